"""The place: what it is made of and what can be asked about it; numpy only, no OpenGL."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from demo_game.collision import Box, Post

from . import (
    bake,
    cabin,
    cabin_porch,
    cabin_room,
    cabin_solid,
    figure,
    flora,
    grass,
    ground_mesh,
    layout,
    meshes,
    occluders,
    paint,
    props,
    scatter,
    solid,
    windmill,
)
from .layout import BIRCH, BUSH, CONIFER
from .mesh import Mesh
from .scatter import VARIANTS
from .terrain import Terrain

LAMP_COLOR = (1.0, 0.66, 0.34)  # linear RGB
LAMP_REACH, LANTERN_REACH = 14.0, 9.0  # m
BOUNDS = (-200.0, -10.0, -240.0), (200.0, 60.0, 160.0)  # m, lowest and highest corner
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
        self.pond = Pond(layout.POND, layout.POND_RADII, self.terrain.pond_level)
        floor = self.terrain.cabin_level + cabin.FLOOR_ABOVE_GROUND
        self.cabin_origin = np.array([layout.CABIN[0], floor, layout.CABIN[1]])
        self.door = (layout.CABIN[0], floor, layout.CABIN[1] + cabin.DEPTH / 2.0)
        self.room = (layout.CABIN[0], floor, layout.CABIN[1])  # middle of the floor
        self.porch = (layout.CABIN[0], floor, layout.CABIN[1] + cabin.DEPTH / 2.0 + 1.2)
        x, z = layout.MAILBOX
        self.mailbox = (x, self.terrain.height(x, z), z)
        a, b, c = (self.cabin_origin + cabin_room.LETTER).tolist()
        self.letter = (a, b, c)  # on the table
        self.blocks = cabin_solid.blocks()
        self.trees = scatter.trees(self.terrain, seed)
        self.rocks = scatter.rocks(self.terrain, seed)
        self.walk = figure.Walk(self.terrain)
        x, z = layout.WINDMILL
        self._mill = windmill.base(self.terrain.height(x, z), x, z)
        self._last_posed: tuple[float, dict[str, NDArray], dict[str, NDArray]] | None = None
        self.bounds = (np.array(BOUNDS[0]), np.array(BOUNDS[1]))

    # What walkers ask.

    @overload
    def height(self, x: float, z: float) -> float: ...

    @overload
    def height(self, x: NDArray, z: NDArray) -> NDArray: ...

    def height(self, x: float | NDArray, z: float | NDArray) -> float | NDArray:
        """Height of the ground, m; scalars or arrays."""
        return self.terrain.height(x, z)  # type: ignore[arg-type, return-value]

    def floor_height(self, x: float, z: float, y: float) -> float:
        """Highest ground, floor or step at (x, z) that feet at height y can stand on, m."""
        best = self.terrain.height(float(x), float(z))
        for low_x, high_x, low_z, high_z, top in self._floors:
            inside = low_x <= x <= high_x and low_z <= z <= high_z
            if inside and best < top <= y + STEP_UP:
                best = top
        return best

    @cached_property
    def _floors(self) -> list[tuple[float, float, float, float, float]]:
        found = []
        for block in self.blocks:
            if block.walkable:
                low = (self.cabin_origin + block.center - block.size / 2.0).tolist()
                high = (self.cabin_origin + block.center + block.size / 2.0).tolist()
                found.append((low[0], high[0], low[2], high[2], high[1]))
        return found

    @cached_property
    def colliders(self) -> list[Box | Post]:
        """What stops a walker; the cabin's floors and steps are boxes with their tops as floors."""
        return [
            *solid.cabin_boxes(self.blocks, self.cabin_origin),
            *solid.tree_posts(self.trees),
            *solid.single_posts(self.terrain, self.rocks),
            *solid.fence_boxes(self.terrain, self.fence_posts),
            *solid.yard_boxes(self.terrain),
        ]

    @cached_property
    def fence_posts(self) -> list[list[list[float]]]:
        """(x, z) of every fence's posts."""
        return [props.fence_posts(line).tolist() for line in layout.FENCES]

    @cached_property
    def lamps(self) -> list[Lamp]:
        """Lamp posts in the order of the path, then the porch's and the table's lantern."""
        found = []
        for x, z in layout.LAMPS:
            facing = meshes.towards_path(self.path, x, z)
            a, b, c = props.lamp_head(x, self.terrain.height(x, z), z, facing)
            found.append(Lamp((a, b, c), LAMP_COLOR, LAMP_REACH))
        for at, strength in ((cabin_porch.LANTERN, 0.45), (cabin_room.LAMP, 0.8)):
            a, b, c = (self.cabin_origin + at).tolist()
            red, green, blue = (strength * value for value in LAMP_COLOR)
            found.append(Lamp((a, b, c), (red, green, blue), LANTERN_REACH))
        return found

    # What moves.

    def figure_position(self, t: float) -> tuple[float, float, float, float]:
        """(x, y, z) of its soles and its heading about +y (0 looks along +z), at time t, s."""
        return self.walk.position(t)

    def figure_pose(self, t: float) -> dict[str, NDArray]:
        """(4, 4) transform of every part of the figure at time t, s."""
        return self._posed(t)[0]

    def mover_pose(self, t: float) -> dict[str, NDArray]:
        """(4, 4) transform of every part of the windmill that moves, at time t, s."""
        return self._posed(t)[1]

    def poses(self, t: float) -> dict[str, NDArray]:
        """(4, 4) transform of every dynamic occluder by its name, at time t, s."""
        parts, movers = self._posed(t)
        return {f"figure/{name}": pose for name, pose in parts.items()} | movers

    def _posed(self, t: float) -> tuple[dict[str, NDArray], dict[str, NDArray]]:
        """The figure and what moves of the windmill; a frame asks more than once."""
        if self._last_posed is None or self._last_posed[0] != t:
            parts = dict(zip(figure.PARTS, self.walk.pose(t), strict=True))
            movers = {"sails": windmill.sail_pose(t, self._mill)}
            for pose in (*parts.values(), *movers.values()):
                pose.setflags(write=False)
            self._last_posed = t, parts, movers
        return self._last_posed[1:]

    # What is drawn.

    @cached_property
    def meshes(self) -> dict[str, Mesh]:
        """Every mesh but ground, trees and grass: static ones in the world's axes with their
        light baked, "figure" and "sails" in their parts' own."""
        found = {}
        for name, mesh in meshes.open_meshes(
            self.terrain, self.fence_posts, self.rocks, self._mill
        ):
            found[name] = bake.lamp_lit(mesh, self.lamps)
        found |= dict(meshes.cabin_meshes(self.blocks, self.cabin_origin, self.lamps))
        return found | dict(meshes.moving_meshes())

    @cached_property
    def ground(self) -> ground_mesh.GroundMesh:
        """The ground and the hills."""
        return ground_mesh.ground_mesh(self.terrain, paint.LOW, paint.HIGH)

    @cached_property
    def grass(self) -> grass.Grass:
        """Tufts beside the path."""
        return grass.grass(self.terrain, self.seed)

    @cached_property
    def meadow(self) -> NDArray:
        """(1024, 1024, 4) u1 painted map of the ground; see `paint.meadow`."""
        shades = []
        rows = zip(self.trees.foot, self.trees.height, self.trees.shape, strict=True)
        for (x, _, z), tall, shape in rows:
            wide = {CONIFER: 0.30, BIRCH: 0.24, BUSH: 1.0}.get(int(shape) // VARIANTS, 0.40)
            shades += [(x, z, wide * tall, 0.42), (x, z, 0.09 * tall, 0.5)]
        shades += [(x, z, 0.85 * size, 0.55) for x, _, z, size, _ in self.rocks]
        shades += [(x, z, 0.5, 0.4) for x, z in layout.LAMPS]
        shades += [(x, z, 0.5, 0.4) for line in self.fence_posts for x, z in line]
        shades.append((*layout.WINDMILL, 5.6, 0.75))
        return paint.meadow(self.terrain, shades)

    def tree_mesh(self, shape: int, level: int) -> Mesh:
        """Mesh of a tree shape, a metre tall, at a level of detail from 0 (near) to 3."""
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
