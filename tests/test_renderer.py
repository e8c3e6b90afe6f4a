"""The weather on a context: pictures, bad input, and everything given back."""

from __future__ import annotations

import gc
import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from importlib import resources
from types import ModuleType
from typing import Any

import esper
import moderngl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.boxes import CORNERS, TRIANGLES, box, placed
from tests.conftest import living
from tests.rain_frames import area, camera, frame, quality
from tests.weather_pictures import SIZE, Stage, stage
from weather_ecs import Weather
from weather_ecs.components import (
    Observer,
    Occluder,
    PointLight,
    RainArea,
    RainContainer,
    Sun,
    Wind,
)
from weather_ecs.errors import ContextError, InvalidValueError, ShaderError
from weather_ecs.gpu import layers as layers_module
from weather_ecs.gpu import renderer as renderer_module
from weather_ecs.gpu.context import Capabilities, probe
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.renderer import Renderer
from weather_ecs.physics.ellipse import edge_factor
from weather_ecs.systems import WeatherProcessor
from weather_ecs.systems.rain_view import RainView

NORTH = math.pi / 2


def near(**changes: Any) -> RainArea:
    """Rain around the origin."""
    return RainArea(**{"center": (0, 0), "radii": (60, 40), "rain_rate": 25.0, **changes})


def far(**changes: Any) -> RainArea:
    """Rain straight along -z, its rim 80 m off."""
    return near(**{"center": (0, -120), **changes})


@pytest.fixture
def made(ctx: moderngl.Context) -> Iterator[Stage]:
    with stage(ctx) as it:
        yield it


# What is drawn


VIEWS: tuple[dict[str, Any], ...] = (
    {},
    {"pitch": 1.5},
    {"pitch": -1.5, "position": (0, 30, 0)},
    {"position": (0, 1.7, 90), "heading": NORTH},
    {"position": (0, 900, 0), "pitch": -0.8},
    {"position": (5000, 1.7, 0), "heading": math.pi},
    {"position": (59.9, 1.7, 0)},
    {"position": (1e7, -1e7, 1e7)},
)


def test_no_view_of_a_full_scene_makes_an_error(
    ctx: moderngl.Context, gl: GL, backend: str
) -> None:
    with stage(ctx, backend=backend) as made:
        esper.create_entity(near(), far(), PointLight((2, 2, 2), (5, 4, 3)), Wind((1, 0), 9.0))
        esper.create_entity(far(), Sun((1, 0.1, 0)), RainContainer(reach=20.0))
        esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((3, 4, 0), (2, 0.1, 2))))
        esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((6, 1, 0), (1, 1, 1)), True))
        for dt in (0.0, 0.03, 3.0, 1e6):
            for at in VIEWS:
                esper.process(dt)
                made.draw(**at)
                assert gl.error() == 0, at


def test_no_rain_draws_nothing_and_does_nothing(made: Stage) -> None:
    empty = made.play(2)
    assert made.rain(empty).max() <= 1.0
    for thing in (near(rain_rate=0.0), far(), PointLight()):
        esper.create_entity(thing)
        assert np.array_equal(made.play(2, heading=-NORTH), empty)
        assert made.weather.stats.drops_moved == made.weather.stats.containers == 0


def test_it_rains_near_and_far(made: Stage) -> None:
    esper.create_entity(near())
    around = made.rain(made.play(4))
    assert (around > 2).mean() > 0.3
    there = made.rain(made.play(4, position=(0, 1.7, 120), heading=NORTH))
    # A shaft of rain in the middle of the picture, and nothing on either side.
    assert there[45:50, 70:90].mean() > 2.0
    assert there[:, :10].max() == 0.0 and there[:, -10:].max() == 0.0


def test_more_rain_is_seen_more(made: Stage) -> None:
    entity, shown = esper.create_entity(near()), []
    for rate in (1.0, 5.0, 25.0, 100.0):
        esper.component_for_entity(entity, RainArea).rain_rate = rate
        shown.append(made.rain(made.play(6)).mean())
    assert shown == sorted(shown) and shown[0] > 0.1 and shown[3] > 2.0 * shown[0]


def test_both_backends_draw_the_same_picture(ctx: moderngl.Context) -> None:
    if not probe(ctx).compute:
        pytest.skip("no compute shaders here")
    pictures = []
    for name in ("compute", "feedback"):
        with stage(ctx, backend=name, quality="medium") as made:
            assert made.weather.backend == made.weather.stats.backend == name
            esper.create_entity(near(), Wind((1, 0), 5.0))
            for k in range(20):
                esper.process(1 / 30)
                picture = made.draw((0.2 * k, 1.7, 0.0), 0.02 * k)
            pictures.append(picture.astype(float))
    assert np.abs(pictures[0] - pictures[1]).mean() < 0.1
    # A few drops at the rim of their discs fall to either side of it by rounding.
    assert (np.abs(pictures[0] - pictures[1]).max(axis=2) > 8).mean() < 0.01
    assert np.abs(pictures[0] - pictures[0].mean(axis=(0, 1))).mean() > 2.0


