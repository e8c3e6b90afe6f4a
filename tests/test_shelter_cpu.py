"""Shelter on the CPU: what stands over a point along the fall, against rays and the GPU's map."""

from __future__ import annotations

import itertools
import math

import moderngl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.boxes import CORNERS, TRIANGLES, highest, placed
from tests.rain_frames import area, frame
from tests.shelter_shapes import hills
from weather_ecs.frame import OccluderData
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.heightmap import Heightmap
from weather_ecs.gpu.occluder_meshes import OccluderMeshes
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.physics.footprint import fall_slope, fall_speed_over
from weather_ecs.physics.heightfield import FEW, LONGEST, Facets, pieces
from weather_ecs.systems.shelter import MARGIN, ShelterIndex

pytestmark = pytest.mark.usefixtures("world")

HERE = np.eye(4)


def brute(corners: np.ndarray, slope: tuple[float, float], u: float, w: float) -> float:
    """Height of the highest triangle over a place carried to height 0, -inf without one."""
    best = -math.inf
    for triangle in corners.astype(float):
        p = triangle[:, [0, 2]] + triangle[:, 1:2] * np.array(slope)
        matrix = np.vstack([p.T, np.ones(3)])
        if abs(np.linalg.det(matrix)) < 1e-9:
            continue
        share = np.linalg.solve(matrix, (u, w, 1.0))
        if (share >= 0.0).all():
            best = max(best, float(share @ triangle[:, 1]))
    return best


slopes = st.tuples(st.floats(-2, 2), st.floats(-2, 2))


@settings(deadline=None, max_examples=60)
@given(st.integers(1, FEW), st.integers(0, 1000), slopes)
def test_few_triangles_are_exact(count, seed, slope):
    rng = np.random.default_rng(seed)
    corners = rng.uniform(-3, 3, (count, 3, 3))
    vertices, indices = corners.reshape(-1, 3).astype(np.float32), np.arange(3 * count)
    (piece,) = pieces(vertices, indices)
    facets = Facets(piece, np.eye(3), slope)
    for u, w in rng.uniform(-6, 6, (20, 2)):
        top = brute(vertices[indices].reshape(-1, 3, 3), slope, u, w)
        if math.isfinite(top):
            assert facets.cover(u, w, top - 1e-3)
            assert not facets.cover(u, w, top + 1e-3)
        else:
            assert not facets.cover(u, w, -100.0)


@settings(deadline=None, max_examples=15)
@given(st.integers(0, 1000), slopes)
def test_many_triangles_are_right_to_half_a_cell(seed, slope):
    vertices, indices = hills(8, 10.0, seed)
    (piece,) = pieces(vertices, indices)
    facets = Facets(piece, np.eye(3), slope)
    triangles = vertices[indices].reshape(-1, 3, 3)
    rng = np.random.default_rng(seed)
    near = np.linspace(-0.36, 0.36, 5)  # half a cell's diagonal
    for x, z in rng.uniform(-4.0, 4.0, (5, 2)):
        tops = [brute(triangles, slope, x + dx, z + dz) for dx in near for dz in near]
        if not all(map(math.isfinite, tops)):
            continue
        # Between the samples; where a slanted fall folds the hills, their height is steep.
        slack = 0.1 * (1.0 + math.hypot(*slope))
        assert facets.cover(x, z, min(tops) - slack)
        assert not facets.cover(x, z, max(tops) + slack)


def test_pieces_are_the_mesh_cut_up():
    vertices, indices = hills(40, 200.0)
    found = pieces(vertices, indices)
    assert len(found) > 30
    whole = {tuple(t.ravel()) for t in vertices[indices].reshape(-1, 3, 3).astype(float)}
    parts = [tuple(t.ravel()) for piece in found for t in piece.corners]
    assert len(parts) == len(whole) == len(set(parts)) and set(parts) == whole
    for piece in found:
        assert 2.0 * piece.half.max() <= LONGEST or len(piece.corners) <= FEW
        np.testing.assert_allclose(piece.corners.max((0, 1)), piece.middle + piece.half)
    assert len(pieces(vertices, indices, 0.05)) == 1


def test_large_triangles_on_top_of_each_other_stay_exact():
    star = np.array([(100, 0, 0), (-100, 0, 50), (-100, 0, -50)], np.float32)
    vertices = np.concatenate([star] * (2 * FEW))
    found = pieces(vertices, np.arange(len(vertices)))
    assert all(len(piece.corners) <= FEW for piece in found)
    for piece in found:
        facets = Facets(piece, np.eye(3), (0.0, 0.0))
        assert facets.cover(0.0, 24.9, -0.1)
        assert not facets.cover(0.0, 25.1, -0.1)


