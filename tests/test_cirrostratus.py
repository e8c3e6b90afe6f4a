"""The halo of a sky: it comes with cirrostratus, in a layer or as a single cloud."""

from __future__ import annotations

import esper
import pytest

from tests.cloud_worlds import drawn, layer, model, record
from weather_ecs import Weather
from weather_ecs.components import Atmosphere, Cloud, Sky
from weather_ecs.systems.atmosphere import HALO

pytestmark = pytest.mark.usefixtures("world")


def halo(weather: Weather) -> float:
    esper.process(0.5)
    seen = drawn(weather).atmosphere
    assert seen is not None
    return seen.halo


def test_it_is_whole_where_a_fifth_of_a_layer_is_cirrostratus() -> None:
    esper.create_entity(Atmosphere())
    weights = (1.0, 9.0)
    sky = Sky(0.0, (model(HALO), model("cumulus")), count=100, weights=weights)
    esper.create_entity(layer((sky,)))
    weather = Weather()
    esper.process(0.5)
    array = record(weather).array
    share = sum(array.kinds[k].model == HALO for k in array.kind.tolist()) / len(array)
    assert 0.02 < share < 0.2
    assert halo(weather) == pytest.approx(5.0 * share)


def test_one_cloud_is_enough_and_the_greatest_share_counts() -> None:
    esper.create_entity(Atmosphere())
    esper.create_entity(layer((Sky(0.0, (model("cumulus"),), count=20),)))
    weather = Weather()
    esper.process(0.5)
    assert halo(weather) == 0.0
    esper.create_entity(model(HALO))
    esper.create_entity(Cloud(HALO, (0.0, 7000.0, 0.0)))
    assert halo(weather) == 1.0


def test_an_atmosphere_may_say_it_itself() -> None:
    esper.create_entity(Atmosphere(halo=0.25))
    esper.create_entity(Cloud("cirrostratus", (0.0, 7000.0, 0.0)))
    assert halo(Weather()) == 0.25
