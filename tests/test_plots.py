"""The figure of docs/drops.md: what its script draws, and the picture that is kept."""

from __future__ import annotations

from pathlib import Path

import moderngl
import numpy as np
import pytest
from PIL import Image

from tools import plot_laws
from weather_ecs.physics import drops

KEPT = Path(__file__).resolve().parent.parent / "docs" / "images" / "drops.png"


def test_the_script_draws_the_laws_and_what_the_gpu_holds(
    ctx: moderngl.Context, tmp_path: Path
) -> None:
    made = plot_laws.figure(ctx)
    speeds, sizes, rest, shower, winds, ratios = made.axes
    lines = {ax.get_title(): ax.get_lines() for ax in made.axes}
    assert all(np.isfinite(line.get_xydata()).all() for each in lines.values() for line in each)
    on_gpu = speeds.get_lines()[0].get_xydata()
    assert on_gpu[:, 1] == pytest.approx(drops.terminal_speed(on_gpu[:, 0]), abs=5e-3)
    assert speeds.get_lines()[-1].get_xydata() == pytest.approx(plot_laws.GUNN_KINZER)
    for patch, rate in zip(sizes.patches, plot_laws.RATES, strict=True):
        found, edges, _ = patch.get_data()
        inside = [
            float(drops.number_density(rate, low, high) / (high - low))
            for low, high in zip(edges[:-1], edges[1:], strict=True)
        ]
        many = np.array(inside) > 20.0  # bins with hundreds of drops in them
        assert found[many] == pytest.approx(np.array(inside)[many], rel=0.06)
        assert many.sum() >= 4
    assert [len(ax.get_lines()) for ax in (rest, shower, winds)] == [5, 8, 4]
    assert ratios.get_lines()[0].get_ydata()[-1] == pytest.approx(0.64, abs=1e-3)
    path = tmp_path / "laws.png"
    made.savefig(path, dpi=30)
    with Image.open(path) as picture:
        assert picture.size == (360, 345) and np.asarray(picture.convert("L")).std() > 10.0


def test_the_picture_that_is_kept_is_small() -> None:
    assert KEPT.stat().st_size < 300_000
    with Image.open(KEPT) as picture:
        assert picture.size == (1200, 1150)


def test_the_script_says_how_it_is_used(capsys: pytest.CaptureFixture[str]) -> None:
    assert plot_laws.main([]) == 2
    assert "FILE" in capsys.readouterr().err
