"""The windows that ask: unsaved changes, a path, a file that has changed, what went wrong."""

from __future__ import annotations

from imgui_bundle import imgui

from weather_ecs.editor import theme
from weather_ecs.editor.file_dialog import FileDialog
from weather_ecs.editor.session import Session

_FLAGS = (
    imgui.WindowFlags_.always_auto_resize
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
)
_WIDE = 420.0


class Dialogs:
    """Shows what a session asks; `draw` in every frame."""

    def __init__(self) -> None:
        self._path = FileDialog()

    @property
    def shown(self) -> bool:
        """Whether the path is being asked for."""
        return self._path.shown

    def draw(self, session: Session) -> None:
        """The one that is due."""
        if session.wants_path is not None:
            title, done, saves = session.wants_path
            session.wants_path = None
            self._path.ask(title, session.document.path, done, saves=saves)
        self._path.draw()
        if session.shared.exports is not None:
            session.shared.exports.draw(session.document, session.shared)
        _unsaved(session)
        _changed(session)
        _trouble(session)


def _unsaved(session: Session) -> None:
    if session.question is None:
        return
    with Modal("Unsaved changes") as shown:
        if not shown:
            return
        imgui.text_wrapped(f"{session.document.name} has changes that are not saved.")
        imgui.dummy(imgui.ImVec2(_WIDE, 6.0))
        answers = (("Save", "save"), ("Don't save", "drop"), ("Cancel", "cancel"))
        pressed = _answers([label for label, _ in answers])
        if imgui.is_key_pressed(imgui.Key.escape):
            pressed = "Cancel"
        elif imgui.is_key_pressed(imgui.Key.enter):
            pressed = "Save"
        if pressed is not None:
            imgui.close_current_popup()
            session.answer(dict(answers)[pressed])


def _changed(session: Session) -> None:
    if not session.changed_outside or session.question is not None:
        return
    with Modal("Changed on disk") as shown:
        if not shown:
            return
        imgui.text_wrapped(
            f"Another program has changed {session.document.name}, and there are changes here"
            " that are not saved. Reading it again can be undone."
        )
        imgui.dummy(imgui.ImVec2(_WIDE, 6.0))
        pressed = _answers(["Read it again", "Keep mine"])
        if pressed or imgui.is_key_pressed(imgui.Key.escape):
            imgui.close_current_popup()
            session.changed_outside = False
            if pressed == "Read it again":
                session.reload()
            elif pressed == "Keep mine":
                session.keep_mine()


def _trouble(session: Session) -> None:
    if not session.trouble:
        return
    with Modal("That did not work") as shown:
        if not shown:
            return
        imgui.push_text_wrap_pos(_WIDE + 120.0)
        imgui.text_unformatted(session.trouble)
        imgui.pop_text_wrap_pos()
        imgui.text_disabled("Everything is as it was.")
        imgui.dummy(imgui.ImVec2(_WIDE, 6.0))
        over = _answers(["Copy the text", "Close"])
        if over == "Copy the text":
            imgui.set_clipboard_text(session.trouble)
        keys = (imgui.Key.escape, imgui.Key.enter)
        if over == "Close" or any(imgui.is_key_pressed(key) for key in keys):
            imgui.close_current_popup()
            session.trouble = ""


class Modal:
    """A window over all others, in the middle, that is opened when it is first drawn."""

    def __init__(self, title: str) -> None:
        self._title, self._open = title, False

    def __enter__(self) -> bool:
        if not imgui.is_popup_open(self._title):
            imgui.open_popup(self._title)
        size = imgui.get_io().display_size
        middle = imgui.ImVec2(0.5 * size.x, 0.45 * size.y)
        imgui.set_next_window_pos(middle, imgui.Cond_.always, imgui.ImVec2(0.5, 0.5))
        # Wrapped text in its first frame has no width to go by.
        wide = min(_WIDE + 40.0, 0.95 * size.x)
        imgui.set_next_window_size(imgui.ImVec2(wide, 0.0), imgui.Cond_.appearing)
        self._open = bool(imgui.begin_popup_modal(self._title, None, _FLAGS)[0])
        return self._open

    def __exit__(self, *_rest: object) -> None:
        if self._open:
            imgui.end_popup()


def _answers(labels: list[str]) -> str | None:
    pressed = None
    for number, label in enumerate(labels):
        if number:
            imgui.same_line()
        if not number:  # what Enter means
            imgui.push_style_color(imgui.Col_.button, theme.vec4(theme.ACCENT_LOW))
        if imgui.button(label, imgui.ImVec2(128.0, 0.0)):
            pressed = label
        if not number:
            imgui.pop_style_color()
    return pressed
