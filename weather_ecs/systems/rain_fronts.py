"""`RainFronts`: when it began and ceased to rain in every area; part of the weather's state.

An area's rain comes down from its ceiling, the largest drops first, and goes likewise. What has to
be known for that is when it did not rain, of late: two spells, the older ones run together. An
area that is new has had its rain, or none, for ever. All by the count of fixed steps.
"""

from __future__ import annotations

import itertools
import math
from typing import Any, NamedTuple

from weather_ecs.clock import MOST_STEPS, STEP
from weather_ecs.components import RainArea
from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.front import LONG, SETTLED, SLOWEST, Dry

DEPTH = 200.0  # m below height 0 to which the rain of an area is followed
LONGEST = 900.0  # s that the slowest drops' fall counts at most
MOST_SPELLS = 2
GREATEST_RATE = 1.0e4  # mm/h, as the component has it

_numbers = itertools.count(1)
Spell = tuple[int | None, int | None]  # steps; None: since ever, or until now


class Front(NamedTuple):
    """An area whose rain has begun or ceased of late."""

    rate: float  # mm/h, of the rain that still falls where no more begins to
    spells: tuple[Spell, ...]  # without rain, the older first


class RainFronts:
    """Watches the areas' rain rates."""

    def __init__(self) -> None:
        self.number = next(_numbers)  # another one for other fronts: a snapshot was restored
        self.revision = 0  # another one when a front is forgotten
        self.steps = 0
        self._rates: dict[int, float] = {}  # mm/h, by uid, as of the last step
        self._fronts: dict[int, Front] = {}

    def step(self, found: list[tuple[int, RainArea]], *, same: bool = False) -> None:
        """A fixed step begins; `found` are all areas by uid, `same` if none has another rate."""
        rates = self._rates
        for uid, area in () if same else found:
            if rates.get(uid) != area.rain_rate:
                front = self.of(uid, area)
                rates[uid] = area.rain_rate
                if front is None:
                    self._fronts.pop(uid, None)
                else:
                    self._fronts[uid] = front
        if len(rates) > len(found):
            alive = {uid for uid, _ in found}
            self._rates = {uid: rate for uid, rate in rates.items() if uid in alive}
            self._fronts = {uid: front for uid, front in self._fronts.items() if uid in alive}
        self.steps = min(self.steps + 1, MOST_STEPS)
        if self._fronts:
            self._forget(dict(found))

    def _forget(self, areas: dict[int, RainArea]) -> None:
        """Leave out what has all come down."""
        for uid, front in list(self._fronts.items()):
            oldest = self.steps - _steps_of_fall(areas[uid])
            spells = tuple([s for s in front.spells if s[1] is None or s[1] > oldest])
            if not spells or (spells[-1][1] is None and (spells[-1][0] or 0) <= oldest):
                del self._fronts[uid]
                self.revision += 1
            elif len(spells) < len(front.spells):
                self._fronts[uid] = front._replace(spells=spells)

    def of(self, uid: int, area: RainArea) -> Front | None:
        """The front of an area as it is now, whether or not a step has seen its rate."""
        known, before = self._fronts.get(uid), self._rates.get(uid)
        rate = area.rain_rate
        if before is None or area.onset == 0.0:
            return None
        if (before > 0.0) == (rate > 0.0):
            return known
        spells = known.spells if known is not None else ()
        if rate > 0.0:
            begun = spells[-1][0] if spells else None
            return Front(rate, (*spells[:-1], (begun, self.steps)))
        spells = (*spells, (self.steps, None))
        if len(spells) > MOST_SPELLS:
            spells = ((spells[0][0], spells[1][1]), *spells[2:])
        return Front(before, spells)

    def rate(self, uid: int, area: RainArea) -> float:
        """mm/h of the rain that is in the air, also where no more begins to fall."""
        if area.rain_rate > 0.0:
            return area.rain_rate
        front = self.of(uid, area)
        return front.rate if front is not None else 0.0

    def dry(self, uid: int, area: RainArea, remainder: float) -> Dry:
        """The spells as `physics.front` has them, `remainder` s after the last step."""
        front = self.of(uid, area)
        if front is None:
            return SETTLED
        ages: list[float] = []
        for begun, ended in front.spells:
            since = -1.0 if ended is None else (self.steps - ended) * STEP + remainder
            until = LONG if begun is None else (self.steps - begun) * STEP + remainder
            ages += (since / area.onset, min(until / area.onset, LONG))
        ages += [0.0] * (4 - len(ages))
        return (ages[0], ages[1], ages[2], ages[3])

    # For snapshots

    def state(self) -> dict[str, Any]:
        """All there is to it, as plain values."""
        fronts = [
            [uid, front.rate, [list(spell) for spell in front.spells]]
            for uid, front in sorted(self._fronts.items())
        ]
        rates = [list(pair) for pair in sorted(self._rates.items())]
        return {"fronts": fronts, "rates": rates, "steps": self.steps}

    @classmethod
    def from_state(cls, state: Any) -> RainFronts:
        """The fronts that `state` was taken of. Raises InvalidValueError for anything else."""
        fields = ["fronts", "rates", "steps"]
        if not isinstance(state, dict) or sorted(state) != fields:
            raise InvalidValueError("fronts", state, f"the fields {fields}")
        made = cls()
        made.steps = _whole("fronts.steps", state["steps"], MOST_STEPS)
        for uid, rate in _pairs("fronts.rates", state["rates"], 2):
            made._rates[_next_uid(uid, made._rates)] = _rate(rate, least=0.0)
        for uid, rate, spells in _pairs("fronts.fronts", state["fronts"], 3):
            uid = _next_uid(uid, made._fronts)
            if uid not in made._rates:
                raise InvalidValueError("fronts.uid", uid, "an area with a rate")
            found = [_spell(pair, made.steps) for pair in _pairs("fronts.spells", spells, 2)]
            front = Front(_rate(rate, least=math.ulp(0.0)), tuple(found))
            _check_order(front.spells, raining=made._rates[uid] > 0.0)
            made._fronts[uid] = front
        return made


