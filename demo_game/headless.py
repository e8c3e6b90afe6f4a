"""The game off screen: a tour at a fixed step, its pictures, film and measurements."""

from __future__ import annotations

import statistics
import sys
import time as clock
from collections.abc import Generator
from contextlib import ExitStack, closing
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.game import Game
from demo_game.mood import CLIMATE
from demo_game.pictures import save_png
from demo_game.place import Place
from demo_game.settings import Settings
from demo_game.stats_writer import StatsWriter, row
from demo_game.tours import make_tour

FILM_RATE = 30.0  # pictures a second at most


class TourError(Exception):
    """The tour cannot run; the message is one line for the player."""


@dataclass(frozen=True)
class HeadlessOptions:
    """What the command line asks of a tour."""

    tour: str = "walk"
    frames: int = 600
    size: tuple[int, int] = (1280, 720)  # px
    dt: float = 1.0 / 60.0  # s
    seed: int = 0
    preset: str = "heavy"
    metar: str | None = None  # a report in place of the preset
    walk_speed: float = 1.4  # m/s, of the tour crossing
    out: Path | None = None  # no pictures where None
    every: int = 60  # frames between two pictures
    video: Path | None = None
    stats: Path | None = None
    progress: bool = False


def encoder_is_installed() -> bool:
    """Whether films can be written."""
    return find_spec("imageio_ffmpeg") is not None


def make_context() -> moderngl.Context:
    """A context of its own, with no window.

    Raises TourError where the machine has no OpenGL 3.3.
    """
    options: dict[str, Any] = {"backend": "egl"} if sys.platform.startswith("linux") else {}
    try:
        return moderngl.create_context(standalone=True, require=330, **options)
    except Exception as error:  # moderngl and glcontext raise plain Exception
        raise TourError(f"no OpenGL 3.3 off screen: {error}") from error


def run_tour(options: HeadlessOptions, settings: Settings) -> str:
    """Run a tour to its end; returns a line that sums it up.

    Raises TourError, OSError, or the weather's own errors.
    """
    if options.video is not None and not encoder_is_installed():
        raise TourError(
            "argument --video: no encoder here, allowed: after pip install imageio-ffmpeg"
        )
    times: list[float] = []
    with ExitStack() as stack:
        if options.out is not None:
            options.out.mkdir(parents=True, exist_ok=True)
        stats = None
        if options.stats is not None:
            stats = stack.enter_context(closing(StatsWriter(options.stats)))
        film = None
        if options.video is not None:
            film = _film(options.video, options.size, options.dt)
            stack.callback(film.close)
        context = make_context()
        stack.callback(context.release)
        target = _Target(context, options.size)
        stack.callback(target.release)
        place = Place(options.seed)
        tour = make_tour(options.tour, place, (options.frames - 1) * options.dt, options.walk_speed)
        game = Game(
            context,
            settings,
            place=place,
            seed=options.seed,
            preset=options.preset,
            tour=tour,
            metar=options.metar,
        )
        stack.callback(game.close)
        for frame in range(options.frames):
            begin = clock.perf_counter()
            game.update(options.dt if frame else 0.0)
            game.draw(target.framebuffer)
            context.finish()
            times.append((clock.perf_counter() - begin) * 1000.0)
            if stats is not None:
                stats.write(
                    row(
                        frame, game.time, times[-1], game.pose.eye, game.weather.stats, _state(game)
                    )
                )
            wanted = options.out is not None and frame % options.every == 0
            filmed = film is not None and frame % film_step(options.dt) == 0
            if wanted or filmed:
                picture = target.read()
                if film is not None and filmed:
                    film.send(picture.tobytes())
                if wanted and options.out is not None:
                    save_png(options.out / f"{options.tour}_{frame:05d}.png", picture)
            if options.progress and (frame + 1) % 60 == 0:
                print(f"demo_game: frame {frame + 1} of {options.frames}", flush=True)
        renderer = str(context.info["GL_RENDERER"])
    return _summary(options, times, renderer)


def _state(game: Game) -> str:
    """Name of the preset, or how far the climate has come: 0 clear to 1 storm."""
    name = game.state
    return f"{name} {game.weather.stats.state:.3f}" if name == CLIMATE else name


def _summary(options: HeadlessOptions, times: list[float], renderer: str) -> str:
    median = statistics.median(times)
    parts = [
        f"{options.tour}: {len(times)} frames of {options.size[0]}x{options.size[1]}",
        f"median {median:.1f} ms ({1000.0 / max(median, 1e-6):.1f} fps) on {renderer}",
    ]
    if options.out is not None:
        parts.append(f"pictures in {options.out}")
    if options.video is not None:
        parts.append(f"film {options.video}")
    if options.stats is not None:
        parts.append(f"measurements {options.stats}")
    return "; ".join(parts)


class _Target:
    """A picture in memory to draw into, with depth that can be read."""

    def __init__(self, context: moderngl.Context, size: tuple[int, int]) -> None:
        self._color = context.texture(size, 4)
        self._depth = context.depth_texture(size)
        self.framebuffer = context.framebuffer([self._color], self._depth)

    def read(self) -> NDArray[np.uint8]:
        """The picture, shape (height, width, 3), top row first."""
        width, height = self.framebuffer.size
        data = self.framebuffer.read(components=3, alignment=1)
        return np.frombuffer(data, np.uint8).reshape(height, width, 3)[::-1]

    def release(self) -> None:
        """Give the GPU objects back."""
        self.framebuffer.release()
        self._depth.release()
        self._color.release()


def film_step(dt: float) -> int:
    """Frames of dt seconds for one of the film's."""
    return max(round(1.0 / (FILM_RATE * dt)), 1)


def _film(path: Path, size: tuple[int, int], dt: float) -> Generator[None, bytes, None]:
    import imageio_ffmpeg

    path.parent.mkdir(parents=True, exist_ok=True)
    # Coded beside the game, on the same cores: in the way that takes least of them.
    film = imageio_ffmpeg.write_frames(
        str(path),
        size,
        fps=min(max(1.0 / (dt * film_step(dt)), 1.0), FILM_RATE),
        codec="libx264",
        quality=6,
        macro_block_size=2,
        ffmpeg_log_level="error",
        output_params=["-preset", "ultrafast", "-threads", "1"],
    )
    film.send(None)
    return film
