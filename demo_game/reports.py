"""METAR reports on the command line: read before anything is built."""

from __future__ import annotations

from typing import Any

import esper

from weather_ecs import Weather

WORLD = "demo_game report"
SHORT = {"degrees": "\u00b0", "degrees Celsius": "\u00b0C"}


def read_report(text: str) -> Any:
    """What the weather understands of a report. Raises WeatherError for one that is not sound."""
    before = esper.current_world
    esper.switch_world(WORLD)
    try:
        with Weather() as weather:
            return weather.apply_metar(text, 0.0)
    finally:
        esper.switch_world(before)
        esper.delete_world(WORLD)


def summary(report: Any, most: int = 3, width: int = 32) -> list[str]:
    """A report in a few short lines, for the readout."""
    parts = [f"{report.station}, {report.time} UTC"]
    for field, value, unit, _ in report.understood:
        figure = f"{value:.3g}" if isinstance(value, float) else str(value)
        name = "" if field in ("clouds", "weather") else f"{field.replace('_', ' ')} "
        parts.append(f"{name}{figure} {SHORT.get(unit, unit)}".rstrip())
    lines = [parts[0]]
    for part in parts[1:]:
        if len(lines) > 1 and len(lines[-1]) + len(part) + 2 <= width:
            lines[-1] += f", {part}"
        else:
            lines.append(part)
    shown = lines[:most]
    if len(lines) > most:
        shown[-1] += ", \u2026"
    return [text if len(text) <= width else text[: width - 1] + "\u2026" for text in shown]
