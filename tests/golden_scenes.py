"""The scenes of the golden pictures: a ground, a shed, and rain."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import esper
import moderngl
import numpy as np

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.views import look_from, perspective
from tests.weather_pictures import stage
from weather_ecs.components import Occluder, PointLight, RainArea, Sun, Wind

SIZE = (320, 180)
FPS = 30.0
NORTH = math.pi / 2  # the heading of -z

SHED = (  # centre, half sizes, colour
    ((0.0, -0.5, 0.0), (300.0, 0.5, 300.0), (0.23, 0.27, 0.17)),
    ((6.0, 3.1, -2.0), (3.0, 0.1, 3.0), (0.30, 0.20, 0.16)),
    ((8.8, 1.5, -2.0), (0.1, 1.5, 2.8), (0.40, 0.34, 0.28)),
    ((3.2, 1.5, -4.7), (0.1, 1.5, 0.1), (0.40, 0.34, 0.28)),
    ((3.2, 1.5, 0.7), (0.1, 1.5, 0.1), (0.40, 0.34, 0.28)),
    ((14.0, 2.0, 6.0), (0.12, 2.0, 0.12), (0.15, 0.15, 0.16)),
)
TOP, HORIZON = (0.36, 0.42, 0.50), (0.62, 0.66, 0.69)
DARK_TOP, DARK_HORIZON = (0.05, 0.06, 0.08), (0.09, 0.10, 0.12)
NIGHT = Sun((0, -1, 0), (0, 0, 0), (0.004, 0.005, 0.007), (0.008, 0.009, 0.011), (0, 0, 0))


@dataclass(frozen=True)
class Scene:
    """What there is, and the way of the camera through it in a second and a half."""

    make: Callable[[], Any]
    position: Callable[[float], tuple[float, float, float]]  # by s
    heading: float = 0.0
    pitch: float = 0.0
    dark: bool = False
    frames: int = field(default=45)


def rain(rate: float = 25.0, **changes: Any) -> RainArea:
    return RainArea(**{"center": (0, 0), "radii": (90, 60), "rain_rate": rate, **changes})


def standing(x: float, y: float, z: float) -> Callable[[float], tuple[float, float, float]]:
    return lambda t: (x, y, z)


SCENES = {
    "near": Scene(
        lambda: esper.create_entity(rain(), Wind((0.3, 1.0), 3.0)), standing(-6.0, 1.7, 2.0)
    ),
    "far": Scene(
        lambda: esper.create_entity(rain(40.0, center=(150, 0), radii=(70, 50), ceiling=160.0)),
        standing(-60.0, 1.7, 0.0),
        pitch=0.12,
    ),
    "edge": Scene(
        lambda: esper.create_entity(rain(center=(61, 30), radii=(80, 50), heading=0.6)),
        lambda t: (-3.0 + 1.4 * t, 1.7, 4.0),
        heading=0.25,
    ),
    "roof": Scene(
        lambda: esper.create_entity(rain(50.0), Wind((0.0, 1.0), 2.0)),
        standing(7.5, 1.7, -2.0),
        heading=math.pi - 0.5,
    ),
    "up": Scene(
        lambda: esper.create_entity(rain(40.0)), standing(-6.0, 1.7, 2.0), heading=0.4, pitch=1.1
    ),
    "cloudburst": Scene(
        lambda: (
            esper.create_entity(rain(110.0), Wind((0.2, -1.0), 9.0), NIGHT),
            esper.create_entity(PointLight((14.0, 4.1, 6.0), (14.0, 10.0, 5.0), 14.0)),
        ),
        lambda t: (2.0 + 3.0 * t, 1.7, 4.5),
        heading=-0.15,
        pitch=0.08,
        dark=True,
    ),
}


class Scenery:
    """Paints sky, ground and shed, with their depth."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self.program = ctx.program(
            vertex_shader="""#version 330 core
            uniform mat4 matrix; uniform vec3 color; in vec3 place; out vec3 shade;
            void main() {
                gl_Position = matrix * vec4(place, 1.0);
                shade = color;
            }""",
            fragment_shader="""#version 330 core
            in vec3 shade; out vec4 pixel;
            void main() { pixel = vec4(shade, 1.0); }""",
        )
        self.sky = ctx.program(
            vertex_shader="""#version 330 core
            void main() {
                vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
                gl_Position = vec4(p, 1.0, 1.0);
            }""",
            fragment_shader="""#version 330 core
            uniform vec3 top; uniform vec3 horizon; uniform vec2 span; uniform float rows;
            out vec4 pixel;
            void main() {
                float up = mix(span.x, span.y, gl_FragCoord.y / rows);
                pixel = vec4(mix(horizon, top, clamp(up, 0.0, 1.0)), 1.0);
            }""",
        )
        self.vertices, self.indices = ctx.buffer(CORNERS), ctx.buffer(TRIANGLES)
        self.box = ctx.vertex_array(
            self.program, [(self.vertices, "3f", "place")], index_buffer=self.indices
        )
        self.everywhere = ctx.vertex_array(self.sky, [])

    def paint(self, scene: Scene, view: np.ndarray, projection: np.ndarray) -> None:
        """Into the bound framebuffer; leaves the depth test on, as games do."""
        top, horizon = (DARK_TOP, DARK_HORIZON) if scene.dark else (TOP, HORIZON)
        self.sky["top"], self.sky["horizon"] = top, horizon
        self.sky["span"] = (math.sin(scene.pitch - 0.5), math.sin(scene.pitch + 0.5))
        self.sky["rows"] = float(SIZE[1])
        self.ctx.enable_only(moderngl.NOTHING)
        self.everywhere.render(moderngl.TRIANGLES, vertices=3)
        self.ctx.enable_only(moderngl.DEPTH_TEST)
        for center, half, color in SHED:
            matrix = projection @ view @ placed(center, half)
            self.program["matrix"].write(matrix.T.astype("f4").tobytes())
            self.program["color"] = tuple(c * (0.25 if scene.dark else 1.0) for c in color)
            self.box.render(moderngl.TRIANGLES)

    def release(self) -> None:
        for thing in (self.everywhere, self.box, self.indices, self.vertices, self.sky,
                      self.program):  # fmt: skip
            thing.release()


def picture(ctx: moderngl.Context, name: str, backend: str = "auto") -> np.ndarray:
    """The last frame of a scene, (height, width, 3) uint8, rows from above."""
    scene = SCENES[name]
    with stage(ctx, SIZE, quality="medium", backend=backend, seed=11) as made:
        scenery = Scenery(ctx)
        scene.make()
        for center, half, _ in SHED:
            esper.create_entity(Occluder(CORNERS, TRIANGLES, placed(center, half)))
        for k in range(scene.frames):
            view = look_from(scene.position(k / FPS), scene.heading, scene.pitch)
            projection = perspective()
            esper.process(1.0 / FPS)
            made.clear()
            scenery.paint(scene, view, projection)
            made.weather.draw(view, projection)
        scenery.release()
        return made.picture()[::-1]
