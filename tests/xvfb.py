"""A private X display with software OpenGL, and real input on it."""

from __future__ import annotations

import contextlib
import os
import select
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TypeVar

ROOT = Path(__file__).parent.parent
T = TypeVar("T")


def wait_until(question: Callable[[], T | None], what: str, seconds: float = 60.0) -> T:
    """The first answer that is true: slow machines only take longer."""
    end = time.monotonic() + seconds
    while True:
        answer = question()
        if answer:
            return answer
        if time.monotonic() > end:
            raise TimeoutError(f"after {seconds} s still not: {what}")
        time.sleep(0.05)


class Display:
    """One running X server; `environment` is what its clients need."""

    def __init__(self, number: str) -> None:
        self.number = number
        self.environment = {
            **{k: v for k, v in os.environ.items() if k not in ("WAYLAND_DISPLAY",)},
            "DISPLAY": f":{number}",
            "LIBGL_ALWAYS_SOFTWARE": "1",
            "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tests")]),
            "PYTHONWARNINGS": "error::DeprecationWarning:weather_ecs",
        }

    def python(self, *arguments: object, seconds: float = 180.0) -> str:
        """Run a Python program on the display, return what it printed; fail with its errors."""
        command = [sys.executable, *map(str, arguments)]
        done = subprocess.run(
            command,
            env=self.environment,
            cwd=ROOT,
            capture_output=True,
            text=True,
            timeout=seconds,
            check=False,
        )
        if done.returncode != 0:
            shown = " ".join(map(str, arguments))
            raise AssertionError(
                f"{shown} exited {done.returncode}\n{done.stdout[-2000:]}\n{done.stderr[-6000:]}"
            )
        return done.stdout

    def start(
        self, *arguments: object, cwd: Path | None = None, log: Path | None = None
    ) -> subprocess.Popen[str]:
        """Start a Python program on the display; its output goes to `log`."""
        out = open(log, "w", encoding="utf-8") if log else None  # noqa: SIM115 - the child's
        try:
            return subprocess.Popen(
                [sys.executable, *map(str, arguments)],
                env=self.environment,
                cwd=cwd or ROOT,
                stdout=out,
                stderr=subprocess.STDOUT if out else None,
                text=True,
            )
        finally:
            if out:
                out.close()

    def xdotool(self, *arguments: object) -> str:
        """Real input events by the XTEST extension."""
        command = ["xdotool", *map(str, arguments)]
        done = subprocess.run(
            command, env=self.environment, capture_output=True, text=True, timeout=60, check=False
        )
        return done.stdout.strip()

    def find_window(self, process: subprocess.Popen[str], title: str, seconds: float = 90.0) -> str:
        """X id of the visible window with this title; fails as soon as the process ends."""

        def look() -> str | None:
            if process.poll() is not None:
                raise AssertionError(f"the program exited {process.returncode} before its window")
            found = self.xdotool("search", "--onlyvisible", "--name", f"^{title}$").split()
            return found[0] if found else None

        return wait_until(look, "a visible window", seconds)


@contextlib.contextmanager
def display(size: Sequence[int] = (1280, 800)) -> Iterator[Display]:
    """Start an X server on a number that is free, stop it at the end."""
    missing = [program for program in ("Xvfb", "xdotool") if shutil.which(program) is None]
    if missing:
        raise RuntimeError(f"{' and '.join(missing)} not found: apt-get install xvfb xdotool")
    reader, writer = os.pipe()
    # The server picks the number and writes it once it takes clients.
    server = subprocess.Popen(
        [
            *("Xvfb", "-displayfd", str(writer), "-screen", "0", f"{size[0]}x{size[1]}x24"),
            *("-nolisten", "tcp", "-noreset", "+extension", "GLX"),
        ],
        pass_fds=[writer],
        stderr=subprocess.DEVNULL,
    )
    os.close(writer)
    try:
        ready, _, _ = select.select([reader], [], [], 60)
        number = os.read(reader, 32).decode().strip() if ready else ""
        if not number:
            raise RuntimeError(f"Xvfb did not start (exit code {server.poll()})")
        yield Display(number)
    finally:
        os.close(reader)
        server.terminate()
        try:
            server.wait(timeout=20)
        except subprocess.TimeoutExpired:
            server.kill()
            server.wait()
