"""The bar over the cloud view: what is shown, the gizmo, the sun."""

from __future__ import annotations

from imgui_bundle import imgui

from weather_ecs.editor import theme
from weather_ecs.editor.cloud_stage import Posed
from weather_ecs.editor.shared import Shared

_MODES = (
    ("Billboards", "billboards", "The cloud as games show it"),
    ("Seeds", "boxes", "Boxes of the seeds: the model's own bright, those of roots faint"),
    ("CFA rays", "rays", "From each seed to the sun: yellow lets light through, red absorbs it"),
    ("Roots", "roots", "Arrows as long as the last level, with the rim of their opening"),
)


def draw_bar(shared: Shared, posed: Posed | None) -> None:
    """Two groups of buttons and the sun; one line."""
    for label, field, tip in _MODES:
        setattr(shared.modes, field, toggle(label, getattr(shared.modes, field), tip))
        imgui.same_line(0.0, 4.0)
    imgui.same_line(0.0, 14.0)
    for label, kind, tip in (
        ("Move", "move", "Arrows move the chosen seed; Ctrl: in steps of 10 m"),
        ("Size", "size", "Dots move the sides of the chosen seed; Ctrl: in steps of 10 m"),
    ):
        if toggle(label, shared.gizmo == kind, tip) != (shared.gizmo == kind):
            shared.gizmo = "none" if shared.gizmo == kind else kind
        imgui.same_line(0.0, 4.0)
    imgui.same_line(0.0, 14.0)
    if imgui.button("View..."):
        imgui.open_popup("view options")
    tip_of_last("The sun, the grid, the plain light of the dissertation")
    if imgui.begin_popup("view options"):
        _options(shared)
        imgui.end_popup()
    if posed is not None:
        _counts(posed)


def _options(shared: Shared) -> None:
    sun, modes = shared.sunlight, shared.modes
    imgui.text("Sun")
    imgui.set_next_item_width(180)
    sun.azimuth = imgui.slider_float("direction", sun.azimuth, 0.0, 360.0, "%.0f°")[1]
    tip_of_last("Degrees clockwise from north, 0 to 360")
    imgui.set_next_item_width(180)
    sun.elevation = imgui.slider_float("height", sun.elevation, -12.0, 90.0, "%.0f°")[1]
    tip_of_last("Degrees over the horizon, -12 to 90; below 0 the moon and stars give light")
    imgui.separator()
    modes.grid = imgui.checkbox("Grid on the ground, 1 km", modes.grid)[1]
    modes.plain = imgui.checkbox("Plain light, as in the dissertation", modes.plain)[1]


def _counts(posed: Posed) -> None:
    seeds = len(posed.shape.centers)
    text = f"{seeds} seed{'s' * (seeds != 1)}  {len(posed.shape.billboards)} billboards"
    wide = imgui.calc_text_size(text).x
    imgui.same_line()
    left = imgui.get_content_region_avail().x - wide
    if left > 8.0:
        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + left)
        imgui.text_disabled(text)
    else:
        imgui.new_line()


def toggle(label: str, on: bool, tip: str = "") -> bool:
    """A button that stays down; whether it is down now."""
    if on:
        imgui.push_style_color(imgui.Col_.button, theme.vec4(theme.ACCENT_LOW))
        imgui.push_style_color(imgui.Col_.button_hovered, theme.vec4(theme.ACCENT_LOW))
    clicked = imgui.button(label)
    if on:
        imgui.pop_style_color(2)
    if tip:
        tip_of_last(tip)
    return on != clicked


def tip_of_last(text: str) -> None:
    """A tooltip of the item that was just made."""
    if imgui.begin_item_tooltip():
        imgui.push_text_wrap_pos(24.0 * imgui.get_font_size())
        imgui.text_unformatted(text)
        imgui.pop_text_wrap_pos()
        imgui.end_tooltip()
