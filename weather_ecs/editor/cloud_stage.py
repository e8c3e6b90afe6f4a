"""`CloudStage`: one cloud under a sky, drawn by the package's own renderer."""

from __future__ import annotations

import itertools
import math
from datetime import UTC, datetime
from typing import NamedTuple

import esper
import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs import QualitySettings, Weather
from weather_ecs.components import Atmosphere, Cloud, CloudModel, CloudShading
from weather_ecs.editor.inside import in_world
from weather_ecs.editor.shared import Sunlight
from weather_ecs.tools import CloudShapeData, frame_of

HEIGHT = 1000.0  # m over the ground at which the model's origin stands, whatever its base
SETTLING = 1.3  # s after a change in which the light still comes in
# Near or far, always its billboards: a picture of the cloud would be seen to change.
_QUALITY = QualitySettings("editor", 1, 1, 16, False, 1.0, 10_000_000, 1, 16, 256)
_EQUINOX = datetime(2025, 3, 20, 12, 7, 30, tzinfo=UTC)  # the sun in the south at longitude 0
_numbers = itertools.count(1)


class Posed(NamedTuple):
    """The cloud that stands on the stage, in the model's own axes."""

    shape: CloudShapeData
    middle: NDArray[np.float64]  # m, of the shape's centre
    own: tuple[int, ...]  # row of the shape's boxes that each of the model's seeds is

    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Least and greatest corner of what the billboards show, m."""
        shown = self.shape.billboards
        if not len(shown):
            half, centers = 0.5 * self.shape.sizes, self.shape.centers
        else:  # the outer rim of an image is clear
            half, centers = 0.4 * shown["size"][:, [0, 1, 0]], shown["position"]
        low, high = (centers - half).min(axis=0), (centers + half).max(axis=0)
        return low + self.middle, high + self.middle


class CloudStage:
    """The cloud of a model and a number; the same objects from frame to frame."""

    def __init__(self, gl: moderngl.Context) -> None:
        self._world = f"weather_ecs.editor cloud {next(_numbers)}"
        with in_world(self._world):
            self.weather = Weather(context=gl, quality=_QUALITY)
            self._air = Atmosphere(time=_EQUINOX.timestamp(), draw=True, speed=0.0, overcast=0.0)
            self._shading = CloudShading()
            esper.create_entity(self._air)
            esper.create_entity(self._shading)
        self._cloud: Cloud | None = None
        self._entity = 0
        self._posed: Posed | None = None
        self._wanted: tuple[CloudModel | None, int] = (None, 0)
        self._sun: tuple[float, float] = (math.nan, math.nan)

    def show(self, model: CloudModel | None, number: int) -> bool:
        """Let this cloud stand there; whether it is another one than before."""
        if model is self._wanted[0] and number == self._wanted[1]:
            return False
        self._wanted = model, number
        self._posed = None
        with in_world(self._world):
            if model is None:
                if self._cloud is not None:
                    esper.delete_entity(self._entity, immediate=True)
                self._cloud = None
            elif self._cloud is None:
                self._cloud = Cloud(model, (0.0, HEIGHT, 0.0), number, drift=0.0)
                self._entity = esper.create_entity(self._cloud)
            else:
                self._cloud.model, self._cloud.number = model, number
        self._pose(model)
        return True

    def light(self, sun: Sunlight, *, plain: bool) -> bool:
        """Put the sun there; whether anything has changed."""
        changed = self._shading.plain != plain
        if changed:
            self._shading.plain = plain
        if (sun.azimuth, sun.elevation) != self._sun:
            self._sun = sun.azimuth, sun.elevation
            self._air.time, self._air.latitude = when(sun.azimuth, sun.elevation)
            changed = True
        return changed

    def sky(self, draw: bool) -> None:
        """Whether the sky is drawn behind the cloud; it is, unless this says otherwise."""
        self._air.draw = draw
        self.step(0.0)

    @property
    def posed(self) -> Posed | None:
        """What stands there, with its absorption as of the last step; None for nothing."""
        return self._posed

    def step(self, dt: float) -> None:
        """Let the light follow."""
        with in_world(self._world):
            esper.process(dt)
        if self._posed is not None:
            shapes = frame_of(self.weather).cloud_shapes
            if shapes and shapes[0] is not self._posed.shape:
                self._posed = self._posed._replace(shape=shapes[0])

    def draw(self, view: NDArray, projection: NDArray, *, clouds: bool = True) -> None:
        """Sky and cloud into what is bound; the model's origin is at (0, HEIGHT, 0)."""
        if self._cloud is not None:
            opacity = 1.0 if clouds else 0.0
            if self._cloud.opacity != opacity:
                self._cloud.opacity = opacity
        self.weather.draw(view, projection)

    def close(self) -> None:
        """Give everything back."""
        self.weather.close()

    def _pose(self, model: CloudModel | None) -> None:
        """Keep the model's axes where they are, however the cloud in them comes out."""
        cloud = self._cloud
        if cloud is None or model is None:
            return
        shapes = frame_of(self.weather).cloud_shapes
        if not shapes:
            return
        shape = shapes[0]
        middle = np.array(model.seeds[0].center) - shape.centers[0].astype(np.float64)
        bottom = float((shape.centers[:, 1] - 0.5 * shape.sizes[:, 1]).min())
        cloud.position = (middle[0], HEIGHT + middle[1] + bottom, middle[2])
        self._posed = Posed(shape, middle, own_rows(model, shape, middle))


def own_rows(model: CloudModel, shape: CloudShapeData, middle: NDArray) -> tuple[int, ...]:
    """Rows of the boxes that are the model's seeds; the rest were added by roots."""
    if len(shape.centers) == len(model.seeds):
        return tuple(range(len(model.seeds)))
    rows, row = [], 0
    centers = np.array([seed.center for seed in model.seeds]) - middle
    for index, center in enumerate(centers):
        most = len(shape.centers) - len(centers) + index
        if not model.seeds[index - 1].roots if index else True:
            found = row  # nothing has been added since the seed before
        else:
            away = np.abs(shape.centers[row : most + 1] - center).max(axis=1)
            limit = 1e-3 + 1e-5 * float(np.abs(center).max(initial=1.0))
            same = np.flatnonzero(away <= limit)
            found = row + int(same[0]) if len(same) else row
        rows.append(min(found, most))
        row = min(found + 1, most + 1)
    return tuple(rows)


def when(azimuth: float, elevation: float) -> tuple[float, float]:
    """Time (s since 1970) and latitude (degrees) of an equinox at which the sun stands there.

    With the sun over the equator its direction (east, north, up) is (-sin h, -sin p cos h,
    cos p cos h) at latitude p and hour angle h.
    """
    turn, rise = math.radians(azimuth), math.radians(elevation)
    east, north = math.sin(turn) * math.cos(rise), math.cos(turn) * math.cos(rise)
    hour = math.asin(min(max(-east, -1.0), 1.0))
    latitude = math.atan2(-north, math.sin(rise))
    if abs(latitude) > 0.5 * math.pi:  # below the horizon: the other half of the day
        hour = math.pi - hour
        latitude = math.atan2(north, -math.sin(rise))
    seconds = hour / (2.0 * math.pi) * 86400.0
    return _EQUINOX.timestamp() + seconds, math.degrees(latitude)
