"""Make sure that the machine has what pip cannot bring: OpenGL, and for tests a virtual display.

    python tools/system_packages.py venv|opengl|window ...

Does nothing where the need is met already, or where the system brings it (macOS, Windows). On a
Debian-like system it installs the missing packages with apt-get. Exit code 1, with a message that
says what to install, where it can do neither.
"""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
from importlib import invalidate_caches
from importlib.util import find_spec

PACKAGES = {
    # Debian ships Python without the module that puts pip into a virtual environment.
    "venv": [f"python{sys.version_info.major}.{sys.version_info.minor}-venv"],
    "opengl": [
        "libegl1",
        "libgl1",
        "libgl1-mesa-dri",
        "libglx-mesa0",
        "libx11-6",
        "libfontconfig1",
        "libfreetype6",
        "fonts-dejavu-core",
    ],
    "window": ["xvfb", "xdotool"],
}

# Run in a process of its own: a driver that is half there may abort the process that asks.
OPENGL_PROBE = """
import ctypes, ctypes.util, os
for name in ("EGL", "GL", "X11", "fontconfig", "freetype"):
    ctypes.CDLL(ctypes.util.find_library(name) or f"lib{name} is not there")
try:
    import moderngl
    moderngl.create_context(standalone=True, backend="egl", require=330)
except Exception:
    # A desktop whose driver has no EGL still opens windows.
    if not os.environ.get("DISPLAY"):
        raise
"""


def has_venv() -> bool:
    invalidate_caches()
    return find_spec("ensurepip") is not None


def has_opengl() -> bool:
    probe = [sys.executable, "-c", OPENGL_PROBE]
    return subprocess.run(probe, capture_output=True, check=False).returncode == 0


def has_window() -> bool:
    return all(shutil.which(program) for program in ("Xvfb", "xdotool"))


PRESENT = {"venv": has_venv, "opengl": has_opengl, "window": has_window}


def apt_install(packages: list[str]) -> bool:
    """Install with apt-get, as root or by sudo; False where that is not possible."""
    if shutil.which("apt-get") is None:
        return False
    prefix: list[str] = []
    if os.geteuid() != 0:
        if shutil.which("sudo") is None:
            return False
        prefix = ["sudo"] if sys.stdin.isatty() else ["sudo", "-n"]
    apt = [*prefix, "env", "DEBIAN_FRONTEND=noninteractive", "apt-get"]
    install = [*apt, "install", "-y", "--no-install-recommends", *packages]
    # Package lists may be fresh already; only fetch them when the first try fails.
    if subprocess.run(install, check=False).returncode == 0:
        return True
    subprocess.run([*apt, "update"], check=False)
    return subprocess.run(install, check=False).returncode == 0


def main(needs: list[str]) -> int:
    unknown = [need for need in needs if need not in PACKAGES]
    if unknown or not needs:
        print(f"system_packages: allowed: {', '.join(PACKAGES)}", file=sys.stderr)
        return 2
    if platform.system() != "Linux":
        return 0
    for need in needs:
        if PRESENT[need]():
            continue
        packages = PACKAGES[need]
        print(f"{need}: not found, installing {' '.join(packages)}", flush=True)
        if not apt_install(packages):
            print(f"{need}: please install these: {' '.join(packages)}", file=sys.stderr)
            return 1
        if not PRESENT[need]():
            print(f"{need}: still not usable after installing {packages}", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