def test_rain_stays_inside_the_viewport(made: Stage) -> None:
    esper.create_entity(near())
    esper.process(0.03)
    made.clear()
    made.target.viewport = (30, 20, 64, 36)
    made.weather.draw(*matrices())
    assert made.target.viewport == (30, 20, 64, 36)
    made.target.viewport = (0, 0, *SIZE)
    shown = made.rain(made.picture()) > 2
    assert shown[20:56, 30:94].mean() > 0.3
    shown[20:56, 30:94] = False
    assert not shown.any()


def test_the_scene_hides_the_rain_behind_it(made: Stage) -> None:
    esper.create_entity(near())
    made.play(3)
    made.target.use()
    made.target.clear(*made.background, depth=0.0)
    made.weather.draw(*matrices())
    assert made.rain(made.picture()).max() == 0.0


def test_hosts_with_other_framebuffers(made: Stage, keep: Callable[[Any], Any]) -> None:
    """Without depth nothing hides the rain; with samples it is drawn as without."""
    ctx = made.ctx
    esper.create_entity(near())
    usual = made.rain(made.play(5)).mean()
    flat = keep(ctx.texture(SIZE, 4))
    bare = keep(ctx.framebuffer([flat]))
    many = keep(ctx.renderbuffer(SIZE, 4, samples=4))
    deep = keep(ctx.depth_renderbuffer(SIZE, samples=4))
    smooth = keep(ctx.framebuffer([many], deep))
    for target in (bare, smooth):
        target.use()
        target.clear(*made.background)
        made.weather.draw(*matrices())
        ctx.copy_framebuffer(bare, target) if target is smooth else None
        pixels = np.frombuffer(bare.read(components=3), np.uint8).reshape(SIZE[1], SIZE[0], 3)
        assert made.rain(pixels).mean() == pytest.approx(usual, rel=0.2)


# Time


def test_draws_do_not_move_the_weather(made: Stage) -> None:
    esper.create_entity(near(velocity=(1.0, 0.0)))
    left, right = Observer(), Observer()
    for _ in range(6):
        esper.process(1 / 30)
        for observer in (None, left, right):
            made.draw(observer=observer)
    before = made.weather.stats.time
    esper.process(1 / 30)
    frames = [made.draw(observer=o) for o in (left, right, left, None, right, None)]
    assert made.weather.stats.time == pytest.approx(before + 1 / 30)
    # The same camera: the same picture, for whichever observer and however often.
    for other in frames[1:]:
        assert np.array_equal(other, frames[0])
    assert made.weather.stats.drops_moved == 0  # the last of them moved nothing


def test_observers_see_what_is_theirs(made: Stage) -> None:
    """One who draws in between changes nothing for another."""
    walker, watcher = Observer(), Observer()

    def play(alone: bool) -> np.ndarray:
        for k in range(12):
            esper.process(1 / 30)
            picture = made.draw((0.3 * k, 1.7, 0.0), 0.1 * k, observer=walker)
            if not alone:
                made.draw((0.0, 1.7, -30.0 + k), 2.0, observer=watcher)
        return picture

    esper.create_entity(near())
    first = made.weather.snapshot()
    together = play(alone=False)
    made.weather.restore(first)
    again = Observer()
    walker = again
    assert np.array_equal(play(alone=True), together)


@pytest.mark.parametrize("pause", [9.0, 3600.0, 1e300])
def test_after_a_pause_the_rain_goes_on_without_a_burst(made: Stage, pause: float) -> None:
    esper.create_entity(near(radii=(400, 400)), Wind((1, 0), 6.0))
    usual = [made.rain(made.play(1)).mean() for _ in range(30)][10:]
    after = [made.rain(made.play(1, pause)).mean()]
    after += [made.rain(made.play(1)).mean() for _ in range(10)]
    assert max(after) < 1.5 * max(usual) and min(after) > 0.6 * min(usual)
    with pytest.raises(InvalidValueError):
        esper.process(math.nan)
    assert min(usual) < 2.0 * made.rain(made.play(1)).mean()


def test_a_paused_weather_hangs_in_the_air(made: Stage) -> None:
    esper.create_entity(near())
    made.play(5)
    made.weather.paused = True
    still = made.play(1)
    assert np.array_equal(made.play(3), still)
    made.weather.paused = False
    assert not np.array_equal(made.play(1), still)


def test_time_that_goes_back(made: Stage, gl: GL) -> None:
    esper.create_entity(near())
    early = made.weather.snapshot()
    made.play(10)
    made.weather.restore(early)
    assert made.rain(made.play(1)).mean() > 1.0
    assert gl.error() == 0


# Bad input


def matrices() -> tuple[np.ndarray, np.ndarray]:
    at = camera()
    return at.view, at.projection


def test_an_area_that_is_deleted_between_draws(made: Stage, gl: GL) -> None:
    keeper = esper.create_entity(far())
    for when in ("before draw", "between draws", "at once"):
        entity = esper.create_entity(near())
        made.play(2)
        esper.process(1 / 30)
        if when == "between draws":
            made.draw()
        esper.delete_entity(entity, immediate=when == "at once")
        dry = made.draw()
        assert made.rain(dry).max() <= 1.0 and gl.error() == 0
    assert esper.entity_exists(keeper)


