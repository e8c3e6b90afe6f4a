"""Framebuffers for the state guard, and what of the state differs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import moderngl

Keep = Callable[[Any], Any]
FILL = """#version 330
void main() { gl_Position = vec4(ivec2(gl_VertexID & 1, gl_VertexID >> 1) * 4 - 1, 0, 1); }
"""
WHITE = "#version 330\nout vec4 color;\nvoid main() { color = vec4(1.0); }"


def make_target(ctx: moderngl.Context, keep: Keep, size: tuple[int, int]) -> moderngl.Framebuffer:
    color, depth = keep(ctx.texture(size, 4)), keep(ctx.depth_renderbuffer(size))
    target = keep(ctx.framebuffer([color], depth))
    target.clear()
    return target
