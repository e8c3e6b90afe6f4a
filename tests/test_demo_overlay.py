"""What lies over the picture, in a real window: legible, whole, and nothing on top of another."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from xvfb import display

pytestmark = pytest.mark.window


def test_every_screen_at_every_size() -> None:
    with display((1280, 800)) as screen:
        report = json.loads(screen.python(Path(__file__).parent / "demo_overlay.py"))
    assert report["problems"] == []
    changed = report["changed"]
    assert len(changed) == 32
    assert all(share > 0.02 for share in changed.values()), changed
    assert all(changed[name] > 0.4 for name in changed if name.startswith(("pause", "help")))
    assert all(changed[name] > 0.1 for name in changed if name.startswith(("start", "end")))
    large = {n: c for n, c in changed.items() if n.startswith("play") and c >= 0.4}
    assert not large
