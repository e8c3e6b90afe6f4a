"""`Document`: the file that is being edited, and the way to change it.

How a panel uses it:

    content = document.content                       # a CloudFile: frozen, tuples of components
    model = content.models[shared.model]
    changed, value = imgui.slider_float("opacity", model.opacity, 0.0, 1.0)
    if changed:
        index = shared.model
        document.try_apply(
            "Opacity",                                # what the menu calls it: Undo Opacity
            lambda: with_item(document.content, "models", index, replace(model, opacity=value)),
            merge=("opacity", index),                 # all of one drag is one step
        )
    if imgui.is_item_deactivated_after_edit():
        document.end_gesture()
    if (problem := document.problem_at(("opacity", index))) is not None:
        ...                                           # show it beside the widget

Components are values here: make others by `dataclasses.replace`, never set a field of one that the
document holds. A part that nobody has changed is the same object as before, so `is` tells what has
to be computed again; `document.revision` tells whether anything has.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from pathlib import Path

from weather_ecs import CloudFile
from weather_ecs.editor.content import check, weight
from weather_ecs.editor.history import History
from weather_ecs.errors import InvalidValueError

Content = CloudFile


class Document:
    """One file's content with its past, and whether it is as on disk.

    A change that would make a file that cannot be loaded is refused: the content stays as it was,
    and `problem` says why until the next change that is taken.
    """

    def __init__(self, content: Content | None = None, path: Path | None = None) -> None:
        self._history: History[Content] = History(
            Content() if content is None else content, weigh=weight
        )
        self._saved: Content | None = self._history.state
        self._revision = 0
        self._generation = 0
        self._error: InvalidValueError | None = None
        self._error_at: Hashable | None = None
        self.path = path  # None: never saved
        self.text = ""  # of the file as it was read or written last
        self.saved_content: Content = self._history.state  # what that text says

    # What it is

    @property
    def content(self) -> Content:
        """What the file holds now."""
        return self._history.state

    @property
    def revision(self) -> int:
        """Another number after every change of the content."""
        return self._revision

    @property
    def generation(self) -> int:
        """Another number for every other file: selections and cameras begin anew then."""
        return self._generation

    @property
    def dirty(self) -> bool:
        """Whether there is something that is not saved: edited, or its file is gone or bad."""
        return self._history.state is not self._saved

    @property
    def edited(self) -> bool:
        """Whether it is another than when its file was read or written."""
        return self._history.state is not self.saved_content

    @property
    def name(self) -> str:
        """What a title shows."""
        return "untitled" if self.path is None else self.path.name

    # Changes

    def apply(self, label: str, content: Content, merge: Hashable | None = None) -> bool:
        """Make this the content, as one step of undo; whether it was taken."""
        return self.try_apply(label, lambda: content, merge)

    def try_apply(
        self, label: str, make: Callable[[], Content], merge: Hashable | None = None
    ) -> bool:
        """The same for a content that may be bad: an InvalidValueError of `make` is a problem.

        The same `merge` key as the last step's, within one gesture, makes the two one step.
        """
        try:
            content = make()
            if content is not self.content:
                check(content, self.content)
        except InvalidValueError as error:
            self._error, self._error_at = error, merge
            return False
        self._error = self._error_at = None
        if content is not self.content:
            self._history.push(label, content, merge)
            self._revision += 1
        return True

    def end_gesture(self) -> None:
        """A drag has ended: the next change is a step of its own."""
        self._history.end_gesture()

    # What was refused

    @property
    def problem(self) -> str | None:
        """Why the last change was refused; None when it was taken."""
        return None if self._error is None else str(self._error)

    @property
    def error(self) -> InvalidValueError | None:
        """The same with its field, value and what is allowed."""
        return self._error

    def problem_at(self, merge: Hashable) -> str | None:
        """The problem, if the change that was refused had this merge key."""
        return self.problem if merge is not None and self._error_at == merge else None

    def forget_problem(self) -> None:
        """The user has seen it."""
        self._error = self._error_at = None

    # The past

    @property
    def can_undo(self) -> bool:
        """Whether there is a step to take back."""
        return self._history.undo_label is not None

    @property
    def can_redo(self) -> bool:
        """Whether there is a step to do again."""
        return self._history.redo_label is not None

    @property
    def undo_label(self) -> str | None:
        """What undo would take back."""
        return self._history.undo_label

    @property
    def redo_label(self) -> str | None:
        """What redo would do again."""
        return self._history.redo_label

    @property
    def steps(self) -> tuple[str, ...]:
        """Labels of what was done, from the oldest."""
        return self._history.steps

    def undo(self) -> bool:
        """Take the last step back; whether there was one."""
        return self._moved(self._history.undo())

    def redo(self) -> bool:
        """Do the step again that was taken back last; whether there was one."""
        return self._moved(self._history.redo())

    def _moved(self, moved: bool) -> bool:
        self.forget_problem()
        self._revision += moved
        return moved

    # Files (see `files.Files`, which calls these)

    def reset(self, content: Content, path: Path | None = None, text: str = "") -> None:
        """Another file, without a past; what it holds is as on disk."""
        self._history.reset(content)
        self._generation += 1
        self._revision += 1
        self.forget_problem()
        self.mark_saved(path, text)

    def mark_saved(self, path: Path | None, text: str, content: Content | None = None) -> None:
        """The file at `path` says this, in this text: the content as it is now, or as it was."""
        said = self.content if content is None else content
        if said is self.content:
            self.end_gesture()
        self.path, self.text = path, text
        self._saved = self.saved_content = said

    def mark_unsaved(self) -> None:
        """What is here is nowhere else: the file on disk is gone, or bad."""
        self._saved = None
