"""Builds the place while the window stays alive."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from demo_game.place import Place

PAUSE = 0.1  # s between two looks at the window


class Abandoned(Exception):
    """The window was closed before there was anything to see."""


def build_place(seed: int) -> Place:
    """A place with everything that takes long already made."""
    place = Place(seed)
    for part in ("meshes", "ground", "grass", "meadow"):
        getattr(place, part)  # made at the first look, then kept
    return place


def prepare_place(seed: int, keep_alive: Callable[[float], bool]) -> Place:
    """Build the place; `keep_alive(seconds)` is called meanwhile and says whether to go on.

    Raises Abandoned where it says no.
    """
    done: list[Place] = []
    failed: list[BaseException] = []

    def work() -> None:
        try:
            done.append(build_place(seed))
        except BaseException as error:  # handed to the thread that waits
            failed.append(error)

    thread = threading.Thread(target=work, name="place", daemon=True)
    begin = time.monotonic()
    thread.start()
    while thread.is_alive():
        if not keep_alive(time.monotonic() - begin):
            raise Abandoned
        thread.join(PAUSE)
    if failed:
        raise failed[0]
    return done[0]
