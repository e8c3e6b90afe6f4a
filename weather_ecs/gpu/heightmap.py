"""The collision heightmap: the depth of the scene as the rain sees it (seed 001, 3.2.1).

The map lies level, in world axes, and looks along the mean fall direction by shearing: a point is
carried along its fall to the height 0 of the world, and where it arrives is its place in the map.
So a roof casts a slanted rain shadow in wind, and a map that is moved by whole texels shows every
surface at the same texels as before: nothing crawls.
"""

from __future__ import annotations

import logging

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import OccluderData
from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.occluder_meshes import OccluderMeshes
from weather_ecs.gpu.occluder_motion import OccluderMotion
from weather_ecs.physics.footprint import (
    Footprint,
    SlopeFollower,
    fall_slope,
    fall_speed_of,
    footprint,
)

__all__ = ["Footprint", "Heightmap", "fall_speed_of", "footprint"]

_log = logging.getLogger("weather_ecs")

STILL = 128.0 / 255.0  # of a channel of velocities, see physics/ride.py
# From [0, 1] to clip space, where the depth runs the same way.
CLIP = np.array([[2.0, 0, 0, -1.0], [0, 2.0, 0, -1.0], [0, 0, 2.0, -1.0], [0, 0, 0, 1.0]])


class Heightmap:
    """Depth of an observer's surroundings: a cached static layer, dynamic occluders over it."""

    def __init__(
        self, ctx: moderngl.Context, guard: StateGuard, meshes: OccluderMeshes, size: int
    ) -> None:
        self._ctx = ctx
        self._guard = guard
        self._meshes = meshes
        self.size = size
        self.footprint: Footprint | None = None
        self.captures = 0  # of the dynamic layer
        self.static_captures = 0
        # What does not move, without what does.
        self.static_texture, self._static_target = self._layer()
        self.texture, self._target = self._layer()
        # Velocities of what moves, over the same depth; see shaders/motion.glsl.
        self.motion = ctx.texture((size, size), 4)
        self.motion.filter = moderngl.NEAREST, moderngl.NEAREST
        self.motion.repeat_x = self.motion.repeat_y = False
        self._motion_target = ctx.framebuffer([self.motion], self.texture)
        self._motion = OccluderMotion()
        self._swept = False  # nothing moves in the texture
        self._seen: tuple[OccluderData, ...] | None = None
        self._still: list[OccluderData] | None = None
        self._moving: list[OccluderData] = []
        self._callbacks = False  # among what moves: the game may draw it elsewhere at any time
        self._broken: dict[int, object] = {}  # functions that have failed, by their occluder
        self._slope = SlopeFollower()
        self._matrix: tuple[Footprint, NDArray[np.float64]] | None = None  # to the map's clip space
        self.others = False  # whether the last capture met other meshes than the one before

    def _layer(self) -> tuple[moderngl.Texture, moderngl.Framebuffer]:
        texture = self._ctx.depth_texture((self.size, self.size))
        texture.compare_func = ""
        texture.filter = moderngl.NEAREST, moderngl.NEAREST
        texture.repeat_x = texture.repeat_y = False
        return texture, self._ctx.framebuffer([], texture)

    def capture(
        self,
        occluders: tuple[OccluderData, ...],
        position: tuple[float, float, float],
        reach: float,
        wind: tuple[float, float, float],
        fall_speed: float,
        extent: float = 1.25,
        time: float = 0.0,
    ) -> bool:
        """Bring the map up to date; draws only what has changed. True if anything was drawn.

        `time`, s, is the weather's: how fast things move is told from it.
        Leaves the bound framebuffer, depth test, mask and culling changed: the caller restores.
        """
        before = self.footprint
        slope = self._slope.follow(fall_slope(wind, fall_speed))
        place = footprint(position, reach, wind, fall_speed, self.size, before, extent, slope)
        # An occluder that has not changed is the same object, and lists compare by identity.
        rests = self._motion.came_to_rest(time)
        stays = place is before or place == before
        if occluders is self._seen and stays and not (self._callbacks or rests):
            return False
        self._seen = occluders
        sound = [o for o in occluders if o.draw is None or self._broken.get(o.key) != o.draw]
        still = [o for o in sound if not o.dynamic]
        moving = [o for o in sound if o.dynamic]
        fresh = not stays or still != self._still
        self._callbacks = any(o.draw is not None for o in moving)
        if not fresh and moving == self._moving and not (self._callbacks or rests):
            return False
        self._motion.follow(moving, time)
        self.footprint = place
        self.others = fresh or _meshes_of(moving) != _meshes_of(self._moving)
        if fresh:
            self._prepare(self._static_target)
            self._static_target.clear(depth=1.0)
            self._draw(still, place, self._static_target)
            self._still = still
            self.static_captures += 1
        if self._motion.moves or not self._swept:
            self._motion_target.use()
            self._guard.gl.glClearColor(STILL, STILL, STILL, 1.0)
            self._guard.gl.glClear(e.COLOR_BUFFER_BIT)
        self._copy_static()
        if self._callbacks or not self._motion.moves:
            self._prepare(self._target)
        self._draw(moving, place, self._target, self._motion if self._motion.moves else None)
        self._swept = not self._motion.moves
        self._moving = moving
        self.captures += 1
        return True

    def _copy_static(self) -> None:
        # moderngl's copy_framebuffer goes by colour attachments, and these have none.
        gl, n = self._guard.gl, self.size
        gl.glBindFramebuffer(e.READ_FRAMEBUFFER, self._static_target.glo)
        gl.glBindFramebuffer(e.DRAW_FRAMEBUFFER, self._target.glo)
        gl.glBlitFramebuffer(0, 0, n, n, 0, 0, n, n, e.DEPTH_BUFFER_BIT, e.NEAREST)

    def _prepare(self, target: moderngl.Framebuffer) -> None:
        target.use()
        self._ctx.enable_only(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<="

    def _draw(
        self,
        occluders: list[OccluderData],
        place: Footprint,
        target: moderngl.Framebuffer,
        motion: OccluderMotion | None = None,
    ) -> None:
        if self._matrix is None or self._matrix[0] is not place:
            self._matrix = place, CLIP @ place.matrix()
        to_map = self._matrix[1]
        for occluder in occluders:
            if occluder.draw is None:
                continue
            try:
                occluder.draw(to_map.copy())
            except Exception:
                # The game's own code: named, left out from here on, and the frame goes on.
                self._broken[occluder.key] = occluder.draw
                _log.exception("occluder %r failed and is left out", occluder.draw)
            # Whatever the game's code has bound or switched on ends here.
            self._guard.reset()
            self._prepare(target)
        if motion is not None:
            self._prepare(self._motion_target)
        self._meshes.draw([o for o in occluders if o.draw is None], to_map, motion)

    def fill(self, block: BlockBuffer) -> None:
        """Write what shaders need of this map into a block `Shelter`, unless it is there."""
        assert self.footprint is not None
        place = self.footprint
        if block.holds == (place, self.size):
            return
        block.holds = place, self.size
        block["shelter_matrix"] = place.matrix()
        span, texel = place.top - place.bottom, 2.0 * place.half / self.size
        block.data["shelter_size"] = (self.size, span, texel, 0.0)
        block.data["shelter_fall"] = (*place.slope, 0.0, 0.0)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        targets = self._motion_target, self._target, self._static_target
        for thing in (*targets, self.motion, self.texture, self.static_texture):
            thing.release()


def _meshes_of(occluders: list[OccluderData]) -> list[int]:
    return [id(o.vertices) for o in occluders]
