"""`BoxGrid.near`: the boxes over a cell of the finest grid, against looking at all of them."""

from __future__ import annotations

import numpy as np
import pytest

from weather_ecs.systems import box_grid
from weather_ecs.systems.box_grid import FINEST, BoxGrid

CELLS = [(i, j) for i in range(-12, 13, 3) for j in range(-12, 13, 4)]


def scattered(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Boxes from half a metre to 60 m wide, some of the same height."""
    rng = np.random.default_rng(4)
    middle = rng.uniform(-50.0, 50.0, (count, 2))
    half = 0.25 * np.exp(rng.uniform(0.0, np.log(120.0), (count, 2)))
    return middle - half, middle + half, rng.integers(0, 6, count).astype(float)


def test_all_that_reach_into_a_cell_the_highest_first() -> None:
    low, high, top = scattered(300)
    grid = BoxGrid(low, high, top)
    for place in CELLS:
        corner = FINEST * np.array(place)
        inside = ((high >= corner) & (low <= corner + FINEST)).all(axis=1)
        expected = sorted(np.flatnonzero(inside).tolist(), key=lambda k: (-top[k], k))
        assert [box[5] for box in grid.near(place)] == expected
        assert [box[0] for box in grid.near(place)] == top[expected].tolist()


def test_what_was_found_is_kept_within_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(box_grid, "_KEPT", 5)
    grid = BoxGrid(*scattered(20))
    before = {place: list(grid.near(place)) for place in CELLS}
    assert len(grid.known) <= 6
    assert {place: grid.near(place) for place in CELLS} == before


def test_no_boxes_are_near_nothing() -> None:
    low, high, top = scattered(0)
    assert BoxGrid(low, high, top).near((0, 0)) == []
