"""`Saving`: a large document is written beside the window's frames, which go on meanwhile."""

from __future__ import annotations

import sys
from collections.abc import Callable
from threading import Thread

LARGE = 500  # seeds of all models, from which a save takes longer than a few frames
_SWITCH = 0.0005  # s between two turns of the window meanwhile: it lets others in at every GL call


class Saving:
    """One piece of work in a thread of its own; the interpreter does not end before it has."""

    def __init__(self, work: Callable[[], str]) -> None:
        self._work = work
        self._text: str | None = None
        self._error: BaseException | None = None
        self._thread = Thread(target=self._run, name="save")
        self._before = sys.getswitchinterval()
        sys.setswitchinterval(min(self._before, _SWITCH))
        self._thread.start()

    @property
    def done(self) -> bool:
        """Whether `result` would not wait."""
        return not self._thread.is_alive()

    def result(self) -> str:
        """What the work returned; waits for it. Raises what it raised."""
        self._thread.join()
        sys.setswitchinterval(self._before)
        if self._error is not None:
            raise self._error
        assert self._text is not None, "it has either a result or an error"
        return self._text

    def _run(self) -> None:
        try:
            self._text = self._work()
        except BaseException as error:
            self._error = error
