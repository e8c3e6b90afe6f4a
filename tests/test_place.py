"""The place: what can be asked of it, and that its meshes are whole."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from demo_game.collision import Colliders
from demo_game.place import Place, bake, cabin, flora, jetty, layout
from demo_game.place.ground_mesh import drowned
from demo_game.place.mesh import Builder
from demo_game.place.noise import Noise
from demo_game.place.windmill import HUB, REACH
from demo_game.player import Intent, Player

WALKER = 0.3  # m, radius
EYE = 1.7  # m


@pytest.fixture(scope="module")
def colliders(place: Place) -> Colliders:
    return Colliders.of(place.colliders)


coordinate = st.floats(-150.0, 100.0)


@given(x=coordinate, z=coordinate)
@settings(max_examples=200, deadline=None)
def test_height_is_the_same_for_scalars_and_arrays(place: Place, x: float, z: float) -> None:
    found = place.height(np.array([x, x]), np.array([z, z]))
    assert found.shape == (2,)
    assert place.height(x, z) == pytest.approx(found[0], abs=1e-9)


@given(x=coordinate, z=coordinate, turn=st.floats(0.0, 6.3))
@settings(max_examples=200, deadline=None)
def test_height_is_continuous_and_gentle(place: Place, x: float, z: float, turn: float) -> None:
    step = 0.05
    other = place.height(x + step * np.cos(turn), z + step * np.sin(turn))
    assert abs(other - place.height(x, z)) < step * 1.2  # nowhere steeper than 50 degrees


def test_height_is_the_drawn_ground(place: Place) -> None:
    ground = place.ground
    count = place.terrain.heights.size
    x, y, z = ground.vertices[:count].T.astype("f8")
    assert np.allclose(place.height(x, z), y, atol=1e-3)


def test_another_seed_is_another_ground_and_the_same_seed_the_same() -> None:
    assert Place(3).height(31.0, -12.0) == Place(3).height(31.0, -12.0)
    assert Place(3).height(31.0, -12.0) != Place(4).height(31.0, -12.0)


def test_the_path_leads_from_the_start_to_the_mailbox(place: Place) -> None:
    assert np.hypot(*(place.path[0] - (0.0, 90.0))) < 10.0
    assert np.hypot(*(place.path[-1] - np.array(layout.MAILBOX))) < 2.5
    assert np.linalg.norm(np.diff(place.path, axis=0), axis=1).max() < 4.0


def test_nothing_stands_on_the_path(place: Place, colliders: Colliders) -> None:
    for x, z in place.path[2:-1]:
        ground = place.height(float(x), float(z))
        assert colliders.is_free(float(x), float(z), WALKER, ground + 0.3, ground + EYE), (x, z)


def test_the_door_lets_one_through_and_the_walls_do_not(place: Place, colliders: Colliders) -> None:
    x, floor, z = place.door
    low, high = floor + 0.3, floor + EYE
    for dz in np.linspace(1.9, -2.2, 42):
        assert colliders.is_free(x, z + dz, WALKER, low, high), dz
    for dx in (-2.0, -1.2, 1.2, 2.8):
        assert not colliders.is_free(x + dx, z - cabin.WALL / 2.0, WALKER, low, high), dx
    middle_x, _, middle_z = place.room
    for side in (-1.0, 1.0):
        wall = middle_x + side * (cabin.WIDTH / 2.0 - cabin.WALL / 2.0)
        assert not colliders.is_free(wall, middle_z, WALKER, low, high)


def test_steps_lead_up_to_the_floor(place: Place) -> None:
    x, floor, z = place.door
    feet = place.height(x, z + 4.5)
    for along in np.linspace(z + 4.5, z - 1.0, 80):
        height = place.floor_height(x, float(along), feet)
        assert height - feet < 0.45  # never more than a step
        feet = height
    assert feet == pytest.approx(floor)
    assert place.floor_height(*place.room[::2], floor) == pytest.approx(floor)


def test_under_the_floor_is_ground(place: Place) -> None:
    x, floor, z = place.room
    assert place.floor_height(x, z, floor - 2.0) == pytest.approx(place.height(x, z))


def test_the_pond_is_a_hollow_below_its_level(place: Place) -> None:
    (x, z), (a, b), level = place.pond
    assert place.height(x, z) < level - 0.8
    for turn in np.linspace(0.0, 6.2, 40):
        shore_x, shore_z = x + 1.6 * a * np.cos(turn), z + 1.6 * b * np.sin(turn)
        assert place.height(shore_x, shore_z) > level - 0.05


def test_what_lies_below_the_pond_is_told_from_the_rest(place: Place) -> None:
    level = place.pond.level
    x, z = place.pond.center
    far = layout.CABIN
    points = [(x, level + up, z) for up in (-0.6, 0.2, 0.0)] + [(far[0], level - 5.0, far[1])]
    found = drowned(place.terrain, np.array(points))
    assert found[:3] == pytest.approx([0.6, -0.2, 0.0], abs=1e-9)
    assert found[3] == -np.inf  # low ground elsewhere is dry
    # Where the sheet of water ends the ground crosses its level, between vertices that know both.
    deep = drowned(place.terrain, place.ground.vertices)
    near = place.terrain.pond_radius(*place.ground.vertices.T[[0, 2]].astype("f8"))
    assert (deep[near < 0.9] > 0.0).all()
    assert np.isfinite(deep[(near > 1.0) & (near < 1.5)]).all()


def test_lamps_hang_above_the_ground_near_the_path(place: Place) -> None:
    posts = place.lamps[: len(layout.LAMPS)]
    assert 5 <= len(posts) <= 8
    for (x, y, z), color, reach in posts:
        assert 2.5 < y - place.height(x, z) < 4.0
        assert np.hypot(*(place.path - (x, z)).T).min() < 4.0
        assert min(color) > 0.0 and reach > 0.0


def test_the_figure_walks_a_closed_round_at_an_even_pace(place: Place) -> None:
    lap = place.walk.length / 1.15
    start, end = np.array(place.figure_position(0.0)), np.array(place.figure_position(lap))
    assert np.allclose(start[:3], end[:3], atol=0.02)
    times = np.arange(0.0, lap, 0.05)
    track = np.array([place.figure_position(t)[:3] for t in times])
    pace = np.linalg.norm(np.diff(track, axis=0), axis=1) / 0.05
    assert (pace > 0.9).all() and (pace < 1.5).all()
    assert np.allclose(track[:, 1], place.height(track[:, 0], track[:, 2]))


def test_the_figure_meets_no_obstacle(place: Place, colliders: Colliders) -> None:
    for t in np.arange(0.0, 60.0, 0.5):
        x, y, z, _ = place.figure_position(t)
        assert colliders.is_free(x, z, 0.25, y + 0.3, y + EYE), t


def test_poses_are_rigid_and_the_feet_stay_near_the_ground(place: Place) -> None:
    for t in np.linspace(0.0, 5.0, 40):
        poses = place.poses(t)
        for pose in poses.values():
            assert np.allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3), atol=1e-9)
            assert np.linalg.det(pose[:3, :3]) == pytest.approx(1.0)
        ground = place.figure_position(t)[1]
        soles = [(poses[f"figure/shin_{s}"] @ (0.0, -0.42, 0.0, 1.0))[1] - ground for s in "lr"]
        assert -0.06 < min(soles) < 0.12
        assert poses["figure/head"][1, 3] - ground > 1.3


def test_the_sails_turn_and_clear_the_ground(place: Place) -> None:
    first, later = place.mover_pose(0.0)["sails"], place.mover_pose(1.0)["sails"]
    assert not np.allclose(first, later)
    assert np.allclose(first[:3, 3], later[:3, 3])
    assert HUB[1] - REACH > 2.5


def test_meshes_are_whole(place: Place) -> None:
    for name, mesh in place.meshes.items():
        count = len(mesh.vertices)
        assert mesh.indices.min() >= 0 and mesh.indices.max() < count, name
        assert np.isfinite(mesh.vertices).all() and np.isfinite(mesh.uvs).all(), name
        assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-3), name
        assert (mesh.colors >= 0.0).all() and (mesh.colors <= 1.0).all(), name
        assert (mesh.ambient >= 0.0).all() and (mesh.ambient <= 1.001).all(), name
        assert (mesh.lamp >= 0.0).all(), name


@pytest.mark.parametrize(
    "name", ["cabin", "room", "lamps", "windmill", "mailbox", "jetty", "figure"]
)
def test_triangles_face_the_way_their_normals_do(place: Place, name: str) -> None:
    mesh = place.meshes[name]
    a, b, c = mesh.vertices[mesh.indices].transpose(1, 0, 2)
    face = np.cross(b - a, c - a)
    area = np.linalg.norm(face, axis=1)
    agree = np.einsum("ij,ij->i", face, mesh.normals[mesh.indices].sum(1))
    assert (agree[area > 1e-6] > 0.0).all()


def test_no_drawn_thing_hangs_in_the_air(place: Place) -> None:
    for name in ("lamps", "fences", "rocks", "mailbox", "windmill", "yard", "jetty"):
        mesh = place.meshes[name]
        x, y, z = mesh.vertices.T.astype("f8")
        assert (y - place.height(x, z)).min() < 0.0, name
    foot = place.trees.foot
    assert (foot[:, 1] < place.height(foot[:, 0], foot[:, 2])).all()


def test_one_walks_out_on_the_jetty_and_the_rain_ends_on_it(
    place: Place, colliders: Colliders
) -> None:
    (low, high), z = layout.JETTY
    player = Player(place, colliders)
    player.place_at(high + 1.5, z, yaw=0.5 * math.pi)  # looks along -x
    for _ in range(400):
        if player.position[0] < low + 0.6:
            break
        player.update(1.0 / 60.0, Intent(forward=1.0))
        x, y, _ = player.position
        assert y > place.pond.level - 0.02
        if low < x < high - 0.3:
            assert y == pytest.approx(place.pond.level + jetty.ABOVE_WATER)
    else:
        pytest.fail("stopped on the way")
    assert place.height(low + 0.6, z) < place.pond.level - 0.5  # there is water below
    mesh = place.meshes["jetty"]
    assert len(mesh.indices) < 150
    shape = {shape.name: shape for shape in place.occluders()}["jetty"]
    assert not shape.dynamic and len(shape.indices) == 12
    for side in (shape.vertices, mesh.vertices):
        assert side[:, 1].max() > place.pond.level + 0.3
    # What rain meets is the deck as it is drawn, to a few centimetres.
    drawn = mesh.vertices[np.abs(mesh.vertices[:, 1] - shape.vertices[:, 1].max()) < 0.02]
    for axis in (0, 2):
        assert np.ptp(drawn[:, axis]) == pytest.approx(np.ptp(shape.vertices[:, axis]), abs=0.1)


def test_ground_chunks_cover_the_whole_grid_once_in_both_levels(place: Place) -> None:
    ground = place.ground
    cells = (len(place.terrain.xs) - 1) * (len(place.terrain.zs) - 1)
    near = ground.chunks[: np.searchsorted(np.cumsum(ground.chunks[:, 1]), 2 * cells) + 1]
    for ranges in (near, ground.coarse[: len(near)]):
        area = 0.0
        for first, count in ranges:
            a, b, c = ground.vertices[ground.indices[first : first + count]].transpose(1, 0, 2)
            area += float(np.cross(b - a, c - a)[:, 1].astype("f8").sum()) / 2.0
        xs, zs = place.terrain.xs, place.terrain.zs
        assert area == pytest.approx((xs[-1] - xs[0]) * (zs[-1] - zs[0]), rel=1e-4)


def test_ground_faces_up_and_reaches_the_hills(place: Place) -> None:
    ground = place.ground
    a, b, c = ground.vertices[ground.indices[: ground.chunks.sum(1).max()]].transpose(1, 0, 2)
    assert (np.cross(b - a, c - a)[:, 1] > 0.0).all()
    far = np.hypot(ground.vertices[:, 0], ground.vertices[:, 2])
    assert far.max() > 2000.0
    assert ground.vertices[far > 1000.0, 1].max() > 60.0


def test_occluders_keep_the_room_dry(place: Place) -> None:
    shapes = {shape.name: shape for shape in place.occluders()}
    assert {"ground", "cabin", "cabin_roof", "trees", "sails", "figure/torso"} <= set(shapes)
    for shape in shapes.values():
        assert shape.indices.max() < len(shape.vertices)
        assert shape.dynamic == (shape.name in place.poses(0.0))
    roof = shapes["cabin_roof"].vertices
    x, floor, _ = place.room
    assert roof[:, 1].min() > floor + 1.8
    assert roof[:, 0].min() < x - 3.0 and roof[:, 0].max() > x + 3.0
    assert roof[:, 2].max() > place.door[2] + 2.0  # over the porch too


def crosses(triangles: np.ndarray, start: np.ndarray, way: np.ndarray) -> bool:
    """Whether a segment meets any of (n, 3, 3) triangles."""
    a, ab, ac = triangles[:, 0], *(triangles[:, 1:] - triangles[:, :1]).transpose(1, 0, 2)
    normal = np.cross(ab, ac)
    det = -(normal @ way)
    safe = np.where(np.abs(det) < 1e-12, 1.0, det)
    off = start - a
    t, turn = (off * normal).sum(axis=1) / safe, np.cross(off, way)
    u, v = (ac * turn).sum(axis=1) / safe, -(ab * turn).sum(axis=1) / safe
    inside = (t >= 0.0) & (t <= 1.0) & (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)
    return bool((inside & (np.abs(det) > 1e-12)).any())


def test_no_rain_comes_in_by_the_windows(place: Place) -> None:
    shape = {shape.name: shape for shape in place.occluders()}["cabin"]
    triangles = shape.vertices[shape.indices].astype(float)
    for opening in [*cabin.WINDOWS, cabin.DOOR]:
        wall, low, high, first, last = opening
        out, along, _, away = cabin.WALLS[wall]
        middle = place.cabin_origin + out * away + along * (low + high) / 2.0
        middle = middle + np.array([0.0, 0.5 * (first + last) * cabin.ROW, 0.0])
        assert crosses(triangles, middle + 0.2 * out, -0.5 * out) == (opening != cabin.DOOR)


def test_no_rain_comes_in_by_the_roof(place: Place) -> None:
    """Nor by its ridge, its eaves over the walls, or between it and the porch's."""
    shapes = {shape.name: shape for shape in place.occluders()}
    shape = shapes["cabin_roof"]
    triangles = shape.vertices[shape.indices].astype(float)
    rng = np.random.default_rng(3)
    half = 0.5 * np.array([cabin.WIDTH, 0.0, cabin.DEPTH]) - (0.1, 0.0, 0.1)
    points = rng.uniform(-half, half, (250, 3))
    points[:100, 2] = rng.uniform(-0.06, 0.06, 100)  # under the ridge
    points[100:150, 2] = rng.uniform(half[2] - 0.1, half[2] + 0.5, 50)  # where the porch begins
    up = np.array([0.0, 20.0, 0.0])
    for point in points:
        assert crosses(triangles, place.cabin_origin + point + (0.0, 0.4, 0.0), up), point


