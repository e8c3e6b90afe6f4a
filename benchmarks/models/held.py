"""How many drops a machine holds at a frame rate: a ladder of numbers, measured in turns."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from time import perf_counter

from benchmarks.models.ours import OurRain
from benchmarks.models.stage import Stage

DT = 1.0 / 60.0  # s
STEPS = 5  # of the ladder
SPREAD = 2.0  # of its ends, either way about what a first look has found
Make = Callable[[int], OurRain]  # rain of so many drops


def frame_of(stage: Stage, rain: OurRain) -> Callable[[], None]:
    """One frame's work: clear, move, draw."""

    def frame() -> None:
        stage.begin()
        rain.move(DT)
        rain.draw()

    return frame


def frame_ms(stage: Stage, rain: OurRain, frames: int, warm_up: int = 2) -> float:
    """Shortest ms of some frames that are waited for."""
    frame, times = frame_of(stage, rain), []
    for _ in range(warm_up + frames):
        begun = perf_counter()
        frame()
        stage.ctx.finish()
        times.append(perf_counter() - begun)
    return min(times[warm_up:]) * 1e3


def first_look(stage: Stage, make: Make, ms: float, begin: int, most: int) -> int:
    """About how many drops take so many ms: doubled until they do, then by proportion."""
    drops = begin
    while True:
        rain = make(drops)
        try:
            took = frame_ms(stage, rain, 3)
        finally:
            rain.release()
        if took >= ms or drops == most:
            return min(max(round(drops * min(ms / took, 1.0)), 1), most)
        drops = min(2 * drops, most)


def ladder(middle: int, most: int) -> list[int]:
    """Numbers of drops around one, all different."""
    powers = [2.0 * k / (STEPS - 1) - 1.0 for k in range(STEPS)]
    return sorted({min(max(round(middle * SPREAD**p), 1), most) for p in powers})


def crossing(drops: Sequence[int], ms: Sequence[float], limit: float) -> float:
    """The number of drops at which a frame takes `limit` ms; both as logarithms between two.

    Times that fall where the number grows are noise: they are raised. Beyond the ends, by
    proportion to the nearest one.
    """
    risen = [max(ms[: k + 1]) for k in range(len(ms))]
    if limit <= risen[0]:
        return drops[0] * limit / risen[0]
    for k in range(1, len(risen)):
        if limit <= risen[k]:
            part = math.log(limit / risen[k - 1]) / math.log(risen[k] / risen[k - 1])
            return float(drops[k - 1] * (drops[k] / drops[k - 1]) ** part)
    return drops[-1] * limit / risen[-1]
