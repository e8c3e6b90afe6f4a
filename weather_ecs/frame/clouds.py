"""Clouds as a frame has them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

CLOUD_DTYPE = np.dtype(
    [
        ("key", "i8"),  # stable for the life of the cloud; only ever compared
        ("shape", "i8"),  # index into FrameData.cloud_shapes
        ("position", "f8", 3),  # m, of the shape's centre
        ("velocity", "f8", 3),  # m/s
        ("scale", "f4"),  # factor on the shape
        ("mirror", "f4"),  # 1 or -1: factor on the shape's x
        ("heading", "f4"),  # rad, the shape turned about +y
        ("shear", "f4", 2),  # (x, z), m of lean per m above the centre
        ("growth", "f4"),  # 0 gone to 1 whole
        ("mode", "f4"),  # of dissolving: 0 from the rim inwards, 1 from the inside out
        ("opacity", "f4"),  # 0 to 1
        ("darkness", "f4"),  # 0 fair to 1: of the base, by how deep the cloud is and its rain
        ("flash", "f4"),  # light from inside, 0 but while lightning is in it
        ("shaded", "f4", 2),  # 0 to 1: what other clouds take of the sun's light, and of the sky's
    ]
)

BILLBOARD_DTYPE = np.dtype(
    [
        ("position", "f4", 3),  # m, from the cloud's centre
        ("size", "f4", 2),  # m, width and height
        ("turn", "f4"),  # rad, in the plane of the picture
        ("image", "i4"),  # of the array of cloud images
        ("seed", "i4"),  # index of the seed it stands in
        ("order", "f4"),  # 0 to 1: when it comes and goes while the cloud grows or dissolves
        ("opacity", "f4"),  # 0 to 1
    ]
)


@dataclass(frozen=True, slots=True, eq=False)
class CloudShapeData:
    """One cloud that a model gave, about its centre; many clouds may stand in the sky with it."""

    key: int  # stable for the life of the shape; only ever compared
    centers: NDArray  # (s, 3) float32, m, of the seeds' boxes
    sizes: NDArray  # (s, 3) float32, m, whole widths
    absorbed: NDArray  # (s,) float32, 0 to 1, of each seed for `light`; a new array when computed
    light: tuple[float, float, float]  # unit, towards the light that `absorbed` is for
    billboards: NDArray  # BILLBOARD_DTYPE, (n,)
    radius: float  # m, of the sphere round the centre that holds every seed
    penetration: float  # m, that light goes inside before all of it is absorbed; may be inf


@dataclass(frozen=True, slots=True)
class CloudLook:
    """Looks of the clouds; see `components.CloudShading`."""

    plain: bool = False  # the dissertation's own light and nothing else
    rays: bool = False  # show the absorption rays
    silver: float = 1.0  # strength of the lining towards the sun
    base: float = 1.0  # darkness of the bases
    ambient: float = 1.0  # factor on the light of sky and ground
    softness: float = 1.0  # factor on the depth over which a billboard fades at what it meets
    shadows: bool = True
