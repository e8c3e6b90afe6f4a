"""The block RainView: what it keeps from one view to the next is never out of date."""

from __future__ import annotations

from dataclasses import replace

import moderngl
import numpy as np

from tests.views import look_from, perspective
from weather_ecs.frame import STRIKE_DTYPE, DropLook, FogData, FrameData, SkyLight, ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.rain_blocks import RAIN_VIEW
from weather_ecs.gpu.view_block import fill_view

VIEWPORT = (0, 0, 64, 36)


def view_of(frame: FrameData) -> ViewData:
    matrices = look_from((1.0, 2.0, 3.0), 0.4), perspective()
    return ViewData(frame, 0, *matrices, (1.0, 2.0, 3.0), (0.0, 0.0, 0.0), 0.1, (), ())


def strike() -> np.ndarray:
    rows = np.zeros(1, STRIKE_DTYPE)
    rows["place"], rows["light"] = (200.0, 300.0, 0.0), 50.0
    return rows


def test_a_block_used_again_holds_what_a_new_one_would(ctx: moderngl.Context) -> None:
    plain = FrameData()
    frames = [
        plain,
        plain,
        replace(plain, sky=SkyLight(zenith_color=(0.1, 0.2, 0.9))),
        replace(plain, fog=FogData(color=(0.5, 0.1, 0.2))),
        replace(plain, look=DropLook(brightness=0.3)),
        replace(plain, strikes=strike()),
        plain,  # lightning leaves nothing behind
    ]
    used = BlockBuffer(ctx, RAIN_VIEW)
    shown = []
    for frame in frames:
        new = BlockBuffer(ctx, RAIN_VIEW)
        for block in (used, new):
            fill_view(block, view_of(frame), VIEWPORT)
        names = [name for name in RAIN_VIEW.dtype.names or () if name != "flash_direction"]
        for name in names:
            assert np.array_equal(used.data[name], new.data[name]), name
        shown.append(b"".join(new.data[name].tobytes() for name in names))
        new.release()
    used.release()
    assert len(set(shown)) == 5
