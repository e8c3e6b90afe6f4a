"""Lightning channels: pieces that face the camera, and the glow of the air round their trunks."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics.lightning_bolt import bolt

DRAW = ProgramKey(vertex="bolt.vert", fragment="bolt.frag")
MOST = 8  # channels in a picture, the brightest
HEAT = 12.0  # light of the channel itself, over that which it sheds nearby
AIR = 0.9  # of the glow
GLOWING = 8  # pieces of the trunk that one of the glow stands for
GLOW = 420.0  # m, width of the glow
LEAST, MOST_WIDE = 0.7, 12.0  # pixels, half widths of a channel
LEAST_GLOW, MOST_GLOW = 14.0, 160.0
FAINTEST = 1e-3

Floats = NDArray[np.float32]


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
        return bool((view.frame.strikes["light"] > FAINTEST).any())

    def distance(self, view: ViewData) -> float:
        """m from the camera to the middle of the brightest channel."""
        rows = view.frame.strikes
        row = rows[int(np.argmax(rows["light"]))]
        middle = 0.5 * (row["origin"] + row["target"])
        return float(np.linalg.norm(middle - np.array(view.position)))

    def draw(self, view: ViewData) -> None:
        """The depth test on, depth writes off; blending on. Blending is left as it was found."""
        look = view.frame.lightning
        rotation = np.eye(4)
        rotation[:3, :3] = view.view[:3, :3]
        matrix = (view.projection @ rotation).astype(np.float32)
        self._program["bolt_matrix"].write(matrix.T.tobytes())
        hot, glowing = channels(view)
        ctx = self._ctx
        if len(glowing) and look.glow > 0.0:
            ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_COLOR
            shape = (GLOW, LEAST_GLOW, MOST_GLOW, 1.0)
            self._render(glowing, (*look.color, AIR * look.glow), shape)
        if len(hot):
            ctx.blend_equation = moderngl.MAX
            self._render(hot, (*look.color, HEAT), (look.width, LEAST, MOST_WIDE, 0.0))
            ctx.blend_equation = moderngl.FUNC_ADD
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
