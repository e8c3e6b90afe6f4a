"""Canvases of near clouds: the same picture with fewer pixels, cut by the scene as before."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
import pytest

from tests.cloud_stage import SIZE, CloudStage, cloud_stage, clouds, shape, sky_frame, view_of
from tests.gl_names import living
from tests.views import perspective
from weather_ecs.gpu.cloud_canvas import _part
from weather_ecs.gpu.cloud_sequence import BILLBOARDS, PICTURE, Items, runs
from weather_ecs.gpu.gl import GL

THREE = ((-150.0, 0.0, 0.0), (150.0, 0.0, 40.0), (0.0, 80.0, 0.0))
RAGGED = 6
OVERHEAD = {"position": (0.0, 390.0, -300.0)}


@pytest.fixture
def stage(ctx: moderngl.Context) -> Iterator[CloudStage]:
    with cloud_stage(ctx) as made:
        yield made


def near_frame(**fields: Any) -> Any:
    """A cloud over the camera whose images are enlarged even in a small picture."""
    data = shape(centers=THREE, billboards=8, width=1500.0, image=RAGGED)
    data.billboards["size"][:, 1] *= 0.25
    return sky_frame(clouds({**OVERHEAD, **fields}), data)


def both(stage: CloudStage, frame: Any, **camera: Any) -> tuple[np.ndarray, np.ndarray]:
    """Pictures with canvases and without; there has to be a canvas."""
    pictures = []
    for on in (True, False):
        stage.passes.canvases_on = on
        pictures.append(stage.draw(frame, pitch=0.5, **camera))
        assert bool(stage.passes._groups) is on
    return pictures[0], pictures[1]


def test_a_canvas_shows_what_the_billboards_show(stage: CloudStage) -> None:
    frame = near_frame()
    painted, straight = both(stage, frame)
    covered = stage.cover(straight) > 0.02
    assert covered.mean() > 0.3
    difference = np.abs(painted - straight).max(axis=2)
    assert 0.0 < difference[covered].mean() < 0.012
    assert np.percentile(difference[covered], 99) < 0.08


def test_the_scene_hides_it_and_is_met_softly(stage: CloudStage) -> None:
    def depth_of(distance: float) -> float:
        near, far = 0.1, 2000.0
        ndc = (far + near) / (far - near) - 2.0 * far * near / ((far - near) * distance)
        return 0.5 * ndc + 0.5

    frame = near_frame()
    for distance in (20.0, 300.0, 450.0, 700.0, 1500.0):
        painted, straight = both(stage, frame, depth=depth_of(distance))
        difference = np.abs(painted - straight).max(axis=2)
        assert difference.mean() < 0.015 and np.percentile(difference, 99) < 0.20, distance
    assert not stage.cover(stage.draw(frame, pitch=0.5, depth=depth_of(20.0))).any()


def test_half_of_the_picture_behind_a_wall_is_cut_as_sharply(stage: CloudStage) -> None:
    frame = near_frame()

    def with_wall(on: bool) -> np.ndarray:
        stage.passes.canvases_on = on
        stage.draw(frame, pitch=0.5)
        stage.target.clear(*stage.background, depth=1.0)
        half = (0, 0, stage.target.width // 2, stage.target.height)
        stage.target.clear(*stage.background, depth=0.5, viewport=half)
        stage.renderer.draw(view_of(frame, pitch=0.5), stage.settings)
        return stage.cover(stage.picture())

    painted, straight = with_wall(True), with_wall(False)
    middle = painted.shape[1] // 2
    assert not painted[:, :middle].any()
    # To the very edge there is as much cloud as without a canvas.
    assert np.abs(painted[:, middle:] - straight[:, middle:]).mean(axis=0).max() < 0.03


def test_what_is_sharp_or_behind_the_camera_needs_no_canvas(stage: CloudStage) -> None:
    far = sky_frame(clouds({"position": (0.0, 400.0, -3000.0)}), shape(centers=THREE))
    stage.draw(far, pitch=0.2)
    assert not stage.passes._groups
    stage.draw(near_frame(position=(0.0, 390.0, 1900.0)), pitch=0.0)
    assert not stage.passes._groups


def test_a_camera_in_a_cloud_sees_its_billboards(stage: CloudStage) -> None:
    stage.draw(near_frame(position=(0.0, 2.0, 0.0)), pitch=0.5)
    assert not stage.passes._groups


def test_canvases_are_kept_and_given_back(ctx: moderngl.Context) -> None:
    gl = GL()
    before = living(gl)
    with cloud_stage(ctx) as stage:
        stage.draw(near_frame(), pitch=0.5)
        there = living(gl)
        for x in range(5):
            stage.draw(near_frame(position=(4.0 * x, 390.0, -300.0)), pitch=0.5)
        assert living(gl) == there
    assert living(gl) == before


def test_observers_with_pictures_of_different_sizes_keep_theirs(ctx: moderngl.Context) -> None:
    def draw(stage: CloudStage, size: tuple[int, int]) -> Any:
        stage.target.viewport = (0, 0, *size)
        stage.draw(near_frame(), pitch=0.5)
        return stage.passes._canvases._shown[0]

    gl = GL()
    with cloud_stage(ctx) as stage:
        sizes = [(SIZE[0] - 8 * k, SIZE[1]) for k in range(6)]
        first = [draw(stage, size) for size in sizes[:2]]
        two = living(gl)
        for _ in range(3):
            assert [draw(stage, size) for size in sizes[:2]] == first
        assert living(gl) == two
        # While a window is drawn larger or smaller there are not ever more of them.
        for size in sizes:
            draw(stage, size)
        most = living(gl)["texture"]
        for size in sizes * 2:
            draw(stage, size)
        assert len(living(gl)["texture"]) == len(most)
        for _ in range(70):
            draw(stage, sizes[0])
        assert len(stage.passes._canvases._kept) == 1
        assert len(living(gl)["texture"]) < len(most)


def test_runs_join_neighbours_of_one_kind_that_follow_on_each_other() -> None:
    kinds = np.array([BILLBOARDS, BILLBOARDS, PICTURE, PICTURE, PICTURE, BILLBOARDS, BILLBOARDS])
    begins = np.array([0, 4, 0, 9, 1, 9, 15])
    ends = np.array([4, 9, 1, 9, 2, 12, 20])
    found = list(runs(Items(kinds, begins, ends)))
    assert found == [(BILLBOARDS, 0, 9), (PICTURE, 0, 2), (BILLBOARDS, 9, 12), (BILLBOARDS, 15, 20)]
    assert list(runs(Items(kinds[:0], begins[:0], ends[:0]))) == []


@pytest.fixture
def crowded(stage: CloudStage) -> tuple[CloudStage, Any]:
    """A stage with small pictures of far clouds, as there is no room for larger ones."""
    stage.settings = replace(stage.settings, cloud_atlas=256, cloud_impostors=64)
    data = shape(centers=THREE, billboards=8, width=3000.0, image=RAGGED)
    places = [(300.0 * x, 2600.0, -2600.0 - 200.0 * z) for x in (-1, 0, 1) for z in range(5)]
    frame = sky_frame(clouds(*({"position": at} for at in places)), data)
    for dt in (0.0, 5.0):
        stage.draw(frame, dt=dt, **UP)
    assert stage.renderer.stats["cloud_billboards"] == 0
    return stage, frame


UP: dict[str, Any] = {"pitch": 0.78, "far": 20000.0}


def test_pictures_that_are_shown_enlarged_are_painted_on_canvases_too(crowded: Any) -> None:
    stage, frame = crowded
    pictures = []
    for on in (True, False):
        stage.passes.canvases_on = on
        pictures.append(stage.draw(frame, **UP))
        assert bool(stage.passes._groups) is on
    painted, straight = pictures
    covered = stage.cover(straight) > 0.02
    difference = np.abs(painted - straight).max(axis=2)[covered]
    assert covered.mean() > 0.2
    assert 0.0 < difference.mean() < 0.02 and np.percentile(difference, 99) < 0.10


def test_what_stands_between_the_guard_and_a_picture_hides_the_picture(crowded: Any) -> None:
    stage, frame = crowded
    near, far = 0.1, UP["far"]

    def with_hill(distance: float) -> np.ndarray:
        ndc = (far + near) / (far - near) - 2.0 * far * near / ((far - near) * distance)
        stage.target.clear(*stage.background, depth=1.0)
        half = (0, 0, stage.target.width // 2, stage.target.height)
        stage.target.clear(*stage.background, depth=0.5 * ndc + 0.5, viewport=half)
        stage.renderer.draw(view_of(frame, **UP), stage.settings)
        assert bool(stage.passes._groups) is stage.passes.canvases_on
        return stage.cover(stage.picture())

    open_sky = stage.cover(stage.draw(frame, **UP))
    middle, reach = open_sky.shape[1] // 2, 12
    (group,) = stage.passes._groups
    # The guard is so far off in the middle of the picture.
    ndc = group.depth[2]
    guard = 2.0 * far * near / (far + near - ndc * (far - near))
    assert 1000.0 < guard < 3600.0
    hidden = with_hill(0.5 * (guard + 3660.0))
    stage.passes.canvases_on = False
    straight = with_hill(0.5 * (guard + 3660.0))
    stage.passes.canvases_on = True
    left = slice(0, middle - reach)
    # But for corners of pictures, which are nearer than the hill.
    assert straight[:, left].mean() < 0.25 * open_sky[:, left].mean()
    assert np.abs(hidden - straight)[:, left].mean() < 0.12 * open_sky[:, left].mean()
    np.testing.assert_allclose(hidden[:, middle:], open_sky[:, middle:], atol=0.02)
    np.testing.assert_allclose(with_hill(15000.0), open_sky, atol=0.02)


def test_what_of_a_canvas_is_painted_lies_in_it() -> None:
    width, height = 96, 54
    whole = (-1.0, -1.0, 1.0, 1.0)
    assert _part(whole, -1.0, width, height) == (0, 0, width, height)
    left, bottom, across, up = _part((-0.5, 0.0, 0.5, 0.5), 0.25, width, height)
    assert left <= 24 and left + across >= 72 and bottom <= 33 and bottom + up >= 40
    # All of it is below what rain hides, and so is none of it painted.
    for top in (-0.9, 0.0, 0.3):
        left, bottom, across, up = _part((-1.0, -1.0, 1.0, top), 0.6, width, height)
        assert up == 0 and 0 <= bottom <= height and left + across <= width


def test_a_guard_nearer_than_the_near_plane_lets_the_scene_hide_pictures(crowded: Any) -> None:
    stage, frame = crowded
    near, far, distance = 3000.0, UP["far"], 3100.0
    ndc = (far + near) / (far - near) - 2.0 * far * near / ((far - near) * distance)
    projection = perspective(aspect=SIZE[0] / SIZE[1], near=near, far=far)
    stage.target.clear(*stage.background, depth=1.0)
    half = (0, 0, stage.target.width // 2, stage.target.height)
    stage.target.clear(*stage.background, depth=0.5 * ndc + 0.5, viewport=half)
    stage.renderer.draw(replace(view_of(frame, **UP), projection=projection), stage.settings)
    assert stage.passes._groups[0].depth[2] < 0.0
    cover, middle = stage.cover(stage.picture()), stage.target.width // 2
    assert cover[:, : middle - 12].mean() < 0.03 * cover[:, middle:].mean()
