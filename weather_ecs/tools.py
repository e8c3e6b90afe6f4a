"""For tools that look into a weather: maps, plots, editors of a game's own.

What `frame_of` gives is what the weather draws: plain arrays, read-only, in metres of the world.
`frame_of(weather).clouds` has a row for every cloud (`position`, `scale`, `shape`, ...), `.areas`
one for every rain area, `.cloud_shapes` the seeds and billboards that clouds stand with.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import CloudShapeData as CloudShapeData
from weather_ecs.frame import FrameData as FrameData
from weather_ecs.physics.climate import shares as sky_shares
from weather_ecs.physics.climate import state as climate_state
from weather_ecs.physics.cloud_images import CLOUD_IMAGES as CLOUD_IMAGES
from weather_ecs.weather import Weather

__all__ = [
    "CLOUD_IMAGES",
    "CloudShapeData",
    "FrameData",
    "climate_state",
    "cloud_images",
    "frame_of",
    "sky_shares",
]


def frame_of(weather: Weather) -> FrameData:
    """The weather as it is now; the same object as long as nothing changes.

    Raises ClosedError for a weather that is closed.
    """
    return weather.frame()


def cloud_images() -> NDArray[np.uint8]:
    """The images of billboards, (n, 256, 256, 4), in the order of their names in CLOUD_IMAGES.

    Texels are (relief x, relief y, shade, coverage); relief is 128 where the surface that is shown
    faces the viewer.
    """
    from weather_ecs.gpu.cloud_images import images

    return images()
