"""The ripples' scheme against a loop, its stability, its sources; where grids and windows are."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from tests.rain_frames import camera
from weather_ecs.errors import InvalidValueError
from weather_ecs.physics import ripple, ripple_place
from weather_ecs.physics.ripple import add_sources, craters, energy, settling_steps, step, time_step

shapes = st.tuples(st.integers(1, 9), st.integers(1, 9))


def grids(values: st.SearchStrategy[float] | None = None) -> st.SearchStrategy[Any]:
    """Pairs of small grids whose border is 0."""
    cells = values if values is not None else st.floats(-20.0, 20.0)

    def pair(shape: tuple[int, int]) -> st.SearchStrategy[Any]:
        inner = tuple(max(n - 2, 0) for n in shape)
        one = hnp.arrays(np.float64, inner, elements=cells).map(
            lambda a: np.pad(a, 1)[: shape[0], : shape[1]]
        )
        return st.tuples(one, one)

    return shapes.flatmap(pair)


def by_loop(current: np.ndarray, previous: np.ndarray, n: int, threshold: float) -> np.ndarray:
    """Page 20's lines, cell by cell."""
    rows, columns = current.shape
    following = np.zeros((rows, columns))
    for i in range(1, rows - 1):
        for j in range(1, columns - 1):
            around = 0.0
            for di in (-1, 0, 1):
                for dj in (-1, 0, 1):
                    if di or dj:
                        around += current[i + di, j + dj]
            new = around / 4.0 - previous[i, j]
            new -= new / 2**n
            if abs(new) < threshold:
                new = 0.0
            following[i, j] = new
    return following


# The scheme


@settings(max_examples=80, deadline=None)
@given(grids(), st.integers(5, 9), st.sampled_from([0.0, 0.01, 0.3]))
def test_a_step_is_that_of_the_loop(pair: Any, n: int, threshold: float) -> None:
    current, previous = pair
    kept = current.copy(), previous.copy()
    expected = by_loop(current, previous, n, threshold)
    found = step(current, previous, n, threshold)
    # Where the two round to either side of the threshold both are right.
    close = np.isclose(found, expected, atol=1e-12)
    edge = np.isclose(np.maximum(abs(found), abs(expected)), threshold, atol=1e-9)
    assert (close | edge).all()
    assert np.array_equal(current, kept[0]) and np.array_equal(previous, kept[1])


def test_defaults_and_types() -> None:
    rng = np.random.default_rng(1)
    a, b = rng.normal(size=(2, 7, 8))
    assert np.array_equal(step(a, b), step(a, b, n=6, threshold=0.01))
    assert step(a.astype("f4"), b.astype("f4")).dtype == np.float32
    assert np.array_equal(step(a.tolist(), b.tolist()), step(a, b))
    assert step(np.ones((4, 4), int), np.zeros((4, 4), int)).dtype == np.float64
    for shape in ((1, 1), (2, 5), (5, 2), (1, 6)):
        assert not step(np.ones(shape), np.ones(shape)).any()


def test_troughs_live_as_long_as_crests() -> None:
    a = np.zeros((31, 31))
    a[15, 15] = 5.0
    up, down, zero = a, -a, np.zeros_like(a)
    before_up, before_down = zero, zero
    for _ in range(30):
        up, before_up = step(up, before_up), up
        down, before_down = step(down, before_down), down
        assert np.array_equal(up, -down)
    assert up.min() < -0.05 and up.max() > 0.05


