"""How much of the light of sun and sky other clouds take from a cloud.

A cloud stands for an ellipsoid whose matter lies as its seeds do, thinned to what they fill of it.
Along a light it is as deep as its longest chord there over the light's penetration: of that depth
Beer and Lambert's law leaves the light behind it. What stands in that light, itself so large, is
hidden by and by as its middle comes behind the other's outline; of a larger one, a part is. For the
sky overhead the same is asked along the vertical, with the wider outline that what is farther below
sees as well.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from weather_ecs.physics.checks import FloatArray
from weather_ecs.physics.cloud_billboard import smoothstep

STRENGTH = 1.5  # factor on a depth: what light passes through two clouds has lost its way
OWN = 0.5  # of a cloud's own sizes, by which it reaches out of another's shadow
INNER, OUTER = 0.45, 1.25  # distance from the middle over the sizes: all in the shadow, and none
BEFORE = 0.6, 1.2  # the same along the light, from which on a cloud is before another
OVER = 0.3, 0.7  # the same upwards over half of both: clouds of one deck have their tops in the sun
WIDER = 0.6  # m, by which an outline is wider for the sky for each m that it stands higher
SUN, SKY = 0.85, 0.7  # at most, of their light: some comes round, of the sky's from the sides
PACKED = 0.999


class Bodies(NamedTuple):
    """Clouds as ellipsoids."""

    center: FloatArray  # (n, 3) m
    half: FloatArray  # (n, 3) m
    dense: FloatArray  # (n,) 1/m, of the depth


def taken(of: Bodies, by: Bodies, light: FloatArray) -> FloatArray:
    """(m, 2), 0 to 1: what the clouds `by` take of the clouds `of` of the sun's light from the
    unit direction `light`, and of the sky's. A cloud in the same place takes nothing.
    """
    up = np.array([0.0, 1.0, 0.0])
    away = by.center[None] - of.center[:, None]
    sizes = np.broadcast_to(by.half, away.shape)
    touching = by.half[None, :, 1] + of.half[:, None, 1]
    over = smoothstep(*OVER, away[..., 1] / touching)
    sun = _left(away, sizes, of, by, light, over)
    wider = sizes.copy()
    wider[..., 0::2] += (WIDER * np.maximum(away[..., 1], 0.0))[..., None]
    sky = _left(away, wider, of, by, up, over)
    return np.stack([SUN * (1.0 - sun), SKY * (1.0 - sky)], axis=1)


def _left(
    away: FloatArray,
    shadow: FloatArray,
    of: Bodies,
    by: Bodies,
    light: FloatArray,
    over: FloatArray,
) -> FloatArray:
    """(m,) of the light along a direction; shadow: (m, n, 3) half sizes of what throws it; over:
    (m, n) how far it does for being higher.
    """
    sizes = shadow + OWN * of.half[:, None]
    place, ray = away / sizes, light / sizes
    one = np.maximum(np.sqrt(np.einsum("mni,mni->mn", ray, ray)), 1e-9)  # 1/m, along the light
    before = np.einsum("mni,mni->mn", place, ray) / one
    off = np.sqrt(np.maximum(np.einsum("mni,mni->mn", place, place) - before * before, 0.0))
    hides = (1.0 - smoothstep(INNER, OUTER, off)) * smoothstep(*BEFORE, before)
    hides *= over * np.minimum(shadow[..., 0::2] / of.half[:, None, 0::2], 1.0).prod(-1)
    slope = light / by.half
    depth = 2.0 * STRENGTH * by.dense / np.sqrt(np.einsum("ni,ni->n", slope, slope))
    return np.asarray(np.prod(1.0 + hides * np.expm1(-depth), axis=1))


def packed(shares: FloatArray) -> FloatArray:
    """Two shares (n, 2) in one number, as `cloud_row.glsl` takes them apart: steps of 1/255."""
    return np.asarray(np.round(255.0 * shares[:, 0]) + PACKED * np.clip(shares[:, 1], 0.0, 1.0))
