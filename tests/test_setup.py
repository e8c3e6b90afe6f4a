"""The set-up that `make` does: system packages are installed only where they are missing."""

from __future__ import annotations

import importlib.util
import os
import platform
import stat
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parent.parent
SCRIPT = ROOT / "tools" / "system_packages.py"

linux_only = pytest.mark.skipif(platform.system() != "Linux", reason="elsewhere it does nothing")


def load() -> ModuleType:
    spec = importlib.util.spec_from_file_location("system_packages", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def program(folder: Path, name: str, script: str) -> Path:
    path = folder / name
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


def run(*needs: str, path: Path) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PATH": str(path)}
    command = [sys.executable, str(SCRIPT), *needs]
    return subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=60, check=False
    )


@pytest.fixture
def bare(tmp_path: Path) -> Path:
    """A PATH with next to nothing on it, and no way to become another user."""
    for tool in ("sh", "env", "cat", "chmod"):
        found = next(p for p in ("/bin", "/usr/bin") if (Path(p) / tool).exists())
        (tmp_path / tool).symlink_to(Path(found) / tool)
    # Not root: as where a user has sudo without a password.
    program(tmp_path, "sudo", 'while [ "$1" = "-n" ]; do shift; done; exec "$@"')
    return tmp_path


def test_unknown_need_exits_2(tmp_path: Path) -> None:
    done = run("windows", path=tmp_path)
    assert done.returncode == 2
    assert "opengl" in done.stderr


@linux_only
def test_missing_programs_are_installed_once(bare: Path) -> None:
    make = "for p in Xvfb xdotool; do printf '#!/bin/sh\\n' > {0}/$p; chmod +x {0}/$p; done"
    program(bare, "apt-get", f'echo "$@" >> {bare}/calls\n' + make.format(bare))
    assert run("window", path=bare).returncode == 0
    calls = (bare / "calls").read_text().splitlines()
    assert calls == ["install -y --no-install-recommends xvfb xdotool"]
    assert run("window", path=bare).returncode == 0
    assert (bare / "calls").read_text().splitlines() == calls


@linux_only
def test_package_lists_are_fetched_when_the_first_try_fails(bare: Path) -> None:
    script = f'echo "$1" >> {bare}/calls\n[ "$1" = update ] && exit 0\nexit 100'
    program(bare, "apt-get", script)
    done = run("window", path=bare)
    assert done.returncode == 1
    assert (bare / "calls").read_text().split() == ["install", "update", "install"]
    assert "xvfb xdotool" in done.stderr


@linux_only
def test_without_apt_it_says_what_to_install(tmp_path: Path) -> None:
    done = run("window", path=tmp_path)
    assert done.returncode == 1
    assert "please install" in done.stderr
    assert "xvfb" in done.stderr


@linux_only
def test_this_machine_has_opengl() -> None:
    module = load()
    assert module.has_opengl()
    assert module.has_venv()


def test_other_systems_bring_their_own(monkeypatch: pytest.MonkeyPatch) -> None:
    module = load()
    monkeypatch.setattr(platform, "system", lambda: "Darwin")
    monkeypatch.setattr(module, "has_opengl", lambda: False)
    assert module.main(["opengl", "window"]) == 0
