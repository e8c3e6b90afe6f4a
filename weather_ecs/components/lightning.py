"""`Lightning`: how the flashes of a world's clouds come and look."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._base import Check, Component, number, vector


@dataclass(eq=False, slots=True)
class Lightning(Component):
    """Flashes in clouds whose model has `lightning`; without this component they are as here.

    Of several the one of the oldest entity counts. `rate` 0 leaves only the strikes that the
    game calls itself.
    """

    rate: float = 1.0  # factor on the flashes a minute of the clouds' models, 0 to 1000
    most: float = 20.0  # flashes a minute in the whole sky, 0 to 600
    ground_share: float = 0.3  # 0 to 1, of the flashes that come down
    audible: float = 25_000.0  # m, 0 to 1e5: farther off there is no thunder
    brightness: float = 4.0  # factor on the light of a flash, 0 to 1000; 1: of a day, nearby
    color: tuple[float, float, float] = (0.80, 0.88, 1.0)  # linear RGB, 0 to 1000
    width: float = 2.2  # m that the channel seems wide, look only; 0.01 to 100
    glow: float = 1.0  # factor on the air's glow round the channel, 0 to 10
    branches: float = 1.0  # factor on the number of branches, 0 to 3

    checks: ClassVar[dict[str, Check]] = {
        "rate": number(0.0, 1000.0),
        "most": number(0.0, 600.0),
        "ground_share": number(0.0, 1.0),
        "audible": number(0.0, 1.0e5),
        "brightness": number(0.0, 1000.0),
        "color": vector(3, 0.0, 1000.0),
        "width": number(0.01, 100.0),
        "glow": number(0.0, 10.0),
        "branches": number(0.0, 3.0),
    }
