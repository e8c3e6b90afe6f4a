"""What one frame costs in Python: `python -m benchmarks.models.python_cost [--quick]`, JSON out.

CPU milliseconds of the calling thread in `esper.process` and `Weather.draw`, median over frames, by
case. A process of its own, because Mesa can be told beforehand to do nothing (GALLIUM_NOOP): a
software renderer would otherwise move and draw drops in that same thread. Where that is not to be
had, the driver's part is in the figures.
"""

from __future__ import annotations

import gc
import json
import os
import random
import statistics
import subprocess
import sys
from collections.abc import Mapping
from time import thread_time
from typing import Any

from benchmarks.models.model import Model
from benchmarks.models.ours import OurRain
from benchmarks.models.stage import Stage, create_context
from benchmarks.models.surroundings import areas_behind, areas_in_view, houses, observers
from weather_ecs.presets import PRESETS

RAIN_RATE = PRESETS["heavy"].rain_rate
DT = 1.0 / 60.0  # s
WARM_UP = 5  # frames

Cases = dict[str, dict[str, Any]]


def cases(quick: bool) -> Cases:
    """What OurRain is made of, by name; the areas, observers and occluders at medium quality."""
    qualities = ("low", "medium", "ultra") if quick else ("low", "medium", "high", "ultra")
    found: Cases = {q: {"quality": q} for q in qualities}
    behind, ahead = ((63,), (15,)) if quick else ((1, 15, 63), (3, 15))
    drawn, hit = ((4,), (1000,)) if quick else ((2, 4), (100, 1000))
    found |= {f"{n}_areas_behind": {"others": areas_behind(n)} for n in behind}
    found |= {f"{n}_areas_in_view": {"others": areas_in_view(n)} for n in ahead}
    found |= {f"{n}_observers": {"others": observers(n)} for n in drawn}
    found |= {f"{n}_occluders": {"others": houses(n)} for n in hit}
    return found


def measure_here(quick: bool) -> dict[str, Any]:
    """{"driver": name, "ms": {case: [process, draw]}} in this process; the cases take turns."""
    ctx = create_context()
    stage = Stage(ctx, (16, 9))
    models = {
        name: OurRain(stage, RAIN_RATE, veil=True, **({"quality": "medium"} | made_of))
        for name, made_of in cases(quick).items()
    }
    ms = time_in_turns(stage, models, 15 if quick else 150)
    for model in models.values():
        model.release()
    stage.release()
    driver = str(ctx.info["GL_RENDERER"])
    ctx.release()
    return {"driver": driver, "ms": ms}


def time_in_turns(stage: Stage, models: Mapping[str, Model], turns: int) -> dict[str, list[float]]:
    """Median CPU milliseconds of `move` and of `draw` in this thread, by model."""
    times: dict[str, list[tuple[float, float]]] = {name: [] for name in models}
    rng = random.Random(1)
    gc.disable()
    for turn in range(WARM_UP + turns):
        # In a new order every time: whoever comes first, or after a large case, is slower.
        for name in rng.sample(list(models), len(models)):
            model = models[name]
            stage.begin()
            stage.ctx.finish()
            start = thread_time()
            model.move(DT)
            moved = thread_time()
            model.draw()
            times[name].append((moved - start, thread_time() - moved))
        if turn % 10 == 0:
            gc.collect()
    gc.enable()
    return {
        name: [statistics.median(part) * 1e3 for part in zip(*pairs[WARM_UP:], strict=True)]
        for name, pairs in times.items()
    }


def measure_apart(quick: bool, module: str = "benchmarks.models.python_cost") -> dict[str, Any]:
    """What a module prints in a process whose driver does nothing, where it can be told so."""
    command = [sys.executable, "-m", module, *(["--quick"] * quick)]
    done = subprocess.run(
        command,
        env=os.environ | {"GALLIUM_NOOP": "true"},
        check=True,
        capture_output=True,
        text=True,
        timeout=300,
    )
    result: dict[str, Any] = json.loads(done.stdout)
    return result


if __name__ == "__main__":
    print(json.dumps(measure_here("--quick" in sys.argv[1:])))
