"""Light scattered by clear air: tables of the sky's radiance for any height of the sun.

After S. Hillaire, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique"
(Computer Graphics Forum 39, 2020): single scattering marched along the view ray, the higher orders
from a table of what arrives from all round. The air is E. Bruneton's ("A Qualitative and
Quantitative Evaluation of 8 Clear Sky Models", 2017): Rayleigh scattering, ozone, and a haze whose
depth is the turbidity's. All is reckoned at three wavelengths, of which tables hold the linear RGB
(`physics.spectrum`), of a sun that gives 1 outside the air; lengths are km here. Radiance is per
steradian of that 1.

A table has no time and no azimuth of its own: rows go by the sine of the elevation, v = sqrt(sine),
columns by the angle D from the sun's azimuth, u = sin(D / 2).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from weather_ecs.physics.checks import FloatArray, floats, number
from weather_ecs.physics.spectrum import seen

GROUND, TOP = 6360.0, 6460.0  # km, radii
EYE = GROUND + 0.2  # km, where the tables' rays begin
# At `spectrum.WAVELENGTHS`. Bodhaine and others 1999; Serdyuchenko and others 2014, for 300 Dobson
# units.
RAYLEIGH = np.array([7.80e-3, 13.08e-3, 27.64e-3])  # 1/km at the ground
OZONE = np.array([2.22e-3, 1.66e-3, 0.12e-3])  # 1/km at 25 km
DEPTH = 0.0972  # Rayleigh's optical depth at 550 nm (Bodhaine and others 1999)
RAYLEIGH_HEIGHT, HAZE_HEIGHT = 8.0, 1.2  # km, over which they thin out by e
HAZE_COLOR = np.array([0.87, 1.02, 1.30])  # Angstrom's exponent 1.3, over 550 nm
HAZE_ALBEDO = 0.93  # share of what haze takes that it scatters
FORWARD = 0.76  # g of the haze's phase function
ALBEDO = 0.2  # of the ground
LEAST_TURBIDITY, MOST_TURBIDITY = 1.0, 10.0
ROWS, COLUMNS = 32, 32  # of a sky table
PARTS = 4  # in which one may be made
_H = math.sqrt(TOP**2 - GROUND**2)
_MU, _RADII = 96, 40  # sizes of the table of columns
_SUNS, _LEVELS = 28, 14  # sizes of the table of higher orders


class SkyTable(NamedTuple):
    """The clear sky for one height of the sun."""

    air: FloatArray  # (ROWS, COLUMNS, 3), all but the light that haze has scattered once
    haze: FloatArray  # (ROWS, COLUMNS, 3), that light over its phase function
    sun: FloatArray  # (3,), share of the sun's light that reaches the ground


def haze_extinction(turbidity: float) -> FloatArray:
    """1/km at the ground, (3,): turbidity is (Rayleigh + haze) / Rayleigh, of depths at 550 nm."""
    return (turbidity - 1.0) * DEPTH / HAZE_HEIGHT * HAZE_COLOR


def rayleigh_phase(cosine: ArrayLike) -> FloatArray:
    """Share of the light scattered into a direction, 1/sr."""
    return 3.0 / (16.0 * math.pi) * (1.0 + np.asarray(cosine, np.float64) ** 2)


def haze_phase(cosine: ArrayLike) -> FloatArray:
    """The same of haze, 1/sr (Cornette and Shanks 1992)."""
    c, g2 = np.asarray(cosine, np.float64), FORWARD * FORWARD
    factor = 3.0 * (1.0 - g2) / (8.0 * math.pi * (2.0 + g2))
    return factor * (1.0 + c * c) / (1.0 + g2 - 2.0 * FORWARD * c) ** 1.5


def transmittance(altitude: ArrayLike, turbidity: float = 2.2) -> FloatArray:
    """Share of the light from a true altitude in degrees that reaches the ground, (..., 3).

    At the three wavelengths. 0 below the horizon, where half a degree of the sun's disc fades out.
    """
    sine = np.sin(np.radians(floats("altitude", altitude, -90.0, 90.0)))
    return _through(np.full(sine.shape, EYE), sine, _checked(turbidity))


def through_from(heights: FloatArray, sine: float, turbidity: float) -> FloatArray:
    """The same at heights (n,) in m over the ground, (n, 3), by the sine of the altitude."""
    return _through(EYE + 1e-3 * heights, np.full(heights.shape, sine), turbidity)


def sky_table(altitude: float, turbidity: float = 2.2) -> SkyTable:
    """The sky for the sun at `altitude` degrees; some 4 ms. Raises InvalidValueError."""
    number("altitude", altitude, -90.0, 90.0)
    turbid = _checked(turbidity)
    return sky_of_parts(altitude, turbid, [sky_part(altitude, turbid, k) for k in range(PARTS)])


def sky_part(altitude: float, turbidity: float, part: int) -> tuple[FloatArray, FloatArray]:
    """(air, haze) of one of the PARTS of a table, at the three wavelengths, some rows of it: who
    has time makes it so.
    """
    h = math.radians(altitude)
    rows = slice(part * ROWS // PARTS, (part + 1) * ROWS // PARTS)
    up, away = (angle[rows] for angle in table_directions())
    sun = np.array([math.cos(h), math.sin(h)])
    direction = np.stack([np.sqrt(1.0 - up * up) * np.cos(away), up], -1)  # along the sun, up
    return _march(direction, sun, turbidity, 20)


def sky_of_parts(
    altitude: float, turbidity: float, parts: Sequence[tuple[FloatArray, FloatArray]]
) -> SkyTable:
    """The table of all its parts, in order."""
    air, haze = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
    sine = np.array(math.sin(math.radians(altitude)))
    return SkyTable(seen(air), seen(haze), seen(_through(np.array(EYE), sine, turbidity)))


def table_directions() -> tuple[FloatArray, FloatArray]:
    """(sine of the elevation, angle from the sun's azimuth) in a table, (ROWS, COLUMNS)."""
    v = np.arange(ROWS) / (ROWS - 1)
    u = np.arange(COLUMNS) / (COLUMNS - 1)
    up, away = np.meshgrid(v * v, 2.0 * np.arcsin(u), indexing="ij")
    return up, away


def _checked(turbidity: float) -> float:
    return number("turbidity", turbidity, LEAST_TURBIDITY, MOST_TURBIDITY)


def _march(
    direction: FloatArray, sun: FloatArray, turbidity: float, steps: int
) -> tuple[FloatArray, FloatArray]:
    """Light scattered towards the eye: (all but the haze's first order, that over its phase).

    direction: (rows, columns, 2), whose rows have one elevation each: all that hangs on that alone
    is worked out once a row.
    """
    up = direction[:, :1, 1]
    length = -EYE * up + np.sqrt((EYE * up) ** 2 + TOP**2 - EYE**2)
    edges = (np.arange(steps + 1) / steps) ** 2  # the air is densest near the eye
    t = length[..., None] * 0.5 * (edges[1:] + edges[:-1])
    dt = length[..., None] * np.diff(edges)
    radius = np.sqrt(EYE**2 + t * (t + 2.0 * EYE * up[..., None]))
    toward = direction @ sun
    sine = (EYE * sun[1] + t * toward[..., None]) / radius
    rayleigh, haze, ozone = _densities(radius)
    lost_by_haze = haze_extinction(turbidity)
    scattered_by_haze = lost_by_haze * HAZE_ALBEDO
    extinction = (
        rayleigh[..., None] * RAYLEIGH + haze[..., None] * lost_by_haze + ozone[..., None] * OZONE
    )
    step = extinction * dt[..., None]
    before = np.cumsum(step, axis=-2) - step
    # Of each piece, what it scatters and does not take again itself.
    kept = np.exp(-before) * -np.expm1(-step) / np.maximum(extinction, 1e-12)
    by_air = rayleigh[..., None] * RAYLEIGH * kept
    by_haze = haze[..., None] * scattered_by_haze * kept
    lit = _through(radius, sine, turbidity)
    around = _higher(radius, sine, turbidity)
    phase = rayleigh_phase(toward)[..., None]
    air = _sum_along(lit, by_air) * phase + _sum_along(around, by_air + by_haze)
    return air, _sum_along(lit, by_haze)


def _sum_along(light: FloatArray, weight: FloatArray) -> FloatArray:
    """Sum over the pieces of rays: (rows, columns, pieces, 3), (rows, 1, pieces, 3)."""
    return np.einsum("rcpk,rpk->rck", light, weight[:, 0])


def _densities(radius: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Of Rayleigh's air, haze and ozone, over what their coefficients are for."""
    height = np.maximum(radius - GROUND, 0.0)
    return (
        np.exp(-height / RAYLEIGH_HEIGHT),
        np.exp(-height / HAZE_HEIGHT),
        np.maximum(1.0 - np.abs(height - 25.0) / 15.0, 0.0),
    )


def _through(radius: FloatArray, sine: FloatArray, turbidity: float) -> FloatArray:
    """Share of the sun's light that arrives at a radius from an elevation, (..., 3)."""
    amounts = _lookup(_columns(), *_mapped(radius, sine))
    shape, colors = amounts.shape, np.stack([RAYLEIGH, haze_extinction(turbidity), OZONE])
    depth = (amounts.reshape(-1, 3) @ colors).reshape(shape)  # one product is the quickest
    # The Earth's shadow, with an edge as wide as the sun.
    horizon = -np.sqrt(np.maximum(1.0 - (GROUND / np.maximum(radius, GROUND)) ** 2, 0.0))
    seen = np.clip((sine - horizon) / (2.0 * 0.00465) + 0.5, 0.0, 1.0)
    return np.exp(-depth) * (seen * seen * (3.0 - 2.0 * seen))[..., None]


def _mapped(radius: FloatArray, sine: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Where a ray stands in the table of columns, both 0 to 1 (Bruneton's mapping)."""
    rho = np.sqrt(np.maximum(radius**2 - GROUND**2, 0.0))
    level = -rho / radius  # no farther down than the horizon
    mu = np.maximum(sine, level)
    d = -radius * mu + np.sqrt(np.maximum((radius * mu) ** 2 + TOP**2 - radius**2, 0.0))
    least = TOP - radius
    return rho / _H, (d - least) / np.maximum(rho + _H - least, 1e-9)


@lru_cache(maxsize=1)
def _columns() -> FloatArray:
    """km of each kind of air up to the top, at its full density: (_RADII, _MU, 3)."""
    x, y = np.meshgrid(np.linspace(0.0, 1.0, _RADII), np.linspace(0.0, 1.0, _MU), indexing="ij")
    radius = np.sqrt((x * _H) ** 2 + GROUND**2)
    least = TOP - radius
    d = least + y * (x * _H + _H - least)
    mu = np.where(d > 0.0, (TOP**2 - radius**2 - d * d) / (2.0 * radius * np.maximum(d, 1e-9)), 1.0)
    steps = 80
    t = d[..., None] * (np.arange(steps) + 0.5) / steps
    along = np.sqrt(radius[..., None] ** 2 + t * (t + 2.0 * (radius * mu)[..., None]))
    return np.stack([density.sum(-1) * d / steps for density in _densities(along)], -1)


def _higher(radius: FloatArray, sine: FloatArray, turbidity: float) -> FloatArray:
    """Light that arrives after two scatterings or more, over all directions alike (Eq. 10)."""
    height = np.clip((radius - GROUND) / (TOP - GROUND), 0.0, 1.0)
    low = math.sin(math.radians(_LOWEST))
    v = np.clip((sine - low) / (1.0 - low), 0.0, 1.0)
    return _lookup(_orders(turbidity), np.sqrt(height), np.sqrt(v))


_LOWEST = -20.0  # degrees, of the sun in the table of higher orders


@lru_cache(maxsize=8)
def _orders(turbidity: float) -> FloatArray:
    """The table of higher orders, (_LEVELS, _SUNS, 3) (Hillaire 2020, Eq. 5 to 10)."""
    height = np.linspace(0.0, 1.0, _LEVELS) ** 2
    low = math.sin(math.radians(_LOWEST))
    sines = low + (1.0 - low) * np.linspace(0.0, 1.0, _SUNS) ** 2
    radius, sine = np.meshgrid(GROUND + height * (TOP - GROUND), sines, indexing="ij")
    radius = np.clip(radius, GROUND + 0.01, TOP - 0.01)
    count, steps = 48, 14
    # Directions evenly over the sphere, along a spiral.
    up = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    turn = math.pi * (3.0 - math.sqrt(5.0)) * np.arange(count)
    r, s = radius[..., None], sine[..., None]
    toward = up * s + np.sqrt((1.0 - up**2) * np.maximum(1.0 - s * s, 0.0)) * np.cos(turn)
    inside = (r * up) ** 2 + GROUND**2 - r * r
    lands = (inside >= 0.0) & (up < 0.0)
    to_top = -r * up + np.sqrt(np.maximum((r * up) ** 2 + TOP**2 - r * r, 0.0))
    length = np.where(lands, -r * up - np.sqrt(np.maximum(inside, 0.0)), to_top)
    t = length[..., None] * (np.arange(steps) + 0.5) / steps
    dt = (length / steps)[..., None, None]
    along = np.sqrt(r[..., None] ** 2 + t * (t + 2.0 * (r * up)[..., None]))
    sun = (r[..., None] * s[..., None] + t * toward[..., None]) / along
    rayleigh, haze, ozone = _densities(along)
    lost = haze_extinction(turbidity)
    scattering = rayleigh[..., None] * RAYLEIGH + haze[..., None] * (lost * HAZE_ALBEDO)
    extinction = (
        scattering + haze[..., None] * lost * (1.0 - HAZE_ALBEDO) + ozone[..., None] * OZONE
    )
    step = extinction * dt
    depth = np.cumsum(step, axis=-2)
    kept = np.exp(step - depth) * -np.expm1(-step) / np.maximum(extinction, 1e-12) * scattering
    second = (_through(along, sun, turbidity) * kept).sum(-2) / (4.0 * math.pi)
    ground = np.maximum(r * s + length * toward, 0.0) / GROUND
    bounce = _through(np.full(ground.shape, EYE), ground, turbidity) * ground[..., None]
    second += np.where(lands[..., None], np.exp(-depth[..., -1, :]) * bounce, 0.0) * (
        ALBEDO / math.pi
    )
    share = kept.sum(-2).mean(-2)  # of light that is everywhere, what one scattering sends on
    return second.mean(-2) / (1.0 - np.minimum(share, 0.95))


def _lookup(table: FloatArray, row: FloatArray, column: FloatArray) -> FloatArray:
    """Bilinear values of an (m, n, 3) table at places in [0, 1]; `row` may have fewer columns."""
    m, n = table.shape[:2]
    y, x = np.asarray(row) * (m - 1), np.asarray(column) * (n - 1)
    i = np.clip(y.astype(np.intp), 0, m - 2)
    j = np.clip(x.astype(np.intp), 0, n - 2)
    fy, fx = (y - i)[..., None], (x - j)[..., None]
    if y.size * n < 4 * x.size:
        # Few rows for many columns: between the rows first, once for all the columns.
        rows = table[i] * (1.0 - fy[..., None]) + table[i + 1] * fy[..., None]
        flat, first = rows.reshape(-1, 3), np.arange(y.size).reshape(y.shape) * n + j
        lower, upper = flat.take(first, axis=0), flat.take(first + 1, axis=0)
        upper -= lower
        upper *= fx
        upper += lower
        return np.asarray(upper)
    flat = table.reshape(m * n, -1)
    first = i * n + j
    upper = flat[first] * (1.0 - fx) + flat[first + 1] * fx
    return upper * (1.0 - fy) + (flat[first + n] * (1.0 - fx) + flat[first + n + 1] * fx) * fy
