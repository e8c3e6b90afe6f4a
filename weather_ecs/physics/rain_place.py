"""Places in a rain container's own axes, in float32: `container.glsl` and maps of drop_step.glsl.

q (n, 2) = forward, lateral, in shares of the container's reach; axis = centre x, centre z, cosine
and sine of the heading.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.words import hash_unit, hash_word

F = np.float32
U = np.uint32


def resettle(ids: NDArray[np.uint32], s: NDArray, seed: int) -> NDArray:
    """Even in the half disc of radius s, (n, 2)."""
    h = hash_word(ids ^ hash_word(np.full(1, seed, U)))
    r = s * np.sqrt(hash_unit(h))
    angle = (hash_unit(h ^ U(0x9E3779B9)) - F(0.5)) * F(math.pi)
    return np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1).astype(F)


def to_container(p: NDArray, axis: tuple[float, ...], reach: tuple[float, ...]) -> NDArray:
    """Shares of reach along the container's own axes, (n, 2), of world points (x, z)."""
    return turn_to_container(p - np.asarray(axis[:2], F), axis, reach)


def turn_to_container(v: NDArray, axis: tuple[float, ...], reach: tuple[float, ...]) -> NDArray:
    c, s = F(axis[2]), F(axis[3])
    turned = np.stack([v[:, 0] * c - v[:, 1] * s, v[:, 0] * s + v[:, 1] * c], axis=1)
    return (turned / np.asarray(reach[:2], F)).astype(F)


def from_container(q: NDArray, axis: tuple[float, ...], reach: tuple[float, ...]) -> NDArray:
    c, s = F(axis[2]), F(axis[3])
    e = q * np.asarray(reach[:2], F)
    turned = np.stack([e[:, 0] * c + e[:, 1] * s, -e[:, 0] * s + e[:, 1] * c], axis=1)
    return (turned + np.asarray(axis[:2], F)).astype(F)


def in_half_disc(q: NDArray, s: NDArray) -> NDArray:
    return (q[:, 0] >= 0.0) & ((q * q).sum(axis=1) <= s * s)


def ring(q: NDArray, moved: NDArray, s: NDArray) -> tuple[NDArray, NDArray]:
    """Drops that left along `moved`, entered again on the same line: (q, which could be)."""
    length = np.sqrt((moved * moved).sum(axis=1))
    good = length >= 1e-9
    e = moved / np.where(good, length, 1.0)[:, None].astype(F)
    along = (q * e).sum(axis=1)
    root = s * s - ((q * q).sum(axis=1) - along * along)
    good &= root > 0.0
    root = np.sqrt(np.maximum(root, 0.0))
    first, last = -along - root, -along + root
    crosses = np.abs(e[:, 0]) > 1e-7
    back = -q[:, 0] / np.where(crosses, e[:, 0], 1.0)
    first = np.where(crosses & (e[:, 0] > 0.0), np.maximum(first, back), first)
    last = np.where(crosses & (e[:, 0] <= 0.0), np.minimum(last, back), last)
    good &= crosses | (q[:, 0] >= 0.0)
    chord = last - first
    good &= chord > 1e-7 * s
    chord = np.where(good, chord, 1.0).astype(F)
    moved_by = -chord * np.floor(-first / chord)
    return np.where(good[:, None], q + e * moved_by[:, None], q).astype(F), good
