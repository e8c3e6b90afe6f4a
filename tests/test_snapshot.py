"""Snapshots: exact, the same everywhere, and never half applied."""

from __future__ import annotations

import copy
import json
import math
import struct
import subprocess
import sys
import zlib
from pathlib import Path

import esper
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.worlds import fresh_world
from weather_ecs import Weather, snapshot
from weather_ecs.components import (
    SNAPSHOT_COMPONENTS,
    Observer,
    Occluder,
    PointLight,
    RainArea,
    RainContainer,
    Sun,
    Wind,
)
from weather_ecs.errors import SnapshotError
from weather_ecs.snapshot_file import LARGEST, VERSION, seal

pytestmark = pytest.mark.usefixtures("world")

ROOT = Path(__file__).resolve().parent.parent
TIMES = [0.016, 0.4, 0.0, 2.7, 1 / 3, 11.0, 0.05]


def build() -> None:
    """A world with some of everything, some of it moving."""
    esper.create_entity(Wind((3, 1), 7.3))
    esper.create_entity(Wind((-1, 0.3), 1.1), PointLight((1, 2, 3)))
    esper.create_entity(Wind((0.1, 0.9), 0.7))
    for number in range(5):
        esper.create_entity(
            RainArea((number / 3, 0.1), (9.7, 3.3), velocity=(0.1, -number / 7), drift=number / 9)
        )
    esper.create_entity(Sun((1, 2, 3)), RainContainer(veil=0.3))


def document() -> dict:
    """What a snapshot of such a world holds."""
    with fresh_world(), Weather(seed=3) as weather:
        build()
        esper.process(0.37)
        return snapshot.decode(weather.snapshot())


DOCUMENT = document()


def components() -> list[tuple[int, str, list]]:
    """All components of the current world, as plain values."""
    return sorted(
        (entity, name, [getattr(component, field) for field in component.__slots__])
        for name, kind in {**SNAPSHOT_COMPONENTS, "Observer": Observer}.items()
        for entity, component in esper.get_component(kind)
    )


def test_a_snapshot_is_small_and_taking_it_changes_nothing():
    weather = Weather(seed=3)
    build()
    esper.process(0.37)
    first = weather.snapshot()
    assert len(first) < 3000
    assert first[:4] == b"WECS"
    assert weather.snapshot() == first


def test_restored_into_an_empty_world_it_goes_on_alike():
    weather = Weather(seed=3)
    build()
    esper.process(0.37)
    weather.paused, weather.speed = False, 1.7
    data = weather.snapshot()
    with fresh_world(), Weather(seed=99) as twin:
        esper.create_entity()  # ids differ
        esper.create_entity(Observer())
        twin.restore(data)
        assert twin.snapshot() == data
        assert twin.speed == 1.7
        mine = []
        for dt in TIMES:
            esper.process(dt)
            mine.append(twin.snapshot())
        rates = [twin.sample((x, 0, 0)).rain_rate for x in range(20)]
    for dt, expected in zip(TIMES, mine, strict=True):
        esper.process(dt)
        assert weather.snapshot() == expected
    assert [weather.sample((x, 0, 0)).rain_rate for x in range(20)] == rates


PROGRAM = """
import sys, esper
from weather_ecs import Weather
times = [float(t) for t in sys.argv[1].split(",")]
weather = Weather(seed=5)
weather.restore(bytes.fromhex(sys.stdin.read()))
for t in times:
    esper.process(t)
    weather.sample((1.0, 2.0, 3.0))
assert not {"moderngl", "pyglet"} & set(sys.modules), "a server needs no OpenGL"
print(weather.snapshot().hex())
"""


def test_another_process_without_opengl_gets_the_same_bytes():
    weather = Weather(seed=3)
    build()
    esper.process(0.37)
    start = weather.snapshot()
    for dt in TIMES:
        esper.process(dt)
        assert weather.stats.frame
    result = subprocess.run(
        [sys.executable, "-c", PROGRAM, ",".join(map(repr, TIMES))],
        input=start.hex(),
        capture_output=True,
        text=True,
        cwd=ROOT,
        timeout=60,
        check=False,
    )
    assert result.returncode == 0, result.stderr
    assert bytes.fromhex(result.stdout) == weather.snapshot()


