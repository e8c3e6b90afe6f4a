"""Real windows on a private X display: the host's state stays, windows come and go."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from xvfb import Display, display

pytestmark = pytest.mark.window

TESTS = Path(__file__).parent


@pytest.fixture(scope="module")
def screen() -> Iterator[Display]:
    with display() as found:
        yield found


@pytest.fixture(scope="module")
def host(screen: Display, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Run the host game once per scene and mode; its frames and notes."""
    done: dict[tuple[str, str], tuple[np.ndarray, dict[str, Any]]] = {}

    def run(scene: str, mode: str) -> tuple[np.ndarray, dict[str, Any]]:
        if (scene, mode) not in done:
            out = tmp_path_factory.mktemp("host") / "frames.npz"
            screen.python(TESTS / "window_host.py", scene, mode, out)
            with np.load(out) as data:
                done[scene, mode] = data["frames"], json.loads(str(data["notes"]))
        return done[scene, mode]

    return run


@pytest.mark.parametrize("backend", ["feedback", "compute"])
@pytest.mark.parametrize("scene", ["pyglet", "caching", "moderngl"])
def test_host_draws_the_same_without_and_with_hidden_rain(
    host: Any, scene: str, backend: str
) -> None:
    alone, alone_notes = host(scene, "none")
    assert not alone_notes["problems"]
    assert alone[-1][..., :3].std() > 5, "the host itself draws something"
    frames, notes = host(scene, f"hidden:{backend}")
    assert notes["stats"]["backend"] == backend
    assert not notes["problems"]
    assert (frames == alone).all()


@pytest.mark.parametrize("backend", ["feedback", "compute"])
@pytest.mark.parametrize("scene", ["pyglet", "caching", "moderngl"])
def test_host_draws_over_the_rain_as_without_it(host: Any, scene: str, backend: str) -> None:
    alone, _ = host(scene, "none")
    frames, notes = host(scene, f"visible:{backend}")
    assert not notes["problems"]
    assert notes["stats"]["drops_drawn"] > 0
    differ = (frames[-1] != alone[-1]).any(axis=2)
    assert differ.mean() > 0.02, "rain shows on what was drawn before it"
    for x, y, width, height in notes["untouched"]:
        assert not differ[y : y + height, x : x + width].any()


@pytest.mark.parametrize(
    "case",
    [
        "resize",
        "minimise",
        "closed_window",
        "recreated_window",
        "two_windows",
        "other_context_current",
        "close_gives_everything_back",
        "good_guest",
        "hostile_state",
    ],
)
def test_window_life(screen: Display, case: str) -> None:
    printed = screen.python(TESTS / "window_life.py", case)
    assert printed == "", "the plug-in does not print"


def test_example_of_the_readme_rains(screen: Display, tmp_path: Path) -> None:
    out = tmp_path / "readme.npz"
    assert screen.python(TESTS / "window_readme.py", out) == ""
    with np.load(out) as data:
        before, after = data["before"], data["after"]
    assert before.shape == (720, 1280, 4)
    assert (before != after).any(axis=2).mean() > 0.02


def test_the_game_of_the_shaders_page_gets_white(screen: Display, tmp_path: Path) -> None:
    out = tmp_path / "shaders.npz"
    assert screen.python(TESTS / "window_shaders.py", out) == ""

    def light(picture: np.ndarray, x: float, y: float) -> float:
        """Median of a patch, in shares of the picture from its lower left corner."""
        row, column = int(y * picture.shape[0]), int(x * picture.shape[1])
        return float(np.median(picture[row - 4 : row + 5, column - 4 : column + 5, :3]))

    with np.load(out) as data:
        rain, snow = data["rain"], data["snow"]
    assert rain.shape == (540, 960, 4)
    under_roof, in_the_open = (0.39, 0.4), (0.5, 0.15)
    assert light(snow, *in_the_open) > light(rain, *in_the_open) + 30.0
    assert light(snow, *in_the_open) > light(snow, *under_roof) + 30.0
