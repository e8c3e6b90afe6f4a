"""The vertex shader of the clouds against its oracle: place, growth, shear, light; and the haze."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import moderngl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tests.cloud_captures import CENTERS, captured, expected_places
from tests.cloud_stage import cloud_stage, clouds, shape, sky_frame, view_of
from weather_ecs.frame import CloudLook, FogData, SkyLight
from weather_ecs.gpu.cloud_scene import haze_of, surround_of
from weather_ecs.gpu.view_block import encode
from weather_ecs.physics import cloud_billboard, cloud_light
from weather_ecs.physics.cloud_light import Body, surround
from weather_ecs.physics.cloud_spread import Spread
from weather_ecs.physics.high_sun import LEVELS
from weather_ecs.physics.sky_map import shown


@pytest.fixture
def scene() -> dict[str, Any]:
    return {
        "position": (40.0, 300.0, -700.0), "scale": 1.3, "mirror": -1.0, "heading": 0.7,
        "shear": (0.3, -0.2), "growth": 0.45, "mode": 0.25, "opacity": 0.8, "darkness": 0.4,
        "flash": 0.3,
    }  # fmt: skip


def test_places_growth_and_shear_are_the_oracle_s(
    ctx: moderngl.Context, scene: dict[str, Any]
) -> None:
    data = shape(centers=CENTERS, billboards=8)
    with cloud_stage(ctx) as stage:
        found = captured(stage, sky_frame(clouds(scene), data))
    _, corners, there = expected_places(data, scene)
    shown = there > 0.01
    assert 3 < shown.sum() < len(there)
    np.testing.assert_allclose(found["place"][shown][..., :2], corners[shown][..., :2], atol=0.02)
    away = np.linalg.norm(corners.mean(axis=1), axis=1)
    size = cloud_billboard.shown_size(data.billboards["size"].astype(float), 1.3, there)
    near = cloud_billboard.near_share(away, size[:, 0])
    wanted = there * near * scene["opacity"]
    np.testing.assert_allclose(found["vs_fade"][:, 0, 0], wanted, atol=2e-3)
    # What is not there is nowhere in the picture.
    assert (found["place"][there < 0.001][..., 2] == 2.0).all()


def test_the_plain_light_is_the_dissertation_s(
    ctx: moderngl.Context, scene: dict[str, Any]
) -> None:
    lost = (0.1, 0.45, 0.9)
    data = shape(centers=CENTERS, billboards=8, absorbed=lost)
    look = CloudLook(plain=True, ambient=0.8)
    frame = sky_frame(clouds({**scene, "growth": 1.0}), data, cloud_look=look)
    with cloud_stage(ctx) as stage:
        found = captured(stage, frame)
    _, corners, _ = expected_places(data, {**scene, "growth": 1.0})
    v = corners - (np.array(scene["position"]) - (0.0, 2.0, 0.0))
    light = surround_of(view_of(frame))
    a = np.array(lost)[data.billboards["seed"]][:, None] * np.ones(4)
    wanted = cloud_light.plain_light(v, a, light.direction, light.sun, 0.8 * light.plain)
    np.testing.assert_allclose(found["vs_lit"], encode(wanted), atol=2e-4)
    np.testing.assert_allclose(found["vs_shade"], found["vs_lit"])
    assert not found["vs_rim"].any()
    assert not found["vs_relief"].any()


def test_the_full_light_is_the_oracle_s(ctx: moderngl.Context, scene: dict[str, Any]) -> None:
    data = shape(centers=CENTERS, billboards=8, absorbed=(0.1, 0.45, 0.9))
    row = {**scene, "growth": 1.0, "shaded": (0.4, 0.55)}
    look = CloudLook(silver=0.7, base=0.9, ambient=1.1)
    # Of a low sun, whose light grows with the height.
    high = tuple((0.1 * k, 0.08 * k, 0.01 * k * k) for k in range(LEVELS))
    sky = replace(SkyLight(), high_direction=(0.6, 0.16, math.sqrt(0.6144)), high_colors=high)
    frame = sky_frame(clouds(row), data, cloud_look=look, sky=sky)
    with cloud_stage(ctx) as stage:
        found = captured(stage, frame)
        stored = stage.passes.store.shapes[0]
    middle, corners, _ = expected_places(data, row)
    v = corners - (np.array(row["position"]) - (0.0, 2.0, 0.0))
    w = corners / np.linalg.norm(corners, axis=-1, keepdims=True)
    spread = Spread.over(
        data.billboards["position"], data.billboards["seed"], data.centers, data.sizes
    )
    field = spread.field(data.absorbed).astype(float)
    offset = v - middle[:, None]
    h, m = row["heading"], row["mirror"]
    own = (
        np.stack(
            [
                (offset[..., 0] * np.cos(h) - offset[..., 2] * np.sin(h)) * m,
                offset[..., 1],
                offset[..., 2] * np.cos(h) + offset[..., 0] * np.sin(h),
            ],
            axis=-1,
        )
        / row["scale"]
    )
    a = np.clip(field[:, None, 0] + (field[:, None, 1:] * own).sum(-1), 0.0, 1.0)
    s = cloud_billboard.place(spread.centers.astype(float), row["scale"], m, h, row["shear"])[
        :, None
    ]
    half = stored.half * row["scale"]
    lean = np.hypot(*row["shear"])
    half = np.array([half[0] + lean * half[1], half[1], half[2] + lean * half[1]])
    half[[0, 2]] = max(half[0], half[2])
    thick = 1.0 / (400.0 * row["scale"])
    body = Body(half, stored.base * row["scale"], 0.4, 0.3, thick, 300.0, row["shaded"])
    lit = cloud_light.full_light(v, s, w, a, body, surround_of(view_of(frame)), (0.7, 0.9, 1.1))
    np.testing.assert_allclose(found["vs_lit"], encode(lit.lit), atol=2e-3)
    np.testing.assert_allclose(found["vs_shade"], encode(lit.shade), atol=2e-3)
    np.testing.assert_allclose(found["vs_rim"], lit.rim, atol=2e-3)
    np.testing.assert_allclose(found["vs_fade"][..., 3], lit.facing, atol=2e-3)
    np.testing.assert_allclose(found["vs_relief"][..., 2], lit.soft, atol=2e-3)


def test_growth_0_is_nothing_and_1_is_all_from_either_side() -> None:
    order = np.linspace(0.0, 1.0, 50)
    for mode in (0.0, 0.3, 1.0):
        assert not cloud_billboard.presence(0.0, mode, order).any()
        assert (cloud_billboard.presence(1.0, mode, order) == 1.0).all()
    half = cloud_billboard.presence(0.5, 0.0, order)
    assert half[0] == 1.0
    assert half[-1] == 0.0
    np.testing.assert_allclose(cloud_billboard.presence(0.5, 1.0, order), half[::-1], atol=1e-12)


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.floats(0.0, 0.2))
def test_a_billboard_never_goes_while_the_cloud_grows(
    growth: float, mode: float, order: float, more: float
) -> None:
    now = cloud_billboard.presence(growth, mode, order)
    assert 0.0 <= now <= cloud_billboard.presence(min(growth + more, 1.0), mode, order) <= 1.0


def test_light_is_less_the_more_is_absorbed_and_the_base_is_dark() -> None:
    light = surround((0.0, 0.8, 0.6), (1, 0.95, 0.9), (0.2, 0.3, 0.6), (0.5, 0.6, 0.7), (0.2,) * 3)
    body = Body(np.array([500.0, 200.0, 500.0]), -190.0, thick=1.0 / 50.0)
    w = np.array([[1.0, 0.0, 0.0]] * 2)
    v = np.array([[0.0, 150.0, 0.0], [0.0, -150.0, 0.0]])
    s = v
    none, half, all_ = (
        cloud_light.full_light(v, s, w, np.full(2, a), body, light) for a in (0.0, 0.5, 1.0)
    )
    for more, less in ((none, half), (half, all_)):
        assert (more.lit > less.lit).all()
        assert (more.facing >= less.facing).all()
    assert (none.lit[0] > none.lit[1]).all()
    assert none.facing[0] > 0.8 > 0.4 > none.facing[1]
    dark = cloud_light.full_light(
        v, s, w, np.full(2, 0.5), Body(body.half_size, -190.0, 1.0, thick=body.thick), light
    )
    assert (dark.lit[1] < 0.7 * half.lit[1]).all()


def test_a_top_is_in_the_sun_whatever_its_seed_has_lost() -> None:
    """A seed as high as the cloud is lit by what its middle loses; its top loses no such thing."""
    light = surround((0.0, 0.6, 0.8), (1, 0.95, 0.9), (0.2, 0.3, 0.6), (0.5, 0.6, 0.7), (0.2,) * 3)
    body = Body(np.array([3000.0, 800.0, 3000.0]), -800.0, 0.85, thick=1.0 / 1500.0)
    high = np.array([-800.0, 0.0, 600.0, 800.0])
    v = np.stack([0.0 * high, high, 0.0 * high], axis=1)
    down = np.array([[0.0, -1.0, 0.0]] * 4)
    lit = cloud_light.full_light(v, 0.0 * v, down, np.ones(4), body, light).lit[:, 0]
    assert (np.diff(lit) > 0.0).all()
    clear = cloud_light.full_light(v, 0.0 * v, down, np.zeros(4), body, light).lit[:, 0]
    assert lit[3] == pytest.approx(clear[3])
    assert lit[0] < 0.7 * clear[0]
    # And a dark base makes no dark top.
    fair = cloud_light.full_light(
        v, 0.0 * v, down, np.ones(4), Body(body.half_size, -800.0, 0.0, thick=body.thick), light
    ).lit[:, 0]
    assert lit[3] > 0.95 * fair[3]
    assert lit[0] < 0.6 * fair[0]


def test_of_a_tower_only_the_foot_is_dark() -> None:
    light = surround((0.0, 0.6, 0.8), (1, 0.95, 0.9), (0.2, 0.3, 0.6), (0.5, 0.6, 0.7), (0.2,) * 3)
    body = Body(np.array([3000.0, 5000.0, 3000.0]), -5000.0, 0.9, thick=1.0 / 3000.0)
    v = np.array([[0.0, -5000.0, 0.0], [0.0, -5000.0 + cloud_light.FOOT, 0.0], [0.0, 5000.0, 0.0]])
    w = np.array([[1.0, 0.0, 0.0]] * 3)
    lit = cloud_light.full_light(v, v, w, np.zeros(3), body, light).lit[:, 0]
    assert lit[0] < 0.5 * lit[1]
    assert lit[1] == pytest.approx(lit[2], rel=0.1)


def test_a_low_sun_shines_under_a_base_and_higher_up_first() -> None:
    suns = np.linspace(0.0, 1.0, LEVELS)[:, None] * np.ones(3)
    body = Body(np.array([500.0, 200.0, 500.0]), -190.0, 0.9, thick=1.0 / 400.0, height=1500.0)
    v, w = np.array([[0.0, -180.0, 0.0]]), np.array([[0.0, 1.0, 0.0]])

    def lit(y: float, height: float = 1500.0) -> float:
        towards = (math.sqrt(1.0 - y * y), y, 0.0)
        dark = (0.0, 0.0, 0.0)
        light = surround(towards, (1, 1, 1), dark, dark, dark, suns)
        there = replace(body, height=height)
        return float(cloud_light.full_light(v, v, w, np.zeros(1), there, light).lit[0, 0])

    assert lit(0.0) > 1.8 * lit(0.5)
    assert lit(0.0, 9000.0) > 2.0 * lit(0.0) > 4.0 * lit(0.0, 200.0)


def test_the_lining_is_towards_the_sun_and_at_the_rim() -> None:
    light = surround((0.0, 0.0, -1.0), (1, 1, 1), (0.2, 0.3, 0.6), (0.5, 0.6, 0.7), (0.2,) * 3)
    body = Body(np.array([500.0, 300.0, 500.0]), -300.0)
    v = np.array([[0.0, 290.0, 0.0], [0.0, 10.0, 0.0]])

    def rim(z: float) -> NDArray:
        w = np.array([[0.0, 0.0, z]] * 2)
        return cloud_light.full_light(v, 0.0 * v, w, np.zeros(2), body, light).rim[:, 0]

    against, with_it = rim(-1.0), rim(1.0)
    assert against[0] > 5.0 * against[1] > 0.0
    assert against[0] > 20.0 * with_it[0]


def test_haze_thins_with_height_and_grows_with_distance() -> None:
    def share(x: float, y: float, extinction: float = cloud_light.CLEAN) -> float:
        return float(cloud_light.haze_share(np.array([[x, y, 0.0]]), 2.0, extinction)[0])

    # Level at the ground it is Beer and Lambert's law itself.
    assert share(10_000.0, 0.0) == pytest.approx(1.0 - np.exp(-3.912 / 5.0), rel=1e-2)
    assert share(1000.0, 0.0) < share(10_000.0, 0.0) < share(60_000.0, 0.0) < 1.0
    assert share(20_000.0, 8_000.0) < 0.7 * share(20_000.0, 500.0)
    # Fog hides what is level, and far less of what is overhead.
    assert share(3000.0, 0.0, 0.01) > 0.99
    assert share(0.0, 3000.0, 0.01) < 0.85
    # Against sampling along the way.
    t = (np.arange(20_000) + 0.5) / 20_000
    for x, y in ((9000.0, 2500.0), (40_000.0, 900.0)):
        h = 2.0 + t * y
        depth = (cloud_light.CLEAN * np.exp(-h / cloud_light.CLEAN_HEIGHT)).mean() * np.hypot(x, y)
        assert share(x, y) == pytest.approx(1.0 - np.exp(-depth), rel=1e-3)


def test_the_plain_model_has_no_haze(ctx: moderngl.Context) -> None:
    data = shape(billboards=12, absorbed=0.0)
    far = clouds({"position": (0.0, 40.0, -900.0)})
    fog = FogData(extinction=0.01)
    with cloud_stage(ctx) as stage:
        stage.passes.impostors_on = False
        plain = [
            stage.draw(sky_frame(far, data, fog=f, cloud_look=CloudLook(plain=True)))
            for f in (FogData(), fog)
        ]
        hazy = stage.draw(sky_frame(far, data, fog=fog))
    np.testing.assert_array_equal(plain[0], plain[1])
    assert np.abs(hazy - plain[0]).max() > 0.05


def test_far_clouds_vanish_in_the_sky_as_it_is_drawn() -> None:
    """Whose light is bent below 1, but where the host draws it with a curve of its own."""
    data = shape(billboards=12, absorbed=0.0)
    sky = SkyLight(horizon_color=(0.6, 0.8, 1.1), zenith_color=(0.6, 0.8, 1.1), sun_color=(0, 0, 0))
    center = np.array([[0.0, 300.0, -20_000.0]])
    found = []
    for draw in (True, False):
        air: Any = SimpleNamespace(draw=draw)
        view = view_of(sky_frame(clouds({}), data, sky=sky, atmosphere=air))
        found.append(haze_of(view, surround_of(view), center)[0, :3])
    drawn, own = found
    np.testing.assert_allclose(drawn, shown(np.array([0.6, 0.8, 1.1])), atol=1e-4)
    np.testing.assert_allclose(own, encode(np.array([0.6, 0.8, 1.1])), atol=1e-4)
    assert drawn[2] < 0.9 < 1.0 < own[2]
