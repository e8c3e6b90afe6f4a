"""One look for everything that is drawn over the picture: colours, font, sizes, panels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pyglet
from pyglet.graphics import Batch, Group

Rgba = tuple[int, int, int, int]

PANEL: Rgba = (14, 19, 26, 190)
PANEL_EDGE: Rgba = (150, 175, 200, 46)
ROW_CHOSEN: Rgba = (120, 170, 215, 62)
SHADE: Rgba = (6, 9, 13, 120)  # over the whole picture behind a menu
TEXT: Rgba = (238, 242, 246, 255)
TEXT_DIM: Rgba = (168, 180, 193, 255)
ACCENT: Rgba = (140, 200, 245, 255)
WARM: Rgba = (250, 196, 112, 255)

FONTS = ("Segoe UI", "Helvetica Neue", "Noto Sans", "DejaVu Sans", "Arial")

REFERENCE = (1280.0, 720.0)  # px, the window that the layouts' units are pixels of
SMALLEST, GREATEST = 0.6, 2.5  # scale; the layouts fit 640x360 at 0.6
SMALLEST_TEXT = 9.5  # px

MARGIN = 18.0  # units, between panels and the window's edge
PADDING = 14.0  # units, between a panel's edge and its text
RADIUS = 9.0  # units, of a panel's corners


@dataclass(frozen=True)
class Frame:
    """The window as the layouts see it: its size in px and the px of one unit."""

    width: int
    height: int

    @property
    def scale(self) -> float:
        """Pixels per unit."""
        wanted = min(self.width / REFERENCE[0], self.height / REFERENCE[1])
        return min(max(wanted, SMALLEST), GREATEST)

    def px(self, units: float) -> float:
        """Whole pixels of so many units."""
        return float(round(units * self.scale))


@dataclass(frozen=True)
class Rect:
    """A rectangle in px, origin at the window's lower left."""

    x: float
    y: float
    width: float
    height: float

    def holds(self, x: float, y: float) -> bool:
        """Whether a point lies in it."""
        return self.x <= x < self.x + self.width and self.y <= y < self.y + self.height

    @property
    def top(self) -> float:
        return self.y + self.height

    @property
    def right(self) -> float:
        return self.x + self.width


class Text:
    """A label that is laid out anew only when its text or colour changes."""

    def __init__(
        self,
        frame: Frame,
        text: str,
        x: float,
        y: float,
        size: float,
        *,
        batch: Batch,
        group: Group,
        color: Rgba = TEXT,
        anchor_x: str = "left",
        anchor_y: str = "center",
        bold: bool = False,
        width: float | None = None,
    ) -> None:
        self._label = pyglet.text.Label(
            text,
            x=round(x),
            y=round(y),
            font_name=list(FONTS),
            font_size=max(size * frame.scale, SMALLEST_TEXT) * 0.75,  # from pixels to points
            weight="bold" if bold else "normal",
            color=color,
            anchor_x=anchor_x,
            anchor_y=anchor_y,
            width=None if width is None else round(width),
            multiline=width is not None,
            batch=batch,
            group=group,
            dpi=96,
        )
        self._text, self._color = text, color

    def set(self, text: str, color: Rgba | None = None) -> None:
        """Show another text."""
        if text != self._text:
            self._text = self._label.text = text
        if color is not None and color != self._color:
            self._color = self._label.color = color

    @property
    def width(self) -> float:
        """Width of the text in px."""
        return float(self._label.content_width)

    @property
    def height(self) -> float:
        """Height of the text in px."""
        return float(self._label.content_height)

    def move(self, x: float, y: float) -> None:
        """Put it elsewhere, px."""
        self._label.position = (round(x), round(y), 0)

    def delete(self) -> None:
        """Give its GPU memory back."""
        self._label.delete()


class Layer:
    """A batch with three depths: panels, marks on them, text; everything in it goes together."""

    def __init__(self, frame: Frame) -> None:
        self.frame = frame
        self.batch = Batch()
        self.back = Group(order=0)
        self.marks = Group(order=1)
        self.front = Group(order=2)
        self.panels: list[Rect] = []
        self._things: list[Any] = []

    def text(self, text: str, x: float, y: float, size: float, **options: object) -> Text:
        """A line of text; x and y in px, size in units."""
        label = Text(self.frame, text, x, y, size, batch=self.batch, group=self.front, **options)  # type: ignore[arg-type]
        self._things.append(label)
        return label

    def panel(self, rect: Rect, color: Rgba = PANEL) -> None:
        """A rounded, translucent panel with a thin edge."""
        self.panels.append(rect)
        radius = self.frame.px(RADIUS)
        for grow, shade in ((1.0, PANEL_EDGE), (0.0, color)):
            self.add(
                pyglet.shapes.RoundedRectangle(
                    rect.x - grow,
                    rect.y - grow,
                    rect.width + 2 * grow,
                    rect.height + 2 * grow,
                    radius + grow,
                    segments=10,
                    color=shade,
                    batch=self.batch,
                    group=self.back,
                )
            )

    def add(self, thing: Any) -> Any:
        """Keep a shape that was put into the batch."""
        self._things.append(thing)
        return thing

    def draw(self) -> None:
        """Draw everything in it."""
        self.batch.draw()

    def delete(self) -> None:
        """Give all its GPU memory back."""
        for thing in self._things:
            thing.delete()
        self._things.clear()
