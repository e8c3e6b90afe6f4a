"""Texture arrays with levels made on the CPU."""

from __future__ import annotations

import moderngl
import numpy as np
import pytest

from weather_ecs.gpu.mip_array import mip_array, mip_levels

READ = """
#version 330
uniform sampler2DArray pictures;
uniform int layer, level;
out vec4 color;
void main() { color = texelFetch(pictures, ivec3(gl_FragCoord.xy, layer), level); }
"""
WHOLE = """
#version 330
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }
"""


def _layers(channels: int) -> np.ndarray:
    rng = np.random.default_rng(3)
    return rng.integers(0, 256, (5, 16, 16, channels), dtype=np.uint8)


def test_each_level_is_the_mean_of_four() -> None:
    levels = mip_levels(_layers(2))
    assert [level.shape[1] for level in levels] == [16, 8, 4, 2, 1]
    fine = levels[0][3, 4:6, 6:8].astype(float).mean(axis=(0, 1))
    assert np.abs(levels[1][3, 2, 3] - fine).max() <= 0.5
    whole = levels[0].astype(float).mean(axis=(1, 2))
    assert np.abs(levels[-1][:, 0, 0] - whole).max() <= 2.0  # half a step for each level


def test_uneven_sides_are_refused() -> None:
    with pytest.raises(ValueError, match="12 x 16"):
        mip_levels(np.zeros((1, 16, 12, 2), np.uint8))
    with pytest.raises(ValueError, match="12 x 12"):
        mip_levels(np.zeros((1, 12, 12, 2), np.uint8))


@pytest.mark.parametrize("channels", [2, 4])
def test_every_level_arrives_on_the_gpu(ctx: moderngl.Context, channels: int) -> None:
    levels = mip_levels(_layers(channels))
    texture = mip_array(ctx, 16, channels, [level.tobytes() for level in levels])
    texture.filter = moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR
    program = ctx.program(vertex_shader=WHOLE, fragment_shader=READ)
    array = ctx.vertex_array(program, [])
    picture = ctx.texture((16, 16), 4)
    target = ctx.framebuffer([picture])
    target.use()
    texture.use(0)
    for k, level in enumerate(levels):
        side = 16 >> k
        for layer in (0, 4):
            program["layer"], program["level"] = layer, k
            array.render(moderngl.TRIANGLE_STRIP, vertices=4)
            data = target.read(viewport=(0, 0, side, side), components=4, alignment=1)
            seen = np.frombuffer(data, np.uint8).reshape(side, side, 4)[..., :channels]
            assert (seen == level[layer]).all()
    for thing in (texture, array, program, target, picture):
        thing.release()
