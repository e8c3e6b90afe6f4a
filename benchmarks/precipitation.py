"""Rain and snow held at a frame rate, beside the table of Liu and Tong (seed 003, Table 1).

They drew 150, 500 and 1000 drops, as light, moderate and heavy rain, at 91, 78 and 56 frames a
second with textured quads and at 32, 21 and 10 with spheres, on an Athlon 64 X2 of 2.5 GHz. Ours:
the presets of the same names with the drops of the quality `high`, what is held at 56 and at
60 frames a second in heavy rain and in heavy snow, and what turbulence and fog cost. Precipitation
alone over a plain background; a frame is a clear, a move and a draw.

Ratios: `drops_at_56fps` in heavy rain at 1280x720, which is the bar; `times_the_papers` over the
1000 of the paper; `drops_at_60fps`, `flakes_at_60fps` and the like, with `_640` at 640x360;
`snow_over_rain` (and with `_feedback`, by that backend) and `turbulence_share` at the same number,
per particle and as a share of the frame; `fog_ms` of a fog over the whole picture. The two sides
of each of these take turns every few frames, with nothing else between them, and the median over
the turns counts: a machine whose speed drifts within seconds slows both alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import moderngl

from benchmarks.harness import Case, Result, Timings, measure, renderer_name
from benchmarks.models.held import crossing, first_look, frame_of, ladder
from benchmarks.models.ours import OurRain
from benchmarks.models.stage import Stage, create_context
from weather_ecs import QualitySettings
from weather_ecs.components import Air, Fog, Observer, Wind
from weather_ecs.presets import PRESETS

# Preset: drops, frames a second with textured quads and with spheres.
PAPER = {"light": (150, 91, 32), "moderate": (500, 78, 21), "heavy": (1000, 56, 10)}
SIZES = ((1280, 720), (640, 360))
COLD = Air(temperature=-5.0, humidity=0.9)
SNOW_RATE = PRESETS["heavy_snow"].rain_rate
EQUAL = 50_000  # particles, where kinds and winds are compared
HIGH = 50_000  # drops of the quality `high`
OFTEN = 3  # times more rounds for what is compared two by two


def run(quick: bool) -> Result:
    ctx = create_context()
    sizes = ((320, 180),) if quick else SIZES
    share = 10 if quick else 1
    rounds = 3 if quick else 9
    rows: list[dict[str, Any]] = papers_rows()
    ratios: dict[str, float] = {}
    try:
        for size in sizes:
            stage = Stage(ctx, size)
            small = "" if size == sizes[0] else "_640"
            try:
                rows += preset_rows(stage, small, HIGH // share, rounds)
                found, held = held_rows(stage, small, quick, rounds)
                rows += found
                ratios |= held
                if not small:
                    more, costs = cost_rows(stage, EQUAL // share, rounds)
                    rows += more
                    ratios |= costs
            finally:
                stage.release()
        ratios["times_the_papers"] = ratios["drops_at_56fps"] / PAPER["heavy"][0]
        renderer = renderer_name(ctx)
        if ctx.error != "GL_NO_ERROR":
            raise RuntimeError(f"OpenGL error: {ctx.error}")
    finally:
        ctx.release()
    return Result("precipitation", renderer, rows, ratios)


def papers_rows() -> list[dict[str, Any]]:
    """Liu and Tong's own table."""
    return [
        {"name": f"paper_{preset}_{how}", "drops": drops, "ms": 1e3 / fps, "fps": float(fps)}
        for preset, (drops, *rates) in PAPER.items()
        for how, fps in zip(("textured", "spheres"), rates, strict=True)
    ]


def own(drops: int) -> QualitySettings:
    """A quality of so many drops, all of them for the one area that there is."""
    return QualitySettings("held", drops, 1, 512, True)


def rain(stage: Stage, drops: int, others: Sequence[object] = (), backend: str = "auto") -> OurRain:
    """Heavy rain of so many drops."""
    rate = PRESETS["heavy"].rain_rate
    return OurRain(stage, rate, quality=own(drops), backend=backend, others=others)


