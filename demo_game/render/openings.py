"""What of the picture the cabin's door and windows leave to whoever stands in its room."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from demo_game.place import Place, cabin

Frame = tuple[float, float, float, float]  # left, bottom, right, top, -1 to 1
WHOLE: Frame = (-1.0, -1.0, 1.0, 1.0)
NOTHING: Frame = (0.0, 0.0, 0.0, 0.0)
INSET = 0.1  # m from the walls, so that what is near is not cut


class Openings:
    """The openings as rectangles in the inner faces of the walls."""

    def __init__(self, place: Place) -> None:
        inset = cabin.WALL + INSET
        x, z = cabin.WIDTH / 2.0 - inset, cabin.DEPTH / 2.0 - inset
        self._low = place.cabin_origin + (-x, 0.0, -z)
        self._high = place.cabin_origin + (x, cabin.TOP - INSET, z)
        self._corners = place.cabin_origin + np.array(
            [_corners(*opening) for opening in (cabin.DOOR, *cabin.WINDOWS)]
        )

    def frame(self, camera: NDArray, view_projection: NDArray) -> Frame:
        """Where the outside may be seen; all of the picture from anywhere but the room."""
        if (camera < self._low).any() or (camera > self._high).any():
            return WHOLE
        found = [seen for corners in self._corners if (seen := _seen(corners, view_projection))]
        if not found:
            return NOTHING
        low, high = np.min(found, axis=0), np.max(found, axis=0)
        return float(low[0]), float(low[1]), float(high[2]), float(high[3])


def _corners(wall: str, low: float, high: float, first: int, last: int) -> NDArray:
    """(4, 3) corners of an opening, local, in order."""
    out, along, _, away = cabin.WALLS[wall]
    face = out * (away - cabin.WALL)
    bottom, top = cabin.UP * (first * cabin.ROW), cabin.UP * (last * cabin.ROW)
    sides = face + along * low, face + along * high
    return np.array([sides[0] + bottom, sides[1] + bottom, sides[1] + top, sides[0] + top])


def _seen(corners: NDArray, view_projection: NDArray) -> Frame | None:
    """The picture's part that a polygon is in; None where it is out of it."""
    clip = corners @ view_projection[:, :3].T + view_projection[:, 3]
    kept = []
    for here, after in zip(clip, np.roll(clip, -1, axis=0), strict=True):
        if here[3] > 1e-3:
            kept.append(here)
        if (here[3] > 1e-3) != (after[3] > 1e-3):
            share = (here[3] - 1e-3) / (here[3] - after[3])
            kept.append(here + (after - here) * share)
    if not kept:
        return None
    points = np.array([point[:2] / point[3] for point in kept])
    low, high = np.clip(points.min(0), -1.0, 1.0), np.clip(points.max(0), -1.0, 1.0)
    if (low >= high).any():
        return None
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])
