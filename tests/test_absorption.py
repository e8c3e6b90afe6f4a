"""Path lengths through boxes: against sampling along the ray, and cases that are known."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.absorption import absorbed, path_lengths, path_lengths_to

AXES = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1)]


def sampled(centers, sizes, direction, reach=None, n=20_000):
    """Metres inside all boxes by brute force: points along the ray, box by box."""
    direction = np.asarray(direction, float) / np.linalg.norm(direction)
    if reach is None:
        reach = 2.0 * (np.abs(centers).max() + sizes.max()) * 2.0
    t = (np.arange(n) + 0.5) * (reach / n)
    out = []
    for center in centers:
        points = center + t[:, None] * direction
        inside = np.abs(points[:, None, :] - centers[None]) <= 0.5 * sizes[None]
        out.append(inside.all(axis=2).sum() * reach / n)
    return np.array(out)


@pytest.mark.parametrize("direction", [*AXES, (1, 2, 3), (-1, 0.5, 0), (0.3, -1, 0.2)])
def test_lengths_are_those_of_samples_along_the_ray(direction):
    rng = np.random.default_rng(4)
    centers, sizes = rng.uniform(-50, 50, (12, 3)), rng.uniform(10, 60, (12, 3))
    got = path_lengths(centers, sizes, direction)
    # A sample's step is 440 m / 20 000; each box can be wrong by one at either end.
    assert got == pytest.approx(sampled(centers, sizes, direction), abs=12 * 2 * 0.022)
    assert np.all(got > 0.0)


@pytest.mark.parametrize("axis", AXES)
def test_a_box_alone_counts_from_its_centre(axis):
    size = np.array([[20.0, 60.0, 100.0]])
    got = path_lengths([[5.0, 6.0, 7.0]], size, axis)
    assert got == pytest.approx(0.5 * np.abs(axis) @ size[0])


def test_the_ray_of_a_diagonal_leaves_by_the_corner():
    assert path_lengths([[0, 0, 0]], [[2, 4, 6]], (1, 2, 3)) == pytest.approx(math.sqrt(14))


def test_boxes_that_overlap_are_added():
    """A column: three boxes of 100 m, the upper two overlapping by half."""
    centers, sizes = [[0, 0, 0], [0, 100, 0], [0, 150, 0]], [[100.0] * 3] * 3
    assert path_lengths(centers, sizes, (0, 1, 0)).tolist() == [250.0, 150.0, 50.0]
    assert path_lengths(centers, sizes, (0, -1, 0)).tolist() == [50.0, 150.0, 250.0]
    assert path_lengths(centers, sizes, (1, 0, 0)).tolist() == [50.0, 100.0, 50.0]  # on a face


def test_a_face_that_two_boxes_share_counts_once():
    centers, sizes = [[0, 0, 0], [100, 0, 50], [100, 0, -50]], [[100.0] * 3] * 3
    for order in ([0, 1, 2], [0, 2, 1]):
        got = path_lengths(np.array(centers)[order], sizes, (1, 0, 0))
        assert got[0] == 150.0


def test_light_near_by_ends_the_ray():
    centers, sizes = [[0, 0, 0], [0, 100, 0]], [[100.0] * 3] * 2
    assert path_lengths_to(centers, sizes, (0, 1e6, 0)).tolist() == [150.0, 50.0]
    assert path_lengths_to(centers, sizes, (0, 110, 0)).tolist() == [110.0, 10.0]
    assert path_lengths_to(centers, sizes, (0, 100, 0)).tolist() == [100.0, 0.0]  # in a centre
    assert path_lengths_to(centers, sizes, (0, 20, 0)).tolist() == [20.0, 80.0]
    got = path_lengths_to(centers, sizes, (30.0, 10.0, 5.0))
    assert got[0] == pytest.approx(math.sqrt(900 + 100 + 25))


def test_far_light_near_by_is_light_from_its_direction():
    rng = np.random.default_rng(7)
    centers, sizes = rng.uniform(-50, 50, (9, 3)), rng.uniform(10, 60, (9, 3))
    direction = np.array([0.3, 0.8, -0.2])
    near = path_lengths_to(centers, sizes, direction * 1e9)
    assert near == pytest.approx(path_lengths(centers, sizes, direction), abs=1e-3)


@settings(deadline=None, max_examples=60)
@given(
    st.lists(
        st.tuples(*[st.floats(-1e6, 1e6)] * 3, *[st.floats(1e-3, 1e6)] * 3), min_size=1, max_size=6
    ),
    st.tuples(*[st.floats(-1e300, 1e300)] * 3).filter(any),
)
def test_lengths_are_finite_positive_and_turn_with_nothing(boxes, direction):
    array = np.array(boxes)
    centers, sizes = array[:, :3], array[:, 3:]
    got = path_lengths(centers, sizes, direction)
    assert np.all(np.isfinite(got))
    own = 0.5 * sizes.min(axis=1)
    assert np.all(got >= own * (1.0 - 1e-9))  # at least to the nearest face of its own box
    assert np.all(got <= np.linalg.norm(sizes, axis=1).sum() * (1.0 + 1e-9))
    rows = [path_lengths(centers, sizes, direction, slice(i, i + 1))[0] for i in range(len(got))]
    assert got == pytest.approx(rows)


def test_many_boxes_are_done_in_parts():
    n = 1500  # more pairs than are held at once
    centers = np.zeros((n, 3))
    centers[:, 1] = 10.0 * np.arange(n)
    got = path_lengths(centers, np.full((n, 3), 10.0), (0, 1, 0))
    assert got == pytest.approx(5.0 + 10.0 * np.arange(n)[::-1])


def test_absorption_is_a_share():
    """The dissertation's own words: light that loses its strength after 10 m."""
    assert absorbed([0.0, 2.5, 10.0, 40.0], 10.0).tolist() == [0.0, 0.25, 1.0, 1.0]
    assert absorbed([0.0, 1e300], math.inf).tolist() == [0.0, 0.0]
    assert absorbed([1e300], 1e-300).tolist() == [1.0]


@pytest.mark.parametrize("none", [[], np.zeros((0, 3))])
def test_no_seeds_have_no_lengths(none):
    assert path_lengths(none, none, (0, 1, 0)).shape == (0,)
    assert path_lengths_to(none, none, (0, 1, 0)).shape == (0,)


@pytest.mark.parametrize("penetration", [0, -1, math.nan, None, [1.0, 2.0]])
def test_bad_penetrations_are_refused(penetration):
    with pytest.raises(InvalidValueError, match="light_penetration"):
        absorbed([1.0], penetration)


@pytest.mark.parametrize(
    ("centers", "sizes", "direction"),
    [
        ([[0, 0, 0]], [[1, 1, 1]], (0, 0, 0)),
        ([[0, 0, 0]], [[1, 1, 1]], (0, math.nan, 0)),
        ([[0, 0, 0]], [[1, 1, 1]], (0, 1)),
        ([[0, 0, 0]], [[1, 1, -1]], (0, 1, 0)),
        ([[0, 0, 0]], [[1, 1, 1]] * 2, (0, 1, 0)),
        ([], [[1, 1, 1]], (0, 1, 0)),
        ([0, 0, 0], [1, 1, 1], (0, 1, 0)),
        ([[0, 0, math.inf]], [[1, 1, 1]], (0, 1, 0)),
    ],
)
def test_bad_boxes_and_directions_are_refused(centers, sizes, direction):
    with pytest.raises(InvalidValueError):
        path_lengths(centers, sizes, direction)
    if direction == (0, 1, 0):
        with pytest.raises(InvalidValueError):
            path_lengths_to(centers, sizes, direction)
