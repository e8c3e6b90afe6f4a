"""`Files`: opens, saves and watches the file of a document, and knows the recent ones."""

from __future__ import annotations

import os
from enum import Enum
from pathlib import Path
from time import monotonic

from weather_ecs import load_clouds, save_clouds
from weather_ecs.editor.document import Content, Document
from weather_ecs.editor.recent import Recent

LOOK_EVERY = 0.5  # s between two looks at a file on disk


class OnDisk(Enum):
    """What has become of a document's file since it was read or written last."""

    SAME = "same"
    CHANGED = "changed"
    GONE = "gone"


class Files:
    """The way between documents and disk.

    Everything raises WeatherFileError or OSError and then leaves document and disk as they were:

        files.new(document)
        files.open(document, path)          # also for a file that is dropped on the window
        files.save(document)                # document.path has to be set, else use save_as
        files.save_as(document, path)
        if files.on_disk(document) is OnDisk.CHANGED: files.reload(document)   # once a frame
        for path in files.recent.paths: ...

    `reload` is one step of undo, so that nothing is lost by it. Ask about unsaved changes
    (`document.dirty`) before `new` and `open`.
    """

    def __init__(self, recent: Recent | None = None) -> None:
        self.recent = Recent() if recent is None else recent
        self._stamp: tuple[int, ...] | None = None
        self._told = OnDisk.SAME
        self._next_look = 0.0

    def new(self, document: Document) -> None:
        """An empty document without a file."""
        document.reset(Content())
        self._noticed(document)

    def open(self, document: Document, path: str | os.PathLike[str]) -> None:
        """Another file in place of what is there."""
        target = Path(path).absolute()
        content = load_clouds(target)
        document.reset(content, target, target.read_text(encoding="utf-8"))
        self._noticed(document)
        self.recent.add(target)

    def save(self, document: Document) -> None:
        """Write the document to its file."""
        if document.path is None:
            raise FileNotFoundError("the document has no file yet")
        self.save_as(document, document.path)

    def save_as(self, document: Document, path: str | os.PathLike[str]) -> None:
        """Write the document to a file, which is its own from now on."""
        target = Path(path).absolute()
        save_clouds(target, document.content)
        document.mark_saved(target, target.read_text(encoding="utf-8"))
        self._noticed(document)
        self.recent.add(target)

    def reload(self, document: Document) -> None:
        """Take what the file has become; the step can be undone."""
        if document.path is None:
            return
        content = load_clouds(document.path)
        text = document.path.read_text(encoding="utf-8")
        document.apply(f"Reload {document.name}", content)
        document.mark_saved(document.path, text)
        self._noticed(document)

    def on_disk(self, document: Document) -> OnDisk:
        """What has become of the file; looks only now and then, and tells everything once."""
        if document.path is None or monotonic() < self._next_look:
            return OnDisk.SAME
        self._next_look = monotonic() + LOOK_EVERY
        stamp = stamp_of(document.path)
        if stamp == self._stamp:
            self._told = OnDisk.SAME
            return OnDisk.SAME
        news = OnDisk.GONE if stamp is None else OnDisk.CHANGED
        document.mark_unsaved()
        self._stamp = stamp
        return news

    def _noticed(self, document: Document) -> None:
        self._stamp = None if document.path is None else stamp_of(document.path)
        self._told = OnDisk.SAME


def stamp_of(path: Path) -> tuple[int, ...] | None:
    """What changes with a file; None where there is none."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
