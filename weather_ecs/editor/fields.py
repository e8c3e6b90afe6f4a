"""What every field means, in which unit, and what it may be: for sliders and tooltips.

Ranges are those of the components' own checks. `info(RainArea, "rain_rate").tooltip()` gives

    Water that falls in the middle of the area.
    mm/h, 0 to 10 000
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from functools import cache
from typing import Any

from weather_ecs.components._base import Component, Limits, limits_of
from weather_ecs.editor.field_texts import TEXTS

_LIMITLESS = Limits("other")


@dataclass(frozen=True, slots=True)
class Field:
    """One field of a component."""

    name: str
    label: str  # as a panel calls it
    unit: str  # as it is written behind a value; "" for a share, a factor, a count
    help: str  # one sentence
    default: Any  # None where there is none
    limits: Limits
    soft: tuple[float, float]  # what a slider goes over; a typed value may go beyond

    @property
    def low(self) -> float:
        """The least value."""
        return self.limits.low

    @property
    def high(self) -> float:
        """The greatest value."""
        return self.limits.high

    def range_text(self) -> str:
        """Unit and range in words."""
        limits = self.limits
        if limits.kind == "choice":
            return ", ".join(limits.choices)
        if limits.kind == "flag":
            return "on or off"
        words = [self.unit] if self.unit else []
        if limits.kind == "direction":
            words.append(f"{limits.size} numbers, kept at length 1")
        elif limits.kind == "integer":
            words.append(f"{_number(limits.low)} to {_number(limits.high)}, whole")
        elif limits.kind in ("number", "vector") and math.isfinite(limits.low):
            above = "above " if limits.above else ""
            words.append(f"{above}{_number(limits.low)} to {_number(limits.high)}")
        if limits.optional:
            words.append("or none")
        return ", ".join(words)

    def tooltip(self) -> str:
        """What it means, its unit and its range."""
        return "\n".join(part for part in (self.help, self.range_text()) if part)


def info(kind: type[Component], name: str) -> Field:
    """What there is to know about a field. Raises KeyError for one that does not exist."""
    found: Field = _kept_info(kind, name)
    return found


def _info(kind: type[Component], name: str) -> Field:
    label, unit, words, *soft = TEXTS[kind][name]
    entry = next(entry for entry in fields(kind) if entry.name == name)  # type: ignore[arg-type]
    limits = limits_of(kind.checks[name]) or _LIMITLESS
    default = entry.default if isinstance(entry.default, (int, float, str, tuple)) else None
    low, high = soft if soft else (limits.low, limits.high)
    return Field(name, label, unit, words, default, limits, (low, high))


_kept_info: Any = cache(_info)  # to mypy a class of components has no hash


def _number(value: float) -> str:
    if value == math.inf:
        return "without limit"
    return f"{value:,.0f}".replace(",", " ") if abs(value) >= 1e4 else f"{value:g}"
