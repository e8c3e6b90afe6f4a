"""`EditorWindow`: the window, its frame, and the panels in it."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Any

import moderngl
import pyglet
from imgui_bundle import imgui

from weather_ecs.editor import panels, theme, view
from weather_ecs.editor.cloud_view import CloudView
from weather_ecs.editor.dialogs import Dialogs
from weather_ecs.editor.document import Document
from weather_ecs.editor.files import Files
from weather_ecs.editor.gui import Gui
from weather_ecs.editor.help_page import draw_help
from weather_ecs.editor.layout import GAP, Box, boxes, part_of, workspace_of
from weather_ecs.editor.menu_table import WORKSPACES, commands_of, menus_of
from weather_ecs.editor.menus import draw_bar, press_keys
from weather_ecs.editor.pace import Pace
from weather_ecs.editor.panel_guard import draw_panel
from weather_ecs.editor.panels import Entry
from weather_ecs.editor.session import Session
from weather_ecs.editor.shared import Panel, Shared

TITLE = "Weather editor"
SHORTEST = 1.0 / 120.0  # s between frames where the display does not set the pace
SMALLEST = (640, 400)
_FIXED = (
    imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_resize
    | imgui.WindowFlags_.no_collapse
    | imgui.WindowFlags_.no_title_bar
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_bring_to_front_on_focus
    | imgui.WindowFlags_.no_background
)


class EditorWindow(pyglet.window.Window):
    """The editor in a window."""

    def __init__(
        self,
        path: str | os.PathLike[str] | None,
        size: tuple[int, int],
        files: Files | None = None,
    ) -> None:
        self.pace = Pace()
        self.drawn = 0  # frames
        super().__init__(
            *size, caption=TITLE, resizable=True, vsync=True, visible=False, file_drops=True
        )
        self.set_minimum_size(*SMALLEST)
        self.shared = Shared(moderngl.get_context())
        self.session = Session(self.shared, files)
        self.dialogs = Dialogs()
        self.gui = Gui(self)
        self.entries: list[tuple[Entry, Panel]] = []
        for entry in panels.PANELS:
            self.entries.append((entry, panels.make(entry, self.shared)))
        self._last = time.perf_counter()
        self._ready = True
        self._caption = ""
        self._helps = False
        self.commands = commands_of(self)
        if path is not None and not self.session.load(Path(path)):
            self.session.document.path = None
        self.set_visible(True)

    @property
    def document(self) -> Document:
        """What is being edited."""
        return self.session.document

    @property
    def cloud_view(self) -> CloudView:
        """The view of the cloud."""
        return next(panel for _, panel in self.entries if isinstance(panel, CloudView))

    def play(self) -> None:
        """Run until the window is closed."""
        pyglet.clock.schedule_interval(self.tick, SHORTEST)
        pyglet.app.run(interval=None)

    def shut(self) -> None:
        """Give everything back; a second time does nothing."""
        pyglet.clock.unschedule(self.tick)
        if not self._ready:
            return
        self._ready = False
        self.session.finish_saving()
        self.switch_to()
        for _, panel in self.entries:
            close = getattr(panel, "close", None)
            if close is not None:
                close()
        self.gui.close()
        super().close()

    # One frame

    def dispatch_event(self, *event: Any) -> Any:
        """Whatever comes in may change what is seen."""
        if event[0] not in ("on_draw", "on_refresh"):
            self.pace.wake(time.perf_counter())
        return super().dispatch_event(*event)

    def tick(self, _dt: float = 0.0) -> None:
        """A frame, if one is due: nothing is drawn anew that would come out the same."""
        if self._ready and self.pace.due(time.perf_counter(), moves=self.shared.moves):
            self.frame()

    def frame(self, _dt: float = 0.0) -> None:
        """Everything, once; `draw` of pyglet's calls `on_draw`."""
        if self._ready:
            self.draw(_dt)

    def on_draw(self) -> None:
        if not self._ready:
            return
        now = time.perf_counter()
        dt, self._last = now - self._last, now
        self.drawn += 1
        width, height = self.get_framebuffer_size()
        self.shared.pass_time(dt)
        self.shared.selection.clamp(self.document)
        self._show_name()
        self.gui.begin(dt)
        for entry, panel in self.entries:
            update = getattr(panel, "update", None)
            if update is not None and workspace_of(entry.place) == self.shared.workspace:
                update(self.document, self.shared)
        self._draw_all()
        screen = self.shared.gl.detect_framebuffer(0)
        screen.use()
        if width > 0 and height > 0:
            screen.viewport = (0, 0, width, height)
            self.shared.gl.scissor = None
            screen.clear(*theme.PANEL)
            view.copy_pictures(height)
            screen.use()
        self.gui.end(seen=width > 0 and height > 0)
        if self.session.closing:
            pyglet.clock.schedule_once(lambda _dt: self.shut(), 0.0)

    def _draw_all(self) -> None:
        """Menus, panels, what asks; then what keys have called for."""
        if imgui.is_key_pressed(imgui.Key.escape):
            imgui.internal.close_popups_except_modals()
        self.session.look_at_disk()
        menus = menus_of(self)
        self.shared.workspace = draw_bar(menus, WORKSPACES, self.shared.workspace)
        self._lay_out()
        self.dialogs.draw(self.session)
        self._helps = draw_help(menus, self._helps)
        if not imgui.is_popup_open("", imgui.PopupFlags_.any_popup):
            if not imgui.is_window_focused(imgui.FocusedFlags_.any_window):
                # After a window that asked there may be none, and then no key means anything.
                imgui.set_window_focus(f"{self.shared.workspace} view")
            press_keys(menus)
        self.shared.selection.clamp(self.document)

    def toggle_help(self) -> None:
        """Show the page of keys, or put it away."""
        self._helps = not self._helps

    def toggle_fullscreen(self) -> None:
        """The whole screen, or a window."""
        self.set_fullscreen(not self.fullscreen)

    def _show_name(self) -> None:
        caption = f"{'• ' if self.document.dirty else ''}{self.document.name} - {TITLE}"
        if caption != self._caption:
            self._caption = caption
            self.set_caption(caption)

    def _lay_out(self) -> None:
        size = imgui.get_io().display_size
        here = [
            (entry, panel)
            for entry, panel in self.entries
            if workspace_of(entry.place) == self.shared.workspace
        ]
        below = any(part_of(entry.place) == "below" for entry, _ in here)
        parts = boxes(size.x, size.y, imgui.get_frame_height() + 12.0, below=below)
        _draw_gaps(parts, size.x, below=below)
        for name, box in parts.items():
            mine = [(entry, panel) for entry, panel in here if part_of(entry.place) == name]
            if name == "status":
                self._draw_status(box)
            elif mine and mine[0][0].share < 1.0:
                self._draw_stacked(box, mine)
            elif mine:
                self._draw_tabs(box, name, [panel for _, panel in mine])

    def _draw_stacked(self, box: Box, mine: list[tuple[Entry, Panel]]) -> None:
        y = box.y
        for entry, panel in mine:
            high = box.height * entry.share
            part = Box(box.x, y, box.width, max(high - 4.0, 1.0))
            with _Window(f"{entry.place.value} {panel.title}", part) as window:
                if window:
                    imgui.separator_text(panel.title)
                    draw_panel(panel, self.document, self.shared)
            y += high

    def _draw_tabs(self, box: Box, name: str, mine: list[Panel]) -> None:
        with _Window(f"{self.shared.workspace} {name}", box) as window:
            if not window:
                return
            if len(mine) == 1:
                draw_panel(mine[0], self.document, self.shared)
            elif imgui.begin_tab_bar("panels"):
                for panel in mine:
                    if imgui.begin_tab_item(panel.title)[0]:
                        draw_panel(panel, self.document, self.shared)
                        imgui.end_tab_item()
                imgui.end_tab_bar()

    def _draw_status(self, box: Box) -> None:
        with _Window("status", box) as window:
            if window:
                problem = self.document.problem
                if problem:
                    imgui.text_colored(theme.vec4(theme.BAD), problem)
                elif self.shared.note:
                    color = theme.BAD if self.shared.note_bad else theme.TEXT
                    imgui.text_colored(theme.vec4(color), self.shared.note)

    # Events

    def on_close(self) -> None:
        """The question about unsaved changes comes first."""
        if self._ready:
            self.session.quit()

    def on_key_press(self, symbol: int, modifiers: int) -> None:
        """Escape closes nothing here."""

    def on_file_drop(self, x: int, y: int, paths: list[str]) -> None:
        """The first file that was let go over the window is opened."""
        if self._ready and paths:
            self.session.open_path(Path(paths[0]))


