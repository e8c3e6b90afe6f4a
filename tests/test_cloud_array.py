"""Clouds of a layer in columns: what comes, dissolves and goes."""

from __future__ import annotations

import numpy as np

from weather_ecs.systems.cloud_array import WHOLE, CloudArray
from weather_ecs.systems.cloud_mix import Kind

FAIR, GREY = Kind(0.25, "cumulus", 0), Kind(0.75, "stratus", 1)


def filled() -> CloudArray:
    """Three fair clouds and two grey ones, serials 10 to 14."""
    array = CloudArray()
    places = np.array([[0, 5], [40, -7], [-30, 2], [8, 8], [1, 1]])
    array.add([FAIR, GREY, FAIR, GREY, FAIR], places, np.arange(10, 15), WHOLE)
    return array


def test_questions_about_those_that_stand() -> None:
    array = filled()
    assert (len(array), array.standing, array.extent) == (5, 5, (-30, 40, -7, 8))
    assert array.skies() == [0.25, 0.75]
    assert (array.count_of(0.25), array.count_of(0.75), array.count_of(0.5)) == (3, 2, 0)
    assert (array.oldest(), array.oldest(0.75)) == (0, 1)


def test_one_that_dissolves_counts_no_more_and_is_gone_in_its_tick() -> None:
    array = filled()
    array.dissolve(1, tick=7)
    assert (len(array), array.standing, array.count_of(0.75)) == (5, 4, 1)
    assert array.oldest(0.75) == 3
    array.drop_gone(6)
    assert len(array) == 5
    array.drop_gone(7)
    assert array.serial.tolist() == [10, 12, 13, 14]
    assert array.extent == (-30, 8, 1, 8)


def test_every_change_has_another_version_and_no_change_has_none() -> None:
    array, seen = filled(), set()
    for change in (
        lambda: array.dissolve(0, 3),
        lambda: array.drop_gone(3),
        lambda: array.remove(np.array([1])),
        lambda: array.add([FAIR], np.array([[0, 0]]), np.array([20]), 4),
    ):
        seen.add(array.version)
        change()
    assert len(seen | {array.version}) == 5
    before = array.version
    array.drop_gone(3)
    assert array.version == before


def test_kinds_without_a_cloud_are_forgotten_when_they_are_many() -> None:
    array = filled()
    crowd = [Kind(0.5, f"model {number}", number) for number in range(400)]
    places = np.zeros((len(crowd), 2), np.int64)
    array.add(crowd, places, np.arange(100, 500), WHOLE)
    array.remove(np.arange(5, 305))
    assert len(array.kinds) == 402  # twice as many as clouds and 256 may be kept
    kept = [array.kinds[k] for k in array.kind.tolist()]
    array.remove(np.arange(5, 95))
    kept = [*kept[:5], *kept[95:]]
    assert [array.kinds[k] for k in array.kind.tolist()] == kept
    assert len(array.kinds) == len(set(kept)) == 12
    array.add([GREY], np.array([[0, 0]]), np.array([600]), WHOLE)
    assert array.kinds[array.kind[-1]] == GREY and len(array.kinds) == 12
