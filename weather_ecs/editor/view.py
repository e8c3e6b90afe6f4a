"""A picture in a panel, and the mouse and keys that move its camera."""

from __future__ import annotations

from typing import NamedTuple

from imgui_bundle import imgui

from weather_ecs.editor.camera import OrbitCamera
from weather_ecs.editor.target import Target

UPRIGHT = (imgui.ImVec2(0.0, 1.0), imgui.ImVec2(1.0, 0.0))  # OpenGL's rows go up
HELP = (
    "Drag: turn    Shift+drag or middle: move along    Wheel: nearer, farther\n"
    "Right button held: look round, with W A S D Q E: fly"
)
_LEFT, _RIGHT, _MIDDLE = 0, 1, 2
ALL_BUTTONS = (
    imgui.ButtonFlags_.mouse_button_left
    | imgui.ButtonFlags_.mouse_button_right
    | imgui.ButtonFlags_.mouse_button_middle
)
_FLIGHT = (
    (imgui.Key.w, 0, 1.0),
    (imgui.Key.s, 0, -1.0),
    (imgui.Key.d, 1, 1.0),
    (imgui.Key.a, 1, -1.0),
    (imgui.Key.e, 2, 1.0),
    (imgui.Key.q, 2, -1.0),
)


class Rect(NamedTuple):
    """Where the picture stands in the window, pixels."""

    x: float
    y: float
    width: float
    height: float

    @property
    def aspect(self) -> float:
        """Width over height."""
        return self.width / max(self.height, 1.0)

    @property
    def pixels(self) -> tuple[int, int]:
        """Of the framebuffer, on displays of any density."""
        scale = imgui.get_io().display_framebuffer_scale
        return max(round(self.width * scale.x), 1), max(round(self.height * scale.y), 1)


_pictures: list[tuple[Target, Rect]] = []  # shown in this frame


def space_left() -> Rect:
    """What is left of the window that is being drawn."""
    at, room = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail()
    return Rect(at.x, at.y, max(room.x, 1.0), max(room.y, 1.0))


def show(name: str, target: Target, rect: Rect, *, takes_mouse: bool = True) -> bool:
    """The picture as an item that takes the mouse; whether the mouse is over it.

    It is copied under all widgets at the end of the frame: windows have no ground of their own.
    A gizmo over it is to be drawn before, and has the mouse where the picture does not take it.
    """
    _pictures.append((target, rect))
    imgui.set_cursor_screen_pos(imgui.ImVec2(rect.x, rect.y))
    if not takes_mouse:
        imgui.dummy(imgui.ImVec2(rect.width, rect.height))
        return False
    imgui.invisible_button(name, imgui.ImVec2(rect.width, rect.height), ALL_BUTTONS)
    return bool(imgui.is_item_hovered())


def copy_pictures(height: int) -> None:
    """Copy what was shown in this frame into the window that is bound, `height` pixels high."""
    scale = imgui.get_io().display_framebuffer_scale
    for target, rect in _pictures:
        left, right = round(rect.x * scale.x), round((rect.x + rect.width) * scale.x)
        top, bottom = round(rect.y * scale.y), round((rect.y + rect.height) * scale.y)
        target.copy_to((left, height - bottom, right, height - top))
    _pictures.clear()


def flight() -> tuple[float, float, float]:
    """Where the keys that are held would go, each -1, 0 or 1: ahead, aside to the right, up."""
    way = [0.0, 0.0, 0.0]
    for key, axis, sign in _FLIGHT:
        if imgui.is_key_down(key):
            way[axis] += sign
    return way[0], way[1], way[2]


def steer(camera: OrbitCamera, height: float, dt: float) -> bool:
    """Move the camera as the mouse over the item just shown says; whether it has moved."""
    io = imgui.get_io()
    moved = False
    dx, dy = io.mouse_delta.x, io.mouse_delta.y
    active = imgui.is_item_active()
    if active and (dx or dy):
        if imgui.is_mouse_down(_MIDDLE) or (imgui.is_mouse_down(_LEFT) and io.key_shift):
            camera.pan(dx, dy, height)
            moved = True
        elif imgui.is_mouse_down(_RIGHT):
            camera.look(dx, dy)
            moved = True
        elif imgui.is_mouse_down(_LEFT):
            camera.orbit(dx, dy)
            moved = True
    if active and imgui.is_mouse_down(_RIGHT):
        ahead, aside, above = flight()
        if ahead or aside or above:
            fast = 4.0 if io.key_shift else 1.0
            camera.fly(fast * ahead, fast * aside, fast * above, dt)
            moved = True
    if imgui.is_item_hovered() and io.mouse_wheel:
        camera.zoom(io.mouse_wheel)
        moved = True
    return moved
