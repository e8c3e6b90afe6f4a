"""Errors of the package: one root, so that a game can catch them all."""

from __future__ import annotations


class WeatherError(Exception):
    """Root of every error the package raises on purpose."""


def shorten(value: object) -> str:
    """What a message shows of a value."""
    shown = repr(value)
    return shown if len(shown) <= 200 else shown[:200] + "..."


class InvalidValueError(WeatherError, ValueError):
    """A value outside its permitted range; names the field, the value and the range."""

    def __init__(self, field: str, value: object, allowed: str) -> None:
        super().__init__(f"{field}: got {shorten(value)}, allowed: {allowed}")
        self.field = field
        self.value = value
        self.allowed = allowed


class ContextError(WeatherError, RuntimeError):
    """No usable OpenGL context: too old, not current, or already closed."""


class ShaderError(WeatherError, RuntimeError):
    """A shader that does not resolve, compile or link; carries file, line and the driver's log."""


class SnapshotError(WeatherError, ValueError):
    """Bytes that are not a snapshot this version can restore."""


class WeatherFileError(WeatherError, ValueError):
    """A file that cannot be loaded; names it and, where it can, the line, the key and the value."""

    def __init__(self, path: str, problem: str) -> None:
        super().__init__(f"{path}: {problem}")
        self.path = path
        self.line: int | None = None
        self.key = ""

    @classmethod
    def of(
        cls, path: str, line: int | None, key: str, value: object, allowed: str
    ) -> WeatherFileError:
        """The error for one value of a file."""
        shown = "nothing" if value is None else shorten(value)
        place = f"line {line}, " if line else ""
        error = cls(path, f"{place}{key}: got {shown}, allowed: {allowed}")
        error.line, error.key = line, key
        return error


class MissingExtraError(WeatherError, ImportError):
    """A library is missing that an optional feature needs; names the extra that brings it."""

    def __init__(self, extra: str, library: str) -> None:
        super().__init__(f"the library {library!r} is missing: pip install 'weather_ecs[{extra}]'")
        self.extra = extra


class MetarError(WeatherError, ValueError):
    """A text that is not a METAR report, or one of impossible values."""


class ClosedError(WeatherError, RuntimeError):
    """The weather was used after `close`."""
