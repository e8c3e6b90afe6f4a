"""Lightning channels: pieces that face the camera, and the glow of the air round their trunks."""

from __future__ import annotations

import math
from typing import NamedTuple

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics.lightning_bolt import bolt
from weather_ecs.physics.optics import falling_extinction
from weather_ecs.physics.rain_field import RainField

DRAW = ProgramKey(vertex="bolt.vert", fragment="bolt.frag")
MOST = 8  # channels in a picture, the brightest
HEAT = 12.0  # light of the channel itself, over that which it sheds nearby
AIR = 0.9  # of the glow
GLOWING = 8  # pieces of the trunk that one of the glow stands for
GLOW = 420.0  # m, width of the glow
LEAST, MOST_WIDE = 0.7, 12.0  # pixels, half widths of a channel
LEAST_GLOW, MOST_GLOW = 14.0, 160.0
FAINTEST = 1e-3
SOFT = 200.0  # m below the clouds, in which what shines through rain sets in
# Of what large drops take from a beam half is bent by so little that it stays in it (van de Hulst
# 1957), which counts for what is this bright.
BEAM = 0.5
SAMPLES = 12  # of the rain on the way to it

Floats = NDArray[np.float32]


class Rain(NamedTuple):
    """What falls between a camera and lightning."""

    depth: float  # optical
    top: float  # m, world height: above are the clouds


NO_RAIN = Rain(0.0, math.inf)


class BoltPass:
    """Draws the strikes of a view; without any it does nothing."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._ctx = ctx
        self._program = shaders.program(DRAW)
        self._room = 1024
        self._make()

    def _make(self) -> None:
        self._buffer = self._ctx.buffer(reserve=self._room * 32, dynamic=True)
        content = (self._buffer, "4f 4f/i", "in_begin", "in_end")
        self._array = self._ctx.vertex_array(self._program, [content])

    def draws(self, view: ViewData) -> bool:
        """Whether there is anything to draw."""
        strikes = view.frame.strikes
        return len(strikes) > 0 and bool((strikes["light"] > FAINTEST).any())

    def distance(self, view: ViewData) -> float:
        """m from the camera to the middle of the brightest channel."""
        rows = view.frame.strikes
        row = rows[int(np.argmax(rows["light"]))]
        middle = 0.5 * (row["origin"] + row["target"])
        return float(np.linalg.norm(middle - np.array(view.position)))

    def rain(self, view: ViewData) -> Rain | None:
        """What falls before the brightest channel; None where that hides nothing, or all."""
        frame = view.frame
        if not len(frame.areas):
            return None
        row = frame.strikes[int(np.argmax(frame.strikes["light"]))]
        eye = np.array(view.position)
        end = np.array([row["target"][0], eye[1], row["target"][2]])
        field = RainField(frame.areas, frame.fronts)
        lost = 0.0
        for share in (np.arange(SAMPLES) + 0.5) / SAMPLES:
            rate = field.rate(*(eye + share * (end - eye)).tolist())
            lost += falling_extinction(
                rate * (1.0 - frame.air.snow_share), rate * frame.air.snow_share
            )
        depth = lost / SAMPLES * float(np.linalg.norm(end - eye))
        if depth < 0.02 or HEAT * float(row["light"]) * math.exp(-BEAM * depth) < 0.02:
            return None
        return Rain(depth, float(frame.areas["ceiling"].max()))

    def draw(self, view: ViewData, rain: Rain = NO_RAIN) -> None:
        """The depth test on, depth writes off; blending on and for straight colours afterwards.

        rain: before it and drawn already; a channel that is bright enough shines through.
        """
        look = view.frame.lightning
        rotation = np.eye(4)
        rotation[:3, :3] = view.view[:3, :3]
        matrix = (view.projection @ rotation).astype(np.float32)
        self._program["bolt_matrix"].write(matrix.T.tobytes())
        hot, glowing = channels(view)
        left, top = math.exp(-BEAM * rain.depth), rain.top - view.position[1]
        if math.isfinite(top):
            hot, glowing = (_below(pieces, top) for pieces in (hot, glowing))
        ctx = self._ctx
        if len(glowing) and look.glow > 0.0:
            ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_COLOR
            shape = (GLOW, LEAST_GLOW, MOST_GLOW, 1.0)
            self._render(glowing, (*look.color, AIR * look.glow * left), shape)
        if len(hot):
            ctx.blend_equation = moderngl.MAX, moderngl.MAX
            self._render(hot, (*look.color, HEAT * left), (look.width, LEAST, MOST_WIDE, 0.0))
            ctx.blend_equation = moderngl.FUNC_ADD, moderngl.FUNC_ADD
        ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA

    def _render(self, pieces: Floats, color: tuple[float, ...], shape: tuple[float, ...]) -> None:
        if len(pieces) > self._room:
            self.release()
            while self._room < len(pieces):
                self._room *= 2
            self._make()
        self._program["bolt_color"] = color
        self._program["bolt_shape"] = shape
        self._buffer.orphan()
        self._buffer.write(pieces.tobytes())
        self._array.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=len(pieces))

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self._array.release()
        self._buffer.release()


def _below(pieces: Floats, top: float) -> Floats:
    """What is under the clouds, without an edge at their base."""
    for light in (3, 7):
        pieces[:, light] *= np.clip((top - pieces[:, light - 2]) / SOFT, 0.0, 1.0)
    return pieces[pieces[:, 3] > 0.0]


def channels(view: ViewData) -> tuple[Floats, Floats]:
    """(n, 8) pieces of the channels, and of the glow: beginning and end from the camera, lights."""
    rows, look = view.frame.strikes, view.frame.lightning
    rows = rows[rows["light"] > FAINTEST]
    rows = rows[np.argsort(-rows["light"], kind="stable")[:MOST]]
    hot, glowing = [np.zeros((0, 8), np.float32)], [np.zeros((0, 8), np.float32)]
    eye = np.array(view.position)
    for row in rows:
        origin, target = (tuple(row[name].tolist()) for name in ("origin", "target"))
        ground, leader = bool(row["ground"]), float(row["leader"])
        shape = bolt(origin, target, int(row["word"]), ground=ground, branches=look.branches)
        shown = shape.along <= leader
        if row["again"]:
            shown &= shape.order == 0
        light = float(row["light"])
        pieces = np.zeros((int(shown.sum()), 8), np.float32)
        pieces[:, :3], pieces[:, 4:7] = shape.begin[shown] - eye, shape.end[shown] - eye
        pieces[:, 3], pieces[:, 7] = light * shape.light[shown, 0], light * shape.light[shown, 1]
        hot.append(pieces)
        coarse = shape.trunk[::GLOWING][: 1 + int(leader * ((len(shape.trunk) - 1) // GLOWING))]
        glow = np.full((len(coarse) - 1, 8), light, np.float32)
        glow[:, :3], glow[:, 4:7] = coarse[:-1] - eye, coarse[1:] - eye
        glowing.append(glow)
    return np.concatenate(hot), np.concatenate(glowing)
