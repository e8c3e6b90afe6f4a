"""The programs that draw clouds, where their textures are bound, and the block that lights them."""

from __future__ import annotations

import moderngl
import numpy as np

from weather_ecs.frame import ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.cloud_blocks import CLOUD_VIEW
from weather_ecs.gpu.cloud_images import hulls, image_array
from weather_ecs.gpu.flash import cloud_lights
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics.cloud_images import CLOUD_IMAGES
from weather_ecs.physics.cloud_light import Surround

IMAGES = ("IMAGES", len(CLOUD_IMAGES))
BILLBOARDS = ProgramKey(vertex="cloud.vert", fragment="cloud.frag", defines=(IMAGES,))
SOFT = ProgramKey(vertex="cloud.vert", fragment="cloud.frag", defines=(IMAGES, "SOFT"))
QUADS = ProgramKey(vertex="cloud_quad.vert", fragment="cloud_quad.frag")
# Units of the samplers; the same in all programs.
UNITS = {
    "cloud_images": 0,
    "cloud_stream": 1,
    "cloud_rows": 2,
    "cloud_billboards": 3,
    "cloud_seeds": 4,
    "cloud_atlas": 5,
    "cloud_quads": 6,
    "scene_depth": 7,
}


class CloudPrograms:
    """Made with the first clouds."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self.images = image_array(ctx)
        self._block = BlockBuffer(ctx, CLOUD_VIEW)
        self._programs = {key: shaders.program(key) for key in (BILLBOARDS, SOFT, QUADS)}
        self._arrays = {key: ctx.vertex_array(p, []) for key, p in self._programs.items()}
        for program in self._programs.values():
            for name, unit in UNITS.items():
                if name in program:
                    program[name] = unit
            if "cloud_hulls" in program:
                program["cloud_hulls"].write(hulls().tobytes())

    def aim(self, key: ProgramKey, matrix: bytes) -> None:
        """From camera-relative places to the picture; 16 floats, column by column."""
        self._programs[key]["cloud_matrix"].write(matrix)

    def haze(self, key: ProgramKey, share: float) -> None:
        """1, or 0 while impostors are made: these get theirs when they are drawn."""
        self._programs[key]["cloud_hazed"] = share

    def billboards(self, key: ProgramKey, begin: int, end: int) -> None:
        """Draw a stretch of the stream."""
        if end > begin:
            self._programs[key]["cloud_first"] = begin
            self._arrays[key].render(moderngl.TRIANGLE_STRIP, vertices=8, instances=end - begin)

    def quads(self, first: int, count: int) -> None:
        """Draw so many impostors from the row `first` on."""
        self._programs[QUADS]["cloud_first"] = first
        self._arrays[QUADS].render(moderngl.TRIANGLE_STRIP, vertices=4, instances=count)

    def light(self, view: ViewData, light: Surround) -> None:
        """Fill and bind the block for a view."""
        data, look = self._block.data, view.frame.cloud_look
        data["cloud_sun"][:3], data["cloud_sun_color"][:3] = light.direction, light.sun
        data["cloud_above"][:3], data["cloud_below"][:3] = light.above, light.below
        data["cloud_ambient"][:3] = look.ambient * light.plain
        places, colors = cloud_lights(view.frame, view.position)
        data["cloud_flashes"] = 0 if look.plain else len(places)
        data["cloud_flash_at"][: len(places)] = places
        data["cloud_flash_color"][: len(places)] = colors
        data["cloud_look"] = (look.silver, look.base, look.ambient, float(look.plain))
        data["cloud_depth"][:2] = view.projection[2, 2], view.projection[2, 3]
        data["cloud_origin"][2] = max(look.softness, 1e-3)
        self._block.upload()
        self._block.bind()

    def set_origin(self, x: int, y: int) -> None:
        """Lower left corner of the viewport that is drawn to, pixels."""
        self._block.data["cloud_origin"][:2] = x, y
        self._block.upload()
        self._block.bind()

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for array in self._arrays.values():
            array.release()
        self._block.release()
        self.images.release()


def camera_matrix(view: ViewData) -> bytes:
    """From camera-relative places, world axes, to the picture."""
    rotation = np.eye(4)
    rotation[:3, :3] = view.view[:3, :3]
    return (view.projection @ rotation).astype(np.float32).T.tobytes()
