"""Waiting for what compute shaders have written."""

from __future__ import annotations

import moderngl


class ComputeOrder:
    """`order.after(bits)`: what was dispatched before is written before what comes after reads it.

    Mesa's software rasteriser has done a dispatch when the call returns, and its barrier waits for
    all drawing besides: there it is left out, and a frame is made while the last one is drawn.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._immediate = str(ctx.info["GL_RENDERER"]).startswith("llvmpipe")

    def after(self, bits: int) -> None:
        """`bits`: how it will be read, as in glMemoryBarrier."""
        if not self._immediate:
            self._ctx.memory_barrier(bits)
