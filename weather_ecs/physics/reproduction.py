"""Reproduction: from the seeds and roots of a model to the boxes and billboards of one cloud.

After R. P. Torchelsen, "Modelo para simulação em tempo-real de nuvens usando billboards" (UNISINOS,
2005), section 3.1. A model is anything with the fields of `components.CloudModel`; in `reproduce` a
seed may do without a centre, which is then the origin, and without roots.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.checks import FloatArray, floats
from weather_ecs.physics.cloud_images import CLOUD_IMAGES

MOST_SEEDS = 1_000_000
MOST_BILLBOARDS = 10_000_000
FILLED = 0.75  # of an image's half-width; what lies beyond is clear or nearly so

# The same fields as frame.BILLBOARD_DTYPE, which says what they are.
BILLBOARDS = np.dtype(
    [
        ("position", "f4", 3),
        ("size", "f4", 2),
        ("turn", "f4"),
        ("image", "i4"),
        ("seed", "i4"),
        ("order", "f4"),
        ("opacity", "f4"),
    ]
)


class Boxes(NamedTuple):
    """The boxes of one cloud."""

    centers: FloatArray  # (n, 3), m, the model's axes
    sizes: FloatArray  # (n, 3), m, whole sides
    seeds: NDArray[np.intp]  # (n,), index of the model's seed that each is, or descends from


def reproduce(model: Any, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Centres and whole sides of the boxes of one cloud, (n, 3) both, m, in the model's axes.

    Every seed of the model is followed by what its roots add. At level k = 1, 2, ... a root adds
    boxes of the seed's size at the seed's centre + direction x radius x k: the radius is that of
    the sphere through the box's corners, the direction the root's, turned at random by up to half
    of its openings. The number of levels is drawn between the root's minimum and maximum.
    """
    boxes = descend(model, rng)
    return boxes.centers, boxes.sizes


def descend(model: Any, rng: np.random.Generator) -> Boxes:
    """What `reproduce` gives, and which seed of the model each box comes from."""
    centers: list[FloatArray] = []
    sides: list[FloatArray] = []
    total = 0
    places = _boxes_of(model.seeds)
    for seed, center, size in zip(model.seeds, *places, strict=True):
        added = [center[None, :]]
        for root in getattr(seed, "roots", ()):
            steps = _steps(root, rng)
            total += len(steps)
            if total > MOST_SEEDS:
                raise InvalidValueError("seeds", f"{total} or more", f"at most {MOST_SEEDS}")
            radius = 0.5 * float(np.linalg.norm(size))
            added.append(center + _directions(root, len(steps), rng) * (radius * steps)[:, None])
        centers.append(np.concatenate(added))
        sides.append(size)
    if not centers:
        raise InvalidValueError("seeds", model.seeds, "at least one seed")
    seeds = np.repeat(np.arange(len(centers)), [len(each) for each in centers])
    return Boxes(np.concatenate(centers), np.array(sides)[seeds], seeds)


def _boxes_of(seeds: Sequence[Any]) -> tuple[FloatArray, FloatArray]:
    """Centres and whole sides of seeds, (n, 3) both, checked together."""
    places = [getattr(seed, "center", (0.0, 0.0, 0.0)) for seed in seeds]
    sides = [(seed.width, seed.height, seed.depth) for seed in seeds]
    try:
        checked = floats("center", places), floats("size", sides, 0.0)
    except InvalidValueError:
        for center, size in zip(places, sides, strict=True):  # the one that it is
            floats("center", center), floats("size", size, 0.0)
        raise
    flat = (checked[1] == 0.0).any(axis=-1)
    if flat.any():
        size = checked[1][flat][0].tolist()
        raise InvalidValueError("size", size, "three numbers above 0, metres")
    return checked


def level_counts(start: int, end: int, levels: int) -> NDArray[np.int64]:
    """New seeds of each level, (levels,): `start` at the first to `end` at the last, linearly."""
    return np.rint(np.linspace(start, end, levels)).astype(np.int64)


def image_indices(names: Sequence[str]) -> list[int]:
    """Layers of the images of these names; a family's name ("puff") is all of its images."""
    found: list[int] = []
    for name in names:
        layers = [
            layer
            for layer, image in enumerate(CLOUD_IMAGES)
            if name in (image, image.rpartition("_")[0])
        ]
        if not layers:
            families = sorted({image.rpartition("_")[0] for image in CLOUD_IMAGES})
            allowed = f"{', '.join(families)}, or one image of them as {CLOUD_IMAGES[0]}"
            raise InvalidValueError("images", name, allowed)
        found.extend(layers)
    return found


