"""Frame time of the rain against drops, areas, observers and occluders, on both backends.

A frame is a clear, `esper.process` and `Weather.draw` at 1280x720, veil included. Every group
shares a base case, one area of heavy rain all about the observer at medium quality, and is measured
in turns with it. The cost in Python is measured apart, see `models/python_cost.py`: rows of the
group `python`, in CPU milliseconds of the calling thread.

Ratios: NAME_over_BASE are frame times; `invisible_area_cost` is what one area out of view adds to a
frame, as a share of it, from the Python times (timing a frame to 1 % would drown in noise);
`python_*` are milliseconds of Python or ratios of these.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import moderngl

from benchmarks.harness import Case, Result, Timings, measure, renderer_name
from benchmarks.models.ours import OurRain
from benchmarks.models.python_cost import measure_apart
from benchmarks.models.stage import Stage, create_context
from benchmarks.models.surroundings import areas_behind, areas_in_view, houses, observers
from weather_ecs.presets import PRESETS

RAIN_RATE = PRESETS["heavy"].rain_rate
DT = 1.0 / 60.0  # s
BASE = "base"

Made = Mapping[str, Any]  # arguments of OurRain
Ratios = dict[str, float]


def groups(ctx: moderngl.Context, quick: bool) -> dict[str, dict[str, Made]]:
    """Cases by group and name; each group has a case BASE, which the others are compared with."""
    backends = ["feedback"] + (["compute"] if ctx.version_code >= 430 else [])
    qualities = ("medium",) if quick else ("low", "medium", "high", "ultra")
    drops: dict[str, Made] = {
        f"{q}_{b}": {"quality": q, "backend": b} for q in qualities for b in backends
    }
    behind, ahead = ((3,), (3,)) if quick else ((3, 15, 63), (3, 15))
    areas: dict[str, Made] = {f"areas_{n + 1}_behind": {"others": areas_behind(n)} for n in behind}
    areas |= {f"areas_{n + 1}_in_view": {"others": areas_in_view(n)} for n in ahead}
    seen_by, on = ((2,), (100,)) if quick else ((2, 4), (100, 1000))
    drawn: dict[str, Made] = {f"observers_{n}": {"others": observers(n)} for n in seen_by}
    hit: dict[str, Made] = {f"occluders_{n}": {"others": houses(n)} for n in on}
    named = {"drops": drops, "areas": areas, "observers": drawn, "occluders": hit}
    base: dict[str, Made] = {BASE: {}}
    return {group: base | cases for group, cases in named.items()}


def run(quick: bool) -> Result:
    ctx = create_context()
    stage = Stage(ctx, (320, 180) if quick else (1280, 720))
    rows: list[dict[str, Any]] = []
    ratios: Ratios = {}
    try:
        for group, cases in groups(ctx, quick).items():
            timings, found = run_group(ctx, stage, group, cases, rounds=3 if quick else 9)
            rows += found
            ratios |= group_ratios(group, cases, timings)
        base_ms = rows[0]["ms"]
        renderer = renderer_name(ctx)
        if ctx.error != "GL_NO_ERROR":
            raise RuntimeError(f"OpenGL error: {ctx.error}")
    finally:
        stage.release()
        ctx.release()
    python = measure_apart(quick)
    rows += python_rows(python)
    ratios |= python_ratios(python["ms"], base_ms)
    return Result("scaling", renderer, rows, ratios)


def run_group(
    ctx: moderngl.Context, stage: Stage, group: str, cases: Mapping[str, Made], rounds: int
) -> tuple[Timings, list[dict[str, Any]]]:
    """Measure the cases of a group in turns; their rows."""
    models: list[OurRain] = []

    def case(name: str, made: Made) -> Case:
        model = OurRain(stage, RAIN_RATE, veil=True, **({"quality": "medium"} | dict(made)))
        models.append(model)

        def frame() -> None:
            stage.begin()
            model.move(DT)
            model.draw()

        stats = model.weather.stats
        facts = {
            "group": group,
            "drops": model.drops,
            "containers": stats.containers,
            "backend": stats.backend,
        }
        return Case(name, frame, facts)

    try:
        listed = [case(name, made) for name, made in cases.items()]
        timings = measure(listed, finish=ctx.finish, rounds=rounds)
        return timings, [timings.row(case) for case in listed]
    finally:
        for model in models:
            model.release()


def group_ratios(group: str, cases: Mapping[str, Made], timings: Timings) -> Ratios:
    """How many times the base's frame time the others take; backends against each other."""
    names: Sequence[str] = [name for name in cases if name != BASE]
    if group != "drops":
        return {f"{name}_over_base": timings.ratio(name, BASE) for name in names}
    found: Ratios = {}
    for name in names:
        quality, _, backend = name.partition("_")
        medium = f"medium_{backend}"
        if quality != "medium":
            found[f"{name}_over_medium"] = timings.ratio(name, medium)
        if backend == "feedback" and f"{quality}_compute" in names:
            found[f"compute_over_feedback_{quality}"] = timings.ratio(f"{quality}_compute", name)
    return found


def python_rows(python: Mapping[str, Any]) -> list[dict[str, Any]]:
    return [
        {
            "name": f"python_{name}",
            "group": "python",
            "driver": python["driver"],
            "ms": moving + drawing,
            "process_ms": moving,
            "draw_ms": drawing,
        }
        for name, (moving, drawing) in python["ms"].items()
    ]


def python_ratios(parts: Mapping[str, Sequence[float]], base_ms: float) -> Ratios:
    """Milliseconds of Python, and what things out of view add as shares of the base's frame."""
    ms = {name: sum(both) for name, both in parts.items()}
    return {
        "python_ms_medium": ms["medium"],
        "python_ultra_over_low": ms["ultra"] / ms["low"],
        "python_ms_per_area_in_view": (ms["15_areas_in_view"] - ms["medium"]) / 15.0,
        "python_ms_per_area_behind": (ms["63_areas_behind"] - ms["medium"]) / 63.0,
        "python_ms_per_observer": (ms["4_observers"] - ms["medium"]) / 3.0,
        "python_ms_1000_occluders": ms["1000_occluders"] - ms["medium"],
        "invisible_area_cost": (ms["63_areas_behind"] - ms["medium"]) / 63.0 / base_ms,
        "invisible_63_areas_cost": (ms["63_areas_behind"] - ms["medium"]) / base_ms,
    }
