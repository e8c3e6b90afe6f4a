"""The benchmark harness, on workloads whose times are known."""

from __future__ import annotations

import gc
import json
import subprocess
import sys
import time
import types
from pathlib import Path

import pytest

from benchmarks import __main__ as command
from benchmarks.harness import Case, Result, Timings, machine_name, measure, renderer_name

ROOT = Path(__file__).parent.parent


class Clock:
    """Stands in for `perf_counter`: time passes only where a workload says so."""

    def __init__(self) -> None:
        self.now = 0.0

    def spend(self, seconds: float) -> None:
        self.now += seconds

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr("benchmarks.harness.perf_counter", clock)
    return clock


def test_cases_take_turns(clock: Clock) -> None:
    order: list[str] = []
    cases = [Case(n, lambda n=n: (order.append(n), clock.spend(0.01))) for n in "ABC"]
    measure(cases, rounds=4, warm_up=2, sample_seconds=0.01)
    assert "".join(order) == "AABBCC" + "ABC" * 4


def test_ratio_survives_a_machine_that_slows_down(clock: Clock) -> None:
    speed = [1.0]

    def work(seconds: float) -> None:
        clock.spend(seconds * speed[0])

    def slow() -> None:
        work(0.030)
        speed[0] *= 1.5  # every round runs on a slower machine than the one before

    cases = [Case("fast", lambda: work(0.010)), Case("slow", slow)]
    timings = measure(cases, rounds=9, warm_up=1, sample_seconds=0.0)
    assert timings.ratio("slow", "fast") == pytest.approx(3.0)
    assert timings.ratio("fast", "slow") == pytest.approx(1 / 3)
    assert max(timings.seconds["fast"]) > 10 * min(timings.seconds["fast"])


def test_one_disturbed_round_changes_nothing(clock: Clock) -> None:
    calls = [0]

    def disturbed() -> None:
        calls[0] += 1
        clock.spend(5.0 if calls[0] == 6 else 0.02)

    cases = [Case("a", disturbed), Case("b", lambda: clock.spend(0.01))]
    timings = measure(cases, rounds=9, warm_up=2, sample_seconds=0.0)
    assert timings.ms("a") == pytest.approx(20.0)
    assert timings.ratio("a", "b") == pytest.approx(2.0)
    assert timings.added_ms("a", "b") == pytest.approx(10.0)


def test_short_frames_share_a_sample(clock: Clock) -> None:
    cases = [Case("short", lambda: clock.spend(1e-3)), Case("long", lambda: clock.spend(0.2))]
    timings = measure(cases, rounds=3, sample_seconds=0.05)
    assert timings.frames == {"short": 50, "long": 1}
    assert timings.ms("short") == pytest.approx(1.0)
    timings = measure(cases, rounds=3, sample_seconds=0.05, alike=True)
    assert timings.frames == {"short": 50, "long": 50}
    assert timings.ms("long") == pytest.approx(200.0)


def test_finish_is_inside_the_sample(clock: Clock) -> None:
    pending = [0.0]

    def submit() -> None:
        pending[0] += 0.02

    def finish() -> None:
        clock.spend(pending[0])
        pending[0] = 0.0

    timings = measure([Case("gpu", submit)], finish=finish, rounds=3, sample_seconds=0.1)
    assert timings.frames["gpu"] == 5
    assert timings.ms("gpu") == pytest.approx(20.0)


def test_before_is_not_timed(clock: Clock) -> None:
    case = Case("c", lambda: clock.spend(0.01), before=lambda: clock.spend(7.0))
    assert measure([case], rounds=3).ms("c") == pytest.approx(10.0)


def test_real_clock_finds_what_was_slept_at_least() -> None:
    cases = [Case("two", lambda: time.sleep(0.02)), Case("one", lambda: time.sleep(0.01))]
    timings = measure(cases, rounds=3, warm_up=1, sample_seconds=0.0)
    for name, slept in (("two", 20.0), ("one", 10.0)):  # a busy machine only sleeps longer
        assert 0.99 * slept <= timings.ms(name) < 1000.0 * slept