@pytest.mark.parametrize("periodic", [False, True])
def test_rings_are_as_symmetric_as_the_grid_and_run_at_the_speed(periodic: bool) -> None:
    side, middle = 121, 60
    a, before = np.zeros((side, side)), np.zeros((side, side))
    add_sources(a, (middle + 0.5, middle + 0.5), 10.0)
    assert abs(a.sum()) < 0.02 * abs(a).sum()  # as much water in the rim as is missing inside
    steps = 60
    for _ in range(steps):
        a, before = step(a, before, 9, 0.0, periodic=periodic), a
    for same in (a.T, a[::-1], a[:, ::-1]):
        assert np.allclose(a, same, atol=1e-12)
    x, y = np.meshgrid(np.arange(side) - middle, np.arange(side) - middle)
    r = np.hypot(x, y)
    # Round: as far along the diagonals as along the axes; short waves are a little slower.
    turned = np.cos(4.0 * np.arctan2(y, x))
    fronts = []
    for part in (turned > 0.7, turned < -0.7):
        ring = [(a[part & (r >= k) & (r < k + 1)] ** 2).mean() for k in range(3, 58)]
        fronts.append(3 + int(np.argmax(ring)))
    assert abs(fronts[0] - fronts[1]) <= 3
    assert 0.85 < np.mean(fronts) / (steps * ripple.COURANT) < 1.02


def test_without_a_border_nothing_tells_the_edge_from_the_middle() -> None:
    rng = np.random.default_rng(2)
    a, b = rng.normal(size=(2, 12, 9))
    shift = (5, 7)
    moved = [np.roll(x, shift, (0, 1)) for x in (a, b)]
    for _ in range(20):
        a, b = step(a, b, 5, 0.0, periodic=True), a
        moved = [step(*moved, 5, 0.0, periodic=True), moved[0]]
    assert np.allclose(np.roll(a, shift, (0, 1)), moved[0], atol=1e-12)


@settings(max_examples=80, deadline=None)
@given(grids(), st.integers(5, 9))
def test_energy_is_lost_at_the_damping_s_rate(pair: Any, n: int) -> None:
    current, previous = pair
    scale = max(float((current**2).sum() + (previous**2).sum()), 1.0)
    before = energy(current, previous, n)
    assert before >= -1e-12 * scale
    for _ in range(5):
        current, previous = step(current, previous, n, 0.0), current
        after = energy(current, previous, n)
        assert after == pytest.approx((1.0 - 0.5**n) * before, abs=1e-9 * scale)
        before = after


@settings(max_examples=60, deadline=None)
@given(grids(), st.integers(5, 9), st.sampled_from([0.0, 0.01, 0.3, 5.0]))
def test_nothing_grows_whatever_the_state(pair: Any, n: int, threshold: float) -> None:
    current, previous = pair
    most = 30.0 * max(abs(current).max(initial=0.0), abs(previous).max(initial=0.0), threshold)
    for _ in range(200):
        current, previous = step(current, previous, n, threshold), current
        assert abs(current).max(initial=0.0) <= most


@pytest.mark.parametrize("n", [5, 6])
def test_water_comes_to_rest(n: int) -> None:
    rng = np.random.default_rng(n)
    a, before = np.zeros((40, 40), np.float32), np.zeros((40, 40), np.float32)
    add_sources(a, rng.uniform(0, 40, (30, 2)), np.full(30, ripple.DEEPEST))
    peaks = []
    for _ in range(settling_steps(n)):
        a, before = step(a, before, n, ripple.THRESHOLD), a
        peaks.append(abs(a).max())
    assert peaks[0] > 5.0 and not a.any() and not before.any()
    assert not step(a, before, n, ripple.THRESHOLD).any()


@pytest.mark.parametrize("n", [4, 10, -1, 0, 5.0, 6.5, math.nan, "6", None, True])
def test_other_dampings_are_refused(n: Any) -> None:
    zero = np.zeros((4, 4))
    with pytest.raises(InvalidValueError, match="5 to 9") as caught:
        step(zero, zero, n)
    assert caught.value.field == "n"


@pytest.mark.parametrize("threshold", [-0.01, math.nan, math.inf, "x"])
def test_other_thresholds_are_refused(threshold: Any) -> None:
    zero = np.zeros((4, 4))
    with pytest.raises(InvalidValueError, match="threshold"):
        step(zero, zero, 6, threshold)


