"""Areas as plain rows: those of a frame once, those of an array that may change every time."""

from __future__ import annotations

import numpy as np

from weather_ecs.frame import AREA_DTYPE, AreaRow, plain_areas

ROWS = [(7, (1.0, 2.0), (5.0, 4.0), 0.5, 25.0, 1.5, 300.0), (8, (3, 4), (9, 6), 1, 2, 3, 4)]


def test_rows_are_those_of_the_array() -> None:
    areas = np.array(ROWS, AREA_DTYPE)
    assert plain_areas(areas) == tuple(AreaRow(*row) for row in ROWS)
    assert plain_areas(areas[::-1]) == tuple(AreaRow(*row) for row in ROWS[::-1])
    assert plain_areas(areas[:0]) == ()
    assert type(plain_areas(areas)[1].heading) is float and type(plain_areas(areas)[1].key) is int


def test_only_what_cannot_change_is_remembered() -> None:
    areas = np.array(ROWS, AREA_DTYPE)
    before = plain_areas(areas)
    areas["heading"] = 2.0
    assert [row.heading for row in plain_areas(areas)] == [2.0, 2.0] != before
    areas.setflags(write=False)
    known = plain_areas(areas)
    assert plain_areas(areas) is known
    other = areas.copy()
    other.setflags(write=False)
    assert plain_areas(other) == known and plain_areas(areas) == known
