"""`Air`: temperature and humidity at the ground."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._base import Check, Component, number


@dataclass(eq=False, slots=True)
class Air(Component):
    """The air, which decides whether rain, sleet or snow falls. The oldest entity's one counts.

    What falls goes by the wet bulb of the two: snow below about 0.8 degrees of it, rain above.
    """

    temperature: float = 15.0  # degrees Celsius at the height y = 0, -100 to 100
    humidity: float = 0.8  # 0 to 1, relative

    checks: ClassVar[dict[str, Check]] = {
        "temperature": number(-100.0, 100.0),
        "humidity": number(0.0, 1.0),
    }
