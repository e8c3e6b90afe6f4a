"""Shelter on the CPU: what stands over a point along the fall, against rays and the GPU's map."""

from __future__ import annotations

import itertools
import math

import esper
import moderngl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.boxes import CORNERS, TRIANGLES, highest, placed
from tests.rain_frames import area, frame
from weather_ecs import Weather
from weather_ecs.components import CollisionHeightmap, Occluder, RainArea, Wind
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


def hills(n: int, size: float, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """An uneven ground of n by n quads."""
    rng = np.random.default_rng(seed)
    at = np.linspace(-size / 2, size / 2, n + 1)
    x, z = np.meshgrid(at, at)
    vertices = np.stack([x, rng.uniform(0.0, 0.3 * size / n, x.shape), z], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(n), np.arange(n))
    a = (j * (n + 1) + i).ravel()
    quads = np.stack([a, a + n + 1, a + 1, a + 1, a + n + 1, a + n + 2], 1)
    return vertices.astype(np.float32), quads.reshape(-1).astype(np.uint32)


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


# What the game asks


def roof(x: float = 0.0, y: float = 3.0, z: float = 0.0, **rest: object) -> Occluder:
    """Six by four metres."""
    return Occluder(CORNERS, TRIANGLES, placed((x, y, z), (3, 0.05, 2)), **rest)  # type: ignore[arg-type]


def test_a_sample_under_a_roof_is_dry_and_right_within_a_metre_of_its_edge():
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    esper.create_entity(roof())
    for _ in range(40):
        esper.process(0.5)
    for y in (0.0, 1.7, 2.6):
        for edge, step in ((3.0, (1, 0)), (2.0, (0, 1))):
            for sign in (-1, 1):
                for away, covered in ((-0.1, True), (0.1, False)):
                    x, z = (sign * (edge + away) * s for s in step)
                    got = weather.sample((x, y, z))
                    assert got.sheltered is covered
                    assert got.rain_rate == (0.0 if covered else 25.0)
                    assert (got.wetness == 0.0) is covered
                    assert got.visibility < 5000.0  # what one sees through is outside
    above = weather.sample((0, 3.1, 0))
    assert not above.sheltered and above.rain_rate == 25.0


def test_the_dry_place_moves_downwind_of_its_roof():
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    esper.create_entity(Wind((0, 1), 8.0))
    esper.create_entity(roof(y=5.0))
    slope = 8.0 / fall_speed_over(np.array([25.0]))
    shift = 5.0 * slope
    assert not weather.sample((0, 0, 0)).sheltered  # it blows in under the windward edge
    assert weather.sample((0, 0, shift)).sheltered
    assert weather.sample((0, 0, shift + 1.8)).sheltered
    assert not weather.sample((0, 0, shift + 2.3)).sheltered
    assert weather.sample((0, 4.6, 0.4)).sheltered


def test_a_sample_knows_what_has_moved_a_quarter_of_a_second_ago():
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (90, 90), 25.0))
    cart = roof(dynamic=True)
    esper.create_entity(cart)
    assert weather.sample((0, 0, 0)).sheltered
    for k in range(1, 40):
        cart.transform = placed((k, 3.0, 0), (3, 0.05, 2))
        for _ in range(5):
            esper.process(0.05)
        assert weather.sample((k + 2.5, 0, 0)).sheltered
        assert not weather.sample((k - 3.5, 0, 0)).sheltered


@pytest.mark.parametrize("many", [False, True])
def test_who_stands_behind_a_wall_is_dry_in_any_wind(many):
    # Rain of more than 45 degrees goes over the wall, or meets it less than MARGIN above the point.
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    esper.create_entity(Wind((1, 0), 12.0))
    parts = [placed((0.0, 1.4, 0.0), (0.08, 1.4, 8.0))]
    parts += [placed((30.0 + k, 0.5, 0.0), (0.1, 0.5, 0.1)) for k in range(4 if many else 0)]
    corners = np.concatenate([CORNERS @ m[:3, :3].T + m[:3, 3] for m in parts])
    faces = np.concatenate([TRIANGLES + len(CORNERS) * k for k in range(len(parts))])
    esper.create_entity(Occluder(corners, faces))
    esper.process(0.1)
    for away in (0.16, 0.3, 0.6):
        for y in (0.0, 0.8, 1.6):
            assert weather.sample((away, y, 0.5)).sheltered, (away, y)
            assert not weather.sample((-away, y, 0.5)).sheltered, (away, y)
    assert not weather.sample((0.3, 2.75, 0.5)).sheltered
    assert not weather.sample((6.5, 0.8, 0.5)).sheltered
    # Ground counts only from MARGIN on, as it may be coarser than what is drawn.
    esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((0, -0.9, 20), (20, 1.0, 10))))
    esper.process(0.1)
    assert not weather.sample((0.0, 0.0, 20.0)).sheltered


def test_rain_passes_what_lies_on_layers_it_ignores():
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    leaves = roof(layers=0b100)
    esper.create_entity(leaves)
    rule = CollisionHeightmap(layers=0b011)
    entity = esper.create_entity(rule)
    assert not weather.sample((0, 0, 0)).sheltered
    leaves.layers = 0b110
    assert weather.sample((0, 0, 0)).sheltered
    rule.layers = 0
    assert not weather.sample((0, 0, 0)).sheltered
    esper.delete_entity(entity)
    assert weather.sample((0, 0, 0)).sheltered


def test_thousands_of_occluders_come_and_go_without_a_trace():
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    for k in range(2000):
        entity = esper.create_entity(roof(dynamic=bool(k % 2)))
        if k % 20 == 0:
            esper.process(0.05)
            weather.sample((0, 0, 0))
        esper.delete_entity(entity, immediate=bool(k % 3))
    esper.process(0.2)
    assert not weather.sample((0, 0, 0)).sheltered
    weather._shelter._meshes.keep_used()
    assert len(weather._shelter._meshes._known) < 200
    assert len(weather._shelter._facets._known) <= 4096
