"""The OpenGL context of a pyglet window, current for a while; pyglet itself is not imported."""

from __future__ import annotations

import logging
import sys
from typing import Any
from weakref import WeakSet

from weather_ecs.errors import ContextError, InvalidValueError

_log = logging.getLogger("weather_ecs")
_flat: WeakSet[Any] = WeakSet()  # windows of which the log has said that they are


def check_window(window: Any) -> None:
    """Raises InvalidValueError for what is no window, ContextError for one that is closed."""
    if window is None:
        return
    if isinstance(window, type) or not hasattr(window, "switch_to"):
        raise InvalidValueError("window", window, "a pyglet window or None")
    if window.context is None:
        raise ContextError("the window is closed")


def can_be_drawn_to(window: Any) -> bool:
    """Whether it is open and has a size."""
    if window.context is None or window.has_exit:
        return False
    width, height = window.get_size()
    return width > 0 and height > 0


def matrices_of(window: Any, view: Any, projection: Any) -> tuple[Any, Any]:
    """View and projection, those that are None by the window's own.

    One line in the log tells a game that has set none: pyglet's first projection is flat.
    """
    if view is None:
        view = window.view
    if projection is None:
        projection = window.projection
        if _is_flat(projection, window.get_size()[0]) and window not in _flat:
            _flat.add(window)
            _log.warning(
                "the window's projection is flat, a pixel for a metre: set window.view and "
                "window.projection to the camera's, or hand both to draw"
            )
    return view, projection


def _is_flat(projection: Any, width: int) -> bool:
    """Whether it is a pyglet `Mat4` of parallel rays, with a pixel for a metre."""
    if not isinstance(projection, tuple) or len(projection) != 16:
        return False
    return bool(projection[15] == 1.0 and abs(projection[0] * width - 2.0) < 0.01)


class current:  # no generator: that takes three times as long, in every draw
    """Make a window's context current, and afterwards the one that was before."""

    __slots__ = ("_before", "_window")

    def __init__(self, window: Any) -> None:
        self._window = window
        self._before: Any = None

    def __enter__(self) -> None:
        window = self._window
        if window is None:
            return
        if window.context is None:
            raise ContextError("the window is closed")
        gl = sys.modules.get("pyglet.gl")  # where there is a window, pyglet has loaded it
        before = None if gl is None else gl.current_context
        if before is not window.context:
            window.switch_to()
            self._before = before

    def __exit__(self, *error: object) -> None:
        before, self._before = self._before, None
        if before is not None:
            before.set_current()
