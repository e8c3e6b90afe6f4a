"""`Exports`: asks how a picture, a film or a sheet is to be, and makes it a piece a frame."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from imgui_bundle import imgui

from weather_ecs.editor import export, theme
from weather_ecs.editor.bound import caption
from weather_ecs.editor.camera import OrbitCamera
from weather_ecs.editor.dialogs import Modal
from weather_ecs.editor.document import Document
from weather_ecs.editor.shared import Shared
from weather_ecs.editor.studio import studio_of
from weather_ecs.errors import WeatherError

STILL, FILM, SHEET = "still", "film", "sheet"
TITLES = {STILL: "Export a still", FILM: "Export a film", SHEET: "Export an impostor sheet"}
ENDINGS = {STILL: ".png", FILM: ".mp4", SHEET: ".png"}
SIZES = ((640, 360), (1280, 720), (1920, 1080), (3840, 2160))
TILES = (64, 128, 256, 512)
COLUMNS = (4, 8, 12, 16)
_WIDE = 430.0


@dataclass(slots=True)
class Choice:
    """What is asked for."""

    path: str = ""
    size: int = 1  # of SIZES
    seconds: float = 6.0
    fps: int = 30
    tile: int = 2  # of TILES
    columns: int = 1  # of COLUMNS


class Exports:
    """The windows of the export; `draw` in every frame."""

    def __init__(self) -> None:
        self.kind: str | None = None  # what is being asked about
        self.choice = Choice()
        self.error = ""
        self._job: Iterator[float] | None = None
        self._share = 0.0
        self._path = Path()
        self._camera: OrbitCamera | None = None

    @property
    def busy(self) -> bool:
        """Whether something is being made."""
        return self._job is not None

    def ask(
        self, kind: str, document: Document, shared: Shared, camera: OrbitCamera | None = None
    ) -> None:
        """Open the window for a kind of export; `camera` is the cloud view's."""
        if self.busy:
            return
        self._camera = camera
        folder = Path.cwd() if document.path is None else document.path.parent
        self.kind, self.error = kind, ""
        self.choice.path = str(folder / f"{_stem(document, shared)}_{kind}{ENDINGS[kind]}")

    def draw(self, document: Document, shared: Shared) -> None:
        """The window that asks, or the one that shows how far it is."""
        if self._job is not None:
            shared.moves = True
            self._go_on(shared)
        elif self.kind is not None:
            self._draw_question(document, shared)

    def begin(self, document: Document, shared: Shared) -> bool:
        """Set out; whether it could. A still is made at once."""
        kind, choice = self.kind, self.choice
        path = Path(os.path.expanduser(choice.path.strip()))
        if not path.suffix:
            path = path.with_name(path.name + ENDINGS[kind or STILL])
        self._path = path
        size = SIZES[choice.size]
        try:
            if not path.parent.is_dir():
                raise OSError(f"there is no folder {path.parent}")
            if kind == STILL and shared.workspace == "sky":
                export.still_of_world(path, studio_of(shared), size)
            elif kind == STILL:
                camera = self._camera or OrbitCamera()
                export.still_of_cloud(shared.gl, path, _subject(document, shared), camera, size)
            elif kind == FILM:
                frames = max(round(choice.seconds * choice.fps), 2)
                self._job = export.turntable(
                    shared.gl, path, _subject(document, shared), size, frames, float(choice.fps)
                )
            else:
                tile, columns = TILES[choice.tile], COLUMNS[choice.columns]
                subject = _subject(document, shared)
                self._job = export.impostor_sheet(shared.gl, path, subject, tile, columns)
        except (WeatherError, OSError) as error:
            self.error = _said(error)
            return False
        self.kind, self.error, self._share = None, "", 0.0
        if self._job is None:
            shared.say(f"Wrote {path}")
        return True

    def cancel(self) -> None:
        """Leave off; nothing is left on disk."""
        job, self._job = self._job, None
        if job is not None:
            job.close()  # type: ignore[attr-defined]

    def close(self) -> None:
        """The window is closing."""
        self.cancel()

    def _go_on(self, shared: Shared) -> None:
        assert self._job is not None, "something is being made"
        try:
            self._share = next(self._job)
        except StopIteration:
            self._job = None
            shared.say(f"Wrote {self._path}")
            return
        except (WeatherError, OSError) as error:
            self._job = None
            shared.say(f"Not written: {_said(error)}", bad=True)
            return
        with Modal("Export") as shown:
            if shown:
                imgui.text(self._path.name)
                imgui.progress_bar(self._share, imgui.ImVec2(_WIDE, 0.0))
                if imgui.button("Cancel", imgui.ImVec2(128.0, 0.0)) or imgui.is_key_pressed(
                    imgui.Key.escape
                ):
                    imgui.close_current_popup()
                    self.cancel()
                    shared.say("The export was left off")

    def _draw_question(self, document: Document, shared: Shared) -> None:
        kind, choice = self.kind or STILL, self.choice
        with Modal(TITLES[kind]) as shown:
            if not shown:
                return
            imgui.dummy(imgui.ImVec2(_WIDE, 1.0))
            needs_cloud = kind != STILL or shared.workspace == "cloud"
            possible = bool(document.content.models) or not needs_cloud
            imgui.text_wrapped(_what(kind, document, shared) if possible else _NO_MODEL)
            caption("File", "PNG for pictures, MP4 for films")
            choice.path = imgui.input_text("##path", choice.path)[1]
            if kind == SHEET:
                _choose("Tile", choice, "tile", [f"{2 * t} x {t} pixels" for t in TILES])
                _choose("Round it", choice, "columns", [f"{c} pictures" for c in COLUMNS])
            else:
                _choose("Size", choice, "size", [f"{w} x {h}" for w, h in SIZES])
            if kind == FILM:
                caption("Duration", "s of the film, 1 to 60")
                changed, value = imgui.slider_float("##s", choice.seconds, 1.0, 60.0, "%.0f s")
                choice.seconds = min(max(value, 1.0), 60.0) if changed else choice.seconds
                caption("Rate", "Pictures a second, 10 to 60")
                changed, rate = imgui.slider_int("##fps", choice.fps, 10, 60, "%d a second")
                choice.fps = min(max(rate, 10), 60) if changed else choice.fps
            if self.error:
                imgui.push_style_color(imgui.Col_.text, theme.vec4(theme.BAD))
                imgui.text_wrapped(self.error)
                imgui.pop_style_color()
            there = Path(os.path.expanduser(choice.path.strip() or ".")).is_file()
            imgui.begin_disabled(not possible or not choice.path.strip())
            go = imgui.button("Replace it" if there else "Export", imgui.ImVec2(128.0, 0.0))
            imgui.end_disabled()
            imgui.same_line()
            leave = imgui.button("Cancel", imgui.ImVec2(128.0, 0.0))
            leave = leave or imgui.is_key_pressed(imgui.Key.escape)
            if leave:
                self.kind = None
            if leave or (go and self.begin(document, shared)):
                imgui.close_current_popup()


