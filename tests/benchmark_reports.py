"""Benchmarks run for a moment, and the shape of their reports."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest

from benchmarks import __main__ as command

Json = dict[str, Any]


def report(name: str, folder: Path) -> Json:
    """What `python -m benchmarks NAME --quick --json FILE` writes."""
    path = folder / f"{name}.json"
    assert command.main([name, "--quick", "--json", str(path)]) == 0
    text = path.read_text(encoding="utf-8")
    result: Json = json.loads(text, parse_constant=lambda word: pytest.fail(f"{word} in JSON"))
    return result


def check_shape(result: Json, name: str) -> None:
    assert set(result) == {"benchmark", "renderer", "machine", "rows", "ratios"}
    assert result["benchmark"] == name
    assert "OpenGL" in result["renderer"] and "cores" in result["machine"]
    assert all(row["ms"] > 0.0 and math.isfinite(row["ms"]) for row in result["rows"])
    assert all(
        isinstance(ratio, float | int) and math.isfinite(ratio)
        for ratio in result["ratios"].values()
    )
