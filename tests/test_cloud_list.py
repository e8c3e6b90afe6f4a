"""Clouds of a frame when a layer goes: they dissolve, but not while the weather stands still."""

from __future__ import annotations

import esper
import pytest

from tests.cloud_worlds import drawn, layer, sky
from weather_ecs import Weather

pytestmark = pytest.mark.usefixtures("world")


def ten_clouds() -> tuple[Weather, int]:
    entity = esper.create_entity(layer((sky(0.0, 10),)))
    weather = Weather()
    esper.process(0.0)
    assert len(drawn(weather).clouds) == 10
    return weather, entity


def test_clouds_of_a_layer_that_goes_dissolve() -> None:
    weather, entity = ten_clouds()
    esper.delete_entity(entity, immediate=True)
    esper.process(0.02)
    left = drawn(weather).clouds
    assert len(left) == 10 and (left["growth"] <= 1.0).all()
    esper.process(0.5)
    later = drawn(weather).clouds
    assert (later["growth"] < 1.0).all()
    for _ in range(40):
        esper.process(1.0)
    assert len(drawn(weather).clouds) == 0


def test_while_it_is_paused_they_are_gone_at_once() -> None:
    weather, entity = ten_clouds()
    weather.paused = True
    esper.delete_entity(entity, immediate=True)
    esper.process(0.02)
    assert len(drawn(weather).clouds) == 0
    weather.paused = False
    esper.process(0.02)
    assert len(drawn(weather).clouds) == 0
