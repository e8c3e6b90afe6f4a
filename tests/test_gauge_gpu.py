"""Rain gauges that the GPU reads: the area's rain rate, roofs, edges."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import esper
import moderngl
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.targets import bound_target
from tests.views import look_from, perspective
from weather_ecs import Weather
from weather_ecs.components import Occluder, RainArea, RainGauge, Wind
from weather_ecs.gpu.gauge_pass import MAX_GAUGES, RING

pytestmark = pytest.mark.usefixtures("world")

RATE = 25.0


@pytest.fixture
def target(ctx: moderngl.Context) -> Iterator[None]:
    """Something small to draw into."""
    with bound_target(ctx, (32, 18)):
        yield


# On the GPU


def watch(weather: Weather, seconds: float, step: float = 0.1, heading: float = 0.0) -> None:
    for _ in range(round(seconds / step)):
        esper.process(step)
        weather.draw(look_from((0, 1.7, 0), heading), perspective())


def set_up(gauges: Iterable[RainGauge]) -> list[RainGauge]:
    there = list(gauges)
    for gauge in there:
        esper.create_entity(gauge)
    return there


def counted(gauges: list[RainGauge], within: float) -> None:
    """They read the rain rate, by drops that were counted: looked up, it would be exact."""
    got = [gauge.rate for gauge in gauges]
    assert got == pytest.approx([RATE] * len(gauges), rel=within)
    assert got != [RATE] * len(gauges)


def own_water(weather: Weather) -> list[float]:
    """Drops' own water over what was counted, for every gauge, in the last frames together."""
    sums = np.zeros((MAX_GAUGES, 4))
    for slot in weather._renderer._gauges._ring:
        raw = np.frombuffer(slot.texture.read(), np.float32).reshape(-1, MAX_GAUGES, 4)
        sums += raw.sum(axis=0)
    return (sums[:, 3] / np.maximum(sums[:, 0], 1e-9)).tolist()


# (distance, height) of gauges before the observer; the last lies a little lower.
PLACES = ((2.0, 0.0, 0.5), (8.0, 0.0, 0.5), (14.0, -8.0, 1.0), (20.0, 0.0, 0.5), (6.0, 5.0, -1.0))


@pytest.mark.usefixtures("target")
@pytest.mark.parametrize("speed", [0.0, 8.0])
def test_in_the_open_a_gauge_reads_the_areas_rain_rate(
    ctx: moderngl.Context, backend: str, speed: float
) -> None:
    with Weather(context=ctx, backend=backend, quality="medium", seed=2) as weather:
        esper.create_entity(RainArea((0, 0), (200, 200), RATE))
        esper.create_entity(Wind((0.6, 0.8), speed))
        gauges = set_up(RainGauge((x, y, z)) for x, z, y in PLACES)
        ratios = []
        for _ in range(10):
            watch(weather, 3.0)
            ratios.append(own_water(weather))
        counted(gauges, 0.05)
        # The same drops by their own water: a few large ones decide, so less exactly.
        assert np.mean(np.array(ratios)[:, : len(gauges)]) == pytest.approx(1.0, abs=0.12)


@pytest.mark.usefixtures("target")
def test_gusts_a_profile_and_turbulence_take_no_rain_and_bring_none(
    ctx: moderngl.Context, backend: str
) -> None:
    with Weather(context=ctx, backend=backend, quality="medium", seed=3) as weather:
        esper.create_entity(RainArea((0, 0), (200, 200), RATE))
        esper.create_entity(
            Wind(
                (0.6, 0.8), 9.0, gustiness=0.6, interval=5.0, veer=0.5, veer_period=9.0,
                exponent=1 / 7, turbulence=0.25, ground=-1.0, scale=5.0,
            )
        )  # fmt: skip
        gauges = set_up(RainGauge((x, y, z)) for x, z, y in PLACES)
        watch(weather, 30.0)
        counted(gauges, 0.05)


@pytest.mark.usefixtures("target")
def test_turbulence_brings_and_takes_none_near_and_far(ctx: moderngl.Context, backend: str) -> None:
    with Weather(context=ctx, backend=backend, quality="medium", seed=5) as weather:
        esper.create_entity(RainArea((0, 0), (200, 200), RATE))
        esper.create_entity(Wind((0.6, 0.8), 9.0, turbulence=0.25, ground=-1.0, scale=5.0))
        gauges = set_up(RainGauge((x, 0.5, 0.0), window=20.0) for x in (2.0, 8.0, 15.0, 25.0))
        watch(weather, 22.0)
        counted(gauges, 0.04)


