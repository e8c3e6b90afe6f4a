"""Framebuffers to draw into, given back afterwards."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import moderngl


@contextmanager
def bound_target(ctx: moderngl.Context, size: tuple[int, int]) -> Iterator[moderngl.Framebuffer]:
    """With colour and depth, and bound; without one some drivers write no transform feedback."""
    made = ctx.simple_framebuffer(size)
    made.use()
    try:
        yield made
    finally:
        for thing in (*made.color_attachments, made.depth_attachment, made):
            thing.release()


@contextmanager
def window_like(ctx: moderngl.Context, size: tuple[int, int]) -> Iterator[moderngl.Framebuffer]:
    """With colour and a depth that can be read, as the demo draws into off screen."""
    color, depth = ctx.texture(size, 4), ctx.depth_texture(size)
    made = ctx.framebuffer([color], depth)
    try:
        yield made
    finally:
        for thing in (made, depth, color):
            thing.release()
