"""One point and one line in plain floats, against the arrays' functions."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from weather_ecs.physics.ellipse import line_intersections, nearest_perimeter_point
from weather_ecs.physics.ellipse_point import line_crossings, nearest_point

LENGTH = st.floats(-5000.0, 5000.0)
POINT = st.tuples(LENGTH, LENGTH)
RADIUS = st.floats(0.5, 2000.0)
RADII = st.tuples(RADIUS, RADIUS).map(lambda pair: (max(pair), min(pair)))
HEADING = st.floats(-7.0, 7.0)


@given(POINT, POINT, RADII, HEADING)
def test_the_nearest_point_is_that_of_the_arrays(at, center, radii, heading):
    expected = nearest_perimeter_point(at, center, radii, heading)
    found = nearest_point(at, center, radii, heading)
    # Of two as near either may be meant: what counts is how far it is.
    assert math.isclose(math.dist(found, at), math.dist(expected, at), rel_tol=1e-12, abs_tol=1e-9)
    if math.dist(at, center) > 1.1 * radii[0]:
        assert np.allclose(found, expected, rtol=1e-9, atol=1e-6)


def test_points_on_the_axes_and_in_the_middle():
    for at in ((0.0, 0.0), (3.0, 0.0), (50.0, 0.0), (0.0, 2.0), (0.0, -90.0)):
        for radii in ((20.0, 20.0), (30.0, 10.0)):
            expected = nearest_perimeter_point(at, (0.0, 0.0), radii)
            found = nearest_point(at, (0.0, 0.0), radii, 0.0)
            assert math.isclose(math.dist(found, at), math.dist(expected, at), abs_tol=1e-9)


@given(POINT, st.floats(-math.pi, math.pi), POINT, RADII, HEADING)
def test_a_line_meets_it_where_the_arrays_say(origin, way, center, radii, heading):
    direction = (math.cos(way), -math.sin(way))
    expected = line_intersections(origin, direction, center, radii, heading)
    found = line_crossings(origin, direction, center, radii, heading)
    if len(found) == len(expected):
        assert np.allclose(np.reshape(found, (-1, 2)), expected, rtol=1e-7, atol=1e-3)
    else:  # it all but touches: rounding decides
        both = [*found, *expected.tolist()]
        assert max(math.dist(p, q) for p in both for q in both) < 1e-2 * radii[0]


def test_a_line_that_misses_touches_and_crosses():
    for x, count in ((3.0, 0), (2.0, 1), (1.0, 2)):
        assert len(line_crossings((x, -9.0), (0.0, 3.0), (0.0, 0.0), (4.0, 2.0), math.pi / 2)) == (
            count
        )
    first, second = line_crossings((0.0, -9.0), (0.0, 2.0), (0.0, 0.0), (4.0, 2.0), 0.0)
    assert np.allclose([first, second], [(0.0, -2.0), (0.0, 2.0)])
