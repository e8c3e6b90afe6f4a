"""`StrikeField`: the strikes of late and those that are due; part of the weather's state."""

from __future__ import annotations

from typing import Any, NamedTuple

from weather_ecs.clock import MOST_STEPS, STEP
from weather_ecs.components._base import FAR, flag, integer, number, vector
from weather_ecs.errors import InvalidValueError
from weather_ecs.physics import lightning

Vector = tuple[float, float, float]
MOST = 1024  # strikes that are kept; more at once, and the oldest are forgotten
STRIKE, THUNDER = "strike", "thunder"  # events; see docs/lightning.md

_check_whole = integer(0, MOST_STEPS)
_check_word = integer(0, 2**63 - 1)
_check_place = vector(3, -2.0 * FAR, 2.0 * FAR)
_check_current = number(0.0, 1.0e4)
_check_flag = flag()


class Strike(NamedTuple):
    """One flash of lightning."""

    number: int  # rising, of this weather
    step: int  # the fixed step in which it strikes
    origin: Vector  # m, where it begins, in the cloud
    target: Vector  # m, where it ends: on the ground, or elsewhere in the cloud
    current: float  # kA, of its first return stroke
    ground: bool  # it comes down
    word: int  # that its shape and its course follow from

    @property
    def time(self) -> float:
        """s, the weather's clock."""
        return self.step * STEP

    @property
    def energy(self) -> float:
        """J."""
        return lightning.energy(self.current)

    def distance(self, point: Vector) -> float:
        """m from the nearest place of its channel to a point."""
        return lightning.channel_distance(self.origin, self.target, point)

    def delay(self, point: Vector) -> float:
        """s after which its thunder is heard at a point."""
        return lightning.thunder_delay(self.distance(point))


class Heard(NamedTuple):
    """Where an observer is from a strike."""

    observer: int  # entity
    distance: float  # m
    delay: float  # s until the thunder


class StrikeField:
    """What a snapshot has to hold of the lightning."""

    __slots__ = ("due", "following", "struck")

    def __init__(self) -> None:
        self.due: list[tuple[Strike, bool]] = []  # in order; whether things near draw it to them
        self.struck: list[Strike] = []  # in order; those whose light or thunder is about
        self.following = 0  # number of the next one

    def add(self, strike: Strike, *, drawn: bool) -> None:
        """One more that is due; its number is given here."""
        self.due.append((strike._replace(number=self.following), drawn))
        self.following += 1
        self.due.sort(key=_order)
        del self.due[MOST:]

    def take(self, step: int) -> list[tuple[Strike, bool]]:
        """Those that are due in a step, no longer due then."""
        count = sum(strike.step <= step for strike, _ in self.due)
        now, self.due = self.due[:count], self.due[count:]
        return now

    def forget(self, step: int, seconds: float) -> None:
        """Leave out what was longer ago, and what is too much."""
        oldest = step - int(seconds / STEP) - 1
        if self.struck and (self.struck[0].step < oldest or len(self.struck) > MOST):
            self.struck = [strike for strike in self.struck if strike.step >= oldest][-MOST:]

    # For snapshots

    def state(self) -> dict[str, Any]:
        """All there is to it, as plain values."""
        return {
            "due": [[_plain(strike), drawn] for strike, drawn in self.due],
            "following": self.following,
            "struck": [_plain(strike) for strike in self.struck],
        }

    @classmethod
    def from_state(cls, state: Any, now: int) -> StrikeField:
        """The field that `state` was taken of, at the fixed step `now`.

        Raises InvalidValueError for anything else.
        """
        if not isinstance(state, dict) or set(state) != {"due", "following", "struck"}:
            raise InvalidValueError("lightning", state, "due, following and struck")
        field = cls()
        field.following = _check_whole("lightning.following", state["following"])
        for name in ("due", "struck"):
            if not isinstance(state[name], list) or len(state[name]) > MOST:
                raise InvalidValueError(f"lightning.{name}", state[name], f"at most {MOST} strikes")
        field.struck = [_strike(row, field.following) for row in state["struck"]]
        for row in state["due"]:
            if not isinstance(row, list) or len(row) != 2:
                raise InvalidValueError("lightning.due", row, "a strike and a flag")
            field.due.append((_strike(row[0], field.following), _check_flag("drawn", row[1])))
        following = min(now + 1, MOST_STEPS)
        for strikes, first, last in (
            (field.struck, 0, now),
            ([strike for strike, _ in field.due], following, MOST_STEPS),
        ):
            places = [(strike.step, strike.number) for strike in strikes]
            if places != sorted(set(places)):
                raise InvalidValueError("lightning", places, "strikes in order, each once")
            if places and not first <= places[0][0] <= places[-1][0] <= last:
                allowed = f"steps of {first} to {last}: the clock is at {now}"
                raise InvalidValueError("lightning", places, allowed)
        return field


def _order(row: tuple[Strike, bool]) -> tuple[int, int]:
    return row[0].step, row[0].number


def _plain(strike: Strike) -> list[Any]:
    return [list(value) if isinstance(value, tuple) else value for value in strike]


def _strike(row: Any, following: int) -> Strike:
    if not isinstance(row, list) or len(row) != len(Strike._fields):
        raise InvalidValueError("lightning.strike", row, f"{len(Strike._fields)} values")
    found, step, origin, target, current, ground, word = row
    if _check_whole("strike.number", found) >= following:
        raise InvalidValueError("strike.number", found, f"below {following}")
    a, b = (_check_place("strike.origin", origin), _check_place("strike.target", target))
    return Strike(
        found,
        _check_whole("strike.step", step),
        (a[0], a[1], a[2]),
        (b[0], b[1], b[2]),
        _check_current("strike.current", current),
        _check_flag("strike.ground", ground),
        _check_word("strike.word", word),
    )