def test_garbage_collection_is_left_as_it_was(clock: Clock) -> None:
    seen: list[bool] = []

    def frame() -> None:
        seen.append(gc.isenabled())
        clock.spend(0.01)

    assert gc.isenabled()
    measure([Case("a", frame)], rounds=2, warm_up=1, sample_seconds=0.0)
    assert seen == [True, False, False]
    assert gc.isenabled()

    def fail() -> None:
        if not gc.isenabled():
            raise RuntimeError("in a timed round")
        clock.spend(0.01)

    with pytest.raises(RuntimeError, match="timed round"):
        measure([Case("a", fail)], rounds=1, warm_up=1)
    assert gc.isenabled()


def test_wrong_requests_are_refused() -> None:
    with pytest.raises(ValueError, match="differ"):
        measure([Case("a", int), Case("a", int)])
    with pytest.raises(ValueError, match="at least 1"):
        measure([Case("a", int)], rounds=0)


def test_row_and_json(tmp_path: Path) -> None:
    timings = Timings({"a": [0.01, 0.02, 0.03]}, {"a": 4})
    row = timings.row(Case("a", int, {"drops": 50_000, "covered": 0.1234567891}))
    assert row["ms"] == pytest.approx(20.0)
    assert row["fps"] == pytest.approx(50.0)
    result = Result("synthetic", "none", [row], {"a_over_b": 2.0})
    result.write(tmp_path / "r.json")
    read = json.loads((tmp_path / "r.json").read_text())
    assert set(read) == {"benchmark", "renderer", "machine", "rows", "ratios"}
    assert read["rows"][0]["drops"] == 50_000
    assert read["rows"][0]["covered"] == pytest.approx(0.123457)
    assert read["ratios"] == {"a_over_b": 2.0}
    assert read["machine"] == machine_name()
    table = result.table()
    assert "50000" in table
    assert "a_over_b = 2" in table


def test_json_refuses_what_is_not_a_number(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="JSON"):
        Result("x", "none", [], {"bad": float("nan")}).write(tmp_path / "r.json")
    assert not (tmp_path / "r.json").exists()


def test_renderer_is_named() -> None:
    info = {"GL_RENDERER": "llvmpipe", "GL_VERSION": "4.5 (Core Profile) Mesa"}
    assert renderer_name(types.SimpleNamespace(info=info)).startswith("llvmpipe, OpenGL 4.5")
    assert renderer_name(None) == "none"
    assert "cores" in machine_name()


@pytest.mark.parametrize("arguments", [["no_such"], [], ["harness"], ["--frob"]])
def test_bad_command_lines_exit_2_with_one_line(arguments: list[str]) -> None:
    run = [sys.executable, "-m", "benchmarks", *arguments]
    done = subprocess.run(run, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.strip().splitlines()) == 1
    if arguments == ["no_such"]:
        assert "no_such" in done.stderr
        assert all(name in done.stderr for name in command.names())


def test_command_runs_and_writes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    asked: list[bool] = []

    def run(quick: bool) -> Result:
        asked.append(quick)
        return Result("synthetic", "none", [{"name": "a", "ms": 1.5}], {"r": 3.0})

    module = types.ModuleType("benchmarks.synthetic")
    module.run = run  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "benchmarks.synthetic", module)
    monkeypatch.setattr(command, "names", lambda: ["synthetic"])
    path = tmp_path / "out.json"
    assert command.main(["synthetic", "--quick", "--json", str(path)]) == 0
    assert asked == [True]
    assert "r = 3" in capsys.readouterr().out
    assert json.loads(path.read_text())["benchmark"] == "synthetic"
    with pytest.raises(SystemExit) as stop:
        command.main(["synthetic", "--json", str(tmp_path / "no" / "out.json")])
    assert stop.value.code == 2
