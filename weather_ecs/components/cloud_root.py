"""`CloudRoot`: a direction in which a seed of a cloud model reproduces."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from weather_ecs.components._agreeing import Agreeing
from weather_ecs.components._base import Check, integer, number
from weather_ecs.errors import InvalidValueError

MOST_DESCENDANTS = 1_000_000
_MOST_SEEDS = 1_000_000_000  # of one level; the product is what is limited


@dataclass(eq=False, slots=True)
class CloudRoot(Agreeing):
    """A root (Torchelsen 2005, 3.1): starts at its seed's centre and adds seeds level by level.

    Level k lies k radii of the seed away from the seed, in the root's direction turned at random
    within the openings. Angles are in degrees. The numbers of seeds of the levels between the first
    and the last are interpolated.
    """

    pitch: float = 0.0  # degrees above the horizon, within 360; 90 is straight up
    yaw: float = 0.0  # degrees counter-clockwise seen from above, within 360; 0 is +x
    open_pitch: float = 360.0  # degrees, 0 to 360, whole opening: half of it to either side
    open_yaw: float = 360.0  # degrees, 0 to 360, whole opening
    reproductions_min: int = 1  # levels, 0 to 1e6
    reproductions_max: int = 2  # levels, not below the minimum
    seeds_start: int = 3  # new seeds at the first level, 0 to 1e9
    seeds_end: int = 1  # new seeds at the last level, 0 to 1e9

    checks: ClassVar[dict[str, Check]] = {
        "pitch": number(-360.0, 360.0),
        "yaw": number(-360.0, 360.0),
        "open_pitch": number(0.0, 360.0),
        "open_yaw": number(0.0, 360.0),
        "reproductions_min": integer(0, MOST_DESCENDANTS),
        "reproductions_max": integer(0, MOST_DESCENDANTS),
        "seeds_start": integer(0, _MOST_SEEDS),
        "seeds_end": integer(0, _MOST_SEEDS),
    }

    def descendants(self) -> int:
        """The most seeds that this root can add."""
        return _added(self.seeds_start, self.seeds_end, self.reproductions_max)

    def agree(self) -> None:
        if self.reproductions_min > self.reproductions_max:
            raise InvalidValueError(
                "CloudRoot.reproductions_min",
                self.reproductions_min,
                f"at most reproductions_max, {self.reproductions_max}",
            )
        count = self.descendants()
        if count > MOST_DESCENDANTS:
            raise InvalidValueError(
                "CloudRoot.reproductions_max and seeds",
                f"{count} descendants",
                f"at most {MOST_DESCENDANTS} descendants of a root",
            )


@lru_cache(4096)  # a model is checked whenever one of its hundreds of roots is another
def _added(start: int, end: int, levels: int) -> int:
    return int(np.rint(np.linspace(start, end, levels)).astype(np.int64).sum())
