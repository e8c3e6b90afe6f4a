"""`WorldView`: the weather as a player sees it from the ground, on foot or in the air."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from weather_ecs.editor import theme, view
from weather_ecs.editor.studio import Studio, studio_of
from weather_ecs.editor.view_bar import tip_of_last, toggle

if TYPE_CHECKING:
    from weather_ecs.editor.document import Document
    from weather_ecs.editor.shared import Shared

_POINTS = ("N", "NE", "E", "SE", "S", "SW", "W", "NW")
_V = imgui.ImVec2


class WorldView:
    """The panel that shows the world."""

    title = "World"

    def __init__(self, shared: Shared) -> None:
        pass

    def draw(self, document: Document, shared: Shared) -> None:
        """The bar, the picture, and what there is where the eye is."""
        studio = studio_of(shared)
        _draw_bar(studio)
        rect = view.space_left()
        if rect.width < 2.0 or rect.height < 2.0:
            return
        shared.moves |= studio.picture(rect.pixels, shared.dt, document.revision)
        hovered = view.show("world picture", studio.target, rect)
        self._steer(studio, shared, hovered)
        _draw_readout(studio, rect)

    def _steer(self, studio: Studio, shared: Shared, hovered: bool) -> None:
        io, camera = imgui.get_io(), studio.camera
        if imgui.is_item_active() and (io.mouse_delta.x or io.mouse_delta.y):
            camera.look(io.mouse_delta.x, io.mouse_delta.y)
        if hovered and io.mouse_wheel:
            camera.zoom(io.mouse_wheel)
        if io.want_text_input or io.key_ctrl or not (hovered or imgui.is_item_active()):
            return
        ahead, aside, above = view.flight()
        if ahead or aside or above:
            camera.move(ahead, aside, above, min(shared.dt, 0.1), fast=io.key_shift)


def _draw_bar(studio: Studio) -> None:
    camera = studio.camera
    flying = toggle("Fly", camera.flying, "Off the ground, with E and Q up and down")
    if flying != camera.flying:
        if flying:
            camera.flying = True
            camera.height = max(camera.height, 60.0)
        else:
            camera.land()
    imgui.same_line(0.0, 4.0)
    if imgui.button("Home"):
        camera.go(0.0, 55.0)
        camera.land()
        camera.yaw, camera.pitch = 0.0, math.radians(12.0)
        camera.zoom(math.log(camera.fov / math.radians(60.0)) / -math.log(0.9))
    tip_of_last("Back to the village green, looking north")
    text = f"{_POINTS[round(camera.bearing / 45.0) % 8]} {camera.bearing:.0f}°"
    text += f"   {camera.height:.0f} m up" if camera.flying else ""
    help_text = "Drag: look   W A S D: go   Shift: faster   Wheel: closer"
    imgui.same_line(0.0, 12.0)
    imgui.text(text)
    room = imgui.get_window_width() - imgui.calc_text_size(help_text).x - 12.0
    imgui.same_line()
    if room > imgui.get_cursor_pos_x():
        imgui.same_line(room)
        imgui.text_disabled(help_text)
    else:
        imgui.new_line()


def readout(studio: Studio) -> list[str]:
    """The weather where the eye is, in lines of text."""
    eye = studio.camera.eye()
    sample = studio.simulation.weather.sample(tuple(eye.tolist()))
    wind = math.hypot(sample.wind[0], sample.wind[2])
    bearing = math.degrees(math.atan2(-sample.wind[0], sample.wind[2])) % 360.0
    seen = sample.visibility
    far = f"{seen / 1000.0:.0f} km" if seen >= 9500.0 else f"{seen:,.0f} m".replace(",", " ")
    lines = [
        f"{sample.temperature:.1f} °C   {100.0 * sample.humidity:.0f} %",
        f"wind {wind:.1f} m/s" + (f" from {bearing:.0f}°" if wind >= 0.05 else ""),
        f"sees {far}",
    ]
    if sample.rain_rate > 0.0:
        lines.append(f"rain {sample.rain_rate:.1f} mm/h")
    if sample.snow_rate > 0.0:
        lines.append(f"snow {sample.snow_rate:.1f} mm/h of water")
    clouds, state = len(studio.simulation.frame.clouds), studio.simulation.weather.stats.state
    lines.append(f"{clouds} clouds, state {state:.2f}")
    return lines


def _draw_readout(studio: Studio, rect: view.Rect) -> None:
    """A small plate in the corner of the picture."""
    text = "\n".join(readout(studio))
    size = imgui.calc_text_size(text)
    if size.x + 36.0 > rect.width or size.y + 28.0 > rect.height:
        return
    x, y = rect.x + 10.0, rect.y + 10.0
    lines = imgui.get_window_draw_list()
    far = _V(x + size.x + 16.0, y + size.y + 12.0)
    lines.add_rect_filled(_V(x, y), far, theme.packed((0.06, 0.07, 0.09, 0.66)), 5.0)
    lines.add_text(_V(x + 8.0, y + 6.0), theme.packed(theme.TEXT), text)
