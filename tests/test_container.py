"""Where the container stands: near, far, and the way between."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from weather_ecs.physics import ellipse
from weather_ecs.physics.camera import wrap_angle
from weather_ecs.physics.container import (
    Area,
    Container,
    ContainerSettings,
    births,
    place,
    radial_positions,
    size_factor,
)

AREA = Area((10.0, -70.0), (70.0, 45.0), 0.4, 400.0)
SIZE = ContainerSettings(40.0, 24.0, 0.75)
HALF = math.radians(45.0)


def at(
    position: tuple[float, float],
    heading: float,
    previous: Container | None = None,
    half: float = HALF,
    dt: float = 1 / 60,
    area: Area = AREA,
) -> Container:
    return place(area, (position[0], 1.7, position[1]), heading, half, SIZE, previous, dt)


def holds(container: Container, point: tuple[float, float]) -> bool:
    """Whether a point (x, z) lies in the container's footprint."""
    q = ellipse.local(point, container.center, container.heading)
    forward, lateral = q[..., 0] / container.reach[0], q[..., 1] / container.reach[1]
    return bool((container.whole or forward >= 0) and forward**2 + lateral**2 <= 1)


def test_near_container_is_centred_on_the_observer() -> None:
    c = at((10.0, -70.0), 0.3)
    assert c.near and not c.whole and c.visible and c.distance == 0.0
    assert math.dist(c.center, (10.0, -70.0)) <= SIZE.margin + 0.25 + 1e-9
    assert c.reach == (40.0, 40.0) and c.height == 24.0 and c.size_scale == 1.0


def test_moves_and_turns_inside_the_margin_leave_it_where_it_is() -> None:
    first = at((10.0, -70.0), 0.3)
    moved = at((10.3, -70.4), 0.3 + 0.4, first)
    assert (moved.center, moved.heading, moved.bottom) == (
        first.center, first.heading, first.bottom,
    )  # fmt: skip


def test_past_the_margin_it_follows_and_turns_to_the_view() -> None:
    first = at((10.0, -70.0), 0.3)
    far = at((16.0, -70.0), 0.3, first)
    assert math.dist(far.anchor, (16.0, -70.0)) == pytest.approx(SIZE.margin)
    margin = math.pi / 2 - HALF
    kept = at((10.0, -70.0), 0.3 + margin - 0.01, first)
    turned = at((10.0, -70.0), 0.3 + margin + 0.01, first)
    assert kept.heading == first.heading
    assert turned.heading == pytest.approx(0.3 + margin + 0.01)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.floats(-4, 4), st.floats(-4, 4), st.floats(-1, 1)), max_size=30))
def test_no_view_ever_shows_the_omitted_half(moves: list[tuple[float, float, float]]) -> None:
    x, z, heading, c = 10.0, -70.0, 0.0, None
    for dx, dz, turn in moves:
        x, z = x + dx, z + dz
        heading = wrap_angle(heading + turn)
        c = at((x, z), heading, c, area=Area((0, 0), (900.0, 900.0), 0.0, 400.0))
        for azimuth in np.linspace(-HALF, HALF, 7) + heading:
            for r in (0.05, 5.0, 30.0):
                assert holds(c, (x + r * math.cos(azimuth), z - r * math.sin(azimuth)))


def test_a_view_too_wide_gets_the_whole_cylinder() -> None:
    assert at((10.0, -70.0), 0.0, half=math.radians(85)).whole
    assert at((10.0, -70.0), 0.0, half=math.pi).whole


@given(st.floats(0, 2 * math.pi), st.floats(-math.pi, math.pi))
def test_at_distance_zero_far_equals_near(turn: float, heading: float) -> None:
    direction = np.array([math.cos(turn), math.sin(turn)])
    rim = ellipse.nearest_perimeter_point(
        np.array(AREA.center) + 200 * direction, AREA.center, AREA.radii, AREA.heading
    )
    inward = (np.array(AREA.center) - rim) * 1e-7
    near = at(tuple(rim + inward), heading)
    far = at(tuple(rim - inward), heading)
    assert near.near and not far.near
    assert np.allclose(near.center, far.center, atol=1e-3)
    assert np.allclose(near.reach, far.reach, atol=1e-3)
    assert near.height == pytest.approx(far.height, abs=1e-3)
    assert abs(wrap_angle(near.heading - far.heading)) < 1e-3
    assert near.share == pytest.approx(far.share, abs=1e-4)
    assert near.size_scale == pytest.approx(far.size_scale, abs=1e-4)