@pytest.mark.usefixtures("target")
def test_nothing_lands_under_a_roof_and_all_of_it_beside(
    ctx: moderngl.Context, backend: str
) -> None:
    with Weather(context=ctx, backend=backend, quality="medium") as weather:
        esper.create_entity(RainArea((0, 0), (200, 200), RATE))
        ground = placed((0, -1, 0), (100, 1, 100))
        esper.create_entity(Occluder(CORNERS, TRIANGLES, ground))
        esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((8, 4, 0), (2, 0.1, 2))))
        under, beside, edge = (RainGauge((8, 0.3, z), window=20.0) for z in (0.0, 3.2, 2.0))
        on_ground = RainGauge((12.0, 0.0, -3.0), window=20.0)
        for gauge in (under, beside, edge, on_ground):
            esper.create_entity(gauge)
        watch(weather, 21.0)
        assert under.rate == 0.0
        assert beside.rate == pytest.approx(RATE, rel=0.06)
        assert on_ground.rate == pytest.approx(RATE, rel=0.06)
        assert 0.3 * RATE < edge.rate < 0.7 * RATE


@pytest.mark.usefixtures("target")
def test_a_roof_in_the_wind_takes_nothing_from_a_gauge_beside_it(
    ctx: moderngl.Context, backend: str
) -> None:
    # Behind it small drops are kept off further out than large ones are.
    with Weather(context=ctx, backend=backend, quality="medium", seed=3) as weather:
        esper.create_entity(RainArea((0, 0), (200, 200), RATE))
        esper.create_entity(Wind((0.0, 1.0), 8.0))
        ground = placed((0, -1, 0), (100, 1, 100))
        esper.create_entity(Occluder(CORNERS, TRIANGLES, ground))
        esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((14, 3, -14), (5, 0.1, 5))))
        gauges = set_up(RainGauge((x, 0.3, 0.0)) for x in (15.0, 22.0))
        watch(weather, 30.0)
        counted(gauges, 0.06)


@pytest.mark.usefixtures("target")
def test_the_edge_of_an_area_and_two_areas_together(ctx: moderngl.Context, backend: str) -> None:
    with Weather(context=ctx, backend=backend, quality="medium") as weather:
        esper.create_entity(RainArea((0, 0), (30, 30), RATE, soft_edge=25.0))
        esper.create_entity(RainArea((5, 0), (90, 90), 10.0))
        at = (15.0, 1.0, 3.0)
        gauge, dry = RainGauge(at, window=20.0), RainGauge((500.0, 0.0, 0.0), window=20.0)
        esper.create_entity(gauge)
        esper.create_entity(dry)
        watch(weather, 21.0)
        assert gauge.rate == pytest.approx(weather.sample(at).rain_rate, rel=0.07)
        assert dry.rate == 0.0


@pytest.mark.usefixtures("target")
def test_counts_come_back_some_frames_late_and_only_while_time_passes(
    ctx: moderngl.Context,
) -> None:
    with Weather(context=ctx, quality="low") as weather:
        esper.create_entity(RainArea((0, 0), (60, 60), RATE))
        watch(weather, 0.5)
        passes = weather._renderer._gauges
        assert not passes._ring  # nothing is made before the first gauge
        gauge = RainGauge((4, 0, 0))
        esper.create_entity(gauge)
        taken = []
        inner = weather._renderer.take_readings
        weather._renderer.take_readings = lambda: taken.append(inner()) or taken[-1]
        watch(weather, 1.0)
        assert [len(readings) for readings in taken] == [0] * RING + [1] * (10 - RING)
        assert taken[-1][0].time == pytest.approx(weather.stats.time - 0.1 * RING)
        weather.paused = True
        watch(weather, 0.1)  # what the last draw has brought is entered
        before = gauge.rate
        watch(weather, 1.0)
        assert taken[-10:] == [[]] * 10
        assert gauge.rate == before


@pytest.mark.usefixtures("target")
def test_more_gauges_than_are_counted_read_the_areas(ctx: moderngl.Context) -> None:
    with Weather(context=ctx, quality="low") as weather:
        esper.create_entity(RainArea((0, 0), (60, 60), RATE))
        gauges = [RainGauge((4, 0, k / 10), window=5.0) for k in range(MAX_GAUGES + 5)]
        for gauge in gauges:
            esper.create_entity(gauge)
        watch(weather, 6.0)
        assert [gauge.rate for gauge in gauges[MAX_GAUGES:]] == pytest.approx([RATE] * 5)
        assert np.mean([gauge.rate for gauge in gauges]) == pytest.approx(RATE, rel=0.2)
        behind = RainGauge((-20, 0, 0), window=5.0)  # no drops are drawn there
        for gauge in gauges:
            gauge.position = (-10.0, 0.0, 0.0)
        esper.create_entity(behind)
        watch(weather, 6.0)
        assert behind.rate == pytest.approx(RATE)
