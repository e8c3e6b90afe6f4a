"""`RainGauge`: measures what lands on a level opening."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._base import FAR, Check, Component, number, set_raw, vector


class _Instrument(Component):
    """A component with a reading, which is the weather's to set."""

    __slots__ = ("_rate",)
    _rate: float

    @property
    def rate(self) -> float:
        """mm/h, mean over the window; 0 before anything was measured."""
        return self._rate


@dataclass(eq=False, slots=True)
class RainGauge(_Instrument):
    """A rain gauge: `rate` is the mean of what has landed on it, under a roof 0.

    It counts the drops that fall through its plane, each for the real ones it stands for; without
    OpenGL, and where no drops are, it reads the areas' rates.
    """

    position: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m, of the opening's middle
    area: float = 1.0  # m2, above 0 to 1e6, of the level opening
    window: float = 30.0  # s of weather, 0.1 to 3600, over which the reading is a mean

    checks: ClassVar[dict[str, Check]] = {
        "position": vector(3, -FAR, FAR),
        "area": number(0.0, 1.0e6, above=True),
        "window": number(0.1, 3600.0),
    }

    def __post_init__(self) -> None:
        set_raw(self, "_rate", 0.0)


def set_rate(gauge: RainGauge, rate: float) -> None:
    """Set the reading."""
    set_raw(gauge, "_rate", rate)
