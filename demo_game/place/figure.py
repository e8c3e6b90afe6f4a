"""A figure that walks its round: ten rigid parts hung on joints, posed from the distance walked."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from . import layout, palette
from .mesh import PLAIN, Builder, Mesh, merge
from .terrain import Terrain

PARTS = ("torso", "head", "arm_l", "arm_r", "fore_l", "fore_r", "thigh_l", "thigh_r",
         "shin_l", "shin_r")  # fmt: skip
SPEED = 1.15  # m/s
STRIDE = 1.36  # m, two steps
HIP, SHOULDER, NECK = 0.90, 1.40, 1.47  # m above the sole
THIGH, SHIN, UPPER_ARM = 0.43, 0.42, 0.30  # m


def _torso(build: Builder) -> None:
    rings = [(0.30, -0.36, 1.0), (0.245, -0.10, 0.92), (0.205, 0.12, 0.85), (0.225, 0.36, 0.80),
             (0.20, 0.50, 0.66), (0.085, 0.57, 1.0)]  # fmt: skip
    angle = np.linspace(0.0, 2.0 * np.pi, 11)
    for (r0, y0, d0), (r1, y1, d1) in zip(rings[:-1], rings[1:], strict=True):
        points = []
        for r, y, d in ((r0, y0, d0), (r1, y1, d1)):
            points += [(r * np.sin(t), y, r * d * np.cos(t)) for t in angle]
        n = len(angle)
        k = np.arange(n - 1)[:, None]
        faces = np.concatenate([k + (0, 1, n + 1), k + (0, n + 1, n)])
        normals = np.tile(np.stack([np.sin(angle), 0.15 + 0 * angle, np.cos(angle)], 1), (2, 1))
        build.faces(points, faces, palette.COAT, normals=normals, material=PLAIN)
    build.tube((0, 0.05, 0), (0, 0.10, 0), (0.222, 0.222), palette.BEAM, sides=10, material=PLAIN)
    build.box((0.24, -0.05, -0.02), (0.10, 0.24, 0.28), palette.BEAM, material=PLAIN)  # satchel
    build.tube((0.20, 0.06, 0.12), (-0.13, 0.53, 0.1), (0.018, 0.018), palette.BEAM, sides=4)
    build.tube((0.20, 0.06, -0.15), (-0.13, 0.53, -0.1), (0.018, 0.018), palette.BEAM, sides=4)


def _head(build: Builder) -> None:
    skin, hat = palette.SKIN, palette.HAT
    build.tube((0, -0.02, 0), (0, 0.08, 0), (0.06, 0.058), skin, material=PLAIN)
    build.tube((0, 0.06, 0.01), (0, 0.16, 0.02), (0.075, 0.105), skin, sides=8, material=PLAIN)
    build.tube((0, 0.16, 0.02), (0, 0.24, 0.01), (0.105, 0.10), skin, sides=8, material=PLAIN)
    build.box((0, 0.155, 0.12), (0.03, 0.05, 0.05), skin * 0.95, material=PLAIN)
    build.box((0, 0.08, 0.075), (0.11, 0.07, 0.06), palette.BEAM * 1.3, material=PLAIN)  # beard
    build.tube((0, 0.225, 0), (0, 0.245, 0), (0.235, 0.215), hat, sides=12, caps=True)
    build.tube((0, 0.245, 0), (0, 0.36, -0.01), (0.125, 0.095), hat, sides=10, caps=True)
    band = palette.BEAM * 0.6
    build.tube((0, 0.245, 0), (0, 0.275, 0), (0.129, 0.124), band, sides=10, material=PLAIN)


def _limb(build: Builder, length: float, radii: tuple[float, float], color: NDArray) -> None:
    build.tube((0, 0.03, 0), (0, -length, 0), radii, color, sides=7, material=PLAIN, caps=True)


def meshes() -> list[Mesh]:
    """One mesh a part, origin in its joint, looking along +z."""
    found = []
    for k, name in enumerate(PARTS):
        build = Builder(40 + k)
        build.part = k
        if name == "torso":
            _torso(build)
        elif name == "head":
            _head(build)
        elif name.startswith("arm"):
            _limb(build, UPPER_ARM + 0.02, (0.075, 0.06), palette.COAT * 0.95)
        elif name.startswith("fore"):
            _limb(build, 0.24, (0.058, 0.055), palette.COAT * 0.95)
            build.box((0, -0.29, 0.01), (0.05, 0.11, 0.08), palette.SKIN, material=PLAIN)
        elif name.startswith("thigh"):
            _limb(build, THIGH, (0.10, 0.075), palette.TROUSERS)
        else:
            _limb(build, SHIN - 0.05, (0.072, 0.06), palette.TROUSERS)
            build.tube((0, -0.2, 0), (0, -SHIN + 0.04, 0), (0.078, 0.07), palette.BOOT, sides=7)
            build.box((0, -SHIN + 0.05, 0.05), (0.10, 0.10, 0.27), palette.BOOT, material=PLAIN)
        found.append(build.build(dynamic=True))
    return found


def mesh() -> Mesh:
    """All parts in one mesh."""
    return merge(meshes(), dynamic=True)


class Walk:
    """Where the figure is, and how it stands, at any time."""

    def __init__(self, terrain: Terrain) -> None:
        self.terrain = terrain
        self.loop = layout.smooth_line(layout.FIGURE_LOOP, closed=True, step=16)
        steps = np.linalg.norm(np.diff(self.loop, axis=0), axis=1)
        self.along = np.concatenate([[0.0], np.cumsum(steps)])
        self.length = float(self.along[-1])

    def position(self, t: float) -> tuple[float, float, float, float]:
        """(x, y, z) of the soles and heading about +y (rad; 0 looks along +z) at time t, s."""
        walked = (t * SPEED) % self.length
        x = float(np.interp(walked, self.along, self.loop[:, 0]))
        z = float(np.interp(walked, self.along, self.loop[:, 1]))
        ahead = (walked + 0.7) % self.length
        behind = (walked - 0.7) % self.length
        dx = np.interp(ahead, self.along, self.loop[:, 0])
        dz = np.interp(ahead, self.along, self.loop[:, 1])
        dx -= np.interp(behind, self.along, self.loop[:, 0])
        dz -= np.interp(behind, self.along, self.loop[:, 1])
        return x, float(self.terrain.height(x, z)), z, math.atan2(dx, dz)

    def pose(self, t: float) -> NDArray:
        """(10, 4, 4) transforms of the parts at time t, s."""
        x, y, z, heading = self.position(t)
        phase = 2.0 * math.pi * (t * SPEED % STRIDE) / STRIDE
        swing = math.sin(phase)
        bob = 0.022 * math.cos(2.0 * phase) - 0.012
        root = _turn_y(heading, x, y + bob, z)
        lean = _bend(0.05, 0.0, HIP, 0.0)
        sway = _turn_y(0.09 * swing, 0.0, 0.0, 0.0)
        torso = root @ lean @ sway
        out = np.empty((len(PARTS), 4, 4))
        out[0] = torso
        up = NECK - HIP
        out[1] = torso @ _turn_y(-0.09 * swing, 0.0, up, 0.02) @ _bend(0.03, 0.0, 0.0, 0.0)
        for k, side in enumerate((1.0, -1.0)):
            step = swing * side
            arm = torso @ _bend(0.48 * step, 0.245 * side, SHOULDER - HIP, 0.0)
            out[2 + k] = arm @ _lift(0.10 * side)
            out[4 + k] = out[2 + k] @ _bend(-0.28 - 0.22 * max(-step, 0.0), 0.0, -UPPER_ARM, 0.0)
            leg = phase if side > 0 else phase + math.pi
            thigh = -0.06 - 0.46 * math.sin(leg)
            knee = 0.12 + 0.62 * max(math.cos(leg + 0.35), 0.0) ** 1.5
            out[6 + k] = root @ _bend(thigh, 0.10 * side, HIP, 0.0)
            out[8 + k] = out[6 + k] @ _bend(knee, 0.0, -THIGH, 0.0)
        return out


def _bend(angle: float, x: float, y: float, z: float) -> NDArray:
    """Turn about +x (positive: what hangs down swings back), then move."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1, 0, 0, x], [0, c, -s, y], [0, s, c, z], [0, 0, 0, 1.0]])


def _lift(angle: float) -> NDArray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])


def _turn_y(angle: float, x: float, y: float, z: float) -> NDArray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0, s, x], [0, 1, 0, y], [-s, 0, c, z], [0, 0, 0, 1.0]])
