"""Ellipses against brute force and the identities that define them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics import ellipse

sizes = st.floats(-3.0, 6.0).map(lambda e: 10.0**e)
thinness = st.one_of(st.just(1.0), st.floats(0.0, 6.0).map(lambda e: 10.0**e))
headings = st.floats(-7.0, 7.0)
shares = st.floats(-3.0, 3.0)


def perimeter(angles: NDArray[np.float64], radii: Any) -> NDArray[np.float64]:
    return np.stack((radii[0] * np.cos(angles), radii[1] * np.sin(angles)), axis=-1)


def distance_by_search(own: NDArray[np.float64], radii: Any) -> float:
    """Distance to the perimeter in the ellipse's own axes by a search that narrows itself."""
    best, width = np.linspace(0.0, 2.0 * math.pi, 4001), math.pi / 2000.0
    for _ in range(12):
        gaps = np.hypot(*(perimeter(best, radii) - own).T)
        chosen = best[np.argsort(gaps)[:4]]
        best = (chosen[:, None] + np.linspace(-width, width, 401)).ravel()
        width /= 100.0
    return gaps.min()


def test_implicit_is_equation_1_and_one_on_the_perimeter() -> None:
    angles = np.linspace(0.0, 6.0, 50)
    points = ellipse.world(perimeter(angles, (30.0, 7.0)), (4.0, -9.0), 0.7)
    assert np.allclose(ellipse.implicit(points, (4.0, -9.0), (30.0, 7.0), 0.7), 1.0)
    assert np.array_equal(ellipse.implicit([[3.0, 0.0], [0.0, 1.0]], (0, 0), (2.0, 1.0)), [2.25, 1])
    assert ellipse.implicit((0.0, 0.0), (0.0, 0.0), (2.0, 1.0)).shape == ()


def test_heading_turns_counter_clockwise_seen_from_above() -> None:
    """Seen from above, x to the right and z towards the viewer: a quarter turn ends at -z."""
    tip = ellipse.world((5.0, 0.0), (0.0, 0.0), math.pi / 2)
    assert np.allclose(tip, (0.0, -5.0))
    assert ellipse.implicit((0.0, -5.0), (0, 0), (5.0, 1.0), math.pi / 2) == pytest.approx(1.0)
    assert np.allclose(ellipse.local(tip, (0.0, 0.0), math.pi / 2), (5.0, 0.0))


@given(st.tuples(shares, shares), st.tuples(shares, shares), headings)
def test_world_undoes_local(
    point: tuple[float, float], center: tuple[float, float], heading: float
) -> None:
    back = ellipse.world(ellipse.local(point, center, heading), center, heading)
    assert np.allclose(back, point, atol=1e-12)


@settings(max_examples=60, deadline=None)
@given(sizes, thinness, st.tuples(shares, shares), headings)
def test_nearest_point_is_on_the_perimeter_and_no_point_is_nearer(
    a: float, thin: float, share: tuple[float, float], heading: float
) -> None:
    radii, center = (a, a / thin), (12.0, -7.0)
    own = np.array(share) * radii
    point = ellipse.world(own, center, heading)
    foot = ellipse.nearest_perimeter_point(point, center, radii, heading)
    scale = a + np.hypot(*own) + 14.0  # rounding of the world coordinates
    found = np.hypot(*(foot - point))
    assert found == pytest.approx(distance_by_search(own, radii), rel=1e-9, abs=1e-13 * scale)
    off = ellipse.edge_distance(foot, center, radii, heading)
    assert abs(off) <= 1e-13 * scale


