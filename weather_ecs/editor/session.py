"""`Session`: the document, its file, and the questions that come between."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from weather_ecs.editor.document import Document
from weather_ecs.editor.files import ChangedOnDiskError, Files
from weather_ecs.editor.saving import LARGE, Saving
from weather_ecs.editor.shared import Shared
from weather_ecs.errors import WeatherError

Act = Callable[[], object]


class Session:
    """New, open, save and quit, each of them after the question about unsaved changes.

    What is to be asked stands in `question`, `trouble` and `wants_path`; `dialogs` shows it.
    """

    def __init__(self, shared: Shared, files: Files | None = None) -> None:
        self.shared = shared
        self.document = Document()
        self.files = Files() if files is None else files
        self.question: Act | None = None  # what was asked for and would lose changes
        self.trouble = ""  # what went wrong, to be read
        self.wants_path: tuple[str, Callable[[Path], None], bool] | None = None
        self.changed_outside = False  # the file is another one, and so is what is here
        self._mine = False  # and what is here is to be written over it
        self._saving: tuple[Saving, Callable[[str], None]] | None = None
        self.closing = False  # the window may close

    @property
    def saving(self) -> bool:
        """Whether a save is under way."""
        return self._saving is not None

    # What menus call

    def new(self) -> None:
        """An empty file."""
        self._unless_unsaved(self._new)

    def open(self) -> None:
        """Ask for a file and open it."""
        self._unless_unsaved(lambda: self._ask_path("Open", self.load, saves=False))

    def open_path(self, path: Path) -> None:
        """Open this file: a recent one, or one that was dropped on the window."""
        self._unless_unsaved(lambda: self.load(path))

    def save(self, then: Act | None = None) -> None:
        """Write the file; one without a name asks for it first. `then` follows what went well."""
        if self.document.path is None:
            self.save_as(then)
        else:
            self._write(lambda: self.files.may_save(self.document, anyway=self._mine), then)

    def keep_mine(self) -> None:
        """What is here counts, whatever another program has written; the next save says so."""
        self.changed_outside, self._mine = False, True

    def save_as(self, then: Act | None = None) -> None:
        """Ask for a path and write there."""
        self._ask_path(
            "Save as",
            lambda path: self._write(lambda: path, then),
            saves=True,
        )

    def reload(self) -> None:
        """Take what the file has become."""
        self.finish_saving()
        self.changed_outside = self._mine = False
        name = self.document.name
        if self._tried(lambda: self.files.reload(self.document)):
            self.shared.say(f"{name} has changed on disk and was read again")

    def quit(self) -> None:
        """Close the editor."""
        self._unless_unsaved(self._quit)

    # Answers

    def answer(self, word: str) -> None:
        """To the question about unsaved changes: save, drop or cancel."""
        act, self.question = self.question, None
        if act is None:
            return
        if word == "save":
            self.save(then=act)
        elif word == "drop":
            act()

    def load(self, path: Path) -> bool:
        """Open a file whatever is lost; one that is bad leaves everything as it is."""
        self.finish_saving()
        if not self._tried(lambda: self.files.open(self.document, path)):
            return False
        self.changed_outside = self._mine = False
        self.shared.selection.clamp(self.document)
        self.shared.number = 0
        self.shared.workspace = "cloud" if self.document.content.models else "sky"
        self.shared.say(f"Opened {path}")
        return True

    def look_at_disk(self) -> None:
        """Once a frame: what has become of a save, and what others have done to the file."""
        if self._saving is not None:
            if not self._saving[0].done:
                self.shared.moves = True
                return
            self.finish_saving()
        edited = self.document.edited
        news = self.files.follow(self.document)
        if news is None:
            return
        self.shared.say(news.text, bad=news.bad)
        path = self.document.path
        self.changed_outside = bool(news.bad and edited and path is not None and path.is_file())

    # How

    def finish_saving(self) -> bool:
        """Wait for a save that is under way, if there is one; False where it has failed."""
        saving, self._saving = self._saving, None
        if saving is None:
            return True
        work, ended = saving
        return self._tried(lambda: ended(work.result()))

    def _unless_unsaved(self, act: Act) -> None:
        if not self.finish_saving():
            return  # first that is to be read
        if self.document.dirty:
            self.question = act
        else:
            act()

    def _ask_path(self, title: str, done: Callable[[Path], object], *, saves: bool) -> None:
        self.wants_path = title, lambda path: (done(path), None)[1], saves

    def _new(self) -> None:
        self.files.new(self.document)
        self.changed_outside = self._mine = False
        self.shared.selection.clamp(self.document)
        self.shared.workspace = "cloud"

    def _write(self, where: Callable[[], Path], then: Act | None) -> None:
        """Save to the path that `where` gives; a large document in a thread of its own."""
        self.finish_saving()
        document = self.document
        try:
            path = where()
        except ChangedOnDiskError as error:
            if error.path.is_file():
                self.changed_outside = True  # asks which of the two counts
                return
            path = error.path  # a folder, say: what is the matter with it the attempt tells
        content = document.content

        def ended(text: str) -> None:
            self.files.saved(document, path, content, text)
            self.changed_outside = self._mine = False
            self.shared.say(f"Saved {document.path}")
            if then is not None:
                then()

        work = self.files.writing(document, path)
        if sum(len(model.seeds) for model in content.models) < LARGE:
            self._tried(lambda: ended(work()))
            return
        self.shared.say(f"Saving {path}")
        self._saving = Saving(work), ended

    def _quit(self) -> None:
        self.closing = True

    def _tried(self, act: Act) -> bool:
        try:
            act()
        except WeatherError as error:
            self.trouble = str(error)
        except OSError as error:
            self.trouble = f"{error.filename or self.document.name}: {error.strerror or error}"
        else:
            return True
        return False
