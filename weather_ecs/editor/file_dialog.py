"""`FileDialog`: folders and files to choose from, or a path to type."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from imgui_bundle import imgui

from weather_ecs.editor import items, theme

ENDING = ".toml"
MOST = 2000  # entries that are listed of a folder
LONGEST = 4096  # characters of a path

Done = Callable[[Path], None]


class FileDialog:
    """One dialog, opened for opening or for saving; `draw` it in every frame."""

    def __init__(self) -> None:
        self._title = ""
        self._done: Done | None = None
        self._saves = False
        self._opening = False
        self._folder = Path.cwd()
        self._text = ""
        self._chosen = -1
        self._listed: list[tuple[str, bool]] = []
        self._error = ""
        self._over: Path | None = None  # a file that would be replaced
        self._focus = False

    def ask(self, title: str, start: Path | None, done: Done, *, saves: bool) -> None:
        """Open it: `start` is a folder or a file, `done` is called with what is chosen."""
        self._title, self._done, self._saves = title, done, saves
        self._opening = self._focus = True
        self._over, self._error = None, ""
        place = Path.cwd() if start is None else start
        self._text = place.name if start is not None and not place.is_dir() else ""
        self._go(place if place.is_dir() else place.parent)

    @property
    def shown(self) -> bool:
        """Whether it is open."""
        return self._done is not None

    def draw(self) -> None:
        """The window, if it is open."""
        if self._done is None:
            return
        name = f"{self._title}###files"
        if self._opening:
            imgui.open_popup(name)
            self._opening = False
        size = imgui.get_io().display_size
        box = imgui.ImVec2(min(620.0, 0.94 * size.x), min(460.0, 0.92 * size.y))
        imgui.set_next_window_size(box)
        middle = imgui.ImVec2(0.5 * size.x, 0.5 * size.y)
        imgui.set_next_window_pos(middle, imgui.Cond_.always, imgui.ImVec2(0.5, 0.5))
        flags = imgui.WindowFlags_.no_resize | imgui.WindowFlags_.no_move
        if not imgui.begin_popup_modal(name, None, flags)[0]:
            self._done = None
            return
        self._content()
        imgui.end_popup()

    def _content(self) -> None:
        if imgui.button("Up") or (imgui.is_key_pressed(imgui.Key.backspace) and not _typing()):
            self._go(self._folder.parent)
        imgui.same_line()
        if imgui.button("Home"):
            self._go(Path.home())
        imgui.same_line()
        imgui.align_text_to_frame_padding()
        imgui.text_disabled(_short(str(self._folder), imgui.get_content_region_avail().x))
        below = 2.0 * imgui.get_frame_height_with_spacing() + 28.0
        lines = (imgui.get_content_region_avail().y - below) / (
            imgui.get_text_line_height_with_spacing()
        )
        listed = [(f"{text}/" if folder else text, "") for text, folder in self._listed]
        chosen = items.choose("entries", listed, self._chosen, max(lines, 2.0))
        if chosen != self._chosen or (chosen >= 0 and imgui.is_mouse_double_clicked(0)):
            self._pick(chosen, twice=imgui.is_mouse_double_clicked(0))
        if self._focus:
            imgui.set_keyboard_focus_here()
            self._focus = False
        imgui.set_next_item_width(-1.0)
        entered, self._text = imgui.input_text_with_hint(
            "##name", "a file's name or path", self._text, imgui.InputTextFlags_.enter_returns_true
        )
        if self._over is not None:
            imgui.text_colored(theme.vec4(theme.WARN), f"{self._over.name} is there. Replace it?")
        elif self._error:
            imgui.text_colored(theme.vec4(theme.BAD), self._error)
        else:
            imgui.text_disabled("Files of clouds and weather end in .toml")
        label = "Replace" if self._over is not None else "Save" if self._saves else "Open"
        imgui.set_cursor_pos_x(imgui.get_window_width() - 220.0)
        if imgui.button(label, imgui.ImVec2(100.0, 0.0)) or entered:
            self._take()
        imgui.same_line()
        if imgui.button("Cancel", imgui.ImVec2(100.0, 0.0)) or imgui.is_key_pressed(
            imgui.Key.escape
        ):
            self._close()

    def _pick(self, row: int, *, twice: bool) -> None:
        self._chosen = row
        self._over = None
        if not 0 <= row < len(self._listed):
            return
        name, folder = self._listed[row]
        if not folder:
            self._text = name
            if twice:
                self._take()
        elif twice:
            self._go(self._folder / name)

    def _take(self) -> None:
        text = os.path.expanduser(self._text.strip())
        if not text or len(text) > LONGEST or "\0" in text:
            self._error = "a file's name is needed"
            return
        path = self._folder / text
        if _is_folder(path):
            self._text = ""
            self._go(path)
            return
        if self._saves and not path.suffix:
            path = path.with_name(path.name + ENDING)
        if self._saves and self._over != path and path.exists():
            self._over = path
            return
        if not self._saves and not path.is_file():
            self._error = f"there is no file {path.name}"
            return
        done = self._done
        self._close()
        if done is not None:
            done(path)

    def _close(self) -> None:
        self._done = None
        imgui.close_current_popup()

    def _go(self, folder: Path) -> None:
        """List another folder; one that cannot be read says so and is not gone to."""
        try:
            found = []
            with os.scandir(folder) as entries:
                for entry in entries:
                    is_folder = entry.is_dir()
                    if not entry.name.startswith(".") and (
                        is_folder or entry.name.lower().endswith(ENDING)
                    ):
                        found.append((entry.name, is_folder))
                        if len(found) >= MOST:
                            break
        except OSError as error:
            self._error = f"{folder}: {error.strerror}"
            return
        found.sort(key=lambda entry: (not entry[1], entry[0].lower()))
        self._folder, self._listed, self._chosen, self._error = folder.resolve(), found, -1, ""


def _is_folder(path: Path) -> bool:
    try:
        return path.is_dir()
    except OSError:
        return False


def _typing() -> bool:
    return bool(imgui.get_io().want_text_input)


def _short(text: str, width: float) -> str:
    """The end of a text that fits."""
    while len(text) > 8 and imgui.calc_text_size(text).x > width:
        text = "..." + text[7:]
    return text
