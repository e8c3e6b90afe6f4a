"""Which clouds come in: shares of the skies, kept exactly by quotas and not by chance."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from weather_ecs.components import CloudModel, Sky
from weather_ecs.components._base import integer, number
from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.climate import shares

MOST_NUMBER = 10_000  # as Sky.generated has it
_check_credit = number(-1.0e3, 1.0e3)
_check_state = number(0.0, 1.0)
_check_number = integer(0, MOST_NUMBER)


class Kind(NamedTuple):
    """One of the different clouds of a layer."""

    sky: float  # state of the sky it was drawn from
    model: str  # name
    number: int


class Part(NamedTuple):
    """What one sky gives to the clouds that come in."""

    sky: float  # its state
    share: float  # of the clouds that come in, 0 to 1
    models: tuple[tuple[str, float], ...]  # names and weights
    generated: int


class Mix(NamedTuple):
    """The sky of one moment."""

    target: int  # clouds that stand in the layer
    parts: tuple[Part, ...]  # those with a share, by state; none without clouds


def mix_at(skies: Sequence[Sky], state: float) -> Mix:
    """The mix of the two skies round a state (Torchelsen 2005, 3.4).

    A sky that has no clouds thins out the other one: of those that come in it can give none.
    """
    order = sorted(skies, key=lambda sky: sky.state)
    if not order:
        return Mix(0, ())
    weights = shares([sky.state for sky in order], state)
    return _mix(order, [float(weight) for weight in weights])


def nearest_mix(skies: Sequence[Sky], state: float) -> Mix:
    """The sky nearest to a state, of two as near the clearer one: a layer begins with it."""
    order = sorted(skies, key=lambda sky: (abs(sky.state - state), sky.state))
    return _mix(order[:1], [1.0]) if order else Mix(0, ())


def _mix(skies: Sequence[Sky], weights: Sequence[float]) -> Mix:
    exact = sum(weight * sky.count for sky, weight in zip(skies, weights, strict=True))
    giving = [(s, w) for s, w in zip(skies, weights, strict=True) if w > 0.0 and s.count]
    whole = sum(weight for _, weight in giving)
    parts = [Part(sky.state, weight / whole, _models(sky), sky.generated) for sky, weight in giving]
    return Mix(int(exact + 0.5) if parts else 0, tuple(parts))


def _models(sky: Sky) -> tuple[tuple[str, float], ...]:
    found: dict[str, float] = {}  # a name that is there twice has both shares
    for model, weight in zip(sky.models, sky.weights or (1.0,) * len(sky.models), strict=True):
        name = model.name if isinstance(model, CloudModel) else model
        if weight > 0.0:
            found[name] = found.get(name, 0.0) + weight
    return tuple(found.items())


class Quota:
    """Draws keys so that after any number of draws each has had its share, to within one."""

    __slots__ = ("credits",)

    def __init__(self) -> None:
        self.credits: dict[Any, float] = {}

    def take(self, weights: Sequence[tuple[Any, float]]) -> Any:
        """The key that is most behind its share."""
        total = sum(weight for _, weight in weights)
        credits = {key: self.credits.get(key, 0.0) + weight / total for key, weight in weights}
        best = max(credits, key=credits.__getitem__)  # the first of equals
        credits[best] -= 1.0
        self.credits = credits
        return best


class Chooser:
    """Draws the kinds of the clouds that come in."""

    __slots__ = ("models", "numbers", "skies")

    def __init__(self) -> None:
        self.skies = Quota()
        self.models: dict[float, Quota] = {}  # by sky
        self.numbers: dict[tuple[float, str], int] = {}  # the next one of each model of a sky

    def take(self, mix: Mix) -> Kind:
        """The next cloud's kind."""
        sky = self.skies.take([(part.sky, part.share) for part in mix.parts])
        return self.take_of(next(part for part in mix.parts if part.sky == sky))

    def take_of(self, part: Part) -> Kind:
        """The next cloud's kind, if it is to be of this sky."""
        if len(part.models) == 1:
            name = part.models[0][0]
        else:
            name = self.models.setdefault(part.sky, Quota()).take(part.models)
        number = self.numbers.get((part.sky, name), 0) % part.generated
        self.numbers[part.sky, name] = number + 1
        return Kind(part.sky, name, number)

    # For snapshots

    def state(self) -> dict[str, Any]:
        """All there is to it, as plain values."""
        return {
            "models": [
                [sky, name, credit]
                for sky, quota in sorted(self.models.items())
                for name, credit in quota.credits.items()
            ],
            "numbers": [[sky, name, n] for (sky, name), n in sorted(self.numbers.items())],
            "skies": [[sky, credit] for sky, credit in self.skies.credits.items()],
        }

    @classmethod
    def from_state(cls, state: Any) -> Chooser:
        """The chooser that `state` was taken of. Raises InvalidValueError for anything else."""
        chooser = cls()
        if not isinstance(state, dict) or set(state) != {"models", "numbers", "skies"}:
            raise InvalidValueError("clouds.chooser", state, "models, numbers and skies")
        for sky, credit in rows("chooser.skies", state["skies"], 2):
            chooser.skies.credits[_check_state("sky", sky)] = _check_credit("credit", credit)
        for sky, name, credit in rows("chooser.models", state["models"], 3):
            quota = chooser.models.setdefault(_check_state("sky", sky), Quota())
            quota.credits[text("model", name)] = _check_credit("credit", credit)
        for sky, name, following in rows("chooser.numbers", state["numbers"], 3):
            key = _check_state("sky", sky), text("model", name)
            chooser.numbers[key] = _check_number("number", following)
        return chooser


def rows(field: str, value: Any, width: int) -> list[list[Any]]:
    """A list of lists of one length. Raises InvalidValueError for anything else."""
    if not isinstance(value, list) or not all(
        isinstance(row, list) and len(row) == width for row in value
    ):
        raise InvalidValueError(field, value, f"a list of lists of {width}")
    return value


def text(field: str, value: Any) -> str:
    """A short text. Raises InvalidValueError for anything else."""
    if not isinstance(value, str) or len(value) > 64:
        raise InvalidValueError(field, value, "a text of at most 64 characters")
    return value
