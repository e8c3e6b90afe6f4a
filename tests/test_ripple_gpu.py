"""Ripples on the GPU: against the oracle, at any frame rate, where drops land."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.rain_frames import camera, quality
from tests.ripple_oracle import RippleOracle
from tests.ripple_stage import ONTO, data_of, only_grid, rain, read, renderer_of
from tests.weather_pictures import Stage, stage
from weather_ecs.components import Occluder, RippleSurface
from weather_ecs.frame import AREA_DTYPE, FrameData, RippleData
from weather_ecs.gpu.rain_pass import RainPass
from weather_ecs.gpu.ripple_grid import GREATEST_RISE, RippleGrid
from weather_ecs.gpu.ripple_pass import RipplePass
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.physics import ripple, ripple_place
from weather_ecs.systems.rain_view import RainView


def water(**fields: Any) -> RippleData:
    """Water in front of the camera, whose whole grid is 200 by 150 cells."""
    usual: dict[str, Any] = {
        "key": 0, "center": (3.0, 0.0, 0.0), "size": (4.0, 3.0), "heading": 0.0, "ellipse": False,
        "cell": 0.02, "speed": 0.3, "damping": 5, "amplitude": 1.0, "color": (0.03, 0.04, 0.04),
        "clarity": 0.5, "draw": True,
    }  # fmt: skip
    return RippleData(**{**usual, **fields})


@pytest.fixture
def made(ctx: moderngl.Context, backend: str) -> Iterator[Stage]:
    with stage(ctx, backend=backend, quality="medium") as it:
        yield it


# Against the oracle


@pytest.mark.parametrize(
    "fields",
    [
        {"size": (4.0, 3.0), "cell": 0.02},  # the whole grid, its border held
        {"size": (4.0, 3.0), "cell": 0.02, "heading": 0.7, "center": (3.0, -0.4, 0.5)},
        {"size": (20.0, 14.0), "cell": 0.03, "damping": 6},  # a window that goes round
        {"size": (20.0, 14.0), "cell": 0.03, "heading": -2.0, "shape": "ellipse"},
    ],
    ids=["basin", "turned basin", "lake", "round lake"],
)
def test_many_steps_are_those_of_the_oracle(
    made: Stage, ctx: moderngl.Context, fields: dict[str, Any], tmp_path: Path
) -> None:
    surface = RippleSurface(**{"center": (3.0, 0.0, 0.0), **fields})
    esper.create_entity(rain())
    esper.create_entity(surface)
    oracle = RippleOracle(ctx, renderer_of(made), data_of(made, surface), tmp_path / "shaders")
    try:
        made.play(45, dt=1 / 24, **ONTO)
        grid = only_grid(made)
        assert grid.steps == oracle.steps and oracle.craters > 30
        for found, expected in ((read(grid), oracle.now), (read(grid, 1), oracle.before)):
            assert expected is not None and abs(expected).max() > 2.0
            away = abs(found - expected)
            # An amplitude at the threshold may fall to either side of it, and its waves with it.
            assert np.mean(away > 0.05) < 0.08
            assert np.sqrt((away**2).mean()) < 0.05 * np.sqrt((expected**2).mean())
    finally:
        oracle.release()


@pytest.fixture
def passes(ctx: moderngl.Context) -> Iterator[tuple[RipplePass, Callable[..., RippleGrid]]]:
    """A pass without drops, and a function that lets a surface with a given state move on."""
    target = ctx.simple_framebuffer((64, 36))
    target.use()
    shaders = ShaderLoader(ctx)
    drops = RainPass(ctx, shaders, backend="feedback", seed=1)
    it = RipplePass(ctx, shaders, drops)
    area = np.array([(0, (0, 0), (60, 60), 0.0, 25.0, 1.0, 400.0)], AREA_DTYPE)
    views = RainView(1)

    def advance(surface: RippleData, start: np.ndarray, times: list[float]) -> RippleGrid:
        dt = ripple.time_step(surface.cell, surface.speed)
        target.use()
        for k, time in enumerate(times):
            seen = FrameData(time=time, areas=area, ripples=(surface,))
            view = views.view(seen, camera(pitch=-0.5), 0, quality())
            it.update(replace(view, containers=()), True, 256)
            (grid,) = it.grids().values()
            if k == 0:
                grid.amplitudes[0].write(start.astype(np.float32))
                assert grid.steps == math.floor(time / dt)
        return grid

    yield it, advance
    it.release()
    drops.release()
    shaders.release()
    for thing in (*target.color_attachments, target.depth_attachment, target):
        thing.release()


@pytest.mark.parametrize("kind", ["held", "periodic", "ellipse"])
@pytest.mark.parametrize("n", [5, 7, 9])
def test_the_scheme_alone_is_the_oracle_s(passes: Any, kind: str, n: int) -> None:
    _, advance = passes
    size = (9.0, 8.0) if kind == "periodic" else (4.0, 3.0)
    surface = water(size=size, damping=n, ellipse=kind == "ellipse")
    place = ripple_place.grid_of(surface.size, surface.cell, 256)
    rows, columns = place.cells[::-1]
    y, x = np.mgrid[:rows, :columns]
    inside = np.hypot((x + 0.5) / columns * 2 - 1, (y + 0.5) / rows * 2 - 1) < 1.0
    now = np.zeros((rows, columns), np.float32)
    rng = np.random.default_rng(n)
    ripple.add_sources(now, rng.uniform(20, 130, (12, 2)), rng.uniform(5, 10, 12))
    before = np.zeros_like(now)
    dt = ripple.time_step(surface.cell, surface.speed)
    grid = advance(surface, now, [10.0 + k * dt * 1.01 for k in range(41)])
    steps = int((10.0 + 40 * dt * 1.01) / dt) - int(10.0 / dt)
    for _ in range(steps):
        following = ripple.step(now, before, n, ripple.THRESHOLD, periodic=kind == "periodic")
        if kind == "ellipse":
            following[~inside] = 0.0
        now, before = following, now
    assert abs(now).max() > 0.5
    assert np.mean(abs(read(grid) - now) > 1e-2) < 5e-3
    assert np.mean(abs(read(grid, 1) - before) > 1e-2) < 5e-3
    if kind != "periodic":
        assert not read(grid)[[0, -1]].any() and not read(grid)[:, [0, -1]].any()


def test_the_frame_rate_does_not_show(passes: Any) -> None:
    it, advance = passes
    surface = water()
    start = np.zeros((150, 200), np.float32)
    ripple.add_sources(start, [(100.0, 75.0), (40.0, 110.0)], [8.0, 6.0])
    found = []
    for steps in (20, 80, 300):
        times = np.linspace(2.0, 4.0, steps).tolist()
        grid = advance(surface, start, times)
        found.append((read(grid).copy(), it.map(0, surface).scale, grid.map.read()))
        it.forget(0)
    rng = np.random.default_rng(1)
    times = [2.0, *np.sort(rng.uniform(2.0, 4.0, 40)).tolist(), 4.0]
    grid = advance(surface, start, times)
    found.append((read(grid).copy(), it.map(0, surface).scale, grid.map.read()))
    assert abs(found[0][0]).max() > 0.3
    for amplitudes, scale, _ in found[1:]:
        assert np.array_equal(amplitudes, found[0][0])
        # Which half of the map is the later one may differ, but not what it shows.
        assert scale[2] in (pytest.approx(found[0][1][2]), pytest.approx(1.0 - found[0][1][2]))


def test_a_long_frame_does_few_steps_and_stays_sound(passes: Any) -> None:
    _, advance = passes
    start = np.zeros((150, 200), np.float32)
    ripple.add_sources(start, (100.0, 75.0), 10.0)
    grid = advance(water(), start, [1.0, 11.0, 11.0, 30.0])
    assert np.isfinite(read(grid)).all() and 0.0 < abs(read(grid)).max() < 10.0


def test_a_clock_that_was_set_back_begins_with_level_water(passes: Any) -> None:
    _, advance = passes
    start = np.zeros((150, 200), np.float32)
    ripple.add_sources(start, (100.0, 75.0), 10.0)
    grid = advance(water(), start, [5.0, 5.5])
    assert read(grid).any()
    grid = advance(water(), np.zeros_like(start), [1.0])
    assert not read(grid).any() and grid.steps == math.floor(1.0 / ripple.time_step(0.02, 0.3))


def test_the_map_holds_the_slopes(passes: Any) -> None:
    it, advance = passes
    surface = water(amplitude=2.0)
    start = np.zeros((150, 200), np.float32)
    ripple.add_sources(start, (100.0, 75.0), 10.0)
    grid = advance(surface, start, [1.0, 1.5])
    a = read(grid)
    rise = np.roll(a, -1, 1) - np.roll(a, 1, 1)
    rise = 0.25 * np.roll(rise, 1, 0) + 0.5 * rise + 0.25 * np.roll(rise, -1, 0)
    texels = np.frombuffer(grid.map.read(), np.uint8).reshape(150, 200, 4).astype(float)
    found = (texels[..., 2 * grid._newest] - 127.0) / 127.0 * GREATEST_RISE
    assert abs(rise).max() > 1.0
    assert abs(found - rise).max() < GREATEST_RISE / 127.0
    ripples = it.map(0, surface)
    assert ripples.texture is grid.map
    assert ripples.scale[:2] == pytest.approx((1 / 4.0, 1 / 3.0))
    assert ripples.scale[3] == pytest.approx(2.0 * GREATEST_RISE * 1e-3 / 0.04)


# Where rings are, and where none


def test_rings_are_where_drops_land_and_none_under_a_roof(made: Stage) -> None:
    surface = RippleSurface((3.0, 0.0, 0.0), (4.0, 3.0), cell=0.02)
    esper.create_entity(surface)
    esper.create_entity(rain())
    # Over the half at negative z.
    esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((3.0, 2.0, -3.0), (4.0, 0.1, 3.0))))
    peak = np.zeros((150, 200))
    for _ in range(40):
        made.play(1, **ONTO)
        grid = only_grid(made)
        fresh = read(grid)
        peak = np.maximum(peak, np.where(fresh < -1.5, -fresh, 0.0))
    # Craters are deep; the waves that come in under the roof are not.
    assert (peak[:60] > 3.0).sum() < 0.05 * (peak[90:] > 3.0).sum()
    assert (peak[90:] > 3.0).sum() > 30


def test_a_surface_catches_rain_or_leaves_it_to_the_game(made: Stage) -> None:
    surface = RippleSurface((3.0, 0.0, 0.0), (4.0, 3.0), cell=0.02, catches_rain=False)
    esper.create_entity(surface)
    esper.create_entity(rain())
    esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((0, -5, 0), (40, 0.1, 40))))
    made.play(20, **ONTO)
    assert not read(only_grid(made)).any()  # they fall through, to the ground below
    surface.catches_rain = True
    made.play(20, **ONTO)
    assert read(only_grid(made)).any()


def test_no_rain_no_rings_and_rest_after_it(made: Stage) -> None:
    surface = RippleSurface((3.0, 0.0, 0.0), (4.0, 3.0), cell=0.02, speed=2.0)
    shower = rain()
    shower.onset = 0.0
    esper.create_entity(surface)
    esper.create_entity(shower)
    made.play(30, **ONTO)
    grid = only_grid(made)
    assert read(grid).any()
    shower.rain_rate = 0.0
    made.play(5, **ONTO)
    assert read(grid).any()  # rings run on
    settling = ripple.settling_steps(5) * ripple.time_step(0.02, 2.0)
    made.play(int(settling / 0.1) + 10, dt=0.1, **ONTO)
    assert not read(grid).any()
    assert set(grid.map.read()) == {127}
    solver: Any = renderer_of(made).ripples._solver
    asked: list[int] = []
    solver._step = lambda *arguments: asked.append(1)
    made.play(10, dt=0.1, **ONTO)
    assert not asked  # at rest it takes no GPU work