@pytest.mark.parametrize(
    ("current", "previous", "field"),
    [
        (np.zeros((4, 4)), np.zeros((4, 5)), "previous"),
        (np.zeros(4), np.zeros(4), "current"),
        (np.zeros((2, 2, 2)), np.zeros((2, 2, 2)), "current"),
        (np.full((4, 4), math.nan), np.zeros((4, 4)), "current"),
        (np.zeros((4, 4)), np.full((4, 4), math.inf), "previous"),
        ("water", np.zeros((4, 4)), "current"),
        (np.zeros((4, 4), complex), np.zeros((4, 4)), "current"),
        ([[1.0, 2.0], [3.0]], np.zeros((2, 2)), "current"),
    ],
)
def test_other_grids_are_refused(current: Any, previous: Any, field: str) -> None:
    with pytest.raises(InvalidValueError) as caught:
        step(current, previous)
    assert caught.value.field == field


def test_the_time_step_gives_the_waves_their_speed() -> None:
    assert time_step(0.015, 0.3) * 0.3 / 0.015 == pytest.approx(ripple.COURANT)
    for cell, speed in ((0.0, 1.0), (1.0, 0.0), (-1.0, 1.0), (math.nan, 1.0)):
        with pytest.raises(InvalidValueError):
            time_step(cell, speed)


# Sources


def test_sources_press_craters_where_they_are() -> None:
    grid = np.zeros((30, 40), np.float32)
    add_sources(grid, [(10.5, 20.5), (31.0, 8.25)], [4.0, 6.0])
    assert np.unravel_index(grid.argmin(), grid.shape) == (8, 30) or grid[20, 10] == -4.0
    assert grid[20, 10] == pytest.approx(-4.0)
    near = np.zeros(grid.shape, bool)
    near[14:27, 4:17] = near[2:15, 24:38] = True
    assert not grid[~near].any()
    twice = grid.copy()
    add_sources(twice, [(10.5, 20.5), (31.0, 8.25)], [4.0, 6.0])
    assert np.allclose(twice, 2.0 * grid)


def test_sources_go_round_where_there_is_no_border() -> None:
    middle, corner = np.zeros((20, 24)), np.zeros((20, 24))
    add_sources(middle, (12.0, 10.0), 5.0, periodic=True)
    add_sources(corner, (0.0, 0.0), 5.0, periodic=True)
    assert np.allclose(np.roll(middle, (-10, -12), (0, 1)), corner)


def test_craters_keep_the_energy_of_the_drops() -> None:
    rng = np.random.default_rng(3)
    n = 40_000
    places = np.column_stack([rng.uniform(-20, 20, n), np.zeros(n), rng.uniform(-20, 20, n)])
    for diameter, weight in ((0.7, 20.0), (1.0, 300.0), (1.5, 100.0)):
        speed = 9.65 - 10.3 * math.exp(-0.6 * diameter)
        _, deep = craters(places, np.full(n, diameter), np.full(n, speed), np.full(n, weight))
        lone = ripple.DEPTH * diameter**1.5 * speed * math.sqrt(weight)
        shown = deep[deep > 0.0]
        assert shown.min() >= ripple.SHALLOWEST - 1e-6 and shown.max() <= ripple.DEEPEST
        assert (deep**2).sum(1).mean() == pytest.approx(lone**2, rel=0.05)
    assert not craters(places, np.zeros(n), np.zeros(n), np.ones(n))[1].any()
    assert craters(np.zeros((0, 3)), [], [], [])[1].shape == (0, ripple.MOST_CRATERS)


def test_a_drop_that_stands_for_many_makes_craters_around_it() -> None:
    places = np.column_stack([np.arange(200.0), np.zeros(200), np.zeros(200)])
    many = np.full(200, 50.0)
    off, deep = craters(places, np.full(200, 2.0), np.full(200, 6.5), many)
    count = (deep > 0.0).sum(axis=1)
    assert (count == ripple.MOST_CRATERS).all() and (deep[deep > 0.0] < 1.5 * ripple.COMMON).all()
    assert not off[:, 0].any()  # the first is where the splash is
    away = np.hypot(*off[:, 1:].T)
    assert away.max() <= ripple.SCATTER and away.mean() == pytest.approx(
        ripple.SCATTER * 2.0 / 3.0, rel=0.05
    )
    _, few = craters(places, np.full(200, 2.0), np.full(200, 6.5), many / 8.0)
    assert ((few > 0.0).sum(axis=1) == 1).all()