def billboards(model: Any, boxes: Boxes, rng: np.random.Generator) -> NDArray:
    """Billboards of a cloud in its boxes, an array of BILLBOARDS; positions in the boxes' axes.

    `roundness` draws them from the whole box towards the ellipsoid in it. `flatness` lifts those
    that would hang below the lowest box until what they show stands on its bottom. `order` is 0 for
    the one nearest to the cloud's middle and rises evenly to 1 at the rim.
    """
    centers, sides = boxes.centers, boxes.sizes
    if len(centers) * model.billboards_max > MOST_BILLBOARDS:
        count = len(centers) * model.billboards_max
        raise InvalidValueError("billboards_max", f"{count} in all", f"at most {MOST_BILLBOARDS}")
    counts = rng.integers(model.billboards_min, model.billboards_max + 1, len(centers))
    box = np.repeat(np.arange(len(centers)), counts)
    n = len(box)
    origin = boxes.seeds[box]
    place = rng.uniform(-1.0, 1.0, (n, 3))
    reach = np.linalg.norm(place, axis=1)
    to_ball = np.abs(place).max(axis=1, initial=0.0) / np.where(reach > 0.0, reach, 1.0)
    place *= (1.0 + model.roundness * (to_ball - 1.0))[:, None]
    position = centers[box] + 0.5 * sides[box] * place
    width = rng.uniform(model.size_min, model.size_max, n) * _each(model, "size_factor", origin)
    height = width * model.aspect * _each(model, "aspect_factor", origin)
    low = float((centers[:, 1] - 0.5 * sides[:, 1]).min())
    lift = np.maximum(0.0, low + FILLED * 0.5 * height - position[:, 1])
    position[:, 1] += model.flatness * lift
    turn = np.radians(model.turn) * _each(model, "turn_factor", origin)

    result = np.zeros(n, BILLBOARDS)
    result["position"] = position
    result["size"] = np.stack((width, height), axis=1)
    result["turn"] = rng.uniform(-1.0, 1.0, n) * turn
    result["image"] = _images(model, origin, rng)
    result["seed"] = box
    result["order"] = _order(position)
    result["opacity"] = model.opacity
    return result


def _each(model: Any, field: str, origin: NDArray[np.intp]) -> FloatArray:
    """A field of the model's seeds, for each of the seeds `origin`."""
    return np.array([getattr(seed, field) for seed in model.seeds], np.float64)[origin]


def _images(model: Any, origin: NDArray[np.intp], rng: np.random.Generator) -> NDArray[np.int64]:
    """Images drawn from the lists of the seeds, or the model's where a seed has none."""
    known: dict[tuple[str, ...], list[int]] = {}
    lists = []
    for seed in model.seeds:
        names = tuple(seed.images or model.images)
        if names not in known:
            known[names] = image_indices(names)
        lists.append(known[names])
    counts = np.array([len(each) for each in lists])
    starts = np.cumsum(counts) - counts
    drawn = np.minimum(rng.random(len(origin)) * counts[origin], counts[origin] - 1)
    return np.concatenate(lists)[starts[origin] + drawn.astype(np.int64)]


def _steps(root: Any, rng: np.random.Generator) -> NDArray[np.int64]:
    """The level of every seed that the root adds in one cloud."""
    levels = int(rng.integers(root.reproductions_min, root.reproductions_max + 1))
    counts = level_counts(root.seeds_start, root.seeds_end, levels)
    if float(counts.sum(dtype=np.float64)) > MOST_SEEDS:
        raise InvalidValueError("descendants", int(counts.sum()), f"at most {MOST_SEEDS}")
    return np.repeat(np.arange(1, levels + 1), counts)


def _directions(root: Any, n: int, rng: np.random.Generator) -> FloatArray:
    """Unit vectors within the root's openings, (n, 3)."""
    turns = rng.uniform(-0.5, 0.5, (n, 2))
    pitch = np.radians(root.pitch + root.open_pitch * turns[:, 0])
    yaw = np.radians(root.yaw + root.open_yaw * turns[:, 1])
    level = np.cos(pitch)
    return np.stack((level * np.cos(yaw), np.sin(pitch), -level * np.sin(yaw)), axis=1)


def _order(position: FloatArray) -> FloatArray:
    n = len(position)
    if n < 2:
        return np.zeros(n)
    low, high = position.min(axis=0), position.max(axis=0)
    half = np.where(high > low, 0.5 * (high - low), 1.0)
    distance = np.linalg.norm((position - 0.5 * (low + high)) / half, axis=1)
    order = np.empty(n)
    order[np.argsort(distance, kind="stable")] = np.linspace(0.0, 1.0, n)
    return order
