"""The context: what it must be, what it can do, and that meeting it leaves no trace."""

from __future__ import annotations

import sys

import moderngl
import pytest

from tests.gl_host import read_state
from tests.processes import run
from weather_ecs.errors import ContextError, InvalidValueError
from weather_ecs.gpu import gl_platform
from weather_ecs.gpu.context import obtain, probe, require
from weather_ecs.gpu.gl import GL, SIGNATURES, SINCE


def test_probe(ctx: moderngl.Context) -> None:
    found = probe(ctx)
    assert found.version == ctx.version_code
    assert found.compute == (ctx.version_code >= 430)


def test_a_given_context_is_taken(ctx: moderngl.Context) -> None:
    assert obtain(ctx) is ctx


@pytest.mark.parametrize("thing", ["context", 3, object()])
def test_what_is_no_context_is_refused(ctx: moderngl.Context, thing: object) -> None:
    with pytest.raises(InvalidValueError, match="context"):
        obtain(thing)  # type: ignore[arg-type]


def test_without_a_current_context(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gl_platform, "sources", list)
    with pytest.raises(ContextError, match="no OpenGL context is current"):
        GL()


@pytest.mark.parametrize(
    ("version", "text"), [(300, "3.0 Mesa 22"), (210, "2.1"), (320, "OpenGL ES 3.2 Mesa")]
)
def test_too_old_names_both_versions(version: int, text: str) -> None:
    with pytest.raises(ContextError) as caught:
        require(version, text)
    assert "3.3" in str(caught.value)
    assert text in str(caught.value)


@pytest.mark.parametrize("version", [330, 410, 460])
def test_new_enough(version: int) -> None:
    require(version, f"{version / 100}")


def test_no_context_and_a_released_one() -> None:
    out = run(
        "import moderngl\n"
        "from weather_ecs.errors import ContextError\n"
        "from weather_ecs.gpu.context import obtain\n"
        "def attempt(*given):\n"
        "    try:\n"
        "        obtain(*given)\n"
        "    except ContextError as error:\n"
        "        print(error)\n"
        "attempt()\n"
        "first = moderngl.create_context(standalone=True, backend='egl')\n"
        "second = moderngl.create_context(standalone=True, backend='egl')\n"
        "first.release()\n"
        "attempt(first)\n"
        "assert obtain(second) is second\n"
    )
    assert out.splitlines() == [
        "no OpenGL context is current in this thread",
        "the moderngl context was released",
    ]


# A host that has a context, but not through moderngl: what it has set must stay.
FOREIGN = """
import glcontext
context = glcontext.get_backend_by_name("egl")(glversion=330, mode="standalone")
from tests.gl_host import read_state
from weather_ecs.gpu.context import obtain, probe
from weather_ecs.gpu.gl import GL
gl = GL()
gl.glBlendFuncSeparate(1, 0, 0x0304, 0x0305)
gl.glPrimitiveRestartIndex(9)
gl.glActiveTexture(0x84C2)
before = read_state(gl)
ctx = obtain()
after = read_state(gl)
print({name: (before[name], after[name]) for name in before if before[name] != after[name]})
print(gl.error(), ctx.version_code, probe(ctx).compute, obtain() is ctx)
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="makes its context with EGL")
def test_meeting_a_foreign_context_changes_nothing() -> None:
    lines = run(FOREIGN).splitlines()
    assert lines[0] == "{}"
    assert lines[1].startswith("0 ")
    assert lines[1].endswith(" True")


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Mesa's own switches")
def test_an_old_context() -> None:
    out = run(
        "import moderngl\n"
        "from weather_ecs.gpu.context import obtain, probe\n"
        "from weather_ecs.gpu.gl import GL\n"
        "ctx = moderngl.create_context(standalone=True, backend='egl')\n"
        "gl = GL()\n"
        "print(probe(obtain()).compute, gl.version, gl.glDispatchCompute, gl.glBindSamplers)\n",
        MESA_GL_VERSION_OVERRIDE="3.3",
        MESA_GLSL_VERSION_OVERRIDE="330",
    )
    if " 330 " not in out:
        pytest.skip("not Mesa")
    assert out.split() == ["False", "330", "None", "None"]


def test_entry_points(ctx: moderngl.Context, gl: GL) -> None:
    assert gl.is_current()
    for name, optional in SIGNATURES.items():
        present = gl.version >= SINCE.get(name, 0)
        assert (getattr(gl, name) is not None) == present, name
        assert present or optional, name
    assert gl.get_string(0x1F02)
    gl.glViewport(1, 2, 3, 4)
    assert gl.get_ints(0x0BA2, 4) == (1, 2, 3, 4)
    gl.glBlendColor(0.25, 0.5, 0.75, 1.0)
    gl.glDepthRange(0.25, 0.75)
    state = read_state(gl)
    assert state["blend color"] == (0.25, 0.5, 0.75, 1.0)
    assert state["depth range"] == (0.25, 0.75)
    gl.glBlendColor(0.0, 0.0, 0.0, 0.0)
    gl.glDepthRange(0.0, 1.0)
