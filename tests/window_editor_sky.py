"""The sky workspace of the editor under a real mouse and real keys; exits 0 when all holds.

`window_editor_sky.py FOLDER`
"""

from __future__ import annotations

import faulthandler
import sys
from pathlib import Path

import numpy as np
from imgui_bundle import imgui
from PIL import Image

from editor_hands import Hands
from weather_ecs import CloudFile
from weather_ecs.editor.app import EditorWindow
from weather_ecs.editor.simulation import Simulation
from weather_ecs.editor.studio import Studio, studio_of

SIZE = (1000, 640)  # as small as all still fits: fewer pixels to draw
REPORT = "EHAM 281255Z 27020KT 6000 -SN BKN012 M02/M04"


def opened() -> tuple[EditorWindow, Hands]:
    """An editor without a file, at its sky."""
    window = EditorWindow(None, SIZE)
    window.set_location(0, 0)
    hands = Hands(window)
    hands.frames(3)
    hands.click("Sky and weather")
    hands.until(lambda: hands.shows("New##layer"), "the sky's panels")
    hands.click("Heights")  # nothing is drawn of the world meanwhile
    return window, hands


def simulation_of(window: EditorWindow) -> tuple[Studio, Simulation]:
    studio = studio_of(window.shared)
    return studio, studio.simulation


def make_sky(window: EditorWindow, hands: Hands) -> None:
    """A layer, a sky and a climate from nothing; run, put at a moment, undone and done again."""
    document = window.document
    empty = document.content
    studio, simulation = simulation_of(window)

    hands.click("New##layer")
    assert len(document.content.layers) == 1
    hands.drag("layer/0/base/##value", (0.5, 0.5), (0.8, 0.5))
    assert document.content.layers[0].base != 1000.0
    assert document.steps == ("New layer", "Layer: base")  # a drag is one step

    hands.click("Sky")
    hands.click("##add")
    hands.until(lambda: hands.shows("cumulus"), "the list of models")
    hands.click("cumulus")
    sky = document.content.layers[0].skies[0]
    assert sky.models == ("cumulus",) and sky.count == 20, sky
    steps = len(document.steps)
    hands.click("##add")
    hands.until(lambda: hands.shows("stratus"), "the list of models")
    hands.click("stratus")
    hands.click("model 1/x")
    assert document.content.layers[0].skies[0].models == ("cumulus",)
    assert len(document.steps) == steps + 2  # each by itself
    hands.click("New##sky")
    assert [sky.state for sky in document.content.layers[0].skies] == [0.0, 1.0]

    hands.click("Simulation")
    hands.click("New climate")
    assert document.content.climate is not None
    hands.until(lambda: len(simulation.frame.clouds) == 20, "twenty clouds")

    hands.key("space")
    hands.until(lambda: simulation.time > 0.2, "the weather runs")
    hands.click("Pause")
    stood = simulation.time
    hands.frames(4)
    assert simulation.time == stood
    hands.click("strip", (0.1, 0.5))
    hands.until(lambda: not simulation.seeking, "the moment that was clicked")
    assert abs(simulation.time - 60.0) < 2.0 and not simulation.running
    assert abs(simulation.weather.stats.state - 0.1) < 0.01
    hands.click("- step")
    hands.until(lambda: not simulation.seeking, "a second before")
    assert abs(simulation.time - 59.0) < 2.0

    hands.click("World")
    hands.frames(2)
    picture = np.frombuffer(studio.target.read(), np.uint8)
    assert picture.std() > 20.0  # sky, clouds and land

    hands.click("Heights")
    made = document.content
    steps = len(document.steps)
    for _ in range(steps):
        hands.key("ctrl+z")
    assert document.content is empty and not document.can_undo
    hands.frames(2)
    assert len(simulation.frame.clouds) == 0
    for _ in range(steps):
        hands.key("ctrl+y")
    assert document.content is made


