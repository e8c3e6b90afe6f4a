"""The winds: laws, gusts, turbulence, and a plot of what they come to."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from imgui_bundle import imgui, implot
from numpy.typing import NDArray

from weather_ecs.components import Wind
from weather_ecs.editor import items, theme
from weather_ecs.editor.bound import Bound, line, row, rows, take, tidy
from weather_ecs.editor.content import with_item, with_new
from weather_ecs.editor.content import without as without_item
from weather_ecs.editor.document import Content, Document
from weather_ecs.editor.fields import info
from weather_ecs.editor.inside import gust_speeds, law_speeds
from weather_ecs.editor.shared import Shared
from weather_ecs.editor.studio import studio_of

POINTS = 240
LEAST = 60.0  # s that a plot shows
_NAMES = ("a", "b", "c", "d", "e", "f")


class WindPanel:
    """The document's winds; they add up."""

    title = "Wind"

    def __init__(self, shared: Shared) -> None:
        self._plotted: tuple[object, ...] = ()
        self._curves: tuple[NDArray, NDArray, NDArray] | None = None

    def draw(self, document: Document, shared: Shared) -> None:
        """The list, the chosen wind, its plot."""
        winds, chosen = document.content.winds, shared.selection.wind
        with items.well("winds", len(winds)):
            for k, wind in enumerate(winds):
                if imgui.selectable(f"{wind.speed:g} m/s##wind{k}", k == chosen)[0]:
                    shared.selection.wind, shared.focus = k, "wind"
                imgui.same_line(imgui.get_window_width() * 0.34)
                imgui.text_disabled(f"{wind.law}, from {bearing_of(wind.direction):.0f}°")
        pressed = items.edit_buttons("wind", bool(winds))
        if pressed == "New":
            content = with_new(document.content, "winds", Wind(speed=5.0))
            if document.apply("New wind", content):
                shared.selection.wind = len(winds)
        elif pressed == "Copy":
            copy = with_new(document.content, "winds", replace(winds[chosen]), chosen + 1)
            if document.apply("Copy wind", copy):
                shared.selection.wind = chosen + 1
        elif pressed == "Delete":
            document.apply("Delete wind", without_item(document.content, "winds", chosen))
        winds, chosen = document.content.winds, shared.selection.wind
        if chosen >= len(winds):
            imgui.text_disabled("Without any it is calm.")
            return
        self._draw_plot(winds[chosen], studio_of(shared).simulation.time)
        _draw_wind(document, chosen)

    def _draw_plot(self, wind: Wind, now: float) -> None:
        """The law of the wind, and how its gusts go over that."""
        if self._plotted != (wind,):
            self._plotted, self._curves = (wind,), curves(wind)
        assert self._curves is not None, "the curves of this wind"
        times, law, gusts = self._curves
        size = imgui.ImVec2(-1.0, 160.0)
        flags = implot.Flags_.no_menus | implot.Flags_.no_box_select | implot.Flags_.no_mouse_text
        if not implot.begin_plot("##wind", size, flags):
            return
        bare = implot.AxisFlags_.no_label
        implot.setup_axes("s", "m/s", bare, bare)
        implot.setup_axis_format(implot.ImAxis_.x1, "%g s")
        always = implot.Cond_.always
        top = max(float(max(law.max(), gusts.max())) * 1.15, 1.0)
        implot.setup_axes_limits(float(times[0]), float(times[-1]), 0.0, top, always)
        below = implot.LegendFlags_.outside | implot.LegendFlags_.horizontal
        implot.setup_legend(implot.Location_.north, below)
        implot.plot_line("m/s with gusts", times, gusts, _look(theme.ACCENT, 1.6))
        implot.plot_line("by the law", times, law, _look(theme.WARN, 1.6))
        if times[0] <= now <= times[-1]:
            implot.plot_inf_lines("now", np.array([now]), _look(theme.GOOD, 1.2))
        implot.end_plot()


def _look(color: theme.Color, width: float) -> implot.Spec:
    """How a line of the plot is drawn."""
    return implot.Spec(line_color=theme.vec4(color), line_weight=width)


def curves(wind: Wind) -> tuple[NDArray, NDArray, NDArray]:
    """Times in s, speeds in m/s by the law and with the gusts, over what there is to see."""
    end = wind.times[2] + max(wind.start, 0.0)
    if wind.law == "constant":
        end = 6.0 * wind.interval if wind.gustiness > 0.0 else LEAST
    elif wind.period > 0.0:
        end += max(wind.period, wind.times[2])
    times = np.linspace(0.0, min(max(1.05 * end, LEAST), 1e6), POINTS)
    return times, law_speeds(wind, times), gust_speeds(wind, times)


def bearing_of(direction: tuple[float, float]) -> float:
    """Degrees clockwise from north that a wind comes from, by where it blows to (x, z)."""
    return math.degrees(math.atan2(-direction[0], direction[1])) % 360.0


def direction_of(bearing: float) -> tuple[float, float]:
    """Where a wind blows to, (x, z), by the degrees from north that it comes from."""
    turn = math.radians(bearing)
    return -math.sin(turn), math.cos(turn)


def _draw_wind(document: Document, index: int) -> None:
    def put(wind: Wind) -> Content:
        return with_item(document.content, "winds", index, wind)

    wind = document.content.winds[index]
    bound = Bound(document, wind, put, ("wind", index), "Wind")
    row(bound, "speed")
    with line(bound, "direction", "Comes from", info(Wind, "direction")):
        value = bearing_of(wind.direction)
        changed, now = imgui.slider_float("##value", value, 0.0, 360.0, "%.0f°")
        take(bound, "direction", "Direction", changed, direction_of(now))
    row(bound, "law")
    if wind.law != "constant":
        row(bound, "start")
        row(bound, "times")
        row(bound, "period")
        _draw_coefficients(bound, wind)
    rows(bound, "gustiness", "interval", "veer", "veer_period")
    rows(bound, "exponent", "ground", "turbulence", "scale")


def _draw_coefficients(bound: Bound, wind: Wind) -> None:
    """a to f of the laws, three in a line."""
    used = 4 if wind.law == "gust" else 6
    for first in range(0, used, 3):
        names = ", ".join(_NAMES[first : min(first + 3, used)])
        with line(bound, f"coefficients {first}", names, info(Wind, "coefficients")):
            values = list(wind.coefficients[first : min(first + 3, used)])
            drag = {1: imgui.drag_float, 2: imgui.drag_float2, 3: imgui.drag_float3}[len(values)]
            given = values[0] if len(values) == 1 else values
            changed, now = drag("##value", given, 0.01, -100.0, 100.0, "%.2f")  # type: ignore[operator]
            found = [now] if len(values) == 1 else list(now)
            every = [*wind.coefficients]
            every[first : first + len(found)] = [tidy(each) for each in found]
            take(bound, "coefficients", "Coefficients", changed, tuple(every))
