"""What the clouds' vertex shader makes of billboards, read back, and where it should put them."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from tests.cloud_stage import SETTINGS, SIZE, CloudStage, view_of
from weather_ecs.frame import FrameData
from weather_ecs.gpu.cloud_programs import UNITS
from weather_ecs.gpu.shader_loader import ProgramKey
from weather_ecs.physics import cloud_billboard
from weather_ecs.physics.cloud_images import CLOUD_IMAGES

NAMES = {"vs_lit": 3, "vs_shade": 3, "vs_rim": 3, "vs_relief": 3, "vs_fade": 4}
KEY = ProgramKey(
    vertex="cloud.vert",
    defines=(("IMAGES", len(CLOUD_IMAGES)),),
    varyings=(*NAMES, "gl_Position"),
)

# Vertices of the strip 0 1 7 2 6 3 5 4 that are at the square's corners as the oracle counts them.
STRIP_OF_SQUARE = [0, 1, 2, 3]
CENTERS = ((-90.0, 0.0, 0.0), (60.0, 20.0, 40.0), (0.0, 110.0, -30.0))


def captured(stage: CloudStage, frame: FrameData, **camera: Any) -> dict[str, NDArray[np.float32]]:
    """What the vertex shader makes of the first cloud's billboards, in the shape's own order."""
    passes = stage.passes
    passes.impostors_on = False
    stage.draw(frame, **camera)
    view = view_of(frame, **camera)
    guard = stage.renderer._guard
    with guard:
        passes.update(view, SETTINGS, SIZE[1])
        program = passes._shaders.program(KEY)
        for name, unit in UNITS.items():
            if name in program:
                program[name] = unit
        # The corners of a square, twice, for those of the octagon.
        square = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)] * 2, np.float32)
        program["cloud_hulls"].write(np.tile(square, (len(CLOUD_IMAGES), 1)).tobytes())
        program["cloud_first"] = 0
        program["cloud_hazed"] = 1.0
        # Places come out as they are, but for their depth.
        program["cloud_matrix"].write(np.eye(4, dtype=np.float32).tobytes())
        count = int(passes._begins[1])
        width = sum(NAMES.values()) + 4
        buffer = stage.ctx.buffer(reserve=count * 8 * width * 4)
        array = stage.ctx.vertex_array(program, [])
        array.transform(buffer, moderngl.POINTS, vertices=8, instances=count)
        rows = np.frombuffer(buffer.read(), np.float32).reshape(count, 8, width)
        rows = rows[:, STRIP_OF_SQUARE]
        array.release()
        buffer.release()
        pairs = np.frombuffer(passes._stream.texture.read(), np.uint32).reshape(-1, 2)
    back = np.argsort(pairs[:count, 0])
    found, at = {}, 0
    for name, size in (*NAMES.items(), ("place", 4)):
        found[name] = rows[back][..., at : at + size]
        at += size
    return found


def expected_places(data: Any, row: dict[str, Any]) -> tuple[NDArray, NDArray, NDArray]:
    """Middles from the cloud's centre, corners from the camera, what is there of each."""
    b = data.billboards
    there = cloud_billboard.presence(row["growth"], row["mode"], b["order"])
    middle = cloud_billboard.place(
        b["position"].astype(float), row["scale"], row["mirror"], row["heading"], row["shear"]
    )
    at = middle + np.array(row["position"]) - (0.0, 2.0, 0.0)
    size = cloud_billboard.shown_size(b["size"].astype(float), row["scale"], there)
    offsets = cloud_billboard.corners(
        at, size, b["turn"].astype(float), row["mirror"], row["heading"]
    )
    return middle, at[:, None] + offsets, there
