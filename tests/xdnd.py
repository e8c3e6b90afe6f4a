"""A source of dropped files: another client of the display, which speaks the XDND protocol."""

from __future__ import annotations

import time
from collections.abc import Callable
from ctypes import POINTER, byref, c_long, c_ubyte, c_ulong, cast
from pathlib import Path
from typing import Any

from pyglet.libs.x11 import xlib

VERSION = 5
_ATOM = 4  # XA_ATOM
_REPLACE = 0  # PropModeReplace
_REQUEST, _NOTIFY = 30, 31  # SelectionRequest, SelectionNotify


def hear_selections(window: Any) -> None:
    """What `Window.dispatch_events` leaves to pyglet's own loop: answers about selections."""
    event = xlib.XEvent()
    asked = window._x_display, window._window, _NOTIFY, byref(event)
    while xlib.XCheckTypedWindowEvent(*asked):
        window.dispatch_platform_event(event)


class DragSource:
    """Has a file under the mouse; a file manager as seen from the window it is dropped on."""

    def __init__(self, path: Path) -> None:
        self._data = f"{path.as_uri()}\r\n".encode()
        self._display = xlib.XOpenDisplay(None)
        root = xlib.XDefaultRootWindow(self._display)
        self._window = xlib.XCreateSimpleWindow(self._display, root, 0, 0, 1, 1, 0, 0, 0)
        self._uris = self._atom("text/uri-list")
        types = (c_ulong * 4)(
            *map(self._atom, ("text/plain", "text/uri-list", "UTF8_STRING", "TEXT"))
        )
        self._put(self._window, self._atom("XdndTypeList"), _ATOM, 32, bytes(types), 4)
        xlib.XSetSelectionOwner(self._display, self._atom("XdndSelection"), self._window, 0)
        self.taken = False  # the target has asked for the file and got it

    def drop(self, target: int, at: tuple[int, int], between: Callable[[], object]) -> None:
        """Let the file go over a window, at pixels of the screen; `between` lets the target act."""
        self._send(target, "XdndEnter", VERSION << 24 | 1)
        self._send(target, "XdndPosition", 0, at[0] << 16 | at[1], 0, self._atom("XdndActionCopy"))
        self._send(target, "XdndDrop", 0, 0)
        end = time.monotonic() + 60.0
        while not self.taken:
            assert time.monotonic() < end, "nobody has taken what was dropped"
            between()
            self._answer()

    def close(self) -> None:
        """Leave the display."""
        xlib.XCloseDisplay(self._display)

    def _answer(self) -> None:
        """What the target has asked meanwhile."""
        event = xlib.XEvent()
        while xlib.XPending(self._display):
            xlib.XNextEvent(self._display, byref(event))
            if event.type == _REQUEST:
                self._hand_over(event.xselectionrequest)

    def _hand_over(self, asked: xlib.XSelectionRequestEvent) -> None:
        self._put(asked.requestor, asked.property, self._uris, 8, self._data, len(self._data))
        answer = xlib.XEvent()
        answer.xselection.type = _NOTIFY
        answer.xselection.requestor, answer.xselection.selection = asked.requestor, asked.selection
        answer.xselection.target, answer.xselection.property = asked.target, asked.property
        answer.xselection.time = asked.time
        self._post(asked.requestor, answer)
        self.taken = True

    def _send(self, target: int, name: str, *values: int) -> None:
        event = xlib.XEvent()
        event.xclient.type, event.xclient.format = xlib.ClientMessage, 32
        event.xclient.window, event.xclient.message_type = target, self._atom(name)
        for index, value in enumerate((self._window, *values)):
            event.xclient.data.l[index] = c_long(value).value
        self._post(target, event)

    def _post(self, target: int, event: xlib.XEvent) -> None:
        xlib.XSendEvent(self._display, target, False, 0, byref(event))
        xlib.XFlush(self._display)

    def _put(self, window: int, name: int, kind: int, width: int, data: bytes, count: int) -> None:
        pointer = cast(data, POINTER(c_ubyte))
        xlib.XChangeProperty(self._display, window, name, kind, width, _REPLACE, pointer, count)

    def _atom(self, name: str) -> int:
        return int(xlib.XInternAtom(self._display, name.encode(), False))