def _draw_gaps(parts: dict[str, Box], width: float, *, below: bool) -> None:
    """Darker stripes between the parts: the ground is that of the panels."""
    lines = imgui.get_background_draw_list()
    color = theme.packed(theme.BACK)
    left, view_box, status = parts["left"], parts["view"], parts["status"]
    stripes = [
        Box(left.width, left.y, GAP, left.height),
        Box(parts["right"].x - GAP, left.y, GAP, left.height),
        Box(0.0, status.y - GAP, width, GAP),
    ]
    if below:
        bottom = view_box.y + view_box.height
        stripes.append(Box(view_box.x, bottom, view_box.width, GAP))
    for x, y, wide, high in stripes:
        lines.add_rect_filled(imgui.ImVec2(x, y), imgui.ImVec2(x + wide, y + high), color)


class _Window:
    """A window of imgui that stands where it is told to."""

    def __init__(self, name: str, box: Box, flags: int = 0) -> None:
        self._name, self._box, self._flags = name, box, flags

    def __enter__(self) -> bool:
        imgui.set_next_window_pos(imgui.ImVec2(self._box.x, self._box.y))
        imgui.set_next_window_size(imgui.ImVec2(self._box.width, self._box.height))
        return bool(imgui.begin(self._name, None, _FIXED | self._flags)[0])

    def __exit__(self, *_rest: Any) -> None:
        imgui.end()


def run(path: str | os.PathLike[str] | None, size: tuple[int, int]) -> None:
    """Open the editor, with a file if there is one, and run it until it is closed."""
    window = EditorWindow(None if path is None else Path(path), size)
    try:
        window.play()
    finally:
        window.shut()
