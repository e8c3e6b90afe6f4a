"""Daylight, twilight, moonlight and starlight as a scene is lit by them, and as an eye sees it.

From the tables of `physics.atmosphere` and published illuminances (P. M. Janiczek and J. A.
DeYoung, "Computer Programs for Sun and Moon Illuminance", US Naval Observatory Circular 171, 1987),
which decide below the horizon, where light scattered many times and refracted is most of it.

The eye gets used to the dark, see `adapted`. On that scale a clear day with the sun 53 degrees
high gives the light that this package's scenes are made for, a sun of (1.0, 0.95, 0.86); the sky is
shown SKY_GAIN times as bright beside it as a meter has it.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from weather_ecs.physics.atmosphere import (
    PARTS,
    SkyTable,
    haze_phase,
    sky_of_parts,
    sky_part,
    sky_table,
    table_directions,
    transmittance,
)
from weather_ecs.physics.checks import FloatArray
from weather_ecs.physics.haze import haze_left, whitened
from weather_ecs.physics.illuminance import (
    moon_illuminance,
    moon_phase_factor,
    sun_illuminance,
)
from weather_ecs.physics.spectrum import seen

SUN_LUX = 133_300.0  # lx, outside the air (Darula, Kittler and Gueymard 2005)
CLEAR = 2.2  # turbidity of the air that the scale is for
HIGH = math.degrees(math.asin(0.8))  # the sun's altitude that it is for
NOON = np.array([1.0, 0.95, 0.86])  # the sun's colour there
SKY_GAIN = 3.7
COVER_GAIN = 1.5  # of a covered sky
NIGHT_GAIN = 2.0  # of airglow and stars: a night with a moon is brighter than one without
HAZE_SHARE = 0.33  # of SKY_GAIN, for the glow round the sun, which a picture cannot hold
NIGHT_LUX = 6.5e-4  # of airglow and stars on level ground, sun and moon down (Janiczek, -18)
NIGHT_COLOR = np.array([0.80, 1.02, 1.35])
BLUE_SHIFT = np.array([0.62, 1.00, 2.12])  # what the eye's rods make of grey (Jensen et al. 2000)
GROUND = np.array([0.16, 0.16, 0.136])  # share of the light that the ground sends back
HIGH_SKY, LOW_SKY = 0.85, 0.07  # sines of elevation that zenith and horizon are means about
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
_KNOTS = np.concatenate(
    [np.arange(-7.0, 10.5), np.arange(12.0, 21.0, 2.0), np.arange(25.0, 91.0, 5.0)]
)
MOST_KEPT = 192  # tables, of 50 kB each


class ClearSky(NamedTuple):
    """The clear sky of one source of light that gives 1 outside the air."""

    air: FloatArray  # radiance times pi, see `atmosphere.SkyTable`
    haze: FloatArray  # times HAZE_SHARE too
    sun: FloatArray  # (3,), what reaches a surface that faces it
    diffuse: FloatArray  # (3,), what level ground gets of the sky
    zenith: FloatArray  # (3,), radiance times pi, mean of the upper part
    horizon: FloatArray  # (3,), mean of the lowest 8 degrees


class Scene(NamedTuple):
    """What a scene is lit by, as it is shown: factors on the clear skies, and sums."""

    sun_scale: FloatArray  # (3,), on the sun's clear sky
    moon_scale: FloatArray  # (3,), on the moon's
    overcast: FloatArray  # (3,), at the zenith; a third of it at the horizon (CIE)
    night: FloatArray  # (3,), at the zenith
    haze_light: FloatArray  # (3,), of haze so thick that nothing is seen through it
    shift: float  # 0 to 1, of the colours towards those of the night
    exposure: float  # on light as a meter has it
    sun_color: FloatArray  # (3,)
    moon_color: FloatArray  # (3,)
    zenith: FloatArray  # (3,)
    horizon: FloatArray  # (3,)
    ground: FloatArray  # (3,)


_known: dict[tuple[int, float], tuple[ClearSky, float]] = {}  # by knot and turbidity
_begun: dict[str, Any] = {}  # the table that is being made ahead, and its parts

MOON = moon_illuminance(45.0, 0.0) / sun_illuminance(45.0)  # the full moon's light over the sun's


def clear_sky(altitude: float, turbidity: float = CLEAR) -> ClearSky:
    """The clear sky for a source at a true altitude in degrees, between the tables kept."""
    turbid = round(turbidity, 1)
    i, share = _between(altitude)
    low, low_level = _knot(i, turbid)
    if share == 0.0:
        high, high_level = low, low_level
    else:
        high, high_level = _knot(i + 1, turbid)
    # Brightness goes by powers in twilight; what is left to interpolate is the shape.
    level = low_level ** (1.0 - share) * high_level**share
    sun = seen(transmittance(altitude, turbid))
    if altitude < 6.0:
        level *= (_diffuse_lux(altitude, sun) / (level * SUN_LUX)) ** min(1.0 - altitude / 6.0, 1.0)
    near, far = level * (1.0 - share) / low_level, level * share / high_level
    parts = (near * a + far * b for a, b in zip(low, high, strict=True))
    air, haze, _, diffuse, zenith, horizon = parts
    return ClearSky(air, haze, sun, diffuse, zenith, horizon)


def look_ahead(altitude: float, turbidity: float = CLEAR) -> bool:
    """Make a part of a table that a source at such an altitude will need next, some 1 ms.

    Called now and then before it moves on by a degree, no `clear_sky` has to make a whole one.
    False where there is nothing left to do.
    """
    if not _begun:
        turbid, (i, _) = round(turbidity, 1), _between(altitude)
        wanted = [(k, turbid) for k in (i + 2, i - 1) if 0 <= k < len(_KNOTS)]
        wanted = [key for key in wanted if key not in _known]
        if not wanted:
            return False
        _begun.update(key=wanted[0], parts=[])
    # One that somebody else has begun is made first: many skies do not keep each other from it.
    key, parts = _begun["key"], _begun["parts"]
    altitude = float(_KNOTS[key[0]])
    parts.append(sky_part(altitude, key[1], len(parts)))
    if len(parts) == PARTS:
        _begun.clear()
        _keep(key, sky_of_parts(altitude, key[1], parts))
    return True


def _between(altitude: float) -> tuple[int, float]:
    """The knot below an altitude, and how far it is on the way to the next one, 0 to 1."""
    place = min(max(altitude, float(_KNOTS[0])), 90.0)
    i = min(int(np.searchsorted(_KNOTS, place, side="right")) - 1, len(_KNOTS) - 2)
    return i, (place - float(_KNOTS[i])) / float(_KNOTS[i + 1] - _KNOTS[i])


def _diffuse_lux(altitude: float, sun: FloatArray) -> float:
    """lx of the sky alone, of which the share of the sun's own light has been taken."""
    direct = SUN_LUX * float(sun @ LUMINANCE) * max(math.sin(math.radians(altitude)), 0.0)
    whole = sun_illuminance(altitude) - NIGHT_LUX * _smooth((-altitude - 12.0) / 6.0)
    return max(whole - direct, 0.3 * whole, 1e-6)


