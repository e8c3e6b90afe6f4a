"""Splashes that ride on what they have hit; the oracle of `shaders/motion.glsl`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FASTEST = 16.0  # m/s along an axis; whoever is faster has been put there


def motion_bytes(velocity: NDArray) -> NDArray[np.float64]:
    """(n, 3) in [1, 255] of velocities (n, 3) in m/s; 128 stands still."""
    slow = np.abs(velocity).max(axis=-1, keepdims=True) < FASTEST
    return np.where(slow, np.floor(velocity * (127.0 / FASTEST) + 128.5), 128.0)


def motion_velocity(numbers: NDArray) -> NDArray[np.float64]:
    """The inverse, to within 6.3 cm/s."""
    return (np.asarray(numbers, np.float64) - 128.0) * (FASTEST / 127.0)


def packed(numbers: NDArray) -> NDArray[np.float64]:
    """Three of these bytes as one number that a float of 32 bits holds exactly; 0 stands still."""
    return (np.asarray(numbers, np.float64) - 128.0) @ np.array([1.0, 256.0, 65536.0])


def unpacked(number: NDArray) -> NDArray[np.float64]:
    """The inverse."""
    whole = np.asarray(number, np.float64).astype(np.int64) + 0x808080
    return np.stack([whole & 255, whole >> 8 & 255, whole >> 16 & 255], axis=-1).astype(np.float64)
