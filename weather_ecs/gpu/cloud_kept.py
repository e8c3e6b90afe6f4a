"""What is known of each cloud's picture, a row each."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

KEPT_DTYPE = np.dtype(
    [
        ("tile", "i4", 3),  # column, row, height; height 0: there is no picture
        ("old_tile", "i4", 3),
        ("share", "f4"),  # of the newer picture
        ("quad", "f8", (3, 3)),  # middle from the cloud's position, half width, half height, m
        ("old_quad", "f8", (3, 3)),
        ("cuts", "f4", 4),  # of the picture's corners, as PictureBounds has them
        ("old_cuts", "f4", 4),
        ("way", "f8", 3),  # from the camera to the cloud, when it was taken
        ("version", "i8"),  # of the shape's absorption
        ("shape", "i8"),  # the shape's key
        ("pixels", "f4"),  # of the scene, when it was taken, and what its tile should have been
        ("need", "f4"),
        ("stamp", "i8"),  # of sky and look
        ("state", "f4", 7),  # growth, mode, darkness, shear, shaded
        ("seen", "i8"),  # draw at which it was last in the picture
        ("real", "?"),  # drawn with billboards at the last draw
        ("large", "?"),  # and too large for a picture, not only waiting for one
    ]
)


def state_of(clouds: NDArray) -> NDArray[np.float64]:
    """(n, 7) the column `state` of clouds as they are now."""
    columns = (clouds["growth"], clouds["mode"], clouds["darkness"])
    return np.column_stack([*columns, clouds["shear"], clouds["shaded"]])