def boxes(seed: int, count: int, dynamic: bool = False) -> list[OccluderData]:
    rng = np.random.default_rng(seed)
    made = []
    for k in range(count):
        center = (rng.uniform(-40, 40), rng.uniform(-2, 15), rng.uniform(-40, 40))
        size = tuple(rng.uniform(0.5, 6.0, 3).tolist())
        transform = placed(center, size, rng.uniform(-3, 3), rng.uniform(-0.6, 0.6))
        made.append(OccluderData(k, transform, dynamic, CORNERS, TRIANGLES))
    return made


def known(index: ShelterIndex, points: np.ndarray) -> np.ndarray:
    return np.array([index.covers(*point) for point in points.tolist()])


@pytest.mark.parametrize("slope", [(0.0, 0.0), (0.8, -0.34), (-2.0, 1.5)])
def test_boxes_shelter_what_lies_below_them_along_the_fall(slope):
    still, moving = boxes(1, 60), boxes(2, 20, True)
    index = ShelterIndex()
    index.update((*still, *moving), slope, 0.0)
    points = np.random.default_rng(3).uniform((-45, -3, -45), (45, 15, 45), (4000, 3))
    at = points[:, [0, 2]] + points[:, 1:2] * np.array(slope)
    top = highest(at, slope, [o.transform for o in (*still, *moving)], MARGIN)
    clear = np.abs(top - points[:, 1] - MARGIN) > 1e-3
    expected = top > points[:, 1] + MARGIN
    np.testing.assert_array_equal(known(index, points)[clear], expected[clear])
    assert 0.1 < expected.mean() < 0.9


def test_what_has_moved_turned_come_or_gone_is_seen():
    index, times = ShelterIndex(), itertools.count()

    def covered(*occluders: OccluderData) -> list[bool]:
        index.update(occluders, (0.0, 0.0), float(next(times)))
        return [index.covers(x, 0.0, 0.0) for x in (0.0, 4.0, 8.0)]

    def long_box(x: float, turn: float, dynamic: bool) -> OccluderData:
        return OccluderData(1, placed((x, 3, 0), (3, 0.1, 0.5), turn), dynamic, CORNERS, TRIANGLES)

    assert covered() == [False] * 3
    for dynamic in (False, True):
        assert covered(long_box(0, 0.0, dynamic)) == [True, False, False]
        assert covered(long_box(6, 0.0, dynamic)) == [False, True, True]
        assert covered(long_box(6, math.pi / 2, dynamic)) == [False, False, False]
        other = long_box(4, 0.0, not dynamic)
        assert covered(long_box(0, 0.0, dynamic), other) == [True, True, False]
        assert covered(other) == [False, True, False]
    assert covered() == [False] * 3


def test_a_changed_mesh_is_another_one():
    index, transform = ShelterIndex(), HERE
    high = CORNERS + np.array((0, 5, 0), np.float32)
    for time, (vertices, expected) in enumerate(((high, True), (high - 50.0, False), (high, True))):
        one = OccluderData(0, transform, False, vertices.astype(np.float32), TRIANGLES)
        index.update((one,), (0.0, 0.0), float(time))
        assert index.covers(0.0, 0.0, 0.0) is expected


def test_callbacks_are_not_seen():
    index = ShelterIndex()
    index.update((OccluderData(0, HERE, True, draw=lambda matrix: None),), (0.0, 0.0), 0.0)
    assert not index.covers(0.0, -5.0, 0.0)


def catch_up(index: ShelterIndex) -> None:
    """Take over what `update` was told, as the first question after it does."""
    assert index._due is not None
    index._catch_up(*index._due)


def test_thousands_move_and_share_one_mesh():
    index, count = ShelterIndex(), 3000
    rng = np.random.default_rng(0)
    at = rng.uniform(-200, 200, (count, 3)) * (1, 0.02, 1) + (0, 6, 0)

    def crowd(shift: float) -> tuple[OccluderData, ...]:
        made = []
        for k, (x, y, z) in enumerate(at.tolist()):
            transform = placed((x + shift, y, z), (1, 0.5, 1))
            made.append(OccluderData(k, transform, k % 2 == 0, CORNERS, TRIANGLES))
        return tuple(made)

    for time, shift in enumerate((0.0, 3.0)):
        index.update(crowd(shift), (0.0, 0.0), float(time))
        catch_up(index)
        assert len(index._meshes._known) == 1
        assert all(index.covers(x + shift, 0.0, z) for x, _, z in at[:200].tolist())
        off = np.abs(at[:, None, [0, 2]] - at[None, :200, [0, 2]] + (50.0, 0.0))
        free = (off.max(axis=2) > 1.01).all(axis=0)
        for (x, _, z), alone in zip(at[:200].tolist(), free, strict=True):
            assert not alone or not index.covers(x - 50.0 + shift, 0.0, z)


