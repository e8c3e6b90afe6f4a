"""A game's own programs, moderngl's or not, read the weather through the public includes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.targets import bound_target
from tests.views import look_from, perspective
from weather_ecs import InvalidValueError, Weather, glsl
from weather_ecs.components import Air, Fog, Occluder, RainArea, RippleSurface, SnowFlakes
from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.gl import GL
from weather_ecs.public_glsl import PUBLIC

pytestmark = pytest.mark.usefixtures("world")

HEAD = "#version 330\n"
CORNER = (
    "void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0,"
    " 0.0, 1.0); }"
)
# All includes in one shader, of the ground in front of the observer.
READ = """
out vec4 got;
void main()
{
    vec3 place = vec3(gl_FragCoord.x * 0.5 - 4.0, 0.0, -gl_FragCoord.y * 0.5), up = vec3(0, 1, 0);
    vec2 slope = ripple_slope(place.xz, 0.0);
    got.x = weather_wetness(place, up) + 100.0 * weather_snow(place, up);
    got.y = weather_rained_on(place) + 2.0 * weather_sunlight(place);
    got.z = weather_fog(weather_light(up, 1.0), 50.0).r + weather_sky(vec3(0, 1, 0)).b;
    got.w = 100.0 * (abs(slope.x) + abs(slope.y));
}
"""


class Pyglets:
    """Knows of a program what pyglet's ShaderProgram tells."""

    def __init__(self, program: moderngl.Program) -> None:
        self.id = program.glo


def no_wrapping(program: moderngl.Program) -> Any:
    return program


WRAPPINGS: dict[str, Callable[[moderngl.Program], Any]] = {
    "name": lambda program: program.glo,
    "pyglet": Pyglets,
    "arcade": lambda program: SimpleNamespace(glo=program.glo),
}


@pytest.fixture
def pond() -> RippleSurface:
    return RippleSurface(center=(0, 0, -4), size=(6, 6), draw=False)


@pytest.fixture
def weather(ctx: moderngl.Context, pond: RippleSurface) -> Iterator[Weather]:
    """Sleet on a pond and on a roof over part of it."""
    with bound_target(ctx, (64, 36)), Weather(context=ctx, quality="low") as made:
        roof = placed((2.0, 2.5, -4.0), (1.5, 0.1, 2.0))
        parts = (RainArea((0, 0), (60, 60), 60.0), Air(1.5, 0.9), Fog(300.0), SnowFlakes())
        for part in (*parts, Occluder(CORNERS, TRIANGLES, roof), pond):
            esper.create_entity(part)
        for _ in range(40):
            esper.process(1 / 20)
            made.draw(look_from((0.0, 1.7, 0.0), 0.0), perspective())
        yield made


Read = Callable[[Callable[[moderngl.Program], Any]], np.ndarray]


@pytest.fixture
def read(ctx: moderngl.Context, weather: Weather, pond: RippleSurface) -> Iterator[Read]:
    """What the shader reads of the weather when it is used under another guise, (16, 16, 4)."""
    made: list[Any] = []
    texture = ctx.texture((16, 16), 4, dtype="f4")
    target = ctx.framebuffer([texture])

    def values(wrap: Callable[[moderngl.Program], Any]) -> np.ndarray:
        source = HEAD + "".join(map(glsl, PUBLIC)) + READ
        program = ctx.program(vertex_shader=HEAD + CORNER, fragment_shader=source)
        array = ctx.vertex_array(program, [])
        made.extend((array, program))
        ripples = weather.ripples(pond)
        assert ripples is not None
        maps = weather.wetness(), weather.heightmap(), weather.sky(), weather.cloud_shadow()
        weather.air().use(wrap(program))
        for thing in (*maps, ripples):
            thing.use(wrap(program))
        target.use()
        array.render(moderngl.TRIANGLES, vertices=3)
        return np.frombuffer(texture.read(), np.float32).reshape(16, 16, 4).copy()

    yield values
    for thing in (*made, target, texture):
        thing.release()


@pytest.mark.parametrize("guise", WRAPPINGS)
def test_programs_of_other_libraries_read_the_same(
    read: Read, ctx: moderngl.Context, gl: GL, guise: str
) -> None:
    expected = read(no_wrapping)
    assert (np.ptp(expected[..., (0, 1, 3)], axis=(0, 1)) > 0.01).all()  # each map has been read
    assert expected[..., 2].min() > 0.1
    other = ctx.program(vertex_shader=HEAD + CORNER)
    gl.glUseProgram(other.glo)
    in_use: list[int] = []

    def wrap(program: moderngl.Program) -> Any:
        in_use.append(gl.get_int(e.CURRENT_PROGRAM))
        return WRAPPINGS[guise](program)

    assert np.array_equal(read(wrap), expected)
    assert set(in_use) == {other.glo}  # before each of them, and so after those before it
    gl.glUseProgram(0)
    other.release()
    assert gl.error() == 0


def test_what_a_shader_does_not_use_is_left_out(
    weather: Weather, ctx: moderngl.Context, gl: GL
) -> None:
    program = ctx.program(vertex_shader=HEAD + CORNER)
    for thing in (weather.air(), weather.wetness(), weather.sky(), weather.heightmap()):
        thing.use(program.glo)
    assert gl.error() == 0
    program.release()


@pytest.mark.parametrize("program", [None, True, 0, -1, 1 << 40, 99999, "ground", object()])
def test_what_is_no_program_is_refused(weather: Weather, gl: GL, program: object) -> None:
    for thing in (weather.air(), weather.wetness()):
        with pytest.raises(InvalidValueError, match=r"^program: got .*ShaderProgram"):
            thing.use(program)
    assert gl.error() == 0
