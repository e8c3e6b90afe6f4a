"""Hands for the editor: real mouse and keys on its window, by the names of what it shows.

Every widget that is drawn tells its place on the way, so a test clicks on "New##layer" wherever the
layout has put it. A test runs on a display of its own; the events come from xdotool, by way of X.
"""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

from imgui_bundle import imgui

_ITEMS = (
    "begin_combo", "begin_menu", "begin_tab_item", "button", "checkbox", "collapsing_header",
    "combo", "drag_float", "drag_float2", "drag_float3", "drag_int", "input_int", "input_text",
    "input_text_multiline", "input_text_with_hint", "invisible_button", "menu_item", "selectable",
    "slider_float", "slider_int", "small_button",
)  # fmt: skip
Box = tuple[float, float, float, float]


class Hands:
    """Clicks, drags and types in an editor window, and lets its frames pass."""

    def __init__(self, window: Any) -> None:
        self.window = window
        self.seen: dict[str, tuple[int, Box]] = {}  # frame and box, by ids and label
        self._ids: list[str] = []
        self._frame = 0
        self._heard = {"on_key_release": 0, "on_text": 0}  # events that have come
        for name in self._heard:
            window.push_handlers(**{name: partial(self._hear, name)})
        for name in _ITEMS:
            setattr(imgui, name, self._telling(getattr(imgui, name)))
        push, pop = imgui.push_id, imgui.pop_id

        def push_id(what: Any) -> None:
            self._ids.append(str(what))
            push(what)

        def pop_id() -> None:
            self._ids.pop()
            pop()

        imgui.push_id, imgui.pop_id = push_id, pop_id

    def frames(self, count: int = 1) -> None:
        """Let frames pass, with the events that have come."""
        for _ in range(count):
            self._frame += 1
            self.window.switch_to()
            self.window.dispatch_events()
            self.window.frame()

    def until(self, question: Callable[[], Any], what: str, seconds: float = 200.0) -> None:
        """Let frames pass until something is so."""

        def asked() -> bool:
            if question():
                return True
            self.frames()
            return False

        self.wait(asked, what, seconds)

    def wait(self, question: Callable[[], Any], what: str, seconds: float = 200.0) -> None:
        """Ask until something is so; the question itself lets time pass."""
        end = time.monotonic() + seconds
        while not question():
            assert time.monotonic() < end, f"still not: {what}"

    def box(self, name: str) -> Box:
        """Where a widget is: its label, with the ids before it where that is not enough."""
        self.frames(2)
        found = self._called(name)
        assert found, f"{name} is not to be seen; there are {sorted(self._now())}"
        assert len(found) == 1, f"{name} may be any of {found}"
        return self.seen[found[0]][1]

    def shows(self, name: str) -> bool:
        """Whether a widget is to be seen."""
        return bool(self._called(name))

    def click(self, name: str, at: tuple[float, float] = (0.5, 0.5), button: int = 1) -> None:
        """Click on a widget, at a share of its width and height."""
        self.click_at(*_place(self.box(name), at), button)

    def click_at(self, x: float, y: float, button: int = 1) -> None:
        """Click at pixels of the window."""
        self.move(x, y)
        self._press(button, True)
        self._press(button, False)
        self.frames(2)

    def drag(
        self, name: str, start: tuple[float, float], end: tuple[float, float], steps: int = 4
    ) -> None:
        """Drag with the left button from one share of a widget's box to another."""
        box = self.box(name)
        self.drag_at(_place(box, start), _place(box, end), steps)

    def drag_at(self, start: tuple[float, float], end: tuple[float, float], steps: int = 4) -> None:
        """Drag with the left button between pixels of the window."""
        self.move(*start)
        self._press(1, True)
        for k in range(1, steps + 1):
            part = k / steps
            self.move(start[0] + (end[0] - start[0]) * part, start[1] + (end[1] - start[1]) * part)
        self._press(1, False)
        self.frames(2)

    def move(self, x: float, y: float) -> None:
        """Move the mouse; back when the window has heard of it."""
        px, py = round(x), round(y)
        self._tell("mousemove", px, py)

        def there() -> bool:
            at = imgui.get_io().mouse_pos
            return abs(at.x - px) < 1.5 and abs(at.y - py) < 1.5

        self.until(there, f"the mouse at {px}, {py}")

    def key(self, *names: str) -> None:
        """Press keys, as xdotool calls them: ctrl+z."""
        for name in names:
            with self._hearing("on_key_release", len(name.split("+"))):
                self._tell("key", "--clearmodifiers", name)

    def type(self, text: str) -> None:
        """Type a text."""
        with self._hearing("on_text", len(text)):
            self._tell("type", "--delay", 4, text)

    def _called(self, name: str) -> list[str]:
        """What is to be seen of this name; what only looks like it counts where nothing else is."""
        now = self._now()
        found = [key for key in now if key == name or key.endswith(f"/{name}")]
        return found or [key for key in now if key.rpartition("/")[2].partition("##")[0] == name]

    def _hear(self, name: str, *_event: object) -> None:
        self._heard[name] += 1

    @contextmanager
    def _hearing(self, name: str, count: int) -> Iterator[None]:
        """Let frames pass until so many events of a kind have come, and what they do is done."""
        wanted = self._heard[name] + count
        yield
        self.until(lambda: self._heard[name] >= wanted, f"{count} times {name}")
        self.frames(4)  # widgets take one event a frame: a press, its release

    def _press(self, button: int, down: bool) -> None:
        self._tell("mousedown" if down else "mouseup", button)
        which = {1: 0, 2: 2, 3: 1}[button]
        self.until(lambda: imgui.is_mouse_down(which) == down, f"button {button} {down}")
        self.frames()

    def _tell(self, *arguments: object) -> None:
        subprocess.run(["xdotool", *map(str, arguments)], check=True, timeout=60)

    def _now(self) -> list[str]:
        return [key for key, (frame, _) in self.seen.items() if frame >= self._frame - 1]

    def _telling(self, draw: Callable[..., Any]) -> Callable[..., Any]:
        def drawn(label: str, *rest: Any, **named: Any) -> Any:
            result = draw(label, *rest, **named)
            # A popup that has just been opened is another window, without an item yet.
            opened = result if isinstance(result, bool) else False
            if draw.__name__ in ("begin_combo", "begin_menu") and opened:
                return result
            if imgui.is_item_visible():
                low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
                key = "/".join((*self._ids, label))
                self.seen[key] = (self._frame, (low.x, low.y, high.x, high.y))
            return result

        return drawn


def _place(box: Box, at: tuple[float, float]) -> tuple[float, float]:
    return box[0] + (box[2] - box[0]) * at[0], box[1] + (box[3] - box[1]) * at[1]