def test_sky_light_under_a_roof_and_in_the_open() -> None:
    roof = Builder()
    roof.box((0.0, 2.0, 0.0), (8.0, 0.2, 8.0), (0.5, 0.5, 0.5))
    block = bake.Block(np.array([0.0, 2.0, 0.0]), np.array([8.0, 0.2, 8.0]), np.eye(3))
    up = np.array([[0.0, 1.0, 0.0]] * 2)
    points = np.array([[0.0, 0.0, 0.0], [40.0, 0.0, 0.0]])
    covered, free = bake.sky_seen(points, up, [block], rays=200)
    assert free == 1.0
    # A square of half side a at height h: cosine-weighted share by the form factor of a plate.
    a = 4.0 / 1.9
    s = a / np.sqrt(1.0 + a * a)
    assert covered == pytest.approx(1.0 - 4.0 / np.pi * s * np.arctan(s), abs=0.04)


@pytest.mark.parametrize("level", range(flora.LEVELS))
def test_trees_are_a_metre_tall_and_get_simpler(place: Place, level: int) -> None:
    for shape in range(9):
        mesh = place.tree_mesh(shape, level)
        assert 0.85 < mesh.vertices[:, 1].max() < 1.12
        if level:
            assert len(mesh.indices) < len(place.tree_mesh(shape, level - 1).indices)


def test_noise_repeats_and_stays_in_range() -> None:
    noise = Noise(7)
    x, y = np.random.default_rng(0).uniform(-300.0, 300.0, (2, 1000))
    value = noise(x, y)
    assert np.abs(value).max() <= 1.0
    assert np.allclose(value, noise(x + 256.0, y - 256.0))
