"""The ends of what a weather may be given, drawn: all that is kept and told stays a number."""

from __future__ import annotations

from itertools import product

import esper
import moderngl
import numpy as np
import pytest

from tests.weather_pictures import stage
from weather_ecs import Weather
from weather_ecs.components import Air, Fog, RainArea, Wind

pytestmark = pytest.mark.usefixtures("world")

HERE = (0.0, 1.7, 0.0)


def kept(weather: Weather) -> np.ndarray:
    """Places and velocities of all drops and flakes, (n, 6) float32."""
    found = []
    for drops in weather._renderer._rain.sets().values():
        state = np.frombuffer(drops.states[drops.current].read(), np.float32)
        found.append(state.reshape(-1, 6)[: drops.alive])
    return np.concatenate(found)


@pytest.mark.parametrize("speed", [0.0, 100.0])
@pytest.mark.parametrize("temperature", [-60.0, 60.0])
def test_rain_and_snow_at_the_ends_of_rate_wind_and_cold(
    ctx: moderngl.Context, backend: str, speed: float, temperature: float
) -> None:
    with stage(ctx, (64, 36), backend=backend) as shown:
        area = RainArea((0, 0), (300, 300), 1000.0)
        esper.create_entity(area)
        esper.create_entity(Wind((0.6, 0.8), speed, turbulence=0.25, exponent=1 / 7))
        esper.create_entity(Air(temperature, 0.9))
        changed = shown.rain(shown.play(8)).mean()
        state = kept(shown.weather)
        assert len(state) > 1000 and np.isfinite(state).all()
        assert changed > 5.0
        found = shown.weather.sample(HERE)
        assert found.rain_rate + found.snow_rate == pytest.approx(1000.0, rel=0.1)
        assert (found.snow_rate > 900.0) == (temperature < 0.0)
        assert np.isfinite([*found.wind, found.visibility, found.wetness, found.snow_depth]).all()
        area.rain_rate = 0.0
        shown.play(2, dt=10.0)
        assert shown.weather.sample(HERE).rain_rate == 0.0


@pytest.mark.parametrize(("visibility", "drawn"), list(product([0.0, 1e7], [False, True])))
def test_no_visibility_and_endless_visibility(
    ctx: moderngl.Context, visibility: float, drawn: bool
) -> None:
    with stage(ctx, (64, 36)) as shown:
        esper.create_entity(RainArea((0, 0), (300, 300), 25.0))
        esper.create_entity(Fog(visibility, draw=drawn))
        picture = shown.play(4)
        found = shown.weather.sample(HERE)
        assert 0.0 < found.visibility <= 50_000.0
        assert (found.visibility <= 1.0) == (visibility == 0.0)
        if drawn and visibility == 0.0:
            assert np.ptp(picture.reshape(-1, 3), axis=0).max() <= 3  # nothing but fog
