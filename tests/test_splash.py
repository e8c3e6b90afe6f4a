"""Splashes: the laws, the texture, and both shaders against their oracle."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import moderngl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.rain_frames import lights
from tests.splash_capture import PICTURE, SplashCapture, impacts, law_of
from tests.splash_views import LOOK, view_at
from tests.streak_capture import view_of
from weather_ecs.frame import RippleData, WindProfile
from weather_ecs.gpu import splash_texture as texture
from weather_ecs.gpu.air_block import flow_of
from weather_ecs.gpu.view_block import encode
from weather_ecs.physics import splash
from weather_ecs.physics.drops import terminal_speed
from weather_ecs.physics.streak import light_on
from weather_ecs.physics.turbulence import eddies


def law(**changes: float) -> splash.SplashLaw:
    return law_of(replace(LOOK, **changes), view_at())


# The laws


def test_weber_number_of_a_drop_at_its_terminal_speed():
    # 2 mm at 6.5 m/s: 1000 * 6.5^2 * 0.002 / 0.0728
    assert splash.weber(np.array(2.0), np.array(6.5)) == pytest.approx(1160.7, rel=1e-3)
    assert splash.spread_radius(np.array(2.0), np.array(6.5)) == pytest.approx(5.84e-3, rel=1e-2)


def test_larger_and_faster_drops_splash_more_and_none_beyond_the_bound():
    diameter = np.linspace(0.5, 6.0, 50)
    weight, seed = np.full(50, 500.0), np.full(50, 0.3)
    radius = splash.crown_radius(diameter, terminal_speed(diameter), weight, seed, law())
    assert (np.diff(radius) > 0.0).all()
    assert radius[0] > 0.005
    assert radius[-1] < LOOK.largest
    slow = splash.crown_radius(diameter, 0.5 * terminal_speed(diameter), weight, seed, law())
    assert (slow < radius).all()


def test_a_splash_that_stands_for_more_is_larger():
    seed = np.random.default_rng(1).random(4000).astype(np.float32)
    sizes = [splash.stature(np.full(4000, w), seed, law()) for w in (1.0, 50.0, 200.0, 5000.0)]
    means = [size.mean() for size in sizes]
    assert means == sorted(means) and means[0] < 0.35 and means[-1] > 2.0
    assert all(s.min() >= splash.SMALLEST and s.max() <= splash.GREATEST for s in sizes)
    # Where it stands for one in `share`, about half of them are small.
    assert 0.3 < (sizes[2] > 1.0).mean() <= 1.0


def test_splashes_grow_with_distance_as_drops_do():
    away = np.linspace(0.0, 20.0, 200)
    factor = splash.near_size(away)
    assert (np.diff(factor) >= 0.0).all() and np.diff(factor).max() < 0.02
    assert factor[0] == splash.NEAREST and factor[-1] == 1.0
    # What they are in the picture still falls with distance.
    assert (np.diff(factor[1:] / away[1:]) < 0.0).all()


def test_a_crown_widens_with_the_root_of_its_age():
    x = np.linspace(0.0, 1.0, 11)
    found = splash.growth(x)
    assert found[0] == splash.FIRST and found[-1] == 1.0
    assert np.allclose((found - splash.FIRST) ** 2, (1.0 - splash.FIRST) ** 2 * x)


@settings(deadline=None, max_examples=60)
@given(
    st.floats(0.0, 1.5), st.floats(0.0, 6.3), st.floats(0.0, 1.0), st.floats(0.0, 30.0),
    st.integers(0, splash.MOST - 1), st.floats(0.0, 0.999),
)  # fmt: skip
def test_droplets_leave_within_the_spread_and_come_back_to_the_plane(
    slope, turn, spread, wind, k, seed
):
    one = replace(law(spread=spread), acceleration=splash.acceleration((wind, 0.0, 0.0), 0.3))
    tilt = math.sin(slope)
    normal = np.array([[tilt * math.cos(turn), math.cos(slope), tilt * math.sin(turn)]])
    seeds = np.array([seed], np.float32)
    velocity, _ = splash.launches(normal, np.array([6.0]), np.array([1.0]), seeds, k, one)
    speed = np.linalg.norm(velocity)
    assert 0.0 < speed <= 6.0 * LOOK.droplet_speed * (1.0 + 1e-9)
    assert (velocity @ normal.T).item() >= speed * math.cos(spread) - 1e-6
    back = splash.landing(normal, velocity, one)
    assert 0.0 < back[0] <= splash.LONGEST
    if back[0] < splash.LONGEST:
        there = splash.way(velocity, back, one)
        assert abs((there * normal).sum()) < 1e-6


def test_wind_carries_droplets_and_gravity_brings_them_down():
    still, windy = law(), replace(law(), acceleration=splash.acceleration((8.0, 0.0, 0.0), 0.3))
    velocity, age = np.array([[0.0, 1.0, 0.0]]), np.array([0.2])
    a, b = splash.way(velocity, age, still), splash.way(velocity, age, windy)
    assert a[0, 1] == b[0, 1] == pytest.approx(0.2 - 0.5 * splash.GRAVITY * 0.04)
    assert b[0, 0] - a[0, 0] == pytest.approx(0.5 * 8.0 * 0.3 / splash.RESPONSE * 0.04)


def test_detail_and_crown_fade_without_a_pop():
    depth = np.arange(0.2, 60.0, 0.05)
    same = np.full(len(depth), 1.0)
    crown, detail = splash.opacities(300.0 * same, depth, 30.0 / depth, 0.3 * same, 0.85, 9.0)
    for opacity in (crown, detail):
        assert np.abs(np.diff(opacity)).max() < 0.2
        assert np.abs(np.diff(opacity[depth > 1.0])).max() < 0.02
    assert (detail[depth > 9.0] == 0.0).all() and (crown[depth > 9.0] > 0.1).any()


# The texture


def test_the_texture_is_always_the_same_and_moves_on_from_frame_to_frame():
    layers = texture.build()
    assert layers.tobytes() == texture.build().tobytes()
    assert layers.shape == (texture.LAYERS, texture.SIZE, texture.SIZE, 2)
    for kind in range(6):
        water = layers[kind * texture.FRAMES : (kind + 1) * texture.FRAMES, ..., 0].astype(int)
        steps = np.abs(np.diff(water, axis=0)).mean(axis=(1, 2))
        shown = 8 if kind == texture.FILM else 14
        assert (steps[:shown] > 0.05).all()
        assert water[0].max() > 100
        # What is not drawn any more has nothing left to show.
        last = int((0.56 if kind == texture.FILM else 0.93) * texture.FRAMES) + 1
        assert water[last:].max() < 32
        assert water[last:].mean() < 0.5


def test_no_picture_is_cut_off_at_its_rim():
    water = texture.build()[..., 0]
    rim = np.concatenate([water[:, 0], water[:, -1], water[:, :, 0], water[:, :, -1]], axis=1)
    assert rim.max() <= 4


def test_a_crown_rises_frays_and_sinks():
    water = texture.build()[: texture.FRAMES, ..., 0].astype(float)
    height = [np.nonzero(one.max(axis=1) > 20)[0].max(initial=0) for one in water[:15]]
    top = int(np.argmax(height))
    assert 3 <= top <= 9 and height[0] < 0.5 * height[top] and height[14] < 0.8 * height[top]
    # The two variants are not each other.
    other = texture.build()[texture.FRAMES : 2 * texture.FRAMES, ..., 0]
    assert np.abs(water - other).mean() > 3.0


# The shaders


@pytest.fixture
def capture(ctx: moderngl.Context) -> Iterator[SplashCapture]:
    made = SplashCapture(ctx)
    yield made
    made.release()


def random_impacts(count: int = 400, time: float = 100.0) -> np.ndarray:
    rng = np.random.default_rng(5)
    diameter = rng.uniform(0.5, 5.0, count)
    place = np.column_stack(
        [rng.uniform(-9, 9, count), np.zeros(count), rng.uniform(-12, 4, count)]
    )
    return impacts(
        count,
        position=place,
        time=time - rng.uniform(-0.05, 0.6, count),
        diameter=diameter,
        speed=terminal_speed(diameter),
        weight=rng.uniform(0.0, 2000.0, count),
        seed=rng.random(count),
    )


def test_looks_are_those_of_the_oracle(capture: SplashCapture):
    lamps = lights(((1.0, 2.0, -2.0), (3.0, 2.0, 1.0), 8.0))
    records, view = random_impacts(), view_at(lights=lamps)
    found = capture.looks(records, view, LOOK)
    one = law_of(LOOK, view)
    r = {name: records[name].astype(np.float64) for name in ("diameter", "speed", "weight")}
    radius = splash.crown_radius(*r.values(), records["seed"], one)
    age = 100.0 - records["time"].astype(np.float64)
    clip = np.column_stack([records["position"], np.ones(len(records))]) @ (
        view.projection @ view.view
    ).T.astype(np.float64)
    ray = records["position"] - np.array(view.position)
    away = np.linalg.norm(ray, axis=1, keepdims=True)
    ray /= away
    radius *= splash.near_size(away[:, 0])
    pixels = radius * 0.5 * PICTURE[1] * view.projection[1, 1] / clip[:, 3]
    crown, detail = splash.opacities(
        r["weight"], clip[:, 3], pixels, ray[:, 1], LOOK.opacity, LOOK.detail
    )
    x = age / LOOK.duration
    crown = np.where(x <= 0.93, crown, 0.0)
    inside = (np.abs(clip[:, :2]) < clip[:, 3:]).all(axis=1) & (clip[:, 3] > 0.3)
    alive = (age > 1e-3) & (age < 0.499) & (np.maximum(crown, detail) > 0.005) & (pixels > 0.21)
    drawn = found.form[:, 0] > 0.0
    assert drawn[inside & alive].all() and drawn.sum() > 80
    assert not drawn[(age < -1e-3) | (age > 0.501)].any()
    assert not drawn[(np.maximum(crown, detail) < 0.003) | (pixels < 0.19)].any()
    sharp = drawn & (np.abs(x - 0.93) > 1e-3)
    assert np.allclose(found.form[sharp, 0], radius[sharp], rtol=2e-3)
    assert np.allclose(found.form[sharp, 1], x[sharp], atol=1e-4)
    assert np.allclose(found.color[sharp, 3], crown[sharp], atol=3e-3)
    assert np.allclose(found.throw[sharp, 2], detail[sharp], atol=3e-3)
    light = encode(light_on(records["position"][sharp], view_of(view, PICTURE[1])))
    assert np.allclose(found.color[sharp, :3], light, atol=6e-3)
    high = np.minimum(splash.stature(r["weight"], records["seed"], one), 1.0)
    pace = r["speed"] * LOOK.droplet_speed * high
    assert np.allclose(found.throw[sharp, 0], pace[sharp], rtol=2e-3)


@pytest.mark.parametrize("turbulence", [0.0, 2.0])
def test_droplets_fly_where_the_oracle_has_them(capture: SplashCapture, turbulence: float):
    look, age = replace(LOOK, droplets=3.0), 0.11
    air = WindProfile(ground=-2.0, turbulence=turbulence, scale=1.5)
    view = view_at(wind=(4.0, 0.0, -2.0), profile=air)
    one = law_of(look, view)
    records = impacts(12, time=100.0 - age)
    records["position"][:, 0] = np.linspace(-1.0, 1.0, 12)
    found = capture.quads(records, view, look)
    high = splash.stature(records["weight"].astype(float), records["seed"], one)
    normal, speed = records["normal"].astype(float), records["speed"].astype(float)
    ages = np.full(12, 100.0 - float(records["time"][0]))
    # Where the eddies have come since the hit.
    carried = records["position"] + np.asarray(view.frame.wind) * ages[:, None]
    pull = np.asarray(one.acceleration) + look.drift / splash.RESPONSE * eddies(
        carried, flow_of(view)
    )
    laws = [replace(one, acceleration=tuple(p)) for p in pull.tolist()]
    expected = []
    for k in range(splash.MOST):
        velocity, thrown = splash.launches(normal, speed, high, records["seed"], k, one)
        each = [(normal[[i]], velocity[[i]], law) for i, law in enumerate(laws)]
        landing = np.concatenate([splash.landing(*it) for it in each])
        flying = thrown & (ages < landing)
        p = records["position"] + np.concatenate(
            [splash.way(v, ages[:1], law) for _, v, law in each]
        )
        v = velocity + pull * ages[:, None]
        ends = []
        for q in (p - v * view.frame.look.exposure * 0.35, p):
            clip = np.column_stack([q, np.ones(12)]) @ (view.projection @ view.view).T
            ends.append(clip[:, :2] / clip[:, 3:])
        expected.append(np.where(flying[:, None], 0.5 * (ends[0] + ends[1]), np.nan))
    order = np.array(expected).transpose(1, 0, 2).reshape(-1, 2)
    order = order[~np.isnan(order[:, 0])]
    assert len(order) > 15
    got = found.droplets
    assert got.shape == order.shape
    assert np.abs(got - order).max() < 4e-3


def test_droplets_die_at_the_second_hit_and_fall_on_over_an_edge(capture: SplashCapture):
    look = replace(LOOK, droplets=5.0, spread=1.2, duration=0.1)
    view = view_at((0.0, 0.8, 2.0), -0.4)
    records = impacts(20, time=100.0 - 0.45, speed=5.0)
    records["position"][:, 0] = -0.03

    def flying() -> int:
        return len(capture.quads(records, view, look).droplets)

    assert flying() == 0  # on level ground all have come down
    capture.ground(edge=0.0)
    over = capture.quads(records, view, look).droplets
    assert 10 < len(over) < 90  # those to the side of the edge, below its height by now
    assert (over[:, 0] > -0.02).all()
    capture.ground(edge=0.0, low=-0.05)
    assert flying() == 0


def test_crowns_stand_on_the_hit_and_face_the_camera(capture: SplashCapture):
    view = view_at()
    records = impacts(8, time=100.0 - 0.15)
    records["position"][:, 0] = np.linspace(-0.9, 0.9, 8)
    found = capture.quads(records, view, replace(LOOK, detail=0.0))
    assert len(found.layer) == 8 and (found.layer < 2 * texture.FRAMES).all()
    assert (found.layer % texture.FRAMES == math.floor(0.5 * texture.FRAMES)).all()
    one = law_of(LOOK, view)
    radius = splash.crown_radius(
        *(records[n].astype(float) for n in ("diameter", "speed", "weight")), records["seed"], one
    ) * splash.growth(np.array(0.5))
    away = np.linalg.norm(records["position"] - np.array(view.position), axis=1)
    radius *= splash.near_size(away)
    clip = np.column_stack([records["position"], np.ones(8)]) @ (view.projection @ view.view).T
    foot = clip[:, :2] / clip[:, 3:]
    low, high = found.ndc[..., :2].min(axis=1), found.ndc[..., :2].max(axis=1)
    assert (low <= foot).all() and (foot <= high).all()
    assert (foot[:, 1] - low[:, 1] < 0.35 * (high - low)[:, 1]).all()  # most of it is above
    wide = (high - low)[:, 0] / view.projection[0, 0] * clip[:, 3]
    assert ((wide > 2.0 * radius) & (wide < 3.4 * radius)).all()
    # A little nearer to the camera than the ground that they stand on, and not by much.
    depth = view.projection[2, 3] / (found.ndc[..., 2] + view.projection[2, 2])
    away = depth.mean(axis=1) - clip[:, 3]
    assert (away < 0.0).all() and (away > -0.2).all()


def test_detail_is_for_what_is_close(capture: SplashCapture):
    def kinds(distance: float) -> set[int]:
        view = view_at((0.0, 1.7, distance), -math.atan2(1.7, distance))
        found = capture.quads(impacts(30, time=99.9), view, LOOK)
        drops = {texture.BEAD} if len(found.droplets) else set()
        return {int(layer) // texture.FRAMES for layer in found.layer} | drops

    crowns = {texture.CROWN, texture.CROWN + 1}
    assert kinds(3.0) == crowns | {texture.FILM, texture.BEAD}
    assert kinds(12.0) == crowns
    assert kinds(400.0) == set()


def test_water_splashes_otherwise_than_ground(capture: SplashCapture):
    pond = RippleData(
        1, (0.0, 0.0, 0.0), (2.0, 1.0), 0.5, True, 0.1, 0.5, 6, 1.0, (0.1, 0.2, 0.2), 1.0, True
    )
    records = impacts(60, time=99.9)
    rng = np.random.default_rng(2)
    records["position"][:, [0, 2]] = rng.uniform(-1.2, 1.2, (60, 2))
    records["position"][:5, 1] = 0.5  # on something that stands in the water
    for ellipse in (True, False):
        water = replace(pond, ellipse=ellipse)
        found = capture.looks(records, view_at(ripples=(water,)), LOOK)
        x, z = records["position"][:, 0], records["position"][:, 2]
        c, s = math.cos(0.5), math.sin(0.5)
        u, w = (x * c - z * s) / 1.0, (x * s + z * c) / 0.5
        inside = u * u + w * w < 1.0 if ellipse else np.maximum(abs(u), abs(w)) < 1.0
        inside[:5] = False
        drawn = found.form[:, 0] > 0.0
        assert drawn.sum() > 40 and 5 < inside.sum() < 55
        assert (found.form[drawn, 2] == inside[drawn]).all()
    quads = capture.quads(records, view_at(ripples=(pond,)), LOOK)
    kinds = {int(layer) // texture.FRAMES for layer in quads.layer}
    assert {texture.BURST, texture.RING, texture.CROWN, texture.FILM} <= kinds
