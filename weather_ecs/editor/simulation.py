"""`Simulation`: the weather of a document, run, paused, stepped and put at any moment.

Everything a weather does follows from its start, its seed and its steps. So any moment is reached
from the last snapshot before it, and the same moment is the same weather however it was come to.
"""

from __future__ import annotations

import itertools
import time as clock
from collections.abc import Callable
from typing import TypeVar

import esper

from weather_ecs import CloudFile, Weather
from weather_ecs.components import Climate
from weather_ecs.components._base import Component
from weather_ecs.editor.inside import (
    STEP,
    entities_by_uid,
    in_world,
    settle,
    steps_of,
)
from weather_ecs.editor.stage import Groups, Stage, groups_of, with_extras
from weather_ecs.editor.timeline import Timeline
from weather_ecs.tools import FrameData, frame_of

BUDGET = 0.012  # s of a frame that running and seeking may take
SLOWEST, FASTEST = 0.05, 600.0  # s of weather in a second
SPAN = 600.0  # s, of the scrub bar where no climate says how long a run is
_CHUNK = 20  # steps at once, between two looks at the watch

C = TypeVar("C", bound=Component)

_numbers = itertools.count(1)


class Simulation:
    """One weather in an esper world of its own, which shows a document as it changes.

    `make_weather` is called once, in that world, with the seed; with a weather that draws nothing
    everything here works without OpenGL.
    """

    def __init__(self, make_weather: Callable[[int], Weather] | None = None, seed: int = 0) -> None:
        self.world = f"weather_ecs.editor {next(_numbers)}"
        self.seed = seed
        self.running = False
        self.speed = 1.0  # s of weather in a second
        self.follows = True  # the steps from the start to now are all by the document as it is
        self._content: CloudFile | None = None
        self._groups: Groups = {}
        self._stage = Stage()
        self._timeline = Timeline()
        self._start: bytes | None = None  # made when it is first needed
        self._target: int | None = None  # step that is being sought
        with in_world(self.world):
            self.weather = (make_weather or _server)(seed)
            esper.process(0.0)

    # The document

    def show(self, content: CloudFile, *, fresh: bool = False) -> None:
        """Bring the weather up to the document's content, now; time stands where it is.

        `fresh` is another document, which begins at its start.
        """
        if content is self._content and not fresh:
            return
        groups = with_extras(groups_of(content))
        first = fresh or self._content is None
        self._content, self._groups, self._start = content, groups, None
        self._timeline.clear()
        self._target = None
        if first:
            self.weather.forget_drawn()
            self.restart()
            return
        with in_world(self.world):
            moved = self._stage.change(groups)
            self._stand()
        if steps_of(self.weather) > 0:
            self.follows = False
        elif moved:
            self.restart()

    def reseed(self, seed: int) -> None:
        """Begin anew with other chance: clouds stand elsewhere, gusts come at other times."""
        self.seed, self._start = seed, None
        self._timeline.clear()
        self.restart()

    def live(self, part: C) -> C | None:
        """A part of the document as the weather has it now; None for one it does not have."""
        with in_world(self.world):
            return self._stage.live(part)

    # Time

    @property
    def time(self) -> float:
        """s of weather since the start."""
        return self.weather.stats.time

    @property
    def span(self) -> float:
        """s that the scrub bar covers: the climate's way, and all that has been run."""
        climate = self.climate
        whole = SPAN
        if climate is not None:
            pace = abs(climate.speed) if climate.running else 1.0
            whole = climate.duration / max(pace, 1e-3)
        return max(min(whole, 1e7), self.time, (self._target or 0) * STEP)

    @property
    def climate(self) -> Climate | None:
        """The document's climate."""
        return None if self._content is None else self._content.climate

    @property
    def seeking(self) -> bool:
        """Whether a moment is being sought that takes more than a frame to reach."""
        return self._target is not None

    @property
    def target(self) -> float | None:
        """s, the moment that is being sought."""
        return None if self._target is None else self._target * STEP

    def restart(self) -> None:
        """Go back to the start."""
        self._restore(0, self._starting())
        self._target = None

    def seek(self, time: float) -> None:
        """Set out for a moment, in s; `update` goes there, from the nearest snapshot before it."""
        target = max(round(time / STEP), 0)
        now = steps_of(self.weather)
        self._target = target
        if not self.follows or target < now:
            self._restore(*self._nearest(target))
        else:
            step, data = self._nearest(target)
            if step > now:
                self._restore(step, data)
        if steps_of(self.weather) == target:
            self._target = None

    def step(self, seconds: float) -> None:
        """Go on by so many seconds, or back; the weather then stands.

        On goes from what is there, whether or not the document has changed on the way.
        """
        self.running = False
        here = self.time if self.target is None else self.target
        if seconds < 0.0:
            self.seek(max(here + seconds, 0.0))
        else:
            self._target = round((here + seconds) / STEP)

    def again(self) -> None:
        """Run to the present moment again from the start, by the document as it is now."""
        if not self.follows:
            self.seek(self.time)

    def update(self, dt: float, budget: float = BUDGET) -> None:
        """A frame of the editor: run on by `dt`, or towards the moment sought.

        Takes about `budget` s of the computer's time at most; then the weather is late, not the
        editor.
        """
        end = clock.perf_counter() + budget
        with in_world(self.world):
            if self._target is not None:
                while self._target is not None:
                    self._seek_on()
                    if clock.perf_counter() >= end:
                        break
            elif self.running:
                left = min(dt, 0.25) * self.speed
                while left > 0.0:
                    left -= self._run_on(left)
                    if clock.perf_counter() >= end:
                        break
            else:
                self._stand()

    def finish(self) -> None:
        """Reach the moment that is being sought, however long it takes."""
        while self._target is not None:
            self.update(0.0, budget=1.0)

    @property
    def frame(self) -> FrameData:
        """What there is to draw now."""
        with in_world(self.world):
            return frame_of(self.weather)

    def close(self) -> None:
        """Give everything back; a second time does nothing."""
        self.weather.close()
        if self.world in esper.list_worlds() and esper.current_world != self.world:
            esper.delete_world(self.world)

    # Inside

    def _starting(self) -> bytes:
        """The start as a snapshot, made by a weather that draws nothing."""
        if self._start is None:
            world = f"{self.world} start"
            with in_world(world), Weather(seed=self.seed) as weather:
                Stage().build(self._groups)
                self._start = weather.snapshot()
            esper.delete_world(world)
        return self._start

    def _nearest(self, step: int) -> tuple[int, bytes]:
        found = self._timeline.before(step) if self.follows else None
        return found or (0, self._starting())

    def _restore(self, step: int, data: bytes) -> None:
        if step == 0:
            self.follows = True
        with in_world(self.world):
            self.weather.restore(data)
            self._stage.adopt(self._groups, entities_by_uid(self.weather))
            self._stand()

    def _seek_on(self) -> None:
        """A few whole steps towards the target."""
        now = steps_of(self.weather)
        if self._target is None or now >= self._target:
            self._target = None
            return
        steps = min(self._target - now, self._timeline.until_next(now), _CHUNK)
        remainder = self.weather.stats.time - now * STEP
        self._pass(steps * STEP - max(remainder, 0.0))
        if steps_of(self.weather) >= self._target:
            self._target = None

    def _run_on(self, seconds: float) -> float:
        """Up to so many seconds, as far as the next snapshot at most; how many it was."""
        now = steps_of(self.weather)
        steps = min(self._timeline.until_next(now), _CHUNK)
        whole = (now + steps) * STEP - self.weather.stats.time
        passed = min(seconds, max(whole, 1e-6))
        self._pass(passed)
        return passed

    def _stand(self) -> None:
        """A frame without time. In a weather that is paused, clouds that an edit takes are gone
        at once; in one that runs they dissolve.
        """
        self.weather.paused = not self.running
        esper.process(0.0)

    def _pass(self, seconds: float) -> None:
        self.weather.paused = False
        esper.process(seconds)
        settle(self.weather)
        step = steps_of(self.weather)
        on_step = self.weather.stats.time - step * STEP < 1e-9
        if self.follows and on_step and self._timeline.wants(step):
            self._timeline.add(step, self.weather.snapshot())


def _server(seed: int) -> Weather:
    return Weather(seed=seed)
