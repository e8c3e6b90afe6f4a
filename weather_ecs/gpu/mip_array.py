"""Texture arrays with their smaller levels made here, and not by the driver.

Mesa's software rasteriser makes each level of each layer as a picture of its own. More than 64 of
them at once, as an array of a dozen layers has, leave it without pictures in advance for as long
as the context lives: whatever is drawn from then on waits for all that was drawn before.
"""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.gl import GL

LAYOUTS = {1: (e.R8, e.RED), 2: (e.RG8, e.RG), 4: (e.RGBA8, e.RGBA)}


def mip_levels(layers: NDArray[np.uint8]) -> list[NDArray[np.uint8]]:
    """Every level, largest first, each texel the mean of four; layers: (n, 2**k, 2**k, channels).

    Raises ValueError where the sides are no equal powers of two.
    """
    size = layers.shape[1]
    if layers.shape[2] != size or size & (size - 1):
        raise ValueError(f"layers of {layers.shape[2]} x {size} texels have no even halves")
    levels = [layers]
    while levels[-1].shape[1] > 1:
        n, h, w, c = levels[-1].shape
        parts = levels[-1].reshape(n, h // 2, 2, w // 2, 2, c).astype(np.uint16)
        levels.append(((parts.sum(axis=(2, 4)) + 2) // 4).astype(np.uint8))
    return levels


def mip_array(
    ctx: moderngl.Context, size: int, channels: int, levels: list[bytes]
) -> moderngl.TextureArray:
    """Layers of size x size texels on the GPU, of levels as bytes; the caller releases it.

    Not repeated, and filtered within one level each: between two of them no flake is seen to
    change, and it is a third cheaper. Changes what moderngl's default unit has bound.
    """
    layers = len(levels[0]) // (size * size * channels)
    texture = ctx.texture_array((size, size, layers), channels, levels[0])
    gl = GL()
    internal, layout = LAYOUTS[channels]
    gl.glActiveTexture(e.TEXTURE0 + ctx.default_texture_unit)
    gl.glBindTexture(e.TEXTURE_2D_ARRAY, texture.glo)
    gl.glPixelStorei(e.UNPACK_ALIGNMENT, 1)
    for k, data in enumerate(levels[1:], 1):
        side, pixels = size >> k, np.frombuffer(data, np.uint8)
        gl.glTexImage3D(
            e.TEXTURE_2D_ARRAY, k, internal, side, side, layers, 0, layout, e.UNSIGNED_BYTE,
            pixels.ctypes.data,
        )  # fmt: skip
    texture.filter = moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR
    texture.repeat_x = texture.repeat_y = False
    return texture
