"""Three models of heavy rain at the same look (seed 000, Table 1): frames per second.

After Puig-Centelles, Ripollés and Chover (2008): Rousseau-style with 90 000 drops and Tariq-style
with 195 000, both even in a box about the observer, and ours with 50 000 in its container. Drops
alone, over a plain background; a frame is a clear, a move and a draw. The rivals' streaks are
calibrated to ours first: their size by bisection until the same share of the pixels is covered,
their opacity until covered pixels are changed as strongly. A covered pixel is one that the drops
change by more than 3/255.

`python -m benchmarks.rain_models FOLDER` writes the three calibrated pictures (needs Pillow).
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import moderngl

from benchmarks.harness import Case, Result, measure, renderer_name
from benchmarks.models.model import Model, Rival
from benchmarks.models.ours import OurRain
from benchmarks.models.rousseau import RousseauRain
from benchmarks.models.stage import Look, Stage, create_context
from benchmarks.models.tariq import TariqRain
from weather_ecs.presets import PRESETS

RAIN_RATE = PRESETS["heavy"].rain_rate
DT = 1.0 / 60.0  # s
APART = 0.1  # s between the pictures that a look is averaged over
SIZES = (0.05, 40.0)  # bracket of the first bisection
# Where the bisections end, as a ratio: opacity moves the share a little, and size the strength.
FINENESS = (1.1, 1.03, 1.004)


def look(stage: Stage, model: Model, moments: int) -> Look:
    """Mean over some moments to come."""
    found = []
    for _ in range(moments):
        model.move(APART)
        stage.begin()
        model.draw()
        found.append(stage.look())
    covered = sum(one.covered for one in found) / moments
    return Look(covered, sum(one.strength for one in found) / moments)


def calibrate(stage: Stage, rival: Rival, wanted: Look, moments: int) -> Look:
    """Turn size and opacity until the rival looks as wanted; the looks it ends with.

    Every picture is taken at the same moments of its rain, so that the share grows with the size
    and chance plays no part.
    """

    def now() -> Look:
        rival.rewind()
        return look(stage, rival, moments)

    low, high = SIZES
    for fineness in FINENESS:
        while high / low > fineness:
            rival.size = math.sqrt(low * high)
            if now().covered < wanted.covered:
                low = rival.size
            else:
                high = rival.size
        low, high = rival.size / 1.5, rival.size * 1.5
        if fineness != FINENESS[-1]:
            stronger = wanted.strength / max(now().strength, 1e-6)
            rival.opacity = min(max(rival.opacity * stronger, 0.01), 1.0)
    return now()


@dataclass
class Comparison:
    """Ours, and rivals that have been made to look like it."""

    ctx: moderngl.Context
    stage: Stage
    models: list[tuple[Model, Look, dict[str, float]]]  # and what the calibration turned


@contextmanager
def comparison(quick: bool) -> Iterator[Comparison]:
    """Make and calibrate the three models; `quick`: a tenth of the drops in a small picture."""
    ctx = create_context()
    with ExitStack() as stack:
        stack.callback(ctx.release)
        stage = Stage(ctx, (320, 180) if quick else (1280, 720))
        stack.callback(stage.release)
        ours = OurRain(stage, RAIN_RATE, quality="low" if quick else "high")
        stack.callback(ours.release)
        moments = 8 if quick else 4
        wanted = look(stage, ours, moments)
        models: list[tuple[Model, Look, dict[str, float]]] = [(ours, wanted, {})]
        for kind, drops in ((RousseauRain, 90_000), (TariqRain, 195_000)):
            rival = kind(stage, drops // 10 if quick else drops, RAIN_RATE)
            stack.callback(rival.release)
            found = calibrate(stage, rival, wanted, moments)
            models.append((rival, found, {"size": rival.size, "opacity": rival.opacity}))
        yield Comparison(ctx, stage, models)


def run(quick: bool) -> Result:
    with comparison(quick) as compared:
        return compare(compared, rounds=3 if quick else 15)


def compare(compared: Comparison, rounds: int) -> Result:
    ctx, stage = compared.ctx, compared.stage

    def case(model: Model, found: Look, turned: dict[str, float]) -> Case:
        def frame() -> None:
            stage.begin()
            model.move(DT)
            model.draw()

        facts = {
            "drops": model.drops,
            "covered": found.covered,
            "strength": found.strength,
            **turned,
        }
        return Case(model.name, frame, facts)

    cases = [case(*entry) for entry in compared.models]
    timings = measure(cases, finish=ctx.finish, rounds=rounds)
    if ctx.error != "GL_NO_ERROR":
        raise RuntimeError(f"OpenGL error: {ctx.error}")
    return Result(
        benchmark="rain_models",
        renderer=renderer_name(ctx),
        rows=[timings.row(case) for case in cases],
        ratios={
            "vs_tariq": timings.ratio("tariq", "ours"),
            "vs_rousseau": timings.ratio("rousseau", "ours"),
            "covered_spread": spread([found.covered for _, found, _ in compared.models]),
            "strength_spread": spread([found.strength for _, found, _ in compared.models]),
        },
    )


def spread(values: list[float]) -> float:
    return max(values) / min(values) - 1.0


def save_pictures(folder: Path) -> None:
    """One PNG of each model, as they are compared."""
    from PIL import Image

    folder.mkdir(parents=True, exist_ok=True)
    with comparison(quick=False) as compared:
        for model, _, _ in compared.models:
            compared.stage.begin()
            model.draw()
            Image.fromarray(compared.stage.picture()).save(folder / f"{model.name}.png")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python -m benchmarks.rain_models FOLDER")
    save_pictures(Path(sys.argv[1]))
