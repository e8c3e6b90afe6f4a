"""Clouds that were taken away, as they dissolve."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.cloud_worlds import model
from weather_ecs.frame import CLOUD_DTYPE
from weather_ecs.systems.cloud_ghosts import LASTING, SEEN, CloudGhosts
from weather_ecs.systems.cloud_shapes import Shape, ShapeLibrary

NONE = np.zeros(0, np.int64)


def shapes(count: int) -> list[Shape]:
    library = ShapeLibrary()
    return [library.get(model("one"), number) for number in range(count)]


def rows(*keys: int, **fields: float) -> NDArray:
    """Clouds 1 km apart that drift along x, the k-th with shape k."""
    found = np.zeros(len(keys), CLOUD_DTYPE)
    found["key"], found["shape"] = keys, np.arange(len(keys))
    found["position"][:, 0] = 1000.0 * np.arange(len(keys))
    found["velocity"][:, 0] = 20.0
    found["growth"] = found["opacity"] = 1.0
    for name, value in fields.items():
        found[name] = value
    return found


def test_those_that_are_kept_leave_nothing_behind() -> None:
    ghosts = CloudGhosts()
    ghosts.take(rows(7, 8, 9), shapes(3), np.array([9, 7]), time=100.0)
    assert ghosts.at(100.0)["key"].tolist() == [8]
    assert len(ghosts) == 1


def test_they_drift_on_and_dissolve_until_nothing_is_left() -> None:
    ghosts = CloudGhosts()
    ghosts.take(rows(7, 8), shapes(2), NONE, time=100.0)
    half = ghosts.at(100.0 + 0.5 * LASTING)
    assert half["position"][:, 0] == pytest.approx([10.0 * LASTING, 1000.0 + 10.0 * LASTING])
    assert half["growth"] == pytest.approx([0.5, 0.5])
    times = np.linspace(100.0, 100.0 + LASTING, 9)[:-1]
    growth = [float(ghosts.at(float(time))["growth"][0]) for time in times]
    assert growth[0] == 1.0 and growth == sorted(growth, reverse=True)
    assert len(ghosts.at(100.0 + LASTING)) == len(ghosts) == len(ghosts.shapes) == 0


@pytest.mark.parametrize(("growth", "opacity"), [(0.0, 1.0), (1.0, 0.0), (SEEN, 0.9)])
def test_what_was_hardly_seen_is_gone_at_once(growth: float, opacity: float) -> None:
    ghosts = CloudGhosts()
    ghosts.take(rows(7, growth=growth, opacity=opacity), shapes(1), NONE, time=0.0)
    assert len(ghosts) == 0 and ghosts.shapes == []


def test_what_was_half_grown_dissolves_from_there() -> None:
    ghosts = CloudGhosts()
    ghosts.take(rows(7, growth=0.5), shapes(1), NONE, time=0.0)
    assert ghosts.at(0.5 * LASTING)["growth"] == pytest.approx([0.25])


def test_each_keeps_its_own_shape_while_others_come_and_go() -> None:
    ghosts, (a, b, c) = CloudGhosts(), shapes(3)
    ghosts.take(rows(1, 2), [a, b], np.array([1]), time=0.0)
    ghosts.take(rows(3), [c], NONE, time=0.5 * LASTING)

    def stands(time: float) -> dict[int, Shape]:
        now = ghosts.at(time)
        return {int(row["key"]): ghosts.shapes[int(row["shape"])] for row in now}

    assert stands(0.6 * LASTING) == {2: b, 3: c}
    # The first is gone, and with it what only it stood with.
    assert stands(1.1 * LASTING) == {3: c}
    assert ghosts.shapes == [c]


def test_a_clock_that_was_set_back_knows_nothing_of_them() -> None:
    ghosts = CloudGhosts()
    ghosts.take(rows(7), shapes(1), NONE, time=100.0)
    assert len(ghosts.at(99.0)) == 0


def test_looking_changes_nothing_and_clearing_everything() -> None:
    ghosts = CloudGhosts()
    ghosts.take(rows(7), shapes(1), NONE, time=0.0)
    ghosts.at(1.0)["position"] += 500.0
    assert ghosts.at(0.0)["position"][0, 0] == 0.0
    ghosts.clear()
    assert len(ghosts.at(0.0)) == 0 and ghosts.shapes == []
