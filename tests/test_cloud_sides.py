"""What a thick sheet of cloud hides from its other side is not drawn."""

from __future__ import annotations

from dataclasses import replace

import moderngl
import numpy as np
import pytest

from tests.cloud_stage import SETTINGS, cloud_stage, clouds, sky_frame
from weather_ecs.frame import CloudShapeData
from weather_ecs.gpu.cloud_sides import hidden_sides
from weather_ecs.physics.cloud_shape import shape
from weather_ecs.presets import CLOUD_MODELS, cloud_model


def data_of(name: str) -> CloudShapeData:
    model = cloud_model(name)
    made = shape(model, 1)
    lost = np.zeros(len(made.centers), np.float32)
    return CloudShapeData(
        1, made.centers, made.sizes, lost, (0.0, 1.0, 0.0), made.billboards, made.radius,
        model.light_penetration,
    )  # fmt: skip


def test_of_the_packages_clouds_nimbostratus_alone_hides_its_sides() -> None:
    hiding = [name for name in CLOUD_MODELS if hidden_sides(data_of(name)) is not None]
    assert hiding == ["nimbostratus"]


def test_the_upper_is_hidden_from_below_and_the_lower_from_above() -> None:
    data = data_of("nimbostratus")
    sides = hidden_sides(data)
    assert sides is not None
    upper, lower = sides
    assert not (upper & lower).any() and not (upper | lower).all()
    y = data.billboards["position"][:, 1]
    assert y[upper].min() > 0.0 > y[lower].max()
    assert 0.3 < upper.mean() < 0.8  # a third at least is saved who looks up


def test_a_sheet_that_light_goes_through_hides_nothing() -> None:
    data = data_of("nimbostratus")
    assert hidden_sides(replace(data, penetration=np.inf)) is None


@pytest.mark.parametrize(("height", "side"), [(2.0, 0), (6000.0, 1), (1700.0, None)])
def test_hidden_billboards_are_left_out(
    ctx: moderngl.Context, height: float, side: int | None
) -> None:
    data = data_of("nimbostratus")
    frame = sky_frame(clouds({"position": (0.0, 1800.0, -4000.0)}), data)
    sides = hidden_sides(data)
    assert sides is not None
    hidden = 0 if side is None else int(np.count_nonzero(sides[side]))
    with cloud_stage(ctx) as stage:
        stage.settings = replace(SETTINGS, cloud_billboards=1000)
        stage.passes.impostors_on = False
        stage.draw(frame, position=(0.0, height, 0.0))
        drawn = stage.renderer.stats["cloud_billboards"]
    assert drawn == len(data.billboards) - hidden
