"""What stands still and what moves in parts: buildings, posts, rocks; figure and sails."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.place import Place
from demo_game.place.mesh import Mesh, merge

from . import geometry
from .frame_block import FrameBlock
from .geometry import PLAIN_FORMAT, PLAIN_NAMES, VERTEX_FORMAT, VERTEX_NAMES
from .programs import Look, Variants, compile_program, release_all, set_matrix, set_uniforms

CABIN_NEAR = 44.0  # m, within which the cabin has all its planks
# m, from where to where a mesh is drawn; others always are
SHOWN = {"room": (0.0, CABIN_NEAR), "letter": (0.0, CABIN_NEAR), "cabin": (0.0, CABIN_NEAR),
         "cabin_far": (CABIN_NEAR, 1e9), "mailbox": (0.0, 160.0), "yard": (0.0, 90.0),
         "jetty": (0.0, 110.0), "lamps": (0.0, 180.0), "fences": (0.0, 115.0),
         "rocks": (0.0, 95.0)}  # fmt: skip
GRAIN_UNIT = 1  # where the scene binds the detail map
PARTS = 12
ACTOR_REACH = 120.0  # m


def ordered(mesh: Mesh, name: str) -> Mesh:
    """The room from its middle outwards, the cabin inwards: what is drawn first hides the rest."""
    if name not in ("room", "cabin"):
        return mesh
    low, high = mesh.bounds
    middle, half = (low + high) * 0.5, (high - low) * 0.5
    away = np.abs((mesh.vertices[mesh.indices].mean(1) - middle) / half).max(1)
    order = np.argsort(away if name == "room" else -away, kind="stable")
    return replace(mesh, indices=mesh.indices[order])


class Statics:
    """All static meshes in one buffer, in pieces."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, place: Place) -> None:
        self.shadow = compile_program(ctx, "shadow.vert", "shadow.frag")
        vertices, indices, ranges, lows, highs, reach, names = [], [], [], [], [], [], []
        vertex_count = index_count = 0
        for name, mesh in place.meshes.items():
            if mesh.dynamic:
                continue
            pieces = geometry.cut(ordered(mesh, name))
            vertices.append(geometry.pack(mesh))
            indices.append(pieces.indices + np.uint32(vertex_count))
            ranges.append(pieces.ranges + (index_count, 0))
            names += [name] * len(pieces.low)
            lows.append(pieces.low)
            highs.append(pieces.high)
            reach.append(np.full((len(pieces.low), 2), SHOWN.get(name, (0.0, 1e9))))
            vertex_count += len(mesh.vertices)
            index_count += pieces.indices.size
        self._vertices = ctx.buffer(np.concatenate(vertices).tobytes())
        self._indices = ctx.buffer(np.concatenate(indices).astype("u4").tobytes())
        self._ranges = np.concatenate(ranges)
        self._low, self._high = np.concatenate(lows), np.concatenate(highs)
        self._reach = np.concatenate(reach)
        self._names, self._hidden = np.array(names), np.zeros(len(names), bool)
        cabin = np.array([n.startswith(("cabin", "room", "letter")) for n in names])
        self._cabin = cabin
        low, high = self._low[cabin].min(0), self._high[cabin].max(0)  # all change at once
        self._switch = (
            np.where(cabin[:, None], low, self._low),
            np.where(cabin[:, None], high, self._high),
        )
        self._shadow_count = index_count - place.meshes["cabin_far"].indices.size
        whole = (self._vertices, VERTEX_FORMAT, *VERTEX_NAMES)

        def look(*defines: str) -> Look:
            program = compile_program(ctx, "object.vert", "object.frag", "GRAIN", *defines)
            block.attach(program)
            return program, [ctx.vertex_array(program, [whole], self._indices)]

        self._kinds = Variants(look), Variants(partial(look, "SOFT"))
        self.soft = False  # whether shadows are soft
        self._close = ctx.sampler(filter=(moderngl.LINEAR, moderngl.LINEAR))
        bare = (self._vertices, "3f4 16x1", "in_position")
        self._shadow_array = ctx.vertex_array(self.shadow, [bare], self._indices)

    @property
    def looks(self) -> tuple[Variants]:
        """What it is drawn with now."""
        return (self._kinds[self.soft],)

    def draw(self, planes: NDArray, outside: NDArray, camera: NDArray) -> None:
        """Draw what is seen, near to far; `outside`: planes of where more than the cabin is."""
        away = geometry.box_distance(camera, self._low, self._high)
        seen = geometry.boxes_seen(outside, self._low, self._high)
        if outside is not planes:
            seen |= self._cabin & geometry.boxes_seen(planes, self._low, self._high)
        switch = geometry.box_distance(camera, *self._switch)
        seen &= (switch >= self._reach[:, 0]) & (switch < self._reach[:, 1])
        chosen = np.flatnonzero(seen & ~self._hidden)
        inside = switch.min() == 0.0
        if inside:  # the picture is full of boards, all of them close
            self._close.use(GRAIN_UNIT)
        array = self.looks[0].arrays[0]
        for first, count in self._ranges[chosen[np.argsort(away[chosen])]].tolist():
            array.render(vertices=count, first=first)
        if inside:
            self._close.clear(GRAIN_UNIT)

    def show(self, name: str, shown: bool) -> None:
        """Show a mesh or leave it out; its shadow stays."""
        self._hidden[self._names == name] = not shown

    def draw_shadow(self, matrix: NDArray) -> None:
        """Draw all of it from the sun; the simple cabin comes last and is left out."""
        set_matrix(self.shadow, "light_matrix", matrix)
        self._shadow_array.render(vertices=self._shadow_count)

    def release(self) -> None:
        """Give everything back."""
        release_all((*self._kinds, self._shadow_array, self._vertices, self._indices))
        release_all((self._close, self.shadow))


