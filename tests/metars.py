"""Real METAR reports."""

from __future__ import annotations

from pathlib import Path

FILE = Path(__file__).parent / "data" / "metars.txt"
REAL = [line for line in FILE.read_text().splitlines() if line and line[0] != "#"]


def find(station: str) -> str:
    return next(line for line in REAL if station in line)
