"""One JSON line per frame, for scripts that measure a tour."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

KEYS = (
    "frame",
    "t",
    "ms",
    "position",
    "mode",
    "rain_rate_here",
    "drops_moved",
    "drops_drawn",
    "impacts",
    "splashes",
    "clouds_drawn",
    "impostors_refreshed",
    "cfa_computed",
    "state",
)


def row(
    frame: int, time: float, ms: float, position: Sequence[float], stats: Any, state: str
) -> dict[str, object]:
    """One frame's line; `stats` is the weather's, what it does not count is 0."""
    return {
        "frame": frame,
        "t": round(time, 6),
        "ms": round(ms, 3),
        "position": [round(float(value), 4) for value in position],
        "mode": str(stats.mode),
        "rain_rate_here": round(float(stats.rain_rate_here), 4),
        "drops_moved": int(stats.drops_moved),
        "drops_drawn": int(stats.drops_drawn),
        "impacts": int(getattr(stats, "impacts", 0)),
        "splashes": int(getattr(stats, "splashes", 0)),
        "clouds_drawn": int(getattr(stats, "clouds_drawn", 0)),
        "impostors_refreshed": int(getattr(stats, "impostors_refreshed", 0)),
        "cfa_computed": int(getattr(stats, "cfa_computed", 0)),
        "state": state,
    }


class StatsWriter:
    """Writes rows as they come; every line is whole even if the run is cut short."""

    def __init__(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        self._file = path.open("w", encoding="utf-8", buffering=1)

    def write(self, line: dict[str, object]) -> None:
        """Append one line."""
        self._file.write(json.dumps(line, allow_nan=False) + "\n")

    def close(self) -> None:
        """Close the file; a second call does nothing."""
        self._file.close()
