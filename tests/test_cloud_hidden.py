"""Clouds behind so much rain that nobody sees them are not drawn."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import moderngl
import numpy as np
import pytest

from tests.cloud_stage import CloudStage, cloud_stage, clouds, shape, sky_frame, view_of
from weather_ecs.frame import VeilData, ViewData
from weather_ecs.gpu import cloud_hidden
from weather_ecs.gpu.cloud_hidden import OPAQUE, hidden_below
from weather_ecs.gpu.cloud_scene import left_by_haze, scene_of
from weather_ecs.gpu.veil_list import rays
from weather_ecs.physics.veil import rain_path

FRAME = sky_frame(
    clouds({"position": (0.0, 900.0, -1500.0)}, {"position": (300.0, 700.0, -900.0)}),
    shape(centers=((-300.0, 0.0, 0.0), (300.0, 0.0, 0.0)), size=(600.0, 200.0, 600.0), width=500.0),
)
TOP = 350.0  # m, of the rain


@pytest.fixture
def stage(ctx: moderngl.Context) -> Iterator[CloudStage]:
    with cloud_stage(ctx) as made:
        yield made


def view(extinction: float, y: float = 2.0, frame: object = FRAME) -> ViewData:
    """Up at the clouds from within a wide shower."""
    veil = VeilData((0.0, 0.0, 1.0, 0.0), (4000.0, 4000.0, 0.9), (-10.0, TOP), extinction, 0.0)
    seen = view_of(frame, position=(0.0, y, 0.0), pitch=0.4)  # type: ignore[arg-type]
    return replace(seen, veils=(veil,))


def low(stage: CloudStage, seen: ViewData) -> float:
    stage.passes.update(seen, stage.settings, 108)
    return hidden_below(seen, scene_of(seen, stage.passes.store, 108))[0]


def test_all_below_the_height_is_behind_opaque_rain_and_what_is_above_is_not(
    stage: CloudStage,
) -> None:
    seen = view(0.008)
    height = low(stage, seen)
    assert -0.6 < height < 0.9
    middle, right, up = rays(seen)
    veil = seen.veils[0]

    def depth(y: float) -> np.ndarray:
        ray = middle + y * up + np.linspace(-1.0, 1.0, 50)[:, None] * right
        path = rain_path(seen.position, ray, 1e5, veil.axis, veil.shape, TOP, 0.0)
        return np.asarray(veil.extinction * path)

    for y in np.linspace(-0.6, height, 40).tolist():
        assert depth(y).min() > 0.99 * OPAQUE
    assert depth(height + 0.15).min() < OPAQUE


def test_thin_rain_and_a_camera_among_the_clouds_hide_nothing_and_thick_rain_all(
    stage: CloudStage,
) -> None:
    assert low(stage, view(0.0005)) == -1.0
    assert low(stage, view(0.5, y=900.0)) == -1.0
    assert low(stage, view(0.5)) == 1.0
    stage.target.use()
    stage.renderer.draw(view(0.5), stage.settings)
    assert stage.renderer.stats["clouds_drawn"] == 0


def test_the_picture_is_the_same(stage: CloudStage, monkeypatch: pytest.MonkeyPatch) -> None:
    pictures = []
    for hides in (True, False):
        if not hides:
            monkeypatch.setattr(cloud_hidden, "hidden_below", lambda view, scene: (-1.0, -1.0))
        for extinction in (0.0, 0.008):
            stage.target.use()
            stage.target.clear(*stage.background, depth=1.0)
            stage.renderer.draw(view(extinction), stage.settings)
            pictures.append(stage.picture())
    dry, hidden, _, whole = pictures
    assert np.abs(hidden - whole).max() < 1.5 / 255.0
    # The rain leaves some of the clouds to be seen.
    assert (stage.cover(dry) > 0.02).mean() > 0.1
    assert np.abs(hidden - hidden[-1, 0]).max() > 4.0 / 255.0


def test_a_cloud_that_is_all_haze_fades() -> None:
    left = left_by_haze(np.array([0.0, 0.5, 0.9, 0.945, 0.99, 1.0], np.float32))
    assert left == pytest.approx([1.0, 1.0, 1.0, 0.5, 0.0, 0.0], abs=1e-5)
