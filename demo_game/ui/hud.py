"""The readout on F3, and short messages at the foot of the window."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import pyglet

from demo_game.compass import compass
from demo_game.ui.theme import MARGIN, PADDING, TEXT_DIM, Frame, Layer, Rect, Text
from demo_game.weather_changer import MARKS
from weather_ecs import Sample

ROWS = (
    "frame",
    "drops moved",
    "drops drawn",
    "rain",
    "falls here",
    "one sees",
    "air",
    "wind",
    "sky",
    "clouds",
    "quality",
    "engine",
    "position",
    "weather",
    "report",
    "report 2",
    "report 3",
)
WIDTH = 360.0  # units
ROW = 18.5
NAME_WIDTH = 112.0
SIZE = 12.5
STRIP = 36.0  # at the foot, of the state over time
DRY, WET = (190, 190, 180), (80, 150, 255)  # colours of its bars

INTERVAL = 0.25  # s between two readings; figures that change faster cannot be read

MESSAGE_TIME = 2.6  # s


class Readout:
    """A panel of names and values at the upper left."""

    def __init__(self, frame: Frame) -> None:
        self._layer = layer = Layer(frame)
        px = frame.px
        height = px(ROW * len(ROWS) + STRIP + 2 * PADDING)
        self.panel = Rect(px(MARGIN), frame.height - px(MARGIN) - height, px(WIDTH), height)
        layer.panel(self.panel)
        self._values: dict[str, Text] = {}
        for index, name in enumerate(ROWS):
            y = self.panel.top - px(PADDING + ROW * (index + 0.5))
            x = self.panel.x + px(PADDING)
            if not name[-1].isdigit():
                layer.text(name, x, y, SIZE, color=TEXT_DIM)
            self._values[name] = layer.text("", x + px(NAME_WIDTH), y, SIZE)

        self._strip: list[pyglet.shapes.Rectangle] = []
        side = (px(WIDTH) - 2 * px(PADDING)) / MARKS
        for index in range(MARKS):
            x, y = self.panel.x + px(PADDING) + index * side, self.panel.y + px(PADDING)
            bar = pyglet.shapes.Rectangle(
                x, y, side * 0.8, 1.0, color=DRY, batch=layer.batch, group=layer.marks
            )
            self._strip.append(layer.add(bar))

    def show_strip(self, history: Sequence[tuple[float, float]]) -> None:
        """State of the skies (height) and rain in mm/h (blue) over time, the newest right."""
        past = [(0.0, 0.0)] * (MARKS - len(history)) + list(history)
        for bar, (state, rate) in zip(self._strip, past[-MARKS:], strict=True):
            bar.height = max(1.0, state * self._layer.frame.px(STRIP - 8.0))
            wet = 1.0 - math.exp(-rate / 6.0)
            r, g, b = (round(dry + wet * (blue - dry)) for dry, blue in zip(DRY, WET, strict=True))
            bar.color = (r, g, b, 255)

    def show(self, values: Mapping[str, str]) -> None:
        """Set the values; a name without one is left empty."""
        for name, text in self._values.items():
            text.set(values.get(name, ""))

    def draw(self) -> None:
        """Draw it."""
        self._layer.draw()

    def delete(self) -> None:
        """Give the GPU memory back."""
        self._layer.delete()


class Message:
    """One line at the foot of the window that goes away by itself."""

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        self._layer: Layer | None = None
        self._left = 0.0

    def say(self, text: str) -> None:
        """Show a line."""
        self.delete()
        frame = self._frame
        px = frame.px
        self._layer = layer = Layer(frame)
        label = layer.text(text, frame.width / 2, px(MARGIN + 22), 17, anchor_x="center")
        width = label.width + px(4 * PADDING)
        layer.panel(Rect(round((frame.width - width) / 2), px(MARGIN), width, px(44)))
        self._left = MESSAGE_TIME

    def update(self, dt: float) -> None:
        """Let dt seconds pass."""
        if self._layer is not None:
            self._left -= dt
            if self._left <= 0.0:
                self.delete()

    def draw(self) -> None:
        """Draw the line, if there is one."""
        if self._layer is not None:
            self._layer.draw()

    def delete(self) -> None:
        """Take the line away."""
        if self._layer is not None:
            self._layer.delete()
            self._layer = None


def readout_values(
    *,
    ms: float,
    stats: object,
    here: Sample,
    wind: tuple[float, float],
    state: str,
    quality: str,
    backend: str,
    position: tuple[float, float, float],
    weather: str = "",
    report: Sequence[str] = (),
) -> dict[str, str]:
    """The texts of the readout; wind is its speed in m/s and heading in rad."""

    def get(name: str) -> Any:
        return getattr(stats, name, 0)

    used = str(get("quality"))
    return {
        "frame": f"{ms:.1f} ms   {1000.0 / max(ms, 0.01):.0f} fps",
        "drops moved": f"{int(get('drops_moved')):,}".replace(",", "\u202f"),
        "drops drawn": f"{int(get('drops_drawn')):,}".replace(",", "\u202f"),
        "rain": str(get("mode")),
        "falls here": _falls(here),
        "one sees": _length(here.visibility),
        "air": f"{here.temperature:.1f} \u00b0C   {100.0 * here.humidity:.0f} %",
        "wind": f"{wind[0]:.1f} m/s to {compass(wind[1])}",
        "sky": state,
        "clouds": _clouds(get),
        "quality": used if quality in (used, "") else f"{quality}: {used}",
        "engine": backend,
        "position": "  ".join(f"{value:.1f}" for value in position) + " m",
        "weather": weather,
        **dict(zip(("report", "report 2", "report 3"), report, strict=False)),
    }


def _falls(here: Sample) -> str:
    """Rates of rain and snow, mm/h of water; under a roof nothing falls."""
    if here.sheltered:
        return "nothing, sheltered"
    parts = [("rain", here.rain_rate), ("snow", here.snow_rate)]
    found = [f"{name} {rate:.1f}" for name, rate in parts if rate >= 0.05]
    return " + ".join(found) + " mm/h" if found else "nothing"


def _clouds(get: Callable[[str], Any]) -> str:
    """The climate's state; clouds in view, impostors taken anew, absorption factors computed."""
    figures = f"{int(get('clouds_drawn'))}, {int(get('impostors_refreshed'))} new"
    return f"{float(get('state')):.2f}   {figures}, CFA {int(get('cfa_computed'))}"


def _length(meters: float) -> str:
    return f"{meters:.0f} m" if meters < 1000.0 else f"{meters / 1000.0:.1f} km"