def test_living_entities_keep_their_components_and_others_come_and_go():
    weather = Weather()
    kept, changed = RainArea((1, 1), (5, 4)), RainArea((2, 2), (5, 4), 8.0)
    esper.create_entity(kept)
    entity = esper.create_entity(changed, Wind((1, 0), 2.0))
    gone = esper.create_entity(RainArea((3, 3), (5, 4), 33.0), Observer())
    lost = esper.create_entity(Sun())
    data = weather.snapshot()
    changed.rain_rate = 99.0
    esper.add_component(entity, PointLight())
    esper.remove_component(entity, Wind)
    esper.remove_component(gone, RainArea)
    esper.delete_entity(lost)
    new = esper.create_entity(RainContainer())
    mixed = esper.create_entity(RainArea((9, 9), (5, 4)), Observer((1, 2, 3)))
    weather.restore(data)
    assert esper.component_for_entity(entity, RainArea) is changed
    assert changed.rain_rate == 8.0
    assert not esper.has_component(entity, PointLight)
    assert esper.component_for_entity(entity, Wind).speed == 2.0
    assert not esper.entity_exists(new)
    assert esper.entity_exists(mixed)
    assert not esper.has_component(mixed, RainArea)
    assert esper.component_for_entity(mixed, Observer).position == (1.0, 2.0, 3.0)
    assert weather.sample((3, 0, 3)).rain_rate == pytest.approx(33.0 + 8.0 + 5.0, rel=0.5)
    assert weather.snapshot() == data
    esper.process(0.0)
    assert weather.snapshot() == data
    assert len(esper.get_component(Sun)) == 1


def test_what_belongs_to_the_game_is_left_alone():
    weather = Weather()
    build()
    empty = weather.snapshot()
    roof = Occluder(np.eye(3), [0, 1, 2])
    esper.create_entity(roof, Observer((7, 8, 9)))
    esper.create_entity("a component of the game")
    assert weather.snapshot() == empty
    weather.restore(empty)
    assert esper.get_component(Occluder)[0][1] is roof
    assert esper.get_component(Observer)[0][1].position == (7.0, 8.0, 9.0)
    assert esper.get_component(str)


def test_the_generator_goes_on_where_it_was():
    weather = Weather(seed=11)
    weather._state.rng.random(5)
    weather._state.rng.integers(0, 7, dtype=np.uint32)
    data = weather.snapshot()
    expected = weather._state.rng.random(4).tolist()
    weather.restore(data)
    assert weather._state.rng.random(4).tolist() == expected
    with fresh_world(), Weather() as other:
        other.restore(data)
        assert other._state.seed == 11
        assert other._state.rng.random(4).tolist() == expected


def test_entities_made_after_a_restore_get_the_same_numbers():
    weather = Weather()
    build()
    data = weather.snapshot()

    def go_on() -> bytes:
        esper.create_entity(RainArea((0, 0), (3, 2), drift=1.0))
        esper.process(0.4)
        esper.delete_entity(esper.create_entity(Wind()))
        esper.process(0.4)
        return weather.snapshot()

    first = go_on()
    weather.restore(data)
    assert go_on() == first


numbers = st.floats(-1e7, 1e7)


@settings(deadline=None, max_examples=60, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.lists(
        st.builds(
            RainArea,
            st.tuples(numbers, numbers),
            st.tuples(st.floats(1e-3, 1e6), st.floats(1e-3, 1e6)).map(lambda r: (max(r), min(r))),
            st.floats(0, 1e4),
            st.floats(allow_nan=False, allow_infinity=False),
            st.floats(0, 1e6),
            st.floats(-1e5, 1e5),
            st.tuples(st.floats(-150, 150), st.floats(-150, 150)),
            st.floats(0, 1),
        ),
        max_size=4,
    ),
    st.lists(st.builds(Wind, st.tuples(numbers, numbers).filter(any), st.floats(0, 150))),
    st.integers(0, 2**63 - 1),
    st.floats(0, 10),
)
def test_every_bit_comes_back(areas, winds, seed, dt):
    with fresh_world(), Weather(seed=seed) as weather:
        for component in [*areas, *winds]:
            esper.create_entity(component)
        esper.process(dt)
        data, before = weather.snapshot(), components()
        esper.process(3.3)
        weather.restore(data)
        assert components() == before
        assert weather.snapshot() == data
    with fresh_world(), Weather() as weather:
        weather.restore(data)
        assert weather.snapshot() == data


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
        (sealed(b"[]"), "not an object"),
        (sealed(b"{}"), "parts"),
        (sealed(b"{"), "JSON"),
        (sealed(b"\xff\xfe"), "JSON"),
        (sealed(b"[" * 100_000), "JSON"),
        (sealed(b"1" * 10_000), "JSON"),
        (sealed(b'{"a":NaN}'), "JSON"),
        (sealed(b"{}", length=1), "length"),
        (sealed(b"{}", length=3), "length"),
        (sealed(b"{}", length=2**31), "claims"),
        (sealed(b"{}", cells=b"123"), "more cells"),
        (sealed(b'{"snow":{"codes":4}}', cells=b"123"), "fewer cells"),
        (sealed(b'{"snow":{"codes":-1}}', cells=b"123"), "fewer cells"),
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


def changed(*path: object, value: object) -> dict:
    result = copy.deepcopy(DOCUMENT)
    place = result
    for step in path[:-1]:
        place = place[step]
    place[path[-1]] = value
    return result


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
