"""The weather on a context: pictures, bad input, and everything given back."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.renderer_scene import NORTH, far, matrices, near
from tests.weather_pictures import SIZE, Stage, stage
from weather_ecs.components import (
    Observer,
    Occluder,
    PointLight,
    RainArea,
    RainContainer,
    Sun,
    Wind,
)
from weather_ecs.errors import InvalidValueError
from weather_ecs.gpu.context import probe
from weather_ecs.gpu.gl import GL


@pytest.fixture
def made(ctx: moderngl.Context) -> Iterator[Stage]:
    with stage(ctx) as it:
        yield it


# What is drawn


VIEWS: tuple[dict[str, Any], ...] = (
    {},
    {"pitch": 1.5},
    {"pitch": -1.5, "position": (0, 30, 0)},
    {"position": (0, 1.7, 90), "heading": NORTH},
    {"position": (0, 900, 0), "pitch": -0.8},
    {"position": (5000, 1.7, 0), "heading": math.pi},
    {"position": (59.9, 1.7, 0)},
    {"position": (1e7, -1e7, 1e7)},
)


def test_no_view_of_a_full_scene_makes_an_error(
    ctx: moderngl.Context, gl: GL, backend: str
) -> None:
    with stage(ctx, backend=backend) as made:
        esper.create_entity(near(), far(), PointLight((2, 2, 2), (5, 4, 3)), Wind((1, 0), 9.0))
        esper.create_entity(far(), Sun((1, 0.1, 0)), RainContainer(reach=20.0))
        esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((3, 4, 0), (2, 0.1, 2))))
        esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((6, 1, 0), (1, 1, 1)), True))
        for dt in (0.0, 0.03, 3.0, 1e6):
            for at in VIEWS:
                esper.process(dt)
                made.draw(**at)
                assert gl.error() == 0, at


def test_no_rain_draws_nothing_and_does_nothing(made: Stage) -> None:
    empty = made.play(2)
    assert made.rain(empty).max() <= 1.0
    for thing in (near(rain_rate=0.0), far(), PointLight()):
        esper.create_entity(thing)
        assert np.array_equal(made.play(2, heading=-NORTH), empty)
        assert made.weather.stats.drops_moved == made.weather.stats.containers == 0


def test_it_rains_near_and_far(made: Stage) -> None:
    esper.create_entity(near())
    around = made.rain(made.play(4))
    assert (around > 2).mean() > 0.3
    there = made.rain(made.play(4, position=(0, 1.7, 120), heading=NORTH))
    # A shaft of rain in the middle of the picture, and nothing on either side.
    assert there[45:50, 70:90].mean() > 2.0
    assert there[:, :10].max() == 0.0 and there[:, -10:].max() == 0.0


def test_more_rain_is_seen_more(made: Stage) -> None:
    entity, shown = esper.create_entity(near()), []
    for rate in (1.0, 5.0, 25.0, 100.0):
        esper.component_for_entity(entity, RainArea).rain_rate = rate
        shown.append(made.rain(made.play(6)).mean())
    assert shown == sorted(shown) and shown[0] > 0.1 and shown[3] > 2.0 * shown[0]


def test_both_backends_draw_the_same_picture(ctx: moderngl.Context) -> None:
    if not probe(ctx).compute:
        pytest.skip("no compute shaders here")
    pictures = []
    for name in ("compute", "feedback"):
        with stage(ctx, backend=name, quality="medium") as made:
            assert made.weather.backend == made.weather.stats.backend == name
            esper.create_entity(near(), Wind((1, 0), 5.0))
            for k in range(20):
                esper.process(1 / 30)
                picture = made.draw((0.2 * k, 1.7, 0.0), 0.02 * k)
            pictures.append(picture.astype(float))
    assert np.abs(pictures[0] - pictures[1]).mean() < 0.1
    # A few drops at the rim of their discs fall to either side of it by rounding.
    assert (np.abs(pictures[0] - pictures[1]).max(axis=2) > 8).mean() < 0.01
    assert np.abs(pictures[0] - pictures[0].mean(axis=(0, 1))).mean() > 2.0


def test_rain_stays_inside_the_viewport(made: Stage) -> None:
    esper.create_entity(near())
    esper.process(0.03)
    made.clear()
    made.target.viewport = (30, 20, 64, 36)
    made.weather.draw(*matrices())
    assert made.target.viewport == (30, 20, 64, 36)
    made.target.viewport = (0, 0, *SIZE)
    shown = made.rain(made.picture()) > 2
    assert shown[20:56, 30:94].mean() > 0.3
    shown[20:56, 30:94] = False
    assert not shown.any()


def test_the_scene_hides_the_rain_behind_it(made: Stage) -> None:
    esper.create_entity(near())
    made.play(3)
    made.target.use()
    made.target.clear(*made.background, depth=0.0)
    made.weather.draw(*matrices())
    assert made.rain(made.picture()).max() == 0.0


def test_hosts_with_other_framebuffers(made: Stage, keep: Callable[[Any], Any]) -> None:
    """Without depth nothing hides the rain; with samples it is drawn as without."""
    ctx = made.ctx
    esper.create_entity(near())
    usual = made.rain(made.play(5)).mean()
    flat = keep(ctx.texture(SIZE, 4))
    bare = keep(ctx.framebuffer([flat]))
    many = keep(ctx.renderbuffer(SIZE, 4, samples=4))
    deep = keep(ctx.depth_renderbuffer(SIZE, samples=4))
    smooth = keep(ctx.framebuffer([many], deep))
    for target in (bare, smooth):
        target.use()
        target.clear(*made.background)
        made.weather.draw(*matrices())
        ctx.copy_framebuffer(bare, target) if target is smooth else None
        pixels = np.frombuffer(bare.read(components=3), np.uint8).reshape(SIZE[1], SIZE[0], 3)
        assert made.rain(pixels).mean() == pytest.approx(usual, rel=0.2)


# Time


def test_draws_do_not_move_the_weather(made: Stage) -> None:
    esper.create_entity(near(velocity=(1.0, 0.0)))
    left, right = Observer(), Observer()
    for _ in range(6):
        esper.process(1 / 30)
        for observer in (None, left, right):
            made.draw(observer=observer)
    before = made.weather.stats.time
    esper.process(1 / 30)
    frames = [made.draw(observer=o) for o in (left, right, left, None, right, None)]
    assert made.weather.stats.time == pytest.approx(before + 1 / 30)
    # The same camera: the same picture, for whichever observer and however often.
    for other in frames[1:]:
        assert np.array_equal(other, frames[0])
    assert made.weather.stats.drops_moved == 0  # the last of them moved nothing


def test_observers_see_what_is_theirs(made: Stage) -> None:
    """One who draws in between changes nothing for another."""
    walker, watcher = Observer(), Observer()

    def play(alone: bool) -> np.ndarray:
        for k in range(12):
            esper.process(1 / 30)
            picture = made.draw((0.3 * k, 1.7, 0.0), 0.1 * k, observer=walker)
            if not alone:
                made.draw((0.0, 1.7, -30.0 + k), 2.0, observer=watcher)
        return picture

    esper.create_entity(near())
    first = made.weather.snapshot()
    together = play(alone=False)
    made.weather.restore(first)
    again = Observer()
    walker = again
    assert np.array_equal(play(alone=True), together)


@pytest.mark.parametrize("pause", [9.0, 3600.0, 1e300])
def test_after_a_pause_the_rain_goes_on_without_a_burst(made: Stage, pause: float) -> None:
    esper.create_entity(near(radii=(400, 400)), Wind((1, 0), 6.0))
    usual = [made.rain(made.play(1)).mean() for _ in range(30)][10:]
    after = [made.rain(made.play(1, pause)).mean()]
    after += [made.rain(made.play(1)).mean() for _ in range(10)]
    assert max(after) < 1.5 * max(usual) and min(after) > 0.6 * min(usual)
    with pytest.raises(InvalidValueError):
        esper.process(math.nan)
    assert min(usual) < 2.0 * made.rain(made.play(1)).mean()


def test_a_paused_weather_hangs_in_the_air(made: Stage) -> None:
    esper.create_entity(near())
    made.play(5)
    made.weather.paused = True
    still = made.play(1)
    assert np.array_equal(made.play(3), still)
    made.weather.paused = False
    assert not np.array_equal(made.play(1), still)


def test_time_that_goes_back(made: Stage, gl: GL) -> None:
    esper.create_entity(near())
    early = made.weather.snapshot()
    made.play(10)
    made.weather.restore(early)
    assert made.rain(made.play(1)).mean() > 1.0
    assert gl.error() == 0
