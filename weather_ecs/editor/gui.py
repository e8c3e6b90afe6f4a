"""`Gui`: imgui in a pyglet window, with a clock of its own and OpenGL left as it was."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import OpenGL

# Each of the renderer's calls is else followed by queries and checks, which cost milliseconds.
OpenGL.ERROR_CHECKING = OpenGL.ARRAY_SIZE_CHECKING = False

from imgui_bundle import imgui, implot  # noqa: E402
from imgui_bundle.imguizmo import im_guizmo  # noqa: E402
from imgui_bundle.python_backends import pyglet_backend  # noqa: E402
from pyglet import gl  # noqa: E402
from pyglet.window import key, mouse  # noqa: E402

from weather_ecs.editor import theme  # noqa: E402

LONGEST = 0.25  # s of a frame that imgui is told of
_BUTTONS = ((mouse.LEFT, 0), (mouse.RIGHT, 1), (mouse.MIDDLE, 2))


_Renderer: Any = pyglet_backend.PygletProgrammablePipelineRenderer  # type: ignore[attr-defined]


class _Backend(_Renderer):  # type: ignore[misc]
    """The bundle's own, but that a drag with several buttons presses none anew."""

    def on_mouse_drag(self, x: int, y: int, dx: int, dy: int, *_rest: int) -> None:
        self.on_mouse_motion(x, y, dx, dy)

    def on_mouse_leave(self, x: int, y: int) -> None:
        if not any(imgui.is_mouse_down(button) for _, button in _BUTTONS):
            self.io.add_mouse_pos_event(-1.0e9, -1.0e9)

    def on_deactivate(self) -> None:
        """Keys that are let go while another window has the focus are never heard of."""
        self.io.add_focus_event(False)

    def on_activate(self) -> None:
        self.io.add_focus_event(True)


class Gui:
    """One imgui context on one window."""

    def __init__(self, window: Any) -> None:
        self._window = window
        self._context = imgui.create_context()
        implot.create_context()
        io = imgui.get_io()
        io.set_ini_filename("")  # the layout is fixed: nothing to keep
        io.config_windows_move_from_title_bar_only = True
        io.config_error_recovery_enable_assert = False
        io.config_error_recovery_enable_tooltip = False
        io.config_debug_highlight_id_conflicts = False
        io.config_drag_click_to_input_text = True
        theme.apply()
        with state_kept():
            self._backend = _Backend(window)
        # The keypad's Enter and both modifiers are known to it; repeats of text come as text.
        self._backend.key_map[key.ENTER] = imgui.Key.enter
        for handler in (self._backend.on_mouse_leave, self._backend.on_activate):
            window.push_handlers(handler)
        window.push_handlers(self._backend.on_deactivate)

    @property
    def wants_keys(self) -> bool:
        """Whether somebody is typing."""
        return bool(imgui.get_io().want_text_input)

    def begin(self, dt: float) -> None:
        """A frame begins, `dt` seconds after the last."""
        io = imgui.get_io()
        width, height = self._window.get_size()
        io.display_size = imgui.ImVec2(float(max(width, 1)), float(max(height, 1)))
        io.delta_time = min(max(dt, 1.0e-4), LONGEST)
        imgui.new_frame()
        im_guizmo.begin_frame()

    def end(self, *, seen: bool = True) -> None:
        """Draw what the frame has gathered into what is bound; nothing of it if it is not seen."""
        imgui.render()
        if seen:
            with state_kept():
                self._backend.render(imgui.get_draw_data())

    def close(self) -> None:
        """Give everything back."""
        self._window.pop_handlers()
        self._window.pop_handlers()
        self._window.pop_handlers()
        self._window.pop_handlers()
        with state_kept():
            self._backend.shutdown()
        implot.destroy_context()
        imgui.destroy_context(self._context)


_SWITCHES = (gl.GL_BLEND, gl.GL_CULL_FACE, gl.GL_DEPTH_TEST, gl.GL_SCISSOR_TEST)
_BLEND = (
    gl.GL_BLEND_SRC_RGB,
    gl.GL_BLEND_DST_RGB,
    gl.GL_BLEND_SRC_ALPHA,
    gl.GL_BLEND_DST_ALPHA,
)
_EQUATIONS = (gl.GL_BLEND_EQUATION_RGB, gl.GL_BLEND_EQUATION_ALPHA)


@contextmanager
def state_kept() -> Iterator[None]:
    """Put back what the bundle's renderer changes: it forgets the unit, alpha and row length."""
    unit = _get(gl.GL_ACTIVE_TEXTURE)
    gl.glActiveTexture(gl.GL_TEXTURE0)
    texture = _get(gl.GL_TEXTURE_BINDING_2D)
    program, array = _get(gl.GL_CURRENT_PROGRAM), _get(gl.GL_VERTEX_ARRAY_BINDING)
    buffer = _get(gl.GL_ARRAY_BUFFER_BINDING)
    row, alignment = _get(gl.GL_UNPACK_ROW_LENGTH), _get(gl.GL_UNPACK_ALIGNMENT)
    blend, equations = [_get(name) for name in _BLEND], [_get(name) for name in _EQUATIONS]
    box, view = _get_box(gl.GL_SCISSOR_BOX), _get_box(gl.GL_VIEWPORT)
    switches = [(name, gl.glIsEnabled(name)) for name in _SWITCHES]
    gl.glPixelStorei(gl.GL_UNPACK_ALIGNMENT, 4)
    try:
        yield
    finally:
        for name, on in switches:
            (gl.glEnable if on else gl.glDisable)(name)
        gl.glViewport(*view)
        gl.glScissor(*box)
        gl.glBlendEquationSeparate(*equations)
        gl.glBlendFuncSeparate(*blend)
        gl.glPixelStorei(gl.GL_UNPACK_ALIGNMENT, alignment)
        gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, row)
        gl.glUseProgram(program)
        gl.glBindVertexArray(array)
        gl.glBindBuffer(gl.GL_ARRAY_BUFFER, buffer)
        gl.glActiveTexture(gl.GL_TEXTURE0)
        gl.glBindTexture(gl.GL_TEXTURE_2D, texture)
        gl.glActiveTexture(unit)


def _get(name: int) -> int:
    value = ctypes.c_int()
    gl.glGetIntegerv(name, ctypes.byref(value))
    return value.value


def _get_box(name: int) -> tuple[int, int, int, int]:
    values = (ctypes.c_int * 4)()
    gl.glGetIntegerv(name, values)
    return values[0], values[1], values[2], values[3]
