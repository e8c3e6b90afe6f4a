"""`ShapeLibrary`: the clouds that models give, each made once and shared by all that stand with it.

What is in here follows from the models and the light: no part of the weather's state.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from weather_ecs.components import CloudModel
from weather_ecs.frame import CloudShapeData
from weather_ecs.physics.absorption import absorbed, path_lengths
from weather_ecs.physics.cloud_shape import CloudShape, shape

TURNS = 24  # headings that a shape can be lit for
SPARE = 64  # shapes that are kept while no cloud stands with them
AT_ONCE = 1500  # seeds up to which a new shape is lit all at once
ANGLE = math.radians(2.0)
PAIRS = 4096  # rays times boxes of a large cloud that one frame follows

Vector = tuple[float, float, float]

_keys = itertools.count(1)


@dataclass(slots=True)
class Shape:
    """A cloud of a model, and how far its light has come."""

    key: int  # a new one for whatever is made
    model: CloudModel
    turn: int  # of TURNS, heading for which it is lit
    made: CloudShape
    data: CloudShapeData | None = None  # None: it has not been lit yet
    target: Vector | None = None  # light that it is being lit for, in parts
    lengths: NDArray | None = None  # m, of the rays followed so far

    @property
    def half(self) -> Vector:
        """Half of the box round it, m."""
        return self.made.half


class ShapeLibrary:
    """Shapes by content of their model, number and heading."""

    def __init__(self) -> None:
        self._shapes: dict[tuple[int, str, int, int], Shape] = {}
        self._made: dict[tuple[int, str, int], CloudShape] = {}
        self._prints: dict[int, tuple[CloudModel, int, int]] = {}  # by id of the model
        self._unlit: dict[int, Shape] = {}  # by key
        self.version = 0  # another one when a shape was lit
        self.lit = 0  # shapes that have been lit for the first time
        self.budget = 1  # shapes that a frame lights
        self.angle = ANGLE  # rad, by which the light has to move until a shape is lit again
        self.computed = 0  # shapes that the last frame has lit
        self.last = 0  # key of the one that was lit last: they take turns
        self.settled: Vector | None = None  # light for which nothing was to be lit again

    def __len__(self) -> int:
        return len(self._shapes)

    def get(self, model: CloudModel, number: int, turn: int = 0) -> Shape:
        """The shape; made, but not lit, if it is new."""
        key = (self._print(model), model.name, number, turn)
        found = self._shapes.get(key)
        if found is None:
            made = self._made.get(key[:3])
            if made is None:
                made = self._made[key[:3]] = shape(model, number)
            found = self._shapes[key] = Shape(next(_keys), model, turn, made)
            self._unlit[found.key] = found
        return found

    def shapes(self) -> list[Shape]:
        """All shapes, those made first at the front."""
        return list(self._shapes.values())

    def unlit(self) -> Shape | None:
        """The first of the shapes that have never been lit."""
        return next(iter(self._unlit.values()), None)

    def prune(self, used: set[int]) -> None:
        """Forget the shapes whose keys are not among those used, beyond some worth keeping."""
        idle = [key for key, each in self._shapes.items() if each.key not in used]
        if len(idle) <= SPARE:
            return
        for key in idle[: len(idle) - SPARE]:
            self._unlit.pop(self._shapes.pop(key).key, None)
        left = {key[:3] for key in self._shapes}
        self._made = {key: made for key, made in self._made.items() if key in left}
        models = {id(each.model) for each in self._shapes.values()}
        self._prints = {key: known for key, known in self._prints.items() if key in models}

    def light_new(self, each: Shape, light: Vector) -> None:
        """Light a new shape; a very large one by its outline only, until its turn comes."""
        if len(each.made.centers) <= AT_ONCE:
            lengths = path_lengths(each.made.centers, each.made.sizes, local(light, each.turn))
            self._finish(each, light, lengths)
            return
        side = each.made.centers @ np.array(local(light, each.turn)) / each.made.radius
        lost = np.clip(0.5 - 0.5 * side, 0.0, 1.0).astype(np.float32)
        # Lit for no direction in particular: the next in turn to be lit properly.
        self._take(each, (0.0, 0.0, 0.0), lost)

    def relight(self, each: Shape, light: Vector) -> bool:
        """Follow the rays to a light that has moved, a large cloud's in parts; whether done."""
        count = len(each.made.centers)
        if each.target is None or each.lengths is None:
            each.target, each.lengths = light, np.zeros(0)
        start = len(each.lengths)
        rows = slice(start, start + max(PAIRS // count, 1))
        towards = local(each.target, each.turn)
        part = path_lengths(each.made.centers, each.made.sizes, towards, rows)
        each.lengths = np.concatenate((each.lengths, part))
        if len(each.lengths) < count:
            return False
        self._finish(each, each.target, each.lengths)
        return True

    def _finish(self, each: Shape, light: Vector, lengths: NDArray) -> None:
        self._take(each, light, absorbed(lengths, each.model.light_penetration).astype(np.float32))

    def _take(self, each: Shape, light: Vector, lost: NDArray) -> None:
        self.version += 1
        self.lit += each.data is None
        self._unlit.pop(each.key, None)
        each.data = self._data(each, light, lost)
        each.target = each.lengths = None

    def _data(self, each: Shape, light: Vector, lost: NDArray) -> CloudShapeData:
        lost.setflags(write=False)
        if each.data is not None:
            return replace(each.data, absorbed=lost, light=light)
        made = each.made
        return CloudShapeData(
            key=each.key,
            centers=made.centers,
            sizes=made.sizes,
            absorbed=lost,
            light=light,
            billboards=made.billboards,
            radius=made.radius,
            penetration=each.model.light_penetration,
        )

    def _print(self, model: CloudModel) -> int:
        """A number for the content of a model: another one whenever a field of it has changed."""
        known, revision = self._prints.get(id(model)), CloudModel.revision()
        if known is None or known[0] is not model or known[1] != revision:
            known = self._prints[id(model)] = (model, revision, hash(repr(model)))
        return known[2]


def turn_of(heading: float) -> int:
    """The nearest of TURNS to a heading in rad."""
    return round(heading / (2.0 * math.pi) * TURNS) % TURNS


def local(light: Vector, turn: int) -> Vector:
    """A direction of the world as a shape has it that is turned counter-clockwise about +y."""
    if turn == 0:
        return light
    c, s = math.cos(turn * 2.0 * math.pi / TURNS), math.sin(turn * 2.0 * math.pi / TURNS)
    x, y, z = light
    return x * c - z * s, y, x * s + z * c