def test_far_container_stands_at_the_nearest_point_and_fits_the_view() -> None:
    observer = (10.0, 130.0)
    toward = math.pi / 2  # heading along -z
    c = at(observer, toward)
    p = ellipse.nearest_perimeter_point(observer, AREA.center, AREA.radii, AREA.heading)
    assert c.anchor == pytest.approx(tuple(p))
    assert c.distance == pytest.approx(math.dist(observer, p))
    # All of the ellipse is in view, so its farthest points lie in the footprint's width and depth.
    t = np.linspace(0, 2 * math.pi, 400)
    rim = ellipse.world(np.stack([70 * np.cos(t), 45 * np.sin(t)], 1), AREA.center, AREA.heading)
    along = np.array([math.cos(c.heading), -math.sin(c.heading)])
    across = np.array([math.sin(c.heading), math.cos(c.heading)])
    assert np.max((rim - p) @ along) == pytest.approx(c.reach[0], rel=0.01)
    assert np.max(np.abs((rim - p) @ across)) == pytest.approx(c.reach[1], rel=0.01)
    assert c.height > SIZE.height and c.bottom + c.height <= AREA.ceiling + 1e-6


def test_a_part_in_view_is_fitted_narrower_than_the_whole() -> None:
    wide = Area((0.0, -300.0), (600.0, 150.0), 0.0, 400.0)
    narrow = at((0.0, 0.0), math.pi / 2, half=math.radians(10), area=wide)
    broad = at((0.0, 0.0), math.pi / 2, half=math.radians(60), area=wide)
    assert narrow.reach[1] < 0.5 * broad.reach[1]


def test_seen_where_the_nearest_point_is_out_of_the_picture() -> None:
    """The paper's own test would drop this rain: P is beside the picture, the far end in it."""
    long = Area((0.0, -20.0), (400.0, 15.0), 0.0, 400.0)
    c = at((0.0, 20.0), math.radians(10), half=math.radians(20), area=long)
    bearing = math.atan2(20.0 - c.anchor[1], c.anchor[0])
    assert abs(wrap_angle(bearing - math.radians(10))) > math.radians(20)
    assert c.visible


def test_behind_the_observer_it_is_not_visible() -> None:
    assert not at((10.0, 130.0), -math.pi / 2).visible


@pytest.mark.parametrize("speed", [1.4, 6.0])
def test_a_straight_walk_changes_the_container_smoothly(speed: float) -> None:
    c, before = None, None
    for k in range(int(160 / speed * 60)):
        z = 60.0 - k * speed / 60
        c = at((10.0, z), math.pi / 2, c)
        if before is not None:
            assert math.dist(c.center, before.center) < 0.35
            assert abs(wrap_angle(c.heading - before.heading)) < 0.1
            assert np.allclose(c.reach, before.reach, atol=0.9)
            assert abs(c.height - before.height) < 0.3
            assert abs(c.share - before.share) < 0.01
        before = c


def test_birth_records_follow_equation_2() -> None:
    record = births(200_000, np.random.default_rng(3))
    d = np.hypot(record[:, 0], record[:, 1])
    share = np.histogram(d, 10, (0, 1))[0] / len(d)
    edges = np.linspace(0, 1, 11)
    expected = (1 - edges[:-1]) ** 2 - (1 - edges[1:]) ** 2
    assert np.allclose(share, expected, atol=0.004)
    assert (record[:, 0] >= 0).all() and (record[:, 2] >= d - 1e-6).all()
    assert (record[:, 2] <= 1).all()
    assert np.histogram(record[:, 2], 10, (0, 1))[0] / len(d) == pytest.approx(0.1, abs=0.005)


def test_public_laws() -> None:
    assert size_factor(0.0, 5.0) == 1.0 and size_factor(1.0, 5.0) == 5.0
    d = radial_positions(100_000, np.random.default_rng(0))
    assert d.mean() == pytest.approx(1 / 3, abs=0.005)
