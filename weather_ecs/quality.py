"""Quality: what the weather may cost. Looks are components' affair, never quality's."""

from __future__ import annotations

import logging
import math
from collections import deque
from dataclasses import dataclass, replace
from statistics import median

from weather_ecs.components._base import flag, integer, number
from weather_ecs.errors import InvalidValueError

QUALITIES = ("low", "medium", "high", "ultra", "auto")
LOWEST_BUDGET = 0.05  # of the greatest quality: 6000 drops, as many as low has
_FIRST_BUDGET = 14_000 / 120_000  # auto starts as medium
STILL = 120  # draws, after which a weather that never goes on is an oversight
_log = logging.getLogger("weather_ecs")


@dataclass(frozen=True, slots=True)
class QualitySettings:
    """What one draw may use. Buffers are made for `drops`; a frame moves and draws a share.

    The levels are such settings; a game may make its own, under a name of its own.
    """

    name: str
    drops: int  # for one observer
    containers: int  # areas whose drops are drawn for one observer; the rest are veils
    heightmap_size: int  # texels on a side of the map of what the rain hits
    veil: bool  # rain beyond the containers
    budget: float = 1.0  # share of the drops that is used, 0.05 to 1
    cloud_billboards: int = 3_000  # of the clouds that are not impostors
    cloud_impostors: int = 3  # pictures of far clouds taken anew in one draw
    cloud_tile: int = 512  # texels, height of the largest of them; they are twice as wide
    cloud_atlas: int = 2048  # texels, height of the texture that holds them; twice as wide


LEVELS: dict[str, QualitySettings] = {
    "low": QualitySettings("low", 6_000, 2, 256, True, 1.0, 1_500, 2, 128, 1024),
    "medium": QualitySettings("medium", 14_000, 4, 512, True),
    "high": QualitySettings("high", 50_000, 8, 1024, True, 1.0, 12_000, 6, 512, 4096),
    "ultra": QualitySettings("ultra", 120_000, 16, 2048, True, 1.0, 40_000, 16, 1024, 4096),
    # Everything that would be seen to jump is fixed; the share of the drops glides.
    "auto": QualitySettings("auto", 120_000, 8, 512, True, _FIRST_BUDGET),
}


_CHECKS = {
    "drops": integer(1, 8_000_000),  # OpenGL promises 65 535 work groups, of 128 drops each
    "containers": integer(1, 32),
    "heightmap_size": integer(16, 8192),
    "veil": flag(),
    "budget": number(LOWEST_BUDGET, 1.0),
    "cloud_billboards": integer(0, 10_000_000),
    "cloud_impostors": integer(1, 1024),
    "cloud_tile": integer(16, 2048),
    "cloud_atlas": integer(256, 8192),
}


def settings_for(quality: object) -> QualitySettings:
    """The settings of a level, or a game's own, checked. Raises InvalidValueError for neither."""
    if isinstance(quality, QualitySettings):
        return _checked(quality)
    if not isinstance(quality, str) or quality not in LEVELS:
        raise InvalidValueError("quality", quality, f"{', '.join(QUALITIES)}, or QualitySettings")
    return LEVELS[quality]


def _checked(own: QualitySettings) -> QualitySettings:
    if any(own is level for level in LEVELS.values()):
        return own
    if not isinstance(own.name, str) or not own.name or own.name in LEVELS:
        raise InvalidValueError("QualitySettings.name", own.name, "a text that names no level")
    for field, check in _CHECKS.items():
        check(f"QualitySettings.{field}", getattr(own, field))
    return own


class FrameCost:
    """Adds up the draws of a frame; a frame lasts from the first draw after a process to the next.

    Times in ms, the clock's readings in s. One line in the log says so where no process ever comes.
    """

    def __init__(self) -> None:
        self._still: int | None = 0  # draws before the first process; None from then on
        self._began: float | None = None
        self._processed = True
        self._gpu = self._cpu = 0.0
        self._counts = False

    def processed(self) -> None:
        """The game has moved on: the next draw begins a frame."""
        self._processed = True
        self._still = None

    def begin(self, now: float) -> tuple[float, float, float] | None:
        """At every draw: frame, GPU and CPU time of a frame that is now over, if rain was in it."""
        if self._still is not None:
            self._still += 1
            if self._still == STILL:
                _log.warning("drawn %d times, but esper.process(dt) never ran in its world", STILL)
        if not self._processed:
            return None
        figures = None
        if self._began is not None and self._counts:
            figures = (now - self._began) * 1000.0, self._gpu, self._cpu
        self._began, self._processed, self._counts = now, False, False
        self._gpu = self._cpu = 0.0
        return figures

    def add(self, gpu_ms: float, cpu_ms: float, drops: int) -> None:
        """What one draw took, and how many drops it has drawn."""
        self._gpu += gpu_ms
        self._cpu += cpu_ms
        self._counts |= drops > 0


