"""Pictures and films on disk: written whole, or not at all."""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from weather_ecs.errors import MissingExtraError

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_KINDS = {1: 0, 3: 2, 4: 6}  # PNG's colour types by the number of channels


@contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """A path beside the one that is wanted, which takes its place when all went well."""
    other = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        yield other
        os.replace(other, path)
    finally:
        other.unlink(missing_ok=True)


def write_png(path: Path, pixels: NDArray[np.uint8]) -> None:
    """Write a picture of shape (height, width, 3 or 4), top row first. Raises OSError."""
    with written_whole(path) as other:
        other.write_bytes(png(pixels))


def png(pixels: NDArray[np.uint8]) -> bytes:
    """A picture as PNG has it (ISO/IEC 15948), 8 bits a channel; rows as differences from above."""
    height, width, channels = pixels.shape
    rows = np.empty((height, 1 + width * channels), np.uint8)
    flat = np.ascontiguousarray(pixels, np.uint8).reshape(height, -1)
    rows[:, 0] = 2  # the filter "up"
    rows[0, 1:] = flat[0]
    rows[1:, 1:] = flat[1:] - flat[:-1]
    head = struct.pack(">IIBBBBB", width, height, 8, _KINDS[channels], 0, 0, 0)
    body = zlib.compress(rows.tobytes(), 6)
    return _SIGNATURE + _chunk(b"IHDR", head) + _chunk(b"IDAT", body) + _chunk(b"IEND", b"")


def film(path: Path, size: tuple[int, int], fps: float) -> Generator[None, bytes, None]:
    """Takes pictures of RGB bytes, top row first, by `send`; `close` ends the film.

    Raises MissingExtraError without the encoder.
    """
    try:
        import imageio_ffmpeg
    except ImportError:
        raise MissingExtraError("editor", "imageio-ffmpeg") from None
    writer = imageio_ffmpeg.write_frames(
        str(path),
        size,
        fps=fps,
        codec="libx264",
        quality=8,
        macro_block_size=2,
        ffmpeg_log_level="error",
    )
    writer.send(None)
    return writer


def _chunk(name: bytes, body: bytes) -> bytes:
    return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))