_NO_MODEL = "There is no cloud model in this document to show."


def _choose(label: str, choice: Choice, field: str, names: list[str]) -> None:
    caption(label)
    changed, index = imgui.combo(f"##{field}", getattr(choice, field), names)
    if changed:
        setattr(choice, field, index)


def _what(kind: str, document: Document, shared: Shared) -> str:
    if kind == STILL and shared.workspace == "sky":
        return "The world as the World view has it now."
    models = document.content.models
    name = models[min(shared.selection.model, len(models) - 1)].name
    which = f"Cloud {shared.number} of {name}"
    return {
        STILL: f"{which}, as the Cloud view has it, without its marks.",
        FILM: f"{which}, once round.",
        SHEET: f"{which} from all sides, from above, level and from below; clear round it.",
    }[kind]


def _subject(document: Document, shared: Shared) -> export.Subject:
    models = document.content.models
    if not models:
        raise WeatherError(_NO_MODEL)
    model = models[min(shared.selection.model, len(models) - 1)]
    return export.Subject(model, shared.number, shared.sunlight, shared.modes.plain)


def _stem(document: Document, shared: Shared) -> str:
    models = document.content.models
    if shared.workspace == "cloud" and models:
        return models[min(shared.selection.model, len(models) - 1)].name.replace(" ", "_")
    return "world" if document.path is None else document.path.stem


def _said(error: Exception) -> str:
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename or 'the file'}: {error.strerror}"
    return str(error)
