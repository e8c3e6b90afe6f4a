"""What the menus have of the simulation and of the export."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from weather_ecs.editor.exporting import FILM, SHEET, STILL, Exports
from weather_ecs.editor.menus import LINE, Item
from weather_ecs.editor.simulation import Simulation
from weather_ecs.editor.studio import studio_of

if TYPE_CHECKING:
    from weather_ecs.editor.app import EditorWindow


def simulation_items(window: EditorWindow) -> list[Item]:
    """Time, while the sky is worked at."""
    here = window.shared.workspace == "sky"

    def run() -> None:
        simulation = _simulation(window)
        simulation.running = not simulation.running

    def begin_again() -> None:
        _simulation(window).running = False
        _simulation(window).restart()

    def step(seconds: float) -> None:
        _simulation(window).step(seconds)

    return [
        Item("Run or pause", "Space", run, here),
        Item("One second on", "Right", partial(step, 1.0), here),
        Item("One second back", "Left", partial(step, -1.0), here),
        Item("One minute on", "Shift+Right", partial(step, 60.0), here),
        Item("One minute back", "Shift+Left", partial(step, -60.0), here),
        Item("To the start", "Ctrl+Home", begin_again, here),
        LINE,
        Item("Again to here", "Ctrl+T", lambda: _simulation(window).again(), here),
        Item("Everything on the map", "M", partial(_whole_map, window), here),
    ]


def export_items(window: EditorWindow) -> list[Item]:
    """Pictures and films."""
    return [
        Item("Export still...", "Ctrl+E", partial(_export, window, STILL)),
        Item("Export film round the cloud...", "", partial(_export, window, FILM)),
        Item("Export impostor sheet...", "", partial(_export, window, SHEET)),
    ]


def _simulation(window: EditorWindow) -> Simulation:
    return studio_of(window.shared).simulation


def _whole_map(window: EditorWindow) -> None:
    studio_of(window.shared).map_wanted = True


def _export(window: EditorWindow, kind: str) -> None:
    shared = window.shared
    if shared.exports is None:
        shared.exports = Exports()
    cameras = [getattr(panel, "camera", None) for _, panel in window.entries]
    camera = next((each for each in cameras if each is not None), None)
    shared.exports.ask(kind, window.document, shared, camera)
