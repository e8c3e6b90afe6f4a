"""The game's own renderer: pictures that make sense, and nothing left behind."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from demo_game.place import Place
from demo_game.place.foliage import SOLID, leaf_levels
from demo_game.place.mesh import Mesh
from demo_game.render import Environment, SceneRenderer, geometry, programs
from demo_game.render.frame_block import FRAME_DTYPE, as_matrix
from demo_game.render.shadows import HIGH, LOW, light_matrix
from demo_game.render.sky_dome import GLARE, glare_frame
from tests.demo_views import look, perspective
from weather_ecs.errors import InvalidValueError

SIZE = (160, 90)
DRY = Environment(lamps=0.3)
RAIN = replace(DRY, rain_areas=[((0.0, -70.0), (70.0, 45.0), 0.0, 10.0, 62.0)])
Keep = Callable[[Any], Any]


@pytest.fixture
def target(ctx: moderngl.Context, keep: Keep) -> moderngl.Framebuffer:
    color, depth = keep(ctx.texture(SIZE, 4)), keep(ctx.depth_renderbuffer(SIZE))
    return keep(ctx.framebuffer([color], depth))


@pytest.fixture
def scene(ctx: moderngl.Context, place: Place) -> Iterator[SceneRenderer]:
    renderer = SceneRenderer(ctx, place, "low")
    yield renderer
    renderer.release()


def start(place: Place) -> NDArray:
    eye = (0.0, place.height(0.0, 74.0) + 1.7, 74.0)
    return look(eye, (0.0, eye[1] + 0.5, -70.0))


def picture(
    scene: SceneRenderer,
    target: moderngl.Framebuffer | None,
    view: NDArray,
    environment: Environment = DRY,
    time: float = 5.0,
) -> NDArray:
    """(height, width, 3) of 0 to 255, the top row first."""
    scene.draw(target, view, perspective(), time, environment)
    bound = target if target is not None else scene.ctx.fbo
    raw = np.frombuffer(bound.read(components=3, alignment=1), "u1")
    return raw.reshape(SIZE[1], SIZE[0], 3)[::-1].astype("f8")


def test_sky_above_ground_below(
    scene: SceneRenderer, target: moderngl.Framebuffer, place: Place
) -> None:
    found = picture(scene, target, start(place))
    sky, ground = found[:20], found[70:]
    assert sky.mean() > ground.mean() + 15.0
    assert ground[..., 1].mean() > ground[..., 2].mean() + 15.0  # grass is not blue
    assert sky[..., 2].mean() >= sky[..., 0].mean() - 5.0
    assert found.std() > 20.0
    assert not (found == 0.0).all(axis=2).any()  # no hole shows the clear colour


def test_no_hole_in_the_ground_whichever_way_one_looks(
    scene: SceneRenderer, target: moderngl.Framebuffer, place: Place
) -> None:
    eye = (10.0, place.height(10.0, -20.0) + 12.0, -20.0)
    for turn in np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False):
        at = (eye[0] + np.sin(turn), eye[1] - 0.9, eye[2] + np.cos(turn))
        scene.draw(target, look(eye, at), perspective(), 5.0, DRY)
        depth = np.frombuffer(target.read(attachment=-1, dtype="f4", components=1), "f4")
        assert (depth.reshape(SIZE[1], SIZE[0])[: SIZE[1] // 2] < 1.0).all(), turn


def test_none_draws_into_what_is_bound(
    scene: SceneRenderer, target: moderngl.Framebuffer, place: Place
) -> None:
    first = picture(scene, target, start(place))
    target.use()
    scene.draw(None, start(place), perspective(), 5.0, DRY)
    raw = np.frombuffer(target.read(components=3, alignment=1), "u1")
    assert np.array_equal(raw.reshape(SIZE[1], SIZE[0], 3)[::-1], first)


def test_no_state_of_the_host_is_taken_for_granted(
    ctx: moderngl.Context, scene: SceneRenderer, target: moderngl.Framebuffer, place: Place
) -> None:
    first = picture(scene, target, start(place))
    ctx.enable_only(moderngl.BLEND | moderngl.CULL_FACE)
    ctx.depth_func, ctx.front_face, ctx.cull_face = ">", "cw", "front"
    ctx.blend_func = moderngl.ZERO, moderngl.ONE
    ctx.blend_equation = moderngl.FUNC_SUBTRACT
    ctx.wireframe = True
    target.scissor = (0, 0, 20, 20)
    target.depth_mask = False
    again = picture(scene, target, start(place))
    ctx.depth_func, ctx.front_face, ctx.cull_face = "<", "ccw", "back"
    ctx.blend_equation = moderngl.FUNC_ADD
    assert np.abs(again - first).max() <= 2.0


def test_matrices_as_pyglet_gives_them(
    scene: SceneRenderer, target: moderngl.Framebuffer, place: Place
) -> None:
    view = start(place)
    first = picture(scene, target, view)
    flat = tuple(view.T.ravel())
    assert np.array_equal(as_matrix(flat), view)
    scene.draw(target, flat, tuple(perspective().T.ravel()), 5.0, DRY)
    raw = np.frombuffer(target.read(components=3, alignment=1), "u1")
    assert np.array_equal(raw.reshape(SIZE[1], SIZE[0], 3)[::-1], first)


def test_two_renderers_draw_the_same(
    ctx: moderngl.Context, scene: SceneRenderer, target: moderngl.Framebuffer, place: Place
) -> None:
    first = picture(scene, target, start(place), RAIN)
    other = SceneRenderer(ctx, place, "low")
    assert np.array_equal(picture(other, target, start(place), RAIN), first)
    other.release()
    other.release()  # a second time does nothing


def test_a_rain_area_darkens_its_sky_and_its_ground(
    scene: SceneRenderer, target: moderngl.Framebuffer, place: Place
) -> None:
    dry, wet = (picture(scene, target, start(place), env) for env in (DRY, RAIN))
    middle = np.s_[:12, 60:100]
    assert wet[middle].mean() < dry[middle].mean() - 8.0
    assert abs(wet[60:].mean() - dry[60:].mean()) < 10.0  # not where the sun still shines
    eye = (0.0, place.height(0.0, -45.0) + 1.7, -45.0)
    inside = look(eye, (0.0, eye[1] - 1.0, -49.0))
    dry, wet = (picture(scene, target, inside, env) for env in (DRY, RAIN))
    assert wet[60:].mean() < dry[60:].mean() - 15.0
    up = look(eye, (0.0, eye[1] + 5.0, -49.0))
    dry, wet = (picture(scene, target, up, env) for env in (DRY, RAIN))
    assert wet.mean() < dry.mean() - 12.0


def test_wetness_darkens_the_ground(
    scene: SceneRenderer, target: moderngl.Framebuffer, place: Place
) -> None:
    dry = picture(scene, target, start(place))
    wet = picture(scene, target, start(place), replace(DRY, wetness=1.0))
    assert wet[75:].mean() < dry[75:].mean() - 8.0


def test_lamps_light_the_ground_by_night(
    scene: SceneRenderer, target: moderngl.Framebuffer, place: Place
) -> None:
    night = replace(
        DRY,
        sun_color=(0.02, 0.02, 0.03),
        zenith_color=(0.01, 0.01, 0.02),
        horizon_color=(0.02, 0.02, 0.03),
        fog_color=(0.02, 0.02, 0.03),
    )
    (x, y, z), _, _ = place.lamps[1]
    view = look((x, y + 3.0, z + 6.0), (x, y - 3.0, z))
    dark, lit = (picture(scene, target, view, replace(night, lamps=s)) for s in (0.0, 1.0))
    assert lit.mean() > dark.mean() + 6.0
    assert lit[..., 0].mean() > lit[..., 2].mean() + 5.0  # and the light is warm


def test_the_sky_changes_little_by_little(
    scene: SceneRenderer, target: moderngl.Framebuffer, place: Place
) -> None:
    before = picture(scene, target, start(place), RAIN)
    for frame in range(1, 80):  # a map takes 32 frames: two changes of maps fall into this
        eye = (0.0, place.height(0.0, 74.0) + 1.7, 74.0 - 0.05 * frame)
        view = start(place).copy()
        view[:3, 3] = -view[:3, :3] @ eye
        now = picture(scene, target, view, RAIN, 5.0 + frame / 30.0)
        assert np.abs(now[:18] - before[:18]).mean() < 1.5, frame
        before = now


def test_moving_shadows_leave_no_trace(
    scene: SceneRenderer, target: moderngl.Framebuffer, place: Place
) -> None:
    x, y, z, _ = place.figure_position(5.0)
    near = look((x + 6.0, y + 2.0, z + 6.0), (x, y, z))
    for time in (5.0, 6.0, 7.5):
        picture(scene, target, near, time=time)
    shadows = scene._shadows
    still, live = (np.frombuffer(t.read(), "f4") for t in (shadows.still, shadows.live))
    assert np.abs(live - still).max() > 0.01
    away = look((0.0, 300.0, 900.0), (0.0, 0.0, 1000.0))
    picture(scene, target, away, time=8.0)
    still, live = (np.frombuffer(t.read(), "f4") for t in (shadows.still, shadows.live))
    assert np.abs(live - still).max() < 1e-6  # but for the rounding of the copy


@pytest.mark.parametrize("quality", ["medium", "high"])
def test_quality_can_change_at_any_time(
    scene: SceneRenderer, target: moderngl.Framebuffer, place: Place, quality: str
) -> None:
    first = picture(scene, target, start(place))
    scene.quality = quality
    assert scene.quality == quality
    assert np.abs(picture(scene, target, start(place)) - first).mean() < 6.0


def test_an_unknown_quality_is_refused(scene: SceneRenderer) -> None:
    with pytest.raises(InvalidValueError, match="quality"):
        scene.quality = "splendid"
    assert scene.quality == "low"


def test_the_block_is_laid_out_as_the_shader_has_it(scene: SceneRenderer) -> None:
    for defines in ((), ("WATER", "CLOUDED"), ("WATER", "SNOWS")):
        for program in scene._choose(defines):
            assert program["Frame"].size == FRAME_DTYPE.itemsize


def test_includes_are_taken_in_once() -> None:
    text = programs.source("object.vert")
    assert text.count("uniform Frame") == 1
    assert "#include" not in text
    with pytest.raises(InvalidValueError, match=r"nothing\.frag"):
        programs.source("nothing.frag")


def test_packing_keeps_normals_colors_and_light(place: Place) -> None:
    mesh: Mesh = place.meshes["room"]
    packed = geometry.pack(mesh)
    assert np.array_equal(packed["position"], mesh.vertices)
    normals = packed["normal"][:, :3] / 127.0
    assert np.abs(normals - mesh.normals).max() < 0.006
    assert np.abs((packed["color"][:, :3] / 255.0) ** 2 - mesh.colors).max() < 0.01
    assert np.abs(packed["extra"][:, 2] / 255.0 * 4.0 - np.minimum(mesh.lamp, 4.0)).max() < 0.01


def test_cutting_loses_no_triangle(place: Place) -> None:
    for name in ("fences", "rocks", "mailbox"):
        mesh = place.meshes[name]
        pieces = geometry.cut(mesh)
        assert sorted(map(tuple, pieces.indices.tolist())) == sorted(
            map(tuple, mesh.indices.tolist())
        )
        assert pieces.ranges[:, 1].sum() == mesh.indices.size
        for (first, count), low, high in zip(pieces.ranges, pieces.low, pieces.high, strict=True):
            points = mesh.vertices[pieces.indices.ravel()[first : first + count]]
            assert (points >= low).all() and (points <= high).all()


def test_culling_never_drops_what_is_seen() -> None:
    rng = np.random.default_rng(2)
    view = look((3.0, 2.0, 9.0), (0.0, 1.0, -20.0))
    clip = perspective() @ view
    planes = geometry.frustum_planes(clip)
    low = rng.uniform(-60.0, 60.0, (400, 3))
    high = low + rng.uniform(0.5, 12.0, (400, 3))
    kept = geometry.boxes_seen(planes, low, high)
    inside = rng.random((50, 400, 3)) * (high - low) + low
    seen = np.concatenate([inside, np.ones((50, 400, 1))], -1) @ clip.T
    visible = (np.abs(seen[..., :2]) < seen[..., 3:]).all(-1) & (seen[..., 3] > 0.1)
    assert kept[visible.any(0)].all()
    assert not kept.all()


def test_box_distance_is_the_nearest_points() -> None:
    low, high = np.array([[0.0, 0.0, 0.0]]), np.array([[2.0, 2.0, 2.0]])
    for point, away in (((1.0, 1.0, 1.0), 0.0), ((5.0, 1.0, 1.0), 3.0), ((5.0, 6.0, 1.0), 5.0)):
        assert geometry.box_distance(np.array(point), low, high)[0] == pytest.approx(away)


@pytest.mark.parametrize("sun", [(0.3, 0.8, 0.5), (-0.97, 0.2, 0.1), (0.05, 0.06, 1.0)])
def test_the_suns_view_covers_the_place(sun: tuple[float, float, float]) -> None:
    way = np.array(sun) / np.linalg.norm(sun)
    matrix = light_matrix(way)
    corners = np.random.default_rng(0).uniform(LOW, HIGH, (200, 3))
    clip = np.c_[corners, np.ones(200)] @ matrix.T
    assert (np.abs(clip[:, :3]) <= 1.0 + 1e-6).all()
    nearer = np.c_[corners + way, np.ones(200)] @ matrix.T
    assert (nearer[:, 2] < clip[:, 2]).all()  # towards the sun is towards the front
    assert np.allclose(nearer[:, :2], clip[:, :2])


def test_leaves_keep_their_cover_in_every_level() -> None:
    levels = leaf_levels()
    share = [(level[..., 1] > 127).mean() for level in levels]
    assert share == pytest.approx([share[0]] * len(share), abs=0.06)
    for level in levels:
        height, width = level.shape[:2]
        u, v = int(SOLID[0] * width), int(SOLID[1] * height)
        assert level[v, u, 1] == 255


def test_what_is_near_the_sun_is_in_its_frame() -> None:
    """Of a direction within the glare, seen in the picture, there is no doubt."""
    rng = np.random.default_rng(4)
    projection = perspective()
    whole = none = 0
    for _ in range(300):
        view = look((0.0, 0.0, 0.0), tuple(rng.normal(size=3)))
        sun = rng.normal(size=3)
        sun /= np.linalg.norm(sun)
        frame = glare_frame(projection @ view, sun)
        ways = rng.normal(size=(4000, 3))
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        ways = ways[ways @ sun > math.cos(math.radians(GLARE))]
        x, y, _, w = projection @ view @ np.column_stack([ways, np.ones(len(ways))]).T
        seen = (w > 0.0) & (np.abs(x) < w) & (np.abs(y) < w)
        x, y = (x / np.where(seen, w, 1.0))[seen], (y / np.where(seen, w, 1.0))[seen]
        if frame is None:
            none += 1
            assert not len(x)
            continue
        left, bottom, right, top = frame
        whole += frame == (-1.0, -1.0, 1.0, 1.0)
        assert ((x >= left) & (x <= right) & (y >= bottom) & (y <= top)).all()
    assert none > 50 and whole < 150