@settings(max_examples=80, deadline=None)
@given(thinness, st.floats(0.0, 2.0 * math.pi), st.floats(-0.999, 3.0))
def test_nearest_point_undoes_a_step_along_the_normal(
    thin: float, angle: float, step: float
) -> None:
    """From a perimeter point along its normal; inwards not as far as the major axis."""
    radii = np.array((1.0, 1.0 / thin))
    foot = perimeter(np.array(angle), radii)
    gradient = np.hypot(*(foot / radii**2))
    normal = foot / radii**2 / gradient
    point = foot + normal * step * (radii[1] ** 2 * gradient if step < 0.0 else 1.0)
    found = ellipse.nearest_perimeter_point(point, (0, 0), radii)
    here, there = np.hypot(*(point - foot)), np.hypot(*(point - found))
    assert there == pytest.approx(here, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(
    ("point", "foot"),
    [
        ((0.0, 0.0), (0.0, 1.0)),  # the centre: the end of the minor axis
        ((5.0, 0.0), (2.0, 0.0)),  # outside on the major axis
        ((-5.0, 0.0), (-2.0, 0.0)),
        ((1.9, 0.0), (2.0, 0.0)),  # inside, past the centre of curvature at 1.5
        ((1.5, 0.0), (2.0, 0.0)),
        ((0.0, 9.0), (0.0, 1.0)),
        ((0.0, -0.25), (0.0, -1.0)),
        ((2.0, 0.0), (2.0, 0.0)),  # on the perimeter
        ((0.75, 0.0), (1.0, math.sqrt(0.75))),  # inside on the major axis: off the axis
    ],
)
def test_nearest_point_in_special_places(
    point: tuple[float, float], foot: tuple[float, float]
) -> None:
    assert np.allclose(ellipse.nearest_perimeter_point(point, (0, 0), (2.0, 1.0)), foot, atol=1e-12)
    thin = ellipse.nearest_perimeter_point(np.array(point) * (1e6, 1.0), (0, 0), (2e6, 1.0))
    assert ellipse.implicit(thin, (0, 0), (2e6, 1.0)) == pytest.approx(1.0)


@pytest.mark.parametrize("across", [1e-3, 1e-9, 1e-100, 1e-200, 5e-324, 0.0])
@pytest.mark.parametrize("along", [0.0, 0.3, 0.75, 1.49999999, 1.5, 1.6, 2.0, 3.0])
def test_nearest_point_is_continuous_towards_the_major_axis(along: float, across: float) -> None:
    foot = ellipse.nearest_perimeter_point((along, across), (0, 0), (2.0, 1.0))
    axis = ellipse.nearest_perimeter_point((along, 0.0), (0, 0), (2.0, 1.0))
    assert np.hypot(*(foot - (along, across))) == pytest.approx(
        np.hypot(*(axis - (along, 0.0))), abs=1.01 * across + 1e-15
    )
    assert foot[1] >= 0.0


def test_nearest_point_of_a_circle_and_of_many_points() -> None:
    points = np.random.default_rng(4).normal(size=(500, 2)) * 5.0
    feet = ellipse.nearest_perimeter_point(points, (1.0, 2.0), (3.0, 3.0), 0.4)
    way = points - (1.0, 2.0)
    expected = (1.0, 2.0) + 3.0 * way / np.hypot(*way.T)[:, None]
    assert feet.shape == (500, 2)
    assert np.allclose(feet, expected)
    alone = [ellipse.nearest_perimeter_point(p, (1, 2), (4.0, 0.5), 0.4) for p in points]
    assert np.allclose(ellipse.nearest_perimeter_point(points, (1, 2), (4.0, 0.5), 0.4), alone)
    centre = ellipse.nearest_perimeter_point((1.0, 2.0), (1.0, 2.0), (3.0, 3.0))
    assert np.hypot(*(centre - (1.0, 2.0))) == pytest.approx(3.0)


@settings(max_examples=100)
@given(thinness, headings, st.floats(0, 6.28), st.floats(0, 6.28), st.floats(-20.0, 20.0))
def test_line_through_two_perimeter_points_finds_both(
    thin: float, heading: float, first: float, second: float, back: float
) -> None:
    assume(abs(math.remainder(first - second, 2.0 * math.pi)) > 0.05)
    radii, center = (50.0, 50.0 / thin), (-3.0, 8.0)
    p, q = ellipse.world(perimeter(np.array((first, second)), radii), center, heading)
    found = ellipse.line_intersections(p + back * (q - p), q - p, center, radii, heading)
    assert found.shape == (2, 2)
    assert np.allclose(found, (p, q), atol=1e-5 if thin > 1e3 else 1e-9)
    backwards = ellipse.line_intersections(p, p - q, center, radii, heading)
    assert np.allclose(backwards, (q, p), atol=1e-5 if thin > 1e3 else 1e-9)


@pytest.mark.parametrize("heading", [0.0, 0.5, 2.0, -1.2])
@pytest.mark.parametrize("angle", [0.0, 0.4, 1.3, 4.0])
def test_tangent_line_touches_once(heading: float, angle: float) -> None:
    radii, center = (9.0, 4.0), (100.0, -50.0)
    touch = ellipse.world(perimeter(np.array(angle), radii), center, heading)
    along = (-radii[0] * math.sin(angle), radii[1] * math.cos(angle))
    way = ellipse.world(along, (0.0, 0.0), heading)
    out = (touch - center) / np.hypot(*(touch - center))
    found = ellipse.line_intersections(touch - 3.0 * way, way, center, radii, heading)
    assert found.shape == (1, 2)
    assert np.allclose(found[0], touch, atol=1e-6)
    beside = ellipse.line_intersections(touch + 1e-6 * out, way, center, radii, heading)
    assert beside.shape == (0, 2)
    within = ellipse.line_intersections(touch - 1e-6 * out, way, center, radii, heading)
    assert within.shape == (2, 2)


@settings(max_examples=60, deadline=None)
@given(st.tuples(shares, shares), st.floats(0, 6.28), thinness.filter(lambda t: t < 100), headings)
def test_chord_is_the_part_of_the_ray_that_is_inside(
    share: tuple[float, float], bearing: float, thin: float, heading: float
) -> None:
    radii, center = (20.0, 20.0 / thin), (5.0, 6.0)
    start = ellipse.world(np.array(share) * radii, center, heading)
    way = 2.5 * np.array((math.cos(bearing), math.sin(bearing)))
    enter, leave = ellipse.chord(start, way, center, radii, heading)
    steps = np.linspace(0.0, 80.0, 20001)
    inside = ellipse.implicit(start + steps[:, None] * way, center, radii, heading) < 1.0
    assert 0.0 <= enter <= leave
    assert leave - enter == pytest.approx(inside.mean() * 80.0, abs=0.01)
    if inside.any():
        assert enter == pytest.approx(steps[inside][0], abs=0.005)


def test_chord_of_many_rays_and_of_vertical_ones() -> None:
    starts = np.array(((-10.0, 0.0), (10.0, 0.0), (0.0, 0.0), (0.0, 5.0), (0.0, 0.0), (9.0, 0.0)))
    ways = np.array(((1.0, 0), (1.0, 0), (2.0, 0), (1.0, 0), (0.0, 0.0), (0.0, 0.0)))
    enter, leave = ellipse.chord(starts, ways, (0, 0), (4.0, 2.0))
    assert np.allclose(enter, (6.0, 0, 0, 0, 0, 0))
    assert np.allclose(leave, (14.0, 0, 2.0, 0, np.inf, 0))
    one = ellipse.chord((-10.0, 0.0), (1.0, 0.0), (0, 0), (4.0, 2.0))
    assert np.allclose(one, (6.0, 14.0))


def test_edge_distance_is_exact_on_axes_and_circles_and_first_order_at_the_edge() -> None:
    along = np.array(((3.0, 0.0), (-9.0, 0.0), (13.0, 0.0), (0.0, 1.0), (0.0, -5.5), (0.0, 0.0)))
    assert np.allclose(ellipse.edge_distance(along, (0, 0), (10.0, 4.0)), (7, 1, -3, 3, -1.5, 4))
    points = np.random.default_rng(1).normal(size=(200, 2)) * 3.0
    distance = ellipse.edge_distance(points, (0, 0), (5.0, 5.0), 1.0)
    assert np.allclose(distance, 5.0 - np.hypot(*points.T))
    angles = np.linspace(0.0, 6.0, 40)
    edge = perimeter(angles, (10.0, 4.0))
    normal = edge / (100.0, 16.0)
    inside = edge - 1e-4 * normal / np.hypot(*normal.T)[:, None]
    assert np.allclose(ellipse.edge_distance(inside, (0, 0), (10.0, 4.0)), 1e-4, rtol=1e-3)


@given(sizes, thinness, st.tuples(shares, shares), headings)
def test_edge_distance_has_the_sign_of_inside_and_stays_finite(
    a: float, thin: float, share: tuple[float, float], heading: float
) -> None:
    radii = (a, a / thin)
    point = ellipse.world(np.array(share) * radii, (0.0, 0.0), heading)
    distance = ellipse.edge_distance(point, (0, 0), radii, heading)
    rho = math.sqrt(ellipse.implicit(point, (0, 0), radii, heading))
    assert np.isfinite(distance)
    assert distance <= a * (1.0 + 1e-15)
    assert (distance > 0.0) == (rho < 1.0)
    near = ellipse.edge_distance((1e-200 * a, 1e-200 * a), (0, 0), radii, heading)
    assert radii[1] * 0.999 <= near <= a * 1.001


def test_edge_factor_is_a_smoothstep_inside_and_nothing_outside() -> None:
    line = np.stack((np.linspace(0.0, 30.0, 301), np.zeros(301)), axis=-1)
    factor = ellipse.edge_factor(line, (0, 0), (20.0, 15.0), 0.0, 10.0)
    assert np.all(factor[:101] == 1.0)
    assert factor[150] == pytest.approx(0.5)
    assert factor[125] == pytest.approx(0.75**2 * 1.5)
    assert np.all(factor[200:] == 0.0)
    assert np.all(np.diff(factor) <= 0.0)
    hard = ellipse.edge_factor(line, (0, 0), (20.0, 15.0))
    assert np.array_equal(hard, (line[:, 0] < 20.0).astype(float))
    wide = ellipse.edge_factor((0.0, 0.0), (0, 0), (20.0, 15.0), 0.0, math.inf)
    assert wide == 1.0


BAD_RADII = [
    (0, 0),
    (1, 0),
    (-2, 1),
    (1, 2),
    (math.nan, 1),
    (2, math.nan),
    (math.inf, 1),
    (2,),
    "ab",
]
CALLS = [
    lambda **k: ellipse.implicit(k["point"], k["center"], k["radii"], k["heading"]),
    lambda **k: ellipse.nearest_perimeter_point(k["point"], k["center"], k["radii"], k["heading"]),
    lambda **k: ellipse.line_intersections(
        k["point"], (1.0, 0.0), k["center"], k["radii"], k["heading"]
    ),
    lambda **k: ellipse.chord(k["point"], (1.0, 0.0), k["center"], k["radii"], k["heading"]),
    lambda **k: ellipse.edge_distance(k["point"], k["center"], k["radii"], k["heading"]),
    lambda **k: ellipse.edge_factor(k["point"], k["center"], k["radii"], k["heading"], 1.0),
]


@pytest.mark.parametrize("call", CALLS)
def test_bad_input_is_named(call: Callable[..., object]) -> None:
    good = {"point": (1.0, 1.0), "center": (0.0, 0.0), "radii": (2.0, 1.0), "heading": 0.0}
    call(**good)
    for radii in BAD_RADII:
        with pytest.raises(InvalidValueError, match="radii"):
            call(**good | {"radii": radii})
    for point in [(math.nan, 0.0), (math.inf, 0.0), (1.0, 2.0, 3.0), 4.0, None]:
        with pytest.raises(InvalidValueError):
            call(**good | {"point": point})
    for heading in [math.nan, math.inf, "north", None]:
        with pytest.raises(InvalidValueError, match="heading"):
            call(**good | {"heading": heading})
    with pytest.raises(InvalidValueError):
        call(**good | {"center": (math.nan, 0.0)})


def test_bad_directions_and_soft_edges() -> None:
    for way in [(0.0, 0.0), (math.nan, 1.0), (1.0, 0.0, 0.0)]:
        with pytest.raises(InvalidValueError):
            ellipse.line_intersections((0.0, 0.0), way, (0, 0), (2.0, 1.0))
    for soft in [-1.0, math.nan]:
        with pytest.raises(InvalidValueError, match="soft_edge"):
            ellipse.edge_factor((0.0, 0.0), (0, 0), (2.0, 1.0), 0.0, soft)
