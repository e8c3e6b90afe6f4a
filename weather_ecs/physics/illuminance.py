"""Light on level ground under a clear sky, in lux, from sun and moon at any height.

P. M. Janiczek and J. A. DeYoung, "Computer Programs for Sun and Moon Illuminance", US Naval
Observatory Circular 171, 1987: cubics for the logarithm, fitted to measurements.
"""

from __future__ import annotations

# From which altitude in degrees; coefficients of the altitude over 90 degrees.
_Law = tuple[tuple[float, tuple[float, float, float, float]], ...]
_SUN: _Law = (
    (20.0, (3.74, 3.97, -4.07, 1.47)),
    (5.0, (3.05, 13.28, -45.98, 64.33)),
    (-0.8, (2.88, 22.26, -207.64, 1034.30)),
    (-5.0, (2.88, 21.81, -258.11, -858.36)),
    (-12.0, (2.70, 12.17, -431.69, -1899.83)),
    (-18.0, (13.84, 262.72, 1447.42, 2797.93)),
)
_MOON: _Law = (
    (20.0, (-1.95, 4.06, -4.24, 1.56)),
    (5.0, (-2.58, 12.58, -42.58, 59.06)),
    (-0.8, (-2.79, 24.27, -252.95, 1321.29)),
)


def sun_illuminance(altitude: float) -> float:
    """lx of sun and sky; below -18 degrees, in the night, what it is there."""
    return _at(_SUN, min(max(altitude, -18.0), 90.0))


def moon_illuminance(altitude: float, phase_angle: float) -> float:
    """lx of the moon by altitude and phase angle (0 full, 180 new), degrees; 0 once it is down."""
    if altitude < -0.8:
        return 0.0
    return _at(_MOON, min(altitude, 90.0)) * moon_phase_factor(phase_angle)


def moon_phase_factor(phase_angle: float) -> float:
    """The moon's light at a phase angle in degrees, over that of the full moon."""
    return float(10.0 ** (-8.68e-3 * phase_angle - 2.2e-9 * phase_angle**4))


def _at(law: _Law, altitude: float) -> float:
    a, b, c, d = next(row for lowest, row in law if altitude >= lowest)
    x = altitude / 90.0
    return float(10.0 ** (a + x * (b + x * (c + x * d))))
