"""The ground under the camera and out to the hills, dry or wet."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.place import Place, paint

from . import geometry
from .environment import Environment
from .frame_block import FrameBlock
from .programs import compile_program, set_uniforms

LAMP_STRENGTH = 1.5  # as in light.glsl
UNITS = {"shadow_map": 0, "detail_map": 1, "meadow_map": 2, "sky_map": 3}


class Ground:
    """Chunks of the ground; those that are wet anywhere take the wet program."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, place: Place) -> None:
        self.dry = compile_program(ctx, "ground.vert", "ground.frag")
        self.wet = compile_program(ctx, "ground.vert", "ground.frag", "WET")
        block.attach(self.dry, self.wet)
        size = paint.HIGH - paint.LOW
        for program in (self.dry, self.wet):
            window = (*paint.LOW.tolist(), *(1.0 / size).tolist())
            set_uniforms(program, map_window=window, lamp_scale=LAMP_STRENGTH * paint.LAMP_RANGE)
            set_uniforms(program, **UNITS)
        mesh = place.ground
        data = np.zeros(
            len(mesh.vertices), [("position", "f4", 3), ("normal", "i1", 4), ("color", "u1", 4)]
        )
        data["position"] = mesh.vertices
        data["normal"][:, :3] = np.round(mesh.normals * 127.0)
        data["color"][:, :3] = np.round(np.sqrt(np.clip(mesh.colors, 0, 1)) * 255)
        data["color"][:, 3] = np.round(mesh.painted * 255)
        self._vertices = ctx.buffer(data.tobytes())
        self._indices = ctx.buffer(mesh.indices.tobytes())
        content = [(self._vertices, "3f4 4i1 4f1", "in_position", "in_normal", "in_color")]
        self._dry_array = ctx.vertex_array(self.dry, content, self._indices)
        self._wet_array = ctx.vertex_array(self.wet, content, self._indices)
        self._chunks = mesh.chunks
        self._low, self._high = mesh.low, mesh.high
        table = place.meadow
        self.map = ctx.texture((table.shape[1], table.shape[0]), 4, table.tobytes())
        self.map.build_mipmaps()
        self.map.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
        self.map.repeat_x = self.map.repeat_y = False

    def _wet_chunks(self, environment: Environment) -> NDArray:
        if environment.wetness > 0.0:
            return np.ones(len(self._low), bool)
        wet = np.zeros(len(self._low), bool)
        middle = (self._low + self._high)[:, [0, 2]] * 0.5
        half = np.linalg.norm((self._high - self._low)[:, [0, 2]], axis=1) * 0.5
        for center, (a, _), _, rate, _ in environment.rain_areas:
            if rate > 0.0:
                wet |= np.linalg.norm(middle - center, axis=1) < a * 1.02 + half
        return wet

    def draw(self, planes: NDArray, camera: NDArray, environment: Environment) -> None:
        """Draw the chunks that are seen, near to far, neighbours in one call."""
        seen = np.flatnonzero(geometry.boxes_seen(planes, self._low, self._high))
        if not len(seen):
            return
        wet = self._wet_chunks(environment)[seen]
        away = geometry.box_distance(camera, self._low[seen], self._high[seen])
        new = (np.diff(seen, prepend=-9) != 1) | (np.diff(wet, prepend=wet[0]) != 0)
        starts = np.flatnonzero(new)
        ends = np.append(starts[1:], len(seen))
        nearest = np.minimum.reduceat(away, starts)
        for k in np.argsort(nearest).tolist():
            first = self._chunks[seen[starts[k]], 0]
            last = seen[ends[k] - 1]
            count = self._chunks[last].sum() - first
            array = self._wet_array if wet[starts[k]] else self._dry_array
            array.render(vertices=int(count) * 3, first=int(first) * 3)

    def release(self) -> None:
        """Give everything back."""
        for item in (self._dry_array, self._wet_array, self._vertices, self._indices, self.map,
                     self.dry, self.wet):  # fmt: skip
            item.release()
