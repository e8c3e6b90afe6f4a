"""A drop that falls from rest, by the balance of weight, buoyancy, added mass and drag."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from .checks import FloatArray, floats

DENSITY_RATIO = 1.22 / 1000.0  # air over water
GRAVITY = 9.8  # m/s2
VISCOSITY = 1.493776e-5  # m2/s, kinematic, of air
STEP, SUBSTEPS = 0.02, 4  # s
SETTLED = 0.0002  # m/s of change in a step below which a speed counts as terminal
LARGEST_SPHERE = 100.0  # mm; beyond, the drag law's range is left


def drag_times_reynolds(reynolds: ArrayLike) -> FloatArray:
    """C_d Re of a sphere, so that Re = 0 is no special case: 24 there (Stokes).

    C_d = 24/Re (1 + 0.15 Re^0.687) + 0.42 / (1 + 42500 Re^-1.16), Clift and Gauvin (1970), within
    6 % of the standard drag curve up to Re = 3e5.
    """
    re = floats("reynolds", reynolds, 0.0)
    power = re**1.16
    return 24.0 + 3.6 * re**0.687 + 0.42 * re * power / (power + 42500.0)


def fall_speed(diameter_mm: ArrayLike, time: ArrayLike) -> FloatArray:
    """Speed (m/s) of a spherical drop `time` seconds after it was let go in still air.

    dv/dt = [(1 - r) g - 3 r C_d / (4 d) v^2] / (1 + r/2), r the density of air over that of water
    (Liu and Tong 2015, restored from their force balance), with Clift and Gauvin's drag. In steps
    of 0.02 s; a drop whose speed changes by less than 0.0002 m/s in a step keeps it. Inside a step
    four exponential ones (Rosenbrock-Euler, second order), which are stable for the smallest drops
    too. So the speed is within 0.0003 m/s of the exact solution until it settles, at most 0.004 m/s
    short of the end.

    Shapes broadcast; diameters of 0 to 100 mm, times of 0 to infinity. Up to 2 mm the speed ends
    within 6 % of Gunn and Kinzer's measurements; larger real drops flatten and fall slower than
    this sphere: `terminal_speed` has their speeds.
    """
    diameter, time = np.broadcast_arrays(
        floats("diameter_mm", diameter_mm, 0.0, LARGEST_SPHERE),
        floats("time", time, 0.0, math.inf),
    )
    speed = np.zeros(diameter.shape)
    left = np.where(diameter > 0.0, time, 0.0)
    size = np.maximum(diameter, 1e-6) * 1e-3  # a nanometre, only so that nothing divides by 0
    while np.any(left > 0.0):
        step = np.minimum(left, STEP)
        reached = speed
        for _ in range(SUBSTEPS):
            reached = reached + _change(reached, size, step / SUBSTEPS)
        change = np.where(left > 0.0, reached - speed, 0.0)
        speed = speed + change
        terminal = (step == STEP) & (np.abs(change) < SETTLED)
        left = np.where(terminal, 0.0, left - step)
    return speed


def _change(speed: FloatArray, size: FloatArray, step: FloatArray) -> FloatArray:
    """Change of speed over a step: phi(J h) h f with J the derivative of the acceleration f."""
    mass = 1.0 + 0.5 * DENSITY_RATIO
    scale = 0.75 * DENSITY_RATIO * VISCOSITY / (size * size) / mass  # f = g' - scale C_d Re v
    re = speed * size / VISCOSITY
    drag = drag_times_reynolds(re)
    force = (1.0 - DENSITY_RATIO) * GRAVITY / mass - scale * drag * speed
    power = re**1.16
    growth = (
        3.6 * 0.687 * re**0.687
        + 0.42 * re * power * (power + 2.16 * 42500.0) / (power + 42500.0) ** 2
    )  # Re times the derivative of C_d Re
    rate = scale * (drag + growth)
    return -force * np.expm1(-rate * step) / rate
