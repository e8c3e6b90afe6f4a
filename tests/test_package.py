"""The built wheel, in an environment of its own and far from the source tree."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tomllib
import venv
import zipfile
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parent.parent
SHIPPED = ("weather_ecs", "demo_game")


def run(*command: object, cwd: Path, seconds: float = 300.0, **environment: str) -> str:
    """Run a program without a display and without a way back to the source tree."""
    hidden = ("DISPLAY", "WAYLAND_DISPLAY", "PYTHONPATH", "VIRTUAL_ENV")
    kept = {name: value for name, value in os.environ.items() if name not in hidden}
    done = subprocess.run(
        [str(part) for part in command],
        cwd=cwd,
        env={**kept, **environment},
        capture_output=True,
        text=True,
        timeout=seconds,
        check=False,
    )
    shown = " ".join(str(part) for part in command)
    assert done.returncode == 0, f"{shown}\n{done.stdout[-3000:]}\n{done.stderr[-6000:]}"
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A wheel from a copy of the sources, so that no earlier build's leftovers get in."""
    source = tmp_path_factory.mktemp("source")
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    for name in SHIPPED:
        ignored = shutil.ignore_patterns("__pycache__", "*.egg-info")
        shutil.copytree(ROOT / name, source / name, ignore=ignored)
    out = tmp_path_factory.mktemp("dist")
    run(sys.executable, "-m", "build", "--wheel", "--outdir", out, source, cwd=out)
    shutil.rmtree(source)
    (found,) = out.glob("*.whl")
    return found


@pytest.fixture(scope="module")
def python(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The interpreter of an empty environment into which only the wheel was installed."""
    home = tmp_path_factory.mktemp("environment")
    venv.create(home, with_pip=True)
    found = home / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    run(found, "-m", "pip", "install", "--quiet", f"{wheel}[demo]", cwd=home, seconds=600)
    return found


def test_wheel_holds_every_file_and_no_other(wheel: Path) -> None:
    names = {n for n in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in n}
    wanted = {
        path.relative_to(ROOT).as_posix()
        for package in SHIPPED
        for path in (ROOT / package).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and not path.name.startswith(".")
    }
    assert names == wanted
    assert any(name.startswith("weather_ecs/shaders/") for name in names)
    assert "weather_ecs/py.typed" in names


def test_version_is_the_same_everywhere(python: Path, tmp_path: Path) -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    code = "import weather_ecs, importlib.metadata as m; "
    code += "print(weather_ecs.__version__, m.version('weather_ecs'), weather_ecs.__file__)"
    imported, installed, place = run(python, "-c", code, cwd=tmp_path).split()
    assert imported == installed == project["version"]
    assert not Path(place).is_relative_to(ROOT)
    assert f"## {imported}" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


IMPORT = """
import sys
import weather_ecs, weather_ecs.components, weather_ecs.presets, weather_ecs.errors
touched = [n for n in ("pyglet.window", "pyglet.gl", "pyglet.app") if n in sys.modules]
assert not touched, touched
if sys.platform == "linux":
    loaded = open("/proc/self/maps").read()
    drivers = [n for n in ("libGL.so", "libEGL.so", "libX11.so") if n in loaded]
    assert not drivers, drivers
"""


def test_import_touches_no_window_and_no_opengl(python: Path, tmp_path: Path) -> None:
    assert run(python, "-W", "error", "-c", IMPORT, cwd=tmp_path) == ""


SERVER = """
import sys, esper
from weather_ecs import Weather
from weather_ecs.components import RainArea
with Weather() as weather:
    esper.create_entity(RainArea(center=(0, 0), radii=(60, 40), rain_rate=25.0, soft_edge=5.0))
    for _ in range(3):
        esper.process(1 / 60)
    assert abs(weather.sample((0, 1, 0)).rain_rate - 25.0) < 1e-6
    assert weather.sample((500, 1, 0)).rain_rate == 0.0
    assert weather.backend == "none"
if sys.platform == "linux":
    assert "libGL.so" not in open("/proc/self/maps").read()
"""


def test_server_needs_no_opengl(python: Path, tmp_path: Path) -> None:
    assert run(python, "-W", "error", "-c", SERVER, cwd=tmp_path) == ""


@pytest.mark.parametrize("command", ["module", "script"])
def test_wheel_runs_the_demo(python: Path, tmp_path: Path, command: str) -> None:
    program = [python, "-m", "demo_game"] if command == "module" else []
    program = program or [python.parent / "weather-ecs-demo"]
    tour = ["--headless", "--tour", "still", "--frames", "2", "--size", "160x90", "--every", "1"]
    run(*program, *tour, "--out", tmp_path / "out", cwd=tmp_path)
    pictures = sorted((tmp_path / "out").glob("*.png"))
    assert len(pictures) == 2
    for picture in pictures:
        header = picture.read_bytes()[:24]
        assert header[:8] == b"\x89PNG\r\n\x1a\n"
        size = int.from_bytes(header[16:20], "big"), int.from_bytes(header[20:24], "big")
        assert size == (160, 90)
