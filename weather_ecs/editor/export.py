"""Export: a still, a film once round a cloud, and a sheet of its pictures from all sides."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.components import CloudModel
from weather_ecs.editor.camera import OrbitCamera
from weather_ecs.editor.cloud_stage import HEIGHT, CloudStage
from weather_ecs.editor.ground import Ground
from weather_ecs.editor.pictures import film, write_png, written_whole
from weather_ecs.editor.shared import Sunlight
from weather_ecs.editor.studio import Studio

_ORIGIN = np.array([0.0, HEIGHT, 0.0])
_LIGHT_COMES = 12  # frames in which the light of a new cloud comes in

Pixels = NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class Subject:
    """The cloud that is shown."""

    model: CloudModel
    number: int = 0
    sun: Sunlight = field(default_factory=Sunlight)
    plain: bool = False


class Shooter:
    """Takes pictures of a cloud, off screen."""

    def __init__(self, gl: moderngl.Context, subject: Subject) -> None:
        self._gl = gl
        self.stage = CloudStage(gl)
        self._ground = Ground(gl)
        self.stage.show(subject.model, subject.number)
        self.stage.light(subject.sun, plain=subject.plain)
        for _ in range(_LIGHT_COMES):
            self.stage.step(0.1)
        posed = self.stage.posed
        assert posed is not None, "a cloud stands on the stage"
        self._bounds = posed.bounds()

    def picture(self, camera: OrbitCamera, size: tuple[int, int]) -> Pixels:
        """The cloud under its sky, over land; (height, width, 3), top row first."""
        sight, depth = camera.view(_ORIGIN), camera.projection(size[0] / size[1])
        with _canvas(self._gl, size) as canvas:
            self._ground.draw(self.stage.weather, depth @ sight, camera.eye() + _ORIGIN, grid=False)
            canvas.use()
            self.stage.draw(sight, depth)
            return _read(canvas)

    def cutout(self, camera: OrbitCamera, size: tuple[int, int]) -> Pixels:
        """The cloud alone; (height, width, 4), colour not multiplied by the last channel.

        Clouds are blended as C + (1 - a) B with whatever is behind them: two pictures, over black
        and over white, tell C and a.
        """
        sight, depth = camera.view(_ORIGIN), camera.projection(size[0] / size[1])
        shots = []
        self.stage.sky(False)
        for shade in (0.0, 1.0):
            with _canvas(self._gl, size, shade) as canvas:
                self.stage.draw(sight, depth)
                shots.append(_read(canvas).astype(np.float32) / 255.0)
        self.stage.sky(True)
        alpha = np.clip(1.0 - (shots[1] - shots[0]).mean(axis=2, keepdims=True), 0.0, 1.0)
        color = np.where(alpha > 1.0 / 255.0, shots[0] / np.maximum(alpha, 1e-3), 0.0)
        rgba = np.concatenate((np.clip(color, 0.0, 1.0), alpha), axis=2)
        return np.rint(rgba * 255.0).astype(np.uint8)

    def way_round(
        self, count: int, pitches: tuple[float, ...], aspect: float
    ) -> list[list[OrbitCamera]]:
        """Cameras round the cloud, a row for each pitch, all as far from it as the farthest needs.

        A pitch below 0 looks down at it, rad.
        """
        rows = []
        for pitch in pitches:
            row = [OrbitCamera(yaw=math.tau * k / count, pitch=pitch) for k in range(count)]
            for camera in row:
                camera.frame(*self._bounds, aspect)
            rows.append(row)
        farthest = max(camera.distance for row in rows for camera in row)
        for row in rows:
            for camera in row:
                camera.distance = farthest
        return rows

    def close(self) -> None:
        """Give everything back."""
        self.stage.close()  # which puts back what was bound
        self._ground.release()


def still_of_cloud(
    gl: moderngl.Context, path: Path, subject: Subject, camera: OrbitCamera, size: tuple[int, int]
) -> None:
    """Write what the cloud view shows, without its marks. Raises OSError."""
    with closing(Shooter(gl, subject)) as shooter:
        write_png(path, shooter.picture(camera, size))


def still_of_world(path: Path, studio: Studio, size: tuple[int, int]) -> None:
    """Write what the world view shows. Raises OSError."""
    with _canvas(studio.gl, size) as canvas:
        for _ in range(3):  # clouds that were impostors of the view come in at this size
            canvas.use()
            studio.scene.draw(studio.camera, size[0] / size[1])
        write_png(path, _read(canvas))


def turntable(
    gl: moderngl.Context,
    path: Path,
    subject: Subject,
    size: tuple[int, int] = (1280, 720),
    frames: int = 180,
    fps: float = 30.0,
    pitch: float = -0.06,
) -> Iterator[float]:
    """Write a film once round a cloud, a frame at a time; yields how far it is, 0 to 1.

    Nothing is left on disk where it is not run to its end. Raises OSError, MissingExtraError.
    """
    with (
        closing(Shooter(gl, subject)) as shooter,
        written_whole(path) as other,
        closing(film(other, size, fps)) as writer,
    ):
        way = shooter.way_round(frames, (pitch,), size[0] / size[1])[0]
        for k, camera in enumerate(way):
            writer.send(shooter.picture(camera, size).tobytes())
            yield (k + 1) / (frames + 1)
    yield 1.0


def impostor_sheet(
    gl: moderngl.Context,
    path: Path,
    subject: Subject,
    tile: int = 256,
    columns: int = 8,
    pitches: tuple[float, ...] = (-0.35, 0.0, 0.35),
) -> Iterator[float]:
    """Write a sheet of pictures from all sides, transparent round the cloud; yields how far it is.

    Columns go once round the cloud; rows look down, level and up at it, each pitch a row, rad.
    Tiles are twice as wide as high. Raises OSError.
    """
    rows, size = len(pitches), (2 * tile, tile)
    sheet = np.zeros((rows * size[1], columns * size[0], 4), np.uint8)
    with closing(Shooter(gl, subject)) as shooter:
        for row, cameras in enumerate(shooter.way_round(columns, pitches, 2.0)):
            for column, camera in enumerate(cameras):
                y, x = row * size[1], column * size[0]
                sheet[y : y + size[1], x : x + size[0]] = shooter.cutout(camera, size)
                yield (row * columns + column + 1) / (rows * columns + 1)
    write_png(path, sheet)
    yield 1.0


class _canvas:
    """A framebuffer for one picture."""

    def __init__(self, gl: moderngl.Context, size: tuple[int, int], shade: float = 0.0) -> None:
        self._color = gl.texture(size, 4)
        self._depth = gl.depth_renderbuffer(size)
        self._framebuffer = gl.framebuffer([self._color], self._depth)
        self._shade = shade

    def __enter__(self) -> moderngl.Framebuffer:
        shade = self._shade
        self._framebuffer.use()
        self._framebuffer.clear(shade, shade, shade, 1.0, depth=1.0)
        return self._framebuffer

    def __exit__(self, *_rest: object) -> None:
        for part in (self._framebuffer, self._depth, self._color):
            part.release()


def _read(canvas: moderngl.Framebuffer) -> Pixels:
    """(height, width, 3), top row first."""
    width, height = canvas.size
    data = canvas.read(components=3, alignment=1)
    return np.ascontiguousarray(np.frombuffer(data, np.uint8).reshape(height, width, 3)[::-1])
