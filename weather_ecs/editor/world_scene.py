"""`WorldScene`: the land and the weather over it, drawn from a player's eye."""

from __future__ import annotations

import math
from importlib import resources

import esper
import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs import glsl
from weather_ecs.components import Occluder
from weather_ecs.editor import world_land
from weather_ecs.editor.inside import in_world
from weather_ecs.editor.simulation import Simulation
from weather_ecs.editor.world_camera import WorldCamera

REACH = 60.0  # m that the eye may go from the middle of the ground's rings
_LAYOUT = ("3f4 3f4 4f4", "in_place", "in_normal", "in_color")
_INCLUDE = '#include "'
LAND, LAND_TEXELS = 24_000.0, 2048  # m and texels of the side of the painted map, as in world.frag
_LAND_UNIT, _GRAIN_UNIT = 6, 7


def shader(name: str) -> str:
    """The text of one of the editor's shaders, the package's public pieces pasted in."""
    folder = resources.files("weather_ecs.editor") / "shaders"
    lines = []
    for line in (folder / name).read_text(encoding="utf-8").splitlines():
        if line.startswith(_INCLUDE):
            line = glsl(line.removeprefix(_INCLUDE).rstrip('"'))
        lines.append(line)
    return "\n".join(lines)


class WorldScene:
    """What there is to see of a simulation; draws into whatever framebuffer is bound."""

    def __init__(self, gl: moderngl.Context, simulation: Simulation) -> None:
        self._gl, self._simulation = gl, simulation
        self._program = gl.program(shader("world.vert"), shader("world.frag"))
        self._backdrop = gl.program(shader("backdrop.vert"), shader("backdrop.frag"))
        self._plain = gl.vertex_array(self._backdrop, [])
        self._maps = (self._painted_land(), _grain(gl))
        self._program["land_map"], self._program["grain_map"] = _LAND_UNIT, _GRAIN_UNIT
        self._middle = (math.inf, math.inf)
        self._ground: tuple[moderngl.VertexArray, moderngl.Buffer, moderngl.Buffer] | None = None
        things = world_land.things()
        self._things = self._array(things)
        with in_world(simulation.world):
            places = things.vertices["place"]
            esper.create_entity(Occluder(places, things.indices))
            self._patch = esper.create_entity()

    def draw(self, camera: WorldCamera, aspect: float) -> None:
        """Land, sky, clouds, rain: the picture of a moment."""
        eye = camera.eye()
        self._follow(float(eye[0]), float(eye[2]))
        weather, gl = self._simulation.weather, self._gl
        turn, projection = camera.turn_matrix(), camera.projection(aspect)
        gl.enable_only(moderngl.DEPTH_TEST)
        gl.depth_func = "<"
        gl.clear(0.5, 0.55, 0.6, 1.0)
        air, sky = weather.air(position=tuple(eye.tolist())), weather.sky()
        if self._simulation.frame.atmosphere is None:
            self._draw_backdrop(np.linalg.inv(projection @ turn))
        self._maps[0].use(_LAND_UNIT)
        self._maps[1].use(_GRAIN_UNIT)
        for user in (air, sky, weather.cloud_shadow(), weather.wetness()):
            user.use(self._program)
        _set(self._program, "to_clip", _columns(projection @ turn))
        _set(self._program, "eye", np.float32(eye).tobytes())
        assert self._ground is not None, "the ground has been made"
        self._ground[0].render()
        self._things[0].render()
        weather.draw(camera.view(), projection)

    def release(self) -> None:
        """Give everything back."""
        for group in (self._ground, self._things):
            for part in group or ():
                part.release()
        for each in (*self._maps, self._plain, self._program, self._backdrop):
            each.release()
        self._ground = None

    def _draw_backdrop(self, from_clip: NDArray) -> None:
        weather = self._simulation.weather
        weather.air().use(self._backdrop)
        weather.sky().use(self._backdrop)
        _set(self._backdrop, "from_clip", _columns(from_clip))
        self._gl.disable(moderngl.DEPTH_TEST)
        self._plain.render(vertices=3)
        self._gl.enable(moderngl.DEPTH_TEST)

    def _painted_land(self) -> moderngl.Texture:
        """Fields and woods, painted once; leaves nothing bound."""
        gl = self._gl
        texture = gl.texture((LAND_TEXELS, LAND_TEXELS), 3)
        framebuffer = gl.framebuffer([texture])
        program = gl.program(shader("backdrop.vert"), shader("land.frag"))
        plain = gl.vertex_array(program, [])
        _set(program, "from_clip", _columns(np.diag((0.5 * LAND, 0.5 * LAND, 0.0, 1.0))))
        framebuffer.use()
        gl.enable_only(moderngl.NOTHING)
        plain.render(vertices=3)
        texture.build_mipmaps()
        texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
        for each in (plain, program, framebuffer):
            each.release()
        return texture

    def _follow(self, x: float, z: float) -> None:
        """Keep the fine middle of the ground, on which the rain falls, under the eye."""
        if math.hypot(x - self._middle[0], z - self._middle[1]) <= REACH:
            return
        self._middle = (x, z)
        mesh = world_land.ground(x, z)
        if self._ground is not None:
            self._ground[1].write(mesh.vertices.tobytes())
        else:
            self._ground = self._array(mesh)
        patch = world_land.patch_of(mesh)
        with in_world(self._simulation.world):
            esper.add_component(self._patch, Occluder(patch.vertices["place"], patch.indices))

    def _array(
        self, mesh: world_land.Mesh
    ) -> tuple[moderngl.VertexArray, moderngl.Buffer, moderngl.Buffer]:
        vertices = self._gl.buffer(mesh.vertices.tobytes())
        indices = self._gl.buffer(mesh.indices.astype("u4").tobytes())
        content = [(vertices, *_LAYOUT)]
        return self._gl.vertex_array(self._program, content, indices), vertices, indices


def _grain(gl: moderngl.Context) -> moderngl.Texture:
    """Noise of three scales that repeats without a seam."""
    size, rng = 256, np.random.default_rng(3)
    far = np.minimum(np.arange(size), size - np.arange(size))
    wave = np.hypot(far[:, None], far)
    channels = []
    for middle in (70.0, 24.0, 8.0):  # waves in the texture's side
        band = np.exp(-(((wave - middle) / (0.6 * middle)) ** 2))
        noise = np.fft.ifft2(np.fft.fft2(rng.standard_normal((size, size))) * band).real
        channels.append(np.clip(0.5 + 0.2 * noise / noise.std(), 0.0, 1.0))
    data = (np.stack(channels, -1) * 255.0).astype(np.uint8)
    texture = gl.texture((size, size), 3, data.tobytes())
    texture.build_mipmaps()
    texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
    return texture


def _columns(matrix: NDArray) -> bytes:
    return np.ascontiguousarray(matrix.T, np.float32).tobytes()


def _set(program: moderngl.Program, name: str, value: bytes) -> None:
    if name in program:
        program[name].write(value)  # type: ignore[union-attr]