def make_weather(window: EditorWindow, hands: Hands, folder: Path) -> None:
    """Rain by slider and on the map, a report read, a picture written."""
    document = window.document
    studio, simulation = simulation_of(window)

    hands.click("New##area")
    hands.drag("area/0/rain_rate/##value", (0.1, 0.5), (0.9, 0.5))
    assert document.content.rain_areas[0].rain_rate > 20.0
    assert document.steps[-1] == "Rain area: rain rate" and len(document.steps) == 2
    hands.key("ctrl+c", "ctrl+v", "Delete")
    areas = document.content.rain_areas
    assert len(areas) == 1 and len(document.steps) == 4
    hands.key("ctrl+z", "ctrl+z")
    assert len(document.steps) == 2

    hands.click("Map")
    hands.until(lambda: hands.shows("map"), "the map")
    studio.map.show((-400.0, -400.0), (400.0, 400.0))
    before = document.content.rain_areas[0].center
    start = studio.map.pixel(*before)
    hands.drag_at(start, (start[0] + 60.0, start[1] + 30.0))
    after = document.content.rain_areas[0].center
    scale = studio.map.scale
    assert abs(after[0] - before[0] - 60.0 * scale) < 1.01 * scale
    assert abs(after[1] - before[1] - 30.0 * scale) < 1.01 * scale
    assert document.steps[-1] == "Move rain area" and len(document.steps) == 3
    sample = simulation.weather.sample((after[0], 1.7, after[1]))
    assert sample.rain_rate == document.content.rain_areas[0].rain_rate
    turned = studio.map.handles(0, document.content.rain_areas[0])[3].at
    hands.drag_at(turned, studio.map.pixel(after[0], after[1] - 300.0))
    assert abs(document.content.rain_areas[0].heading - np.pi / 2) < 0.1

    hands.click("Clouds")
    hands.click("New##cloud")
    hands.until(lambda: len(simulation.frame.clouds) == 1, "a single cloud")
    hands.drag("cloud/0/scale/##value", (0.2, 0.5), (0.7, 0.5))
    assert document.content.clouds[0].scale != 1.0 and document.steps[-1] == "Cloud: scale"

    hands.click("METAR")
    hands.click("##metar")
    hands.key("ctrl+a")
    hands.type("EHAM nonsense")
    assert not hands.shows("Make this the weather") or document.can_undo
    steps = len(document.steps)
    hands.click("Make this the weather")
    assert len(document.steps) == steps  # a bad report changes nothing
    hands.click("##metar")
    hands.key("ctrl+a")
    hands.type(REPORT)
    hands.click("Make this the weather")
    content = document.content
    assert content.air is not None and content.air.temperature < 0.0
    assert content.layers and content.winds and len(document.steps) == steps + 1
    hands.click("Wind")
    hands.frames(2)
    assert hands.shows("wind/0/speed/##value")

    hands.key("ctrl+e")
    hands.until(lambda: hands.shows("##path"), "the window of the export")
    path = folder / "world.png"
    assert window.shared.exports is not None
    window.shared.exports.choice.size = 0
    hands.click("##path")
    hands.key("ctrl+a")
    hands.type(str(path))
    hands.click("Export")
    hands.until(path.is_file, "the picture")
    with Image.open(path) as image:
        assert image.size == (640, 360) and np.array(image).std() > 5.0


def finish(window: EditorWindow) -> None:
    """No error of OpenGL, and everything given back."""
    assert window.shared.gl.error == "GL_NO_ERROR"
    assert isinstance(window.document.content, CloudFile)
    assert not imgui.is_any_item_active()
    window.shut()


if __name__ == "__main__":
    faulthandler.dump_traceback_later(500.0, exit=True)  # whoever hangs says where
    opened_window, its_hands = opened()
    make_sky(opened_window, its_hands)
    opened_window.document.reset(CloudFile())
    make_weather(opened_window, its_hands, Path(sys.argv[1]))
    finish(opened_window)
