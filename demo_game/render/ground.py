"""The ground under the camera and out to the hills, dry or wet."""

from __future__ import annotations

from functools import partial

import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.place import Place, paint
from demo_game.place.ground_mesh import drowned

from . import geometry
from .environment import Environment
from .frame_block import FrameBlock
from .programs import Look, Variants, compile_program, release_all, set_uniforms

COARSE_FROM = 32.0  # m, from where chunks have few triangles
DRIES = 1800.0  # s after the last rain until the ground is certainly dry
DETAIL_REACH = 26.0  # m, up to which the ground has its fine grain
FAR = 4  # number of the first look beyond that
UNITS = {"shadow_map": 0, "detail_map": 1, "meadow_map": 2, "sky_map": 3}


class Ground:
    """Chunks of the ground; those that are wet anywhere take the wet program."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, place: Place) -> None:
        mesh = place.ground
        data = np.zeros(
            len(mesh.vertices), [("position", "f4", 3), ("normal", "i1", 4), ("color", "u1", 4)]
        )
        data["position"] = mesh.vertices
        data["normal"][:, :3] = np.round(mesh.normals * 127.0)
        deep = np.round(drowned(place.terrain, mesh.vertices) * 127.0)
        data["normal"][:, 3] = np.maximum(deep, -128.0)
        data["color"][:, :3] = np.round(np.sqrt(np.clip(mesh.colors, 0, 1)) * 255)
        data["color"][:, 3] = np.round(mesh.painted * 255)
        self._vertices = ctx.buffer(data.tobytes())
        self._indices = ctx.buffer(mesh.indices.tobytes())
        content = [(self._vertices, "3f4 4i1 4f1", "in_position", "in_normal", "in_color")]
        short = [(self._vertices, "3f4 4i1 4x1", "in_position", "in_normal")]

        def look(*defines: str) -> Look:
            program = compile_program(ctx, "ground.vert", "ground.frag", *defines)
            block.attach(program)
            window = (*paint.LOW.tolist(), *(1.0 / (paint.HIGH - paint.LOW)).tolist())
            set_uniforms(program, map_window=window, **UNITS)
            near = short if "NEAR" in defines else content
            return program, [ctx.vertex_array(program, near, self._indices)]

        kinds = [("NEAR", *live, *wet) for live in ((), ("LIVE",)) for wet in ((), ("WET",))]
        kinds += [(), ("WILD",)]
        self.looks = tuple([Variants(partial(look, *kind)) for kind in kinds])
        self._chunks, self._coarse = mesh.chunks, mesh.coarse
        self._skirts, self._beside = mesh.skirts, mesh.beside
        # Where chunks never match: at the pond, which stays in full, and where the grid ends.
        full = mesh.coarse[:, 1] == mesh.chunks[:, 1]
        self._hangs = full | (mesh.beside == np.arange(len(full))[:, None]).any(axis=1)
        self._hangs |= full[mesh.beside].any(axis=1)
        self._block, self._dry_from = block, np.zeros(len(mesh.low))
        self._low, self._high = mesh.low, mesh.high
        inside = (mesh.low[:, [0, 2]] > paint.LOW + paint.MARGIN).all(axis=1)
        inside &= (mesh.high[:, [0, 2]] < paint.HIGH - paint.MARGIN).all(axis=1)
        self._painted = np.asarray(inside, bool)
        # Where the painted map does not reach at all.
        ends = (first + count for first, count in mesh.chunks.tolist())
        parts = zip(mesh.chunks[:, 0].tolist(), ends, strict=True)
        self._wild = np.array([not mesh.painted[mesh.indices[a:b]].any() for a, b in parts])
        table = place.meadow
        self.map = ctx.texture((table.shape[1], table.shape[0]), 4, table.tobytes())
        self.map.build_mipmaps()
        self.map.repeat_x = self.map.repeat_y = False
        self._sharp = _sampler(ctx, moderngl.LINEAR, 0.0)
        self._soft = _sampler(ctx, moderngl.LINEAR_MIPMAP_NEAREST, 2.0)
        self._grain = _sampler(ctx, moderngl.LINEAR_MIPMAP_NEAREST, 3.0, True)

    def _wet_chunks(self, environment: Environment) -> NDArray:
        if environment.wetness > 0.0:
            return np.ones(len(self._low), bool)
        time = float(self._block.data["camera"][0, 3])
        wet = np.zeros(len(self._low), bool)
        middle = (self._low + self._high)[:, [0, 2]] * 0.5
        half = np.linalg.norm((self._high - self._low)[:, [0, 2]], axis=1) * 0.5
        for center, (a, _), _, rate, _ in environment.rain_areas:
            if rate > 0.0:
                wet |= np.linalg.norm(middle - center, axis=1) < a * 1.02 + half
        if environment.water is not None:
            self._dry_from[wet] = time + DRIES
            # Snow does not dry.
            wet = self._dry_from > (0.0 if environment.snow else time)
        return wet

    def _live_chunks(self, spheres: list[tuple[NDArray, float]], sun: NDArray) -> NDArray:
        """Where something that moves may throw its shadow."""
        live = np.zeros(len(self._low), bool)
        for center, radius in spheres:
            reach = (center[1] - self._low[:, 1] + radius) / max(sun[1], 0.05)
            end = center - sun * np.minimum(reach, 60.0)[:, None]
            low, high = np.minimum(center, end) - radius, np.maximum(center, end) + radius
            apart = (low > self._high) | (high < self._low)
            live |= ~(apart[:, 0] | apart[:, 2])
        return live

    def draw(
        self, planes: NDArray, camera: NDArray, environment: Environment, sun: NDArray,
        spheres: list[tuple[NDArray, float]],
    ) -> None:  # fmt: skip
        """Draw the chunks that are seen, near to far, neighbours in one call; `spheres` are
        what moves (centre, radius m)."""
        seen = np.flatnonzero(geometry.boxes_seen(planes, self._low, self._high))
        if not len(seen):
            return
        all_away = geometry.box_distance(camera, self._low, self._high)
        away = all_away[seen]
        near = self._painted[seen] & (away < DETAIL_REACH)
        wet, live = self._wet_chunks(environment)[seen], self._live_chunks(spheres, sun)[seen]
        kind: NDArray = np.where(near, wet + 2 * live, FAR + self._wild[seen])
        fine = away < COARSE_FROM
        # A coarse one does not meet one in full: there it hangs down at its rim.
        meets = self._hangs[seen] | (all_away[self._beside[seen]] < COARSE_FROM).any(axis=1)
        new = (np.diff(seen, prepend=-9) != 1) | (np.diff(kind, prepend=kind[0]) != 0)
        new |= np.diff(fine, prepend=fine[0])
        starts = np.flatnonzero(new)
        ends = np.append(starts[1:], len(seen))
        ranges = np.where(fine[:, None], self._chunks[seen], self._coarse[seen])
        nearest = np.minimum.reduceat(away, starts)
        sharp = True
        self._sharp.use(UNITS["meadow_map"])
        self._grain.use(UNITS["detail_map"])
        for k in np.lexsort((nearest, kind[starts] >= FAR)).tolist():
            if sharp and kind[starts[k]] >= FAR:
                self._soft.use(UNITS["meadow_map"])
                sharp = False
            array = self.looks[kind[starts[k]]].arrays[0]
            _render(array, ranges[starts[k] : ends[k]])
            if not fine[starts[k]]:
                _render(array, self._skirts[seen[starts[k] : ends[k]]][meets[starts[k] : ends[k]]])
        self._soft.clear(UNITS["meadow_map"])
        self._grain.clear(UNITS["detail_map"])

    def release(self) -> None:
        """Give everything back."""
        samplers = self._sharp, self._soft, self._grain
        release_all((*self.looks, self._vertices, self._indices, self.map, *samplers))


def _render(array: moderngl.VertexArray, ranges: NDArray) -> None:
    """Draw ranges of triangles (first, count), those in one call that follow each other."""
    begin = end = 0
    for first, count in [*ranges.tolist(), (-1, 0)]:
        if first != end:
            if end > begin:
                array.render(vertices=(end - begin) * 3, first=begin * 3)
            begin = end = first
        end += count


def _sampler(
    ctx: moderngl.Context, filter_: int, levels: float, tiled: bool = False
) -> moderngl.Sampler:
    """How a map of the ground is read: few levels only, or all would blur away at a low angle."""
    sampler = ctx.sampler(repeat_x=tiled, repeat_y=tiled, filter=(filter_, moderngl.LINEAR))
    sampler.max_lod = levels
    return sampler
