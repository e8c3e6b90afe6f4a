"""`Shared`: what the panels and views of the editor have in common besides the document."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import moderngl

    from weather_ecs.editor.document import Document
    from weather_ecs.editor.exporting import Exports
    from weather_ecs.editor.studio import Studio

NOTE_LASTS = 6.0  # s that a note stays in the status line


@dataclass(slots=True)
class Modes:
    """How the cloud view shows the cloud: any mix."""

    billboards: bool = True
    boxes: bool = False  # the seeds
    rays: bool = False  # the absorption factor: rays to the light
    roots: bool = False  # arrows with their openings
    plain: bool = False  # the dissertation's own light
    grid: bool = True  # the ground below, with its scale


@dataclass(slots=True)
class Selection:
    """Indices into the document's content; what is not there any more is put right by `clamp`."""

    model: int = 0
    seed: int = 0
    root: int = 0
    cloud: int = 0
    layer: int = 0
    sky: int = 0
    area: int = 0
    wind: int = 0

    def clamp(self, document: Document) -> None:
        """Let every index mean something, or be 0."""
        content = document.content
        models, layers = content.models, content.layers
        self.model = _within(self.model, models)
        seeds = models[self.model].seeds if models else ()
        self.seed = _within(self.seed, seeds)
        self.root = _within(self.root, seeds[self.seed].roots if seeds else ())
        self.cloud = _within(self.cloud, content.clouds)
        self.layer = _within(self.layer, layers)
        self.sky = _within(self.sky, layers[self.layer].skies if layers else ())
        self.area = _within(self.area, content.rain_areas)
        self.wind = _within(self.wind, content.winds)


@dataclass(slots=True)
class Sunlight:
    """Where the sun of the cloud view stands."""

    azimuth: float = 130.0  # degrees clockwise from north
    elevation: float = 38.0  # degrees over the horizon


@dataclass(slots=True)
class Shared:
    """Selection, modes and notes; one for the life of the window."""

    gl: moderngl.Context
    selection: Selection = field(default_factory=Selection)
    modes: Modes = field(default_factory=Modes)
    sunlight: Sunlight = field(default_factory=Sunlight)
    number: int = 0  # which of the clouds that the model gives the view shows
    workspace: str = "cloud"  # or "sky"
    gizmo: str = "move"  # or "size", or "none"
    frame_wanted: bool = True  # the view is to bring the whole cloud into the picture
    sight_wanted: bool = False  # the same, if it is not in it
    focus: str = "model"  # what copy and paste mean: "model", "seed", "root", or another panel's
    dt: float = 1.0 / 60.0  # s of the machine's clock since the last frame
    moves: bool = True  # something will look different in the next frame, without an event
    note: str = ""
    note_age: float = 0.0  # s
    note_bad: bool = False
    studio: Studio | None = None  # the simulation; see `studio.studio_of`
    exports: Exports | None = None  # once something was exported

    def choose_model(self, index: int) -> None:
        """Edit another model, from its first seed on."""
        chosen = self.selection
        chosen.model, chosen.seed, chosen.root = index, 0, 0
        self.focus = "model"
        self.frame_wanted = True

    def say(self, text: str, *, bad: bool = False) -> None:
        """Show a line of text for a while; `bad` for what went wrong."""
        self.note, self.note_age, self.note_bad = text, 0.0, bad

    def pass_time(self, dt: float) -> None:
        """A frame has begun, `dt` seconds after the last."""
        self.dt, self.moves = dt, False
        self.note_age += dt
        if self.note_age > NOTE_LASTS * (2.0 if self.note_bad else 1.0):
            self.note = ""


class Panel(Protocol):
    """Something that is drawn into a window of the editor.

    It may also have `update(document, shared)`, called in every frame before anything is drawn
    whether the panel is seen or not, and `close()`, called once with the OpenGL context current.
    """

    title: str

    def draw(self, document: Document, shared: Shared) -> None:
        """Widgets, inside an imgui window that is already open."""


def _within(index: int, things: tuple[object, ...]) -> int:
    return min(max(index, 0), max(len(things) - 1, 0))
