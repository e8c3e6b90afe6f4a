"""The script of the sheets of what falls, and how far posts are seen."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tools import post_row, precipitation_sheets

ROOT = Path(__file__).parent.parent
KEPT = ("fog-posts", "presets", "snowfall", "wind-gust")


@pytest.mark.parametrize("arguments", [[], ["out.jpg"], ["out.jpg", "hail"]])
def test_what_is_missing_is_said(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert precipitation_sheets.main(arguments) == 2
    assert "usage" in capsys.readouterr().err


@pytest.mark.parametrize("visibility", [120.0, 470.0, 1490.0])
def test_a_post_is_seen_to_where_its_contrast_ends(visibility: float) -> None:
    wide, high = post_row.SIZE
    light = np.ones((high, wide, 3), np.float32)
    for k in range(int(post_row.LAST / post_row.APART)):
        x = post_row.column(k)
        away = post_row.APART * (k + 1)
        light[20:, x - 3 : x + 4] = 1.0 - post_row.LEAST ** (away / visibility)
    assert post_row.seen_to(light) == pytest.approx(visibility, rel=2e-3)


def test_what_the_pages_show_is_small() -> None:
    pages = "".join(page.read_text(encoding="utf-8") for page in (ROOT / "docs").glob("*.md"))
    for name in KEPT:
        assert (ROOT / "docs" / "images" / f"{name}.jpg").stat().st_size < 300_000
        assert f"images/{name}.jpg" in pages
