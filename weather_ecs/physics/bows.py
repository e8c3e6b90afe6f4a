"""Rainbows and the halo of 22 degrees: brightness and colour by the angle, from ray optics.

A bow is what many parallel rays become that enter drops all over their faces: those reflected once
inside make the primary, those reflected twice the secondary, and neither sends light between the
two (R. Descartes 1637; H. M. Nussenzveig 1977). The halo comes of rays that pass through two sides
of hexagonal ice crystals turned every way, which stand at 60 degrees to one another (R. Greenler
1980). Indices of refraction: water by Quan and Fry 1995 in a form without salt, ice by Warren and
Brandt 2008. The disc of the sun blurs all of it.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from weather_ecs.physics.checks import FloatArray

SUN_WIDTH = 0.53  # degrees
_WAVES = np.linspace(400.0, 690.0, 59)  # nm
BOW = np.linspace(30.0, 62.0, 257)  # degrees from the point opposite the sun
HALO = np.linspace(19.0, 46.0, 217)  # degrees from the sun


@lru_cache(maxsize=1)
def rainbow() -> FloatArray:
    """Linear RGB at the angles `BOW`, (n, 3); the primary's maximum has luminance 1."""
    index = 1.31279 + 15.762 / _WAVES - 4382.0 / _WAVES**2 + 1.1455e6 / _WAVES**3
    return _colored(_bow(index, 1) + _bow(index, 2), BOW)


@lru_cache(maxsize=1)
def halo() -> FloatArray:
    """Linear RGB at the angles `HALO`, (n, 3); its maximum has luminance 1."""
    index = 1.2986 + 3.45e3 / _WAVES**2
    turn = np.radians((np.arange(4000) + 0.5) / 4000.0 * 90.0)[:, None]  # of the crystal
    inner = math.pi / 3.0 - np.arcsin(np.sin(turn) / index)
    out = index * np.sin(inner)
    passes = (np.abs(out) < 1.0) & (inner > -math.pi / 2.0)
    way = np.degrees(turn + np.arcsin(np.clip(out, -1.0, 1.0)) - math.pi / 3.0)
    weight = np.where(passes, np.cos(turn), 0.0)  # of the face, as the ray sees it
    return _colored(_counted(way, weight, HALO), HALO)


def _bow(index: FloatArray, inside: int) -> FloatArray:
    """Light of the rays with so many reflections inside, (angles, waves)."""
    b = np.sqrt((np.arange(6000) + 0.5) / 6000.0)[:, None]  # evenly over the drop's disc
    enters = np.arcsin(b)
    turns = np.arcsin(b / index)
    deflected = 2.0 * (enters - turns) + inside * (math.pi - 2.0 * turns)
    antisolar = np.degrees(np.abs(math.pi - np.mod(deflected, 2.0 * math.pi)))
    plus, minus = enters + turns, enters - turns
    light = np.zeros_like(turns)
    for reflected in (
        (np.sin(minus) / np.sin(plus)) ** 2,
        (np.tan(minus) / np.tan(plus)) ** 2,
    ):
        light += 0.5 * (1.0 - reflected) ** 2 * reflected**inside
    return _counted(antisolar, light, BOW)


def _counted(angle: FloatArray, weight: FloatArray, grid: FloatArray) -> FloatArray:
    """Weights of rays by their angle and wave, as radiance: over the ring's solid angle."""
    step = grid[1] - grid[0]
    edges = np.append(grid - 0.5 * step, grid[-1] + 0.5 * step)
    sums = [
        np.histogram(angle[:, k], edges, weights=np.broadcast_to(weight, angle.shape)[:, k])[0]
        for k in range(angle.shape[1])
    ]
    return np.stack(sums, -1) / np.sin(np.radians(grid))[:, None]


def _colored(spectra: FloatArray, grid: FloatArray) -> FloatArray:
    """Linear sRGB of spectra (angles, waves) under a white sun, blurred by its disc."""
    white = _eye().sum(0)
    rgb = (spectra @ _eye()) / white
    step = grid[1] - grid[0]
    offsets = np.arange(-round(SUN_WIDTH / step), round(SUN_WIDTH / step) + 1) * step
    disc = np.sqrt(np.maximum((0.5 * SUN_WIDTH) ** 2 - offsets**2, 0.0))
    reach = len(offsets) // 2
    padded = np.pad(rgb, ((reach, reach), (0, 0)), mode="edge")
    blurred = np.stack(
        [np.convolve(padded[:, c], disc / disc.sum(), mode="valid") for c in range(3)], -1
    )
    # Colours purer than a screen has are brought to its rim, with the brightness they have.
    grey = (blurred @ (0.2126, 0.7152, 0.0722))[:, None]
    least = blurred.min(-1, keepdims=True)
    share = np.where(least < 0.0, grey / np.maximum(grey - least, 1e-12), 1.0)
    inside = grey + (blurred - grey) * share
    inside /= grey.max()
    inside.setflags(write=False)
    return inside


def _eye() -> FloatArray:
    """What each wave adds to linear sRGB, (waves, 3): Wyman, Sloan and Shirley 2013, CIE 1931."""

    def lobe(peak: float, left: float, right: float) -> FloatArray:
        width = np.where(peak > _WAVES, left, right)
        return np.exp(-0.5 * ((_WAVES - peak) * width) ** 2)

    x = 0.362 * lobe(442.0, 0.0624, 0.0374) + 1.056 * lobe(599.8, 0.0264, 0.0323)
    x -= 0.065 * lobe(501.1, 0.0490, 0.0382)
    y = 0.821 * lobe(568.8, 0.0213, 0.0247) + 0.286 * lobe(530.9, 0.0613, 0.0322)
    z = 1.217 * lobe(437.0, 0.0845, 0.0278) + 0.681 * lobe(459.0, 0.0385, 0.0725)
    to_rgb = np.array(
        [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]]
    )
    return np.stack([x, y, z], -1) @ to_rgb.T
