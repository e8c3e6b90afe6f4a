"""The drops that the GPU really holds against the laws: sizes, speeds, drift, begin and end."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import esper
import moderngl
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.targets import bound_target
from tests.views import look_from, perspective
from weather_ecs import QualitySettings, Weather
from weather_ecs.components import Occluder, RainArea, RainContainer, RainGauge, Wind
from weather_ecs.physics import front
from weather_ecs.physics.drops import number_density, slope, terminal_speed
from weather_ecs.physics.rain_step import LANDED, diameters, law_of

pytestmark = pytest.mark.usefixtures("world")

DROPS = 20_000
RATES = [1.0, 5.0, 25.0, 100.0]


@pytest.fixture(autouse=True)
def target(ctx: moderngl.Context) -> Iterator[None]:
    with bound_target(ctx, (32, 18)):
        yield


class Held(NamedTuple):
    """What is in the buffers: (n, 3), (n, 3), mm."""

    p: np.ndarray
    v: np.ndarray
    size: np.ndarray


def make(ctx: moderngl.Context, backend: str, drops: int = DROPS) -> Weather:
    quality = QualitySettings("test", drops, 1, 256, True)
    return Weather(context=ctx, backend=backend, quality=quality, seed=4)


def go(weather: Weather, seconds: float, step: float = 0.1) -> None:
    for _ in range(round(seconds / step)):
        esper.process(step)
        weather.draw(look_from((0, 1.7, 0), 0.0), perspective())


def held(weather: Weather, rate: float) -> Held:
    assert weather._renderer is not None
    (drops,) = weather._renderer._rain.sets().values()
    state = np.frombuffer(drops.states[drops.current].read(), np.float32)
    state = state.reshape(-1, 6)[: drops.alive].astype(np.float64)
    births = np.frombuffer(drops.births.read(), np.float32).reshape(-1, 4)[: drops.alive]
    unbind(weather)
    return Held(state[:, :3], state[:, 3:], diameters(births[:, 3], law_of(rate)).astype(float))


def distance(sizes: np.ndarray, density: np.ndarray, grid: np.ndarray) -> float:
    """Kolmogorov and Smirnov's, between a sample and a density on a grid."""
    whole = np.concatenate(([0.0], np.cumsum((density[1:] + density[:-1]) / 2.0)))
    expected = np.interp(np.sort(sizes), grid, whole / whole[-1])
    ranks = np.arange(len(sizes) + 1) / len(sizes)
    return float(max(np.abs(expected - ranks[1:]).max(), np.abs(expected - ranks[:-1]).max()))


@pytest.mark.parametrize("rate", RATES)
def test_sizes_in_the_air_are_marshall_and_palmers(
    ctx: moderngl.Context, backend: str, rate: float
) -> None:
    grid = np.linspace(0.5, 6.0, 4001)
    in_air = np.exp(-float(slope(rate)) * grid)
    landing = in_air * terminal_speed(grid)
    with make(ctx, backend) as weather:
        esper.create_entity(RainArea((0, 0), (300, 300), rate))
        esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((0, -1, 0), (100, 1, 100))))
        go(weather, 0.5)
        it = held(weather, rate)
        assert len(it.size) == DROPS
        # They follow a sequence and no chance: closer than any sample drawn one by one would be.
        assert distance(it.size, in_air, grid) < 0.3 / math.sqrt(DROPS)
        above = it.size > 1.0
        share = float(number_density(rate, 1.0, 6.0) / number_density(rate))
        assert above.mean() == pytest.approx(share, abs=1.5e-3)
        landed: list[np.ndarray] = []
        for _ in range(16):
            before = held(weather, rate)
            go(weather, 0.05, 0.05)
            now = held(weather, rate)
            hits = (now.v[:, 1] > 1024.0) & (now.v[:, 1] < 1e8) & (before.v[:, 1] < 1024.0)
            landed.append(now.size[hits])
            if hits.any():
                assert now.v[hits, 1] - LANDED == pytest.approx(0.0, abs=1e-2)  # on the ground
        found = np.concatenate(landed)
        assert len(found) > 1000
        # Of the drops that land, N(D) v(D); N(D) itself is told apart from it.
        assert distance(found, landing, grid) < 1.63 / math.sqrt(len(found))
        assert distance(found, in_air, grid) > distance(found, landing, grid)


