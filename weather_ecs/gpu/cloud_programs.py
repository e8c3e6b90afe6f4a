"""The programs that draw clouds, where their textures are bound, and the block that lights them."""

from __future__ import annotations

import moderngl
import numpy as np

from weather_ecs.frame import ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.cloud_blocks import CLOUD_VIEW
from weather_ecs.gpu.cloud_images import hulls, image_array
from weather_ecs.gpu.cloud_sequence import (
    BILLBOARDS,
    FADING,
    LIT,
    LIT_FADING,
    PICTURE,
    SOFT,
    Items,
    runs,
)
from weather_ecs.gpu.flash import cloud_lights
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics.cloud_images import CLOUD_IMAGES
from weather_ecs.physics.cloud_light import Surround

IMAGES = ("IMAGES", len(CLOUD_IMAGES))


def _billboards(*defines: str) -> ProgramKey:
    return ProgramKey(vertex="cloud.vert", fragment="cloud.frag", defines=(IMAGES, *defines))


def _pictures(*defines: str) -> ProgramKey:
    return ProgramKey(vertex="cloud_quad.vert", fragment="cloud_quad.frag", defines=defines)


KEYS = {
    BILLBOARDS: _billboards(),
    SOFT: _billboards("SOFT"),
    PICTURE: _pictures(),
    FADING: _pictures("FADING"),
    LIT: _pictures("FLASHES"),
    LIT_FADING: _pictures("FADING", "FLASHES"),
}
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
        self._programs = {kind: shaders.program(key) for kind, key in KEYS.items()}
        self._arrays = {kind: ctx.vertex_array(p, []) for kind, p in self._programs.items()}
        for program in self._programs.values():
            for name, unit in UNITS.items():
                if name in program:
                    program[name] = unit
            if "cloud_hulls" in program:
                program["cloud_hulls"].write(hulls().tobytes())

    def aim(self, matrix: bytes, *kinds: int) -> None:
        """From camera-relative places to the picture; 16 floats, column by column."""
        for kind in kinds or KEYS:
            self._programs[kind]["cloud_matrix"].write(matrix)

    def haze(self, share: float) -> None:
        """1, or 0 while impostors are made: these get theirs when they are drawn."""
        for kind in (BILLBOARDS, SOFT):
            self._programs[kind]["cloud_hazed"] = share

    def draw(self, items: Items) -> None:
        """Draw what there is, in its order."""
        for kind, begin, end in runs(items):
            self.run(kind, begin, end)

    def run(self, kind: int, begin: int, end: int) -> None:
        """Draw a stretch of the stream, or of the rows of pictures."""
        if end > begin:
            self._programs[kind]["cloud_first"] = begin
            self._arrays[kind].render(moderngl.TRIANGLE_STRIP, vertices=8, instances=end - begin)

    def light(self, view: ViewData, light: Surround) -> None:
        """Fill and bind the block for a view."""
        data, look = self._block.data, view.frame.cloud_look
        data["cloud_sun"][:3], data["cloud_sun_color"][:3] = light.direction, light.sun
        data["cloud_sun"][3] = view.position[1] - view.frame.profile.ground
        data["cloud_suns"][:, :3] = light.suns
        data["cloud_above"][:3], data["cloud_below"][:3] = light.above, light.below
        data["cloud_ambient"][:3] = look.ambient * light.plain
        places, colors = cloud_lights(view.frame, view.position)
        data["cloud_flashes"] = 0 if look.plain else len(places)
        data["cloud_flash_at"][: len(places)] = places
        data["cloud_flash_color"][: len(places)] = colors
        data["cloud_look"] = (look.silver, look.base, look.ambient, float(look.plain))
        data["cloud_depth"][:2] = view.projection[2, 2], view.projection[2, 3]
        data["cloud_softness"] = max(look.softness, 1e-3)
        self._block.upload()
        self.bind()

    def bind(self) -> None:
        """Bind the block as it was filled."""
        self._block.bind()

    def meet(self, x: int, y: int) -> None:
        """Billboards are drawn into the picture; x, y: the viewport's corner, pixels."""
        self._programs[SOFT]["cloud_scene_at"] = (1.0, 1.0, -float(x), -float(y))
        self._programs[SOFT]["cloud_guard"] = (0.0, 0.0, -1.0)
        self._programs[SOFT]["cloud_guard_at"] = (0.0, 0.0, -3.0)

    def meet_from(
        self, size: tuple[int, int], canvas: tuple[int, int], depth: tuple[float, float, float]
    ) -> None:
        """And now on a canvas, both in pixels; depth: of its guard, as `Group.depth`."""
        (width, height), (wide, high) = size, canvas
        self._programs[SOFT]["cloud_scene_at"] = (width / wide, height / high, 0.0, 0.0)
        x, y, middle = depth
        at_corner = 0.5 * (middle - x - y) + 0.5
        self._programs[SOFT]["cloud_guard_at"] = depth
        self._programs[SOFT]["cloud_guard"] = (x / wide, y / high, at_corner)

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
