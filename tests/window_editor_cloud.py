"""The cloud workspace of the editor under a real mouse and real keys; exits 0 when all holds.

`window_editor_cloud.py CASE FOLDER`
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from imgui_bundle import imgui

from editor_hands import Hands
from weather_ecs import load_clouds, presets, save_clouds
from weather_ecs.cloud_files import CloudFile
from weather_ecs.editor.app import EditorWindow
from weather_ecs.editor.cloud_view import CloudView
from weather_ecs.editor.files import Files
from weather_ecs.editor.gallery import Gallery
from weather_ecs.editor.recent import Recent
from weather_ecs.editor.studio import studio_of
from xdnd import DragSource, hear_selections

SIZE = (1280, 720)


def opened(folder: Path, path: Path | None = None) -> tuple[EditorWindow, Hands]:
    """An editor with its list of recent files in the folder."""
    window = EditorWindow(None, SIZE, Files(Recent(folder / "recent.json")))
    if path is not None:
        assert window.session.load(path)
    window.set_location(0, 0)
    hands = Hands(window)
    hands.frames(3)
    return window, hands


def view_of(window: EditorWindow) -> CloudView:
    return next(panel for _, panel in window.entries if isinstance(panel, CloudView))


def picture(window: EditorWindow) -> np.ndarray:
    """The cloud view as it is, at rest."""
    target = view_of(window).target
    data = np.frombuffer(target.read(), np.uint8)
    return data.reshape(target.size[1], target.size[0], 3).astype(int)


def at_rest(window: EditorWindow, hands: Hands) -> np.ndarray:
    """The same when all of its pixels are there and it no longer changes."""
    view = view_of(window)

    def rests() -> bool:
        before = view.drawn
        hands.frames(2)
        return view.drawn == before and not window.shared.moves

    hands.until(rests, "the picture at rest")
    return picture(window)


def name_file(hands: Hands, path: Path) -> None:
    """Answer the dialog that asks for a file."""
    hands.until(lambda: hands.shows("##name"), "the dialog")
    hands.frames(4)
    hands.key("ctrl+a")
    hands.type(str(path))
    hands.key("Return")
    hands.until(lambda: not hands.shows("##name"), "the dialog is gone")


def case_story(folder: Path) -> None:
    """A cumulus from nothing, saved, put into a sky whose climate runs; all undone, all redone."""
    window, hands = opened(folder)
    document, shared = window.document, window.shared
    empty = document.content
    sky_alone = at_rest(window, hands)

    # A model of one seed, two roots, the billboards of a cumulus.
    hands.click("New...##model")
    hands.until(lambda: hands.shows("One seed"), "the menu of new models")
    hands.click("One seed")
    assert len(document.content.models) == 1 and len(document.content.models[0].seeds) == 1
    hands.click("New##root")
    hands.click("New##root")
    roots = document.content.models[0].seeds[0].roots
    assert len(roots) == 2 and shared.selection.root == 1
    hands.drag("##yaw", (0.5, 0.5), (0.8, 0.5))
    assert 60.0 < document.content.models[0].seeds[0].roots[1].yaw < 180.0
    steps = document.steps
    assert len(steps) == 4 and steps[-1] == "Yaw", steps  # a drag is one step
    hands.drag("##flatness", (0.9, 0.5), (0.3, 0.5))
    first = at_rest(window, hands)
    assert (np.abs(first - sky_alone).max(axis=2) > 12).mean() > 0.04  # a cloud
    number = shared.number
    hands.click("Generate again")
    hands.until(lambda: shared.number != number, "another random seed")
    assert (np.abs(at_rest(window, hands) - first).max(axis=2) > 12).mean() > 0.02  # another one
    hands.click("##name0cloud")
    hands.key("ctrl+a")
    hands.type("tower")
    hands.key("Return")
    assert document.content.models[0].name == "tower"

    # Saved under a name that is asked for.
    path = folder / "tower.toml"
    hands.key("ctrl+s")
    name_file(hands, path)
    assert document.path == path and not document.dirty
    assert load_clouds(path).models[0].name == "tower"

    # Into a sky of a layer, with a climate that runs.
    hands.click("Sky and weather")
    hands.until(lambda: hands.shows("New##layer"), "the panels of the sky")
    hands.click("Heights")  # nothing is drawn of the world meanwhile
    hands.click("New##layer")
    hands.click("Sky")
    hands.click("##add")
    hands.until(lambda: hands.shows("tower"), "the list of models")
    hands.click("tower")
    hands.click("New##sky")
    hands.click("Simulation")
    hands.click("New climate")
    layer = document.content.layers[0]
    assert layer.skies[0].models == ("tower",) and document.content.climate is not None
    simulation = studio_of(shared).simulation
    hands.until(lambda: len(simulation.frame.clouds) > 5, "clouds in the sky")
    hands.key("space")
    hands.until(lambda: simulation.time > 0.3, "the climate runs")
    hands.key("space")
    assert not simulation.running

    # All of it undone, all redone, saved.
    made, steps = document.content, len(document.steps)
    assert steps >= 10
    for _ in range(steps):
        hands.key("ctrl+z")
    assert document.content is empty and not document.can_undo
    for _ in range(steps):
        hands.key("ctrl+y")
    assert document.content is made and not document.can_redo
    hands.key("ctrl+s")
    hands.until(lambda: not document.dirty, "saved")
    assert len(load_clouds(path).layers) == 1
    finish(window)


def case_hands(folder: Path) -> None:
    """Gizmo, camera, modes, gallery, pictures of textures, copy and paste."""
    save_clouds(folder / "a.toml", CloudFile(models=(presets.cloud_model("cumulus"),)))
    window, hands = opened(folder, folder / "a.toml")
    document, shared, view = window.document, window.shared, view_of(window)
    at_rest(window, hands)

    # The gizmo: the dot in its middle moves the seed along the picture.
    model = document.content.models[0]
    before = model.seeds[0].center
    x, y = pixel_of(view, hands, before)
    hands.drag_at((x, y), (x + 60.0, y))
    after = document.content.models[0].seeds[0].center
    assert np.linalg.norm(np.subtract(after, before)) > 30.0
    assert document.steps == ("Move seed",)
    shared.gizmo = "none"

    # At rest next to nothing is drawn; a mouse that moves is answered at the next tick.
    at_rest(window, hands)
    hands.until(lambda: not window.shared.moves, "nothing moves")

    def tick() -> None:
        window.dispatch_events()
        window.tick()
        window.dispatch_events()  # which draws what the tick has called for

    def dozes() -> bool:
        before = window.drawn
        for _ in range(20):
            tick()
        return window.drawn - before <= 1

    hands.wait(lambda: (tick(), dozes())[1], "the window at rest")
    window.dispatch_event("on_mouse_motion", 300, 300, 1, 1)
    before = window.drawn
    tick()
    assert window.drawn > before

    # The camera: turned, moved along, nearer.
    yaw, distance = view.camera.yaw, view.camera.distance
    hands.drag("cloud picture", (0.2, 0.2), (0.4, 0.2))
    assert view.camera.yaw != yaw and document.steps == ("Move seed",)
    hands._tell("click", 4)
    hands.until(lambda: view.camera.distance < distance, "nearer by the wheel")

    # Each mode shows something of its own.
    plain = at_rest(window, hands)
    for key in "234":
        hands.key(key)
        shown = at_rest(window, hands)
        assert (np.abs(shown - plain).max(axis=2) > 20).mean() > 0.002, key
        hands.key(key)
    hands.key("1")
    assert (np.abs(at_rest(window, hands) - plain).max(axis=2) > 12).mean() > 0.03
    hands.key("1")

    # The gallery: a click shows that cloud.
    gallery = next(panel for _, panel in window.entries if isinstance(panel, Gallery))
    hands.until(lambda: sum(map(bool, gallery._taken)) > 2, "pictures in the gallery")
    hands.click("number 2")
    assert shared.number == 2

    # Textures by picture.
    hands.click("puff_1")
    assert "puff_1" not in document.content.models[0].images
    assert "puff_2" in document.content.models[0].images
    hands.click("puff")
    assert document.content.models[0].images == ("puff",)

    # Copy and paste of the chosen seed.
    hands.click("Seed 2")
    count = len(document.content.models[0].seeds)
    hands.key("ctrl+c", "ctrl+v")
    model = document.content.models[0]
    assert len(model.seeds) == count + 1 and model.seeds[2].size == model.seeds[1].size
    hands.key("Delete")
    assert len(document.content.models[0].seeds) == count
    finish(window)


def case_trouble(folder: Path) -> None:
    """What is refused says so where it is; bad files, lost files, no window to speak of."""
    good = folder / "good.toml"
    save_clouds(good, CloudFile(models=(presets.cloud_model("cumulus"),)))
    bad = folder / "bad.toml"
    bad.write_text(good.read_text().replace("roundness = 0.7", "roundness = 7.0"))
    window, hands = opened(folder, good)
    document = window.document

    # A value that is out of range: refused, said beside the field, the last good one kept.
    kept = document.content
    hands.click("##opacity")
    hands.until(lambda: not imgui.is_mouse_down(0), "the click")
    document.forget_problem()
    box = hands.box("##opacity")
    hands.key("ctrl")
    hands._tell("keydown", "ctrl")
    hands.click_at(0.5 * (box[0] + box[2]), 0.5 * (box[1] + box[3]))
    hands._tell("keyup", "ctrl")
    hands.key("ctrl+a")
    hands.type("7")
    hands.key("Return")
    assert document.problem is not None and "opacity" in document.problem, document.problem
    assert document.problem_at(("model", 0, "opacity")) is not None
    assert document.content.models[0].opacity <= 1.0
    hands.frames(3)
    while document.can_undo:
        hands.key("ctrl+z")
    assert document.content is kept

    # A bad file dropped on the window: what is wrong, and everything as it was.
    source = DragSource(bad)
    source.drop(window._window, (640, 300), hands.frames)
    hands.until(lambda: hear_selections(window) or hands.shows("Close"), "what is wrong")
    source.close()
    assert "roundness" in window.session.trouble and "bad.toml" in window.session.trouble
    hands.click("Close")
    assert document.content is kept and document.path == good

    # Keys work again at once, without a click first.
    window.dispatch_event("on_file_drop", 10, 10, [str(bad)])
    hands.until(lambda: hands.shows("Close"), "what is wrong")
    hands.key("Return", "F1")
    hands.until(lambda: imgui.is_popup_open("", imgui.PopupFlags_.any_popup), "the page of keys")
    hands.key("Escape")

    # The file deleted, and made a folder: the editor has what it had, and can save elsewhere.
    good.unlink()
    hands.until(lambda: window.shared.note_bad, "the note")
    assert document.content is kept and document.dirty
    good.mkdir()
    hands.key("ctrl+s")
    hands.until(lambda: hands.shows("Close"), "that it cannot be saved")
    hands.click("Close")
    assert document.dirty and document.content is kept
    good.rmdir()
    hands.key("ctrl+s")
    hands.until(lambda: not document.dirty, "saved again")

    # Changed by another program: taken over, and undone.
    other = replace(kept, models=(replace(kept.models[0], opacity=0.25),))
    save_clouds(good, other)
    hands.until(lambda: document.content.models[0].opacity == 0.25, "read again")
    hands.key("ctrl+z")
    assert document.content.models[0].opacity == 1.0

    # Unsaved changes are asked about, and nothing is lost by Cancel.
    assert document.dirty
    hands.key("ctrl+n")
    hands.until(lambda: hands.shows("Cancel"), "the question")
    hands.click("Cancel")
    assert document.content.models and document.dirty
    window.dispatch_event("on_close")
    hands.until(lambda: hands.shows("Don't save"), "the question")
    hands.key("Escape")
    hands.until(lambda: not hands.shows("Don't save"), "no question")
    hands.key("ctrl+n")
    hands.until(lambda: hands.shows("Don't save"), "the question")
    hands.click("Don't save")
    assert not document.content.models and not document.dirty

    # A panel that fails inside says so in its place; the others go on.
    panel = next(panel for _, panel in window.entries if panel.title == "Seeds")
    sound = type(panel).draw

    def fails(*_: object) -> None:
        imgui.begin_child("half drawn")
        imgui.push_id("and left")
        raise RuntimeError("broken on purpose")

    type(panel).draw = fails
    hands.frames(3)
    type(panel).draw = sound
    assert hands.shows("New...##model") and not hands.shows("New##seed")
    hands._ids.clear()
    hands.click("Try again##Seeds")
    hands.frames(2)
    assert not hands.shows("Try again##Seeds")

    # A window of next to nothing, and a hidden one.
    window.set_minimum_size(1, 1)
    for size in ((1, 1), (40, 3), (3, 400), (1280, 720)):
        window.set_size(*size)
        hands.frames(4)
    window.minimize()
    hands.frames(4)
    window.activate()
    hands.frames(4)
    assert hands.shows("New...##model")
    finish(window)


def pixel_of(view: CloudView, hands: Hands, place: tuple[float, ...]) -> tuple[float, float]:
    """Where a place of the model's axes is in the window."""
    low_x, low_y, high_x, high_y = hands.box("cloud picture")
    aspect = (high_x - low_x) / (high_y - low_y)
    matrix = view.camera.projection(aspect) @ view.camera.view()
    clip = matrix @ np.array([*place, 1.0])
    x, y = clip[:2] / clip[3]
    return (
        low_x + (0.5 + 0.5 * x) * (high_x - low_x),
        low_y + (0.5 - 0.5 * y) * (high_y - low_y),
    )


def finish(window: EditorWindow) -> None:
    """No error of OpenGL, and everything given back."""
    assert window.shared.gl.error == "GL_NO_ERROR"
    window.shut()
    window.shut()


if __name__ == "__main__":
    globals()[f"case_{sys.argv[1]}"](Path(sys.argv[2]))