def test_a_costly_update_waits_but_no_longer_than_a_tenth_of_a_second():
    index = ShelterIndex()
    index.update(tuple(boxes(1, 5)), (0.0, 0.0), 0.0)
    catch_up(index)
    index._cost = 10_000  # as if so many had been carried along
    here = (OccluderData(9, placed((0, 5, 300), (4, 1, 4)), True, CORNERS, TRIANGLES),)
    index.update(here, (0.0, 0.0), 0.05)
    assert not index.covers(0.0, 0.0, 300.0)
    assert not index.covers(0.0, 0.0, 300.0)
    index.update(here, (0.0, 0.0), 0.11)
    assert index.covers(0.0, 0.0, 300.0)


def test_a_costly_update_does_not_wait_for_a_clock_that_stands_still():
    index = ShelterIndex()
    index.update(tuple(boxes(1, 5)), (0.0, 0.0), 0.0)
    catch_up(index)
    index._cost = 10_000
    here = (OccluderData(9, placed((0, 5, 300), (4, 1, 4)), True, CORNERS, TRIANGLES),)
    index.update(here, (0.0, 0.0), 0.05)
    assert not index.covers(0.0, 0.0, 300.0)
    index.update(here, (0.0, 0.0), 0.05)
    assert index.covers(0.0, 0.0, 300.0)


def test_facets_that_are_not_ready_are_stood_in_for_within_the_budget():
    vertices, indices = hills(10, 12.0)
    index = ShelterIndex()
    one = OccluderData(0, placed((0, 5, 0), (1, 1, 1)), True, vertices, indices)
    index.update((one,), (0.0, 0.0), 0.0)
    assert index.covers(0.0, 0.0, 0.0)
    turned = OccluderData(0, placed((100, 5, 0), (1, 1, 1), 0.5), True, vertices, indices)
    index.update((turned,), (0.0, 0.0), 1.0)
    catch_up(index)
    index._facets.spent = 10_000
    before = len(index._facets._known)
    assert index.covers(100.0, 0.0, 0.0)  # where it is, as it was turned before
    assert len(index._facets._known) == before
    index.update((turned,), (0.02, 0.0), 2.0)
    assert index.covers(100.0, 0.0, 0.0)
    assert len(index._facets._known) == before + 1


@pytest.mark.parametrize("wind", [(0.0, 0.0, 0.0), (7.0, 0.0, -3.0)])
def test_cpu_and_gpu_agree(ctx: moderngl.Context, wind: tuple[float, float, float]) -> None:
    ground = OccluderData(99, HERE, False, *hills(6, 90.0))
    occluders = (*boxes(5, 40), *boxes(6, 10, True), ground)
    data = frame(area(rain_rate=25.0), wind=wind, occluders=occluders)
    speed = fall_speed_over(data.areas["rain_rate"])
    size, reach = 512, 24.0
    guard, shaders = StateGuard(ctx), ShaderLoader(ctx)
    meshes = OccluderMeshes(ctx, shaders)
    heightmap = Heightmap(ctx, guard, meshes, size)
    try:
        with guard:
            heightmap.capture(occluders, (0.0, 2.0, 0.0), reach, wind, speed)
        depth = np.frombuffer(heightmap.texture.read(), np.float32).reshape(size, size)
        place = heightmap.footprint
    finally:
        for thing in (heightmap, meshes, shaders, guard):
            thing.release()
    assert place is not None and place.slope == fall_slope(wind, speed)
    index = ShelterIndex()
    index.update(occluders, place.slope, 0.0)
    points = np.random.default_rng(0).uniform((-15, 0, -15), (15, 9, 15), (3000, 3))
    m = points @ place.matrix()[:3, :3].T + place.matrix()[:3, 3]
    i, j = (m[:, :2] * size).astype(int).T
    around = np.stack([depth[j + a, i + b] for a in (-1, 0, 1) for b in (-1, 0, 1)])
    below = (m[:, 2] - around) * (place.top - place.bottom)
    # Away from edges, and from surfaces the point lies close to, there is no doubt.
    sure = (below > MARGIN + 0.1).all(axis=0) | (below < MARGIN - 0.1).all(axis=0)
    assert sure.mean() > 0.7
    np.testing.assert_array_equal(known(index, points)[sure], (below[4] > MARGIN)[sure])
