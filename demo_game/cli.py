"""The command line: a window, or with `--headless` a scripted tour off screen."""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NoReturn

from demo_game.game import START
from demo_game.headless import HeadlessOptions, TourError, encoder_is_installed, run_tour
from demo_game.place.place import BOUNDS
from demo_game.reports import read_report
from demo_game.settings import BACKENDS, QUALITIES, Settings
from demo_game.tours import TOURS
from weather_ecs.errors import WeatherError
from weather_ecs.presets import PRESETS, SKIES

DEFAULT_OUT = Path("out") / "demo"
LARGEST_SIZE = 8192
MOST_FRAMES = 1_000_000
FILMS = (".mp4", ".mkv", ".mov", ".avi")  # that hold what the encoder writes
INTERRUPTED = 130  # what a shell calls Ctrl-C


_OTHER_SKIES = tuple(name for name in SKIES if name not in PRESETS)


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line, and exits with 2."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message}\n")


def _number(
    kind: Callable[[str], float], low: float, high: float, allowed: str
) -> Callable[[str], float]:
    def parse(text: str) -> float:
        try:
            value = kind(text)
        except ValueError:
            value = math.nan
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"got {text!r}, allowed: {allowed}")
        return value

    return parse


def _size(text: str) -> tuple[int, int]:
    parts = text.lower().split("x")
    allowed = f"WIDTHxHEIGHT, each 16 to {LARGEST_SIZE}, such as 1280x720"
    if len(parts) != 2 or not all(part.isascii() and part.isdigit() for part in parts):
        raise argparse.ArgumentTypeError(f"got {text!r}, allowed: {allowed}")
    width, height = int(parts[0][:9]), int(parts[1][:9])
    if not (16 <= width <= LARGEST_SIZE and 16 <= height <= LARGEST_SIZE):
        raise argparse.ArgumentTypeError(f"got {text!r}, allowed: {allowed}")
    return width, height


def _place(text: str) -> tuple[float, float]:
    (x0, _, z0), (x1, _, z1) = BOUNDS
    parts = text.split(",")
    try:
        x, z = (float(part) for part in parts)
    except ValueError:
        x = z = math.nan
    if not (x0 <= x <= x1 and z0 <= z <= z1):
        allowed = f"X,Z in m, X {x0:g} to {x1:g}, Z {z0:g} to {z1:g}, such as --start=6,-55"
        raise argparse.ArgumentTypeError(f"got {text!r}, allowed: {allowed}")
    return x, z


def _one_of(names: Sequence[str]) -> Callable[[str], str]:
    def parse(text: str) -> str:
        if text not in names:
            raise argparse.ArgumentTypeError(f"got {text!r}, allowed: {', '.join(names)}")
        return text

    return parse


def _preset(text: str) -> str:
    if text in PRESETS:
        return PRESETS[text].name
    if text in SKIES or text.lower().endswith(".toml"):
        return text
    allowed = ", ".join((*PRESETS, *_OTHER_SKIES))
    raise argparse.ArgumentTypeError(f"got {text!r}, allowed: {allowed}, or a file, NAME.toml")


def _film(text: str) -> Path:
    if not text.lower().endswith(FILMS):
        raise argparse.ArgumentTypeError(f"got {text!r}, allowed: a file {', '.join(FILMS)}")
    return Path(text)


def _report(text: str) -> Any:
    try:
        return read_report(text)
    except WeatherError as error:
        raise argparse.ArgumentTypeError(" ".join(str(error).split())) from error


