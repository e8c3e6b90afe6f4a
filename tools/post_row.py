"""Black posts every 50 m in fog, and how far one sees them in the picture."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import esper
import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.camera import Pose, projection_matrix, view_matrix
from demo_game.headless import make_context
from tools.stills import save_sheet
from weather_ecs import Weather, glsl
from weather_ecs.components import Fog

SIZE = (960, 240)  # px
FIELD = math.radians(40.0)  # across
EYE = 4.0  # m
APART, LAST = 50.0, 1500.0  # m
WIDE = 0.008  # of a post, rad: as wide in the picture near and far
VISIBILITIES = (100.0, 300.0, 1000.0)  # m
LEAST = 0.02  # contrast at which a thing is lost in fog (Koschmieder 1924)
POST = """#version 330 core
uniform mat4 matrix; uniform float apart; uniform float wide; uniform float count;
uniform float eye;
out vec3 place; flat out vec3 own;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    float d = apart * float(gl_InstanceID);
    float bearing = (float(gl_InstanceID) - 0.5) / count * 0.62 - 0.31;
    vec3 across = vec3(cos(bearing), 0.0, sin(bearing));
    vec3 foot = d * vec3(sin(bearing), 0.0, -cos(bearing));
    place = foot + wide * d * (corner.x - 0.5) * across;
    place.y = corner.y * (eye + 0.045 * d);
    own = vec3(0.0);
    if (gl_InstanceID == 0) {  // the ground
        place = vec3((corner.x - 0.5) * 9000.0, 0.0, -corner.y * 6000.0);
        own = vec3(0.09, 0.10, 0.06);
    }
    gl_Position = matrix * vec4(place, 1.0);
}"""
SHOWN = """#version 330
uniform float eye; in vec3 place; flat in vec3 own; out vec4 color;
void main() { color = vec4(weather_fog(own, distance(place, vec3(0.0, eye, 0.0))), 1.0); }"""


def posts(out: Path) -> None:
    """A row at each visibility, with how far off the last post is that is seen in the picture."""
    context = make_context()
    kept = context.framebuffer([context.texture(SIZE, 4, dtype="f4")], context.depth_texture(SIZE))
    head, body = SHOWN.split("\n", 1)
    source = f"{head}\n{glsl('weather.glsl')}\n{body}"
    program: Any = context.program(vertex_shader=POST, fragment_shader=source)
    array = context.vertex_array(program, [])
    pictures, texts = [], []
    for visibility in VISIBILITIES:
        esper.switch_world("posts")
        esper.clear_database()
        weather = Weather(context=context, seed=4)
        esper.create_entity(Fog(visibility))
        esper.process(0.1)
        light = _picture(weather, kept, program, array)
        weather.close()
        seen = seen_to(light)
        pictures.append((255.0 * np.clip(light, 0.0, 1.0) ** (1.0 / 2.2)).astype(np.uint8))
        texts.append(
            f"visibility {visibility:.0f} m: posts every {APART:.0f} m, "
            f"contrast 2 % at {seen:.0f} m in the picture"
        )
    save_sheet(out, pictures, texts, columns=1, width=720)


def _picture(weather: Weather, kept: Any, program: Any, array: Any) -> NDArray[np.float32]:
    """Linear light, (height, width, 3), top row first."""
    air = weather.air(position=(0.0, EYE, 0.0))
    view = view_matrix(Pose((0.0, EYE, 0.0), 0.0, 0.0))
    projection = projection_matrix(FIELD, SIZE[0] / SIZE[1], 0.5, 5000.0)
    kept.use()
    kept.clear(*air.color, 1.0)
    kept.ctx.enable_only(moderngl.DEPTH_TEST)
    program["matrix"].write((projection @ view).astype("f4").T.tobytes())
    program["apart"], program["wide"], program["eye"] = APART, WIDE, EYE
    count = int(LAST / APART)
    program["count"] = count
    air.use(program)
    array.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=count + 1)
    raw = np.frombuffer(kept.read(components=3, dtype="f4"), np.float32)
    return raw.reshape(SIZE[1], SIZE[0], 3)[::-1]


def seen_to(light: NDArray[np.float32]) -> float:
    """Metres to where a post keeps the least contrast against the fog beside it; between two
    posts by the logarithm."""
    count = int(LAST / APART)
    contrasts, aways = [], []
    row = light[SIZE[1] // 2 - 5].mean(axis=1)
    behind = float(light[0].mean())
    for k in range(count):
        contrasts.append(abs(1.0 - float(row[column(k)]) / behind))
        aways.append(APART * (k + 1))
    below = next((k for k, it in enumerate(contrasts) if it < LEAST), count - 1)
    if below == 0:
        return aways[0]
    a, b = (math.log(max(contrasts[k], 1e-9)) for k in (below - 1, below))
    return aways[below - 1] + APART * (a - math.log(LEAST)) / (a - b)


def column(k: int) -> int:
    """Pixel from the left at which the post of a number stands, the nearest being 0."""
    bearing = (k + 0.5) / int(LAST / APART) * 0.62 - 0.31
    return int(0.5 * SIZE[0] * (1.0 + math.tan(bearing) / math.tan(0.5 * FIELD)))
