"""`python -m weather_ecs.editor [FILE]`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from weather_ecs.errors import MissingExtraError, WeatherError


def main(arguments: Sequence[str] | None = None) -> int:
    """Open the editor; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m weather_ecs.editor",
        description="Make clouds, skies and weather, and see them live.",
    )
    parser.add_argument("file", nargs="?", metavar="FILE", help="a file of clouds to open")
    parser.add_argument(
        "--size", default="1280x720", metavar="WxH", help="of the window in pixels (1280x720)"
    )
    given = parser.parse_args(arguments)
    try:
        width, height = (int(part) for part in given.size.lower().split("x"))
        if not (1 <= width <= 16384 and 1 <= height <= 16384):
            raise ValueError
    except ValueError:
        parser.error(f"--size: {given.size!r}: allowed: WxH, each 1 to 16384, as 1280x720")
    import pyglet

    pyglet.options.debug_gl = False  # an error of OpenGL shows in a picture, and ends nothing
    try:
        import pyglet.window
    except Exception as error:  # it opens the display; what fails differs by system
        print(f"error: no window: {error}", file=sys.stderr)  # noqa: T201
        return 1
    try:
        from weather_ecs.editor.app import run
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in (
            "imgui_bundle",
            "OpenGL",
            "PIL",
            "imageio_ffmpeg",
        ):
            raise
        missing = MissingExtraError("editor", str(error.name))
        print(f"error: {missing}", file=sys.stderr)  # noqa: T201 - the program's own line
        return 1
    try:
        run(given.file, (width, height))
    except WeatherError as error:
        print(f"error: {error}", file=sys.stderr)  # noqa: T201
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
