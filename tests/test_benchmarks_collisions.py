"""The benchmark of collisions in its quick mode: what it measures, not how fast it was."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest

from benchmarks.collisions import COUNTS, PAPER, Work, frame_ratios
from benchmarks.harness import Timings
from benchmarks.models.scene import HUT, Scene, ground, hut, steps
from benchmarks.models.stage import Stage
from benchmarks.models.struck import StruckRain, case_name
from tests.benchmark_reports import check_shape, report

Keep = Callable[[Any], Any]


@pytest.fixture
def stage(ctx: moderngl.Context, keep: Keep) -> Stage:
    return keep(Stage(ctx, (320, 180)))


@pytest.fixture
def scene(stage: Stage, keep: Keep) -> Scene:
    return keep(Scene(stage))


def test_collisions_compares_with_without_and_the_backends(tmp_path: Path) -> None:
    result = report("collisions", tmp_path)
    check_shape(result, "collisions")
    rows = {row["name"]: row for row in result["rows"]}
    for drops in (20_000, 40_000, 80_000, 160_000):
        for backend in ("compute", "feedback"):
            struck, free = (rows[case_name(drops, backend, w)] for w in (True, False))
            assert (struck["drops"], free["drops"]) == (drops, drops)
            assert (struck["backend"], struck["collisions"]) == (backend, True)
            assert free["impacts"] == 0
            # What lies on the ground is drawn no longer.
            assert 0 < struck["drawn"] < free["drawn"] < drops
        # A drop falls some 20 m at 5 m/s or so, and a frame lasts a sixtieth of a second.
        assert 0.001 < rows[case_name(drops, "compute", True)]["impacts"] / drops < 0.01
    ratios = result["ratios"]
    assert {
        "collision_share",
        "compute_over_feedback",
        "collision_share_work",
        "compute_over_feedback_work",
        "cpu_4m_over_05m",
        "cpu_ms_4m",
    } <= set(ratios)
    assert ratios["collision_share"] >= ratios["collision_share_mean"]
    assert 0.0 < ratios["compute_over_feedback"] <= ratios["compute_over_feedback_mean"]
    cpu = rows["cpu_160000_compute_with"]
    assert ratios["cpu_ms_4m"] == pytest.approx(cpu["ms"], rel=1e-3)
    assert cpu["ms"] == pytest.approx(cpu["process_ms"] + cpu["draw_ms"], rel=1e-3)
    if cpu["driver"] == "NOOP":  # nothing but Python: no work on any drop
        assert 0.4 < ratios["cpu_4m_over_05m"] < 2.5


def test_the_worst_count_is_what_counts() -> None:
    seconds = {}
    for n, added, slower in zip(COUNTS, (0.1, 0.3, 0.2, 0.0), (1.5, 2.0, 1.2, 1.4), strict=True):
        seconds[case_name(n, "compute", False)] = [1.0, 2.0, 1.0]
        seconds[case_name(n, "compute", True)] = [1.0 + added, 2.0 * (1.0 + added), 9.0]
        seconds[case_name(n, "feedback", False)] = [slower, 2.0 * slower, slower]
        seconds[case_name(n, "feedback", True)] = [slower, 2.0 * slower, 9.0 * slower]
    ratios = frame_ratios(Timings(seconds, {}), COUNTS, ("compute", "feedback"))
    assert ratios["collision_share"] == pytest.approx(0.3)
    assert ratios["collision_share_mean"] == pytest.approx(0.15)
    assert ratios["collision_share_2000000"] == pytest.approx(0.2)
    assert ratios["compute_over_feedback"] == pytest.approx(1.2)
    assert ratios["compute_over_feedback_500000"] == pytest.approx(1.5)


def test_work_is_counted_by_frame(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    monkeypatch.setattr("benchmarks.collisions.process_time", lambda: now[0])
    work = Work(lambda: None)
    for name, frames, seconds in (("a", 1, 9.0), ("a", 2, 1.0), ("b", 1, 3.0), ("a", 2, 2.0)):
        now[0] += 100.0  # what comes between two samples counts for nothing
        work.before(name)
        work.finish()
        for _ in range(frames):
            work.frame()
            now[0] += seconds
        work.finish()
    assert work.seconds == {"a": [9.0, 1.0, 2.0], "b": [3.0]}
    kept = work.timings(Timings({"a": [0.5, 0.5], "b": [0.5]}, {}))
    assert kept.seconds == {"a": [1.0, 2.0], "b": [3.0]}  # the first of a's was not timed


def test_the_papers_collisions_cost_fifteen_percent() -> None:
    both = PAPER["compute", True], PAPER["compute", False]
    share = [both[1][n] / both[0][n] - 1.0 for n in COUNTS]
    assert np.mean(share) == pytest.approx(0.15, abs=0.005)


@pytest.mark.parametrize("mesh", [ground(), hut(), steps()])
def test_meshes_are_sound(mesh: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, indices = mesh
    assert indices.max() == len(vertices) - 1 and len(indices) % 3 == 0
    a, b, c = (vertices[indices[k::3]] for k in range(3))
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).min() > 1e-4  # no empty triangle


def test_scene_hides_what_is_behind_it_and_moves(stage: Stage, scene: Scene) -> None:
    pictures = []
    for time in (0.0, 2.0):
        stage.begin()
        scene.draw(scene.place(time))
        pictures.append(stage.picture().astype(int))
        share = stage.look().covered
        assert 0.4 < share < 0.9  # the ground, the hut and the steps; sky above
    changed = np.abs(pictures[0] - pictures[1]).max(axis=2) > 5
    assert 0.005 < changed.mean() < 0.3
    turn = scene.place(2.0)[:3, :3]
    assert np.allclose(turn @ turn.T, np.eye(3)) and np.linalg.det(turn) == pytest.approx(1.0)


@pytest.mark.parametrize("backend", ["compute", "feedback"])
def test_rain_meets_the_scene(stage: Stage, scene: Scene, keep: Keep, backend: str) -> None:
    rain = keep(StruckRain(stage, scene, 30_000, backend=backend, collisions=True))
    stats = rain.rain.weather.stats
    assert (rain.drops, stats.backend, stats.quality) == (30_000, backend, "30000 drops")
    for _ in range(30):
        stage.begin()
        rain.move(1.0 / 60.0)
        rain.draw_scene()
        rain.draw()
    assert stats.impacts > 10 and stats.splashes > 10
    weather = rain.rain.weather
    x, z = HUT
    assert weather.sample((x, 1.0, z)).sheltered and not weather.sample((8.0, 1.0, -5.0)).sheltered
    moving = scene.place(30.0 / 60.0)[:3, 3]
    assert weather.sample((moving[0], 0.5, moving[2])).sheltered
