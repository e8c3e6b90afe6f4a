"""The light of lightning as one camera has it: one place and colour for all flashes at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import FrameData, ViewData
from weather_ecs.physics.lightning import CHANNEL, falloff

HAZE = 0.12  # share of the light at the camera that the fog there shows
VEIL = 0.15  # and that rain shows so deep that nothing shines through
CLOUD_LIGHTS = 4  # flashes that light clouds each from its own place
CLOUD_CORE = 1100.0  # m, within which a flash in a cloud does not fall off
LEAST = 0.0005  # linear; less light than that is not seen on a cloud
CLOUD_GAIN = 1.2  # of a flash's light, next to it


class Flash(NamedTuple):
    """All flashes of a frame, as one."""

    place: NDArray  # (3,) m, of the one that is brightest at the camera
    source: NDArray  # (3,) linear RGB there
    here: NDArray  # (3,) linear RGB at the camera


def flash_of(frame: FrameData, position: tuple[float, float, float]) -> Flash | None:
    """What arrives at a camera; None while there is no lightning."""
    rows = frame.strikes
    if not len(rows):
        return None
    offset = rows["place"] - np.array(position)
    share = falloff((offset * offset).sum(axis=1))
    arriving = rows["light"] * share
    k = int(np.argmax(arriving))
    color = np.array(frame.lightning.color)
    total = float(arriving.sum())
    return Flash(rows["place"][k], color * (total / float(np.asarray(share)[k])), color * total)


def cloud_lights(frame: FrameData, position: tuple[float, float, float]) -> NDArray[np.float32]:
    """(2, m, 4): places from the camera, m, and 1/m2 of the core; linear RGB. m <= CLOUD_LIGHTS."""
    rows = frame.strikes
    if len(rows) > CLOUD_LIGHTS:
        rows = rows[np.argsort(-rows["light"], kind="stable")[:CLOUD_LIGHTS]]
    found = np.zeros((2, len(rows), 4), np.float32)
    if len(rows):
        found[0, :, :3] = rows["cloud_place"] - np.array(position)
        found[0, :, 3] = CLOUD_CORE**-2
        color = np.array(frame.lightning.color)
        found[1, :, :3] = CLOUD_GAIN * rows["light"][:, None] * color
    return found


def lit_by_flashes(view: ViewData, centers: NDArray, reach: NDArray) -> NDArray[np.bool_]:
    """(n,) whether clouds, places (n, 3) from the camera and m, show any of the flashes' light."""
    lit = np.zeros(len(centers), bool)
    places, colors = cloud_lights(view.frame, view.position)
    for place, color in zip(places, colors, strict=True):
        away = np.maximum(np.linalg.norm(centers - place[:3], axis=1) - reach, 0.0)
        lit |= color[:3].max() * (1.0 + away * away * place[3]) ** -1.5 > LEAST
    return lit


def block_flash(flash: Flash | None) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """`weather_flash_place` and `weather_flash_color` of the block WeatherAir."""
    if flash is None:
        return (0.0, 1.0, 0.0, CHANNEL**-2), (0.0, 0.0, 0.0, 0.0)
    return (*flash.place.tolist(), CHANNEL**-2), (*flash.source.tolist(), 0.0)
