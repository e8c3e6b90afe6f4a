"""Where sun, moon and stars stand over a place on the Earth.

Times are UTC, in seconds since 1970 (leap seconds left out, as Unix has it); latitudes are degrees
north and longitudes degrees east. In the world +x is east, +y up and -z north; azimuths are
degrees from north by east, so that a direction is (cos h sin A, sin h, -cos h cos A).

Sun: J. Meeus, Astronomical Algorithms (2nd ed. 1998), chapter 25, low accuracy, 0.01 degree. Moon:
the low-precision formulae of the Astronomical Almanac (page D22), 0.3 degree in longitude and 0.2
in latitude, 1950 to 2050. Sidereal time: Meeus 12.4. Dynamical and universal time count as one:
their 70 s move the moon by 0.01 degree.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from weather_ecs.physics.checks import FloatArray, number

FIRST, LAST = -2208988800.0, 4102444800.0  # s, the beginnings of 1900 and of 2100
AU = 149_597_870.7  # km
EARTH_RADIUS = 6378.14  # km, at the equator
J2000 = 2451545.0
DAY = 86400.0  # s

Vector = tuple[float, float, float]


class Place(NamedTuple):
    """A body as seen from the middle of the Earth."""

    right_ascension: float  # degrees
    declination: float  # degrees
    distance: float  # km


class Moon(NamedTuple):
    """The moon over a place."""

    direction: Vector  # unit, world axes
    illuminated: float  # share of the disc, 0 new to 1 full
    phase_angle: float  # degrees, 0 full to 180 new
    bright_limb: float  # degrees, of the middle of the lit limb, from celestial north by east
    distance: float  # km, from the middle of the Earth


def julian_day(time: float) -> float:
    """Days since noon of 1 January 4713 BC. Raises InvalidValueError outside 1900 to 2099."""
    return number("time", time, FIRST, LAST) / DAY + 2440587.5


def centuries(time: float) -> float:
    """Julian centuries since the noon that began the year 2000."""
    return (julian_day(time) - J2000) / 36525.0


def obliquity(t: float) -> float:
    """Degrees between equator and ecliptic, with the main term of the nutation (Meeus 25.8)."""
    mean = 23.4392911 - t * (0.0130041667 + t * (1.64e-7 - t * 5.036e-7))
    return mean + 0.00256 * _cos(125.04 - 1934.136 * t)


def sun_place(t: float) -> Place:
    """The sun, t centuries after 2000: apparent place (Meeus, chapter 25)."""
    mean = 280.46646 + t * (36000.76983 + t * 0.0003032)
    anomaly = 357.52911 + t * (35999.05029 - t * 0.0001537)
    eccentricity = 0.016708634 - t * (0.000042037 + t * 0.0000001267)
    center = (
        (1.914602 - t * (0.004817 + t * 0.000014)) * _sin(anomaly)
        + (0.019993 - t * 0.000101) * _sin(2.0 * anomaly)
        + 0.000289 * _sin(3.0 * anomaly)
    )
    radius = 1.000001018 * (1.0 - eccentricity**2)
    radius /= 1.0 + eccentricity * _cos(anomaly + center)
    longitude = mean + center - 0.00569 - 0.00478 * _sin(125.04 - 1934.136 * t)
    return Place(*_equatorial(longitude, 0.0, obliquity(t)), radius * AU)


def moon_place(t: float) -> Place:
    """The moon, t centuries after 2000, seen from the middle of the Earth (Almanac, page D22)."""
    longitude = (
        218.32
        + 481267.881 * t
        + 6.29 * _sin(135.0 + 477198.87 * t)
        - 1.27 * _sin(259.3 - 413335.36 * t)
        + 0.66 * _sin(235.7 + 890534.22 * t)
        + 0.21 * _sin(269.9 + 954397.74 * t)
        - 0.19 * _sin(357.5 + 35999.05 * t)
        - 0.11 * _sin(186.5 + 966404.03 * t)
    )
    latitude = (
        5.13 * _sin(93.3 + 483202.02 * t)
        + 0.28 * _sin(228.2 + 960400.89 * t)
        - 0.28 * _sin(318.3 + 6003.15 * t)
        - 0.17 * _sin(217.6 - 407332.21 * t)
    )
    parallax = (
        0.9508
        + 0.0518 * _cos(135.0 + 477198.87 * t)
        + 0.0095 * _cos(259.3 - 413335.36 * t)
        + 0.0078 * _cos(235.7 + 890534.22 * t)
        + 0.0028 * _cos(269.9 + 954397.74 * t)
    )
    return Place(*_equatorial(longitude, latitude, obliquity(t)), EARTH_RADIUS / _sin(parallax))


def sidereal_time(time: float, longitude: float = 0.0) -> float:
    """Mean sidereal time at a longitude, degrees in [0, 360) (Meeus 12.4)."""
    east = number("longitude", longitude, -180.0, 180.0)
    days = julian_day(time) - J2000
    t = days / 36525.0
    angle = 280.46061837 + 360.98564736629 * days + t * t * (0.000387933 - t / 38710000.0)
    return (angle + east) % 360.0


def celestial_axes(time: float, latitude: float, longitude: float) -> FloatArray:
    """Turns equatorial directions into the world's, (3, 3): world = axes @ equatorial.

    Equatorial axes: x to the equinox, z to the north pole.
    """
    north = math.radians(number("latitude", latitude, -90.0, 90.0))
    theta = math.radians(sidereal_time(time, longitude))
    c, s, cn, sn = math.cos(theta), math.sin(theta), math.cos(north), math.sin(north)
    east = (-s, c, 0.0)
    up = (cn * c, cn * s, sn)
    south = (sn * c, sn * s, -cn)
    return np.array([east, up, south])


def sun_direction(time: float, latitude: float, longitude: float) -> Vector:
    """Towards the sun's middle, unit, world axes; without refraction."""
    return _topocentric(sun_place(centuries(time)), celestial_axes(time, latitude, longitude))


