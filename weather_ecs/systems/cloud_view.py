"""`LayerView`: the clouds of one layer as rows for the GPU."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weather_ecs.components import CloudModel, SkyLayer
from weather_ecs.frame import CLOUD_DTYPE, WindProfile
from weather_ecs.physics.chance import uniforms
from weather_ecs.physics.wind import LOWEST
from weather_ecs.systems.cloud_array import WHOLE, CloudArray
from weather_ecs.systems.cloud_layer import FORMING, TICK, LayerClouds
from weather_ecs.systems.cloud_place import QUANTUM
from weather_ecs.systems.cloud_shapes import Shape, ShapeLibrary

SMALLEST, LARGEST = 0.85, 1.2  # factors on a shape
RIM = 0.06  # of the rectangle's shorter side: where clouds fade that come in or leave
WIDEST_RIM = 1500.0  # m
LEANING = 50.0  # s for which the wind's difference works on a cloud before its parts are renewed
STEEPEST = 0.5  # m of lean per m
DEPTH = 1000.0  # m over which that difference is taken

_NO_ROWS = np.zeros(0, np.int64)
_UID_MASK, _SERIAL_BITS = 0x3FFFFF, 40  # of a key


def scales(serial: NDArray, uid: int) -> NDArray:
    """Factors on the shapes of clouds, by their serial numbers."""
    return SMALLEST + (LARGEST - SMALLEST) * uniforms(serial, uid, 11)


def lifts(serial: NDArray, uid: int, variation: float) -> NDArray:
    """How far the bases of clouds lie above that of their layer, m."""
    return variation * (2.0 * uniforms(serial, uid, 12) - 1.0)


def rim(layer: SkyLayer) -> float:
    """Width of the strip along the rectangle's edge in which clouds fade, m."""
    return min(RIM * min(layer.size), WIDEST_RIM)


def inside(x: NDArray, z: NDArray, layer: SkyLayer) -> NDArray:
    """0 at the rectangle's edge and beyond to 1 inside the rim."""
    reach_x = 0.5 * layer.size[0] - np.abs(x - layer.center[0])
    reach_z = 0.5 * layer.size[1] - np.abs(z - layer.center[1])
    return ease(np.minimum(reach_x, reach_z) / rim(layer))


def growth(array: CloudArray, now: float) -> NDArray:
    """0 to 1 of every cloud, `now` in ticks."""
    grown = np.where(array.born == WHOLE, 1.0, (now - array.born) / FORMING)
    left = np.where(array.dying == WHOLE, 1.0, 1.0 - (now - array.dying) / FORMING)
    return ease(np.minimum(grown, left))


def ease(x: NDArray) -> NDArray:
    """Smoothstep from 0 at x = 0 to 1 at x = 1."""
    share = np.clip(x, 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def lean(record: LayerClouds, layer: SkyLayer, profile: WindProfile) -> tuple[float, float]:
    """m of lean per m of height: the layer's own, and what the wind's growth with height makes."""
    x, z = layer.shear
    if profile.exponent and layer.drift:
        # The law is for the lowest few hundred metres; above, it stands in for whatever makes the
        # wind grow there.
        base = max(layer.base - profile.ground, LOWEST)
        low, high = (
            (height / profile.reference) ** profile.exponent for height in (base, base + DEPTH)
        )
        pull = layer.drift * (high - low) / DEPTH * LEANING
        dx, dz = record.wind[0] * pull, record.wind[1] * pull
        limit = STEEPEST / max(np.hypot(dx, dz), STEEPEST)
        x, z = x + dx * limit, z + dz * limit
    return float(x), float(z)


def key_of(uid: int) -> int:
    """Key of the first cloud of a layer; those of its other clouds follow on it."""
    return ((uid & _UID_MASK) + 1) << _SERIAL_BITS


class LayerView:
    """Rows of a layer, made again when its clouds, its models or its shapes have changed."""

    def __init__(self) -> None:
        self.rows = np.zeros(0, CLOUD_DTYPE)  # where the clouds are in the drifting frame
        self.shown = _NO_ROWS  # rows of the layer's array that they are
        self.shapes: list[Shape] = []  # that the rows' indices mean
        self._changing = False

    def build(
        self,
        record: LayerClouds,
        layer: SkyLayer,
        models: dict[tuple[float, str], CloudModel],
        library: ShapeLibrary,
    ) -> list[Shape]:
        """Make the rows; returns the shapes that are wanted and have not been lit."""
        array = record.array
        present = np.bincount(array.kind, minlength=len(array.kinds))
        by_kind: list[Shape | None] = []
        for kind, count in zip(array.kinds, present.tolist(), strict=True):
            model = models.get((kind.sky, kind.model)) if count else None
            by_kind.append(library.get(model, kind.number) if model is not None else None)
        self.shapes = [each for each in by_kind if each is not None and each.data is not None]
        place = {each.key: k for k, each in enumerate(self.shapes)}
        index = np.array([-1 if s is None else place.get(s.key, -1) for s in by_kind], np.int64)
        self.shown = np.flatnonzero(index[array.kind] >= 0) if len(array) else _NO_ROWS
        self.rows = self._template(record, layer, by_kind)
        self.rows["shape"] = index[array.kind[self.shown]] if len(self.shown) else 0
        states = (array.born, array.dying)
        self._changing = any(bool((ticks[self.shown] != WHOLE).any()) for ticks in states)
        return [each for each in by_kind if each is not None and each.data is None]

    def _template(
        self, record: LayerClouds, layer: SkyLayer, by_kind: list[Shape | None]
    ) -> NDArray:
        array, shown = record.array, self.shown
        rows = np.zeros(len(shown), CLOUD_DTYPE)
        serial = array.serial[shown]
        scale = scales(serial, record.uid)
        half = np.array([0.0 if each is None else each.half[1] for each in by_kind])
        dark = np.array([0.0 if each is None else each.model.darkness for each in by_kind])
        rows["key"] = key_of(record.uid) + serial
        rows["position"][:, 0] = array.x[shown] * QUANTUM
        rows["position"][:, 1] = layer.base + lifts(serial, record.uid, layer.variation)
        rows["position"][:, 2] = array.z[shown] * QUANTUM
        rows["scale"], rows["mirror"] = scale, 1.0
        rows["growth"] = rows["opacity"] = 1.0
        # Half of those that dissolve do so from the inside out.
        rows["mode"] = (array.dying[shown] != WHOLE) & (serial % 2 == 1)
        if len(shown):
            kinds = array.kind[shown]
            rows["position"][:, 1] += half[kinds] * scale
            rows["darkness"] = dark[kinds]
        return rows

    def at(
        self, record: LayerClouds, layer: SkyLayer, profile: WindProfile, passed: float
    ) -> NDArray:
        """The rows `passed` seconds after the last tick."""
        rows = self.rows.copy()
        if not len(rows):
            return rows
        position, (vx, vz) = rows["position"], record.velocity
        position[:, 0] += record.offset[0] + vx * passed
        position[:, 2] += record.offset[1] + vz * passed
        rows["velocity"] = (vx, 0.0, vz)
        rows["opacity"] = inside(position[:, 0], position[:, 2], layer)
        rows["shear"] = lean(record, layer, profile)
        if self._changing:
            rows["growth"] = growth(record.array, record.ticks + passed / TICK)[self.shown]
        return rows
