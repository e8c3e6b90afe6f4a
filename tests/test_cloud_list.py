"""All clouds of a frame: each shape listed once, and what a layer that goes leaves behind."""

from __future__ import annotations

import esper
import pytest

from tests.cloud_worlds import drawn, layer, model, sky
from weather_ecs import Weather
from weather_ecs.components import Cloud

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


def test_what_has_not_changed_is_the_same_object() -> None:
    weather, _ = ten_clouds()
    first, second = drawn(weather), drawn(weather)
    assert first.clouds is second.clouds and first.cloud_shapes is second.cloud_shapes
    esper.process(0.02)
    third = drawn(weather)
    assert third.clouds is not first.clouds and third.cloud_shapes is first.cloud_shapes
    with pytest.raises(ValueError, match="read-only"):
        third.clouds["growth"] = 0.0


def test_shapes_are_listed_once_for_layers_and_made_clouds_alike() -> None:
    weather, _ = ten_clouds()
    shapes = len(drawn(weather).cloud_shapes)
    one = model("one")
    esper.create_entity(layer((sky(0.0, 10),), base=6000.0))
    for number in (0, 1, 0):
        esper.create_entity(Cloud(one, (0.0, 2000.0, 0.0), number=number))
    frame = drawn(weather)
    assert len(frame.clouds) == 23
    # The second layer's sky has the same models: no shape of its own.
    assert len(frame.cloud_shapes) == shapes + 2
    assert len({shape.key for shape in frame.cloud_shapes}) == shapes + 2
    assert set(frame.clouds["shape"].tolist()) == set(range(shapes + 2))
    made = frame.clouds["shape"][20:].tolist()
    assert made[0] == made[2] != made[1]
    assert len(set(frame.clouds["key"].tolist())) == 23


def test_a_layer_is_there_before_the_first_step_has_seen_it() -> None:
    weather = Weather()
    esper.create_entity(layer((sky(0.0, 10),)))
    before = drawn(weather).clouds
    esper.process(0.02)
    after = drawn(weather).clouds
    assert before["key"].tolist() == after["key"].tolist()
    assert after["position"] == pytest.approx(before["position"] + 0.02 * before["velocity"])


def test_without_clouds_there_is_nothing_and_then_again_nothing() -> None:
    weather = Weather()
    assert len(drawn(weather).clouds) == len(drawn(weather).cloud_shapes) == 0
    cloud = esper.create_entity(Cloud(model("one"), (0.0, 2000.0, 0.0)))
    assert len(drawn(weather).clouds) == len(drawn(weather).cloud_shapes) == 1
    esper.delete_entity(cloud)
    assert len(drawn(weather).clouds) == len(drawn(weather).cloud_shapes) == 0
