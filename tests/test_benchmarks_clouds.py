"""The benchmark of the clouds in its quick mode: what it measures, not how fast it was."""

from __future__ import annotations

from pathlib import Path

from tests.benchmark_reports import check_shape, report


def test_clouds_measures_the_dissertation_s_three_skies(tmp_path: Path) -> None:
    result = report("clouds", tmp_path)
    check_shape(result, "clouds")
    rows = {row["clouds"]: row for row in result["rows"]}
    assert set(rows) == {100, 200, 1000}
    assert 0 < rows[100]["drawn"] < rows[200]["drawn"] < rows[1000]["drawn"] < 1000
    names = {"fps_100", "fps_200", "fps_1000", "cfa_ms_per_frame"}
    assert set(result["ratios"]) == names
    assert all(row["cfa_ms"] >= 0.0 and row["start_s"] > 0.0 for row in rows.values())
