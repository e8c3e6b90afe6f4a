"""Measure several workloads in turns, so that a busy machine slows all of them alike.

One round runs every case once (A B C A B C ...). What is compared is compared within a round, and
the median of these ratios is what counts: it stands a machine whose speed drifts from one minute to
the next.
"""

from __future__ import annotations

import gc
import json
import os
import platform
import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from typing import Any


@dataclass(frozen=True)
class Case:
    """One workload: `frame` does one frame's work, `facts` are columns of its row."""

    name: str
    frame: Callable[[], object]
    facts: Mapping[str, Any] = field(default_factory=dict)
    before: Callable[[], object] | None = None  # once ahead of every sample, not timed


@dataclass(frozen=True)
class Timings:
    """Seconds per frame of every case, one entry per round."""

    seconds: dict[str, list[float]]
    frames: dict[str, int]  # frames in one sample

    def ms(self, name: str) -> float:
        """Median milliseconds per frame."""
        return statistics.median(self.seconds[name]) * 1e3

    def ratio(self, slow: str, fast: str) -> float:
        """How many times longer a frame of `slow` takes than one of `fast`: median over rounds."""
        pairs = zip(self.seconds[slow], self.seconds[fast], strict=True)
        return statistics.median(a / b for a, b in pairs)

    def added_ms(self, slow: str, fast: str) -> float:
        """How many ms more a frame of `slow` takes than one of `fast`: median over rounds."""
        pairs = zip(self.seconds[slow], self.seconds[fast], strict=True)
        return statistics.median(a - b for a, b in pairs) * 1e3

    def row(self, case: Case) -> dict[str, Any]:
        """The case's row: its facts, then median, quartiles and frame rate."""
        samples = self.seconds[case.name]
        low, _, high = statistics.quantiles(samples, n=4) if len(samples) > 1 else samples * 3
        ms = self.ms(case.name)
        return {
            "name": case.name,
            **case.facts,
            "ms": ms,
            "ms_quartiles": [low * 1e3, high * 1e3],
            "fps": 1e3 / ms,
            "rounds": len(samples),
            "frames_per_sample": self.frames[case.name],
        }


@dataclass(frozen=True)
class Result:
    """What one benchmark found; `ratios` are flat names to numbers."""

    benchmark: str
    renderer: str
    rows: list[dict[str, Any]]
    ratios: dict[str, float]
    machine: str = field(default_factory=lambda: machine_name())

    def as_dict(self) -> dict[str, Any]:
        return {
            "benchmark": self.benchmark,
            "renderer": self.renderer,
            "machine": self.machine,
            "rows": [_rounded(row) for row in self.rows],
            "ratios": _rounded(self.ratios),
        }

    def write(self, path: Path) -> None:
        """One JSON object; NaN and infinity, which JSON lacks, raise ValueError."""
        text = json.dumps(self.as_dict(), indent=2, allow_nan=False)
        path.write_text(text + "\n", encoding="utf-8")

    def table(self) -> str:
        """The rows as aligned text, then the ratios."""
        lines = [f"{self.benchmark}: {self.renderer}; {self.machine}"]
        columns = list(dict.fromkeys(key for row in self.rows for key in row))
        cells = [columns] + [[_text(row.get(key)) for key in columns] for row in self.rows]
        widths = [max(len(line[i]) for line in cells) for i in range(len(columns))]
        for line in cells:
            padded = (cell.ljust(width) for cell, width in zip(line, widths, strict=True))
            lines.append("  ".join(padded).rstrip())
        lines += [f"{name} = {_text(value)}" for name, value in self.ratios.items()]
        return "\n".join(lines)


def measure(
    cases: Sequence[Case],
    *,
    finish: Callable[[], object] | None = None,
    rounds: int = 15,
    warm_up: int = 3,
    sample_seconds: float = 0.05,
    alike: bool = False,
) -> Timings:
    """Run the cases in turns for `rounds` rounds after `warm_up` untimed frames of each.

    `finish` waits for the GPU (`ctx.finish`) and ends every sample. A sample holds as many frames
    as the case does in `sample_seconds`, so that the clock and the wait weigh nothing. `alike`: as
    many for every case, the quickest one's, so that the wait weighs the same on all.
    """
    names = [case.name for case in cases]
    if len(set(names)) != len(names):
        raise ValueError(f"case names must differ: {names}")
    if rounds < 1 or warm_up < 1:
        raise ValueError("rounds and warm_up must be at least 1")

    def sample(case: Case, frames: int) -> float:
        if case.before is not None:
            case.before()
        if finish is not None:
            finish()
        start = perf_counter()
        for _ in range(frames):
            case.frame()
        if finish is not None:
            finish()
        return (perf_counter() - start) / frames

    frames = {}
    for case in cases:
        # The quickest warm-up frame: the first ones compile and allocate.
        fastest = min(sample(case, 1) for _ in range(warm_up))
        frames[case.name] = max(1, min(1000, round(sample_seconds / max(fastest, 1e-7))))

    if alike:
        frames = dict.fromkeys(frames, max(frames.values()))

    seconds: dict[str, list[float]] = {name: [] for name in names}
    collecting = gc.isenabled()
    try:
        for _ in range(rounds):
            gc.collect()
            gc.disable()
            for case in cases:
                seconds[case.name].append(sample(case, frames[case.name]))
            if collecting:
                gc.enable()
    finally:
        if collecting:
            gc.enable()
    return Timings(seconds, frames)


def machine_name() -> str:
    """CPU, cores that this process may use, system and Python."""
    cpu = platform.processor() or platform.machine()
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                cpu = line.partition(":")[2].strip()
                break
    except OSError:
        pass  # not Linux
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return f"{cpu}, {cores} cores, {platform.system()}, Python {platform.python_version()}"


def renderer_name(ctx: Any | None) -> str:
    """Renderer and OpenGL version of a moderngl context; "none" without one."""
    if ctx is None:
        return "none"
    return f"{ctx.info['GL_RENDERER']}, OpenGL {ctx.info['GL_VERSION']}"


def _rounded(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _rounded(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(item) for item in value]
    if isinstance(value, float):
        return float(f"{value:.6g}")
    if hasattr(value, "item"):  # a numpy scalar
        return _rounded(value.item())
    return value


def _text(value: Any) -> str:
    if value is None:
        return "-"
    if isinstance(value, list | tuple):
        return " to ".join(_text(item) for item in value)
    return f"{value:.4g}" if isinstance(value, float) else str(value)
