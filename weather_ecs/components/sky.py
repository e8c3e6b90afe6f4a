"""`Sky`: what stands in a layer while the weather is in one state."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from weather_ecs.components._agreeing import Agreeing
from weather_ecs.components._base import Check, integer, number, to_float
from weather_ecs.components.cloud import a_model
from weather_ecs.components.cloud_model import CloudModel
from weather_ecs.errors import InvalidValueError

MOST_MODELS = 64


def _models(field: str, value: Any) -> tuple[CloudModel | str, ...]:
    allowed = f"up to {MOST_MODELS} models or names of them, in a tuple or list"
    if isinstance(value, (str, bytes, bytearray)) or not isinstance(value, Sequence):
        raise InvalidValueError(field, value, allowed)
    if len(value) > MOST_MODELS:
        raise InvalidValueError(field, f"{len(value)} of them", allowed)
    return tuple([a_model(field, item) for item in value])


def _weights(field: str, value: Any) -> tuple[float, ...]:
    allowed = "none, or one number >= 0 and <= 1e6 for each model, not all 0"
    if isinstance(value, (str, bytes, bytearray)) or not isinstance(value, Sequence):
        raise InvalidValueError(field, value, allowed)
    result = tuple([to_float(field, item, allowed) for item in value[: MOST_MODELS + 1]])
    if not all(0.0 <= item <= 1.0e6 for item in result) or (result and not any(result)):
        raise InvalidValueError(field, value, allowed)
    return result


@dataclass(eq=False, slots=True)
class Sky(Agreeing):
    """A set of clouds that stands for one state of the weather (Torchelsen 2005, 3.4).

    `generated` different clouds are made from each model, and `count` clouds stand in the sky, each
    one of those. It belongs to a `SkyLayer`; alone on an entity it does nothing.
    """

    state: float  # 0 clear to 1 storm
    models: tuple[CloudModel | str, ...] = ()  # models or names of them, at most 64
    generated: int = 10  # 1 to 10000, different clouds of each model
    count: int = 0  # 0 to 100000, clouds in the layer's rectangle; 0 needs no models
    weights: tuple[float, ...] = ()  # of the models, when one is drawn; none: all the same

    checks: ClassVar[dict[str, Check]] = {
        "state": number(0.0, 1.0),
        "models": _models,
        "generated": integer(1, 10_000),
        "count": integer(0, 100_000),
        "weights": _weights,
    }

    def agree(self) -> None:
        if self.count and not self.models:
            raise InvalidValueError("Sky.count", self.count, "0 where there are no models")
        given = [model.name for model in self.models if isinstance(model, CloudModel)]
        for name in given:  # clouds are told apart by the names of their models
            if given.count(name) + self.models.count(name) > 1:
                raise InvalidValueError("Sky.models", f"two called {name!r}", "names that differ")
        if self.weights and len(self.weights) != len(self.models):
            raise InvalidValueError(
                "Sky.weights", self.weights, f"none, or one for each of {len(self.models)} models"
            )
