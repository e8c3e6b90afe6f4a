"""`MapFrame`: the world from above as a picture has it, and what of it the mouse can take."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

from weather_ecs.components import RainArea
from weather_ecs.components.rain_area import GREATEST_RADIUS, SMALLEST_RADIUS

CLOSEST, WIDEST = 0.02, 50_000.0  # m of a pixel
ROOM = 1.12  # of what is brought into the picture
HANDLE = 9.0  # pixels from a handle at which the mouse takes it

Point = tuple[float, float]


class Handle(NamedTuple):
    """Something of a rain area that can be dragged."""

    area: int  # index of it
    part: str  # "middle", "long", "short" or "turn"
    at: Point  # pixels


@dataclass(slots=True)
class MapFrame:
    """Which place of the world is where in a picture; east is to the right, north up."""

    x: float = 0.0  # m, in the middle of the picture
    z: float = 0.0
    scale: float = 50.0  # m of a pixel
    left: float = 0.0  # pixels, of the picture in the window
    top: float = 0.0
    width: float = 1.0
    height: float = 1.0

    def place(self, left: float, top: float, width: float, height: float) -> None:
        """Where the picture is now."""
        self.left, self.top = left, top
        self.width, self.height = max(width, 1.0), max(height, 1.0)

    def pixel(self, x: float, z: float) -> Point:
        """Where a place is in the window: -z is up."""
        return (
            self.left + 0.5 * self.width + (x - self.x) / self.scale,
            self.top + 0.5 * self.height + (z - self.z) / self.scale,
        )

    def world(self, px: float, py: float) -> Point:
        """(x, z) in m of a pixel of the window."""
        return (
            self.x + (px - self.left - 0.5 * self.width) * self.scale,
            self.z + (py - self.top - 0.5 * self.height) * self.scale,
        )

    def pan(self, dx: float, dy: float) -> None:
        """Move along by a drag of so many pixels."""
        self.x -= dx * self.scale
        self.z -= dy * self.scale

    def zoom(self, notches: float, px: float, py: float) -> None:
        """Come nearer by so many notches of the wheel; what is under the mouse stays there."""
        x, z = self.world(px, py)
        self.scale = min(max(self.scale * 0.85 ** min(max(notches, -50.0), 50.0), CLOSEST), WIDEST)
        there = self.world(px, py)
        self.x += x - there[0]
        self.z += z - there[1]

    def show(self, low: Point, high: Point) -> None:
        """Bring a rectangle of the world into the picture."""
        self.x, self.z = 0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])
        wanted = max((high[0] - low[0]) / self.width, (high[1] - low[1]) / self.height)
        self.scale = min(max(ROOM * wanted, CLOSEST), WIDEST)

    def spacing(self, pixels: float = 110.0) -> float:
        """m between lines of a grid: 1, 2 or 5 times a power of ten, near so many pixels."""
        wanted = self.scale * pixels
        power = 10.0 ** math.floor(math.log10(wanted))
        return min((1.0, 2.0, 5.0, 10.0), key=lambda k: abs(math.log(k * power / wanted))) * power

    def rim(self, area: RainArea, points: int = 48) -> list[Point]:
        """The rim of an area, pixels."""
        return [self.pixel(*along(area, math.tau * k / points)) for k in range(points)]

    def handles(self, index: int, area: RainArea) -> list[Handle]:
        """What of an area the mouse can take."""
        ahead, across = along(area, 0.0), along(area, 0.5 * math.pi)
        reach = 1.0 + 26.0 * self.scale / area.radii[0]
        x, z = area.center
        turn = (x + (ahead[0] - x) * reach, z + (ahead[1] - z) * reach)
        return [
            Handle(index, "middle", self.pixel(x, z)),
            Handle(index, "long", self.pixel(*ahead)),
            Handle(index, "short", self.pixel(*across)),
            Handle(index, "turn", self.pixel(*turn)),
        ]

    def grasp(
        self, areas: tuple[RainArea, ...], chosen: int, px: float, py: float
    ) -> Handle | None:
        """What the mouse would take there: a handle of the chosen area, or an area by its inside.

        Of several the smallest.
        """
        if 0 <= chosen < len(areas):
            found = [
                (math.dist(handle.at, (px, py)), handle)
                for handle in self.handles(chosen, areas[chosen])
            ]
            away, handle = min(found, key=lambda each: each[0])
            if away <= HANDLE:
                return handle
        x, z = self.world(px, py)
        inside = [
            (area.radii[0] * area.radii[1], index)
            for index, area in enumerate(areas)
            if covers(area, x, z)
            or math.dist(self.pixel(*area.center), (px, py)) <= HANDLE  # a speck on this scale
        ]
        return Handle(min(inside)[1], "middle", (px, py)) if inside else None


def along(area: RainArea, angle: float) -> Point:
    """(x, z) on the rim of an area, `angle` rad from its heading."""
    a, b = area.radii
    u, v = a * math.cos(angle), b * math.sin(angle)
    c, s = math.cos(area.heading), math.sin(area.heading)
    # Headings are counter-clockwise seen from above, where z points down.
    return area.center[0] + u * c - v * s, area.center[1] - u * s - v * c


def covers(area: RainArea, x: float, z: float) -> bool:
    """Whether a place is inside an area."""
    dx, dz = x - area.center[0], z - area.center[1]
    c, s = math.cos(area.heading), math.sin(area.heading)
    u, v = dx * c - dz * s, dx * s + dz * c
    return (u / area.radii[0]) ** 2 + (v / area.radii[1]) ** 2 <= 1.0


def dragged(area: RainArea, part: str, to: Point, grip: Point = (0.0, 0.0)) -> RainArea:
    """An area one of whose handles was dragged to a place; `grip` is where its middle was taken.

    The first radius is never the smaller one: where the two would meet, the other gives way.
    """
    x, z = to
    if part == "middle":
        return replace(area, center=(x - grip[0], z - grip[1]))
    dx, dz = x - area.center[0], z - area.center[1]
    if part == "turn":
        return replace(area, heading=math.atan2(-dz, dx))
    c, s = math.cos(area.heading), math.sin(area.heading)
    wanted = abs(dx * c - dz * s) if part == "long" else abs(dx * s + dz * c)
    wanted = min(max(wanted, SMALLEST_RADIUS), GREATEST_RADIUS)
    a, b = area.radii
    if part == "long":
        return replace(area, radii=(wanted, min(b, wanted)))
    return replace(area, radii=(max(a, wanted), wanted))
