"""`MadeClouds`: the `Cloud` components of the game as rows for the GPU."""

from __future__ import annotations

import math
from typing import Any

import esper
import numpy as np
from numpy.typing import NDArray

from weather_ecs.components import Cloud, CloudModel
from weather_ecs.frame import CLOUD_DTYPE, WindProfile
from weather_ecs.physics.wind import height_share
from weather_ecs.systems.cloud_models import ModelBook
from weather_ecs.systems.cloud_shapes import Shape, ShapeLibrary, turn_of
from weather_ecs.systems.queries import alive
from weather_ecs.systems.uids import Uids

Wind = tuple[float, float, float]


def share_of(cloud: Cloud, profile: WindProfile) -> float:
    """How much of the wind at the reference height carries a cloud, by the wind at its base."""
    if cloud.drift == 0.0:
        return 0.0
    height = cloud.position[1] - profile.ground
    return cloud.drift * height_share(height, profile.reference, profile.exponent)


class MadeClouds:
    """One row for each cloud, made again when any of them or any model has changed."""

    def __init__(self) -> None:
        self.shapes: list[Shape] = []  # that the rows' indices mean
        self.wanted: list[Shape] = []  # that have not been lit
        self.edited = False  # a model has changed since the last time
        self._own = np.zeros((0, 2))  # m/s, (x, z)
        self._share = np.zeros((0, 1))  # of the wind
        self._rows = np.zeros(0, CLOUD_DTYPE)
        self._list: list[Any] | None = None
        self._entities: list[int] = []
        self._seen: tuple[Any, ...] = ()

    def collect(
        self, book: ModelBook, library: ShapeLibrary, uids: Uids, profile: WindProfile
    ) -> bool:
        """Take the living clouds over; whether anything has changed."""
        pairs = esper.get_component(Cloud)
        bent = (profile.exponent, profile.ground)
        seen = (Cloud.revision(), CloudModel.revision(), library.lit, bent)
        same = pairs is self._list and seen == self._seen
        if same and all(map(esper.entity_exists, self._entities)):
            return False
        self.edited = seen[1:2] != self._seen[1:2]
        self._list, self._seen = pairs, seen
        found = alive(Cloud, uids)
        self._entities = [pair[0] for pair in pairs if esper.entity_exists(pair[0])]
        self.shapes, self.wanted, motion, rows = [], [], [], []
        places: dict[int, int] = {}  # index of a shape by its key
        for uid, cloud in found:
            model = book.find(cloud.model, uids)
            if model is None:
                continue
            shape = library.get(model, cloud.number, turn_of(cloud.heading))
            if shape.data is None:
                self.wanted.append(shape)
                continue
            motion.append((*cloud.velocity, share_of(cloud, profile)))
            rows.append(_row(uid, cloud, shape, places.setdefault(shape.key, len(places))))
            if len(places) > len(self.shapes):
                self.shapes.append(shape)
        self._rows = np.array(rows, CLOUD_DTYPE)
        moving = np.array(motion).reshape(-1, 3)
        self._own, self._share = moving[:, :2], moving[:, 2:]
        return True

    def at(self, wind: Wind, passed: float) -> NDArray:
        """The rows `passed` seconds after the clouds were last moved."""
        rows = self._rows.copy()
        if len(rows):
            rows["velocity"][:, 0::2] = self._own + self._share * (wind[0], wind[2])
            rows["position"] += rows["velocity"] * passed
        return rows


def _row(uid: int, cloud: Cloud, shape: Shape, index: int) -> tuple[Any, ...]:
    x, y, z = cloud.position
    return (
        uid,
        index,
        (x, y + shape.half[1] * cloud.scale, z),
        (0.0, 0.0, 0.0),
        cloud.scale,
        1.0,
        math.fmod(cloud.heading, 2.0 * math.pi),
        cloud.shear,
        cloud.growth,
        cloud.hollow,
        cloud.opacity,
        shape.model.darkness,
        0.0,
        (0.0, 0.0),
    )
