"""The scripts of the sky's sheets: what they are told, and how angles are measured."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tools import collision_sheets, metar_sheet, showcase, sky_sheets, stills

ROOT = Path(__file__).parent.parent
KEPT = (
    "collisions", "day", "halo", "lee", "metar", "puddles", "rainbow", "showcase", "splashes",
    "storm", "strike",
)  # fmt: skip


@pytest.mark.parametrize(
    ("main", "arguments"),
    [
        (metar_sheet.main, []),
        (metar_sheet.main, ["out.jpg"]),
        (sky_sheets.main, ["out.jpg"]),
        (sky_sheets.main, ["out.jpg", "dawn"]),
        (collision_sheets.main, ["out.jpg"]),
        (collision_sheets.main, ["out.jpg", "hail"]),
        (showcase.main, []),
        (showcase.main, ["out.jpg", "snow", "dawn"]),
    ],
)
def test_what_is_missing_is_said(
    main: object, arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 2  # type: ignore[operator]
    assert "usage" in capsys.readouterr().err


def test_reports_are_read_without_remarks() -> None:
    found = metar_sheet.reports_of("# two of them\nEHAM 1\n\n  LPPT 2  \n")
    assert found == ["EHAM 1", "LPPT 2"]


def test_a_ring_is_measured_where_it_adds_most() -> None:
    apart = np.linspace(15.0, 62.0, 480)[None, :].repeat(40, axis=0)
    light = 120.0 * np.exp(-(((apart - 42.3) / 0.5) ** 2))
    light += 30.0 * np.exp(-(((apart - 51.0) / 0.8) ** 2))
    without = np.full((*apart.shape, 3), 60, np.uint8)
    there = (without + light[..., None]).astype(np.uint8)
    peaks = sky_sheets._peaks((there, without), apart, ((39.0, 45.0), (48.0, 56.0)))
    assert peaks == pytest.approx([42.3, 51.0], abs=0.25)


def test_sheets_hold_pictures_and_texts(tmp_path: Path) -> None:
    from PIL import Image

    pictures = [np.full((90, 160, 3), 40 * k, np.uint8) for k in range(1, 4)]
    for name in ("sheet.png", "sheet.jpg"):
        stills.save_sheet(tmp_path / name, pictures, ["a", "b", "c"], columns=2, width=80)
        with Image.open(tmp_path / name) as sheet:
            assert sheet.width == 160 and sheet.height > 90
            got = np.asarray(sheet.convert("RGB"))
        assert np.abs(got[10, 10].astype(int) - 40).max() < 4
        assert np.abs(got[10, 120].astype(int) - 80).max() < 4


def test_what_the_pages_show_is_small() -> None:
    files = ROOT / "README.md", *(ROOT / "docs").glob("*.md")
    pages = "".join(page.read_text(encoding="utf-8") for page in files)
    for name in KEPT:
        assert (ROOT / "docs" / "images" / f"{name}.jpg").stat().st_size < 300_000
        assert f"images/{name}.jpg" in pages
