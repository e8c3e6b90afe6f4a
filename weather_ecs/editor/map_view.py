"""`MapView`: the world from above: rectangles of the layers, clouds, rain, wind, and the eye."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from imgui_bundle import imgui

from weather_ecs.components import SkyLayer
from weather_ecs.editor import theme, view
from weather_ecs.editor.content import with_item
from weather_ecs.editor.document import Content, Document
from weather_ecs.editor.map_frame import Handle, MapFrame, dragged
from weather_ecs.editor.shared import Shared
from weather_ecs.editor.studio import Studio, studio_of
from weather_ecs.tools import FrameData

MOST_CLOUDS = 2500  # drawn; of more every second, third … one
LAND: theme.Color = (0.125, 0.150, 0.125, 1.0)
GRID: theme.Color = (0.235, 0.265, 0.245, 1.0)
LAYERS: tuple[theme.Color, ...] = (
    (0.95, 0.80, 0.45, 1.0), (0.55, 0.85, 0.60, 1.0), (0.60, 0.75, 1.00, 1.0),
    (0.90, 0.60, 0.85, 1.0), (0.95, 0.62, 0.45, 1.0), (0.55, 0.90, 0.90, 1.0),
)  # fmt: skip
_LEFT, _RIGHT = 0, 1
_V = imgui.ImVec2


class MapView:
    """The panel that shows the map. Rain areas are moved, sized and turned in it."""

    title = "Map"

    def __init__(self, shared: Shared) -> None:
        self._held: Handle | None = None
        self._grip = (0.0, 0.0)  # m, from an area's middle to where it was taken

    def draw(self, document: Document, shared: Shared) -> None:
        """The map, and what the mouse does to it."""
        studio = studio_of(shared)
        rect = view.space_left()
        if rect.width < 2.0 or rect.height < 2.0:
            return
        frame = studio.map
        frame.place(*rect)
        if studio.map_wanted:
            studio.map_wanted = False
            _show_all(frame, studio, document)
        corner, far = _V(rect.x, rect.y), _V(rect.x + rect.width, rect.y + rect.height)
        imgui.invisible_button("map", _V(rect.width, rect.height), view.ALL_BUTTONS)
        self._steer(document, shared, studio)
        lines = imgui.get_window_draw_list()
        lines.push_clip_rect(corner, far, True)
        lines.add_rect_filled(corner, far, theme.packed(LAND))
        _draw_grid(lines, frame)
        _draw_clouds(lines, frame, studio.simulation.frame)
        for k, layer in enumerate(document.content.layers):
            _draw_layer(lines, frame, layer, k, k == shared.selection.layer)
        self._draw_rain(lines, frame, studio, document, shared.selection.area)
        _draw_eye(lines, frame, studio)
        _draw_wind(lines, frame, studio)
        _draw_scale(lines, frame)
        lines.pop_clip_rect()
        if imgui.is_item_hovered() and not imgui.is_mouse_down(_LEFT):
            self._tip(document, studio)

    # The mouse

    def _steer(self, document: Document, shared: Shared, studio: Studio) -> None:
        io, frame = imgui.get_io(), studio.map
        x, y = io.mouse_pos.x, io.mouse_pos.y
        areas = document.content.rain_areas
        if imgui.is_item_activated() and imgui.is_mouse_clicked(_LEFT):
            self._held = frame.grasp(areas, shared.selection.area, x, y)
            if self._held is not None:
                shared.selection.area, shared.focus = self._held.area, "area"
                center, (px, pz) = areas[self._held.area].center, frame.world(x, y)
                self._grip = (px - center[0], pz - center[1])
        if imgui.is_item_active() and (io.mouse_delta.x or io.mouse_delta.y):
            held = self._held
            if held is not None and held.area < len(areas) and imgui.is_mouse_down(_LEFT):
                self._drag(document, held, frame.world(x, y))
            elif held is None:
                frame.pan(io.mouse_delta.x, io.mouse_delta.y)
        if imgui.is_item_deactivated():
            if self._held is not None:
                document.end_gesture()
            self._held = None
        if imgui.is_item_hovered():
            if io.mouse_wheel:
                frame.zoom(io.mouse_wheel, x, y)
            if imgui.is_mouse_double_clicked(_LEFT) and frame.grasp(areas, -1, x, y) is None:
                studio.camera.go(*frame.world(x, y))

    def _drag(self, document: Document, held: Handle, to: tuple[float, float]) -> None:
        index = held.area

        def make() -> Content:
            area = dragged(document.content.rain_areas[index], held.part, to, self._grip)
            return with_item(document.content, "rain_areas", index, area)

        what = {"middle": "Move", "turn": "Turn"}.get(held.part, "Size")
        document.try_apply(f"{what} rain area", make, merge=("map", index, held.part))

    def _tip(self, document: Document, studio: Studio) -> None:
        pos = imgui.get_io().mouse_pos
        x, z = studio.map.world(pos.x, pos.y)
        text = f"{x:,.0f} m east, {-z:,.0f} m north".replace(",", " ")
        if abs(x) < 1e7 and abs(z) < 1e7:
            sample = studio.simulation.weather.sample((x, 1.7, z))
            falls = sample.rain_rate + sample.snow_rate
            if falls > 0.0:
                text += f"\n{falls:.1f} mm/h of {'snow' if sample.snow_rate > 0 else 'rain'}"
        held = studio.map.grasp(document.content.rain_areas, -1, pos.x, pos.y)
        hint = "Drag: move the rain area" if held else "Drag: move along. Double click: go there"
        imgui.set_tooltip(f"{text}\n{hint}")

    # The picture

    def _draw_rain(
        self,
        lines: imgui.ImDrawList,
        frame: MapFrame,
        studio: Studio,
        document: Document,
        chosen: int,
    ) -> None:
        data = studio.simulation.frame
        areas = document.content.rain_areas
        for row in data.areas:
            carried = int(row["key"]) in data.carried
            color = (0.75, 0.62, 1.0) if carried else (0.35, 0.66, 1.0)
            strength = min(0.12 + 0.05 * math.log1p(float(row["rain_rate"])), 0.42)
            rim = _rim(frame, row)
            lines.add_convex_poly_filled(rim, theme.packed((*color, strength)))
            outline = theme.packed((*color, 0.9))
            lines.add_polyline(rim, outline, flags=imgui.ImDrawFlags_.closed, thickness=1.5)
        if not 0 <= chosen < len(areas):
            return
        area = areas[chosen]
        if studio.simulation.time > 0.0:  # where the document has it: rain drifts away from there
            points: list[Any] = [_V(*p) for p in frame.rim(area)]
            color_there = theme.packed((1.0, 1.0, 1.0, 0.35))
            lines.add_polyline(points, color_there, flags=imgui.ImDrawFlags_.closed, thickness=1.0)
        handles = frame.handles(chosen, area)
        lines.add_line(_V(*handles[1].at), _V(*handles[3].at), theme.packed(theme.TEXT), 1.0)
        for handle in handles:
            size = 5.0 if handle.part == "turn" else 4.0
            lines.add_circle_filled(_V(*handle.at), size, theme.packed(theme.TEXT))
            lines.add_circle(_V(*handle.at), size, theme.packed(theme.BACK), 0, 1.0)


def _show_all(frame: MapFrame, studio: Studio, document: Document) -> None:
    """Bring all layers, or where there is none all rain, into the picture."""
    content = document.content
    boxes = [(*layer.center, *layer.size) for layer in content.layers]
    boxes += [(*a.center, 2.4 * a.radii[0], 2.4 * a.radii[0]) for a in content.rain_areas]
    if not boxes:
        boxes = [(0.0, 0.0, 4000.0, 4000.0)]
    low = (min(x - 0.5 * w for x, _, w, _ in boxes), min(z - 0.5 * d for _, z, _, d in boxes))
    high = (max(x + 0.5 * w for x, _, w, _ in boxes), max(z + 0.5 * d for _, z, _, d in boxes))
    frame.show(low, high)


def _draw_grid(lines: imgui.ImDrawList, frame: MapFrame) -> None:
    step = frame.spacing()
    (x0, z0), (x1, z1) = (
        frame.world(frame.left, frame.top),
        frame.world(frame.left + frame.width, frame.top + frame.height),
    )
    color = theme.packed(GRID)
    for k in range(math.ceil(x0 / step), math.floor(x1 / step) + 1):
        px = frame.pixel(k * step, 0.0)[0]
        lines.add_line(_V(px, frame.top), _V(px, frame.top + frame.height), color, 1.0)
    for k in range(math.ceil(z0 / step), math.floor(z1 / step) + 1):
        py = frame.pixel(0.0, k * step)[1]
        lines.add_line(_V(frame.left, py), _V(frame.left + frame.width, py), color, 1.0)


def _draw_clouds(lines: imgui.ImDrawList, frame: MapFrame, data: FrameData) -> None:
    """Low clouds over high ones would hide them: all are drawn half through."""
    if not len(data.clouds):
        return
    rows = data.clouds[:: -(-len(data.clouds) // MOST_CLOUDS)]
    radii = np.array([shape.radius for shape in data.cloud_shapes])[rows["shape"]]
    position = rows["position"]
    px = frame.left + 0.5 * frame.width + (position[:, 0] - frame.x) / frame.scale
    py = frame.top + 0.5 * frame.height + (position[:, 2] - frame.z) / frame.scale
    size = np.maximum(0.8 * radii * rows["scale"] / frame.scale, 1.5)
    alpha = 0.3 * rows["opacity"] * rows["growth"]
    shade = 0.95 - 0.45 * rows["darkness"]
    seen = (np.abs(px - frame.left - 0.5 * frame.width) < 0.5 * frame.width + size) & (
        np.abs(py - frame.top - 0.5 * frame.height) < 0.5 * frame.height + size
    )
    for x, y, r, s, a in np.stack((px, py, size, shade, alpha), -1)[seen].tolist():
        color = imgui.get_color_u32(imgui.ImVec4(s, s, s, a))
        lines.add_circle_filled(_V(x, y), r, color, 10 if r < 8.0 else 0)


def _draw_layer(
    lines: imgui.ImDrawList, frame: MapFrame, layer: SkyLayer, index: int, chosen: bool
) -> None:
    x, z = layer.center
    w, d = layer.size
    a, b = frame.pixel(x - 0.5 * w, z - 0.5 * d), frame.pixel(x + 0.5 * w, z + 0.5 * d)
    color = theme.packed(LAYERS[index % len(LAYERS)])
    lines.add_rect(_V(*a), _V(*b), color, thickness=2.5 if chosen else 1.0)
    label = f"{layer.base:,.0f} m".replace(",", " ")
    at = _V(max(a[0], frame.left) + 5.0, max(a[1], frame.top) + 3.0 + 16.0 * (index % 4))
    lines.add_text(at, color, label)


def _rim(frame: MapFrame, row: np.void, points: int = 40) -> list[Any]:
    (x, z), (a, b), heading = row["center"].tolist(), row["radii"].tolist(), float(row["heading"])
    c, s = math.cos(heading), math.sin(heading)
    rim: list[Any] = []
    for k in range(points):
        u, v = a * math.cos(math.tau * k / points), b * math.sin(math.tau * k / points)
        rim.append(_V(*frame.pixel(x + u * c - v * s, z - u * s - v * c)))
    return rim


def _draw_eye(lines: imgui.ImDrawList, frame: MapFrame, studio: Studio) -> None:
    camera = studio.camera
    x, y = frame.pixel(camera.x, camera.z)
    half = 0.5 * camera.fov * 1.5
    corners: list[Any] = [_V(x, y)]
    for k in range(9):
        turn = camera.yaw + half * (1.0 - k / 4.0)
        corners.append(_V(x - 46.0 * math.sin(turn), y - 46.0 * math.cos(turn)))
    lines.add_convex_poly_filled(corners, theme.packed((1.0, 0.85, 0.35, 0.22)))
    lines.add_circle_filled(_V(x, y), 4.0, theme.packed((1.0, 0.85, 0.35, 1.0)))


def _draw_wind(lines: imgui.ImDrawList, frame: MapFrame, studio: Studio) -> None:
    """Arrow in the corner: where the wind blows to, now, and how hard."""
    wind = studio.simulation.frame.wind
    speed = math.hypot(wind[0], wind[2])
    x, y = frame.left + frame.width - 46.0, frame.top + 44.0
    color = theme.packed(theme.TEXT)
    lines.add_circle_filled(_V(x, y), 32.0, theme.packed((0.06, 0.07, 0.09, 0.72)))
    lines.add_text(_V(x - 4.0, y - 31.0), theme.packed(theme.DIM), "N")
    if speed > 0.05:
        dx, dy = wind[0] / speed, wind[2] / speed
        tip, tail = (x + 18.0 * dx, y + 18.0 * dy), (x - 18.0 * dx, y - 18.0 * dy)
        lines.add_line(_V(*tail), _V(*tip), color, 2.0)
        side = (-dy, dx)
        one, other = (
            _V(tip[0] - 9.0 * dx + k * 5.0 * side[0], tip[1] - 9.0 * dy + k * 5.0 * side[1])
            for k in (1, -1)
        )
        lines.add_triangle_filled(_V(*tip), one, other, color)
    text = f"{speed:.1f} m/s" if speed > 0.05 else "calm"
    size = imgui.calc_text_size(text)
    lines.add_rect_filled(
        _V(x - 0.5 * size.x - 5, y + 35), _V(x + 0.5 * size.x + 5, y + 39 + size.y),
        theme.packed((0.06, 0.07, 0.09, 0.72)), 4.0,
    )  # fmt: skip
    lines.add_text(_V(x - 0.5 * size.x, y + 37.0), color, text)


def _draw_scale(lines: imgui.ImDrawList, frame: MapFrame) -> None:
    step = frame.spacing()
    width = step / frame.scale
    text = f"{step / 1000.0:g} km" if step >= 1000.0 else f"{step:g} m"
    x, y = frame.left + 14.0, frame.top + frame.height - 16.0
    color = theme.packed(theme.TEXT)
    lines.add_line(_V(x, y), _V(x + width, y), color, 2.0)
    for end in (x, x + width):
        lines.add_line(_V(end, y - 5.0), _V(end, y + 1.0), color, 2.0)
    lines.add_text(_V(x + 4.0, y - 20.0), color, text)
