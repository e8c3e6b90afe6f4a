"""Fixtures: one off-screen OpenGL context for all tests, watched for errors and leaks in each."""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

import esper
import moderngl
import pytest
from hypothesis import HealthCheck, settings

from tests.gl_names import begin, living
from tests.worlds import fresh_world
from weather_ecs.gpu.context import probe
from weather_ecs.gpu.gl import GL

if TYPE_CHECKING:
    from demo_game.place import Place

# The same examples every time, and no clock: a busy machine is no reason to fail. The examples of a
# test share its world.
settings.register_profile(
    "steady",
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)
settings.load_profile("steady")


class Releasable(Protocol):
    def release(self) -> Any: ...


Thing = TypeVar("Thing", bound=Releasable)


def rest(context: moderngl.Context, gl: GL) -> None:
    """Nothing bound, no flags, no errors: what one test leaves must not reach the next."""
    gl.glUseProgram(0)
    gl.glBindVertexArray(0)
    context.detect_framebuffer(0).use()
    context.enable_only(moderngl.NOTHING)
    while gl.error():
        pass


@pytest.fixture(scope="session")
def watched() -> Iterator[tuple[moderngl.Context, GL]]:
    """The context of this process; use `ctx`, which watches it."""
    settings: dict[str, Any] = {"backend": "egl"} if sys.platform.startswith("linux") else {}
    context = moderngl.create_context(standalone=True, require=330, **settings)
    yield context, GL()
    context.release()


@pytest.fixture
def ctx(watched: tuple[moderngl.Context, GL]) -> Iterator[moderngl.Context]:
    """A clean context; afterwards no error may be pending and nothing new may be alive."""
    context, gl = watched
    with context:
        rest(context, gl)
        begin(gl)
        before = living(gl)
        yield context
        error = gl.error()
        after = living(gl)
        rest(context, gl)
    new = {kind: sorted(after[kind] - before[kind]) for kind in after}
    left = {kind: names for kind, names in new.items() if names}
    assert error == 0, f"OpenGL error {error:#06x} pending after the test"
    assert not left, f"OpenGL objects left alive: {left}"


@pytest.fixture
def gl(ctx: moderngl.Context, watched: tuple[moderngl.Context, GL]) -> GL:
    """Raw entry points of `ctx`."""
    return watched[1]


@pytest.fixture
def keep(ctx: moderngl.Context) -> Iterator[Callable[[Thing], Thing]]:
    """`keep(thing)` releases a thing at the end of the test, the latest first."""
    kept: list[Releasable] = []

    def keep_one(thing: Thing) -> Thing:
        kept.append(thing)
        return thing

    yield keep_one
    for thing in reversed(kept):
        thing.release()


@pytest.fixture(autouse=True)
def home() -> Iterator[None]:
    """A test leaves esper in the world that it began in."""
    before = esper.current_world
    yield
    after = esper.current_world
    if after != before:
        esper.switch_world(before)
    assert after == before, f"the test has left esper in the world {after!r}"


@pytest.fixture
def world() -> Iterator[str]:
    """A world of esper's own for a test; its name."""
    with fresh_world() as name:
        yield name


@pytest.fixture(params=["compute", "feedback"])
def backend(ctx: moderngl.Context, request: pytest.FixtureRequest) -> str:
    """Each way of moving drops that there is here."""
    name: str = request.param
    if name == "compute" and not probe(ctx).compute:
        pytest.skip("no compute shaders here")
    return name


@pytest.fixture(scope="session")
def place() -> Place:
    """The demo's place, which nobody changes; making it takes seconds."""
    from demo_game.place import Place

    return Place(0)


def pytest_configure(config: pytest.Config) -> None:
    # Mesa's shader cache writes to the home directory; tests leave nothing behind. Without any
    # cache, the software renderer would translate the same shaders anew in every test.
    if not os.environ.keys() & {"MESA_SHADER_CACHE_DISABLE", "MESA_SHADER_CACHE_DIR"}:
        cache = tempfile.mkdtemp(prefix="weather-ecs-shaders-")
        os.environ["MESA_SHADER_CACHE_DIR"] = cache
        config.add_cleanup(partial(shutil.rmtree, cache, ignore_errors=True))
