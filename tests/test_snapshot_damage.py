"""Snapshots from elsewhere: damaged, hostile or made by chance, refused or sound."""

from __future__ import annotations

import copy
import json
import math
import struct
import zlib

import esper
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.snapshots import DOCUMENT, build, changed, components
from tests.worlds import fresh_world
from weather_ecs import Weather, snapshot
from weather_ecs.errors import SnapshotError
from weather_ecs.snapshot_file import LARGEST, VERSION, seal

pytestmark = pytest.mark.usefixtures("world")


# Damaged and hostile bytes


def sealed(
    content: bytes, version: int = VERSION, length: int | None = None, cells: bytes = b""
) -> bytes:
    """A snapshot file with a fitting checksum around any content."""
    length = len(content) if length is None else length
    return seal(zlib.compress(content), length, cells, version)


def refused(data: object, match: str | None = None) -> None:
    """`restore` raises SnapshotError and leaves the weather as it was."""
    with fresh_world(), Weather(seed=1) as weather:
        build()
        esper.process(0.12)
        before, bits = components(), weather.snapshot()
        with pytest.raises(SnapshotError, match=match):
            weather.restore(data)
        assert components() == before
        assert weather.snapshot() == bits


GOOD = snapshot.encode(DOCUMENT)


@pytest.mark.parametrize(
    ("data", "match"),
    [
        (b"", "not a weather snapshot"),
        (b"WEC", "not a weather snapshot"),
        (b"WECS", "cut off"),
        (b"PNG!" + GOOD[4:], "not a weather snapshot"),
        (GOOD[:9], "cut off"),
        (GOOD[:40], "checksum"),
        (GOOD[:-1], "checksum"),
        (GOOD + b"x", "checksum"),
        (None, "bytes"),
        ("WECS", "bytes"),
        (sealed(b"{}", version=1), "version 1, this is 2"),
        (sealed(b"{}", version=3), "version 3"),
        (sealed(b"{}", version=0), "version 0"),
        (sealed(b"[]"), "^the snapshot's content is not an object"),
        (sealed(b"{}"), "parts"),
        (sealed(b"{"), "JSON"),
        (sealed(b"\xff\xfe"), "JSON"),
        (sealed(b"[" * 100_000), "JSON"),
        (sealed(b"1" * 10_000), "JSON"),
        (sealed(b'{"a":NaN}'), "JSON"),
        (sealed(b"{}", length=1), "length"),
        (sealed(b"{}", length=3), "length"),
        (sealed(b"{}", length=2**31), "claims"),
        (sealed(b"{}", cells=b"123"), "^the snapshot has more cells"),
        (sealed(b'{"snow":{"codes":4}}', cells=b"123"), "^the snapshot has fewer cells"),
        (sealed(b'{"snow":{"codes":-1}}', cells=b"123"), "^the snapshot has fewer cells"),
        (sealed(b'{"snow":' + b"[" * 900 + b"]" * 900 + b"}"), "parts|JSON"),
    ],
)
def test_damaged_bytes(data, match):
    refused(data, match)


def test_a_bomb_stops_at_the_length_it_claims():
    bomb = zlib.compress(b"0" * 50_000_000, 9)
    for length in (10, LARGEST, LARGEST + 1):
        with pytest.raises(SnapshotError):
            snapshot.decode(seal(bomb, length))


def test_bytes_after_the_end_of_the_compressed_part():
    refused(seal(zlib.compress(b"{}") + b"more", 2), "decompressed")
    data = seal(zlib.compress(b"{}"), 2)
    rest = data[18:] + b"more"
    checksum = zlib.crc32(rest, zlib.crc32(struct.pack("<II", 2, 0)))
    refused(struct.pack("<4sHIII", b"WECS", VERSION, 2, 0, checksum) + rest, "length")


def area_at(field: str, value: object) -> dict:
    index = next(i for i, (_, parts) in enumerate(DOCUMENT["entities"]) if "RainArea" in parts)
    return changed("entities", index, 1, "RainArea", field, value=value)