def test_a_window_of_no_size(made: Stage, gl: GL) -> None:
    esper.create_entity(near())
    made.play(3)
    for viewport in ((0, 0, 0, 0), (0, 0, 0, 90), (5, 5, 160, 0), (0, 0, 1, 1), (400, 400, 9, 9)):
        made.target.viewport = viewport
        esper.process(1 / 30)
        made.weather.draw(*matrices())
        assert gl.error() == 0
    made.target.viewport = (0, 0, *SIZE)
    assert made.rain(made.play(2)).mean() > 1.0


def test_a_context_that_is_not_current(made: Stage) -> None:
    esper.create_entity(near())
    made.play(2)
    other = moderngl.create_context(standalone=True, backend="egl")
    try:
        with other, pytest.raises(ContextError, match="not current"):
            made.weather.draw(*matrices())
    finally:
        other.release()
        made.ctx.__enter__()
    # And nothing is lost: in its own context it goes on.
    assert made.rain(made.play(2)).mean() > 1.0


def test_compute_where_there_is_none(
    ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    def old(context: moderngl.Context, *rest: Any) -> Capabilities:
        return replace(probe(context, *rest), version=330, compute=False)

    monkeypatch.setattr(renderer_module, "probe", old)
    with pytest.raises(ContextError, match=r"4\.3.*3\.3"):
        Weather(context=ctx, backend="compute")
    assert esper.get_processor(WeatherProcessor) is None  # nothing is left in the world
    with stage(ctx, backend="auto") as made:
        assert made.weather.backend == "feedback"
        esper.create_entity(near())
        assert made.rain(made.play(3)).mean() > 1.0


@pytest.mark.parametrize(
    ("module", "part"),
    [
        (renderer_module, "RainPass"),
        (layers_module, "VeilPass"),
        (layers_module, "DepthCopy"),
        (layers_module, "PrimitiveCounter"),
    ],
)
def test_a_renderer_that_cannot_be_made_leaves_nothing(
    ctx: moderngl.Context, gl: GL, monkeypatch: pytest.MonkeyPatch, module: ModuleType, part: str
) -> None:
    def broken(*args: Any, **kwargs: Any) -> None:
        raise ShaderError("the driver does not like it")

    before = living(gl)
    monkeypatch.setattr(module, part, broken)
    with pytest.raises(ShaderError):
        Weather(context=ctx)
    assert living(gl) == before
    monkeypatch.undo()
    Weather(context=ctx).close()  # and the world has none yet


def test_backends_that_are_none(ctx: moderngl.Context) -> None:
    for wrong in ("vulkan", "", None, 3):
        with pytest.raises(InvalidValueError, match="backend"):
            Renderer(ctx, backend=wrong)  # type: ignore[arg-type]


def test_a_projection_without_perspective(made: Stage, gl: GL) -> None:
    """A host's two-dimensional matrices, as a window has them from the start."""
    esper.create_entity(near())
    flat = np.diag([2 / 160, 2 / 90, -1 / 255, 1.0])
    flat[:3, 3] = -1.0
    esper.process(1 / 30)
    made.weather.draw(np.eye(4), flat)
    assert gl.error() == 0
    assert made.rain(made.play(2)).mean() > 1.0


# Quality


def test_quality_changes_on_the_fly(made: Stage, gl: GL) -> None:
    esper.create_entity(near(), Occluder(CORNERS, TRIANGLES, placed((9, 3, 0), (2, 0.1, 2))))
    renderer = made.weather._renderer
    assert renderer is not None
    means = []
    for name, drops, texels in (
        ("low", 6_000, 256), ("high", 50_000, 1024), ("medium", 14_000, 512), ("low", 6_000, 256),
    ):  # fmt: skip
        made.weather.quality = name
        means.append(made.rain(made.play(3)).mean())
        (drop_set,) = renderer.rain.sets().values()
        heightmap = renderer.heightmap()
        assert heightmap is not None
        assert (drop_set.capacity, heightmap.size) == (drops, texels)
        assert made.weather.stats.drops_moved == drops
        assert gl.error() == 0
    # It changes what the rain costs, and not how dense it is.
    assert max(means) < 1.6 * min(means)


def test_the_budget_moves_fewer_drops_in_the_same_buffers(ctx: moderngl.Context) -> None:
    view_of, renderer = RainView(1), Renderer(ctx, seed=1)
    target = ctx.simple_framebuffer(SIZE)
    target.use()
    sizes, moved = set(), []
    for k, budget in enumerate((1.0, 0.5, 0.05, 1.0)):
        choice = quality(4000, budget=budget)
        renderer.draw(view_of.view(frame(area(), time=k / 30), camera(), 0, choice), choice)
        moved.append(renderer.stats["drops_moved"])
        sizes |= {(id(drops), drops.births.size) for drops in renderer.rain.sets().values()}
    assert moved == [4000, 2001, 201, 4000]
    assert len(sizes) == 1
    renderer.release()
    for thing in (*target.color_attachments, target.depth_attachment, target):
        thing.release()


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
