"""`LayerClouds`: the clouds of one layer, which come in, drift across and leave.

All clouds of a layer drift alike, so each keeps its place in a frame of reference that drifts with
them, and time costs nothing where nobody comes or goes: once a second of weather the layer is
carried on and the outermost clouds are held against the rectangle.

Clouds come in as many as a steady stream of the sky that is due brings: where the number is right,
one for each that leaves (Torchelsen 2005, 3.4), else in the stream's own measure, so that after the
layer has been blown across once the number and the kinds are those of the new sky. Beyond the
dissertation they also form, dissolve and turn into others where they stand: in calm air, where
nothing would ever come in, and where the layer asks for it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.chance import scramble, uniform, uniforms
from weather_ecs.systems.cloud_array import WHOLE, CloudArray
from weather_ecs.systems.cloud_mix import Chooser, Kind, Mix
from weather_ecs.systems.cloud_place import QUANTUM, apart, scattered

TICK = 1.0  # s
FORMING = 24  # ticks from nothing to whole, and back
CALM = 0.5  # m/s, of wind below which clouds change where they stand
CHANGE = 90.0  # s in which they do so in calm air
QUICKEST = FORMING * TICK  # s in which all clouds can change where they stand
MANY = 64  # clouds at once, of which each need not look for room of its own
HASTE = 0.1  # share by which a wrong number is put right faster than the stream alone would


class Box(NamedTuple):
    """A rectangle of the world, m."""

    x: float  # centre
    z: float
    width: float  # along x
    depth: float  # along z


class LayerClouds:
    """One layer's clouds. The seed and the layer's uid give all its chance."""

    __slots__ = (
        "array",
        "box",
        "change",
        "chooser",
        "due",
        "known",
        "offset",
        "seed",
        "serial",
        "ticks",
        "uid",
        "velocity",
        "wind",
    )

    def __init__(self, seed: int, uid: int, box: Box, velocity: tuple[float, float]) -> None:
        self.seed, self.uid = seed, uid
        self.ticks = 0
        self.box = box
        self.velocity = velocity  # (x, z), m/s, holds until the next tick
        self.wind = (0.0, 0.0)  # (x, z), m/s, at the reference height, as slow as clouds follow it
        self.offset = (0.0, 0.0)  # m, of the drifting frame's origin
        self.serial = 0  # of the next cloud
        self.due = 0.0  # clouds that the stream has brought and that have not come in
        self.change = 0.0  # clouds that are to change where they stand
        self.known: frozenset[tuple[float, str]] = frozenset()  # sky and name of its models
        self.chooser = Chooser()
        self.array = CloudArray()

    def fill(self, mix: Mix) -> None:
        """The start: the rectangle is filled at random."""
        count = mix.target
        kinds = [self.chooser.take(mix) for _ in range(count)]
        order = np.argsort(uniforms(np.arange(count), self._chance(0)), kind="stable")
        places = scattered(count, self.box.width, self.box.depth, self._chance(0))
        self._add([kinds[k] for k in order], self._inside(places), WHOLE)

    def tick(
        self, velocity: tuple[float, float], box: Box, mix: Mix, turnover: float = 0.0
    ) -> None:
        """A second has passed; `turnover` is the time in s in which clouds change in place."""
        self.ticks += 1
        moved = self._carry(velocity, box)
        array = self.array
        standing = array.standing
        left = self._leave()
        along = abs(moved[0]) / box.width, abs(moved[1]) / box.depth
        crossed = along[0] + along[1]
        if max(along) > 0.5:  # the rectangle has been put elsewhere
            self._begin_anew(mix, left)
        elif crossed > 0.0:
            self._come_in(mix, moved, standing, left)
        wind = math.hypot(*velocity) if crossed > 0.0 else 0.0
        if turnover > 0.0:
            pace = TICK / max(turnover, QUICKEST)
        else:
            pace = TICK / CHANGE * max(1.0 - wind / CALM, 0.0)
        if pace > 0.0:
            self._change_in_place(mix, pace, steady=turnover > 0.0)
        array.drop_gone(self.ticks - FORMING)

    def renew(self, known: frozenset[tuple[float, str]], mix: Mix) -> None:
        """The layer's skies have come to be others; `known` are the models of each now.

        Clouds of none of them go, and others form where they are missing.
        """
        array = self.array
        other = self.known.isdisjoint(known)
        self.known = known
        odd = [k for k, kind in enumerate(array.kinds) if (kind.sky, kind.model) not in known]
        going = np.flatnonzero(np.isin(array.kind, odd))
        if len(going):
            array.remove(going)
        if other or len(going):
            self._form(mix, mix.target - array.standing)

    def complete(self, mix: Mix) -> None:
        """Clouds form or dissolve where they stand until there are as many as the mix has."""
        array = self.array
        for _ in range(array.standing - mix.target):
            excess = self._excess(mix)
            self._dissolve(excess if excess is not None else array.oldest())
        if array.standing < mix.target:
            self._form(mix, mix.target - array.standing)

    # Parts of a tick

    def _carry(self, velocity: tuple[float, float], box: Box) -> tuple[float, float]:
        """Carry the layer on; how far it has moved against its rectangle, m."""
        dx, dz = self.velocity[0] * TICK, self.velocity[1] * TICK
        self.offset = self.offset[0] + dx, self.offset[1] + dz
        moved = dx - (box.x - self.box.x), dz - (box.z - self.box.z)
        self.velocity, self.box = velocity, box
        return moved

    def _leave(self) -> int:
        """Take out the clouds beyond the rectangle; how many of them were not dissolving."""
        array, (ox, oz), box = self.array, self.offset, self.box
        if not len(array):
            return 0
        x, z = (box.x - ox) / QUANTUM, (box.z - oz) / QUANTUM
        a, b = 0.5 * box.width / QUANTUM + 1.0, 0.5 * box.depth / QUANTUM + 1.0
        low_x, high_x, low_z, high_z = array.extent
        if low_x >= x - a and high_x <= x + a and low_z >= z - b and high_z <= z + b:
            return 0
        out = (abs(array.x - x) > a) | (abs(array.z - z) > b)
        before = array.standing
        array.remove(np.flatnonzero(out))
        return before - array.standing

    def _come_in(self, mix: Mix, moved: tuple[float, float], standing: int, left: int) -> None:
        box, target = self.box, mix.target
        if standing == target:
            count, self.due = left, 0.0
        else:
            crossed = abs(moved[0]) / box.width + abs(moved[1]) / box.depth
            haste = 1.0 + HASTE if standing < target else 1.0 - HASTE
            self.due += target * crossed * haste
            count = int(self.due)
            self.due -= count
            if standing < target:
                count = min(count, target - standing + left)
        if count > 0 and mix.parts:
            kinds = [self.chooser.take(mix) for _ in range(count)]
            tries = 3 if count <= MANY else 1
            serials = range(self.serial, self.serial + count)
            places = np.array([self._upwind(moved, serial, tries) for serial in serials])
            self._add(kinds, places, WHOLE)

    def _upwind(self, moved: tuple[float, float], serial: int, tries: int) -> tuple[int, int]:
        """A place in the strip that has come into the rectangle since the last tick, in quanta."""
        box = self.box
        chance = self._chance(serial)
        along_x, along_z = abs(moved[0]) / box.width, abs(moved[1]) / box.depth
        from_x = uniform(chance, 1) * (along_x + along_z) < along_x
        best, farthest = (0, 0), -1
        for attempt in range(tries):  # the one of them that is farthest from the other clouds
            across, depth = uniform(chance, 2, attempt), uniform(chance, 3, attempt)
            if from_x:
                x = math.copysign(0.5 * box.width, -moved[0]) + depth * moved[0]
                z = (across - 0.5) * box.depth
            else:
                x = (across - 0.5) * box.width
                z = math.copysign(0.5 * box.depth, -moved[1]) + depth * moved[1]
            place = self._place(x, z)
            distance = apart(place, self.array.x, self.array.z) if tries > 1 else 0
            if distance > farthest:
                best, farthest = place, distance
        return best

    def _begin_anew(self, mix: Mix, left: int) -> None:
        """The rectangle is somewhere else at once: as many as have left stand in it."""
        count = min(left, max(mix.target - self.array.standing, 0))
        kinds = [self.chooser.take(mix) for _ in range(count)]
        places = scattered(count, self.box.width, self.box.depth, self._chance(self.serial))
        self._add(kinds, self._inside(places), WHOLE)

    def _change_in_place(self, mix: Mix, pace: float, *, steady: bool) -> None:
        """Form, dissolve and turn clouds so that number and shares come to be the mix's."""
        array = self.array
        self.change += max(mix.target, array.standing) * pace
        while self.change >= 1.0:
            self.change -= 1.0
            standing = array.standing
            excess = self._excess(mix)
            if standing < mix.target:
                self._form(mix, 1)
            elif standing > mix.target:
                self._dissolve(excess if excess is not None else array.oldest())
            elif excess is not None:
                self._turn(excess, mix)
            elif steady and standing:
                self._dissolve(array.oldest())
                self._form(mix, 1)
            else:
                self.change = 0.0

    def _form(self, mix: Mix, count: int) -> None:
        if count > MANY and mix.parts:
            kinds = [self.chooser.take(mix) for _ in range(count)]
            places = scattered(count, self.box.width, self.box.depth, self._chance(self.serial))
            self._add(kinds, self._inside(places), self.ticks)
            return
        for _ in range(count if mix.parts else 0):
            chance = self._chance(self.serial)
            spots = [
                self._place(
                    (uniform(chance, 4, attempt) - 0.5) * self.box.width,
                    (uniform(chance, 5, attempt) - 0.5) * self.box.depth,
                )
                for attempt in range(3)
            ]
            best = max(spots, key=lambda spot: apart(spot, self.array.x, self.array.z))
            self._add([self.chooser.take(mix)], np.array([best]), self.ticks)

    def _dissolve(self, row: int) -> None:
        self.array.dissolve(row, self.ticks)

    def _turn(self, row: int, mix: Mix) -> None:
        """One kind turns into another: it dissolves, and the other forms at the same place."""
        array = self.array
        part = max(mix.parts, key=lambda part: part.share * mix.target - array.count_of(part.sky))
        place = np.array([[array.x[row], array.z[row]]])
        array.dissolve(row, self.ticks)
        self._add([self.chooser.take_of(part)], place, self.ticks)

    def _excess(self, mix: Mix) -> int | None:
        """The oldest cloud of the sky that has most too many, if one has a whole cloud too many."""
        array = self.array
        due = {part.sky: part.share * mix.target for part in mix.parts}
        over = {sky: array.count_of(sky) - due.get(sky, 0.0) for sky in array.skies()}
        if not over:
            return None
        sky = max(over, key=over.__getitem__)
        return array.oldest(sky) if over[sky] >= 1.0 else None

    # Places and chance

    def _chance(self, serial: int) -> int:
        return scramble(self.seed, self.uid, serial)

    def _place(self, x: float, z: float) -> tuple[int, int]:
        """A point relative to the rectangle's centre, in quanta of the drifting frame."""
        dx, dz = self.box.x - self.offset[0], self.box.z - self.offset[1]
        return math.floor((x + dx) / QUANTUM + 0.5), math.floor((z + dz) / QUANTUM + 0.5)

    def _inside(self, places: NDArray) -> NDArray:
        shift = np.array([self.box.x - self.offset[0], self.box.z - self.offset[1]])
        return np.floor((places + shift) / QUANTUM + 0.5).astype(np.int64)

    def _add(self, kinds: list[Kind], places: NDArray, born: int) -> None:
        serials = np.arange(self.serial, self.serial + len(kinds), dtype=np.int64)
        self.array.add(kinds, places.reshape(-1, 2), serials, born)
        self.serial += len(kinds)
