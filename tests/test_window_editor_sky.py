"""The editor's sky workspace in a real window."""

from __future__ import annotations

from pathlib import Path

import pytest

from xvfb import ROOT, display

pytestmark = pytest.mark.window


def test_sky_workspace(tmp_path: Path) -> None:
    with display((1280, 800)) as screen:
        screen.python(ROOT / "tests" / "window_editor_sky.py", tmp_path, seconds=550.0)
