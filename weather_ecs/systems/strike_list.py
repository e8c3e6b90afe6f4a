"""`StrikeList`: the strikes whose light is about, as rows for a frame, and their clouds' light."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weather_ecs.clock import STEP
from weather_ecs.components import Lightning
from weather_ecs.frame import STRIKE_DTYPE, CloudShapeData, LightningLook, empty
from weather_ecs.physics import lightning
from weather_ecs.systems.state import WeatherState

LONGEST = 2.5  # s that a flash may last
IN_CLOUD = 0.7  # light of a flash that stays in its cloud, of one to ground
HIGH, LOW = 0.85, 0.40  # of a channel's height: where its light is for clouds, and for the ground
OWN = 0.10  # of a flash's strength, by which the whole of its cloud is lit
MOST_LIGHT = 1.0e4
NO_STRIKES = empty(STRIKE_DTYPE)


def look_of(own: Lightning) -> LightningLook:
    """What is drawn of it."""
    return LightningLook(own.color, own.width, own.glow, own.branches)


class StrikeList:
    """Rows of a frame; `lit` gives its clouds with the light of the strikes inside them."""

    def __init__(self) -> None:
        self._lit: tuple[NDArray, NDArray, NDArray] | None = None  # clouds, strikes, the result

    def rows(self, state: WeatherState, brightness: float) -> NDArray:
        """STRIKE_DTYPE of the flashes at the clock's time, the oldest first."""
        if not state.strikes.struck:
            return NO_STRIKES
        now = state.clock.time
        found = []
        for strike in reversed(state.strikes.struck):
            age = now - strike.step * STEP
            if age > LONGEST:
                break
            flash = lightning.course(strike.word, strike.ground)
            if not 0.0 <= age < flash.end:
                continue
            level = brightness * lightning.strength(strike.current)
            level *= lightning.intensity(flash, age) * (1.0 if strike.ground else IN_CLOUD)
            a, b = np.array(strike.target), np.array(strike.origin)
            low, high = (LOW, HIGH) if strike.ground else (0.5, 0.5)
            leader = age / flash.times[0] if strike.ground else 1.0
            again = strike.ground and len(flash.times) > 1 and age >= flash.times[1]
            found.append(
                (
                    strike.number, strike.word, strike.origin, strike.target, a + low * (b - a),
                    a + high * (b - a), age, level, min(leader, 1.0), strike.ground, again,
                )
            )  # fmt: skip
        if not found:
            return NO_STRIKES
        array = np.array(found[::-1], STRIKE_DTYPE)
        array.setflags(write=False)
        return array

    def lit(self, clouds: NDArray, shapes: tuple[CloudShapeData, ...], strikes: NDArray) -> NDArray:
        """The clouds with their `flash`; the same array for the same clouds and strikes."""
        if not len(clouds) or not len(strikes):
            self._lit = None
            return clouds
        known = self._lit
        if known is not None and known[0] is clouds and known[1] is strikes:
            return known[2]
        radius = np.array([shape.radius for shape in shapes])[clouds["shape"]] * clouds["scale"]
        flash = np.zeros(len(clouds))
        for row in strikes:
            away = np.linalg.norm(clouds["position"] - row["cloud_place"], axis=1)
            inside = np.clip(1.0 - (away / np.maximum(radius, 1.0)) ** 2, 0.0, 1.0)
            flash += OWN * float(row["light"]) * inside * inside
        lit = clouds.copy()
        lit["flash"] = np.minimum(flash, MOST_LIGHT)
        lit.setflags(write=False)
        self._lit = (clouds, strikes, lit)
        return lit
