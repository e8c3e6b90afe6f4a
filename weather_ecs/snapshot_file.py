"""A snapshot's bytes: a header, its values as compressed canonical JSON, and its cells.

The header has magic, format version, the lengths of both parts and the CRC-32 of all that follows.
The JSON has sorted keys, no spaces, and floats with as many digits as give them back to the bit;
in place of the codes of cells it says how many bytes of the second part they are. There is no code
in it, and nothing in it is trusted.
"""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Callable
from typing import Any

from weather_ecs.errors import SnapshotError

MAGIC = b"WECS"
VERSION = 2
LARGEST = 32 * 1024 * 1024  # bytes of either part; a bomb stops there

_HEADER = struct.Struct("<4sHIII")  # magic, version, lengths of both parts, CRC-32 of the rest
_GROUNDS = ("snow", "wetness")  # parts of a document that have cells


def encode(document: dict[str, Any]) -> bytes:
    """Bytes of a JSON document. Raises ValueError for NaN and infinity."""
    cells: list[bytes] = []

    def take_out(codes: Any) -> Any:
        try:
            cells.append(bytes.fromhex(codes))
        except (TypeError, ValueError):
            return codes
        return len(cells[-1])

    short = {
        name: _with_codes(part, take_out) if name in _GROUNDS else part
        for name, part in sorted(document.items())
    }
    text = json.dumps(short, sort_keys=True, separators=(",", ":"), allow_nan=False).encode()
    return seal(zlib.compress(text, 9), len(text), b"".join(cells))


def seal(packed: bytes, length: int, cells: bytes = b"", version: int = VERSION) -> bytes:
    """A header before compressed text, so long when it is not, and cells to be compressed."""
    # Mostly small numbers that follow no pattern.
    small = zlib.compressobj(9, zlib.DEFLATED, 15, 9, zlib.Z_FILTERED)
    rest = packed + small.compress(cells) + small.flush()
    checksum = _checksum(length, len(cells), rest)
    return _HEADER.pack(MAGIC, version, length, len(cells), checksum) + rest


def decode(data: bytes) -> dict[str, Any]:
    """The JSON document of `encode`. Raises SnapshotError for anything else."""
    if not isinstance(data, (bytes, bytearray, memoryview)):
        raise SnapshotError(f"a snapshot is bytes, not {type(data).__name__}")
    data = bytes(data)
    if data[:4] != MAGIC[: len(data[:4])] or len(data) < 4:
        raise SnapshotError("these bytes are not a weather snapshot")
    if len(data) < _HEADER.size:
        raise SnapshotError("the snapshot is cut off in its header")
    _, version, length, cells, checksum = _HEADER.unpack_from(data)
    if version != VERSION:
        raise SnapshotError(f"the snapshot has format version {version}, this is {VERSION}")
    if max(length, cells) > LARGEST:
        raise SnapshotError(f"the snapshot claims {max(length, cells)} bytes, allowed: {LARGEST}")
    rest = data[_HEADER.size :]
    if _checksum(length, cells, rest) != checksum:
        raise SnapshotError("the snapshot is damaged or cut off: its checksum does not fit")
    text, rest = _inflated(rest, length)
    codes, rest = _inflated(rest, cells)
    if rest:
        raise SnapshotError("the snapshot's content has another length than it claims")
    try:
        document = json.loads(text, parse_constant=_refuse_constant)
        if not isinstance(document, dict):
            raise SnapshotError("the snapshot's content is not an object")
        return _with_cells(document, codes)
    except SnapshotError:  # a ValueError as well, that has been said already
        raise
    except (ValueError, RecursionError) as error:
        raise SnapshotError(f"the snapshot's content is not valid JSON: {error}") from None


def _inflated(data: bytes, length: int) -> tuple[bytes, bytes]:
    """A compressed part that claims to be so long, and what comes after it."""
    try:
        stream = zlib.decompressobj()
        found = stream.decompress(data, length + 1)
    except zlib.error as error:
        raise SnapshotError(f"the snapshot cannot be decompressed: {error}") from None
    if len(found) != length or not stream.eof:
        raise SnapshotError("the snapshot's content has another length than it claims")
    return found, stream.unused_data


def _with_cells(document: dict[str, Any], cells: bytes) -> dict[str, Any]:
    """The document with the codes of its cells where it says how many they are."""
    at = 0

    def put_back(count: Any) -> Any:
        nonlocal at
        if type(count) is not int:
            return count
        if not 0 <= count <= len(cells) - at:
            raise SnapshotError("the snapshot has fewer cells than it claims")
        at += count
        return cells[at - count : at].hex()

    for name in sorted(document):
        if name in _GROUNDS:
            document[name] = _with_codes(document[name], put_back)
    if at != len(cells):
        raise SnapshotError("the snapshot has more cells than it claims")
    return document


def _with_codes(value: Any, change: Callable[[Any], Any]) -> Any:
    """A copy in which every field `codes` is what `change` makes of it, in the keys' order."""
    if isinstance(value, list):
        return [_with_codes(item, change) for item in value]
    if isinstance(value, dict):
        return {
            name: change(value[name]) if name == "codes" else _with_codes(value[name], change)
            for name in sorted(value)
        }
    return value


def _checksum(length: int, cells: int, rest: bytes) -> int:
    return zlib.crc32(rest, zlib.crc32(struct.pack("<II", length, cells)))


def _refuse_constant(name: str) -> float:
    raise ValueError(f"{name} is not a number")
