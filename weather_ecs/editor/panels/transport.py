"""The bar of the simulation: run, pause, step, scrub, speed, and the state along the way."""

from __future__ import annotations

from typing import Any

from imgui_bundle import imgui

from weather_ecs.components import Climate
from weather_ecs.editor import theme
from weather_ecs.editor.document import Document
from weather_ecs.editor.shared import Shared
from weather_ecs.editor.simulation import FASTEST, SLOWEST, Simulation
from weather_ecs.editor.studio import studio_of
from weather_ecs.editor.view_bar import tip_of_last
from weather_ecs.tools import climate_state

STEPS = ((0.05, "1 tick"), (1.0, "1 s"), (10.0, "10 s"), (60.0, "1 min"))
_V = imgui.ImVec2


class Transport:
    """The panel below the views of the sky; it also lets the time pass."""

    title = "Time"

    def __init__(self, shared: Shared) -> None:
        self._shared = shared
        self._step = 1

    def update(self, document: Document, shared: Shared) -> None:
        """The simulation's share of a frame."""
        studio = studio_of(shared)
        studio.update(document, shared)
        shared.moves |= studio.simulation.running or studio.simulation.seeking

    def close(self) -> None:
        """Give the simulation and its views back, if anybody has asked for them."""
        if self._shared.exports is not None:
            self._shared.exports.close()
        if self._shared.studio is not None:
            self._shared.studio.close()

    def draw(self, document: Document, shared: Shared) -> None:
        """A line of buttons, and the strip of the whole run below it."""
        simulation = studio_of(shared).simulation
        self._draw_buttons(simulation)
        self._draw_strip(document, simulation)

    def _draw_buttons(self, simulation: Simulation) -> None:
        if imgui.button("Pause" if simulation.running else "Run", _V(58.0, 0.0)):
            simulation.running = not simulation.running
        tip_of_last("Space")
        imgui.same_line(0.0, 4.0)
        if imgui.button("Start"):
            simulation.running = False
            simulation.restart()
        tip_of_last("Back to the start")
        step, label = STEPS[self._step]
        imgui.same_line(0.0, 10.0)
        if imgui.button("- step"):
            simulation.step(-step)
        tip_of_last(f"{label} back")
        imgui.same_line(0.0, 4.0)
        if imgui.button("step +"):
            simulation.step(step)
        tip_of_last(f"{label} on")
        imgui.same_line(0.0, 4.0)
        imgui.set_next_item_width(74.0)
        changed, index = imgui.combo("##step", self._step, [name for _, name in STEPS])
        self._step = index if changed else self._step
        tip_of_last("Length of a step; a tick is the fixed step of all weather, 0.05 s")
        imgui.same_line(0.0, 10.0)
        imgui.set_next_item_width(110.0)
        flags = imgui.SliderFlags_.logarithmic | imgui.SliderFlags_.always_clamp
        simulation.speed = imgui.slider_float(
            "##speed", simulation.speed, SLOWEST, FASTEST, "%.3g x", flags
        )[1]
        tip_of_last("Speed: seconds of weather in a second, 0.05 to 600")
        if not simulation.follows and not simulation.seeking:
            imgui.same_line(0.0, 10.0)
            if imgui.button("Again to here"):
                simulation.again()
            tip_of_last(
                "The document was changed on the way. This runs to the same moment again from "
                "the start, by the document as it is now."
            )

    def _draw_strip(self, document: Document, simulation: Simulation) -> None:
        span, now = max(simulation.span, 1.0), simulation.time
        text = f"{clock(simulation.target or now)} / {clock(span)}"
        room = imgui.get_content_region_avail()
        height = max(room.y - imgui.get_text_line_height_with_spacing() - 2.0, 20.0)
        at, width = imgui.get_cursor_screen_pos(), max(room.x, 10.0)
        imgui.invisible_button("strip", _V(width, height))
        if imgui.is_item_active():
            share = (imgui.get_io().mouse_pos.x - at.x) / width
            wanted = min(max(share, 0.0), 1.0) * span
            simulation.running = False
            if abs(wanted - (simulation.target or now)) >= 0.5 * span / width:
                simulation.seek(wanted)
        elif imgui.is_item_hovered():
            share = (imgui.get_io().mouse_pos.x - at.x) / width
            imgui.set_tooltip(f"Drag to any moment: {clock(share * span)}")
        lines = imgui.get_window_draw_list()
        far = _V(at.x + width, at.y + height)
        lines.add_rect_filled(at, far, theme.packed(theme.WELL), 4.0)
        draw_states(lines, document, span, at.x, at.y, width, height)
        x = at.x + width * min(now / span, 1.0)
        if simulation.target is not None:
            goal = at.x + width * min(simulation.target / span, 1.0)
            band = theme.packed((0.96, 0.73, 0.33, 0.30))
            lines.add_rect_filled(_V(min(x, goal), at.y), _V(max(x, goal), far.y), band)
            lines.add_line(_V(goal, at.y), _V(goal, far.y), theme.packed(theme.WARN), 1.0)
        color = theme.packed(theme.ACCENT)
        lines.add_line(_V(x, at.y), _V(x, far.y), color, 2.0)
        lines.add_triangle_filled(_V(x - 5, at.y), _V(x + 5, at.y), _V(x, at.y + 7), color)
        state = simulation.weather.stats.state
        imgui.text(text)
        imgui.same_line(0.0, 16.0)
        imgui.text_disabled(f"state {state:.2f}")
        if simulation.seeking:
            imgui.same_line(0.0, 16.0)
            imgui.text_colored(theme.vec4(theme.WARN), f"on the way: {clock(now)}")


def draw_states(
    lines: imgui.ImDrawList,
    document: Document,
    span: float,
    left: float,
    top: float,
    width: float,
    height: float,
) -> None:
    """The climate's state along the run, and the states of the skies as faint lines."""
    content = document.content

    def level(state: float) -> float:
        return top + height - 5.0 - (height - 10.0) * state

    states = {sky.state for layer in content.layers for sky in layer.skies}
    for state in sorted(states):
        y = level(state)
        lines.add_line(_V(left, y), _V(left + width, y), theme.packed(theme.LINE), 1.0)
    climate = content.climate
    if climate is None:
        return
    count = max(min(int(width / 4.0), 200), 2)
    points: list[Any] = []
    for k in range(count + 1):
        time = span * k / count
        points.append(_V(left + width * k / count, level(state_after(climate, time))))
    fill = theme.packed((0.31, 0.61, 0.89, 0.16))
    for a, b in zip(points, points[1:], strict=False):
        base = top + height
        lines.add_quad_filled(_V(a.x, base), a, b, _V(b.x, base), fill)
    lines.add_polyline(points, theme.packed((0.55, 0.75, 0.95, 0.9)), flags=0, thickness=1.5)


def state_after(climate: Climate, seconds: float) -> float:
    """The state of a climate after so many seconds of weather."""
    passed = seconds * climate.speed if climate.running else 0.0
    elapsed = min(max(climate.elapsed + passed, 0.0), climate.duration)
    return climate_state(climate.initial, climate.final, climate.duration, elapsed)


def clock(seconds: float) -> str:
    """Minutes and seconds, or hours, minutes and seconds."""
    whole = round(max(seconds, 0.0) * 100.0)
    minutes, hundredths = divmod(whole, 6000)
    hours, minutes = divmod(minutes, 60)
    text = f"{minutes:02d}:{hundredths / 100.0:05.2f}"
    return f"{hours}:{text}" if hours else text
