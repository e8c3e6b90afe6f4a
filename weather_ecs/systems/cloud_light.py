"""`CloudLightSystem`: how much light the seeds of clouds lose, one cloud in a frame."""

from __future__ import annotations

import math

from weather_ecs.components import Sun
from weather_ecs.frame import SkyLight
from weather_ecs.systems.cloud_shapes import Shape, ShapeLibrary, Vector
from weather_ecs.systems.queries import alive
from weather_ecs.systems.state import WeatherState


class CloudLightSystem:
    """Lights clouds that are new, and again those whose light has moved, in turn.

    Clouds of a layer share their shapes, so this is once for all clouds that stand with a shape.
    Where nobody draws, nobody needs it.
    """

    def run(self, state: WeatherState) -> None:
        """One frame."""
        library = state.cloud_shapes
        library.computed = 0
        if state.drawn and len(library):
            light = sun_direction(state)
            for _ in range(library.budget):
                if not light_one(library, light):
                    break
                library.computed += 1


def sun_direction(state: WeatherState) -> Vector:
    """Unit vector towards the sun, wherever it stands; of an atmosphere as of the last frame."""
    if state.light_direction is not None:
        return state.light_direction
    for _, sun in alive(Sun, state.uids):
        return sun.direction
    return SkyLight().sun_direction


def light_one(library: ShapeLibrary, light: Vector) -> bool:
    """Light one shape, or follow some rays of a large one; whether there was any to light."""
    new = library.unlit()
    if new is not None:
        library.light_new(new, light)
        return True
    close = math.cos(0.25 * library.angle)
    if library.settled is not None and not moved(library.settled, light, close):
        return False  # nothing was stale for a light as near as this
    each = _next_stale(library, light)
    if each is None:
        library.settled = light
        return False
    library.settled = None  # there may be more
    if library.relight(each, light):
        library.last = each.key
    return True


def _next_stale(library: ShapeLibrary, light: Vector) -> Shape | None:
    """The one that is being lit in parts, or the next after the last one whose light has moved."""
    shapes = library.shapes()
    for each in shapes:
        if each.target is not None:
            return each
    limit = math.cos(library.angle)
    lit = [each for each in shapes if each.data is not None]
    stale = [each for each in lit if each.data and moved(each.data.light, light, limit)]
    after = [each for each in stale if each.key > library.last]
    return min(after or stale, key=lambda each: each.key, default=None)


def moved(before: Vector, now: Vector, limit: float) -> bool:
    """Whether the cosine between two vectors is below a limit, which is more than 0."""
    across, one, other = (
        p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
        for p, q in ((before, now), (before, before), (now, now))
    )
    # A direction that someone has written down is rarely quite of the length 1; (0, 0, 0), for no
    # direction in particular, has moved in any case.
    return across <= 0.0 or across < limit * math.sqrt(one * other)