def _steps_of_fall(area: RainArea) -> float:
    """Fixed steps after which the slowest drop from the ceiling has come down everywhere."""
    seconds = min((max(area.ceiling, 0.0) + DEPTH) / SLOWEST, LONGEST)
    return seconds * area.onset / STEP


def _whole(field: str, value: Any, most: int) -> int:
    if type(value) is not int or not 0 <= value <= most:
        raise InvalidValueError(field, value, f"a whole number in [0, {most}]")
    return value


def _pairs(field: str, values: Any, size: int) -> list[list[Any]]:
    good = isinstance(values, list) and all(isinstance(v, list) and len(v) == size for v in values)
    if not good:
        raise InvalidValueError(field, values, f"a list of lists of {size}")
    return list(values)


def _next_uid(uid: Any, known: dict[int, Any]) -> int:
    number = _whole("fronts.uid", uid, 2**53)
    if known and number <= max(known):
        raise InvalidValueError("fronts.uid", uid, "uids in order, each once")
    return number


def _rate(value: Any, least: float) -> float:
    if type(value) is not float or not least <= value <= GREATEST_RATE:
        raise InvalidValueError("fronts.rate", value, f"a number in [{least:g}, {GREATEST_RATE:g}]")
    return value


def _spell(pair: list[Any], steps: int) -> Spell:
    for value in pair:
        if value is not None:
            _whole("fronts.spells", value, steps)
    return pair[0], pair[1]


def _check_order(spells: tuple[Spell, ...], raining: bool) -> None:
    moments = [moment for spell in spells for moment in spell]
    inner = moments[1:-1] + ([moments[-1]] if raining else [])
    known = [moment for moment in moments if moment is not None]
    sound = (
        1 <= len(spells) <= MOST_SPELLS
        and None not in inner
        and known == sorted(known)
        and (moments[-1] is None) != raining
    )
    if not sound:
        raise InvalidValueError("fronts.spells", spells, "one or two spells in order")