def snow(stage: Stage, drops: int, backend: str = "auto") -> OurRain:
    """Heavy snow of so many flakes."""
    return OurRain(stage, SNOW_RATE, quality=own(drops), backend=backend, others=[COLD])


def preset_rows(stage: Stage, small: str, drops: int, rounds: int) -> list[dict[str, Any]]:
    """The presets that have the names of the paper's rains."""
    models = {
        f"{preset}{small}": OurRain(stage, PRESETS[preset].rain_rate, quality=own(drops))
        for preset in PAPER
    }
    return in_turns(stage, models, rounds)[1]


def held_rows(
    stage: Stage, small: str, quick: bool, rounds: int
) -> tuple[list[dict[str, Any]], dict[str, float]]:
    """Drops and flakes held at the paper's frame rate in heavy rain, and at 60."""
    rows: list[dict[str, Any]] = []
    ratios = {}
    begin, most = (500, 4_000) if quick else (10_000, 8_000_000)
    for kind, make in (("drops", rain), ("flakes", snow)):
        middle = first_look(stage, partial(make, stage), 1e3 / PAPER["heavy"][1], begin, most)
        numbers = ladder(middle, most)
        models = {f"{kind}_{n}{small}": make(stage, n) for n in numbers}
        timings, found = in_turns(stage, models, rounds)
        rows += found
        ms = [timings.ms(name) for name in models]
        for fps in (PAPER["heavy"][1], 60):
            ratios[f"{kind}_at_{fps}fps{small}"] = float(round(crossing(numbers, ms, 1e3 / fps)))
    return rows, ratios


def cost_rows(
    stage: Stage, drops: int, rounds: int
) -> tuple[list[dict[str, Any]], dict[str, float]]:
    """The same number of drops, of flakes, and of drops in turbulent air; fog and nothing else.

    Fog once and twice: a picture that is only cleared is a bad measure for one that is drawn, as
    drivers leave out a clear that nothing was drawn upon.
    """
    still, rough = Wind((1.0, 0.0), 8.0), Wind((1.0, 0.0), 8.0, turbulence=0.25)
    fog, twice = (
        partial(OurRain, stage, 0.0, quality=own(drops), others=(Fog(200.0, draw=True), *eyes))
        for eyes in ([Observer()], [Observer(), Observer()])
    )
    pairs = (
        {"rain": partial(rain, stage, drops), "snow": partial(snow, stage, drops)},
        {
            "rain_feedback": partial(rain, stage, drops, backend="feedback"),
            "snow_feedback": partial(snow, stage, drops, backend="feedback"),
        },
        {
            "wind": partial(rain, stage, drops, [still]),
            "turbulence": partial(rain, stage, drops, [rough]),
        },
        {"fog": fog, "fog_twice": twice},
    )
    rows: list[dict[str, Any]] = []
    ratio, added = [], []
    for pair in pairs:
        models = {name: make() for name, make in pair.items()}
        plain, other = models
        timings, found = in_turns(stage, models, OFTEN * rounds, alike=True)
        rows += found
        per_particle = models[plain].drops / max(models[other].drops, 1)
        ratio.append(timings.ratio(other, plain) * per_particle)
        added.append(timings.added_ms(other, plain))
    return rows, {
        "snow_over_rain": ratio[0],
        "snow_over_rain_feedback": ratio[1],
        "turbulence_share": ratio[2] - 1.0,
        "fog_ms": added[3],
    }


def in_turns(
    stage: Stage, models: dict[str, OurRain], rounds: int, alike: bool = False
) -> tuple[Timings, list[dict[str, Any]]]:
    """Measure models in turns; gives them back."""
    ctx: moderngl.Context = stage.ctx
    size = "x".join(map(str, stage.size))
    try:
        cases = [
            Case(name, frame_of(stage, model), {"drops": model.drops, "size": size})
            for name, model in models.items()
        ]
        timings = measure(cases, finish=ctx.finish, rounds=rounds, alike=alike)
        return timings, [timings.row(case) for case in cases]
    finally:
        for model in models.values():
            model.release()
