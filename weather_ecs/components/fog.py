"""`Fog`: how far one sees in the air."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from weather_ecs.components._base import Check, Component, Limits, flag, limited, number, vector

_rgb = vector(3, 0.0, 1000.0)


def _color(field: str, value: Any) -> tuple[float, ...] | None:
    return None if value is None else _rgb(field, value)


@dataclass(eq=False, slots=True)
class Fog(Component):
    """Fog, mist or haze over the whole world, exponential in the distance to the observer.

    Rain and snow take their own share on top, where they fall. The oldest entity's one counts.
    """

    # m, at which a black thing keeps 2 % of its contrast (Koschmieder); less than 1 counts as 1,
    # and beyond the 50 km of clean air there is nothing to add.
    visibility: float = 1000.0  # 0 to 1e7
    color: tuple[float, float, float] | None = None  # linear RGB; None: from the light of the sky
    depth: float = 250.0  # m of it overhead, 0 to 1e5: how much of the sky it hides
    draw: bool = False  # over the whole picture, for games whose own shaders know no fog

    checks: ClassVar[dict[str, Check]] = {
        "visibility": number(0.0, 1.0e7),
        "color": limited(_color, Limits("vector", 0.0, 1000.0, size=3, optional=True)),
        "depth": number(0.0, 1.0e5),
        "draw": flag(),
    }
