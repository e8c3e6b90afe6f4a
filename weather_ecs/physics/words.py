"""Integer hash of 32-bit words, the same as shaders/hash.glsl (the PCG output permutation)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

U = np.uint32


def hash_word(x: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """Words that look random."""
    with np.errstate(over="ignore"):
        state = x.astype(U) * U(747796405) + U(2891336453)
        word = ((state >> ((state >> U(28)) + U(4))) ^ state) * U(277803737)
        return (word >> U(22)) ^ word


def hash_unit(x: NDArray[np.uint32]) -> NDArray[np.float32]:
    """In [0, 1): 24 bits, exact in a float."""
    return (hash_word(x) >> U(8)).astype(np.float32) * np.float32(1.0 / 16777216.0)