def _knot(index: int, turbidity: float) -> tuple[ClearSky, float]:
    """A table's sky, and the luminance of what level ground gets of it."""
    known = _known.get((index, turbidity))
    return known or _keep((index, turbidity), sky_table(float(_KNOTS[index]), turbidity))


def _keep(key: tuple[int, float], table: SkyTable) -> tuple[ClearSky, float]:
    """What a table comes to; of those kept the oldest goes where there are too many."""
    altitude = float(_KNOTS[key[0]])
    up, away = table_directions()
    h = math.radians(altitude)
    cosine = np.sqrt(1.0 - up * up) * np.cos(away) * math.cos(h) + up * math.sin(h)
    shown = math.pi * (table.air + table.haze * haze_phase(cosine)[..., None])
    sines = up[:, 0]
    means = np.trapezoid(shown, away[0], axis=1) / math.pi  # over the azimuth
    diffuse = 2.0 * np.trapezoid(means * sines[:, None], sines, axis=0)
    haze = HAZE_SHARE * math.pi * table.haze
    seen = math.pi * table.air + haze * haze_phase(cosine)[..., None]
    rows = np.trapezoid(seen, away[0], axis=1) / math.pi
    upper, lower = sines >= 0.7, sines <= math.sin(math.radians(8.0))
    zenith, horizon = (
        np.trapezoid(rows[part], sines[part], axis=0) / np.ptp(sines[part])
        for part in (upper, lower)
    )
    sky = ClearSky(math.pi * table.air, haze, table.sun, diffuse, zenith, horizon)
    for array in sky:
        array.setflags(write=False)
    while len(_known) >= MOST_KEPT:
        _known.pop(next(iter(_known)), None)
    _known[key] = sky, float(diffuse @ LUMINANCE)
    return _known[key]


