"""`SkyLayer`: the clouds of one height, over a rectangle of the world."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._agreeing import Agreeing, parts
from weather_ecs.components._base import FAR, Check, number, vector
from weather_ecs.components.cloud_model import CloudModel
from weather_ecs.components.rain_area import FASTEST
from weather_ecs.components.sky import Sky
from weather_ecs.errors import InvalidValueError


@dataclass(eq=False, slots=True)
class SkyLayer(Agreeing):
    """Clouds at one height that drift across a rectangle (Torchelsen 2005, 3.4).

    At the start the rectangle is filled from the sky whose state is nearest. A cloud that leaves it
    is gone, and another comes in on the upwind side, drawn from the two skies round the state of
    its `Climate`: the one on the same entity, or else the oldest entity's. Without any, the state
    is 0. Layers are independent of each other; several may lie above one another. In calm air, and
    wherever there is a `turnover`, clouds also form, dissolve and turn into others where they are.
    A rectangle smaller than the seeds of a model is refused, where the skies hold the model itself
    and not its name; of what grows from them, only the middle has to be inside.
    """

    base: float = 1000.0  # m, world height of the clouds' bases, -1000 to 1e5
    center: tuple[float, float] = (0.0, 0.0)  # (x, z), m, of the rectangle; each within 1e7
    size: tuple[float, float] = (20_000.0, 20_000.0)  # (x, z), m, whole sides, 1 to 1e7
    skies: tuple[Sky, ...] = ()  # in any order, no two of the same state, at most 64
    variation: float = 0.0  # m, 0 to 1e4: bases differ by up to this either way
    velocity: tuple[float, float] = (0.0, 0.0)  # (x, z), m/s, the layer's own; each within 150
    drift: float = 1.0  # 0 to 1: share of the weather's wind that is added to it
    shear: tuple[float, float] = (0.0, 0.0)  # (x, z), m of lean per m of height, each within 10

    # s, 0 to 1e6, in which the clouds are others where they stand; below 24 counts as 24, 0: never
    turnover: float = 0.0

    # A count of its own: a layer may follow an observer, which changes neither skies nor models.
    revisions: ClassVar[list[int]] = [0]
    checks: ClassVar[dict[str, Check]] = {
        "base": number(-1.0e3, 1.0e5),
        "center": vector(2, -FAR, FAR),
        "size": vector(2, 1.0, FAR),
        "skies": parts(Sky, 64),
        "variation": number(0.0, 1.0e4),
        "velocity": vector(2, -FASTEST, FASTEST),
        "drift": number(0.0, 1.0),
        "shear": vector(2, -10.0, 10.0),
        "turnover": number(0.0, 1.0e6),
    }

    def agree(self) -> None:
        states = [sky.state for sky in self.skies]
        for index, state in enumerate(states):
            if state in states[:index]:
                raise InvalidValueError(
                    "SkyLayer.skies", f"two skies of state {state:g}", "states that all differ"
                )
        for sky in self.skies:
            for model in sky.models:
                if isinstance(model, CloudModel):
                    self.check_holds(model)

    def check_holds(self, model: CloudModel) -> None:
        """Raises InvalidValueError where a cloud of this model is larger than the rectangle."""
        least = sorted(model.span())
        if any(side < need for side, need in zip(sorted(self.size), least, strict=True)):
            allowed = f"no smaller than a cloud of {model.name}: {least[0]:g} by {least[1]:g} m"
            raise InvalidValueError("SkyLayer.size", self.size, allowed)
