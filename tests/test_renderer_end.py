"""What the renderer gives back, and the area's edge in its shader."""

from __future__ import annotations

import gc
import math
from collections.abc import Callable, Iterator
from importlib import resources
from typing import Any

import esper
import moderngl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.boxes import CORNERS, TRIANGLES, box, placed
from tests.gl_names import living
from tests.rain_frames import area, camera, frame, quality
from tests.renderer_scene import far, near
from tests.views import look_from, perspective
from tests.weather_pictures import Stage, stage
from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import (
    Observer,
    Occluder,
    PointLight,
    RippleSurface,
    SplashEmitter,
    Wind,
)
from weather_ecs.errors import ContextError
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.renderer import Renderer
from weather_ecs.physics.ellipse import edge_factor
from weather_ecs.systems import WeatherProcessor
from weather_ecs.systems.rain_view import RainView


@pytest.fixture
def made(ctx: moderngl.Context) -> Iterator[Stage]:
    with stage(ctx) as it:
        yield it


# The end


def test_close_gives_everything_back(ctx: moderngl.Context, gl: GL, backend: str) -> None:
    before = living(gl)
    with stage(ctx, backend=backend, quality="medium") as made:
        esper.create_entity(near(), Occluder(CORNERS, TRIANGLES, placed((3, 4, 0), (2, 1, 2))))
        esper.create_entity(far())
        made.play(3)
        made.draw(observer=Observer())
        assert sum(map(len, living(gl).values())) > sum(map(len, before.values())) + 20
        made.weather.close()
        made.weather.close()
    assert living(gl) == before


def drawn_in(context: moderngl.Context) -> tuple[Weather, list[Any]]:
    """A weather that has drawn into a context, and what it has drawn into."""
    target = context.simple_framebuffer((16, 9))
    target.use()
    weather = Weather(context=context, quality="low")
    esper.create_entity(near())
    esper.process(0.1)
    weather.draw(look_from((0.0, 1.7, 0.0), 0.0), perspective())
    return weather, [target, *target.color_attachments, target.depth_attachment]


def test_close_in_another_context_may_be_tried_again(
    ctx: moderngl.Context, gl: GL, world: str
) -> None:
    before = living(gl)
    weather, things = drawn_in(ctx)
    other = moderngl.create_context(standalone=True, backend="egl")
    with other, pytest.raises(ContextError, match="not current"):
        weather.close()
    assert esper.get_processor(WeatherProcessor) is None
    other.release()
    ctx.__enter__()
    weather.close()
    weather.close()
    for thing in things:
        thing.release()
    assert living(gl) == before


def test_a_context_that_was_released_first(ctx: moderngl.Context, world: str) -> None:
    own = moderngl.create_context(standalone=True, backend="egl")
    try:
        weather, _ = drawn_in(own)
        own.release()
        with pytest.raises(ContextError, match="released"):
            weather.draw(look_from((0.0, 1.7, 0.0), 0.0), perspective())
        weather.close()
        weather.close()
        assert esper.get_processor(WeatherProcessor) is None
    finally:
        ctx.__enter__()


def test_what_a_game_holds_outlives_another_seed(made: Stage, gl: GL) -> None:
    """A client that takes over its server's weather goes on with its maps."""
    with fresh_world(), Weather(seed=77) as server:
        esper.create_entity(near())
        others = server.snapshot()
    esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((0, -1, 0), (90, 1, 90))))
    weather = made.weather
    made.play(2)
    held = [weather.wetness(), weather.heightmap(), weather.sky(), weather.air()]
    program = made.ctx.program(vertex_shader="#version 330\nvoid main() {gl_Position = vec4(0);}")
    weather.restore(others)
    assert made.rain(made.play(2)).mean() > 1.0
    assert held == [weather.wetness(), weather.heightmap(), weather.sky(), weather.air()]
    for thing in held:
        thing.use(program)
    program.release()
    assert gl.error() == 0


def test_a_renderer_that_was_released(ctx: moderngl.Context) -> None:
    renderer = Renderer(ctx)
    renderer.release()
    renderer.release()
    view = RainView().view(frame(area()), camera(), 0, quality())
    with pytest.raises(ContextError, match="released"):
        renderer.draw(view, quality())


def test_a_forgotten_observer_leaves_no_heightmap(ctx: moderngl.Context, gl: GL) -> None:
    view_of, renderer, choice = RainView(1), Renderer(ctx, seed=1), quality(100)
    target = ctx.simple_framebuffer((16, 16))
    target.use()
    seen = frame(area(), occluders=(box(0, placed((0, 5, 0), (2, 0.1, 2))),))
    renderer.draw(view_of.view(seen, camera(), 0, choice), choice)
    before = {kind: len(names) for kind, names in living(gl).items()}
    for key in range(1, 40):
        renderer.draw(view_of.view(seen, camera(), key, choice), choice)
        assert renderer.heightmap(key) is not None
        renderer.forget(key)
        view_of.forget(key)
        assert renderer.heightmap(key) is None
    after = {kind: len(names) for kind, names in living(gl).items()}
    assert after["texture"] == before["texture"]
    assert after["framebuffer"] == before["framebuffer"]
    renderer.release()
    for thing in (*target.color_attachments, target.depth_attachment, target):
        thing.release()


