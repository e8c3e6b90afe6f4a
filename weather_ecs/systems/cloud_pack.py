"""Clouds of a layer as a few bytes each, for snapshots."""

from __future__ import annotations

import base64
import binascii
from typing import Any

import numpy as np
from numpy.typing import NDArray

from weather_ecs.components._base import integer, number
from weather_ecs.errors import InvalidValueError
from weather_ecs.systems.cloud_array import WHOLE, CloudArray
from weather_ecs.systems.cloud_mix import Kind, rows, text

MOST_CLOUDS = 1_000_000
GREATEST = 2**53
_OLDEST = 0xFFFF  # as an age: not forming, not dissolving
_FIELDS = {"columns", "count", "kinds", "low"}
# x and z from the lowest, serials from the one before, kinds, ages in ticks.
_TYPES = ("<u4", "<u4", "<u4", "<u4", "<u2", "<u2")

_check_sky = number(0.0, 1.0)
_check_number = integer(0, 10_000)
_check_place = integer(-GREATEST, GREATEST)


def pack(array: CloudArray, tick: int, least: int) -> dict[str, Any]:
    """The clouds in the given tick as plain values; their serials are `least` and above."""
    used, kinds = np.unique(array.kind, return_inverse=True)
    low = [int(values.min()) if len(array) else 0 for values in (array.x, array.z)]
    columns = (
        array.x - low[0],
        array.z - low[1],
        np.diff(array.serial, prepend=least),
        kinds,
        np.where(array.born == WHOLE, _OLDEST, tick - array.born),
        np.where(array.dying == WHOLE, _OLDEST, tick - array.dying),
    )
    data = b"".join(
        _planes(values.astype(kind)) for values, kind in zip(columns, _TYPES, strict=True)
    )
    return {
        "columns": base64.b64encode(data).decode(),
        "count": len(array),
        "kinds": [list(array.kinds[k]) for k in used.tolist()],
        "low": low,
    }


def unpack(state: Any, tick: int, least: int, following: int) -> CloudArray:
    """The clouds that `pack` was given; serials below `following`.

    Raises InvalidValueError for anything else.
    """
    if not isinstance(state, dict) or set(state) != _FIELDS:
        raise InvalidValueError("clouds", state, f"the fields {sorted(_FIELDS)}")
    count = integer(0, MOST_CLOUDS)("clouds.count", state["count"])
    kinds = [
        Kind(_check_sky("sky", sky), text("model", model), _check_number("number", which))
        for sky, model, which in rows("clouds.kinds", state["kinds"], 3)
    ]
    low = state["low"]
    if not isinstance(low, list) or len(low) != 2:
        raise InvalidValueError("clouds.low", low, "two whole numbers")
    x, z, serial, kind, born, dying = _columns(state["columns"], count)
    x += _check_place("clouds.low", low[0])
    z += _check_place("clouds.low", low[1])
    serial = np.cumsum(serial) + least
    if count and (np.diff(serial).min(initial=1) < 1 or int(serial[-1]) >= following):
        raise InvalidValueError("clouds.serial", int(serial[-1]), f"rising, below {following}")
    if count and int(kind.max()) >= len(kinds):
        raise InvalidValueError("clouds.kind", int(kind.max()), f"below {len(kinds)}")
    array = CloudArray()
    ticks = [np.where(age == _OLDEST, WHOLE, tick - age) for age in (born, dying)]
    for began in ticks:
        if count and int(began.min()) < WHOLE:
            raise InvalidValueError("clouds.age", int(tick - began.min()), f"at most {tick}")
    array.replace([x, z, serial, kind, *ticks], kinds)
    return array


def _planes(values: NDArray) -> bytes:
    """Bytes of the same significance side by side, which compresses better."""
    return values.view(np.uint8).reshape(len(values), values.itemsize).T.tobytes()


def _columns(data: Any, count: int) -> list[NDArray]:
    sizes = [np.dtype(kind).itemsize * count for kind in _TYPES]
    try:
        content = base64.b64decode(data, validate=True)
    except (TypeError, ValueError, binascii.Error):
        raise InvalidValueError("clouds.columns", data, "a text in base 64") from None
    if len(content) != sum(sizes):
        raise InvalidValueError("clouds.columns", f"{len(content)} bytes", f"{sum(sizes)} bytes")
    columns, start = [], 0
    for size, kind in zip(sizes, _TYPES, strict=True):
        planes = np.frombuffer(content, np.uint8, size, start)
        planes = planes.reshape(np.dtype(kind).itemsize, count)
        values = np.ascontiguousarray(planes.T).view(kind).reshape(count)
        columns.append(values.astype(np.int64))
        start += size
    return columns
