"""The place: what it is made of and what can be asked about it; numpy only, no OpenGL."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from demo_game.collision import Box, Post

from . import bake, cabin, cabin_porch, cabin_room, cabin_solid, figure, flora, layout, paint
from . import grass as grass_module
from . import ground_mesh, occluders, props, scatter, windmill
from .layout import BIRCH, BUSH, CONIFER
from .mesh import Builder, Mesh, merge, placed, yaw_matrix
from .rocks import rock
from .scatter import VARIANTS
from .terrain import Terrain

LAMP_COLOR = (1.0, 0.66, 0.34)  # linear RGB
STEP_UP = 0.45  # m, the highest step one walks up


class Lamp(NamedTuple):
    """A warm light."""

    position: tuple[float, float, float]  # m
    color: tuple[float, float, float]  # linear RGB times strength
    reach: float  # m


class Pond(NamedTuple):
    """The still water."""

    center: tuple[float, float]  # (x, z), m
    radii: tuple[float, float]  # m
    level: float  # m, world height


class Place:
    """Ground, cabin, pond, lamps, trees, a figure and a windmill; the same for the same seed."""

    def __init__(self, seed: int = 0) -> None:
        self.seed = seed
        self.terrain = Terrain(seed)
        self.path = self.terrain.path  # (n, 2) from the start to the mailbox
        self.path_to_door = self.terrain.spur  # (n, 2) from the path to the steps
        self.pond = Pond(layout.POND, layout.POND_RADII, self.terrain.pond_level)
        floor = self.terrain.cabin_level + cabin.FLOOR_ABOVE_GROUND
        self.cabin_origin = np.array([layout.CABIN[0], floor, layout.CABIN[1]])
        self.door = (layout.CABIN[0], floor, layout.CABIN[1] + cabin.DEPTH / 2.0)
        self.room = (layout.CABIN[0], floor, layout.CABIN[1])  # middle of the floor
        self.porch = (layout.CABIN[0], floor, layout.CABIN[1] + cabin.DEPTH / 2.0 + 1.2)
        x, z = layout.MAILBOX
        self.mailbox = (x, self.terrain.height(x, z), z)
        self.blocks = cabin_solid.blocks()
        self.trees = scatter.trees(self.terrain, seed)
        self.rocks = scatter.rocks(self.terrain, seed)
        self.walk = figure.Walk(self.terrain)
        x, z = layout.WINDMILL
        self._mill = windmill.base(self.terrain.height(x, z), x, z)
        self.bounds = (np.array([-200.0, -10.0, -240.0]), np.array([200.0, 60.0, 160.0]))

    # What walkers ask.

    def height(self, x: ArrayLike, z: ArrayLike) -> float | NDArray:
        """Height of the ground, m; scalar or arrays."""
        return self.terrain.height(x, z)

    def ground_normal(self, x: ArrayLike, z: ArrayLike) -> NDArray:
        """(..., 3) unit normal of the ground."""
        return self.terrain.normal(x, z)

    def floor_height(self, x: float, z: float, y: float) -> float:
        """Highest ground, floor or step at (x, z) that feet at height y can stand on, m."""
        best = self.terrain.height(float(x), float(z))
        for block in self.blocks:
            if not block.walkable:
                continue
            dx, top, dz = block.center + self.cabin_origin + (0.0, block.size[1] / 2.0, 0.0)
            inside = abs(x - dx) <= block.size[0] / 2.0 and abs(z - dz) <= block.size[2] / 2.0
            if inside and best < top <= y + STEP_UP:
                best = float(top)
        return float(best)

    @cached_property
    def colliders(self) -> list[Box | Post]:
        """What stops a walker; the cabin's floors and steps are boxes with their tops as floors."""
        found: list[Box | Post] = []
        for block in self.blocks:
            if block.solid:
                x, y, z = block.center + self.cabin_origin
                half = block.size / 2.0
                span = (float(y - half[1]), float(y + half[1]))
                flat = (float(half[0]), float(half[2]))
                found.append(Box((float(x), float(z)), flat, *span, block.heading))
        for (x, y, z), tall, shape in zip(
            self.trees.foot.tolist(), self.trees.height, self.trees.shape, strict=True
        ):
            if shape // VARIANTS == BUSH:
                found.append(Post((x, z), 0.42 * float(tall), y - 1.0, y + 0.5 * float(tall)))
                continue
            thick = (0.026 if shape // VARIANTS == CONIFER else 0.032) * tall
            thick *= 0.55 if shape // VARIANTS == BIRCH else 1.0
            found.append(Post((x, z), float(thick), y - 1.0, y + float(tall) * 0.4))
        for x, y, z, size, _ in self.rocks:
            found.append(Post((x, z), 0.40 * size, y - 1.0, y + 0.30 * size))
        for x, z in layout.LAMPS:
            y = self.terrain.height(x, z)
            found.append(Post((x, z), 0.12, y - 1.0, y + 3.6))
        x, y, z = self.mailbox
        found.append(Post((x, z), 0.16, y - 1.0, y + 1.4))
        x, z = layout.WINDMILL
        y = self.terrain.height(x, z)
        found.append(Post((x, z), windmill.radius_at(0.5), y - 2.0, y + windmill.HEIGHT))
        for posts in self.fence_posts:
            for (x0, z0), (x1, z1) in zip(posts[:-1], posts[1:], strict=True):
                x, z = (x0 + x1) / 2.0, (z0 + z1) / 2.0
                y = self.terrain.height(x, z)
                half = (math.hypot(x1 - x0, z1 - z0) / 2.0, 0.07)
                heading = math.atan2(-(z1 - z0), x1 - x0)
                found.append(Box((x, z), half, y - 1.0, y + 1.15, heading))
        return found

    @cached_property
    def fence_posts(self) -> list[list[list[float]]]:
        """(x, z) of every fence's posts."""
        return [props.fence_posts(line).tolist() for line in layout.FENCES]

    @cached_property
    def lamps(self) -> list[Lamp]:
        """Lamp posts in the order of the path, then the porch's and the table's lantern."""
        found = []
        for x, z in layout.LAMPS:
            head = props.lamp_head(x, self.terrain.height(x, z), z, self._towards_path(x, z))
            found.append(Lamp((head[0], head[1], head[2]), LAMP_COLOR, 14.0))
        for at, strength in ((cabin_porch.LANTERN, 0.45), (cabin_room.LAMP, 0.8)):
            x, y, z = (self.cabin_origin + at).tolist()
            r, g, b = (strength * c for c in LAMP_COLOR)
            found.append(Lamp((x, y, z), (r, g, b), 9.0))
        return found

    def _towards_path(self, x: float, z: float) -> float:
        gap = self.path - (x, z)
        nearest = gap[np.argmin(np.hypot(gap[:, 0], gap[:, 1]))]
        return float(math.atan2(nearest[0], nearest[1]))

    # What moves.

    def figure_position(self, t: float) -> tuple[float, float, float, float]:
        """(x, y, z) of its soles and its heading about +y, at time t, s."""
        return self.walk.position(t)

    def figure_pose(self, t: float) -> dict[str, NDArray]:
        """(4, 4) transform of every part of the figure at time t, s."""
        return dict(zip(figure.PARTS, self.walk.pose(t), strict=True))

    def mover_pose(self, t: float) -> dict[str, NDArray]:
        """(4, 4) transform of every part of the windmill that moves, at time t, s."""
        return {"sails": windmill.sail_pose(t, self._mill)}

    def poses(self, t: float) -> dict[str, NDArray]:
        """(4, 4) transform of every dynamic occluder by its name, at time t, s."""
        found = {f"figure/{name}": pose for name, pose in self.figure_pose(t).items()}
        return found | self.mover_pose(t)

    # What is drawn.

    @cached_property
    def meshes(self) -> dict[str, Mesh]:
        """Every mesh but ground, trees and grass: static ones in the world's axes with their
        light baked, "figure" and "sails" in their parts' own."""
        return dict(self._build_meshes())

    def _build_meshes(self) -> Iterator[tuple[str, Mesh]]:
        lights = [(np.array(p) - self.cabin_origin, max(c)) for p, c, _ in self.lamps]
        lights.append((np.array(cabin_room.EMBERS), 0.25))
        moved = placed(np.eye(3), self.cabin_origin)
        shell, inside = Builder(21), Builder(22)
        cabin.walls(shell, inside)
        cabin.roof(shell, inside)
        for part in (cabin.foundation, cabin_porch.porch, cabin_porch.steps, cabin_porch.door):
            part(shell)
        cabin_room.room(inside)
        for name, build, bounce in (("room", inside, 0.30), ("cabin", shell, 0.10)):
            mesh = bake.bake(build.build(), self.blocks, lights, bounce)
            yield name, mesh.moved(moved)
        height = self.terrain.height
        posts = Builder(23)
        for x, z in layout.LAMPS:
            props.lamp_post(posts, x, height(x, z), z, self._towards_path(x, z))
        fences = Builder(24)
        for line in self.fence_posts:
            props.fence(fences, np.array(line), height)
        box = Builder(25)
        x, y, z = self.mailbox
        props.mailbox(box, x, y, z, self._towards_path(x, z))
        pile = Builder(26)
        x, z = layout.CABIN
        props.woodpile(pile, x - 3.35, height(x - 3.35, z), z - 0.4, 3.0)
        props.bench(pile, -6.4, height(-6.4, -50.2), -50.2, 1.1)
        stones = []
        for k, (x, y, z, size, turn) in enumerate(self.rocks):
            matrix = placed(yaw_matrix(turn) * size, (x, y, z))
            stones.append(rock(300 + k % 5, 2 if size > 1.2 else 1).moved(matrix))
        mill = Builder(27)
        windmill.tower(mill)
        for name, mesh in (("lamps", posts.build()), ("fences", fences.build()),
                           ("mailbox", box.build()), ("yard", pile.build()),
                           ("rocks", merge(stones)),
                           ("windmill", mill.build().moved(self._mill))):  # fmt: skip
            yield name, bake.lamp_lit(mesh, self.lamps)
        simple = cabin_solid.simple_mesh(self.blocks)
        yield "cabin_far", bake.bake(simple, self.blocks, lights, 0.10).moved(moved)
        sails = Builder(28)
        sails.part = len(figure.PARTS)
        windmill.sails(sails)
        yield "sails", sails.build(dynamic=True)
        yield "figure", figure.mesh()

    @cached_property
    def ground(self) -> ground_mesh.GroundMesh:
        """The ground and the hills."""
        return ground_mesh.ground_mesh(self.terrain, paint.LOW, paint.HIGH)

    @cached_property
    def grass(self) -> grass_module.Grass:
        """Tufts beside the path."""
        return grass_module.grass(self.terrain, self.seed)

    @cached_property
    def meadow(self) -> NDArray:
        """(1024, 1024, 4) u1 painted map of the ground; see `paint.meadow`."""
        shades = []
        for (x, _, z), tall, shape in zip(
            self.trees.foot, self.trees.height, self.trees.shape, strict=True
        ):
            wide = {CONIFER: 0.30, BIRCH: 0.24, BUSH: 1.0}.get(int(shape) // VARIANTS, 0.40)
            shades += [(x, z, wide * tall, 0.42), (x, z, 0.09 * tall, 0.5)]
        shades += [(x, z, 0.85 * size, 0.55) for x, _, z, size, _ in self.rocks]
        shades += [(x, z, 0.5, 0.4) for x, z in layout.LAMPS]
        shades += [(x, z, 0.5, 0.4) for line in self.fence_posts for x, z in line]
        shades.append((*layout.WINDMILL, 5.6, 0.75))
        return paint.meadow(self.terrain, shades)

    def tree_mesh(self, shape: int, level: int) -> Mesh:
        """Mesh of a tree shape, a metre tall, at a level of detail 0 (near) to 2."""
        kind, variant = divmod(shape, VARIANTS)
        if kind == CONIFER:
            return flora.conifer(100 + variant, level)
        if kind == BUSH:
            return flora.bush(400 + variant, level)
        return flora.broadleaf(200 + 10 * kind + variant, level, kind == BIRCH)

    def occluders(self) -> Iterator[occluders.Occluder]:
        """What rain can hit: (name, vertices, indices, dynamic)."""
        return occluders.occluders(
            self.terrain, self.blocks, self.cabin_origin, self.trees, self.meshes, figure.meshes()
        )
