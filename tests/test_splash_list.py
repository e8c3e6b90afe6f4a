"""The lists of splashes that are to be seen hold what the vertex shader shows, and nothing else."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace

import moderngl
import numpy as np
import pytest

from tests.splash_capture import LOOKS, PICTURE, SplashCapture, impacts
from tests.splash_scenes import scene
from tests.views import look_from, perspective
from tests.weather_pictures import stage
from weather_ecs.frame import DropLook, FrameData, SplashLook, ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.context import probe
from weather_ecs.gpu.impact_list import ImpactList
from weather_ecs.gpu.rain_blocks import RAIN_VIEW
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.gpu.splash_list import SplashList, chunks_of
from weather_ecs.gpu.splash_pass import SPLASH, fill_splash
from weather_ecs.gpu.streak_list import CHUNK
from weather_ecs.gpu.view_block import fill_view
from weather_ecs.physics.camera import camera_from
from weather_ecs.systems.rain_view import RainView

TIME = 10.0
N = 5000  # more than a chunk
SETTINGS = SimpleNamespace(drops=1000, containers=1, budget=1.0, veil=False)


@pytest.fixture
def capture(ctx: moderngl.Context) -> Iterator[SplashCapture]:
    made = SplashCapture(ctx)
    yield made
    made.release()


def view() -> ViewData:
    camera = camera_from(look_from((0.0, 1.7, 0.0), 0.0), perspective())
    frame = FrameData(time=TIME, look=DropLook())
    return RainView(1).view(frame, camera, 0, SETTINGS)


def records() -> np.ndarray:
    """All around the camera, near and far, of any age, some that were never written."""
    rng = np.random.default_rng(3)
    found = impacts(N, seed=rng.uniform(0.0, 1.0, N))
    found["position"] = rng.uniform((-30.0, -0.2, -30.0), (30.0, 3.0, 30.0), (N, 3))
    found["time"] = TIME - rng.uniform(-0.1, 0.8, N)
    found["time"][::50] = -1e6
    found["weight"] = 10.0 ** rng.uniform(-3.0, 4.0, N)
    return found


def lists(ctx: moderngl.Context, array: np.ndarray, look: SplashLook) -> tuple[list, list]:
    """Numbers of the records that are listed as (small, large)."""
    shaders = ShaderLoader(ctx)
    seen = SplashList(ctx, shaders, shaders.program(LOOKS))
    kept = ImpactList(ctx, len(array))
    kept.records.write(array)
    blocks = [BlockBuffer(ctx, block) for block in (RAIN_VIEW, SPLASH)]
    fill_view(blocks[0], view(), (0, 0, *PICTURE))
    fill_splash(blocks[1], view(), look)
    for block in blocks:
        block.upload()
        block.bind()
    seen.find(0, kept)
    ids, commands = (np.frombuffer(buffer.read(), np.uint32) for buffer in seen.buffers(0))
    found: list[list[int]] = []
    chunks = chunks_of(kept)
    for part in commands.reshape(2, chunks, 5):
        assert (part[:, 1] == 1).all() and (part[:, 3:] == 0).all()
        # No chunk leaves its own stretch.
        assert (part[:, 2] // CHUNK == np.arange(chunks)).all()
        found.append([k for count, _, first, *_ in part for k in ids[first : first + count]])
    for thing in (*blocks, seen, kept, shaders):
        thing.release()
    return found[0], found[1]


def test_listed_is_what_the_vertex_shader_shows(
    ctx: moderngl.Context, capture: SplashCapture
) -> None:
    array, look = records(), SplashLook()
    small, large = lists(ctx, array, look)
    looks = capture.looks(array, view(), look)
    shown = np.flatnonzero(looks.form[:, 0] > 0.0)
    assert 200 < len(shown) < N // 2
    assert small == sorted(small) and large == sorted(large)
    # Two programs may round an opacity at the very threshold to either side of it.
    assert len(set(shown) ^ set(small + large)) <= 2
    assert not set(small) & set(large)
    # A small one is a crown and nothing else.
    few = np.array([k for k in small if k in set(shown)])
    assert len(few) > 50 and len(large) > 50
    assert (looks.throw[few, 2] < 0.0041).all()


def test_nothing_is_listed_where_nothing_has_been_hit(ctx: moderngl.Context) -> None:
    array = records()
    array["time"] = -1e6
    assert lists(ctx, array, SplashLook()) == ([], [])


@pytest.mark.parametrize(("quality", "room"), [("medium", 4096), ("ultra", 30_000)])
def test_there_is_room_for_one_in_four_drops(
    ctx: moderngl.Context, quality: str, room: int
) -> None:
    if not probe(ctx).compute:
        pytest.skip("no compute shaders here")
    with stage(ctx, quality=quality, backend="compute") as it:
        scene()
        it.play(2)
        assert it.weather._renderer is not None
        listed = it.weather._renderer._rain.impacts()
        assert listed is not None and listed.capacity == room
