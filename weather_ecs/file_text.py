"""Text of files that nobody has to trust: read within bounds, written whole or not at all."""

from __future__ import annotations

import errno
import os
import re
import secrets
import shutil
import stat
import tomllib
from collections.abc import Mapping
from contextlib import suppress
from itertools import accumulate
from pathlib import Path
from typing import Any

from weather_ecs.errors import WeatherFileError
from weather_ecs.toml_scan import TooDeepError, statements

LARGEST = 2 * 1024 * 1024  # bytes of a file
LONGEST_LINE = 2000  # characters; bounds what reading takes, however a file is made
DEEPEST = 32  # tables and arrays inside each other, each way of writing them

MOST_TABLES = 20_000  # headers; what the package itself writes within LARGEST has fewer

_HEADER = re.compile(r"^[ \t]*\[", re.MULTILINE)
_BRACKET = re.compile(r"[\[\]{}]")
_DOTTED = re.compile(rf"(?:\.[^.\n]*+){{{DEEPEST}}}")


def read_text(name: str) -> str:
    """A file's text. Raises WeatherFileError for one that is missing, too long or not UTF-8."""
    try:
        if not os.path.isfile(name):
            raise WeatherFileError(name, "there is no such file")
        with open(name, "rb") as stream:
            data = stream.read(LARGEST + 1)
    except OSError as error:
        raise WeatherFileError(name, f"cannot be read: {error.strerror}") from None
    except ValueError:  # a name that no file can have
        raise WeatherFileError(name, "there is no such file") from None
    if len(data) > LARGEST:
        raise WeatherFileError(name, f"longer than {LARGEST} bytes")
    try:
        return data.decode("utf-8-sig")  # some editors begin a file with a mark that says so
    except UnicodeDecodeError as error:
        raise WeatherFileError(name, f"not UTF-8 text: {error}") from None


def parse(name: str, text: str) -> dict[str, Any]:
    """A TOML text as tables. Raises WeatherFileError that names the file and the line."""
    _check_lines(name, text)
    try:
        if _may_be_deep(text) or len(_HEADER.findall(text)) > MOST_TABLES:
            headers = sum(1 for each in statements(text, DEEPEST) if each.header)
            if headers > MOST_TABLES:
                raise WeatherFileError(name, f"{headers} tables, allowed: at most {MOST_TABLES}")
        return tomllib.loads(text)
    except TooDeepError as error:
        deep = f"line {error.line}: nested too deeply, allowed: at most {DEEPEST} levels"
        raise WeatherFileError(name, deep) from None
    except RecursionError:
        raise WeatherFileError(name, "values are nested too deeply") from None
    except ValueError as error:  # also of a number with thousands of digits
        raise WeatherFileError(name, f"not valid TOML: {error}") from None


def write_text(name: str, text: str) -> None:
    """Replace a file by another text, or make it: all of it, or the old file stays.

    Links are followed, the file's mode is kept. Raises WeatherFileError for a text that
    `read_text` and `parse` would refuse for its size, PermissionError for a file that is
    write-protected, and OSError.
    """
    data = text.encode("utf-8")
    if len(data) > LARGEST or max(map(len, text.split("\n"))) > LONGEST_LINE:
        raise WeatherFileError(name, f"more than {LARGEST} bytes, or {LONGEST_LINE} in a line")
    try:
        target = Path(name).resolve()
    except (RuntimeError, ValueError) as error:  # links in a circle, a name that cannot be
        raise OSError(errno.EINVAL, str(error), name) from None
    before = _mode(target)
    if before is not None and not (before & 0o222 and os.access(target, os.W_OK)):
        raise PermissionError(errno.EACCES, "the file is write-protected", name)
    # A short name of its own: the target's may be as long as names can be.
    aside = target.with_name(f".{secrets.token_hex(6)}.tmp")
    try:
        with open(aside, "xb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        if before is not None:
            shutil.copymode(target, aside)
        os.replace(aside, target)
    except BaseException as error:
        with suppress(OSError):
            aside.unlink(missing_ok=True)
        if isinstance(error, OSError) and error.filename == str(aside):
            error.filename = name  # the one that is known
        raise
    _sync_folder(target.parent)


def _mode(target: Path) -> int | None:
    """Permissions of a file; None where there is none. Raises OSError for what is no file."""
    try:
        found = target.stat().st_mode
    except FileNotFoundError:
        return None
    if stat.S_ISDIR(found):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(target))
    if not stat.S_ISREG(found):
        raise OSError(errno.EINVAL, "not a plain file", str(target))
    return found


def _sync_folder(folder: Path) -> None:
    """Let the new name survive a power cut, where folders can be synced."""
    with suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _check_lines(name: str, text: str) -> None:
    for number, line in enumerate(text.split("\n"), 1):
        if len(line) > LONGEST_LINE:
            long = f"line {number} has {len(line)} characters, allowed: at most {LONGEST_LINE}"
            raise WeatherFileError(name, long)


def _may_be_deep(text: str) -> bool:
    """Whether it is worth looking closely; True also for some texts that are not deep."""
    steps = [1 if mark in "[{" else -1 for mark in _BRACKET.findall(text)]
    return max(accumulate(steps), default=0) > DEEPEST or _DOTTED.search(text) is not None


def depth(value: Any, most: int = DEEPEST) -> int:
    """How deeply tables and lists are nested in a value; stops counting beyond `most`."""
    level, found = [value], 0
    while found <= most:
        inner: list[Any] = []
        for item in level:
            if isinstance(item, Mapping):
                inner.extend(item.values())
            elif isinstance(item, (list, tuple)):
                inner.extend(item)
        if not inner:
            return found
        level, found = inner, found + 1
    return found