def build_parser() -> argparse.ArgumentParser:
    """The parser of `python -m demo_game`."""
    parser = _Parser(
        prog="demo_game",
        description="A first-person walk in and out of the rain.",
        epilog="Without --headless a window opens; where there is no display, the tour is "
        "rendered off screen and its pictures are written instead.",
        allow_abbrev=False,
    )
    add = parser.add_argument
    add("--headless", action="store_true", help="render a tour off screen")
    add(
        "--tour",
        type=_one_of(TOURS),
        metavar="NAME",
        default="walk",
        help="walk: from dry land through the rain area's edge, into the cabin, out by the other "
        "side, all of it in the frames given; run: in through the edge at 6 m/s; crossing: "
        "straight through the edge at --walk-speed; still: in the rain, not moving; clouds: under "
        "a sky that fills from clear to storm, with shafts of rain, then up through a cloud and "
        "over the tops; snow: before, while and after it snows; storm: towards a "
        "thunderstorm that comes up, with lightning; night: along the lamps in a shower under a "
        "full moon. The last four bring their own weather; clouds, snow and storm are a "
        "time-lapse in parts, however many frames they have",
    )
    add("--frames", type=_number(int, 1, MOST_FRAMES, f"1 to {MOST_FRAMES}"), default=600)
    add("--size", type=_size, metavar="WxH", default=(1280, 720), help="default 1280x720")
    add(
        "--dt",
        type=_number(float, 1e-6, 10.0, "a step in s, up to 10"),
        default=1.0 / 60.0,
        help="fixed step in seconds; the same command gives the same pictures",
    )
    add("--seed", type=_number(int, 0, 2**63 - 1, "0 to 2^63 - 1"), default=0)
    add(
        "--quality",
        type=_one_of(QUALITIES),
        metavar="LEVEL",
        default=None,
        help=f"{', '.join(QUALITIES)} (default: auto in a window; off screen medium, as "
        "auto follows the speed of the machine)",
    )
    add(
        "--backend",
        type=_one_of(BACKENDS),
        metavar="NAME",
        default="auto",
        help=", ".join(BACKENDS),
    )
    add(
        "--preset",
        type=_preset,
        metavar="NAME|FILE",
        default="heavy",
        help=f"{', '.join(PRESETS)} (default heavy); {', '.join(_OTHER_SKIES)}: a sky with the "
        "rain that its own clouds bring; or a file of clouds, NAME.toml; on a "
        "tour only what falls and the wind follow a rain, so that the difference of two runs is "
        "the rain; fog, sleet, snow: the air too",
    )
    add(
        "--watch",
        action="store_true",
        help="in the window, with a file: look at it twice a second, and take what has changed",
    )
    add(
        "--metar",
        type=_report,
        metavar="REPORT",
        default=None,
        help="a METAR report in quotes, whose weather takes the place of the preset; what was "
        "understood of it is printed off screen, and shown on F3 in the window (needs the extra "
        "metar)",
    )
    add(
        "--walk-speed",
        type=_number(float, 0.1, 20.0, "0.1 to 20 m/s"),
        default=1.4,
        metavar="SPEED",
        help="of the tour crossing, m/s",
    )
    add("--out", type=Path, metavar="DIR", default=None, help="where the pictures go (PNG)")
    add(
        "--every",
        type=_number(int, 1, MOST_FRAMES, f"1 to {MOST_FRAMES}"),
        metavar="K",
        default=None,
        help="a picture every K frames (default 60)",
    )
    add(
        "--video",
        type=_film,
        metavar="FILE",
        default=None,
        help="a film of the tour, such as walk.mp4 (needs imageio-ffmpeg)",
    )
    add("--stats", type=Path, metavar="FILE", default=None, help="JSON lines, one per frame")
    add(
        "--start",
        type=_place,
        metavar="X,Z",
        default=START,
        help="where in the window the walk begins, in m on the ground: 0,70, before the rain, if "
        "not given; 6,-61 is in the cabin (write --start=-9,-90 where X is negative)",
    )
    add("--fullscreen", action="store_true", help="open the window on the whole screen")
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the game; returns the exit code."""
    parser = build_parser()
    options = parser.parse_args(arguments)
    if options.watch and not options.preset.lower().endswith(".toml"):
        parser.error("argument --watch: needs a file to look at, such as --preset evening.toml")
    try:
        return _run(options)
    except KeyboardInterrupt:
        return INTERRUPTED


def _run(options: argparse.Namespace) -> int:
    settings = Settings(
        quality=options.quality or ("medium" if options.headless else "auto"),
        backend=options.backend,
        fullscreen=options.fullscreen,
    )
    if options.metar is not None:
        if options.headless:
            print(options.metar)
        options.metar = options.metar.text
    if options.headless:
        return _tour(options, settings)
    from demo_game.display import NoDisplay, open_window

    try:
        return open_window(
            settings,
            seed=options.seed,
            preset=options.preset,
            start=options.start,
            metar=options.metar,
            watch=options.watch,
        )
    except NoDisplay as reason:
        print(f"demo_game: no window ({reason}); rendering the tour off screen instead")
    except WeatherError as error:
        return _refuse(str(error))
    settings.quality = options.quality or "medium"
    nothing_asked = options.out is None and options.video is None and options.stats is None
    if nothing_asked and encoder_is_installed():
        options.video = DEFAULT_OUT / f"{options.tour}.mp4"
        options.out = DEFAULT_OUT
    return _tour(options, settings, progress=True)


def _tour(options: argparse.Namespace, settings: Settings, *, progress: bool = False) -> int:
    out, every = options.out, options.every
    nothing_asked = out is None and options.video is None and options.stats is None
    if out is None and (nothing_asked or every is not None):
        out = DEFAULT_OUT
    tour = HeadlessOptions(
        tour=options.tour,
        frames=options.frames,
        size=options.size,
        dt=options.dt,
        seed=options.seed,
        preset=options.preset,
        metar=options.metar,
        walk_speed=options.walk_speed,
        out=out,
        every=every or 60,
        video=options.video,
        stats=options.stats,
        progress=progress,
    )
    try:
        summary = run_tour(tour, settings)
    except (TourError, WeatherError, OSError) as error:
        return _refuse(str(error))
    print(summary)
    return 0


def _refuse(message: str) -> int:
    first = " ".join(message.split())
    print(f"demo_game: {first}", file=sys.stderr)
    return 2
