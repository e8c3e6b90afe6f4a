"""What one frame with collisions costs the CPU, by number of drops: JSON out, see `python_cost`."""

from __future__ import annotations

import json
import sys
from typing import Any

from benchmarks.models.python_cost import time_in_turns
from benchmarks.models.scene import Scene
from benchmarks.models.stage import Stage, create_context
from benchmarks.models.struck import StruckRain, case_name

COUNTS = (500_000, 4_000_000)
QUICK_COUNTS = (20_000, 160_000)


def measure_here(quick: bool) -> dict[str, Any]:
    """{"driver": name, "ms": {case: [process, draw]}} in this process."""
    ctx = create_context()
    stage = Stage(ctx, (16, 9))
    scene = Scene(stage)
    models = {}
    for drops in QUICK_COUNTS if quick else COUNTS:
        for backend in ("compute", "feedback") if ctx.version_code >= 430 else ("feedback",):
            for collisions in (False, True):
                models[case_name(drops, backend, collisions)] = StruckRain(
                    stage, scene, drops, backend=backend, collisions=collisions
                )
    ms = time_in_turns(stage, models, 15 if quick else 150)
    for model in models.values():
        model.release()
    scene.release()
    stage.release()
    driver = str(ctx.info["GL_RENDERER"])
    ctx.release()
    return {"driver": driver, "ms": ms}


if __name__ == "__main__":
    print(json.dumps(measure_here("--quick" in sys.argv[1:])))
