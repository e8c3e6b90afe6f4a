"""`Files`: opens, saves and watches the file of a document, and knows the recent ones."""

from __future__ import annotations

import os
from collections.abc import Callable
from enum import Enum
from pathlib import Path
from time import monotonic
from typing import NamedTuple

from weather_ecs.cloud_files import read_content
from weather_ecs.editor.document import Content, Document
from weather_ecs.editor.kept_text import kept_text
from weather_ecs.editor.recent import Recent
from weather_ecs.errors import WeatherError, WeatherFileError
from weather_ecs.file_text import read_text, write_text

LOOK_EVERY = 0.5  # s between two looks at a file on disk


class OnDisk(Enum):
    """What has become of a document's file since it was read or written last."""

    SAME = "same"
    CHANGED = "changed"
    GONE = "gone"


class News(NamedTuple):
    """What `Files.follow` has to say, and whether it is bad."""

    text: str
    bad: bool = False


class ChangedOnDiskError(WeatherError):
    """A file that somebody else has written meanwhile: saving would undo that."""

    def __init__(self, path: Path) -> None:
        self.path = path
        super().__init__(f"{path}: was changed on disk; reload it, save anyway, or save as another")


class Files:
    """The way between documents and disk.

    Everything raises WeatherError or OSError and then leaves document and disk as they were:

        files.new(document)
        files.open(document, path)          # also for a file that is dropped on the window
        files.save(document)                # document.path has to be set, else use save_as
        files.save(document, anyway=True)   # after ChangedOnDiskError, when the user wants it
        files.save_as(document, path)
        files.reload(document)              # one step of undo: nothing is lost by it
        news = files.follow(document)       # once a frame; looks at the disk twice a second
        if news is not None: shared.say(news.text, bad=news.bad)
        for path in files.recent.paths: ...

    Ask about unsaved changes (`document.dirty`) before `new` and `open`. Saving keeps comments and
    layout of what has not changed.
    """

    def __init__(self, recent: Recent | None = None) -> None:
        self.recent = Recent() if recent is None else recent
        self._stamp: tuple[int, ...] | None = None  # of the file as the document knows it
        self._seen: tuple[int, ...] | None = None  # of the file as it was looked at last
        self._next_look = 0.0

    def new(self, document: Document) -> None:
        """An empty document without a file."""
        document.reset(Content())
        self._noticed(document)

    def open(self, document: Document, path: str | os.PathLike[str]) -> None:
        """Another file in place of what is there."""
        target = Path(path).absolute()
        try:
            stamp, text = _read(target)
            content = read_content(str(target), text)
        except WeatherFileError:
            if not target.exists():
                self.recent.remove(target)
            raise
        document.reset(content, target, text)
        self._noticed(document, stamp)
        self.recent.add(target)

    def save(self, document: Document, *, anyway: bool = False) -> None:
        """Write the document to its file."""
        self.save_as(document, self.may_save(document, anyway=anyway))

    def save_as(self, document: Document, path: str | os.PathLike[str]) -> None:
        """Write the document to a file, which is its own from now on."""
        content = document.content
        self.saved(document, path, content, self.writing(document, path)())

    def may_save(self, document: Document, *, anyway: bool = False) -> Path:
        """Where `save` would write; raises as it does where it may not."""
        if document.path is None:
            raise FileNotFoundError("the document has no file yet")
        if not anyway and self._compare(document) is OnDisk.CHANGED:
            raise ChangedOnDiskError(document.path)
        return document.path

    def writing(self, document: Document, path: str | os.PathLike[str]) -> Callable[[], str]:
        """The work of a save, which any thread may do: it writes the document as it is now, and
        returns the text. What comes out of it is for `saved`.
        """
        name, content = str(Path(path).absolute()), document.content
        text, before = document.text, document.saved_content

        def work() -> str:
            kept = kept_text(name, text, before, content)
            write_text(name, kept)
            return kept

        return work

    def saved(
        self, document: Document, path: str | os.PathLike[str], content: Content, text: str
    ) -> None:
        """The document was written when it had this content; the file is its own from now on."""
        target = Path(path).absolute()
        document.mark_saved(target, text, content)
        self._noticed(document)
        self.recent.add(target)

    def reload(self, document: Document) -> None:
        """Take what the file has become; the step can be undone."""
        if document.path is None:
            return
        stamp, text = _read(document.path)
        content = read_content(str(document.path), text)
        document.end_gesture()
        document.apply(f"reload of {document.name}", content)
        document.mark_saved(document.path, text)
        self._noticed(document, stamp)

    def on_disk(self, document: Document) -> OnDisk:
        """What has become of the file; looks only now and then, and tells everything once."""
        if document.path is None or monotonic() < self._next_look:
            return OnDisk.SAME
        self._next_look = monotonic() + LOOK_EVERY
        stamp = stamp_of(document.path)
        if stamp == self._seen:
            return OnDisk.SAME
        self._seen = stamp
        return self._compare(document)

    def follow(self, document: Document) -> News | None:
        """Keep up with the file: what has changed is taken, unless something here is unsaved."""
        found = self.on_disk(document)
        if found is OnDisk.SAME:
            return None
        if found is OnDisk.GONE:
            document.mark_unsaved()
            return News(f"{document.path} is gone; saving writes it again", bad=True)
        if document.edited:
            return News(f"{document.name} was changed on disk, and here: reload or save?", bad=True)
        try:
            self.reload(document)
        except (WeatherError, OSError) as error:
            document.mark_unsaved()
            return News(f"{error}; what was there is kept", bad=True)
        return News(f"{document.name} was changed on disk and read again")

    def _compare(self, document: Document) -> OnDisk:
        """Whether the file says something else than the document last knew it to say."""
        if document.path is None:
            return OnDisk.SAME
        stamp = stamp_of(document.path)
        if stamp is None:
            return OnDisk.GONE
        if stamp == self._stamp:
            return OnDisk.SAME
        try:
            same = read_text(str(document.path)) == document.text
        except WeatherFileError:
            same = False
        if same:
            self._stamp = stamp
            if document.dirty and not document.edited:  # it was gone or bad, and is back
                document.mark_saved(document.path, document.text)
        return OnDisk.SAME if same else OnDisk.CHANGED

    def _noticed(self, document: Document, stamp: tuple[int, ...] | None = None) -> None:
        """The document knows what its file says."""
        if stamp is None and document.path is not None:
            stamp = stamp_of(document.path)
        self._stamp = self._seen = stamp


def stamp_of(path: Path) -> tuple[int, ...] | None:
    """What changes with a file; None where there is none."""
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


def _read(path: Path) -> tuple[tuple[int, ...] | None, str]:
    """A file's stamp, taken first so that no later change is missed, and its text."""
    return stamp_of(path), read_text(str(path))