def test_speed_and_drift_go_by_the_size(ctx: moderngl.Context, backend: str) -> None:
    with make(ctx, backend, 4000) as weather:
        esper.create_entity(RainArea((0, 0), (300, 300), 25.0))
        wind = Wind((1.0, 0.0), 0.0)
        esper.create_entity(wind)
        go(weather, 2.0)
        it = held(weather, 25.0)
        assert -it.v[:, 1] == pytest.approx(terminal_speed(it.size), abs=2e-3)
        # The wind gets up: what began after it goes with it, and of the others small drops first.
        wind.speed = 10.0
        go(weather, 0.1, 0.1)
        it = held(weather, 25.0)
        late = it.v[:, 0] < 9.9 * np.max(it.v[:, 0]) / 10.0
        order = np.argsort(it.size[late])
        speeds = it.v[late, 0][order]
        assert late.mean() > 0.5
        assert speeds[: len(speeds) // 4].mean() > 1.5 * speeds[-len(speeds) // 4 :].mean()


def fresh_hits(weather: Weather, since: float) -> np.ndarray:
    """(s, mm) of what the list of impacts says was hit after a time, (n, 2)."""
    assert weather._renderer is not None
    impacts = weather._renderer._rain.impacts()
    if impacts is None:
        return np.zeros((0, 2))
    records, _, dropped = impacts.read()
    unbind(weather)
    assert dropped == 0
    new = records[records["time"] > since]
    assert len(new) < impacts.capacity
    return np.column_stack([new["time"], new["diameter"]]).astype(float)


def unbind(weather: Weather) -> None:
    """Reading leaves a buffer bound that is the weather's to delete."""
    assert weather._renderer is not None
    weather._renderer._ctx.buffer(reserve=4).release()


def test_a_shower_sends_its_large_drops_first(ctx: moderngl.Context, backend: str) -> None:
    """The smallest drop that has hit the ground falls at the ceiling's height over the time."""
    ceiling, ground = 20.0, placed((0, -1, 0), (100, 1, 100))
    with make(ctx, backend, 10_000) as weather:
        esper.create_entity(RainContainer(height=12.0))
        area = RainArea((0, 0), (300, 300), 0.0, ceiling=ceiling, onset=1.0)
        esper.create_entity(area)
        esper.create_entity(Occluder(CORNERS, TRIANGLES, ground))
        gauge = RainGauge((6, 1, 0), window=120.0)
        esper.create_entity(gauge)
        go(weather, 1.0)
        area.rain_rate = 25.0
        started, expected, step = weather.stats.time, 0.0, 0.1
        hits: list[np.ndarray] = []
        for k in range(80):
            go(weather, step, step)
            if k % 10 == 9:
                hits.append(fresh_hits(weather, weather.stats.time - 1.0))
            dry = (weather.stats.time - started, front.LONG, 0.0, 0.0)
            expected += step * 25.0 * float(front.water_arrived(ceiling - 1.0, dry, 25.0))
        assert gauge.rate * weather.stats.time == pytest.approx(expected, rel=0.07)
        assert expected < 0.65 * 25.0 * 8.0
        if backend == "feedback":
            return  # there a drop tells of its own last hit alone
        found = np.concatenate(hits)
        time, size = found[:, 0] - started, found[:, 1]
        assert len(size) > 1000
        slowest = ceiling / (time + 0.5 * front.EDGE)
        assert np.all(terminal_speed(size) >= slowest - 0.02)
        first = ceiling / front.FASTEST
        assert first - 0.3 <= time.min() < first + 1.0
        for at in (3.0, 4.0, 6.0):
            small = size[np.abs(time - at) < 0.2].min()
            late, early = (ceiling / (at + by) for by in (0.2 + 0.5 * front.EDGE, -0.2))
            assert front.diameter_at(late) - 1e-3 <= small <= front.diameter_at(early)
