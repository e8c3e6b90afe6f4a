"""The benchmark of rain and snow, in its quick mode: what it measures, not how fast it was."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.models.held import crossing, ladder
from benchmarks.precipitation import PAPER
from tests.benchmark_reports import check_shape, report


def test_precipitation_has_the_papers_table_beside_ours(tmp_path: Path) -> None:
    result = report("precipitation", tmp_path)
    check_shape(result, "precipitation")
    rows = {row["name"]: row for row in result["rows"]}
    # Liu and Tong (2015), Table 1.
    for name, drops, textured, spheres in (
        ("light", 150, 91, 32), ("moderate", 500, 78, 21), ("heavy", 1000, 56, 10),
    ):  # fmt: skip
        assert PAPER[name] == (drops, textured, spheres)
        for how, fps in (("textured", textured), ("spheres", spheres)):
            row = rows[f"paper_{name}_{how}"]
            assert (row["drops"], row["fps"]) == (drops, fps)
            assert row["ms"] == pytest.approx(1e3 / fps, rel=1e-4)
        assert rows[name]["drops"] == 5000
    ratios = result["ratios"]
    for kind in ("drops", "flakes"):
        at_56, at_60 = (ratios[f"{kind}_at_{fps}fps"] for fps in (56, 60))
        assert 0.0 < at_60 <= at_56
        assert len([name for name in rows if name.startswith(f"{kind}_")]) >= 3
    assert ratios["times_the_papers"] == pytest.approx(ratios["drops_at_56fps"] / 1000.0)
    compared = {"snow_over_rain", "snow_over_rain_feedback", "turbulence_share", "fog_ms"}
    assert compared <= set(ratios)
    assert rows["fog"]["drops"] == rows["fog_twice"]["drops"] == 0
    for plain, other in (("rain", "snow"), ("rain_feedback", "snow_feedback")):
        assert rows[other]["drops"] == rows[plain]["drops"] == 5000
        assert rows[other]["rounds"] == rows[plain]["rounds"] > rows["light"]["rounds"]


def test_the_number_held_lies_between_two_of_the_ladder() -> None:
    drops = ladder(40_000, 8_000_000)
    assert drops == [20_000, 28_284, 40_000, 56_569, 80_000]
    assert ladder(1, 10) == [1, 2]
    ms = [n / 2000.0 for n in drops]
    assert crossing(drops, ms, 1e3 / 56) == pytest.approx(2e6 / 56)
    assert crossing(drops, ms, 5.0) == pytest.approx(10_000)
    assert crossing(drops, ms, 80.0) == pytest.approx(160_000)
    noisy = [10.0, 9.0, 9.5, 20.0, 19.0]  # what gets quicker with more drops is noise
    assert 40_000 < crossing(drops, noisy, 15.0) < 56_569
    assert crossing(drops, noisy, 10.0) == 20_000
