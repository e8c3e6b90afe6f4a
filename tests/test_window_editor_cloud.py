"""The editor's cloud workspace in a real window, and its benchmark."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from xvfb import ROOT, display

pytestmark = pytest.mark.window


@pytest.mark.parametrize("case", ["story", "hands", "trouble"])
def test_cloud_workspace(case: str, tmp_path: Path) -> None:
    with display((1280, 800)) as screen:
        screen.python(ROOT / "tests" / "window_editor_cloud.py", case, tmp_path, seconds=550.0)
        if case == "story":
            # The demo opens what was made, and its pictures show it.
            screen.python(
                *("-m", "demo_game", "--headless", "--tour", "still", "--size", "320x180"),
                *("--frames", 3, "--every", 3, "--seed", 1, "--preset", tmp_path / "tower.toml"),
                *("--out", tmp_path / "walk", "--stats", tmp_path / "walk.jsonl"),
            )
            assert list((tmp_path / "walk").glob("*.png"))
            lines = (tmp_path / "walk.jsonl").read_text().splitlines()
            assert json.loads(lines[-1])["clouds_drawn"] > 0


def test_benchmark_shows_a_change_in_the_next_frame(tmp_path: Path) -> None:
    path = tmp_path / "editor.json"
    with display((1280, 800)) as screen:
        screen.python("-m", "benchmarks", "editor", "--quick", "--json", path)
    result = json.loads(path.read_text())
    rows = {row["name"]: row for row in result["rows"]}
    assert set(rows) == {"idle", "slider", "slider_marks", "orbit"}
    assert all(row["seeds"] == 100 and row["billboards"] == 1000 for row in rows.values())
    assert result["ratios"]["frames_until_shown"] == 1.0
    assert result["ratios"]["open_50_ms"] > 0.0