@pytest.mark.parametrize(
    "bad",
    [
        changed("seed", value=-1),
        changed("seed", value=True),
        changed("seed", value=1.5),
        changed("next_uid", value=2),
        changed("next_uid", value=2**60),
        changed("clock", "steps", value=-1),
        changed("clock", "speed", value="fast"),
        changed("clock", value=None),
        changed("clock", "more", value=1),
        changed("rng", value=None),
        changed("rng", "bit_generator", value="MT19937"),
        changed("rng", "state", value={}),
        changed("rng", "state", "inc", value=2),
        changed("rng", "state", "state", value=-1),
        changed("rng", "state", "state", value=2**128),
        changed("rng", "uinteger", value=1.0),
        changed("more", value=1),
        changed("entities", value={}),
        changed("entities", 0, value=[]),
        changed("entities", 0, value=[0, {}]),
        changed("entities", 0, 0, value=1),
        changed("entities", 0, 0, value=-1),
        changed("entities", 0, 0, value="0"),
        changed("entities", 0, 0, value=10**9),
        changed("entities", 0, 1, value={"Volcano": {}}),
        changed("entities", 0, 1, value={"Observer": {"position": [0, 0, 0]}}),
        changed("entities", 0, 1, value={"Wind": {}}),
        changed("entities", 0, 1, value={"Wind": None}),
        changed("entities", 0, 1, "Wind", "gusts", value=1),
        area_at("radii", [1, 2]),
        area_at("radii", [1, 1, 1]),
        area_at("radii", "11"),
        area_at("rain_rate", -5.0),
        area_at("rain_rate", True),
        area_at("rain_rate", None),
        area_at("rain_rate", 10**400),
        area_at("center", [0, {}]),
    ],
)
def test_documents_with_one_bad_value(bad):
    refused(sealed(json.dumps(bad).encode()), "snapshot")


def test_infinity_and_nan_are_never_written_and_never_read():
    with pytest.raises(ValueError, match="JSON"):
        snapshot.encode({"a": math.nan})
    for text in (b"NaN", b"Infinity", b"-Infinity", b"1e999"):
        bad = json.dumps(area_at("rain_rate", 12345.5)).encode().replace(b"12345.5", text)
        refused(sealed(bad))


@settings(deadline=None, max_examples=150)
@given(st.data())
def test_any_flipped_byte_is_noticed(data):
    position = data.draw(st.integers(0, len(GOOD) - 1))
    flip = data.draw(st.integers(1, 255))
    damaged = bytearray(GOOD)
    damaged[position] ^= flip
    with pytest.raises(SnapshotError):
        snapshot.load(snapshot.decode(bytes(damaged)))


@settings(deadline=None, max_examples=100)
@given(st.binary(max_size=200))
def test_any_bytes_are_refused(data):
    for candidate in (data, b"WECS" + data, sealed(data)):
        with pytest.raises(SnapshotError):
            snapshot.load(snapshot.decode(candidate))


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=8,
)


def paths(value: object, path: tuple = ()) -> list[tuple]:
    found = [path] if path else []
    if isinstance(value, dict):
        for key, inner in value.items():
            found += paths(inner, (*path, key))
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            found += paths(inner, (*path, index))
    return found


PATHS = paths(DOCUMENT)


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(st.tuples(st.sampled_from(PATHS), json_values), min_size=1, max_size=3))
def test_any_document_is_a_sound_weather_or_an_error(changes):
    bad = copy.deepcopy(DOCUMENT)
    for path, value in changes:
        place = bad
        try:
            for step in path[:-1]:
                place = place[step]
            place[path[-1]] = value
        except (KeyError, IndexError, TypeError):
            continue
    data = sealed(json.dumps(bad).encode())
    with fresh_world(), Weather(seed=1) as weather:
        build()
        before, bits = components(), weather.snapshot()
        try:
            weather.restore(data)
        except SnapshotError:
            assert components() == before
            assert weather.snapshot() == bits
            return
        after = weather.snapshot()
        esper.process(1.0)
        assert math.isfinite(weather.sample((0, 0, 0)).rain_rate)
        weather.restore(after)
        assert weather.snapshot() == after
