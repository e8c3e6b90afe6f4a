"""The game's purpose: a letter to carry to the mailbox, dry. Plain Python: no OpenGL, no window.

How wet it gets is water in mm on the sheet, as a rain gauge counts it: the rain rate at the hand,
times the share of the sheet that the coat leaves open, times 1 + v / 6.5 m/s, for whoever walks
meets the drops that hang before him as well as those that fall on him. Paper of 80 g/m2 soaks up
about its own weight of water, 0.08 mm: then nobody can read it any more. In 25 mm/h that is 23 s
for somebody who stands, and 12 s, but 70 m, for somebody who runs.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import Enum

RUINED_AT = 0.08  # mm of water on the sheet
OPEN_SHARE = 0.5  # of the sheet, the rest is under the coat
FALL_SPEED = 6.5  # m/s, of drops of 2 mm, which carry most of the water of heavy rain
DRYING = 0.6  # mm/h under a roof
PICK_UP = 1.6  # m from the letter, on the ground
HAND_IN = 1.5  # m from the mailbox, on the ground
SAME_FLOOR = 2.0  # m between feet and letter or mailbox

PICKED_UP = "You have the letter. Keep it dry."
GROWING_WET = (
    (0.15, "Drops on the envelope."),
    (0.45, "The letter is getting wet."),
    (0.75, "The ink is running. Find a roof!"),
)

Point = Sequence[float]  # (x, y, z), m


class State(Enum):
    """What has become of the letter."""

    LYING = "lying"  # on the table
    CARRIED = "carried"
    DELIVERED = "delivered"
    RUINED = "ruined"


class Letter:
    """One letter, from the table to the mailbox; it changes by `update` alone."""

    def __init__(self, table: Point, mailbox: Point) -> None:
        self._table, self._mailbox = table, mailbox
        self.again()

    def again(self) -> None:
        """Another letter lies on the table."""
        self.state = State.LYING
        self.water = 0.0  # mm on the sheet
        self.time = 0.0  # s that it has been carried
        self.rain_rate = 0.0  # mm/h that reached the hand last
        self.sheltered = False
        self._said = 0  # of GROWING_WET

    @property
    def wetness(self) -> float:
        """0 dry to 1 ruined."""
        return min(self.water / RUINED_AT, 1.0)

    @property
    def ended(self) -> bool:
        """Whether it is delivered or ruined."""
        return self.state in (State.DELIVERED, State.RUINED)

    @property
    def goal(self) -> tuple[float, float] | None:
        """(x, z) of where to go next, m; None when it is over."""
        if self.ended:
            return None
        x, _, z = self._table if self.state is State.LYING else self._mailbox
        return x, z

    def update(
        self, dt: float, feet: Point, *, speed: float, rain_rate: float, sheltered: bool
    ) -> str | None:
        """Let dt seconds pass; returns what to tell the player, if anything.

        `speed` is the walker's over the ground in m/s; `rain_rate` (mm/h) and `sheltered` are
        what the weather says of the place of the hand.
        """
        if self.ended:
            return None
        if self.state is State.LYING:
            if not _is_near(feet, self._table, PICK_UP):
                return None
            self.state = State.CARRIED
            return PICKED_UP
        self.time += dt
        self.rain_rate, self.sheltered = rain_rate, sheltered
        self.water += dt * water_rate(rain_rate, speed)
        if sheltered:
            self.water = max(self.water - dt * DRYING / 3600.0, 0.0)
        if self.water >= RUINED_AT:
            self.state = State.RUINED
        elif _is_near(feet, self._mailbox, HAND_IN):
            self.state = State.DELIVERED
        else:
            return self._warning()
        return None

    def _warning(self) -> str | None:
        reached = sum(self.wetness >= level for level, _ in GROWING_WET)
        if reached <= self._said:
            return None
        self._said = reached
        return GROWING_WET[reached - 1][1]


def water_rate(rain_rate: float, speed: float) -> float:
    """mm of water a second on a letter that is carried at `speed` m/s through `rain_rate` mm/h."""
    return OPEN_SHARE * rain_rate / 3600.0 * (1.0 + speed / FALL_SPEED)


def _is_near(feet: Point, thing: Point, reach: float) -> bool:
    away = math.hypot(feet[0] - thing[0], feet[2] - thing[2])
    return away <= reach and abs(feet[1] - thing[1]) <= SAME_FLOOR
