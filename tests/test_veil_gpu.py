"""The veil's shader against its oracle."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.rain_frames import area, camera, frame, quality
from tests.veil_stage import (
    GRAIN,
    HERE,
    SIZE,
    Stage,
    assert_same,
    axis_of,
    only,
    oracle,
    rays_of,
    shaft,
)
from weather_ecs.frame import FogData, SkyLight, SnowLook, VeilData
from weather_ecs.gpu.veil_list import color
from weather_ecs.gpu.view_block import encode, veil_light
from weather_ecs.physics import veil
from weather_ecs.physics.front import LONG
from weather_ecs.physics.optics import fog_factor
from weather_ecs.systems.rain_view import RainView

NORTH = math.pi / 2


@pytest.fixture
def stage(ctx: moderngl.Context) -> Iterator[Stage]:
    made = Stage(ctx)
    yield made
    made.release()


SCENES = {
    "from outside": (camera(HERE, NORTH), shaft()),
    "turned away": (camera(HERE, -NORTH), shaft()),
    "from inside": (camera((10.0, 1.7, -140.0), 1.0), shaft()),
    "from the middle, with drops": (camera((0.0, 1.7, -150.0), 1.0), shaft(shown=35.0)),
    "from outside, with drops": (camera((0.0, 1.7, -95.0), NORTH), shaft(shown=12.0)),
    "from the rim, out": (camera((0.0, 1.7, -104.9), -NORTH), shaft()),
    "looking up": (camera((5.0, 1.7, -150.0), 0.3, 1.35), shaft()),
    "straight up": (camera((5.0, 1.7, -150.0), 0.3, math.pi / 2), shaft()),
    "straight up, with drops": (camera((5.0, 1.7, -150.0), 0.3, math.pi / 2), shaft(shown=20.0)),
    "looking down": (camera((5.0, 150.0, -150.0), 0.3, -1.2), shaft(extinction=0.003)),
    "above the ceiling": (camera((0.0, 260.0, 0.0), NORTH, -0.5), shaft(extinction=0.003)),
    "above the ceiling, level": (camera((0.0, 260.0, 0.0), NORTH, -1e-9), shaft()),
    "above the ceiling, up": (camera((0.0, 260.0, 0.0), NORTH, 0.7), shaft()),
    "over it, straight down": (camera((0.0, 320.0, -150.0), NORTH, -1.57), shaft(extinction=1e-3)),
    "hard edge": (camera(HERE, NORTH), shaft(shape=(70.0, 45.0, 0.9999))),
    "all edge": (camera(HERE, NORTH), shaft(shape=(70.0, 45.0, 0.0))),
    "thin, across": (camera(HERE, NORTH), shaft(shape=(400.0, 2.0, 0.0), extinction=0.3)),
    "thin, along": (
        camera((0.0, 1.7, 0.3), 0.0),
        shaft(axis=axis_of((0.0, 0.0), 0.0), shape=(400.0, 2.0, 0.3)),
    ),
    "wide angle": (camera(HERE, NORTH, vertical=120.0), shaft()),
    "narrow angle": (camera(HERE, NORTH, vertical=8.0), shaft()),
    "far off": (camera((0.0, 1.7, 4000.0), NORTH, vertical=20.0), shaft()),
    "far off, hard edge": (
        camera((0.0, 1.7, 4000.0), NORTH, vertical=4.0),
        shaft(shape=(70.0, 45.0, 0.9999)),
    ),
    "begins": (camera(HERE, NORTH), shaft(dry=(20.0, LONG, 0.0, 0.0))),
    "begins, from inside": (
        camera((0.0, 1.7, -150.0), 1.0, 0.8),
        shaft(dry=(15.0, LONG, 0.0, 0.0), slope=1.6, shown=20.0),
    ),
    "ends": (camera(HERE, NORTH), shaft(dry=(-1.0, 30.0, 0.0, 0.0), slope=3.0)),
    "a short one passes": (camera(HERE, NORTH), shaft(dry=(40.0, LONG, -1.0, 12.0))),
    "far off, thin": (
        camera((0.0, 1.7, 4000.0), NORTH, vertical=4.0),
        shaft(shape=(300.0, 3.0, 0.2), extinction=0.2),
    ),
}

CURTAIN: dict[str, Any] = {"top": 60.0, "ragged": 0.8, "phase": 2.3, "drift": (0.5, -0.2)}


@pytest.mark.parametrize(
    "name",
    ["from outside", "from inside", "looking up", "above the ceiling", "far off", "begins",
     "from the middle, with drops", "wide angle", "narrow angle", "straight up"],
)  # fmt: skip
def test_rain_under_a_cloud_is_that_of_the_oracle(stage: Stage, name: str) -> None:
    at, plain = SCENES[name]
    data = replace(plain, **CURTAIN)
    expected = oracle(at, data)
    assert_same(stage.draw(only(at, data)), expected)
    assert np.abs(expected - oracle(at, plain)).max() > 0.005  # there is something to tell


def test_a_shaft_is_soft_at_the_top_and_as_dense_on_the_whole() -> None:
    """Towards the ceiling it fades to nothing; rays take from one place what they give another."""
    at = camera((0.0, 1.7, 1500.0), NORTH, 0.05, vertical=14.0)
    plain = shaft(shape=(70.0, 45.0, 0.16), extinction=0.004)
    uneven = replace(plain, **{**CURTAIN, "top": 0.0})
    first, second = (-np.log1p(-oracle(at, data)) for data in (plain, uneven))
    assert second.sum() == pytest.approx(first.sum(), rel=0.1)
    assert np.abs(second - first).max() > 0.15 * first.max()
    soft = -np.log1p(-oracle(at, replace(plain, top=80.0)))
    column = soft.argmax() % SIZE[0]
    rows = np.flatnonzero(first[:, column] > 0.0)
    assert soft[rows[-1], column] < 0.1 * first[rows[-1], column]
    assert soft[rows[-1] // 3, column] == pytest.approx(first[rows[-1] // 3, column])


def test_thick_rain_under_a_cloud_is_darker(stage: Stage) -> None:
    """Than in the open, and the darker the less shines through it."""
    at = camera(HERE, NORTH)
    bright, dark = (stage.draw(only(at, shaft(cloud=cloud))) for cloud in (0.0, 1.0))
    drawn = bright[..., 3] > 0.05
    assert (dark[..., :3][drawn] < bright[..., :3][drawn] - 0.05).all()
    thin = drawn & (dark[..., 3] < 0.2)
    thick = dark[..., 3] > 0.8
    assert thin.any() and dark[..., 1][thick].mean() < dark[..., 1][thin].mean() - 0.03
    snow = stage.draw(only(at, shaft(cloud=1.0, snow=1.0)))
    assert (snow[..., :3][drawn] > dark[..., :3][drawn]).all()


@pytest.mark.parametrize("name", SCENES)
def test_pixels_are_those_of_the_oracle(stage: Stage, name: str) -> None:
    at, data = SCENES[name]
    expected = oracle(at, data)
    assert_same(stage.draw(only(at, data)), expected)
    seen = name not in ("turned away", "from the rim, out", "above the ceiling, up")
    assert (expected.max() > 0.1) == seen  # the scene is one in which there is something to see


def test_many_views_of_many_veils(stage: Stage) -> None:
    rng = np.random.default_rng(4)
    for _ in range(25):
        x, z = rng.uniform(-300, 300, 2)
        at = camera(
            (x, rng.uniform(0, 300), z), rng.uniform(-3, 3), rng.uniform(-1.5, 1.5),
            rng.uniform(20, 110), rng.uniform(0.5, 2.5),
        )  # fmt: skip
        b, a = np.sort(rng.uniform(5, 300, 2)).tolist()
        data = VeilData(
            axis_of((0.0, 0.0), rng.uniform(-3, 3)), (a, b, rng.uniform(0, 0.95)),
            (-3e4, rng.uniform(50, 400)), rng.uniform(0.001, 0.05), rng.choice([0.0, 5.0, 40.0]),
        )  # fmt: skip
        assert_same(stage.draw(only(at, data)), oracle(at, data))


FOG = FogData(1.0 / 80.0, (0.1, 0.3, 0.8))


@pytest.mark.parametrize("name", [n for n in SCENES if "straight" not in n])
def test_rain_in_fog_takes_its_colour(stage: Stage, name: str) -> None:
    at, data = SCENES[name]
    there = oracle(at, data)
    away = veil.rain_distance(
        at.position, rays_of(at), math.inf, data.axis, data.shape, data.span[1], data.shown,
        data.extinction, data.dry, (data.slope / 4.1) ** (-1.0 / 0.21),
    )  # fmt: skip
    left = fog_factor(np.maximum(away, 0.0), FOG.extinction)[..., None]
    wanted = encode(veil_light(SkyLight())) * left + encode(np.array(FOG.color)) * (1.0 - left)
    found = stage.draw(only(at, data, FOG))
    drawn = there > 0.02
    off = np.abs(found[..., :3] - wanted).max(axis=2) * np.maximum(there, 0.05)
    assert off[drawn].max(initial=0.0) <= GRAIN * 1.1 + 1e-3
    assert np.abs(found[..., 3] - there)[drawn].max(initial=0.0) <= 2e-3


@settings(max_examples=50, deadline=None)
@given(st.floats(0.0, 300.0), st.floats(1.0, 400.0), st.floats(1e-4, 0.05), st.floats(1e-4, 0.02))
def test_fog_before_rain_is_about_what_the_integral_has(
    start: float, way: float, rain: float, fog: float
) -> None:
    """Mean of what the fog leaves, over the light that comes from every depth of the rain."""
    radius = 0.5 * way
    found = veil.rain_distance(
        (-start - radius, 1.0, 0.0), np.array([[1.0, 0.0, 0.0]]), math.inf, (0.0, 0.0, 1.0, 0.0),
        (radius, radius, 0.9999), 500.0, 0.0, rain,
    )[0]  # fmt: skip
    x = (np.arange(2000) + 0.5) * (way / 2000)
    weight = np.exp(-rain * x)
    mean = float((weight * np.exp(-fog * (start + x))).sum() / weight.sum())
    assert math.exp(-fog * found) == pytest.approx(mean, abs=0.12)
    assert start <= found <= start + radius


def test_the_scene_cuts_the_ray(stage: Stage) -> None:
    """Half the picture has something in front of it, at depths from within to beyond the rain."""
    at = camera((0.0, 1.7, -150.0), 1.0, far=500.0)
    data = shaft()
    t = np.geomspace(0.2, 400.0, SIZE[0])[None, :].repeat(SIZE[1], 0)
    p = at.projection
    stored = (((-p[2, 2] * t + p[2, 3]) / t) * 0.5 + 0.5).astype(np.float32)
    stored[: SIZE[1] // 2] = 1.0
    end = veil.scene_depth(stored, p)
    assert end[-1] == pytest.approx(t[-1], rel=2e-3)
    expected = oracle(at, data, end)
    assert_same(stage.draw(only(at, data), stored), expected)
    assert expected[-1, 0] < 0.01 < 0.3 < expected[0, 0]


def test_the_far_plane_does_not_cut_it(stage: Stage) -> None:
    """Rain beyond the far plane, in front of nothing, is seen; so is rain that it runs through."""
    for far in (40.0, 160.0, 1e5):
        at = camera(HERE, NORTH, near=0.05, far=far)
        assert_same(stage.draw(only(at, shaft())), oracle(camera(HERE, NORTH), shaft()))


def test_the_near_plane_does_not_cut_it(stage: Stage) -> None:
    at = camera((0.0, 1.7, -150.0), NORTH, near=30.0)
    assert_same(stage.draw(only(at, shaft())), oracle(at, shaft()))


def test_a_viewport_elsewhere_in_the_picture(stage: Stage) -> None:
    at, data = camera((0.0, 1.7, -150.0), 1.0), shaft()
    rng = np.random.default_rng(3)
    stored = rng.uniform(0.9, 1.0, (SIZE[1], SIZE[0])).astype(np.float32)
    found = stage.draw(only(at, data), stored, origin=(31, 17))
    assert_same(found, oracle(at, data, veil.scene_depth(stored, at.projection)))


def test_a_lopsided_frustum(stage: Stage) -> None:
    """As for the eyes of a headset, or for tiles of a large picture."""
    at = camera(HERE, NORTH)
    at.projection[0, 2], at.projection[1, 2] = 0.4, -0.3
    assert_same(stage.draw(only(at, shaft())), oracle(at, shaft()))


def test_a_veil_in_several_of_a_frame(stage: Stage) -> None:
    """Each goes over what the one before has left: the light that gets through multiplies."""
    at = camera(HERE, NORTH)
    seen = frame(area(0, (0.0, -150.0)), area(1, (40.0, -260.0), rain_rate=60.0))
    view = RainView().view(seen, at, 0, quality(containers=0))
    assert len(view.veils) == 2
    through = np.ones((SIZE[1], SIZE[0]))
    for each in view.veils:
        data = replace(each, cloud=0.0, ragged=0.0)
        expected = oracle(at, data)
        assert_same(stage.draw(only(at, data)), expected)
        through *= 1.0 - expected
    assert through.min() < 0.9


@pytest.mark.parametrize("sides", [(1.0, 1.0), (-1.0, 1.0)])
def test_parallel_rays_do_no_harm(stage: Stage, sides: tuple[float, float]) -> None:
    """A picture without perspective has no rain in it that would mean anything, and no NaN."""
    at = camera(HERE, NORTH)
    at.projection[:] = np.diag([0.01 * sides[0], 0.01 * sides[1], -0.001, 1.0])
    assert np.isfinite(stage.draw(only(at, shaft()))).all()


def test_a_level_look_above_the_ceiling_has_no_line_along_the_horizon(stage: Stage) -> None:
    """The middle row of an odd number of rows looks exactly along the ceiling."""
    stage.size = (95, 53)
    at = camera((0.0, 260.0, 0.0), NORTH)
    found = stage.draw(only(at, shaft()))
    assert found[26:, :, 3].max() == 0.0
    assert found[:26, :, 3].max() > 0.1


def test_overhead_the_veil_has_no_hole(stage: Stage) -> None:
    """The drops show the rain as far as they reach, straight up as elsewhere."""
    at = camera((0.0, 1.7, 0.0), 0.3, 1.4, vertical=40.0)
    wide = shaft(
        axis=axis_of((0.0, 0.0), 0.0), shape=(300.0, 300.0, 0.9), extinction=0.004, shown=25.0
    )
    found = stage.draw(only(at, wide))[..., 3].astype(float)
    assert found.min() > 0.4
    assert np.abs(np.diff(found, axis=0)).max() < 0.01
    assert np.abs(np.diff(found, axis=1)).max() < 0.01


def test_a_veil_of_snow_is_no_brighter_than_the_sky_that_lights_it() -> None:
    """Single flakes may be, to stand out from it."""
    it = frame(area(0, (0.0, 0.0), (60.0, 40.0), 2.0))
    snow = VeilData((0.0, 0.0, 1.0, 0.0), (60.0, 40.0, 0.5), (0.0, 80.0), 0.01, 30.0, snow=1.0)

    def shown(brightness: float) -> np.ndarray:
        return color(replace(it, flakes=SnowLook(brightness=brightness)), snow)

    assert (shown(0.5) < shown(1.0)).all() and (shown(1.0) < shown(1.3)).all()
    assert np.array_equal(shown(1.7), shown(1.3)) and np.array_equal(shown(9.0), shown(1.3))
