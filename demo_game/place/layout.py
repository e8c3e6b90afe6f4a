"""Where everything stands: plain numbers in metres, ground plane (x, z)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# Corners of the walk: dry land, the rain area's edge near (0, -25), past the cabin, the mailbox.
PATH = [
    (1.0, 96.0), (0.0, 78.0), (0.5, 66.0), (3.0, 46.0), (-1.5, 24.0), (-1.0, 2.0), (0.5, -24.0),
    (0.0, -40.0), (-2.0, -52.0), (-5.0, -66.0), (-8.0, -86.0), (-9.5, -104.0), (-13.0, -124.0),
    (-19.0, -144.0), (-23.4, -156.0), (-24.2, -158.4),
]  # fmt: skip
SPUR = [(-0.6, -46.0), (2.6, -51.0), (5.4, -54.4), (6.0, -56.4)]  # from the path to the steps
WHEEL_TRACK = [(-7.0, -80.0), (4.0, -84.0), (18.0, -83.0), (29.5, -84.5)]  # to the windmill

CABIN = (6.0, -62.0)  # middle of the room, door on the +z side
WINDMILL = (35.0, -85.0)
POND = (-28.0, -70.0)
POND_RADII = (13.0, 9.0)
JETTY = (-18.4, -12.9), -68.6  # ends along x, and z, m
MAILBOX = (-25.0, -160.0)
BENCH, BENCH_FACING = (-6.4, -50.2), 1.1  # (x, z); rad about +y
WOODPILE = (2.65, -62.4)
FLAG = (1.6, -57.8)
# Where one stands to look along the sight posts, and their bearing from north over east, rad.
SIGHT_FROM, SIGHT_BEARING = (0.0, 88.0), 5.515

LAMPS = [
    (2.6, 61.0), (-1.6, 41.0), (1.3, 17.0), (-3.2, -4.0), (2.8, -27.0), (-3.4, -47.5),
    (-10.6, -83.0), (-9.2, -118.0),
]  # fmt: skip

FIGURE_LOOP = [
    (-4.4, -54.0), (3.0, -53.2), (11.0, -52.6), (15.6, -57.5), (15.4, -66.0), (10.0, -71.5),
    (1.5, -71.0), (-3.2, -64.0),
]  # fmt: skip

# Posts every 2.4 m along each line.
FENCES = [
    [(-7.0, 52.0), (-5.5, 34.0), (-6.5, 18.0), (-7.2, 4.0)],
    [(22.5, -71.0), (36.0, -66.5), (50.0, -71.0), (53.0, -84.0), (49.0, -98.0), (36.0, -102.0)],
    [(-15.5, -112.0), (-21.0, -127.0), (-27.5, -142.0)],
]

# Trees that compose the view: (x, z, kind, height m); the rest is scattered.
CONIFER, BROADLEAF, BIRCH, BUSH = range(4)
TREES = [
    (-15.0, 47.0, BROADLEAF, 10.5), (15.5, 50.0, CONIFER, 14.0), (20.5, 44.0, CONIFER, 10.5),
    (13.5, 27.0, BIRCH, 8.5), (17.5, 24.0, BIRCH, 9.5), (-21.0, 22.0, CONIFER, 12.0),
    (-26.0, 29.0, CONIFER, 14.5), (-30.0, 8.0, BROADLEAF, 9.5), (27.0, 3.0, CONIFER, 13.0),
    (32.0, 9.0, CONIFER, 15.0), (-19.0, -22.0, CONIFER, 12.5), (-24.0, -28.0, CONIFER, 15.0),
    (-30.0, -24.0, CONIFER, 10.0), (22.0, -30.0, BROADLEAF, 10.0), (30.0, -38.0, CONIFER, 13.0),
    (15.0, -76.5, CONIFER, 14.5), (9.5, -79.0, CONIFER, 17.0), (20.5, -74.5, CONIFER, 11.5),
    (-12.5, -61.0, BIRCH, 8.0), (-43.5, -63.0, BIRCH, 9.5), (-45.0, -72.0, BIRCH, 8.0),
    (-37.5, -83.0, BROADLEAF, 9.0), (-22.0, -85.5, CONIFER, 12.0), (-48.0, -82.0, CONIFER, 15.0),
    (-50.0, -55.0, CONIFER, 13.0), (6.0, -96.0, BROADLEAF, 10.5), (-24.0, -101.0, CONIFER, 14.0),
    (-29.0, -108.0, CONIFER, 11.0), (2.0, -119.0, CONIFER, 14.0), (-2.5, -134.0, BIRCH, 9.0),
    (-33.0, -150.0, BROADLEAF, 9.0), (-36.0, -164.0, CONIFER, 13.0), (-14.5, -168.0, CONIFER, 15.0),
]  # fmt: skip
BUSHES = [  # (x, z, height m)
    (-9.6, 50.0, 1.5), (-11.2, 51.6, 1.1), (9.5, 55.5, 1.2), (11.3, 53.9, 1.7), (-8.6, 31.5, 1.3),
    (7.4, 37.8, 1.0), (10.6, 20.8, 1.5), (12.4, 18.9, 1.0), (-11.5, 14.6, 1.4), (9.3, -0.8, 1.2),
    (-8.2, -13.6, 1.6), (-9.8, -15.0, 1.1), (8.6, -24.2, 1.3), (12.6, -58.4, 1.1),
    (18.4, -71.2, 1.5), (2.6, -74.8, 1.2), (-1.9, -72.3, 1.6), (-11.8, -74.0, 1.3),
    (-15.2, -62.2, 1.2), (-14.3, -79.8, 1.4), (-39.0, -58.4, 1.5), (-42.4, -77.0, 1.6),
    (1.0, -92.6, 1.3), (-2.8, -107.6, 1.4), (-14.6, -105.8, 1.1), (-6.0, -127.0, 1.5),
    (-24.2, -139.0, 1.3), (-16.0, -150.8, 1.2), (-29.2, -153.6, 1.5), (28.4, -73.6, 1.4),
    (41.2, -90.4, 1.2), (24.0, -95.6, 1.6), (15.2, 58.2, 1.3), (-17.2, 61.0, 1.6),
]  # fmt: skip


def smooth_line(corners: list[tuple[float, float]], closed: bool = False, step: int = 8) -> NDArray:
    """(n, 2) Catmull-Rom curve through the corners, `step` points a span."""
    p = np.asarray(corners, "f8")
    if closed:
        p = np.concatenate([p[-1:], p, p[:2]])
    else:
        p = np.concatenate([2 * p[:1] - p[1:2], p, 2 * p[-1:] - p[-2:-1]])
    t = np.linspace(0.0, 1.0, step, endpoint=False)[:, None]
    spans = []
    for a, b, c, d in zip(p, p[1:], p[2:], p[3:], strict=False):
        spans.append(
            b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))
        )
    spans.append(p[-2:-1])
    return np.concatenate(spans)


def distance_to_line(points: NDArray, line: NDArray) -> NDArray:
    """(n,) distance of (n, 2) points from a polyline, m."""
    best = np.full(len(points), np.inf)
    for a, b in zip(line[:-1], line[1:], strict=True):
        edge = b - a
        t = np.clip((points - a) @ edge / (edge @ edge), 0.0, 1.0)
        best = np.minimum(best, np.sum((points - a - t[:, None] * edge) ** 2, axis=1))
    return np.sqrt(best)
