"""Clouds in pictures: order, growth, nearness, impostors, memory, state, both backends."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
import pytest

from tests.cloud_stage import SETTINGS, CloudStage, cloud_stage, clouds, shape, sky_frame, view_of
from tests.gl_host import Host, read_state
from tests.gl_names import living
from weather_ecs.errors import ShaderError
from weather_ecs.frame import CloudLook, FrameData, SkyLight
from weather_ecs.gpu import cloud_kit
from weather_ecs.gpu.context import probe
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard

NEAR_CLOUD = {"position": (0.0, 30.0, -500.0)}
FAR_CLOUD = {"position": (0.0, 200.0, -2500.0)}
THREE = ((-150.0, 0.0, 0.0), (150.0, 0.0, 40.0), (0.0, 80.0, 0.0))


@pytest.fixture
def stage(ctx: moderngl.Context) -> Iterator[CloudStage]:
    with cloud_stage(ctx) as made:
        yield made


def field(count: int, seed: int = 0, spread: float = 6000.0) -> Any:
    """Clouds all round, three shapes."""
    rng = np.random.default_rng(seed)
    rows = [
        {
            "position": (rng.uniform(-spread, spread), 700.0, rng.uniform(-spread, spread)),
            "shape": k % 3,
            "heading": rng.uniform(0.0, 6.0),
        }
        for k in range(count)
    ]
    shapes = [shape(k + 1, THREE, billboards=4, seed=k, width=180.0) for k in range(3)]
    return clouds(*rows), shapes


@pytest.mark.parametrize("backend", ["compute", "feedback"])
def test_a_cloud_is_in_the_picture_on_both_backends(ctx: moderngl.Context, backend: str) -> None:
    if backend == "compute" and not probe(ctx).compute:
        pytest.skip("no compute shaders here")
    with cloud_stage(ctx, backend) as stage:
        picture = stage.draw(sky_frame(clouds(NEAR_CLOUD), shape(centers=THREE)))
        cover = stage.cover(picture)
    middle = cover[50:75, 80:112]
    assert (middle > 0.1).mean() > 0.5
    assert (cover[:10] < 0.01).all()
    assert stage.renderer.stats["clouds_drawn"] == 1


def test_without_clouds_nothing_is_made_or_drawn(stage: CloudStage) -> None:
    picture = stage.draw(FrameData())
    assert not stage.cover(picture).any()
    assert stage.passes.store is None


def test_growth_0_and_opacity_0_draw_nothing_and_half_grown_less_than_whole(
    stage: CloudStage,
) -> None:
    data = shape(centers=THREE, billboards=10)

    def covered(**fields: Any) -> float:
        frame = sky_frame(clouds({**NEAR_CLOUD, **fields}), data)
        return float((stage.cover(stage.draw(frame)) > 0.05).mean())

    stage.passes.impostors_on = False
    assert covered(growth=0.0) == covered(opacity=0.0) == 0.0
    assert 0.0 < covered(growth=0.3) < covered(growth=0.6) < covered()
    assert covered(growth=0.5, mode=1.0) != covered(growth=0.5)


def test_nearer_billboards_hide_farther_ones_and_nearer_clouds_farther_clouds(
    stage: CloudStage,
) -> None:
    # Plain light: the near one absorbs everything and is dark, the far one is lit.
    sky = SkyLight(sun_direction=(0.0, 0.0, 1.0), sun_color=(1.0, 1.0, 1.0))
    look = CloudLook(plain=True, ambient=0.1)
    dark = shape(1, billboards=1, absorbed=1.0, width=300.0)
    bright = shape(2, ((0.0, 0.0, 200.0),), billboards=1, absorbed=0.0, width=300.0)
    for on in (False, True):
        stage.passes.impostors_on = on
        for near_dark in (True, False):
            rows = clouds(
                {"position": (0.0, 2.0, -700.0 if near_dark else -1100.0), "shape": 0},
                {"position": (0.0, 2.0, -1100.0 if near_dark else -700.0), "shape": 1},
            )
            rows["key"] += 2 * near_dark  # other clouds, or they would change places slowly
            frame = sky_frame(rows, dark, bright, sky=sky, cloud_look=look)
            for _ in range(3):
                picture = stage.draw(frame)
            middle = picture[54, 96, 0]
            assert middle < 0.5 if near_dark else middle > 0.6


def test_the_scene_hides_clouds_and_softens_them_where_they_meet(stage: CloudStage) -> None:
    frame = sky_frame(clouds({"position": (0.0, 2.0, -300.0)}), shape(billboards=1, width=200.0))
    stage.passes.impostors_on = False

    def depth_of(distance: float) -> float:
        near, far = 0.1, 2000.0
        ndc = (far + near) / (far - near) - 2.0 * far * near / ((far - near) * distance)
        return 0.5 * ndc + 0.5

    open_sky = stage.cover(stage.draw(frame)).max()
    behind = stage.cover(stage.draw(frame, depth=depth_of(900.0))).max()
    before = stage.cover(stage.draw(frame, depth=depth_of(100.0))).max()
    through = stage.cover(stage.draw(frame, depth=depth_of(302.0))).max()
    assert behind == pytest.approx(open_sky, abs=0.02)
    assert before == 0.0
    assert 0.0 < through < 0.9 * open_sky


def test_clouds_beyond_the_host_s_far_plane_are_drawn(stage: CloudStage) -> None:
    frame = sky_frame(clouds({"position": (0.0, 900.0, -9000.0), "scale": 12.0}), shape())
    assert stage.cover(stage.draw(frame, far=500.0)).max() > 0.05


def test_what_is_behind_the_camera_costs_nothing(stage: CloudStage) -> None:
    frame = sky_frame(clouds({"position": (0.0, 30.0, 900.0)}), shape())
    assert not stage.cover(stage.draw(frame)).any()
    assert stage.renderer.stats["clouds_drawn"] == 0
    assert stage.renderer.stats["cloud_billboards"] == 0


def test_flying_through_a_cloud_nothing_pops(stage: CloudStage) -> None:
    data = shape(centers=THREE, billboards=12, width=160.0)
    frame = sky_frame(clouds({"position": (0.0, 0.0, 0.0)}), data)
    last, steps, covers = None, [], []
    for z in np.arange(300.0, -300.0, -2.5):
        picture = stage.draw(frame, position=(0.0, 10.0, float(z)))
        if last is not None:
            steps.append(np.abs(picture - last).mean())
        last = picture
        covers.append(float((stage.cover(picture) > 0.03).mean()))
    # Moved all the while, so never 0; and no frame changes much more than its neighbours.
    steps = np.array(steps)
    around = np.convolve(steps, np.ones(9) / 9.0, mode="same") + 0.002
    assert (steps[5:-5] < 3.0 * around[5:-5]).all()
    assert max(covers) > 0.8
    assert covers[-1] < 0.2


def test_impostors_look_like_the_clouds_they_stand_for(stage: CloudStage) -> None:
    rows, shapes = field(12)
    rows["scale"] = 5.0
    frame = sky_frame(rows, *shapes)
    for _ in range(60):
        with_them = stage.draw(frame, pitch=0.3)
    drawn = stage.renderer.stats["cloud_billboards"]
    stage.passes.impostors_on = False
    without = stage.draw(frame, pitch=0.3)
    assert drawn < 0.5 * stage.renderer.stats["cloud_billboards"]
    covered = stage.cover(without) > 0.02
    assert covered.mean() > 0.03
    difference = np.abs(with_them - without).max(axis=2)
    assert difference[covered].mean() < 0.025
    assert np.percentile(difference[covered], 99) < 0.2


def test_a_budget_bounds_the_pictures_taken_and_the_billboards_drawn(stage: CloudStage) -> None:
    rows, shapes = field(60)
    stage.settings = replace(SETTINGS, cloud_impostors=2, cloud_billboards=60)
    frame = sky_frame(rows, *shapes)
    # At first every cloud in view needs one; none is left out, however few billboards may be.
    stage.draw(frame, pitch=0.3)
    stats = stage.renderer.stats
    assert stats["cloud_billboards"] <= 60
    kept = stage.passes.impostors().kept
    drawn = kept["tile"][:, 2][stage.passes._scene.visible] > 0
    assert (drawn | kept["real"][stage.passes._scene.visible]).all()
    for step in range(30):
        rows = rows.copy()
        rows["position"][:, 0] += 30.0
        stage.draw(sky_frame(rows, *shapes), pitch=0.3, dt=0.1)
        assert stage.renderer.stats["cloud_billboards"] <= 60
        if step > 20:
            assert stage.renderer.stats["impostors_refreshed"] <= 2


def test_an_impostor_is_taken_again_when_view_light_or_cloud_change(stage: CloudStage) -> None:
    data = shape(centers=THREE)
    row = {"position": (0.0, 400.0, -1500.0)}

    def settled(frame: FrameData, **camera: Any) -> int:
        taken = 0
        for _ in range(45):
            stage.draw(frame, pitch=0.2, **camera)
            taken += int(stage.renderer.stats["impostors_refreshed"])
        return taken

    still = sky_frame(clouds(row), data)
    assert settled(still) == 1
    assert settled(still) == 0
    assert settled(still, heading=1.8) == 0  # turning the camera changes nothing
    assert settled(still, position=(900.0, 2.0, 0.0)) >= 1
    low = sky_frame(clouds(row), data, sky=SkyLight(sun_direction=(0.96, 0.28, 0.0)))
    assert settled(low, position=(900.0, 2.0, 0.0)) >= 1
    other = replace(data, absorbed=data.absorbed + np.float32(0.5))
    assert settled(sky_frame(clouds(row), other, sky=low.sky), position=(900.0, 2.0, 0.0)) >= 1
    shrunk = sky_frame(clouds({**row, "growth": 0.7}), other, sky=low.sky)
    assert settled(shrunk, position=(900.0, 2.0, 0.0)) >= 1


def test_under_a_still_sky_no_picture_is_taken_again(stage: CloudStage) -> None:
    """Clouds of every size in the picture are as large in it as they should be."""
    data = shape(centers=THREE)
    far = np.geomspace(700.0, 14_000.0, 40)
    places = [(0.4 * z * np.sin(7.0 * z), 0.2 * z, -z) for z in far.tolist()]
    frame = sky_frame(clouds(*[{"position": place} for place in places]), data)
    for _ in range(60):
        stage.draw(frame, pitch=0.2)
    for _ in range(5):
        stage.draw(frame, pitch=0.2)
        assert stage.renderer.stats["impostors_refreshed"] == 0


def test_new_pictures_and_new_light_come_in_without_a_jump(stage: CloudStage) -> None:
    rows = clouds({"position": (0.0, 200.0, -900.0)})
    data = shape(centers=THREE, absorbed=0.0)
    other = replace(data, absorbed=np.ones(3, np.float32))
    for on in (True, False):
        stage.passes.impostors_on = on
        for _ in range(60):
            before = stage.draw(sky_frame(rows, data), pitch=0.2)
        pictures = [before]
        for _ in range(90):
            pictures.append(stage.draw(sky_frame(rows, other), pitch=0.2, dt=1 / 60))
        whole = np.abs(pictures[-1] - before).max()
        largest = max(np.abs(b - a).max() for a, b in zip(pictures, pictures[1:], strict=False))
        assert whole > 0.1
        assert largest < 0.25 * whole


def test_lightning_lights_a_cloud_at_once(stage: CloudStage) -> None:
    data = shape(centers=THREE)
    for _ in range(30):
        dark = stage.draw(sky_frame(clouds(FAR_CLOUD), data), pitch=0.1)
    lit = stage.draw(sky_frame(clouds({**FAR_CLOUD, "flash": 1.5}), data), pitch=0.1)
    assert (lit - dark).max() > 0.1
    after = stage.draw(sky_frame(clouds(FAR_CLOUD), data), pitch=0.1)
    np.testing.assert_allclose(after, dark, atol=0.05)


def test_rays_and_boxes_are_shown_on_demand(stage: CloudStage) -> None:
    data = shape(centers=THREE)
    plain = stage.draw(sky_frame(clouds(NEAR_CLOUD), data))
    stage.passes.impostors_on = False
    shown = stage.draw(sky_frame(clouds(NEAR_CLOUD), data, cloud_look=CloudLook(rays=True)))
    yellow = (shown[..., 0] > 0.5) & (shown[..., 2] < 0.3)
    assert yellow.sum() > 10
    assert np.abs(shown - plain).max() > 0.3


def test_memory_is_flat_while_clouds_come_and_go(ctx: moderngl.Context) -> None:
    gl = GL()
    with cloud_stage(ctx) as stage:
        rows, shapes = field(40)
        for k in range(40):
            fresh = [replace(data, key=100 * k + j) for j, data in enumerate(shapes)]
            rows = rows.copy()
            rows["key"] = np.arange(40) + 13 * k
            stage.draw(sky_frame(rows, *fresh), pitch=0.3)
            if k == 5:
                there = living(gl)
                size = stage.passes.store.billboards.texture.size
        assert living(gl) == there
        assert stage.passes.store.billboards.texture.size == size
        space = stage.passes.impostors().atlas.space
        # Nothing is taken for clouds that are gone.
        stage.draw(sky_frame(rows[:0], *fresh))
        stage.draw(sky_frame(clouds({"position": (0.0, 0.0, 9000.0)}), *fresh))
        held = stage.passes.impostors().kept["tile"][:, 2]
        assert len(held) == 1
        tile = space.take(space.size // 2)
        assert tile is not None


def test_a_host_in_any_state_finds_it_again(ctx: moderngl.Context) -> None:
    gl = GL()
    rows, shapes = field(20)
    kept: list[Any] = []

    def keep(thing: Any) -> Any:
        kept.append(thing)
        return thing

    outer = StateGuard(ctx, gl)
    with outer, cloud_stage(ctx) as stage:
        host = Host(ctx, gl, keep, 7)
        frame = sky_frame(rows, *shapes)
        stage.draw(frame, pitch=0.3)
        stage.renderer.cloud_shadow()
        for _ in range(6):
            host.scramble()
            before = read_state(gl)
            stage.renderer.draw(view_of(frame, pitch=0.3, dt=0.2), stage.settings)
            after = read_state(gl)
            assert {k: (v, after[k]) for k, v in before.items() if after[k] != v} == {}
        outer.reset()
    outer.release()
    for thing in reversed(kept):
        thing.release()
    while gl.error() == 0x0506:  # the window's framebuffer was bound; there is none
        pass


def test_everything_is_given_back(ctx: moderngl.Context) -> None:
    gl = GL()
    before = living(gl)
    rows, shapes = field(20)
    with cloud_stage(ctx) as stage:
        stage.renderer.cloud_shadow()
        stage.draw(sky_frame(rows, *shapes), pitch=0.3)
        stage.renderer.forget(0)
        stage.draw(sky_frame(rows, *shapes), pitch=0.3)
    assert living(gl) == before


@pytest.mark.parametrize("part", ["CloudPrograms", "RowTexture", "CloudInside"])
def test_what_cannot_be_made_is_tried_again(
    ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch, part: str
) -> None:
    def broken(*args: Any, **kwargs: Any) -> None:
        raise ShaderError("the driver does not like it")

    rows, shapes = field(6)
    with cloud_stage(ctx) as stage:
        monkeypatch.setattr(cloud_kit, part, broken)
        alive: list[dict[str, set[int]]] = []
        for _ in range(3):
            with pytest.raises(ShaderError):
                stage.draw(sky_frame(rows, *shapes), pitch=0.3)
            alive.append(living(GL()) | {"query": set()})
        assert alive[0] == alive[1] == alive[2]
        monkeypatch.undo()
        assert stage.cover(stage.draw(sky_frame(rows, *shapes), pitch=0.3)).max() > 0.1


def test_in_a_cloud_the_view_is_white_and_one_s_own_wings_are_free(stage: CloudStage) -> None:
    data = shape(size=(400.0, 300.0, 400.0), billboards=12, width=160.0, absorbed=0.2)
    frame = sky_frame(clouds({"position": (0.0, 0.0, 0.0)}), data)
    inside = stage.draw(frame, position=(0.0, 1.0, 20.0))
    assert (stage.cover(inside) > 0.15).mean() > 0.99
    assert inside.std(axis=(0, 1)).max() < 0.08
    near = stage.draw(frame, position=(0.0, 1.0, 20.0), depth=0.5)  # 0.2 m off
    assert stage.cover(near).max() == 0.0
    plain = sky_frame(frame.clouds, data, cloud_look=CloudLook(plain=True))
    seen = stage.cover(stage.draw(plain, position=(0.0, 1.0, 20.0)))
    assert seen.std() > 0.05


def test_two_clouds_that_change_places_do_so_unseen(stage: CloudStage) -> None:
    sky = SkyLight(sun_direction=(0.0, 0.0, 1.0), sun_color=(1.0, 1.0, 1.0))
    look = CloudLook(plain=True, ambient=0.1)
    ahead = ((0.0, 0.0, 200.0),)  # of the centre, so that all of it faces the sun
    dark = shape(1, ahead, (60.0, 60.0, 1.0), 1.0, 5, width=160.0)
    bright = shape(2, ahead, (60.0, 60.0, 1.0), 0.0, 5, width=160.0)
    for on in (True, False):
        stage.passes.impostors_on = on
        pictures = []
        for step in range(140):
            way = np.clip((step - 40) * 0.5, -10.0, 10.0)
            rows = clouds(
                {"position": (0.0, 30.0, -900.0 - way), "shape": 0},
                {"position": (0.0, 30.0, -900.0 + way), "shape": 1},
            )
            rows["key"] += 2 * on
            frame = sky_frame(rows, dark, bright, sky=sky, cloud_look=look)
            pictures.append(stage.draw(frame, dt=1 / 60))
        whole = np.abs(pictures[-1] - pictures[20]).max()
        steps = [np.abs(b - a).max() for a, b in zip(pictures[20:], pictures[21:], strict=False)]
        assert whole > 0.3
        assert max(steps) < 0.15 * whole
