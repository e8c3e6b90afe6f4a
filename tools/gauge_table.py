"""What rain gauges read, as a share of the rain rate: `python -m tools.gauge_table [SEED ...]`.

25 mm/h at medium, readings of 30 s at several distances from the observer, in calm air, in wind
and in gusts with turbulence, on both backends; in the open, and under a roof of 10 by 10 m each.
Prints the table in docs/collisions.md.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

import esper
import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.camera import Pose, projection_matrix, view_matrix
from demo_game.headless import make_context
from weather_ecs import Weather
from weather_ecs.components import Occluder, RainArea, RainGauge, Wind

RATE = 25.0  # mm/h
DISTANCES = (2.0, 8.0, 15.0, 25.0)  # m, ahead of the observer
STEP, WINDOW = 0.1, 30.0  # s
EYE = 1.7  # m
ROOF, ROOF_HEIGHT = 5.0, 2.5  # m, half a side, height
BACKENDS = ("compute", "feedback")
STEADY = ("calm", "8 m/s")  # winds under a roof


def winds() -> dict[str, Wind]:
    """By their names in the table."""
    return {
        "calm": Wind(),
        "8 m/s": Wind((0.6, 0.8), 8.0),
        "9 m/s, gusts, veering, turbulence": Wind(
            (0.6, 0.8), 9.0, gustiness=0.6, interval=5.0, veer=0.5, veer_period=9.0,
            exponent=1 / 7, turbulence=0.25, ground=-1.0, scale=5.0,
        ),
    }  # fmt: skip


def roof(x: float) -> Occluder:
    """A level square over (x, 0)."""
    signs = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    corners = [(x + a * ROOF, ROOF_HEIGHT, b * ROOF) for a, b in signs]
    return Occluder(np.array(corners), np.array([(0, 1, 2), (0, 2, 3)]))


def readings(
    ctx: moderngl.Context, backend: str, wind: Wind, seed: int, covered: bool = False
) -> NDArray[np.float64]:
    """Of every distance's gauge, over the rain rate."""
    esper.switch_world("gauges")
    esper.clear_database()
    view = view_matrix(Pose((0.0, EYE, 0.0), -0.5 * math.pi, 0.0))  # along +x
    projection = projection_matrix(math.radians(90.0), 16.0 / 9.0)
    with Weather(context=ctx, backend=backend, quality="medium", seed=seed) as weather:
        esper.create_entity(RainArea((0, 0), (200, 200), RATE))
        esper.create_entity(wind)
        gauges = [RainGauge((x, 0.5, 0.0), window=WINDOW) for x in DISTANCES]
        for x, gauge in zip(DISTANCES, gauges, strict=True):
            esper.create_entity(gauge)
            if covered:
                esper.create_entity(roof(x))
        for _ in range(round(WINDOW / STEP)):
            esper.process(STEP)
            weather.draw(view, projection)
        return np.array([gauge.rate for gauge in gauges]) / RATE


def main(arguments: Sequence[str]) -> int:
    seeds = [int(text) for text in arguments] or [1, 2]
    ctx = make_context()
    target = ctx.simple_framebuffer((32, 18))
    target.use()
    head = "".join(f" {d:.0f} m |" for d in DISTANCES)
    print(f"| wind | backend | seed |{head}\n| --- | --- | --- |" + " --- |" * len(DISTANCES))
    worst = 0.0
    cases = [(name, seed, False) for name in winds() for seed in seeds]
    cases += [(name, seeds[0], True) for name in STEADY]
    for name, seed, covered in cases:
        for backend in BACKENDS:
            got = readings(ctx, backend, winds()[name], seed, covered)
            worst = max(worst, float(np.abs(got - (0.0 if covered else 1.0)).max()))
            where = f"{name}, under a roof" if covered else name
            cells = "".join(f" {value:.3f} |" for value in got)
            print(f"| {where} | {backend} | {seed} |{cells}", flush=True)
    print(f"\nfarthest off: {100 * worst:.1f} %")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
