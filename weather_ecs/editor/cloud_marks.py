"""What the cloud view shows besides billboards: seeds, absorption rays, roots."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from weather_ecs.components import CloudModel, CloudRoot, CloudSeed
from weather_ecs.editor.cloud_stage import Posed
from weather_ecs.editor.marks import Sketch
from weather_ecs.editor.shared import Modes

OWN = (0.36, 0.66, 1.0)  # the model's seeds
ADDED = (0.45, 0.58, 0.78)  # those that roots have added
CHOSEN = (1.0, 0.72, 0.25)
ROOT = (0.35, 0.90, 0.62)
AXES = ((0.93, 0.33, 0.36), (0.48, 0.80, 0.30), (0.30, 0.58, 0.95))  # x, y, z
LIT, DARK = np.array([1.0, 0.93, 0.35]), np.array([0.85, 0.12, 0.10])  # of rays
_ARC = 13  # points of an arc


def sketch(posed: Posed, model: CloudModel, modes: Modes, seed: int, root: int) -> Sketch:
    """Marks of the cloud in the model's axes, m; `seed` and `root` are the chosen ones."""
    result = Sketch()
    shape = posed.shape
    centers = shape.centers.astype(np.float64) + posed.middle
    sizes = shape.sizes.astype(np.float64)
    own = np.zeros(len(centers), bool)
    own[list(posed.own)] = True
    chosen = posed.own[seed] if seed < len(posed.own) else None
    if modes.boxes:
        _seeds(result, centers, sizes, own, chosen)
        _axes(result, posed.middle, 0.35 * shape.radius)
    if modes.rays:
        _rays(result, centers, shape.absorbed, shape.light, posed.middle, shape.radius)
    if modes.roots:
        result.add(_roots(model.seeds, seed, root))
    if chosen is not None and not modes.boxes and (modes.roots or modes.rays):
        pick = slice(chosen, chosen + 1)
        result.boxes(centers[pick], sizes[pick], (*CHOSEN, 0.9), 1.5)
    return result


def _seeds(
    result: Sketch, centers: NDArray, sizes: NDArray, own: NDArray, chosen: int | None
) -> None:
    if (~own).any():
        result.boxes(centers[~own], sizes[~own], (*ADDED, 0.38), 1.0)
    rest = own.copy()
    if chosen is not None:
        rest[chosen] = False
    result.faces(centers[rest], sizes[rest], (*OWN, 0.05))
    result.boxes(centers[rest], sizes[rest], (*OWN, 0.95), 1.4)
    if chosen is not None:
        pick = slice(chosen, chosen + 1)
        result.faces(centers[pick], sizes[pick], (*CHOSEN, 0.06))
        result.boxes(centers[pick], sizes[pick], (*CHOSEN, 1.0), 2.2)


def _axes(result: Sketch, middle: NDArray, length: float) -> None:
    """The cloud's centre and its axes, as the dissertation's figure 28 has them."""
    for axis, color in enumerate(AXES):
        tip = middle.copy()
        tip[axis] += length
        _arrow(result, middle, tip, (*color, 0.95), 2.0)


def _rays(
    result: Sketch,
    centers: NDArray,
    absorbed: NDArray,
    light: tuple[float, float, float],
    middle: NDArray,
    radius: float,
) -> None:
    """From the seeds' centres towards the light until they leave the cloud's sphere."""
    way = np.array(light)
    back = centers - middle
    along = back @ way
    reach = -along + np.sqrt(np.maximum(along**2 - (back**2).sum(axis=1) + radius**2, 0.0))
    share = np.clip(absorbed.astype(np.float64), 0.0, 1.0)[:, None]
    color = np.concatenate([LIT + share * (DARK - LIT), np.full_like(share, 0.9)], axis=1)
    ends = centers + way * (np.maximum(reach, 0.0) + 0.25 * radius)[:, None]
    result.lines(centers, ends, color, 1.6)
    # A small cross in each centre shows where its ray begins, seen from any side.
    arm = 0.02 * radius
    for axis in range(3):
        step = np.zeros(3)
        step[axis] = arm
        result.lines(centers - step, centers + step, color, 2.0)


@lru_cache(maxsize=1)
def _roots(seeds: tuple[CloudSeed, ...], chosen_seed: int, chosen_root: int) -> Sketch:
    """All roots; kept while the seeds are the same ones, whatever else of the model changes."""
    result = Sketch()
    for index, each in enumerate(seeds):
        for number, one in enumerate(each.roots):
            _root(result, each, one, chosen=(index, number) == (chosen_seed, chosen_root))
    return result


def _root(result: Sketch, seed: CloudSeed, root: CloudRoot, *, chosen: bool) -> None:
    """An arrow to its last level, and the rim of its opening at the first."""
    color = (*(CHOSEN if chosen else ROOT), 1.0 if chosen else 0.75)
    thin = (*color[:3], 0.85 if chosen else 0.45)
    center = np.array(seed.center)
    radius = 0.5 * math.hypot(*seed.size)
    levels = max(root.reproductions_max, 1)
    far = min(levels, 1000) * radius
    tip = center + far * direction(root.pitch, root.yaw)
    _arrow(result, center, tip, color, 2.6 if chosen else 1.8)
    low, high = root.pitch - 0.5 * root.open_pitch, root.pitch + 0.5 * root.open_pitch
    left, right = root.yaw - 0.5 * root.open_yaw, root.yaw + 0.5 * root.open_yaw
    pitches, yaws = np.linspace(low, high, _ARC), np.linspace(left, right, 2 * _ARC)
    for pitch in (low, high) if root.open_pitch else (low,):
        result.path(center + radius * _directions(pitch, yaws), thin, 1.2)
    for yaw in (left, right) if 0.0 < root.open_yaw < 360.0 else (left,):
        arc = center + radius * _directions(pitches, yaw)
        result.path(arc, thin, 1.2)
    if chosen and root.open_yaw:
        for pitch in np.linspace(low, high, 4)[1:-1]:
            result.path(center + radius * _directions(pitch, yaws), (*thin[:3], 0.35), 1.0)


def _arrow(
    result: Sketch, start: NDArray, tip: NDArray, color: tuple[float, ...], width: float
) -> None:
    along = tip - start
    length = float(np.linalg.norm(along))
    if length <= 0.0:
        return
    along /= length
    aside = np.cross(along, (0.0, 1.0, 0.0) if abs(along[1]) < 0.9 else (1.0, 0.0, 0.0))
    aside /= np.linalg.norm(aside)
    turned = np.array((aside, -aside, np.cross(along, aside), np.cross(aside, along)))
    barbs = tip - along * (0.10 * length) + turned * (0.04 * length)
    result.lines((start, *barbs), tip, color, width)


def direction(pitch: float, yaw: float) -> NDArray[np.float64]:
    """Unit vector of a root's angles in degrees."""
    return np.asarray(_directions(pitch, yaw), np.float64)


def _directions(pitch: float | NDArray, yaw: float | NDArray) -> NDArray[np.float64]:
    up, turn = np.broadcast_arrays(np.radians(pitch), np.radians(yaw))
    level = np.cos(up)
    return np.stack((level * np.cos(turn), np.sin(up), -level * np.sin(turn)), axis=-1)
