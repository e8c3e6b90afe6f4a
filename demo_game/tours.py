"""Scripted ways through the place: a pose for every moment, the same at any frame rate.

`walk` shows every stage within the time it is given: it goes as fast as that needs, each stage
having its share of the time (`WALK`); so do those of the sky. `run` and `crossing` move at a true
speed.
"""

from __future__ import annotations

import numpy as np

from demo_game.curve import Smooth
from demo_game.player import RUN_SPEED, Ground
from demo_game.route import Glance, Key, Look, Route, stage_at
from demo_game.tour import WALKING, Tour, WalkTour
from demo_game.tour_sky import clouds_tour, night_tour, snow_tour, storm_tour

TOURS = ("walk", "run", "crossing", "still", "clouds", "snow", "storm", "night")

EDGE_Z = -25.0  # m, where the way crosses the perimeter of the rain area
CURTAIN = (0.0, 16.0, -60.0)  # what one looks at from outside
OUT_OF_DOOR = (9.6, 1.3, -50.0)
BACK = (12.0, 14.0, -70.0)

# The whole way: along the path, up the steps, into the cabin and back out of its only door, and
# on along the path. A key names a corner, so a change here needs a look at WALK.
WAY = (
    (0.4, 68.0), (0.9, 62.0), (3.0, 46.0), (-1.5, 24.0), (-1.0, 2.0), (0.2, -14.0), (0.5, -24.0),
    (0.0, -38.0), (2.2, -49.6), (6.0, -54.6), (6.0, -62.9), (6.0, -54.6), (2.6, -51.8),
    (-2.6, -55.0), (-5.0, -66.0), (-8.0, -86.0), (-9.5, -104.0), (-13.0, -122.0), (-14.8, -130.0),
)  # fmt: skip
TURN = 10  # the corner inside the cabin, where the way goes back
# The shares of the time leave most of it to the edge and to the cabin.
WALK = (
    Key(0.00, 0, "far"),
    Key(0.07, 1, "approach"),
    Key(0.22, 4),
    Key(0.27, 5, "edge"),
    Key(0.39, 7, "inside"),
    Key(0.49, 9, "cabin"),
    Key(0.55, TURN),
    Key(0.67, TURN, "out"),
    Key(0.725, 11),
    Key(0.77, 13, "leaving"),
    Key(0.87, 16),
    Key(0.93, 17, "looking back"),
    Key(0.97, 18),
    Key(1.00, 18),
)
GLANCES = (
    Glance(0.00, CURTAIN),
    Glance(0.07, CURTAIN),
    Glance(0.20),
    Glance(0.515),
    Glance(0.61, OUT_OF_DOOR),
    Glance(0.675, OUT_OF_DOOR),
    Glance(0.775),
    Glance(0.90),
    Glance(0.98, BACK),
    Glance(1.00, BACK),
)
RUN = ((0.0, 5.0), (0.0, -36.0), (-12.0, -60.0), (-12.0, -115.0), (-20.0, -150.0))
CROSSING = ((0.0, EDGE_Z + 12.0), (0.0, EDGE_Z - 24.0))
STILL = (-4.0, -44.0)
STILL_LOOK = (6.0, 2.2, -62.0)


def make_tour(name: str, ground: Ground, duration: float, speed: float = WALKING) -> Tour:
    """A tour of that name that lasts `duration` seconds; `speed` (m/s) is for `crossing`."""
    duration = max(duration, 1e-6)
    if name == "walk":
        return _walk(ground, duration)
    if name == "run":
        return _straight("run", ground, RUN, RUN_SPEED)
    if name == "crossing":
        return _straight("crossing", ground, CROSSING, speed)
    if name == "still":
        return _still(ground)
    if name == "clouds":
        return clouds_tour(ground, duration)
    if name == "snow":
        return snow_tour(ground, duration)
    if name == "storm":
        return storm_tour(ground, duration)
    if name == "night":
        return night_tour(ground, duration)
    raise ValueError(f"tour: got {name!r}, allowed: {', '.join(TOURS)}")


def _walk(ground: Ground, duration: float) -> Tour:
    route = Route(ground, WAY, rounding=4.0, turns=(TURN,))
    corners = route.path.corner_lengths
    along_share = Smooth([key.u for key in WALK], [corners[key.corner] for key in WALK])
    look = Look.between(route, along_share, GLANCES)
    return WalkTour(
        "walk",
        route,
        lambda time: along_share(time / duration),
        lambda time: look(time / duration),
        lambda time: stage_at(WALK, time / duration),
        hurried=route.path.length / duration > RUN_SPEED / 2,
    )


def _straight(
    name: str, ground: Ground, points: tuple[tuple[float, float], ...], speed: float
) -> Tour:
    route = Route(ground, list(points), rounding=4.0)
    length = route.path.length

    def along(time: float) -> float:
        return min(max(time * speed, 0.0), length)

    def stage(time: float) -> str:
        return "outside" if route.path(along(time))[1] > EDGE_Z else "inside"

    look = Look.ahead(route)
    return WalkTour(name, route, along, lambda time: look(along(time) / length), stage)


def _still(ground: Ground) -> Tour:
    x, z = STILL
    route = Route(ground, [(x, z), (x, z - 1.0)], rounding=0.0)
    eye = np.array(route.eye(0.0))
    look = Look.towards(np.array(STILL_LOOK) - eye)
    return WalkTour("still", route, lambda time: 0.0, look, lambda time: "still")
