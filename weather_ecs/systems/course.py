"""`Course`: a whole weather on its way to another; part of the weather's state."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from weather_ecs.clock import MOST_STEPS, STEP
from weather_ecs.components._base import integer, number
from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.glide import glide, glide_rate

LONGEST = 1.0e6  # s that a transition takes at most
LONGEST_NAME = 100


class Conditions(NamedTuple):
    """What a whole weather is, but for its clouds; every one of these glides."""

    state: float  # 0 clear to 1 storm, of the skies
    rain_rate: float  # mm/h of water, as rain or snow by the air
    rain_radius: float  # m, of the area it falls in
    wind_speed: float  # m/s, mean at 10 m
    wind_heading: float  # rad, where it blows to: the angle from +x towards +z
    gustiness: float  # 0 to 1, as of `Wind`
    veer: float  # rad, as of `Wind`
    temperature: float  # degrees Celsius
    humidity: float  # 0 to 1
    visibility: float  # m, without what falls
    lightning: float  # 0 to 1, how active
    overcast: float  # 0 to 1, share of the sky that is cloud
    haze: float  # 0 to 1, from clear air to thick haze


LIMITS: dict[str, tuple[float, float]] = {
    "state": (0.0, 1.0),
    "rain_rate": (0.0, 1.0e4),
    "rain_radius": (10.0, 1.0e6),
    "wind_speed": (0.0, 150.0),
    "wind_heading": (-1.0e6, 1.0e6),
    "gustiness": (0.0, 1.0),
    "veer": (0.0, math.pi),
    "temperature": (-100.0, 100.0),
    "humidity": (0.0, 1.0),
    "visibility": (1.0, 1.0e7),
    "lightning": (0.0, 1.0),
    "overcast": (0.0, 1.0),
    "haze": (0.0, 1.0),
}
# These glide in their logarithm: half-way from 250 m to 25 km of visibility are 2500 m.
_LOGARITHMIC = tuple(name in ("rain_radius", "visibility") for name in Conditions._fields)

OWNED = ("air", "fog", "lightning", "rain", "wind")
UNDER_WAY, FINISHED, CLEARED = 0, 1, 2  # stages; cleared: layers without clouds are gone


class LayerWay(NamedTuple):
    """A layer's way: where it begins and ends."""

    uid: int
    base: float  # m
    last_base: float  # m
    aside: float  # of its own state from that of the weather; for skies may not have the same
    last_aside: float


_check_step = integer(0, MOST_STEPS)
_check_rate = number(-1.0e9, 1.0e9)


def checked(conditions: Conditions) -> Conditions:
    """The same as floats. Raises InvalidValueError for what is out of range."""
    return Conditions(
        *[number(*LIMITS[name])(name, getattr(conditions, name)) for name in Conditions._fields]
    )


class Course:
    """From where, to where, since when and until when."""

    __slots__ = ("began", "end", "layers", "name", "owned", "rates", "stage", "start", "steps")

    def __init__(self, name: str, start: Conditions, end: Conditions, began: int, steps: int):
        self.name = name  # of the weather it goes to
        self.start, self.end = start, end
        self.rates = (0.0,) * len(start)  # per second, at the start, of what glides
        self.began, self.steps = began, steps  # fixed steps
        self.stage = UNDER_WAY
        self.owned: dict[str, int] = {}  # uids of its entities, by what they are
        self.layers: list[LayerWay] = []

    def progress(self, step: int) -> float:
        """0 to 1, share of the time that has passed."""
        return 1.0 if step >= self.began + self.steps else (step - self.began) / self.steps

    def at(self, step: int) -> Conditions:
        """The conditions at a fixed step."""
        if step >= self.began + self.steps:
            return self.end
        passed, seconds = (step - self.began) * STEP, self.steps * STEP
        values = []
        for name, log, a, v, b in zip(
            Conditions._fields, _LOGARITHMIC, self.start, self.rates, self.end, strict=True
        ):
            if log:
                a, b = math.log(a), math.log(b)
            value = glide(a, v, b, seconds, passed)
            low, high = LIMITS[name]
            # A snapshot's rate may lead farther than `exp` does.
            values.append(min(max(math.exp(min(value, 700.0)) if log else value, low), high))
        return Conditions(*values)

    def rates_at(self, step: int) -> tuple[float, ...]:
        """How fast each changes, per second; of logarithms where those glide."""
        if step >= self.began + self.steps:
            return (0.0,) * len(self.start)
        passed, seconds = (step - self.began) * STEP, self.steps * STEP
        rates = []
        for log, a, v, b in zip(_LOGARITHMIC, self.start, self.rates, self.end, strict=True):
            if log:
                a, b = math.log(a), math.log(b)
            rates.append(glide_rate(a, v, b, seconds, passed))
        return tuple(rates)

    # For snapshots

    def state(self) -> dict[str, Any]:
        """All there is to it, as plain values."""
        return {
            "began": self.began,
            "end": list(self.end),
            "layers": [list(row) for row in self.layers],
            "name": self.name,
            "owned": dict(sorted(self.owned.items())),
            "rates": list(self.rates),
            "stage": self.stage,
            "start": list(self.start),
            "steps": self.steps,
        }

    @classmethod
    def from_state(cls, state: Any, now: int) -> Course:
        """The course that `state` was taken of, at the fixed step `now`.

        Raises InvalidValueError for anything else.
        """
        if not isinstance(state, dict) or set(state) != set(cls.__slots__):
            raise InvalidValueError("course", state, f"the fields {sorted(cls.__slots__)}")
        name = state["name"]
        if not isinstance(name, str) or len(name) > LONGEST_NAME:
            raise InvalidValueError("course.name", name, f"text of up to {LONGEST_NAME} characters")
        count = len(Conditions._fields)
        for each in ("start", "end", "rates"):
            if not isinstance(state[each], list) or len(state[each]) != count:
                raise InvalidValueError(f"course.{each}", state[each], f"{count} numbers")
        start, end = (checked(Conditions(*state[each])) for each in ("start", "end"))
        began, steps = (_check_step(f"course.{each}", state[each]) for each in ("began", "steps"))
        if began > now:
            raise InvalidValueError("course.began", began, f"a step up to {now}, the clock's")
        found = cls(name, start, end, began, steps)
        found.rates = tuple([_check_rate("course.rates", value) for value in state["rates"]])
        found.stage = integer(UNDER_WAY, CLEARED)("course.stage", state["stage"])
        owned, layers = state["owned"], state["layers"]
        if not isinstance(owned, dict) or not set(owned) <= set(OWNED):
            raise InvalidValueError("course.owned", owned, ", ".join(OWNED))
        found.owned = {what: _check_step("course.owned", uid) for what, uid in owned.items()}
        if not isinstance(layers, list) or len(layers) > 64:
            raise InvalidValueError("course.layers", layers, "at most 64 layers")
        for row in layers:
            if not isinstance(row, list) or len(row) != 5:
                raise InvalidValueError("course.layers", row, "a uid and four numbers")
            uid = _check_step("course.layers", row[0])
            bases = [number(-1.0e3, 1.0e5)("course.layers", value) for value in row[1:3]]
            asides = [number(-1.0, 1.0)("course.layers", value) for value in row[3:]]
            found.layers.append(LayerWay(uid, *bases, *asides))
        return found