class AutoQuality:
    """Steers the share of the drops so that the game keeps its frame time.

    A pure function of what it is fed. It reckons with the cost of one unit of budget and with
    the time the rest of the game takes, both as medians over a window: unlike the frame time
    itself, these do not change when the budget does, so that no lag can make it swing. The budget
    moves by at most 2 % a frame, and not at all while it is within a tenth of where it should be.
    """

    RATE = 0.02  # greatest change in a frame
    WINDOW = 61  # frames
    DEAD_BAND = 0.10  # share of the budget
    TOLERANCE = 0.05  # share of the target: a frame that long is still on time
    WORTH = 0.10  # share of the frame below which reducing the weather would help nobody
    SHARE = 0.30  # share of the target the weather may take where the display sets the pace
    LONGEST = 1000.0  # ms; a longer frame was a pause
    PATIENCE = 600  # frames before a budget that was too much is tried again

    def __init__(self, target: float = 1000.0 / 60.0, budget: float = _FIRST_BUDGET) -> None:
        if not (isinstance(target, (int, float)) and 1.0 <= target <= 1000.0):
            raise InvalidValueError("target", target, "1 to 1000 ms")
        self.target = float(target)
        self.budget = min(max(float(budget), LOWEST_BUDGET), 1.0)
        self._frames: deque[float] = deque(maxlen=self.WINDOW)  # ms
        self._costs: deque[float] = deque(maxlen=self.WINDOW)  # ms of weather at budget 1
        self._others: deque[float] = deque(maxlen=self.WINDOW)  # ms of all but the weather
        self._ceiling = 1.0  # budget known to be too much
        self._blocked = 0  # frames until the ceiling is tried again
        self._patience = self.PATIENCE

    def settings(self) -> QualitySettings:
        """What the next draw may use."""
        return replace(LEVELS["auto"], budget=self.budget)

    def feed(self, frame_ms: float, gpu_ms: float, cpu_ms: float) -> float:
        """Learn what the last frame took, all and the weather's part; returns the budget.

        A frame that says nothing (no or an absurd duration, a pause, no weather) changes nothing.
        """
        # Written so that NaN, too, is no frame.
        if not (0.0 < frame_ms <= self.LONGEST and gpu_ms >= 0.0 and cpu_ms >= 0.0):
            return self.budget
        # The two run side by side; where the CPU draws, they are the same time counted twice.
        weather = max(gpu_ms, cpu_ms)
        if not 0.0 < weather <= self.LONGEST:
            return self.budget
        self._frames.append(frame_ms)
        self._costs.append(weather / self.budget)
        self._others.append(max(frame_ms - weather, 0.0))
        if len(self._frames) == self.WINDOW:
            self._steer()
        return self.budget

    def _steer(self) -> None:
        """Move the budget towards the one that fits."""
        cost, other = median(self._costs), median(self._others)
        frame = median(self._frames)
        late = frame > self.target * (1.0 + self.TOLERANCE)
        if self._blocked:
            self._blocked -= 1
            if not self._blocked:
                self._ceiling = 1.0
        room = self.target - other
        if late:
            if cost * self.budget < self.WORTH * frame:
                return
            self._remember_ceiling()
            wanted = max(room, 0.5 * self.WORTH * self.target) / cost
            wanted = min(wanted, self.budget)
        else:
            # With vertical sync the display's wait hides in `other`, and `room` says nothing.
            wanted = max(room, self.SHARE * self.target) / cost
            wanted = min(wanted, self._ceiling)
        wanted = min(max(wanted, LOWEST_BUDGET), 1.0)
        near = math.isclose(wanted, self.budget, rel_tol=self.DEAD_BAND)
        if near and not late and LOWEST_BUDGET < wanted < 1.0:
            return
        step = min(max(wanted / self.budget, 1.0 - self.RATE), 1.0 + self.RATE)
        self.budget = min(max(self.budget * step, LOWEST_BUDGET), 1.0)

    def _remember_ceiling(self) -> None:
        """This budget was too much: stay below it for a while, longer each time."""
        if not self._blocked:
            self._blocked = self._patience
            self._patience = min(2 * self._patience, 64 * self.PATIENCE)
            self._ceiling = 1.0
        self._ceiling = min(self._ceiling, 0.9 * self.budget)
