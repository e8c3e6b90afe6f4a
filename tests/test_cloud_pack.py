"""Clouds of a layer as a few bytes each, and what else of a snapshot has fixed fields."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from weather_ecs.errors import InvalidValueError
from weather_ecs.systems.cloud_array import WHOLE, CloudArray
from weather_ecs.systems.cloud_field import CloudField
from weather_ecs.systems.cloud_mix import Kind
from weather_ecs.systems.cloud_pack import pack, unpack
from weather_ecs.systems.course import Course
from weather_ecs.systems.strikes import StrikeField

TICK, LEAST, FOLLOWING = 90, 1000, 1050
COLUMNS = ("x", "z", "serial", "kind", "born", "dying")


def array() -> CloudArray:
    """Four clouds far from the origin: one whole, one forming, two dissolving."""
    made = CloudArray()
    kinds = [Kind(0.25, "cumulus", 3), Kind(0.75, "stratus", 0)]
    far = 2**40
    columns = [
        np.array([far, far - 300, far + 2**31, far]),
        np.array([-far, 7 - far, -far, -far]),
        np.array([1001, 1003, 1004, 1049]),
        np.array([0, 1, 1, 0]),
        np.array([WHOLE, 88, WHOLE, 80]),
        np.array([WHOLE, WHOLE, 71, 90]),
    ]
    made.replace(columns, kinds)
    return made


def test_what_is_packed_comes_back() -> None:
    before = array()
    after = unpack(pack(before, TICK, LEAST), TICK, LEAST, FOLLOWING)
    assert after.kinds == before.kinds
    for name in COLUMNS:
        assert getattr(after, name).tolist() == getattr(before, name).tolist(), name


def test_no_clouds_are_packed_too() -> None:
    after = unpack(pack(CloudArray(), TICK, LEAST), TICK, LEAST, LEAST)
    assert (len(after), after.kinds) == (0, [])


def test_kinds_without_a_cloud_are_left_out() -> None:
    before = array()
    before.kinds.append(Kind(1.0, "cumulonimbus", 1))
    assert pack(before, TICK, LEAST)["kinds"] == [[0.25, "cumulus", 3], [0.75, "stratus", 0]]


@pytest.mark.parametrize(
    "change",
    [
        {"more": 1},
        {"count": 3},
        {"count": -1},
        {"kinds": [[0.25, "cumulus", 3]]},  # one cloud is of the second
        {"kinds": [[1.25, "cumulus", 3], [0.75, "stratus", 0]]},
        {"low": [0]},
        {"low": [2**60, 0]},
        {"columns": "not base 64"},
        {"columns": ""},
        {"columns": 5},
    ],
    ids=str,
)
def test_other_bytes_are_refused(change: dict[str, Any]) -> None:
    with pytest.raises(InvalidValueError, match=r"clouds|sky"):
        unpack(pack(array(), TICK, LEAST) | change, TICK, LEAST, FOLLOWING)


def test_serials_and_ages_are_bounded() -> None:
    state = pack(array(), TICK, LEAST)
    with pytest.raises(InvalidValueError, match="serial"):
        unpack(state, TICK, LEAST, 1049)
    with pytest.raises(InvalidValueError, match="age"):
        unpack(state, 5, LEAST, FOLLOWING)  # it would have begun before the first tick


@pytest.mark.parametrize(
    "read",
    [
        lambda state: CloudField.from_state(state, 1),
        lambda state: Course.from_state(state, TICK),
        lambda state: StrikeField.from_state(state, TICK),
        lambda state: unpack(state, TICK, LEAST, FOLLOWING),
    ],
    ids=["field", "course", "strikes", "array"],
)
@pytest.mark.parametrize("state", [None, [], {}, {"layers": []}, {"other": 1}], ids=str)
def test_another_set_of_fields_is_refused(read: Any, state: Any) -> None:
    with pytest.raises(InvalidValueError):
        read(state)
