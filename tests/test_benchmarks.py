"""The benchmarks of the rain, in their quick mode: what they measure, not how fast it was."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest

from benchmarks.models.box import BoxRain
from benchmarks.models.model import Model
from benchmarks.models.ours import OurRain
from benchmarks.models.rousseau import RousseauRain, refraction_mask
from benchmarks.models.stage import BACKGROUND, Stage
from benchmarks.models.tariq import AZIMUTHS, ELEVATIONS, KINDS, TariqRain, library
from benchmarks.rain_models import spread
from tests.benchmark_reports import check_shape, report

Keep = Callable[[Any], Any]


@pytest.fixture
def stage(ctx: moderngl.Context, keep: Keep) -> Stage:
    return keep(Stage(ctx, (320, 180)))


def test_rain_models_compares_like_with_like(tmp_path: Path) -> None:
    result = report("rain_models", tmp_path)
    check_shape(result, "rain_models")
    rows = {row["name"]: row for row in result["rows"]}
    assert set(rows) == {"ours", "rousseau", "tariq"}
    # The counts of the paper's table, at a tenth: ours draws the fewest drops.
    assert rows["rousseau"]["drops"] == 9_000 and rows["tariq"]["drops"] == 19_500
    assert 0 < rows["ours"]["drops"] < rows["rousseau"]["drops"]
    shares = [row["covered"] for row in rows.values()]
    assert all(0.005 < share < 0.5 for share in shares)
    assert all(0.01 < row["strength"] < 0.5 for row in rows.values())
    ratios = result["ratios"]
    assert set(ratios) == {"vs_tariq", "vs_rousseau", "covered_spread", "strength_spread"}
    assert 0.0 <= ratios["covered_spread"] <= 0.05
    assert ratios["covered_spread"] == pytest.approx(max(shares) / min(shares) - 1.0, abs=1e-4)
    assert ratios["strength_spread"] <= 0.15
    assert ratios["vs_tariq"] > 0.0 and ratios["vs_rousseau"] > 0.0


def test_scaling_covers_drops_areas_observers_and_occluders(tmp_path: Path) -> None:
    result = report("scaling", tmp_path)
    check_shape(result, "scaling")
    groups = {row["group"] for row in result["rows"]}
    assert groups == {"drops", "areas", "observers", "occluders", "python"}
    rows = {row["name"]: row for row in result["rows"]}
    assert rows["areas_4_in_view"]["containers"] == 4
    assert rows["areas_4_behind"]["containers"] == 1  # what is out of view is not drawn
    assert rows["medium_feedback"]["backend"] == "feedback"
    ratios = result["ratios"]
    assert {
        "python_ms_medium",
        "python_ultra_over_low",
        "python_ms_per_area_behind",
        "invisible_area_cost",
        "observers_2_over_base",
        "areas_4_behind_over_base",
        "occluders_100_over_base",
    } <= set(ratios)
    assert ratios["python_ms_medium"] == pytest.approx(rows["python_medium"]["ms"], rel=1e-3)
    if rows["python_low"]["driver"] == "NOOP":  # nothing but Python: no work on any drop
        assert 0.3 < ratios["python_ultra_over_low"] < 3.0


def test_server_measures_whole_worlds_without_opengl(tmp_path: Path) -> None:
    result = report("server", tmp_path)
    assert result["benchmark"] == "server" and result["renderer"] == "none"
    rows = {row["name"]: row for row in result["rows"]}
    assert set(rows) == {"whole", "areas_still", "clouds_alone", "worlds_3"}
    assert (rows["whole"]["clouds"], rows["whole"]["areas"]) == (1000, 20)
    assert rows["worlds_3"]["worlds"] == 3
    ratios = result["ratios"]
    assert ratios["times_real_time"] == pytest.approx(1e3 / rows["whole"]["ms"], rel=1e-4)
    assert ratios["times_real_time"] > 0.0 and ratios["moving_over_still"] > 0.0
    assert 2_000 < ratios["snapshot_bytes"] < 200_000
    assert rows["clouds_alone"]["snapshot_bytes"] < rows["whole"]["snapshot_bytes"]


@pytest.mark.parametrize("kind", [RousseauRain, TariqRain])
def test_box_rain_falls_and_stays_in_its_box(
    stage: Stage, keep: Keep, kind: Callable[..., BoxRain]
) -> None:
    rain = keep(kind(stage, 2000, 25.0))
    first = rain.positions()
    rain.move(0.1)
    fallen = first[:, 1] - rain.positions()[:, 1]
    stayed = fallen > 0.0  # the others came in again at the top
    assert stayed.mean() > 0.9
    assert np.all((fallen[stayed] > 0.15) & (fallen[stayed] < 1.0))  # 1.5 to 10 m/s
    assert np.allclose(fallen[~stayed] + rain.box[1], fallen[~stayed] % rain.box[1], atol=1e-3)
    for _ in range(50):
        rain.move(0.2)
    inside = (rain.positions() - rain.low) / rain.box
    assert inside.min() >= -1e-5 and inside.max() <= 1.0 + 1e-5
    assert np.abs(np.histogram(inside[:, 1], 4, (0.0, 1.0))[0] / 500.0 - 1.0).max() < 0.2
    rain.rewind()
    assert np.array_equal(rain.positions(), first)


def drawn(stage: Stage, model: Model) -> float:
    stage.begin()
    model.draw()
    return stage.look().covered


@pytest.mark.parametrize("kind", [RousseauRain, TariqRain])
def test_larger_streaks_cover_more(stage: Stage, keep: Keep, kind: Callable[..., BoxRain]) -> None:
    rain = keep(kind(stage, 4000, 25.0))
    shares = []
    for size in (1.0, 2.0, 4.0):
        rain.size = size
        shares.append(drawn(stage, rain))
    assert 0.0 < shares[0] < shares[1] < shares[2] < 1.0


def test_a_lamp_lights_tariqs_streaks(stage: Stage, keep: Keep) -> None:
    dark = keep(TariqRain(stage, 4000, 25.0))
    lit = keep(TariqRain(stage, 4000, 25.0, lamp=(0.0, 3.0, -4.0)))
    pictures = []
    for rain in (dark, lit):
        rain.size, rain.opacity = 4.0, 0.2
        stage.begin()
        rain.draw()
        pictures.append(stage.picture().astype(int))
    more = pictures[1] - pictures[0]
    assert more[..., 0].sum() > 0 and more[..., 0].sum() > more[..., 2].sum()  # a warm light


def test_our_rain_leaves_the_current_world_alone(stage: Stage, keep: Keep) -> None:
    import esper

    before, worlds = esper.current_world, set(esper.list_worlds())
    rain = OurRain(stage, 25.0, quality="low")
    assert rain.drops > 1000 and drawn(stage, rain) > 0.0
    assert esper.current_world == before
    rain.release()
    assert set(esper.list_worlds()) == worlds


def test_a_plain_picture_is_not_covered(stage: Stage) -> None:
    stage.begin()
    assert stage.look().covered == 0.0
    assert np.allclose(stage.picture() / 255.0, BACKGROUND, atol=0.5 / 255.0 + 1e-6)


def test_refraction_mask_turns_the_picture_upside_down() -> None:
    mask = refraction_mask(64).astype(float) / 255.0 - 0.5
    assert mask[60, 32, 1] < -0.2 and mask[3, 32, 1] > 0.2  # above looks down, below looks up
    assert abs(mask[32, 32, 0]) < 0.02 and abs(mask[32, 32, 1]) < 0.02
    assert mask[0, 0, 3] == -0.5 and mask[32, 32, 3] == 0.5  # round


def test_library_has_an_appearance_for_every_light() -> None:
    layers = library()
    assert len(layers) == ELEVATIONS * AZIMUTHS * KINDS
    assert all(layer.max() > 100 and layer[0].max() < 60 for layer in layers)
    assert len({layer.tobytes() for layer in layers}) > ELEVATIONS * AZIMUTHS


def test_spread() -> None:
    assert spread([0.10, 0.11, 0.105]) == pytest.approx(0.1)