@lru_cache(maxsize=1)
def _scale() -> tuple[FloatArray, float]:
    """(white balance, light on the things of a scene) of the day that the scale is for."""
    sky = clear_sky(HIGH)
    return NOON / sky.sun, _adapting(sky.diffuse, sky.sun)


def _adapting(diffuse: FloatArray, sun: FloatArray) -> float:
    """Light that the eye gets used to: the sky's, and the sun's on things turned every way."""
    return float((diffuse + 0.5 * sun) @ LUMINANCE)


def scene(
    sun: ClearSky,
    sun_sine: float,
    moon: ClearSky,
    moon_sine: float,
    phase_angle: float,
    *,
    overcast: float = 0.0,
    haze: float = 0.0,
    exposure: float = 1.0,
    adaptation: float = 1.0,
) -> Scene:
    """Put the lights of a sky together; sines of the true altitudes, phase angle in degrees.

    haze: optical depth straight up, see `physics.haze`.
    """
    white, reference = _scale()
    moonlight = MOON * moon_phase_factor(phase_angle)
    # Kasten and Czeplak 1980: what a covered sky lets through in all; the sun finds fewer gaps.
    left, direct = 1.0 - 0.75 * overcast**3.4, 1.0 - overcast
    suns, moons = sun.sun, moon.sun * moonlight
    level = suns * max(sun_sine, 0.0) + moons * max(moon_sine, 0.0)
    clear = sun.diffuse + moon.diffuse * moonlight
    spread = left * (level + clear) - direct * (level + clear)
    stars = NIGHT_LUX / SUN_LUX * NIGHT_COLOR * left
    light = _adapting(direct * clear + spread + stars, direct * (suns + moons))
    shown = exposure * adapted(light / reference, adaptation)
    shift = _smooth((0.5 - math.log10(light * SUN_LUX)) / 3.0)
    factor = SKY_GAIN * shown * white
    # The grey is that of the light above it, half bleached; CIE: (1 + 2 sine) / 3 of the zenith.
    grey = 0.5 * spread + 0.5 * float(spread @ LUMINANCE)
    overhead = COVER_GAIN * shown * white * grey * (9.0 / 7.0)
    sun_scale, moon_scale = factor * direct, factor * direct * moonlight
    night = NIGHT_GAIN * shown * white * stars
    zenith = sun_scale * sun.zenith + moon_scale * moon.zenith + 0.9 * overhead + night
    horizon = sun_scale * sun.horizon + moon_scale * moon.horizon + 0.45 * overhead + 1.6 * night
    sun_color, moon_color = (shown * direct * white * part for part in (suns, moons))
    white_light = whitened(horizon)
    if haze > 0.0:
        sun_color = sun_color * haze_left(haze, max(sun_sine, 0.0))
        moon_color = moon_color * haze_left(haze, max(moon_sine, 0.0))
        zenith = white_light + haze_left(haze, HIGH_SKY) * (zenith - white_light)
        horizon = white_light + haze_left(haze, LOW_SKY) * (horizon - white_light)
    zenith, horizon = shifted(zenith, shift), shifted(horizon, shift)
    moon_color = shifted(moon_color, shift)
    lit = sun_color * max(sun_sine, 0.0) + moon_color * max(moon_sine, 0.0)
    ground = GROUND * (lit + 0.5 * (zenith + horizon))
    return Scene(
        sun_scale,
        moon_scale,
        overhead,
        night,
        white_light,
        shift,
        shown,
        sun_color,
        moon_color,
        zenith,
        horizon,
        ground,
    )


def adapted(light: float, adaptation: float = 1.0) -> float:
    """Factor on the light that an eye used to `light`, over that of a clear day, sees.

    Of d decades less light it sees 0.48 d / (1 + 0.1 d) decades less: a sixth at sunset, 4 % in
    civil twilight, 1 % under the stars. With `adaptation` 0 it is a camera that nobody sets, 1.
    """
    d = -math.log10(max(light, 1e-12))
    seen = 0.48 * d / (1.0 + 0.1 * max(d, 0.0))
    return float(10.0 ** (adaptation * (d - seen)))


def shifted(color: FloatArray, shift: float) -> FloatArray:
    """Colours (..., 3) as the eye sees them in the dark: bluish greys."""
    grey = (np.asarray(color) @ LUMINANCE)[..., None] * BLUE_SHIFT
    return color + shift * (grey / float(BLUE_SHIFT @ LUMINANCE) - color)


def _smooth(x: float) -> float:
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)