class Actors:
    """The figure and the windmill's sails: one mesh, a matrix a part."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, place: Place) -> None:
        self._place = place
        self.shadow = compile_program(ctx, "shadow.vert", "shadow.frag", "PARTS")
        mesh = merge([place.meshes["figure"], place.meshes["sails"]])
        self._vertices = ctx.buffer(geometry.pack(mesh).tobytes())
        self._indices = ctx.buffer(mesh.indices.tobytes())
        self._split = place.meshes["figure"].indices.size
        self._total = mesh.indices.size
        whole = (self._vertices, PLAIN_FORMAT, *PLAIN_NAMES)

        def look(*defines: str) -> Look:
            program = compile_program(ctx, "object.vert", "object.frag", "PARTS", *defines)
            block.attach(program)
            return program, [ctx.vertex_array(program, [whole], self._indices)]

        self.looks = (Variants(look),)
        bare = (self._vertices, "3f4 8x1 4f1 4x1", "in_position", "in_extra")
        self._shadow_array = ctx.vertex_array(self.shadow, [bare], self._indices)
        self._sails = place.meshes["sails"]
        self._lamps = np.array([lamp.position for lamp in place.lamps])
        self._strength = np.array([max(lamp.color) for lamp in place.lamps])
        self.spheres: list[tuple[NDArray, float]] = []
        self._radius = float(np.linalg.norm(self._sails.vertices, axis=1).max())

    def pose(self, time: float, snow: tuple[float, float] = (0.0, 0.0)) -> None:
        """Take the pose of a time, s, with so much snow (m) on the figure and on the sails."""
        program = self.looks[0].program
        set_uniforms(program, part_snow=snow)
        poses = [*self._place.figure_pose(time).values(), *self._place.mover_pose(time).values()]
        padded = [*poses, *[np.eye(4)] * (PARTS - len(poses))]
        set_matrix(program, "parts", *padded)
        set_matrix(self.shadow, "parts", *padded)
        body, sails = poses[0][:3, 3], poses[-1][:3, 3]
        self.spheres = [(body, 1.15), (sails, self._radius)]
        gap = np.sum((self._lamps - body) ** 2, axis=1)
        light = float(np.sum(self._strength * 1.2 / (gap + 1.2)))
        program["part_light"] = (light, 0.0, 0.0, 0.0)

    def draw(self, planes: NDArray, camera: NDArray) -> None:
        """Draw those that are seen."""
        first = 0
        for (center, radius), end in zip(self.spheres, (self._split, self._total), strict=True):
            seen = (planes[:, :3] @ center + planes[:, 3] > -radius).all()
            near = np.linalg.norm(center - camera) < ACTOR_REACH + 20.0 * radius
            if seen and near:
                self.looks[0].arrays[0].render(vertices=end - first, first=first)
            first = end

    def draw_shadow(self, matrix: NDArray) -> None:
        """Draw all of it from the sun."""
        set_matrix(self.shadow, "light_matrix", matrix)
        self._shadow_array.render()

    def release(self) -> None:
        """Give everything back."""
        release_all((*self.looks, self._shadow_array, self._vertices, self._indices))
        self.shadow.release()
