"""The small map: rain areas, the way, cabin, pond, and where the player is; -z is up."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import pyglet
from pyglet.gl import GL_SCISSOR_TEST, glDisable, glEnable, glScissor
from pyglet.graphics import Group

from demo_game.place import Place
from demo_game.ui.envelope import ASPECT, Envelope
from demo_game.ui.theme import MARGIN, PADDING, TEXT_DIM, WARM, Frame, Layer, Rect, Rgba

EXTENT = (-88.0, -182.0, 88.0, 102.0)  # x0, z0, x1, z1, m
HEIGHT = 300.0  # units
RAIN_FULL = 60.0  # mm/h at which an area's blue is strongest

GROUND: Rgba = (52, 66, 50, 255)
WAY: Rgba = (176, 158, 120, 255)
WATER: Rgba = (74, 118, 146, 255)
HOUSE: Rgba = (196, 140, 92, 255)
RAIN: Rgba = (120, 176, 232, 255)


@dataclass(frozen=True)
class MapArea:
    """A rain area as the map shows it."""

    center: tuple[float, float]  # (x, z), m
    radii: tuple[float, float]  # m
    heading: float  # rad
    soft_edge: float  # m
    rain_rate: float  # mm/h


@dataclass(frozen=True)
class MapPlace:
    """What of the place is on the map."""

    way: Sequence[tuple[float, float]]  # (x, z), m
    cabin: tuple[float, float]
    pond: tuple[float, float]
    pond_radii: tuple[float, float]
    mailbox: tuple[float, float]


def map_place(place: Place) -> MapPlace:
    """What the map shows of a place."""
    return MapPlace(
        way=[tuple(point) for point in place.path[::2].tolist()],
        cabin=(place.room[0], place.room[2]),
        pond=place.pond.center,
        pond_radii=place.pond.radii,
        mailbox=(place.mailbox[0], place.mailbox[2]),
    )


class _Clip(Group):
    """Draws nothing outside a rectangle of the window."""

    def __init__(self, rect: Rect, ratio: float, order: int, parent: Group) -> None:
        super().__init__(order=order, parent=parent)
        self._box = [round(v * ratio) for v in (rect.x, rect.y, rect.width, rect.height)]

    def set_state(self) -> None:
        """Begin to clip."""
        glEnable(GL_SCISSOR_TEST)
        glScissor(*self._box)

    def unset_state(self) -> None:
        """Stop."""
        glDisable(GL_SCISSOR_TEST)

    def __eq__(self, other: object) -> bool:
        return self is other

    def __hash__(self) -> int:
        return id(self)


class Minimap:
    """A panel at the upper right."""

    def __init__(self, frame: Frame, place: MapPlace, ratio: float = 1.0) -> None:
        self._layer = layer = Layer(frame)
        px = frame.px
        x0, z0, x1, z1 = EXTENT
        pad = px(PADDING * 0.7)
        self._pixels = (px(HEIGHT) - 2 * pad) / (z1 - z0)  # px per m
        width, height = (x1 - x0) * self._pixels + 2 * pad, px(HEIGHT)
        self.panel = Rect(
            round(frame.width - px(MARGIN) - width), frame.height - px(MARGIN) - height,
            round(width), height,
        )  # fmt: skip
        inner = Rect(
            self.panel.x + pad, self.panel.y + pad,
            self.panel.width - 2 * pad, self.panel.height - 2 * pad,
        )  # fmt: skip
        self._left, self._top = inner.x, inner.top
        layer.panel(self.panel)
        clips = [_Clip(inner, ratio, order, layer.marks) for order in range(4)]
        self._ground, self._rain, self._things, self._player = clips
        self._add(
            pyglet.shapes.Rectangle(
                inner.x, inner.y, inner.width, inner.height,
                color=GROUND, batch=layer.batch, group=self._ground,
            )
        )  # fmt: skip
        self._draw_place(place)
        self._areas: list[tuple[pyglet.shapes.Ellipse, pyglet.shapes.Ellipse]] = []
        self._shown: list[MapArea] = []  # a shape is only touched when its area has changed
        arrow = px(8)
        self._arrow = pyglet.shapes.Triangle(
            arrow, 0, -arrow * 0.75, arrow * 0.72, -arrow * 0.75, -arrow * 0.72,
            color=WARM, batch=layer.batch, group=self._player,
        )  # fmt: skip
        self._add(self._arrow)
        self._ring = pyglet.shapes.Arc(
            0, 0, max(px(11), 8.0), segments=28, thickness=max(1.5, px(2)), closed=True,
            color=WARM, batch=layer.batch, group=self._player,
        )  # fmt: skip
        self._add(self._ring)
        layer.text(
            "N", inner.x + inner.width / 2, inner.top - px(10), 12,
            color=TEXT_DIM, anchor_x="center",
        )  # fmt: skip

    def to_map(self, x: float, z: float) -> tuple[float, float]:
        """Window px of a place (x, z)."""
        return self._left + (x - EXTENT[0]) * self._pixels, self._top - (
            z - EXTENT[1]
        ) * self._pixels

    def show(
        self,
        areas: list[MapArea],
        position: tuple[float, float],
        yaw: float,
        goal: tuple[float, float] | None = None,
    ) -> None:
        """Move what moves; a ring marks the goal (x, z), where there is one."""
        while len(self._areas) < len(areas):
            self._areas.append((self._ellipse(), self._ellipse()))
        if self._shown != areas:
            for index, pair in enumerate(self._areas):
                seen = index < len(areas)
                pair[0].visible = pair[1].visible = seen
                if seen and self._shown[index : index + 1] != [areas[index]]:
                    self._place_area(areas[index], *pair)
            self._shown = list(areas)
        self._arrow.position = self.to_map(*position)
        self._ring.visible = goal is not None
        if goal is not None and self._ring.position != self.to_map(*goal):
            self._ring.position = self.to_map(*goal)
        self._arrow.rotation = math.degrees(-yaw) - 90.0

    def draw(self) -> None:
        """Draw it."""
        self._layer.draw()

    def delete(self) -> None:
        """Give the GPU memory back."""
        self._layer.delete()

    def _place_area(
        self, area: MapArea, outer: pyglet.shapes.Ellipse, inner: pyglet.shapes.Ellipse
    ) -> None:
        strength = math.sqrt(min(area.rain_rate / RAIN_FULL, 1.0))
        at = self.to_map(*area.center)
        for shape, edge in ((outer, 0.0), (inner, min(area.soft_edge, 0.9 * area.radii[1]))):
            shape.position = at
            shape.a = (area.radii[0] - edge) * self._pixels
            shape.b = (area.radii[1] - edge) * self._pixels
            shape.rotation = -math.degrees(area.heading)
            shape.opacity = round(24 + 100 * strength) if area.rain_rate > 0.0 else 14

    def _ellipse(self) -> pyglet.shapes.Ellipse:
        shape = pyglet.shapes.Ellipse(
            0, 0, 1, 1, segments=48, color=RAIN, batch=self._layer.batch, group=self._rain
        )
        self._add(shape)
        return shape

    def _draw_place(self, place: MapPlace) -> None:
        layer, px = self._layer, self._layer.frame.px
        batch = layer.batch
        pond = pyglet.shapes.Ellipse(
            *self.to_map(*place.pond), *(radius * self._pixels for radius in place.pond_radii),
            segments=32, color=WATER, batch=batch, group=self._ground,
        )  # fmt: skip
        self._add(pond)
        way = [self.to_map(x, z) for x, z in place.way]
        self._add(
            pyglet.shapes.MultiLine(
                *way, thickness=max(1.5, px(2.5)), color=WAY, batch=batch, group=self._ground
            )
        )
        side = max(px(8), 6.0)
        x, y = self.to_map(*place.cabin)
        self._add(
            pyglet.shapes.Rectangle(
                x - side / 2, y - side / 2, side, side, color=HOUSE, batch=batch,
                group=self._things,
            )
        )  # fmt: skip
        wide = max(px(13), 10.0)
        x, y = self.to_map(*place.mailbox)
        Envelope(layer, x - wide / 2, y - wide * ASPECT / 2, wide, self._things)

    def _add(self, thing: object) -> None:
        self._layer.add(thing)
