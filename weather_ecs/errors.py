"""Errors of the package: one root, so that a game can catch them all."""

from __future__ import annotations


class WeatherError(Exception):
    """Root of every error the package raises on purpose."""


class InvalidValueError(WeatherError, ValueError):
    """A value outside its permitted range; names the field, the value and the range."""

    def __init__(self, field: str, value: object, allowed: str) -> None:
        shown = repr(value)
        if len(shown) > 200:
            shown = shown[:200] + "..."
        super().__init__(f"{field}: got {shown}, allowed: {allowed}")
        self.field = field
        self.value = value
        self.allowed = allowed


class ContextError(WeatherError, RuntimeError):
    """No usable OpenGL context: too old, not current, or already closed."""


class ShaderError(WeatherError, RuntimeError):
    """A shader that does not resolve, compile or link; carries file, line and the driver's log."""


class SnapshotError(WeatherError, ValueError):
    """Bytes that are not a snapshot this version can restore."""


class ClosedError(WeatherError, RuntimeError):
    """The weather was used after `close`."""
