"""What part of the view a cloud's picture takes up: no more than shows of the cloud."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace

import moderngl
import numpy as np
import pytest

from tests.cloud_stage import CloudStage, cloud_stage, clouds, shape, sky_frame, view_of
from weather_ecs.gpu.cloud_bounds import picture_bounds, shared_octagon
from weather_ecs.gpu.cloud_scene import scene_of
from weather_ecs.gpu.cloud_seen import pictures_seen

SLANTED = ((-300.0, -150.0, 0.0), (0.0, 0.0, 0.0), (300.0, 150.0, 0.0))
FAR = {"position": (0.0, 500.0, -2000.0)}


@pytest.fixture
def stage(ctx: moderngl.Context) -> Iterator[CloudStage]:
    with cloud_stage(ctx) as made:
        yield made


def test_a_picture_s_corners_are_cut_where_nothing_shows(stage: CloudStage) -> None:
    frame = sky_frame(clouds({**FAR, "growth": 0.8}), shape(centers=SLANTED, billboards=20))
    for _ in range(40):
        cut = stage.draw(frame, pitch=0.25, dt=0.1)
    assert stage.renderer.stats["cloud_billboards"] == 0
    kept = stage.passes.impostors().kept
    # It rises from left to right, or falls: two corners are empty.
    assert np.sort(kept["cuts"][0])[:2].max() < 1.6
    kept["cuts"][:] = 2.0
    whole = stage.draw(frame, pitch=0.25)
    assert (stage.cover(whole) > 0.02).mean() > 0.01
    assert np.abs(whole - cut).max() < 1.5 / 255.0


def test_a_picture_is_only_as_large_as_what_shows(stage: CloudStage) -> None:
    data = shape(centers=SLANTED, billboards=20)
    data.billboards["order"][:20] = np.linspace(0.0, 0.3, 20)
    data.billboards["order"][20:] = np.linspace(0.6, 1.0, 40)
    sizes = []
    for growth in (1.0, 0.35):
        frame = sky_frame(clouds({**FAR, "growth": growth}), data)
        stage.draw(frame, pitch=0.25)
        scene = scene_of(view_of(frame, pitch=0.25), stage.passes.store, 108)
        bounds = picture_bounds(scene, stage.passes.store.shapes[0], 0)
        sizes.append(bounds.half)
        assert all(0.0 < cut <= 2.0 for cut in bounds.cuts)
    assert sizes[1][0] < 0.6 * sizes[0][0]
    assert sizes[1][1] < 0.8 * sizes[0][1]


def test_an_older_picture_is_not_cut_off_by_a_smaller_one(stage: CloudStage) -> None:
    data = shape(centers=SLANTED, billboards=20)
    data.billboards["order"][:20] = np.linspace(0.6, 1.0, 20)
    data.billboards["order"][20:40] = np.linspace(0.0, 0.3, 20)
    data.billboards["order"][40:] = np.linspace(0.6, 1.0, 20)
    for _ in range(40):
        before = stage.draw(sky_frame(clouds(FAR), data), pitch=0.25, dt=0.1)
    after = sky_frame(clouds({**FAR, "growth": 0.35}), data)
    first = stage.draw(after, pitch=0.25, dt=1e-4)
    kept = stage.passes.impostors().kept
    assert 0.0 <= kept["share"][0] < 0.01, "the newer picture has hardly begun to show"
    assert kept["quad"][0, 1, 0] < 0.7 * kept["old_quad"][0, 1, 0]
    assert np.abs(first - before).max() < 2.0 / 255.0
    for _ in range(10):
        stage.draw(after, pitch=0.25, dt=0.1)
    assert kept["share"][0] >= 1.0
    assert (stage.cover(before) > 0.02).sum() > 1.5 * (
        stage.cover(stage.draw(after, pitch=0.25)) > 0.02
    ).sum()


def test_an_older_picture_that_no_longer_fits_is_left_out(stage: CloudStage) -> None:
    data = shape(centers=SLANTED, billboards=20)
    for _ in range(40):
        stage.draw(sky_frame(clouds(FAR), data), pitch=0.25, dt=0.1)
    after = sky_frame(clouds({**FAR, "growth": 0.35}), data)
    stage.draw(after, pitch=0.25, dt=1e-4)
    kept = stage.passes.impostors().kept
    assert kept["share"][0] < 0.01
    kept["old_quad"][0, 1:] *= 9.0
    alone = stage.draw(after, pitch=0.25, dt=1e-4)
    assert kept["share"][0] < 0.1
    stage.draw(after, pitch=0.25, dt=1.0)
    assert kept["share"][0] >= 1.0
    assert (stage.cover(alone) > 0.02).mean() > 0.003
    assert np.abs(alone - stage.draw(after, pitch=0.25, dt=1e-4)).max() < 1.5 / 255.0


def test_what_is_seen_of_a_picture_counts_the_older_one_around_it() -> None:
    view, scene = view_of(sky_frame(clouds(FAR))), SimpleNamespace(unit=100.0)
    quads = np.zeros((2, 9, 4), np.float32)
    quads[:, :3, :3] = (0.0, 0.0, -100.0), (10.0, 0.0, 0.0), (0.0, 5.0, 0.0)
    quads[:, 3, 3] = 1.0, 3.0
    seen = pictures_seen(view, scene, quads)  # type: ignore[arg-type]
    assert seen.high[1] == pytest.approx(3.0 * seen.high[0])
    assert seen.low[1] == pytest.approx(3.0 * seen.low[0])
    assert seen.area[1] == pytest.approx(9.0 * seen.area[0])


def test_a_picture_that_is_no_likeness_gives_way_at_once() -> None:
    quad = np.array([[(0.0, 0.0, -100.0), (10.0, 0.0, 0.0), (0.0, 5.0, 0.0)]])
    whole = np.full((1, 4), 2.0)
    size, cuts = shared_octagon(quad, whole, quad, whole)
    assert size == pytest.approx([1.0]) and cuts == pytest.approx(whole)
    larger = quad * np.array([1.0, 3.0, 2.0])[:, None]
    size, cuts = shared_octagon(quad, np.full((1, 4), 1.5), larger, whole)
    assert size == pytest.approx([3.0])
    # Of the older picture's corner (3, 2), in units of the wider octagon.
    assert cuts == pytest.approx(np.full((1, 4), 5.0 / 3.0))
    farther = quad * np.array([2.0, 3.0, 2.0])[:, None]
    assert shared_octagon(quad, whole, farther, whole)[0] == pytest.approx([1.5])
    for other in (
        quad * np.array([1.0, 5.0, 1.0])[:, None],
        quad * np.array([-1.0, 1.0, 1.0])[:, None],
    ):
        assert shared_octagon(quad, whole, other, whole)[0] == np.inf
