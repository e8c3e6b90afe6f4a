"""`python -m weather_ecs.editor` where it cannot start: one line says why."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent


def start(before: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    """The editor in a process of its own, without a display, after some code."""
    hidden = ("DISPLAY", "WAYLAND_DISPLAY")
    kept = {name: value for name, value in os.environ.items() if name not in hidden}
    code = f"import sys; {before}; from weather_ecs.editor.__main__ import main; "
    run = [sys.executable, "-c", code + f"sys.exit(main({list(arguments)}))"]
    return subprocess.run(run, cwd=ROOT, env=kept, capture_output=True, text=True, check=False)


@pytest.mark.skipif(sys.platform != "linux", reason="other systems always have a display")
def test_without_a_display() -> None:
    done = start("pass")
    assert done.returncode == 1 and not done.stdout
    (line,) = done.stderr.splitlines()
    assert line.startswith("error: no window: ")


def test_without_its_libraries() -> None:
    stand_in = "import types; sys.modules['pyglet.window'] = types.ModuleType('pyglet.window')"
    done = start(f"{stand_in}; sys.modules['imgui_bundle'] = None")
    assert done.returncode == 1 and not done.stdout
    (line,) = done.stderr.splitlines()
    assert line == "error: the library 'imgui_bundle' is missing: pip install 'weather_ecs[editor]'"


def test_a_size_that_is_none() -> None:
    done = start("pass", "--size", "0x0")
    assert done.returncode == 2
    assert "'0x0': allowed: WxH, each 1 to 16384" in done.stderr