def moon_at(time: float, latitude: float, longitude: float) -> Moon:
    """The moon over a place: its parallax is in the direction, up to a degree."""
    t = centuries(time)
    sun, moon = sun_place(t), moon_place(t)
    phase, limb = _phase(sun, moon)
    direction = _topocentric(moon, celestial_axes(time, latitude, longitude))
    return Moon(direction, 0.5 + 0.5 * _cos(phase), phase, limb, moon.distance)


def altitude_azimuth(direction: Vector) -> tuple[float, float]:
    """(altitude, azimuth) of a unit direction of the world in degrees, azimuth in [0, 360)."""
    x, y, z = direction
    return math.degrees(math.asin(min(max(y, -1.0), 1.0))), math.degrees(math.atan2(x, -z)) % 360.0


def direction_of(altitude: float, azimuth: float) -> Vector:
    """The unit direction of the world at an altitude and azimuth in degrees."""
    high = _cos(altitude)
    return high * _sin(azimuth), _sin(altitude), -high * _cos(azimuth)


def refraction(altitude: float) -> float:
    """Degrees by which air lifts what stands at a true altitude (Saemundsson 1986, Meeus 16.4).

    Below the horizon, where nothing is seen, it fades to nothing at 3 degrees down.
    """
    h = max(altitude, -1.0)
    lift = 1.02 / 60.0 / math.tan(math.radians(h + 10.3 / (h + 5.11)))
    return max(lift, 0.0) * min(max((altitude + 3.0) / 2.0, 0.0), 1.0)


def refracted(direction: Vector) -> Vector:
    """Where a body is seen, through the air."""
    altitude, azimuth = altitude_azimuth(direction)
    return direction_of(altitude + refraction(altitude), azimuth)


def _phase(sun: Place, moon: Place) -> tuple[float, float]:
    """(phase angle, position angle of the bright limb) in degrees (Meeus, chapter 48)."""
    turn = sun.right_ascension - moon.right_ascension
    ds, dm = sun.declination, moon.declination
    cosine = _sin(ds) * _sin(dm) + _cos(ds) * _cos(dm) * _cos(turn)
    apart = math.acos(min(max(cosine, -1.0), 1.0))
    phase = math.atan2(
        sun.distance * math.sin(apart), moon.distance - sun.distance * math.cos(apart)
    )
    limb = math.atan2(_cos(ds) * _sin(turn), _sin(ds) * _cos(dm) - _cos(ds) * _sin(dm) * _cos(turn))
    return math.degrees(phase), math.degrees(limb) % 360.0


def _topocentric(place: Place, axes: FloatArray) -> Vector:
    """The direction from the ground, where up leads away from the Earth's middle."""
    a, d = place.right_ascension, place.declination
    x, y, z = (axes @ (_cos(d) * _cos(a), _cos(d) * _sin(a), _sin(d))).tolist()
    y -= EARTH_RADIUS / place.distance
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


def _equatorial(longitude: float, latitude: float, tilt: float) -> tuple[float, float]:
    """(right ascension, declination) of a place on the ecliptic, degrees (Meeus 13.3, 13.4)."""
    across = _sin(longitude) * _cos(latitude) * _cos(tilt) - _sin(latitude) * _sin(tilt)
    ascension = math.atan2(across, _cos(longitude) * _cos(latitude))
    sine = _sin(latitude) * _cos(tilt) + _cos(latitude) * _sin(tilt) * _sin(longitude)
    return math.degrees(ascension) % 360.0, math.degrees(math.asin(min(max(sine, -1.0), 1.0)))


def _sin(degrees: float) -> float:
    return math.sin(math.radians(degrees))


def _cos(degrees: float) -> float:
    return math.cos(math.radians(degrees))
