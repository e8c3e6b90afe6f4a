"""The pictures of snow flakes as a texture array, made once for all contexts."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.gpu.flake_shapes import (
    SIZE,
    clump,
    dendrite,
    melting,
    needle,
    plate,
    star,
)  # fmt: skip
from weather_ecs.gpu.mip_array import mip_array, mip_levels

# Kinds and how many pictures of each, in the order of the layers; also in flake.vert.
PLATES, NEEDLES, STARS, CLUMPS, WET = 12, 6, 28, 16, 6
LAYERS = PLATES + NEEDLES + STARS + CLUMPS + WET
_DENDRITES = 16  # of the stars
_SEED = 30


def build() -> NDArray[np.uint8]:
    """Every layer, (LAYERS, SIZE, SIZE, 2): share of a texel covered, and how bright it is."""
    made = _many(plate, PLATES, 0) + _many(needle, NEEDLES, 1)
    made += _many(star, STARS - _DENDRITES, 2) + _many(dendrite, _DENDRITES, 3)
    rng = np.random.default_rng((_SEED, 4))
    made += [clump(rng, made[PLATES:]) for _ in range(CLUMPS)]
    made += _many(melting, WET, 5)
    return np.round(np.clip(np.stack(made), 0.0, 1.0) * 255.0).astype(np.uint8)


def _many(draw: Callable[[np.random.Generator], NDArray], count: int, kind: int) -> list[NDArray]:
    rng = np.random.default_rng((_SEED, kind))
    return [draw(rng) for _ in range(count)]


@cache
def _built() -> list[bytes]:
    return [level.tobytes() for level in mip_levels(build())]


def flake_texture(ctx: moderngl.Context) -> moderngl.TextureArray:
    """The pictures on the GPU, with smaller levels for distance and for what is not in focus."""
    return mip_array(ctx, SIZE, 2, _built())
