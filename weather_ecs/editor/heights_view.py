"""`HeightsView`: the layers' bases beside the low, middle and high bands of the three regions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from imgui_bundle import imgui

from weather_ecs.editor import theme, view
from weather_ecs.editor.bands import BANDS, HIGHEST, LEVELS, REGIONS, describe
from weather_ecs.editor.content import with_item
from weather_ecs.editor.document import Content, Document
from weather_ecs.editor.map_view import LAYERS
from weather_ecs.editor.shared import Shared
from weather_ecs.editor.studio import Studio, studio_of

TOP = 19_000.0  # m of the axis
GRASP = 8.0  # pixels from a layer's line at which the mouse takes it
STEP = 10.0  # m, to which a drag rounds
_COLORS: dict[str, theme.Color] = {
    "low": (0.42, 0.66, 0.46, 0.55),
    "middle": (0.36, 0.56, 0.82, 0.50),
    "high": (0.66, 0.52, 0.86, 0.50),
}
_V = imgui.ImVec2


class HeightsView:
    """The panel with the bands; a layer's base is dragged up and down in it."""

    title = "Heights"

    def __init__(self, shared: Shared) -> None:
        self._held: int | None = None

    def draw(self, document: Document, shared: Shared) -> None:
        """The chart."""
        studio = studio_of(shared)
        rect = view.space_left()
        if rect.width < 120.0 or rect.height < 80.0:
            return
        imgui.invisible_button("heights", _V(rect.width, rect.height))
        top, bottom = rect.y + 30.0, rect.y + rect.height - 14.0

        def level(height: float) -> float:
            return bottom - (bottom - top) * min(max(height / TOP, -0.02), 1.0)

        lines = imgui.get_window_draw_list()
        corner, far = _V(rect.x, rect.y), _V(rect.x + rect.width, rect.y + rect.height)
        lines.add_rect_filled(corner, far, theme.packed(theme.WELL), 5.0)
        left = rect.x + 58.0
        column = (rect.x + rect.width - 12.0 - left) / len(REGIONS)
        for km in range(0, 19, 2):
            y = level(1000.0 * km)
            lines.add_line(_V(left, y), _V(far.x - 12.0, y), theme.packed(theme.LINE), 1.0)
            text = f"{km} km"
            wide = imgui.calc_text_size(text).x
            lines.add_text(_V(left - 8.0 - wide, y - 8.0), theme.packed(theme.DIM), text)
        for k, region in enumerate(REGIONS):
            _draw_region(lines, region, left + k * column, column, level, region == studio.region)
        self._take(document, shared, left, level, bottom, top)
        taken: list[tuple[float, float, float]] = []  # labels: upper and left end, right end
        for k, layer in enumerate(document.content.layers):
            chosen = k == shared.selection.layer
            y = level(layer.base)
            color = theme.packed(LAYERS[k % len(LAYERS)])
            lines.add_line(_V(left, y), _V(far.x - 12.0, y), color, 3.0 if chosen else 1.5)
            text = f"{layer.base:,.0f} m".replace(",", " ")
            text += f"  {describe(layer.base, studio.region)}"
            size = imgui.calc_text_size(text)
            # Labels of layers that lie close together stand beside each other.
            x = far.x - 18.0 - size.x
            while any(abs(y - v) < size.y + 4.0 and x < b and x + size.x > a for v, a, b in taken):
                x -= 12.0
            taken.append((y, x - 12.0, x + size.x + 12.0))
            plate = _V(x - 5.0, y - size.y - 3.0), _V(x + size.x + 5.0, y - 1.0)
            lines.add_rect_filled(*plate, theme.packed((0.06, 0.07, 0.09, 0.80)), 4.0)
            lines.add_text(_V(x, y - size.y - 2.0), color, text)
        self._choose_region(studio, left, column, rect)

    def _take(
        self,
        document: Document,
        shared: Shared,
        left: float,
        level: Callable[[float], float],
        bottom: float,
        top: float,
    ) -> None:
        """Let the mouse choose a layer, and drag its base."""
        layers = document.content.layers
        mouse = imgui.get_io().mouse_pos
        if imgui.is_item_activated() and mouse.x >= left and layers:
            away = [abs(level(layer.base) - mouse.y) for layer in layers]
            nearest = min(range(len(layers)), key=away.__getitem__)
            if away[nearest] <= GRASP:
                self._held = shared.selection.layer = nearest
        held = self._held
        if held is not None and imgui.is_item_active() and imgui.get_io().mouse_delta.y:
            height = (bottom - mouse.y) / max(bottom - top, 1.0) * TOP
            base = min(max(round(height / STEP) * STEP, 0.0), HIGHEST)

            def make() -> Content:
                layer = replace(document.content.layers[held], base=base)
                return with_item(document.content, "layers", held, layer)

            document.try_apply("Layer: base", make, merge=("heights", held))
        if imgui.is_item_deactivated():
            if held is not None:
                document.end_gesture()
            self._held = None
        if imgui.is_item_hovered() and self._held is None:
            imgui.set_tooltip(
                "Heights of cloud bases by the region (Torchelsen 2005, Table 1).\n"
                "Drag a layer's line to move its base; click a region's name to go by it."
            )

    def _choose_region(self, studio: Studio, left: float, column: float, rect: view.Rect) -> None:
        mouse = imgui.get_io().mouse_pos
        if not (imgui.is_item_clicked() and mouse.y < rect.y + 28.0):
            return
        k = int((mouse.x - left) // column)
        if 0 <= k < len(REGIONS):
            studio.region = REGIONS[k]


def _draw_region(
    lines: imgui.ImDrawList,
    region: str,
    x: float,
    width: float,
    level: Callable[[float], float],
    chosen: bool,
) -> None:
    """One region's three bands side by side: middle and high overlap."""
    title = region.capitalize()
    size = imgui.calc_text_size(title)
    middle = x + 0.5 * width
    y = level(TOP) - 24.0
    if chosen:
        plate = _V(middle - 0.5 * size.x - 8.0, y - 2.0), _V(middle + 0.5 * size.x + 8.0, y + 18.0)
        lines.add_rect_filled(*plate, theme.packed(theme.ACCENT_LOW), 4.0)
    color = theme.packed(theme.TEXT if chosen else theme.DIM)
    lines.add_text(_V(middle - 0.5 * size.x, y), color, title)
    bar = (width - 24.0) / len(LEVELS)
    for k, name in enumerate(LEVELS):
        low, high = BANDS[region][name]
        left = x + 12.0 + k * bar
        corner = _V(left + 2.0, level(high))
        far = _V(left + bar - 2.0, level(low))
        red, green, blue, alpha = _COLORS[name]
        shade = theme.packed((red, green, blue, alpha if chosen else 0.5 * alpha))
        lines.add_rect_filled(corner, far, shade, 3.0)
        size = imgui.calc_text_size(name)
        if size.x <= bar - 4.0:
            at = _V(0.5 * (corner.x + far.x - size.x), far.y - size.y - 3.0)
            lines.add_text(at, theme.packed(theme.TEXT), name)
