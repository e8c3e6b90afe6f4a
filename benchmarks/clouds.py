"""Skies of 100, 200 and 1000 clouds with the climate running: frames per second.

The counts of Torchelsen (2005), chapter 5, whose program drew 30, 20 and 10 frames per second of
them on a GeForce 6800 Ultra. A frame is a clear, `esper.process` and `Weather.draw` at 1280x720, at
medium quality, clouds drifting and the climate going from one sky to another. No background is
painted: that is the game's.

Rows: `clouds` in the sky, of them `drawn`; `start_s` until the first picture was there, skies
generated and lit; `cfa_ms`, what the absorption factor of one cloud adds to a frame's CPU time, a
median over pairs of frames with and without it.
Ratios: `fps_N`, and `cfa_ms_per_frame`, the greatest of the rows.
"""

from __future__ import annotations

import statistics
from time import perf_counter
from typing import Any

from benchmarks.harness import Case, Result, measure, renderer_name
from benchmarks.models.cloud_sky import CloudSky
from benchmarks.models.stage import Stage, create_context

DT = 1.0 / 30.0  # s
# Clouds, metres on a side of their square, different ones of each model.
SKIES = ((100, 16_000.0, 10), (200, 20_000.0, 10), (1000, 36_000.0, 10))
SETTLE = 90  # frames before the measurement: the first pictures of all clouds in view are taken


def run(quick: bool) -> Result:
    ctx = create_context()
    stage = Stage(ctx, (320, 180) if quick else (1280, 720))
    skies: list[CloudSky] = []
    rows: list[dict[str, Any]] = []
    try:
        cases, starts = [], {}
        for count, side, generated in SKIES:
            start = perf_counter()
            sky = CloudSky(stage, f"clouds_{count}", count, side, generated, "medium")
            skies.append(sky)
            play(stage, sky)
            ctx.finish()
            starts[sky.name] = perf_counter() - start
            cases.append(Case(sky.name, lambda sky=sky: play(stage, sky)))  # type: ignore[misc]
            for _ in range(5 if quick else SETTLE):
                play(stage, sky)
        rounds, sample = (2, 0.02) if quick else (15, 0.2)
        timings = measure(cases, finish=ctx.finish, rounds=rounds, sample_seconds=sample)
        cfa = {sky.name: cfa_ms(stage, sky, 2 if quick else 40) for sky in skies}
        for sky, case in zip(skies, cases, strict=True):
            facts = {
                "clouds": sky.weather.stats.clouds,
                "drawn": sky.weather.stats.clouds_drawn,
                "start_s": starts[sky.name],
                "cfa_ms": cfa[sky.name],
            }
            rows.append({**timings.row(case), **facts})
        if ctx.error != "GL_NO_ERROR":
            raise RuntimeError(f"OpenGL error: {ctx.error}")
        renderer = renderer_name(ctx)
    finally:
        for sky in skies:
            sky.release()
        stage.release()
        ctx.release()
    ratios = {f"fps_{row['clouds']}": row["fps"] for row in rows}
    return Result("clouds", renderer, rows, ratios | {"cfa_ms_per_frame": max(cfa.values())})


def play(stage: Stage, sky: CloudSky) -> None:
    """One frame."""
    stage.begin()
    sky.move(DT)
    sky.draw()


def cfa_ms(stage: Stage, sky: CloudSky, pairs: int) -> float:
    """CPU milliseconds that computing one absorption factor adds to a frame's `esper.process`."""
    differences = []
    for _ in range(pairs):
        # Whatever still waits for its light first.
        for _ in range(2000):
            sky.move(0.0)
            if not sky.weather.stats.cfa_computed:
                break
        without = sky.process_ms(0.0)
        sky.turn_sun()
        sky.move(0.0)  # the light is another: the frame itself is made anew
        differences.append(sky.process_ms(0.0) - without)
        if not sky.weather.stats.cfa_computed:
            raise RuntimeError("no absorption factor was computed")
    return max(statistics.median(differences), 0.0)
