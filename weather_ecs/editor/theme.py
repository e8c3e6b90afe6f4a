"""The editor's look: fonts, colours, spacing."""

from __future__ import annotations

from pathlib import Path

import imgui_bundle
from imgui_bundle import imgui

Color = tuple[float, float, float, float]

SIZE = 15.0  # pixels, of the text

BACK: Color = (0.086, 0.094, 0.110, 1.0)
PANEL: Color = (0.118, 0.129, 0.149, 1.0)
WELL: Color = (0.098, 0.106, 0.124, 1.0)
RAISED: Color = (0.165, 0.180, 0.208, 1.0)
FIELD: Color = (0.200, 0.220, 0.255, 1.0)
HOVER: Color = (0.250, 0.280, 0.330, 1.0)
LINE: Color = (0.235, 0.255, 0.290, 1.0)
TEXT: Color = (0.870, 0.890, 0.915, 1.0)
DIM: Color = (0.560, 0.595, 0.645, 1.0)
LABEL: Color = (0.690, 0.720, 0.765, 1.0)
ACCENT: Color = (0.310, 0.610, 0.890, 1.0)
ACCENT_LOW: Color = (0.180, 0.370, 0.570, 1.0)
GOOD: Color = (0.480, 0.790, 0.480, 1.0)
WARN: Color = (0.960, 0.730, 0.330, 1.0)
BAD: Color = (0.960, 0.430, 0.390, 1.0)

_C = imgui.Col_
_COLORS: dict[imgui.Col_, Color] = {
    _C.text: TEXT,
    _C.text_disabled: DIM,
    _C.window_bg: PANEL,
    _C.child_bg: (0.0, 0.0, 0.0, 0.0),
    _C.popup_bg: (0.135, 0.147, 0.170, 0.99),
    _C.border: LINE,
    _C.frame_bg: FIELD,
    _C.frame_bg_hovered: HOVER,
    _C.frame_bg_active: ACCENT_LOW,
    _C.title_bg: BACK,
    _C.title_bg_active: RAISED,
    _C.menu_bar_bg: BACK,
    _C.scrollbar_bg: (0.0, 0.0, 0.0, 0.0),
    _C.scrollbar_grab: FIELD,
    _C.scrollbar_grab_hovered: HOVER,
    _C.scrollbar_grab_active: ACCENT_LOW,
    _C.check_mark: ACCENT,
    _C.slider_grab: (0.235, 0.455, 0.680, 1.0),
    _C.slider_grab_active: (0.45, 0.72, 0.98, 1.0),
    _C.button: FIELD,
    _C.button_hovered: HOVER,
    _C.button_active: ACCENT_LOW,
    _C.header: (0.180, 0.370, 0.570, 0.75),
    _C.header_hovered: (0.220, 0.420, 0.620, 0.75),
    _C.header_active: ACCENT_LOW,
    _C.separator: LINE,
    _C.tab: RAISED,
    _C.tab_hovered: HOVER,
    _C.tab_selected: ACCENT_LOW,
    _C.tab_selected_overline: ACCENT,
    _C.table_header_bg: RAISED,
    _C.table_border_light: LINE,
    _C.table_border_strong: LINE,
    _C.text_selected_bg: (0.310, 0.610, 0.890, 0.40),
    _C.nav_cursor: ACCENT,
    _C.modal_window_dim_bg: (0.02, 0.03, 0.04, 0.60),
    _C.plot_lines: ACCENT,
    _C.plot_histogram: ACCENT,
}


def apply() -> None:
    """Give the current imgui context fonts, colours and spacing."""
    style = imgui.get_style()
    for which, color in _COLORS.items():
        style.set_color_(which, imgui.ImVec4(*color))
    style.window_padding = imgui.ImVec2(10, 8)
    style.frame_padding = imgui.ImVec2(7, 3)
    style.item_spacing = imgui.ImVec2(6, 5)
    style.item_inner_spacing = imgui.ImVec2(6, 4)
    style.cell_padding = imgui.ImVec2(4, 2)
    style.scrollbar_size = 11.0
    style.grab_min_size = 9.0
    style.window_border_size = 0.0
    style.child_border_size = 1.0
    style.frame_rounding = style.grab_rounding = style.tab_rounding = 4.0
    style.popup_rounding = style.child_rounding = style.window_rounding = 5.0
    style.scrollbar_rounding = 6.0
    style.circle_tessellation_max_error = 0.8  # pixels: a third fewer triangles in a frame
    style.window_title_align = imgui.ImVec2(0.0, 0.5)
    style.hover_stationary_delay = 0.1
    style.font_size_base = SIZE
    folder = Path(imgui_bundle.__file__).parent / "assets" / "fonts" / "Roboto"
    font = folder / "Roboto-Regular.ttf"
    fonts = imgui.get_io().fonts
    if font.is_file():
        fonts.add_font_from_file_ttf(str(font), SIZE)
    else:  # a build of the bundle without its assets
        fonts.add_font_default()


def vec4(color: Color) -> imgui.ImVec4:
    """A colour as imgui wants it."""
    return imgui.ImVec4(*color)


def packed(color: Color) -> int:
    """A colour as imgui's draw lists want it."""
    return int(imgui.get_color_u32(vec4(color)))
