"""Rain that meets a scene, at 0.5 to 4 million drops (seed 001, Table 1): frame time and CPU time.

After Sunyer et al. (2009), GeForce GTX 280; its frames per second stand beside ours as
`paper_fps`. A frame is a clear, the scene (ground, a hut, steps, a thing that moves), the weather's
step and its draw at 1280x720. With collisions the scene's meshes are occluders, the map of them is
captured anew in every frame, and splashes are drawn; without, the rain falls through everything
that does not hide it.

Ratios: `collision_share` is what collisions and splashes add, as a share of the frame without them
(compute); `compute_over_feedback` compares frame rates without collisions, as the paper does. Both
are those of the count at which they are worst; `_mean` is the mean over the counts. `_work` is the
worst by `work_ms`, processor time of all threads: where the processor draws, it says what a busy
machine's clock cannot; with a GPU it says nothing. `cpu_*` is time of the calling thread in
`esper.process` and `Weather.draw` with collisions (compute). A driver that can be told to do no
work on drops does none meanwhile, see `models/python_cost.py`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from statistics import fmean
from time import process_time
from typing import Any

import moderngl

from benchmarks.harness import Case, Result, Timings, measure, renderer_name
from benchmarks.models.python_cost import measure_apart
from benchmarks.models.scene import Scene
from benchmarks.models.stage import Stage, create_context
from benchmarks.models.struck import StruckRain, case_name
from benchmarks.models.struck_cost import COUNTS as CPU_COUNTS
from benchmarks.models.struck_cost import QUICK_COUNTS as QUICK_CPU_COUNTS

COUNTS = (500_000, 1_000_000, 2_000_000, 4_000_000)
QUICK_COUNTS = (20_000, 40_000, 80_000, 160_000)
DT = 1.0 / 60.0  # s
# Frames per second by drops: one kernel with collisions, without, shaders without.
PAPER = {
    ("compute", True): dict(zip(COUNTS, (76.43, 50.34, 30.12, 15.62), strict=True)),
    ("compute", False): dict(zip(COUNTS, (83.14, 56.12, 35.71, 19.02), strict=True)),
    ("feedback", False): dict(zip(COUNTS, (127.22, 76.92, 43.29, 21.78), strict=True)),
}

SHARE, RATE = "collision_share", "compute_over_feedback"

Ratios = dict[str, float]


class Work:
    """Processor time of all threads, in seconds per frame of every sample, by case."""

    def __init__(self, finish: Callable[[], object]) -> None:
        self._finish = finish
        self.seconds: dict[str, list[float]] = {}
        self._frames = 0
        self._start: float | None = None

    def before(self, name: str) -> None:
        """A sample of a case is to begin; the first `finish` after it starts the clock."""
        self._samples = self.seconds.setdefault(name, [])
        self._frames, self._start = 0, None

    def frame(self) -> None:
        self._frames += 1

    def finish(self) -> None:
        self._finish()
        if self._start is None:
            self._start = process_time()
        else:
            self._samples.append((process_time() - self._start) / self._frames)

    def timings(self, timed: Timings) -> Timings:
        """Without the untimed samples at the beginning."""
        last = {name: len(samples) for name, samples in timed.seconds.items()}
        seconds = {name: samples[-last[name] :] for name, samples in self.seconds.items()}
        return Timings(seconds, timed.frames)


def run(quick: bool) -> Result:
    counts = QUICK_COUNTS if quick else COUNTS
    ctx = create_context()
    stage = Stage(ctx, (320, 180) if quick else (1280, 720))
    scene = Scene(stage)
    backends = ("compute", "feedback") if ctx.version_code >= 430 else ("feedback",)
    try:
        rounds = 3 if quick else 5
        timings, work, rows = run_cases(ctx, stage, scene, counts, backends, rounds)
        renderer = renderer_name(ctx)
        if ctx.error != "GL_NO_ERROR":
            raise RuntimeError(f"OpenGL error: {ctx.error}")
    finally:
        scene.release()
        stage.release()
        ctx.release()
    python = measure_apart(quick, "benchmarks.models.struck_cost")
    rows += cpu_rows(python)
    ratios = frame_ratios(timings, counts, backends)
    worst = frame_ratios(work, counts, backends)
    ratios |= {f"{n}_work": worst[n] for n in (SHARE, RATE) if n in worst}
    ratios |= cpu_ratios(python["ms"], backends[0], QUICK_CPU_COUNTS if quick else CPU_COUNTS)
    return Result("collisions", renderer, rows, ratios)


def run_cases(
    ctx: moderngl.Context,
    stage: Stage,
    scene: Scene,
    counts: Sequence[int],
    backends: Sequence[str],
    rounds: int,
) -> tuple[Timings, Timings, list[dict[str, Any]]]:
    """Every count on every backend with and without collisions, in turns: time, work and rows."""
    work = Work(ctx.finish)
    models: list[StruckRain] = []
    cases: list[Case] = []

    def add(drops: int, backend: str, collisions: bool) -> None:
        model = StruckRain(stage, scene, drops, backend=backend, collisions=collisions)
        models.append(model)

        def frame() -> None:
            work.frame()
            stage.begin()
            model.move(DT)
            model.draw_scene()
            model.draw()

        facts: dict[str, Any] = {
            "drops": model.drops,
            "backend": backend,
            "collisions": collisions,
        }
        name = case_name(drops, backend, collisions)
        cases.append(Case(name, frame, facts, before=lambda: work.before(name)))

    try:
        for drops in counts:
            for backend in backends:
                add(drops, backend, True)
                add(drops, backend, False)
        timings = measure(cases, finish=work.finish, rounds=rounds, warm_up=2)
        worked = work.timings(timings)
        rows = []
        for case, model in zip(cases, models, strict=True):
            stats, row = model.rain.weather.stats, timings.row(case)
            paper = PAPER.get((row["backend"], row["collisions"]), {}).get(model.drops)
            row["work_ms"] = worked.ms(case.name)
            row |= {} if paper is None else {"paper_fps": paper}
            rows.append(row | {"drawn": stats.drops_drawn, "impacts": stats.impacts})
        return timings, worked, rows
    finally:
        for model in models:
            model.release()


def frame_ratios(timings: Timings, counts: Sequence[int], backends: Sequence[str]) -> Ratios:
    """What collisions add, and how the backends compare: the worst count, the mean, and each."""

    def added(backend: str) -> dict[int, float]:
        return {
            n: timings.ratio(case_name(n, backend, True), case_name(n, backend, False)) - 1.0
            for n in counts
        }

    first = backends[0]
    share = added(first)
    ratios: Ratios = {
        SHARE: max(share.values()),
        f"{SHARE}_mean": fmean(share.values()),
    }
    ratios |= {f"{SHARE}_{n}": value for n, value in share.items()}
    if len(backends) < 2:
        return ratios
    for collisions, ending in ((False, ""), (True, "_with_collisions")):
        rate = {
            n: timings.ratio(
                case_name(n, "feedback", collisions), case_name(n, "compute", collisions)
            )
            for n in counts
        }
        name = f"{RATE}{ending}"
        ratios |= {name: min(rate.values()), f"{name}_mean": fmean(rate.values())}
        ratios |= {f"{name}_{n}": value for n, value in rate.items()}
    ratios[f"{SHARE}_feedback"] = max(added("feedback").values())
    return ratios


def cpu_rows(python: Mapping[str, Any]) -> list[dict[str, Any]]:
    return [
        {
            "name": f"cpu_{name}",
            "driver": python["driver"],
            "ms": moving + drawing,
            "process_ms": moving,
            "draw_ms": drawing,
        }
        for name, (moving, drawing) in python["ms"].items()
    ]


def cpu_ratios(parts: Mapping[str, Sequence[float]], backend: str, counts: Sequence[int]) -> Ratios:
    """CPU milliseconds a frame at the most drops, and how they compare with those at the fewest."""
    few, many = (sum(parts[case_name(n, backend, True)]) for n in (counts[0], counts[-1]))
    return {"cpu_4m_over_05m": many / few, "cpu_ms_4m": many}
