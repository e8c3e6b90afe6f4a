"""Shader loader: includes, variants, and where an error is."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import moderngl
import pytest

from weather_ecs.errors import ContextError, InvalidValueError, ShaderError
from weather_ecs.gpu import blocks
from weather_ecs.gpu.blocks import UniformBlock
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.shader_source import Source, resolve

MAIN = "void main() { gl_Position = vec4(%s); }\n"


@pytest.fixture
def files(tmp_path: Path) -> Path:
    (tmp_path / "one.glsl").write_text("// one\nfloat one() { return 1.0; }\n")
    (tmp_path / "two.glsl").write_text('#include "one.glsl"\nfloat two() { return one() + 1.0; }\n')
    (tmp_path / "broken.glsl").write_text("// broken\n\nfloat broken() { return oops; }\n")
    return tmp_path


@pytest.fixture
def loader(ctx: moderngl.Context, files: Path) -> Iterator[ShaderLoader]:
    loader = ShaderLoader(ctx, files)
    yield loader
    loader.release()


def write(files: Path, text: str, name: str = "a.vert") -> ProgramKey:
    (files / name).write_text(text)
    return ProgramKey(vertex=name)


def test_includes_nest_and_count_once(loader: ShaderLoader, files: Path) -> None:
    text = '#include "two.glsl"\n  #  include  "one.glsl"  // again\n' + MAIN % "one() + two()"
    assert loader.program(write(files, text)).glo


def test_an_include_that_is_switched_off_first_is_there_later(
    loader: ShaderLoader, files: Path
) -> None:
    text = '#ifdef NEVER\n#include "one.glsl"\n#endif\n#include "two.glsl"\n' + MAIN % "two()"
    assert loader.program(write(files, text)).glo


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("\nvoid main() { gl_Position = oops; }\n", "a.vert:2:"),
        ('#include "two.glsl"\n\nvoid main() { gl_Position = oops; }\n', "a.vert:3:"),
        ('#include "one.glsl"\n#include "broken.glsl"\n' + MAIN % "1.0", "broken.glsl:3:"),
        ("#include <block:Known>\nvoid main() { gl_Position = oops; }\n", "a.vert:2:"),
        ('#include "two.glsl"\n#include "one.glsl"\n#error here\n', "a.vert:3:"),
    ],
)
def test_driver_errors_name_our_file_and_line(
    loader: ShaderLoader,
    files: Path,
    text: str,
    place: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(blocks, "BLOCKS", {})
    monkeypatch.setattr("weather_ecs.gpu.shader_source.BLOCKS", blocks.BLOCKS)
    UniformBlock("Known", ("k_value", "float"))
    with pytest.raises(ShaderError) as caught:
        loader.program(write(files, text))
    assert place in str(caught.value)
    assert "error" in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('// x\n#include "none.glsl"\n', "a.vert:2: cannot read shader 'none.glsl'"),
        ("#include none.glsl\n", "a.vert:1: expected #include"),
        ('#include "../one.glsl"\n', "a.vert:1: expected #include"),
        ("#include <block:Unheard>\n", "a.vert:1: unknown uniform block 'Unheard'"),
        ('#include "a.vert"\n', "a.vert:1: include cycle: a.vert -> a.vert"),
        ("#version 330\n", "a.vert:1: #version"),
        ('#include "v.glsl"\n', "v.glsl:2: #version"),
        ('\n#include "x.glsl"\n', "y.glsl:3: include cycle: a.vert -> x.glsl -> y.glsl -> x.glsl"),
    ],
)
def test_includes_are_strict(loader: ShaderLoader, files: Path, text: str, message: str) -> None:
    (files / "v.glsl").write_text("\n # version 430\n")
    (files / "x.glsl").write_text('#include "y.glsl"\n')
    (files / "y.glsl").write_text('\n\n#include "x.glsl"\n')
    with pytest.raises(ShaderError) as caught:
        loader.program(write(files, text))
    assert message in str(caught.value)


def test_an_unknown_file_is_named(loader: ShaderLoader) -> None:
    with pytest.raises(ShaderError, match=r"cannot read shader 'none\.vert'"):
        loader.program(ProgramKey(vertex="none.vert"))


def test_a_program_that_does_not_link_names_its_files(loader: ShaderLoader, files: Path) -> None:
    write(files, "out vec2 shade;\n" + MAIN % "1.0" + "// \n")
    (files / "a.frag").write_text("in vec4 shade;\nout vec4 c;\nvoid main() { c = shade; }\n")
    with pytest.raises(ShaderError, match=r"a\.vert \+ a\.frag DEEP=2") as caught:
        loader.program(ProgramKey(vertex="a.vert", fragment="a.frag", defines=(("DEEP", 2),)))
    assert "shade" in str(caught.value)


def test_nothing_is_left_of_a_program_that_failed(loader: ShaderLoader, files: Path) -> None:
    key = write(files, "void main() { gl_Position = oops; }\n")
    with pytest.raises(ShaderError):
        loader.program(key)
    write(files, MAIN % "1.0")
    assert loader.program(key).glo


def test_nothing_is_left_after_thousands_of_programs(
    loader: ShaderLoader, files: Path, gl: GL
) -> None:
    """Mesa gives no name out twice; that nothing is left alive is the fixture's to find."""
    for _ in range(3000):
        gl.glDeleteProgram(gl.glCreateProgram())
    last = gl.glCreateProgram()
    gl.glDeleteProgram(last)
    key = write(files, "void main() { gl_Position = oops; }\n")
    for _ in range(2):
        with pytest.raises(ShaderError):
            loader.program(key)
    assert not any(gl.glIsProgram(name) for name in range(last, last + 200))


