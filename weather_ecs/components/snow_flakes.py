"""`SnowFlakes`: how falling snow looks and moves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from weather_ecs.components._base import Check, Component, Limits, limited, number
from weather_ecs.errors import InvalidValueError

MODELS = ("physical", "liu_tong")


def _model(field: str, value: Any) -> str:
    if not isinstance(value, str) or value not in MODELS:
        raise InvalidValueError(field, value, ", ".join(MODELS))
    return str(value)


@dataclass(eq=False, slots=True)
class SnowFlakes(Component):
    """Looks of falling snow; whether it snows is the air's affair. The oldest entity's one counts.

    `settling` alone is more than looks: a game's minutes are short, so snow may collect faster.
    `physical` flakes are crystals and clumps by the laws in docs/snow.md; `liu_tong` has the
    paper's: 50 mm give or take 10, falling at 1 m/s give or take 0.25, 0.2 and 0.25. The fields and
    their defaults are those of `weather_ecs.frame.SnowLook`.
    """

    model: str = "physical"  # or liu_tong
    size: float = 4.0  # 0.05 to 50, factor on a physical flake's diameter, look only
    size_maximum: float = 7.0  # 1 to 50, growth of a flake at the container's rim (Eq. 3)
    exposure: float = 1.0 / 90.0  # s, 1e-4 to 1, over which a flake in motion is drawn out
    flutter: float = 1.0  # 0 to 2, factor on how far physical flakes sway
    density: float = 5.0  # 0 to 100, factor on how much the flakes cover: 1 is what nature shows
    brightness: float = 1.7  # 0 to 10, factor on the light of sky and ground that flakes show
    opacity: float = 0.9  # 0 to 1, greatest opacity of one flake
    aperture: float = 0.004  # m, 0 to 0.1, of the eye or lens that sees near flakes out of focus
    veil: float = 1.0  # 0 to 10, factor on the extinction of the snow beyond the container
    settling: float = 1.0  # 0 to 100, factor on how fast snow that has fallen grows deep

    checks: ClassVar[dict[str, Check]] = {
        "model": limited(_model, Limits("choice", choices=MODELS)),
        "size": number(0.05, 50.0),
        "size_maximum": number(1.0, 50.0),
        "exposure": number(1.0e-4, 1.0),
        "flutter": number(0.0, 2.0),
        "density": number(0.0, 100.0),
        "brightness": number(0.0, 10.0),
        "opacity": number(0.0, 1.0),
        "aperture": number(0.0, 0.1),
        "veil": number(0.0, 10.0),
        "settling": number(0.0, 100.0),
    }