def test_observers_that_come_and_go_leave_nothing(made: Stage, gl: GL) -> None:
    """With all that is kept for one: drops, splashes, rings, maps, what shaders read."""
    esper.create_entity(near(), Occluder(CORNERS, TRIANGLES, placed((0, -1, 0), (90, 1, 90))))
    esper.create_entity(SplashEmitter(), RippleSurface((4.0, 0.05, 0.0), (4.0, 4.0)))
    counts = []
    for k in range(6):
        seen = Observer()
        made.weather.wetness(observer=seen), made.weather.heightmap(observer=seen)
        made.weather.air(observer=seen)
        for _ in range(2):
            esper.process(1 / 30)
            made.draw(observer=seen)
        assert made.weather.ripples(RippleSurface((0, 0, 0), (1, 1)), observer=seen) is None
        del seen
        gc.collect()
        made.play(1)
        if k > 1:
            counts.append({kind: len(names) for kind, names in living(gl).items()})
    assert counts[0] == counts[-1]


def test_who_went_while_another_context_was_current_is_forgotten_later(made: Stage, gl: GL) -> None:
    esper.create_entity(near())
    made.play(2)
    made.weather.air()
    before = living(gl)
    seen = Observer()
    made.draw(observer=seen)
    made.weather.air(observer=seen)
    assert living(gl) != before
    del seen
    gc.collect()
    other = moderngl.create_context(standalone=True, backend="egl")
    with other, pytest.raises(ContextError, match="not current"):
        made.weather.draw(look_from((0.0, 1.7, 0.0), 0.0), perspective())
    other.release()
    made.ctx.__enter__()
    made.play(1)
    assert living(gl) == before


def test_entities_that_come_and_go_leave_nothing(made: Stage, gl: GL) -> None:
    """Two hundred of each kind, drawn while they lived."""
    esper.create_entity(near())
    made.play(3)

    def count() -> int:
        gc.collect()
        made.play(1)
        return sum(map(len, living(gl).values()))

    def cycle(k: int) -> None:
        entities = [
            esper.create_entity(far(heading=0.1 * k), PointLight((k % 7, 2, 0))),
            esper.create_entity(near(center=(k % 5, 0)), Wind((0, 1), 1.0)),
            esper.create_entity(
                Occluder(CORNERS, TRIANGLES, placed((k % 9, 3, 0), (1, 1, 1)), bool(k % 2))
            ),
        ]
        esper.process(1 / 30)
        made.draw()
        made.draw(observer=Observer())
        for entity in entities:
            esper.delete_entity(entity)

    for k in range(20):
        cycle(k)
    before = count()
    for k in range(200):
        cycle(k)
    assert count() <= before


def test_weathers_that_come_and_go_leave_nothing(ctx: moderngl.Context, gl: GL) -> None:
    before = living(gl)
    for k in range(3):
        with stage(ctx, size=(16, 16), backend=("compute", "feedback")[k % 2]) as made:
            esper.create_entity(near())
            made.play(2)
    assert living(gl) == before


# The shader's own edge


@pytest.fixture
def edge(ctx: moderngl.Context) -> Iterator[Callable[..., np.ndarray]]:
    """`area_factor` of shaders/rain_area.glsl at points (n, 2)."""
    source = resources.files("weather_ecs").joinpath("shaders", "rain_area.glsl").read_text()
    program = ctx.program(
        vertex_shader=f"""#version 330 core
        {source}
        uniform vec4 axis; uniform vec4 shape; in vec2 place; out float factor;
        void main() {{ factor = area_factor(place, axis, shape); }}
        """,
        varyings=["factor"],
    )
    points, out = ctx.buffer(reserve=4096 * 8), ctx.buffer(reserve=4096 * 4)
    array = ctx.vertex_array(program, [(points, "2f", "place")])
    target = ctx.simple_framebuffer((4, 4))
    target.use()

    def run(p: np.ndarray, center: Any, radii: Any, heading: float, soft: float) -> np.ndarray:
        program["axis"] = (*center, math.cos(heading), math.sin(heading))
        program["shape"] = (*radii, soft, 0.0)
        points.write(p.astype(np.float32))
        array.transform(out, moderngl.POINTS, vertices=len(p))
        return np.frombuffer(out.read(4 * len(p)), np.float32)

    yield run
    attachments = (*target.color_attachments, target.depth_attachment)
    for thing in (array, out, points, program, target, *attachments):
        thing.release()


def test_the_edge_in_the_shader_is_that_of_the_physics(edge: Callable[..., np.ndarray]) -> None:
    rng = np.random.default_rng(8)

    @settings(max_examples=60, deadline=None)
    @given(st.floats(1, 500), st.floats(0.05, 1), st.floats(-4, 4), st.floats(0, 1.5))
    def same(a: float, ratio: float, heading: float, soft: float) -> None:
        center, radii = (12.0, -30.0), (a, a * ratio)
        points = np.array(center) + rng.uniform(-1.2 * a, 1.2 * a, (512, 2))
        points[0] = center
        soft = min(soft * radii[1], radii[1]) if soft > 1e-3 else 0.0
        found = edge(points, center, radii, heading, soft)
        points = points.astype(np.float32)
        expected = edge_factor(points, center, radii, heading, soft)
        # A hard edge is where it is only to the float's rounding.
        unsure = np.abs(edge_factor(points, center, radii, heading, 1e-3 * a) - 0.5) < 0.5
        wrong = np.abs(found - expected) > 2e-3
        assert not (wrong & ~unsure).any()

    same()