def test_a_second_stage_that_fails_leaves_nothing(loader: ShaderLoader, files: Path) -> None:
    write(files, MAIN % "1.0")
    (files / "a.frag").write_text("out vec4 c;\nvoid main() { c = oops; }\n")
    with pytest.raises(ShaderError, match=r"a\.frag:2:"):
        loader.program(ProgramKey(vertex="a.vert", fragment="a.frag"))


def test_variants_follow_from_the_key(loader: ShaderLoader, files: Path) -> None:
    write(files, "out float value;\nvoid main() { value = A + float(B); }\n")
    a = ProgramKey(vertex="a.vert", defines=(("A", 1.5), "B"), varyings=("value",))
    b = ProgramKey(vertex="a.vert", defines=("B", ("A", 1.5)), varyings=("value",))
    c = ProgramKey(vertex="a.vert", defines=("B", ("A", 2.5)), varyings=("value",))
    assert a == b
    assert hash(a) == hash(b)
    assert loader.program(a) is loader.program(b)
    assert loader.program(a) is not loader.program(c)


def test_defines_reach_the_shader(ctx: moderngl.Context, loader: ShaderLoader, files: Path) -> None:
    write(files, "out float value;\nvoid main() { value = A + (ON ? 1.0 : 0.0); }\n")
    key = ProgramKey(vertex="a.vert", defines=(("A", 1.5), ("ON", "true")), varyings=("value",))
    target = ctx.simple_framebuffer((1, 1))
    target.use()
    array, output = ctx.vertex_array(loader.program(key), []), ctx.buffer(reserve=4)
    array.transform(output, moderngl.POINTS, vertices=1)
    assert output.read() == b"\x00\x00\x20\x40"  # 2.5
    for thing in (output, array, *target.color_attachments, target.depth_attachment, target):
        thing.release()


def test_geometry_and_fragment_stages(loader: ShaderLoader, files: Path) -> None:
    write(files, MAIN % "1.0")
    (files / "a.geom").write_text(
        "layout(points) in;\nlayout(points, max_vertices = 1) out;\n"
        "void main() { gl_Position = gl_in[0].gl_Position; EmitVertex(); }\n"
    )
    (files / "a.frag").write_text("out vec4 c;\nvoid main() { c = vec4(1.0); }\n")
    assert loader.program(ProgramKey(vertex="a.vert", geometry="a.geom", fragment="a.frag")).glo


def test_compute(ctx: moderngl.Context, loader: ShaderLoader, files: Path) -> None:
    (files / "a.comp").write_text(
        '#include "two.glsl"\nlayout(local_size_x = 1) in;\n'
        "layout(std430, binding = 0) buffer Out { float value; };\nvoid main() { value = two(); }\n"
    )
    key = ProgramKey(compute="a.comp")
    if ctx.version_code < 430:
        with pytest.raises(ContextError, match=r"4\.3"):
            loader.program(key)
        return
    buffer = ctx.buffer(reserve=4)
    buffer.bind_to_storage_buffer(0)
    loader.program(key).run(1)
    assert buffer.read() == b"\x00\x00\x00\x40"
    buffer.release()


@pytest.mark.parametrize(
    "parts",
    [
        {},
        {"fragment": "a.frag"},
        {"vertex": "a.vert", "compute": "a.comp"},
        {"compute": "a.comp", "varyings": ("x",)},
    ],
)
def test_keys_that_make_no_program(parts: dict[str, str]) -> None:
    with pytest.raises(InvalidValueError, match="program key"):
        ProgramKey(**parts)  # type: ignore[arg-type]


def test_files_from_other_systems(loader: ShaderLoader, files: Path) -> None:
    text = '\ufeff#include "one.glsl"\r\n\r\nvoid main() { gl_Position = oops; }\r\n'
    (files / "a.vert").write_bytes(text.encode())
    with pytest.raises(ShaderError, match=r"a\.vert:3:"):
        loader.program(ProgramKey(vertex="a.vert"))


@pytest.mark.parametrize(
    ("log", "expected"),
    [
        ("0:12(3): error: bad", "a.vert:12: error: bad"),  # Mesa
        ("1(12) : error C1008: undefined", "b.glsl:12 : error C1008: undefined"),  # NVIDIA
        ("ERROR: 1:7: 'x' : undeclared", "ERROR: b.glsl:7: 'x' : undeclared"),  # AMD, Intel, macOS
        ("9:12(3): error: bad", "9:12(3): error: bad"),
        ("0(3) : x\n1(4) : y", "a.vert:3 : x\nb.glsl:4 : y"),
    ],
)
def test_logs_of_other_drivers(log: str, expected: str) -> None:
    assert Source("", ["a.vert", "b.glsl"]).located(log) == expected


def test_the_package_brings_its_shaders(ctx: moderngl.Context) -> None:
    loader = ShaderLoader(ctx)
    with pytest.raises(ShaderError, match="none"):
        loader.program(ProgramKey(vertex="none.vert"))
    from importlib import resources

    root = resources.files("weather_ecs").joinpath("shaders")
    names = [item.name for item in root.iterdir() if item.name.endswith(".glsl")]
    assert names
    assert resolve(names[0], "330 core", (), root).text.startswith("#version 330 core\n")


def test_release_twice(ctx: moderngl.Context, files: Path) -> None:
    loader = ShaderLoader(ctx, files)
    loader.program(write(files, MAIN % "1.0"))
    loader.release()
    loader.release()
