"""The examples of README and docs: each runs as it stands, given what its reader brings.

The README's first one and the game of shaders.md need a window: `window_readme.py`,
`window_shaders.py`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import esper
import moderngl
import pytest

from tests.boxes import CORNERS, TRIANGLES
from tests.targets import bound_target
from tests.views import look_from, perspective
from weather_ecs import (
    CloudFile,
    Weather,
    components,
    glsl,
    load_clouds,
    presets,
    save_clouds,
)
from weather_ecs.components import CloudModel, CloudSeed, Occluder, Sky, SkyLayer
from weather_ecs.stats import Stats

pytestmark = pytest.mark.usefixtures("world")

ROOT = Path(__file__).parent.parent
DOCS = [page for page in sorted((ROOT / "docs").glob("*.md")) if page.name != "shaders.md"]
PAGES = [ROOT / "README.md", *DOCS]
VERTEX = "#version 330\nvoid main() { gl_Position = vec4(0.0); }\n"
# What the shaders of a game do with each include, in the words of its page.
FRAGMENT = {
    "cloud-drawing.md": (
        "out vec4 color;\nvoid main() { color = vec4(weather_sunlight(vec3(1.0))); }\n"
    ),
    "collisions.md": (
        "out vec4 color;\nvoid main() { color = vec4(weather_rained_on(vec3(1.0))); }\n"
    ),
    "fog.md": "out vec4 color;\nvoid main() { color = vec4(weather_fog_color.rgb, 1.0); }\n",
    "wetness.md": "out vec4 color;\nvoid main() { color = vec4(weather_water(vec3(1.0))); }\n",
}


def snippets(language: str) -> list[Any]:
    found = []
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        examples = list(re.finditer(rf"^```{language}\n(.*?)^```", text, re.M | re.S))
        for match in examples[page.name == "README.md" :]:
            line = text.count("\n", 0, match.start()) + 2
            found.append(pytest.param(page, line, match[1], id=f"{page.name}:{line}"))
    return found


class Context:
    """Compiles a program whose vertex shader the page leaves out."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx, self.made = ctx, []  # type: ignore[var-annotated]

    def program(self, vertex_shader: object, fragment_shader: str) -> moderngl.Program:
        assert vertex_shader is ...
        program = self._ctx.program(vertex_shader=VERTEX, fragment_shader=fragment_shader)
        self.made.append(program)
        return program


class Sound:
    """What a game would play or show."""

    def __init__(self) -> None:
        self.heard: list[Any] = []

    def __call__(self, *values: Any, **named: Any) -> None:
        self.heard.append(values or named)


@pytest.fixture
def weather(ctx: moderngl.Context) -> Iterator[Weather]:
    with bound_target(ctx, (32, 18)), Weather(context=ctx, quality="low") as made:
        yield made


@pytest.fixture
def names(
    ctx: moderngl.Context, weather: Weather, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Iterator[dict[str, Any]]:
    """What the pages take for granted."""
    monkeypatch.chdir(tmp_path)
    layer = SkyLayer(skies=(Sky(0.0, models=("towers",), count=1),))
    for file in ("towers.toml", "evening.toml"):
        model = CloudModel("towers", (CloudSeed(),))
        save_clouds(file, CloudFile((model,), layers=() if file == "towers.toml" else (layer,)))
    context, cart = Context(ctx), Occluder(CORNERS, TRIANGLES)
    esper.create_entity(cart)
    view = look_from((0.0, 1.7, 0.0), 0.0)
    yield {
        **{name: getattr(components, name) for name in components.__all__},
        "Weather": Weather, "esper": esper, "presets": presets, "weather": weather,
        "context": context, "cart": cart, "clients": SimpleNamespace(send=Sound()), "dt": 1 / 60,
        "view_left": view, "view_right": view, "projection": perspective(),
        "flash_on_the_radar": Sound(), "play_thunder": Sound(),
    }  # fmt: skip
    for program in context.made:
        program.release()


@pytest.mark.parametrize(("page", "line", "code"), snippets("python"))
def test_it_runs(page: Path, line: int, code: str, names: dict[str, Any]) -> None:
    if "weather = Weather(" in code:  # a world has one
        names.pop("weather").close()
    if page.name in FRAGMENT:
        names["my_fragment_shader"] = names["my_ground_shader"] = FRAGMENT[page.name]
    if page.name == "ripples.md" and "program" in code:
        source = "#version 330\n" + glsl("ripple_sample.glsl") + "out vec4 color;\nvoid main() {"
        source += " color = vec4(ripple_slope(gl_FragCoord.xy, 0.1), 0.0, 1.0); }\n"
        names["program"] = names["context"].program(..., source)
        names["pond"] = components.RippleSurface(center=(0, 0, -5), size=(4, 3))
        esper.create_entity(names["pond"])
        esper.process(1 / 20)
        names["weather"].draw(names["view_left"], names["projection"])
    exec(compile("\n" * (line - 1) + code, str(page), "exec"), names)
    if isinstance(names.get("weather"), Weather):
        esper.process(1 / 20)  # and whatever it made is good for a step
        assert isinstance(names["weather"].stats, Stats)
        names["weather"].close()


@pytest.mark.parametrize(("page", "line", "code"), snippets("glsl"))
def test_its_functions_are_there(page: Path, line: int, code: str, ctx: moderngl.Context) -> None:
    include = "ripple_sample.glsl" if page.name == "ripples.md" else "weather.glsl"
    given = (
        "const vec3 world = vec3(1.0), place = vec3(1.0);\nconst float blur = 0.1, shadow = 1.0;\n"
    )
    given += "" if "vec3 normal" in code else "const vec3 normal = vec3(0.0, 1.0, 0.0);\n"
    last = re.findall(r"vec3 (\w+) =", code)[-1]
    source = f"#version 330\n{glsl(include)}{given}out vec4 color;\nvoid main()\n{{\n{code}"
    source += f"    color = vec4({last}, 1.0);\n}}\n"
    ctx.program(vertex_shader=VERTEX, fragment_shader=source).release()


@pytest.mark.parametrize(("page", "line", "text"), snippets("toml"))
def test_its_file_loads(page: Path, line: int, text: str, tmp_path: Path) -> None:
    path = tmp_path / "example.toml"
    path.write_text(text, encoding="utf-8")
    content = load_clouds(path)
    assert content.models and content.layers and content.climate is not None
    again, third = tmp_path / "again.toml", tmp_path / "third.toml"
    save_clouds(again, content)
    save_clouds(third, load_clouds(again))
    assert again.read_bytes() == third.read_bytes()


def test_no_kind_of_block_is_left_out() -> None:
    known = ("python", "glsl", "toml", "")  # without a language: what a program prints
    for page in [*PAGES, ROOT / "docs" / "shaders.md"]:
        fences = re.findall(r"^```(.*)$", page.read_text(encoding="utf-8"), re.M)
        assert len(fences) % 2 == 0 and set(fences) <= set(known), page.name
