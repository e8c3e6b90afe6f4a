"""What the shaders of a splash put out for impacts of a test's choosing, by transform feedback."""

from __future__ import annotations

from typing import NamedTuple

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import SplashLook, ViewData
from weather_ecs.gpu.air_block import AIR_FLOW, fill_air, flow_of
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.heightmap import Footprint
from weather_ecs.gpu.impact_list import IMPACT_DTYPE
from weather_ecs.gpu.rain_blocks import RAIN_VIEW, SHELTER
from weather_ecs.gpu.rain_pass import MOTION_UNIT, SHELTER_UNIT
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.splash_pass import SPLASH, fill_splash
from weather_ecs.gpu.splash_texture import BEAD
from weather_ecs.gpu.view_block import fill_view
from weather_ecs.physics.ride import motion_bytes
from weather_ecs.physics.splash import SplashLaw, acceleration

LOOKS = ProgramKey(
    vertex="splash.vert",
    defines=("IMPACT_LIST",),
    varyings=("vs_at", "vs_normal", "vs_color", "vs_form", "vs_throw"),
)
QUADS = ProgramKey(
    vertex="splash.vert",
    geometry="splash.geom",
    defines=("IMPACT_LIST",),
    varyings=("gl_Position", "gs_uv", "gs_layer", "gs_color"),
)
PICTURE = (320, 180)  # pixels
TOP, BOTTOM, HALF, TEXELS = 20.0, -10.0, 16.0, 256  # m, of the map of heights


class Looks(NamedTuple):
    """Outputs of the vertex shader, one row an impact."""

    at: NDArray
    normal: NDArray
    color: NDArray
    form: NDArray  # radius in m, share of the life, 1 on water, seed
    throw: NDArray  # m/s, s, opacity of film and droplets


class Quads(NamedTuple):
    """Quads of the geometry shader (films and crowns), and the beads that are its droplets."""

    corners: NDArray  # (n, 4, 4), clip space
    layer: NDArray  # (n,)
    beads: NDArray  # (m, 3, 4), clip space

    @property
    def ndc(self) -> NDArray:
        return self.corners[..., :3] / self.corners[..., 3:]

    @property
    def droplets(self) -> NDArray:
        """Middles of the droplets, (m, 2): half-way between the two corners off the right one."""
        ndc = self.beads[..., :2] / self.beads[..., 3:]
        right, across, along = ndc[:, 0], ndc[:, 1], ndc[:, 2]
        # The bead fills half of either side.
        return right + 0.25 * (across - right) + 0.25 * (along - right)


def impacts(count: int, **fields: object) -> NDArray:
    """Records of impacts on level ground at the origin; `fields` set what is different."""
    records = np.zeros(count, IMPACT_DTYPE)
    records["normal"] = (0.0, 1.0, 0.0)
    records["diameter"], records["speed"], records["weight"] = 2.0, 6.5, 500.0
    records["seed"] = np.linspace(0.05, 0.95, count)
    for name, value in fields.items():
        records[name] = value
    return records


def law_of(look: SplashLook, view: ViewData) -> SplashLaw:
    return SplashLaw(
        look.size, look.largest, look.duration, look.share, look.droplets, look.droplet_speed,
        look.spread, acceleration(view.frame.wind, look.drift),
    )  # fmt: skip


class SplashCapture:
    """Runs the shaders; the heights are those of `ground(x, z)`."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._shaders = ShaderLoader(ctx)
        self._looks = self._shaders.program(LOOKS)
        self._quads = self._shaders.program(QUADS)
        self._quads["shelter_map"], self._quads["shelter_motion"] = SHELTER_UNIT, MOTION_UNIT
        self._motion = ctx.texture((TEXELS, TEXELS), 4)
        self._motion.filter = moderngl.NEAREST, moderngl.NEAREST
        self.move((0.0, 0.0, 0.0))
        self._blocks = [BlockBuffer(ctx, block) for block in (RAIN_VIEW, SPLASH, SHELTER, AIR_FLOW)]
        self._map = ctx.depth_texture((TEXELS, TEXELS))
        self._map.compare_func = ""
        self._map.filter = moderngl.NEAREST, moderngl.NEAREST
        self.ground()
        # Without a complete framebuffer some drivers write nothing in transform feedback.
        self._color = ctx.renderbuffer((8, 8))
        self._target = ctx.framebuffer([self._color])

    def ground(self, edge: float | None = None, low: float = -1.0) -> None:
        """Level at 0; beyond x = `edge` at `low`."""
        side = (np.arange(TEXELS) + 0.5) / TEXELS * 2.0 * HALF - HALF
        height = np.zeros((TEXELS, TEXELS))
        if edge is not None:
            height[:, side > edge] = low
        self._map.write(((TOP - height) / (TOP - BOTTOM)).astype(np.float32))
        shelter = self._blocks[2]
        place = Footprint((0.0, 0.0), HALF, (0.0, 0.0), BOTTOM, TOP)
        shelter["shelter_matrix"] = place.matrix()
        shelter.data["shelter_size"] = (TEXELS, TOP - BOTTOM, 2.0 * HALF / TEXELS, 0.0)

    def move(self, velocity: tuple[float, float, float]) -> None:
        """All that there is moves so fast, m/s."""
        motion = np.full((TEXELS, TEXELS, 4), 255, np.uint8)
        motion[..., :3] = motion_bytes(np.array(velocity))
        self._motion.write(motion)

    def looks(self, records: NDArray, view: ViewData, look: SplashLook) -> Looks:
        found = self._run(self._looks, records, view, look, 17, len(records))
        return Looks(*np.split(found, [3, 6, 10, 14], axis=1))

    def quads(self, records: NDArray, view: ViewData, look: SplashLook) -> Quads:
        """What is drawn of every impact, in order; a quad is two triangles, a droplet one."""
        found = self._run(self._quads, records, view, look, 11, len(records) * 33 * 3)
        found = found[found[:, 3] != 0.0].reshape(-1, 3, 11)
        bead = found[:, 0, 6] == BEAD
        quads = found[~bead].reshape(-1, 6, 11)[:, [0, 1, 2, 5]]
        return Quads(quads[..., :4], quads[:, 0, 6], found[bead][..., :4])

    def _run(
        self, program: moderngl.Program, records: NDArray, view: ViewData, look: SplashLook,
        width: int, rows: int,
    ) -> NDArray:  # fmt: skip
        fill_view(self._blocks[0], view, (0, 0, *PICTURE))
        fill_splash(self._blocks[1], view, look)
        fill_air(self._blocks[3], flow_of(view))
        for block in self._blocks:
            block.upload()
            block.bind()
        self._map.use(SHELTER_UNIT)
        self._motion.use(MOTION_UNIT)
        source = self._ctx.buffer(records)
        out = self._ctx.buffer(np.zeros((rows, width), np.float32))
        array = self._ctx.vertex_array(
            program, [(source, "4f 4f 4f", "in_hit", "in_surface", "in_fall")]
        )
        self._target.use()
        array.transform(out, moderngl.POINTS, vertices=len(records))
        found = np.frombuffer(out.read(), np.float32).reshape(rows, width).copy()
        for thing in (array, out, source):
            thing.release()
        return found

    def release(self) -> None:
        things = (self._target, self._color, self._motion, self._map, *self._blocks, self._shaders)
        for thing in things:
            thing.release()