def test_rain_roughens_water_the_more_the_heavier() -> None:
    rates = np.array([0.0, 0.5, 2.0, 5.0, 25.0, 100.0, 1e4])
    slopes = ripple.roughness(rates)
    assert slopes[0] == 0.0 and (np.diff(slopes) >= 0.0).all() and slopes[-1] < 0.2


# Places


@pytest.mark.parametrize(
    ("size", "cell", "most", "cells", "held"),
    [
        ((4.0, 3.0), 0.02, 256, (200, 150), (True, True)),
        ((26.0, 18.0), 0.015, 256, (256, 256), (False, False)),
        ((100.0, 2.0), 0.02, 256, (256, 100), (False, True)),
        ((0.01, 0.01), 0.015, 256, (3, 3), (True, True)),
        ((2.56, 2.56), 0.01, 256, (256, 256), (True, True)),
    ],
)
def test_grids(
    size: Any, cell: float, most: int, cells: tuple[int, int], held: tuple[bool, bool]
) -> None:
    assert ripple_place.grid_of(size, cell, most) == (cells, held)


side = st.floats(0.05, 500.0)
offset = st.floats(-2000.0, 2000.0)


@settings(deadline=None)
@given(st.tuples(side, side), st.sampled_from([0.01, 0.02, 0.1]), st.booleans(),
       st.tuples(offset, offset))  # fmt: skip
def test_windows_stay_on_the_water_and_cover_no_cell_twice(
    size: tuple[float, float], cell: float, ellipse: bool, focus: tuple[float, float]
) -> None:
    grid = ripple_place.grid_of(size, cell, 128)
    middle, half = ripple_place.window_of(grid, cell, size, ellipse, focus)
    for k in range(2):
        assert abs(middle[k]) + half[k] <= 0.5 * size[k] * (1 + 1e-9) + 1e-9
        assert 2.0 * half[k] <= grid.cells[k] * cell * (1 + 1e-6)
        assert middle[k] == 0.0 or not grid.held[k]
    inside = all(abs(f) + h <= 0.5 * s for f, h, s in zip(focus, half, size, strict=True))
    if inside and not ellipse and not any(grid.held):
        assert middle == pytest.approx(focus)


def test_own_axes_corners_and_distances() -> None:
    center, size, heading = (10.0, 2.0, -5.0), (6.0, 2.0), math.pi / 2
    arrays = (np.array([center]), np.array([size]), np.array([heading]))
    (corners,) = ripple_place.corners_of(*arrays)
    # A quarter turn puts the long side along z.
    assert np.allclose(np.ptp(corners, axis=0), (2.0, 0.0, 6.0))
    assert np.allclose(corners.mean(axis=0), center)
    assert ripple_place.to_own(center, heading, 10.0, -9.0) == pytest.approx((4.0, 0.0))
    for place, away in (
        ((10.0, 2.0, -5.0), 0.0), ((10.0, 5.0, -3.0), 3.0), ((14.0, 2.0, -5.0), 3.0),
        ((10.0, 2.0, -12.0), 4.0), ((14.0, 2.0, -12.0), 5.0),
    ):  # fmt: skip
        assert ripple_place.distances(*arrays, place)[0] == pytest.approx(away)


def test_what_a_camera_sees() -> None:
    seen = camera((0.0, 1.7, 0.0), heading=0.0)  # along +x
    places = [(10, 0, 0), (-10, 0, 0), (10, 0, 60), (0, 0, 0), (5000, 0, 0)]
    centers = np.array(places, float)
    sizes = np.array([(2, 2), (2, 2), (2, 2), (400, 400), (2, 2)], float)
    corners = ripple_place.corners_of(centers, sizes, np.zeros(5))
    found = ripple_place.in_view(corners, seen.projection @ seen.view)
    # The one all around has no corner in the picture.
    assert found.tolist() == [True, False, False, True, False]
