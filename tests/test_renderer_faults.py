"""The renderer where something is wrong or changes: input, contexts, quality."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from types import ModuleType
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.gl_names import living
from tests.rain_frames import area, camera, frame, quality
from tests.renderer_scene import far, matrices, near
from tests.weather_pictures import SIZE, Stage, stage
from weather_ecs import Weather
from weather_ecs.components import Occluder
from weather_ecs.errors import ContextError, InvalidValueError, ShaderError
from weather_ecs.gpu import layers as layers_module
from weather_ecs.gpu import renderer as renderer_module
from weather_ecs.gpu.context import Capabilities, probe
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.renderer import Renderer
from weather_ecs.systems import WeatherProcessor
from weather_ecs.systems.rain_view import RainView


@pytest.fixture
def made(ctx: moderngl.Context) -> Iterator[Stage]:
    with stage(ctx) as it:
        yield it


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
