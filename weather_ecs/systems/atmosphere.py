"""`AtmosphereSystem` moves the time of the sky on; `Daylight` says what light there is."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import esper
import numpy as np

from weather_ecs.clock import STEP
from weather_ecs.components import Atmosphere, Cloud, Fog
from weather_ecs.components._base import set_unchecked
from weather_ecs.frame import AtmosphereData, SkyLight
from weather_ecs.physics import astronomy
from weather_ecs.physics.daylight import (
    LUMINANCE,
    NIGHT_LUX,
    SKY_GAIN,
    SUN_LUX,
    Scene,
    clear_sky,
    look_ahead,
    scene,
    shifted,
)
from weather_ecs.physics.haze import Lit, haze_depth, haze_left, under_fog
from weather_ecs.physics.high_sun import high_suns, shown_suns
from weather_ecs.physics.illuminance import moon_phase_factor
from weather_ecs.physics.optics import CLEAR, air_extinction
from weather_ecs.systems.climate import oldest_state
from weather_ecs.systems.queries import alive
from weather_ecs.systems.state import WeatherState

FIRST, LAST = astronomy.FIRST, astronomy.LAST - 1.0
QUANTUM = 10.0  # s of the sky for which its light stands still: the sun moves by 0.04 degrees
STEPS = 256.0  # of what covers the sky, that nobody sees; each makes the light anew
HALO = "cirrostratus"  # the model whose clouds show one


class AtmosphereSystem:
    """Carries the time of every atmosphere on by a fixed step; it stops with the years."""

    def run(self, state: WeatherState) -> None:
        """One fixed step."""
        for _, air in esper.get_component(Atmosphere):
            if air.speed:
                set_unchecked(air, "time", _moved(air, STEP))


def _moved(air: Atmosphere, seconds: float) -> float:
    return min(max(float(air.time) + air.speed * seconds, FIRST), LAST)


class _Heaven(NamedTuple):
    """Where everything stands, and how bright it is."""

    sun: astronomy.Vector
    moon: astronomy.Moon
    light: Scene
    high_direction: astronomy.Vector  # of what lights the clouds
    high_colors: np.ndarray  # (LEVELS, 3), see `physics.high_sun`


class Daylight:
    """The light of the oldest atmosphere; made again when the sun has moved or a field changed."""

    def __init__(self) -> None:
        self._key: tuple[object, ...] = ()
        self._heaven: _Heaven
        self._fog = 0.0
        self.light: SkyLight | None = None
        self.data: AtmosphereData | None = None

    def update(self, state: WeatherState) -> SkyLight | None:
        """Bring `light` and `data` up to date; None where there is no atmosphere.

        The light is the same object for as long as both are the same.
        """
        for _, air in alive(Atmosphere, state.uids):
            self._update(air, state)
            return self.light
        self._key, self.light, self.data = (), None, None
        return None

    def _update(self, air: Atmosphere, state: WeatherState) -> None:
        time = _moved(air, state.clock.remainder)
        time = min(max(math.floor(time / QUANTUM + 0.5) * QUANTUM, FIRST), LAST)
        overcast, haze, closed = _cover(air, state)
        halo = air.halo if air.halo is not None or not state.drawn else _cirrostratus(state)
        look = (air.latitude, air.longitude, air.turbidity, air.exposure, air.adaptation)
        shown = (air.draw, air.stars, air.disc, air.rainbow, halo, state.drawn)
        key, fog = (time, overcast, haze, closed, look, shown), _fog_depth(state)
        if self._key:
            self._look_ahead(air.turbidity)
        if key == self._key and fog == self._fog:
            return
        if key != self._key:
            self._key = key
            self._heaven = heaven = _heaven(air, time, overcast, haze)
            data = _data(air, time, overcast, haze, halo or 0.0, heaven) if state.drawn else None
            self.data = None if data is None else replace(data, rainbow=data.rainbow * (1 - closed))
        self._fog = fog
        self.light = _light(self._heaven, fog)

    def _look_ahead(self, turbidity: float) -> None:
        """Get ready a little of what sun and moon will need when they have moved on."""
        for direction in (self._heaven.sun, self._heaven.moon.direction):
            if look_ahead(_altitude(direction), turbidity):
                return


def covered(state: float) -> float:
    """Share of the sky that its haze covers in a state of the climate, besides its clouds."""
    return 0.85 * state**1.5


def covered_by(overcast: float) -> float:
    """The same where so much of the sky is cloud: broken clouds leave the sky between them."""
    return 0.85 * overcast**3


def _cover(air: Atmosphere, state: WeatherState) -> tuple[float, float, float]:
    """What covers the sky besides the clouds there are, 0 to 1; its haze's depth; and how little
    of the sun the clouds of a whole weather leave to the rain, 0 to 1.
    """
    course = state.course
    whole = None if course is None else course.at(state.clock.steps)
    if whole is None:
        haze, closed, share = 0.0, 0.0, covered(oldest_state(state) or 0.0)
    else:
        haze = haze_depth(round(whole.haze * STEPS) / STEPS)
        closed, share = round(whole.overcast**3 * STEPS) / STEPS, covered_by(whole.overcast)
    return round(share * STEPS) / STEPS if air.overcast is None else air.overcast, haze, closed


def _fog_depth(state: WeatherState) -> float:
    """Optical depth straight up of the oldest fog."""
    for _, fog in alive(Fog, state.uids):
        return max(air_extinction(fog.visibility) - CLEAR, 0.0) * fog.depth
    return 0.0


def _cirrostratus(state: WeatherState) -> float:
    """How much of a halo there is: all where a fifth of a layer is cirrostratus."""
    shares = [0.0]
    for layer in state.clouds.layers.values():
        array = layer.array
        kinds = [k for k, kind in enumerate(array.kinds) if kind.model == HALO]
        if kinds and len(array):
            shares.append(float(np.isin(array.kind, kinds).mean()))
    if any(cloud.model == HALO for _, cloud in alive(Cloud, state.uids)):
        shares.append(1.0)
    return min(5.0 * max(shares), 1.0)


def _heaven(air: Atmosphere, time: float, overcast: float, haze: float) -> _Heaven:
    sun = astronomy.sun_direction(time, air.latitude, air.longitude)
    moon = astronomy.moon_at(time, air.latitude, air.longitude)
    light = scene(
        clear_sky(_altitude(sun), air.turbidity),
        sun[1],
        clear_sky(_altitude(moon.direction), air.turbidity),
        moon.direction[1],
        moon.phase_angle,
        overcast=overcast,
        haze=haze,
        exposure=air.exposure,
        adaptation=air.adaptation,
    )
    high = [
        shown_suns(high_suns(_altitude(at), air.turbidity), scale / SKY_GAIN, haze, at[1])
        for at, scale in ((sun, light.sun_scale), (moon.direction, light.moon_scale))
    ]
    # The moon's turn comes when the highest clouds have lost the sun.
    by_sun = float(high[0][-1] @ LUMINANCE) >= float(high[1][-1] @ LUMINANCE)
    direction = sun if by_sun else moon.direction
    colors = shifted(high[0 if by_sun else 1], light.shift)
    return _Heaven(sun, moon, light, astronomy.refracted(direction), colors)


def _altitude(direction: astronomy.Vector) -> float:
    """Of what is seen there, degrees: the air lifts it."""
    altitude = astronomy.altitude_azimuth(direction)[0]
    return min(altitude + astronomy.refraction(altitude), 90.0)


def _light(heaven: _Heaven, fog: float) -> SkyLight:
    """The brighter of sun and moon is the light that casts shadows; `fog`: depth straight up."""
    light = heaven.light
    day = float(light.sun_color @ LUMINANCE) >= float(light.moon_color @ LUMINANCE)
    direction, color = heaven.sun, light.sun_color
    if not day:
        direction, color = heaven.moon.direction, light.moon_color
    towards = astronomy.refracted(direction)
    lit = under_fog(Lit(color, light.zenith, light.horizon), towards[1], fog)
    high = tuple([_rgb(c) for c in heaven.high_colors])
    return SkyLight(
        towards, _rgb(lit.sun), _rgb(lit.zenith), _rgb(lit.horizon), _rgb(light.ground),
        heaven.high_direction, high,
    )  # fmt: skip


def _rgb(color: np.ndarray) -> tuple[float, float, float]:
    r, g, b = (min(max(value, 0.0), 1000.0) for value in color.tolist())
    return r, g, b


def _data(
    air: Atmosphere, time: float, overcast: float, haze: float, halo: float, heaven: _Heaven
) -> AtmosphereData:
    sun, moon = heaven.sun, heaven.moon
    light = heaven.light
    suns = clear_sky(_altitude(sun), air.turbidity)
    moons = clear_sky(_altitude(moon.direction), air.turbidity)
    moonlight = moon_phase_factor(moon.phase_angle)
    dusk = SUN_LUX * float(suns.diffuse @ LUMINANCE)
    # The faintest star there is to see: 6.4 in the night, two magnitudes less for ten times the
    # light of twilight, and 4.5 under a full moon high up (Schaefer 1990).
    faintest = 6.4 - 1.95 * math.log10(1.0 + dusk / NIGHT_LUX)
    faintest -= 1.9 * moonlight * max(moon.direction[1], 0.0) ** 0.5
    return AtmosphereData(
        sun_direction=astronomy.refracted(sun),
        moon_direction=astronomy.refracted(moon.direction),
        star_axes=astronomy.celestial_axes(time, air.latitude, air.longitude),
        sun_air=suns.air,
        sun_haze=suns.haze,
        moon_air=moons.air,
        moon_haze=moons.haze,
        sun_scale=light.sun_scale,
        moon_scale=light.moon_scale,
        overcast_light=light.overcast,
        night_light=light.night,
        haze_light=light.haze_light,
        haze_depth=haze,
        ground_light=light.ground,
        shift=light.shift,
        sun_disc=_disc(suns.sun, 30.0 * min(light.exposure, 30.0), overcast) * _seen(sun, haze),
        moon_disc=_disc(moons.sun, 0.36 * min(max(light.exposure, 0.3), 4.0), overcast)
        * _seen(moon.direction, haze),
        faintest=faintest - 6.0 * overcast - 2.0 * haze,
        stars=air.stars,
        disc=air.disc,
        halo=halo * (1.0 - overcast),
        rainbow=air.rainbow * (1.0 - overcast),
        draw=air.draw,
    )


def _seen(direction: astronomy.Vector, haze: float) -> np.ndarray:
    """Share of a disc's light that haze of such a depth lets through."""
    return haze_left(haze, max(direction[1], 0.0))


def _disc(through: np.ndarray, brightness: float, overcast: float) -> np.ndarray:
    """Light of a disc seen through the air and what covers the sky."""
    return through * (brightness * (1.0 - overcast) ** 2)
