"""`Recent`: the files that were opened last, kept between two runs of the editor."""

from __future__ import annotations

import json
import os
import sys
from contextlib import suppress
from pathlib import Path

MOST = 12
LARGEST = 65_536  # bytes


def settings_folder() -> Path:
    """Where programs of this user keep what they remember."""
    if sys.platform == "win32":
        base = os.environ.get("APPDATA") or str(Path.home() / "AppData" / "Roaming")
    elif sys.platform == "darwin":
        base = str(Path.home() / "Library" / "Application Support")
    else:
        base = os.environ.get("XDG_CONFIG_HOME") or str(Path.home() / ".config")
    return Path(base) / "weather_ecs"


class Recent:
    """Paths from the latest to the oldest. A list that cannot be read or written is only shorter:
    nothing is raised.
    """

    def __init__(self, path: Path | None = None) -> None:
        if path is None:
            try:
                path = settings_folder() / "recent.json"
            except RuntimeError:  # nobody's home is known
                path = Path(os.devnull)
        self._path = path
        self.paths: tuple[Path, ...] = self._read()

    def add(self, path: Path) -> None:
        """A file was opened or saved."""
        self._put((path, *[other for other in self.paths if other != path]))

    def remove(self, path: Path) -> None:
        """A file is no more."""
        self._put(tuple(other for other in self.paths if other != path))

    def _put(self, paths: tuple[Path, ...]) -> None:
        self.paths = paths[:MOST]
        text = json.dumps([str(path) for path in self.paths], indent=1)
        if self._path == Path(os.devnull):
            return
        aside = self._path.with_name(f"{self._path.name}.{os.getpid()}")
        with suppress(OSError):
            self._path.parent.mkdir(parents=True, exist_ok=True)
            aside.write_text(text, encoding="utf-8", errors="surrogateescape")
            os.replace(aside, self._path)

    def _read(self) -> tuple[Path, ...]:
        try:
            with open(self._path, "rb") as stream:
                items = json.loads(stream.read(LARGEST))
        except (OSError, ValueError, RecursionError):
            return ()
        if not isinstance(items, list):
            return ()
        return tuple(Path(item) for item in items[:MOST] if isinstance(item, str) and item)
