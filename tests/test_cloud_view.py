"""Frustum, order of drawing, and the space of the impostors' atlas; no OpenGL."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.views import look_from, perspective
from weather_ecs.gpu.cloud_atlas import TileSpace
from weather_ecs.physics.cloud_spread import Spread
from weather_ecs.physics.cloud_view import draw_order, frustum, picture_axes, silhouette, visible

REACH = 50_000.0


def test_the_frustum_s_sphere_holds_its_corners_and_the_planes_are_its_sides() -> None:
    view = look_from((0.0, 0.0, 0.0), 0.3, 0.4)
    seen = frustum(view, perspective(60.0, 16 / 9, 0.1, 900.0), REACH)
    forward = -view[2, :3]
    half = math.radians(30.0)
    for side in (-1.0, 1.0):
        up = view[1, :3] * side
        right = view[0, :3]
        corner = REACH * (forward + math.tan(half) * up + math.tan(half) * 16 / 9 * right)
        assert np.linalg.norm(corner - seen.center) <= seen.radius * (1.0 + 1e-9)
        depths = seen.planes[:, :3] @ corner + seen.planes[:, 3]
        assert sorted(np.abs(depths))[:3] == pytest.approx([0.0] * 3, abs=1e-3)
    np.testing.assert_allclose(np.linalg.norm(seen.planes[:, :3], axis=1), 1.0)
    # The host's own far plane, 900 m off, hides no cloud.
    assert visible(seen, 20_000.0 * forward[None], np.array([10.0]))[0]


@settings(max_examples=60, deadline=None)
@given(
    st.floats(-math.pi, math.pi), st.floats(-1.5, 1.5), st.integers(0, 1000),
    st.floats(20.0, 110.0),
)  # fmt: skip
def test_no_cloud_in_view_is_left_out_and_few_others_are_kept(
    heading: float, pitch: float, seed: int, field: float
) -> None:
    rng = np.random.default_rng(seed)
    view, projection = look_from((0.0, 0.0, 0.0), heading, pitch), perspective(field)
    centers = rng.uniform(-20_000.0, 20_000.0, (200, 3))
    radii = rng.uniform(10.0, 900.0, 200)
    found = visible(frustum(view, projection, REACH), centers, radii)
    # A point of the sphere that is in the picture says that the cloud is.
    points = centers[:, None] + radii[:, None, None] * _sphere(rng)
    clip = points @ (projection[:, :3] @ view[:3, :3]).T + projection[:, 3]
    inside = (np.abs(clip[..., :2]) <= clip[..., 3:]).all(-1) & (clip[..., 3] > 0.1)
    assert found[inside.any(axis=1)].all()
    depth = centers @ -view[2, :3]
    assert not found[depth < -radii - 1.0].any()


def _sphere(rng: np.random.Generator) -> np.ndarray:
    points = rng.standard_normal((64, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def test_far_clouds_come_first_within_a_layer() -> None:
    centers = np.array([[100.0, 1000.0, 0.0], [9000.0, 1100.0, 0.0], [3000.0, 900.0, 0.0]])
    assert draw_order(centers, np.full(3, 300.0)).tolist() == [1, 2, 0]


@pytest.mark.parametrize(("camera", "first"), [(0.0, 1), (12_000.0, 0)])
def test_a_higher_layer_is_behind_from_below_and_before_from_above(
    camera: float, first: int
) -> None:
    # A sheet straight overhead is nearer than the cumulus on the horizon that floats under it.
    cumulus, sheet = (20_000.0, 1500.0 - camera, 0.0), (0.0, 8000.0 - camera, 0.0)
    order = draw_order(np.array([cumulus, sheet]), np.array([500.0, 200.0])).tolist()
    assert order == [first, 1 - first]


def test_no_clouds_have_an_order_too() -> None:
    assert draw_order(np.zeros((0, 3)), np.zeros(0)).tolist() == []


def test_silhouettes_are_flat_from_the_side_and_wide_from_below() -> None:
    half = np.array([[500.0, 100.0, 300.0]])
    wide, high = silhouette(np.array([[0.0, 0.0, -9000.0]]), half)
    assert (wide[0], high[0]) == pytest.approx((500.0, 100.0))
    wide, high = silhouette(np.array([[0.0, 900.0, 0.0]]), half)
    assert (wide[0], high[0]) == pytest.approx((500.0, 500.0))


@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_axes_of_a_picture_are_a_right_angled_frame(x: float, y: float, z: float) -> None:
    way = np.array([x, y, z])
    if np.linalg.norm(way) < 1e-3:
        way = np.array([0.0, 1.0, 0.0])
    way /= np.linalg.norm(way)
    right, up = picture_axes(way)
    frame = np.stack([right, up, way])
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-6)
    assert abs(right[1]) < 1e-9


@settings(max_examples=50, deadline=None)
@given(st.lists(st.tuples(st.booleans(), st.sampled_from((16, 32, 64, 128))), max_size=120))
def test_tiles_never_overlap_and_all_room_comes_back(steps: list[tuple[bool, int]]) -> None:
    space = TileSpace(256, 16)
    taken: list[tuple[int, int, int]] = []
    used = np.zeros((256, 256), bool)
    for give, side in steps:
        if give and taken:
            x, y, s = tile = taken.pop(len(taken) // 2)
            used[x : x + s, y : y + s] = False
            space.give(tile)
            continue
        found = space.take(side)
        if found is None:
            continue
        x, y, s = found
        assert s == side
        assert x % s == y % s == 0
        assert not used[x : x + s, y : y + s].any()
        used[x : x + s, y : y + s] = True
        taken.append(found)
    for tile in taken:
        space.give(tile)
    assert space.take(256) == (0, 0, 256)


def test_a_value_that_all_seeds_share_is_spread_evenly_and_a_step_becomes_a_ramp() -> None:
    centers = np.array([[-200.0, 0.0, 0.0], [200.0, 0.0, 0.0]])
    sizes = np.full((2, 3), 400.0)
    x = np.linspace(-300.0, 300.0, 61)
    positions = np.stack([x, 0.0 * x, 0.0 * x], axis=1)
    spread = Spread.over(positions, (x > 0.0).astype(int), centers, sizes)
    even = spread.field(np.array([0.7, 0.7]))
    np.testing.assert_allclose(even[:, 0], 0.7, atol=1e-6)
    np.testing.assert_allclose(even[:, 1:], 0.0, atol=1e-6)
    ramp = spread.field(np.array([0.0, 1.0]))
    assert ramp[0, 0] < 0.1 < 0.9 < ramp[-1, 0]
    assert np.abs(np.diff(ramp[:, 0])).max() < 0.2
    # The slope is the field's own derivative, away from the little jump between two seeds' shares.
    slope = np.gradient(ramp[:, 0], x)
    inner = np.abs(x) > 30.0
    np.testing.assert_allclose(ramp[inner, 1], slope[inner], atol=4e-4)


def test_huge_clouds_keep_their_seeds_values() -> None:
    centers = np.zeros((3000, 3))
    seed = np.arange(3000)
    spread = Spread.over(np.zeros((3000, 3)), seed, centers, np.ones((3000, 3)))
    assert spread.weights is None
    np.testing.assert_allclose(spread.field(seed / 3000.0)[:, 0], seed / 3000.0, atol=1e-6)
