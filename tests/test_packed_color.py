"""Colours as two numbers in a varying: what comes out is what was put in, even a little off."""

from __future__ import annotations

from importlib.resources import files

import moderngl
import numpy as np
import pytest

TEXT = files("weather_ecs").joinpath("shaders/packed_color.glsl").read_text(encoding="utf-8")
PROGRAM = f"""
#version 330
{TEXT}
in vec4 in_color;
in float in_off;
out vec4 shown;

void main() {{ shown = unpack_color(pack_color(in_color) + in_off); }}
""".lstrip()


def unpacked(ctx: moderngl.Context, colors: np.ndarray, off: np.ndarray) -> np.ndarray:
    """(n, 4) colours, there and back, with so much lost on the way."""
    program = ctx.program(vertex_shader=PROGRAM, varyings=["shown"])
    rows = ctx.buffer(np.column_stack([colors, off]).astype("f4").tobytes())
    array = ctx.vertex_array(program, [(rows, "4f 1f", "in_color", "in_off")])
    found = ctx.buffer(reserve=16 * len(colors))
    target = ctx.framebuffer([ctx.renderbuffer((4, 4))])
    target.use()
    array.transform(found, moderngl.POINTS)
    data = np.frombuffer(found.read(), np.float32).reshape(-1, 4)
    for thing in (array, rows, found, program, target, *target.color_attachments):
        thing.release()
    return data


@pytest.mark.parametrize("off", [0.0, 0.001, -0.001])
def test_a_colour_comes_back_as_it_was(ctx: moderngl.Context, off: float) -> None:
    rng = np.random.default_rng(4)
    colors = rng.uniform(0.0, 1.0, (4000, 4)) * (3.9, 3.9, 3.9, 1.0)
    # Whole numbers, where the least loss would change all the rest.
    colors[:500, 0] = colors[500:1000, 3] = 0.0
    colors[1000:1500, 3], colors[1500:2000, 0] = 1.0, 3.9
    colors[2000:2500, 1:3] = np.rint(colors[2000:2500, 1:3] * 1000.0) / 1000.0
    found = unpacked(ctx, colors, np.full(len(colors), off))
    assert np.abs(found - colors).max(axis=0) == pytest.approx(0.0, abs=0.006)
    assert np.abs(found - colors)[:, 1:].max() < 0.0016
    assert found.min() >= 0.0


def test_what_is_too_bright_stays_as_bright_as_can_be(ctx: moderngl.Context) -> None:
    colors = np.array([(9.0, 0.1, 0.2, 0.5), (0.1, 9.0, 9.0, 1.5), (-1.0, -1.0, 0.3, -0.5)])
    found = unpacked(ctx, colors, np.zeros(3))
    wanted = np.clip(colors, 0.0, (3.9, 3.9, 3.9, 1.0))
    np.testing.assert_allclose(found, wanted, atol=0.002)
