"""Times of impacts: exact after weeks, across epochs, and gone where the clock is set back."""

from __future__ import annotations

import esper
import moderngl
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.rain_frames import camera, frame
from tests.renderer_scene import near
from tests.weather_pictures import Stage, stage
from weather_ecs.components import Occluder, RippleSurface, SplashEmitter
from weather_ecs.frame import ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.context import probe
from weather_ecs.gpu.impact_times import EPOCH, in_epoch
from weather_ecs.gpu.rain_blocks import RAIN_VIEW
from weather_ecs.gpu.view_block import TURNING, fill_view
from weather_ecs.quality import QualitySettings

STEPS_A_DAY = 20 * 86400
SIZE = (48, 27)


def ground(*more: object) -> None:
    esper.create_entity(
        Occluder(CORNERS, TRIANGLES, placed((0, -0.5, 0), (100, 0.5, 100))), SplashEmitter()
    )
    for component in more:
        esper.create_entity(component)


def hits(shown: Stage) -> tuple[np.ndarray, float]:
    """(s, ages of what has been hit, the youngest first; mm, mean height of the rings)."""
    renderer = shown.weather._renderer
    assert renderer is not None
    impacts = renderer.rain.impacts()
    assert impacts is not None
    records, total, _ = impacts.read()
    ages = in_epoch(shown.weather.stats.time) - records["time"][:total].astype(float)
    (grid,) = renderer.ripples.grids().values()
    waves = np.frombuffer(grid.amplitudes[0].read(), np.float32)
    return np.sort(ages), float(np.sqrt(np.square(waves).mean()))


def rained(ctx: moderngl.Context, steps: int) -> tuple[np.ndarray, float]:
    """The same on a clock that has done so many steps before."""
    with stage(ctx, SIZE, backend="compute") as shown:
        shown.weather.inner_state.clock.steps = steps
        ground(near(), RippleSurface((4.0, 0.05, 0.0), (4.0, 4.0)))
        shown.play(20, dt=1 / 60)
        return hits(shown)


@pytest.mark.parametrize("steps", [400 * STEPS_A_DAY, int(20 * EPOCH) - 4])
def test_splashes_and_rings_are_the_same_however_late_it_is(
    ctx: moderngl.Context, steps: int
) -> None:
    if not probe(ctx).compute:
        pytest.skip("no compute shaders here")
    ages, waves = rained(ctx, 0)
    late, later_waves = rained(ctx, steps)
    assert len(ages) > 100 and 0.0 <= ages[0] < 0.05 < ages[-1] < 0.6
    assert late == pytest.approx(ages, abs=2e-3)
    assert later_waves == pytest.approx(waves, rel=0.2) and waves > 0.01


def test_nothing_splashes_that_is_yet_to_fall(ctx: moderngl.Context, backend: str) -> None:
    """What was hit at a time to which the clock comes again."""
    with stage(ctx, SIZE, backend=backend) as shown:
        area = near(rain_rate=0.0, onset=0.0)
        ground(area)
        shown.play(2)
        dry = shown.weather.snapshot()
        area.rain_rate = 50.0
        shown.play(26)
        assert shown.weather.stats.splashes > 20
        shown.weather.restore(dry)
        shown.play(10)  # they are counted some frames late
        for _ in range(18):
            shown.play(1)
            assert shown.weather.stats.splashes == 0


def test_flakes_turn_evenly_after_a_month(ctx: moderngl.Context) -> None:
    block = BlockBuffer(ctx, RAIN_VIEW)
    found = []
    for k in range(30):
        at = camera()
        time = 30 * 86400.0 + k / 60
        view = ViewData(frame(time=time), 0, at.view, at.projection, at.position, (0.0,) * 3,
                        1 / 60, (), ())  # fmt: skip
        fill_view(block, view, (0, 0, 16, 9))
        found.append(float(block.data["view_time"][2]))
    block.release()
    assert np.diff(found) % TURNING == pytest.approx(1 / 60, abs=1e-4)
    # As shaders/flake.vert has it: all of them have come round.
    turns = (np.arange(32) - 15.5) * 0.0095 * TURNING
    assert turns == pytest.approx(np.round(turns), abs=1e-9)


def test_more_drops_get_more_room_for_what_they_hit(ctx: moderngl.Context) -> None:
    """Also where the list of impacts is as long as it may be."""
    if not probe(ctx).compute:
        pytest.skip("no compute shaders here")
    room = []
    with stage(ctx, SIZE, backend="compute") as shown:
        ground(near())
        for drops in (270_000, 540_000):
            shown.weather.quality = QualitySettings("own", drops, 1, 64, False, 0.05)
            shown.play(1)
            impacts = shown.weather._renderer.rain.impacts()  # type: ignore[union-attr]
            assert impacts is not None
            room.append((impacts.capacity, impacts.step))
    assert room == [(65_536, 270_000 // 16), (65_536, 540_000 // 16)]
