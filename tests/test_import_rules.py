"""The layers: who may import whom, read from the source of every module without running it."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = "weather_ecs"
# Layer: libraries it may import, and parts of the package; its own part always.
LAYERS: dict[str, tuple[set[str], set[str]]] = {
    "errors": (set(), set()),
    "components": ({"numpy"}, {"errors"}),
    "physics": ({"numpy"}, {"errors"}),
    "frame": ({"numpy"}, set()),
    "gpu": ({"numpy", "moderngl"}, {"errors", "frame", "physics"}),
    "systems": (
        {"numpy", "esper"},
        {"errors", "components", "physics", "frame", "gpu", "clock"},
    ),
    "weather": ({"numpy", "esper", "pyglet"}, {"*"}),
    "metar": ({"metar"}, {"*"}),
    "tools": ({"numpy"}, {"*"}),
    "editor": (
        {"numpy", "esper", "pyglet", "moderngl", "imgui_bundle", "OpenGL", "PIL", "imageio_ffmpeg"},
        {"*"},
    ),
}
TOP = ("weather", "tools", "editor")  # the layers that know of gpu
# Of the editor, what has to work without a window and its widgets.
EDITED = (
    *("document", "history", "content", "files", "recent", "kept_text", "toml_tree"),
    *("clipboard", "pasting", "commands", "fields", "field_texts"),
)
# Every other module of the package: clock, snapshot, stats and their like.
ELSEWHERE: tuple[set[str], set[str]] = ({"numpy", "esper"}, {"*"})  # all but gpu
USERS = ("demo_game", "benchmarks")
_FACES = ("components", "presets", "errors", "events", "tools", "editor.app")
PUBLIC = {PACKAGE, *(f"{PACKAGE}.{name}" for name in _FACES)}
LOADER = "gpu/shader_source.py"  # writes the version line that shader files do not hold


def imports(path: Path, root: Path, typing_too: bool = True) -> Iterator[tuple[int, str]]:
    """Line and full dotted name of everything a file imports, relative imports resolved."""
    package = path.relative_to(root).with_suffix("").parts[:-1]
    tree = ast.parse(path.read_text(encoding="utf-8"))
    skipped: set[ast.AST] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING"):
            skipped.update(inner for part in node.body for inner in ast.walk(part))
    for node in ast.walk(tree):
        if not typing_too and node in skipped:
            continue
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else ()
            origin = ".".join((*base, *([node.module] if node.module else ())))
            yield from ((node.lineno, f"{origin}.{alias.name}") for alias in node.names)


def glsl(path: Path) -> Iterator[tuple[int, str]]:
    """Line and token of what looks like GLSL in a file's strings, docstrings apart."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    prose = {
        node.value for node in ast.walk(tree) if isinstance(node, ast.Expr)
    }  # a string that stands alone is documentation
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node not in prose:
            for token in ("#version", "gl_Position", "void main"):
                if token in node.value and not (
                    token == "#version" and path.as_posix().endswith(f"{PACKAGE}/{LOADER}")
                ):
                    yield node.lineno, token


def layer_breaches(path: Path, root: Path) -> Iterator[str]:
    """What a module of the package imports beyond its layer."""
    inside = path.relative_to(root / PACKAGE)
    layer = inside.parts[0].removesuffix(".py")
    libraries, parts = LAYERS.get(layer, ELSEWHERE)
    if layer == "editor" and inside.stem in EDITED:
        libraries = {"numpy"}
    for line, name in imports(path, root, typing_too=layer != "weather"):
        top, *rest = name.split(".")
        if top == PACKAGE:
            part = rest[0] if rest else ""
            if layer == "__init__" or part == layer or part in parts:
                continue
            if "*" in parts and part != "editor" and (part != "gpu" or layer in TOP):
                continue
        elif top in libraries or top in sys.stdlib_module_names:
            continue
        yield f"{path.relative_to(root).as_posix()}:{line}: {layer} imports {name}"


def user_breaches(path: Path, root: Path) -> Iterator[str]:
    """What a user of the package imports beyond its public names."""
    for line, name in imports(path, root):
        if name.split(".")[0] != PACKAGE:
            continue
        module, _, last = name.rpartition(".")
        modules = {entry.stem for entry in root.joinpath(*module.split(".")).glob("*")}
        is_module = not module or last in modules
        public = name in PUBLIC if is_module else module in PUBLIC and not last.startswith("_")
        if not public:
            yield f"{path.relative_to(root).as_posix()}:{line}: {name} is not public"


def breaches(root: Path) -> list[str]:
    """Every breach of the rules under `root`, as file, line and what is wrong."""
    found: list[str] = []
    for path in sorted((root / PACKAGE).rglob("*.py")):
        found.extend(layer_breaches(path, root))
        found.extend(
            f"{path.relative_to(root).as_posix()}:{line}: {token} in Python"
            for line, token in glsl(path)
        )
    for user in USERS:
        for path in sorted((root / user).rglob("*.py")):
            found.extend(user_breaches(path, root))
    return found


def test_every_module_keeps_to_its_layer() -> None:
    assert list((ROOT / PACKAGE / "physics").glob("*.py"))  # it does look at something
    assert breaches(ROOT) == []


GOOD = {
    "weather_ecs/__init__.py": "from weather_ecs.weather import Weather",
    "weather_ecs/errors.py": "import math",
    "weather_ecs/clock.py": "import esper\nfrom .errors import A",
    "weather_ecs/components/rain.py": "import numpy as np\nfrom ..errors import A",
    "weather_ecs/physics/drops.py": "from .ellipse import f\nfrom weather_ecs.errors import A",
    "weather_ecs/gpu/shader_source.py": 'import moderngl\nfrom ..frame import F\nV = "#version"',
    "weather_ecs/systems/wind.py": "import esper\nfrom .. import frame, components",
    "weather_ecs/weather.py": (
        "import pyglet\nfrom typing import TYPE_CHECKING\nfrom .gpu.renderer import R\n"
        "if TYPE_CHECKING:\n    import moderngl\n"
    ),
    "weather_ecs/editor/app.py": "import imgui_bundle\nfrom weather_ecs.gpu.host import A",
    "weather_ecs/editor/document.py": "from weather_ecs import cloud_files\nfrom .history import A",
    "demo_game/game.py": (
        "import moderngl, pyglet\nimport weather_ecs\nfrom weather_ecs import Weather, presets\n"
        "from weather_ecs.components import Wind\n"
    ),
}
PLANTED = [
    ("weather_ecs/components/rain.py", "import esper"),
    ("weather_ecs/components/rain.py", "from ..physics import drops"),
    ("weather_ecs/components/rain.py", "if TYPE_CHECKING:\n    import moderngl"),
    ("weather_ecs/physics/drops.py", "import scipy"),
    ("weather_ecs/physics/drops.py", "from weather_ecs.components import RainArea"),
    ("weather_ecs/physics/drops.py", "def f():\n    from weather_ecs import frame"),
    ("weather_ecs/frame.py", "from .errors import A"),
    ("weather_ecs/gpu/pass.py", "import esper"),
    ("weather_ecs/gpu/pass.py", "from ..systems import SCHEDULE"),
    ("weather_ecs/gpu/pass.py", 'S = "void f() { gl_Position = x; }"'),
    ("weather_ecs/gpu/pass.py", 'S = f"#version {330}"'),
    ("weather_ecs/systems/wind.py", "import pyglet"),
    ("weather_ecs/systems/wind.py", "import moderngl"),
    ("weather_ecs/weather.py", "import moderngl"),
    ("weather_ecs/clock.py", "from weather_ecs.gpu import gl"),
    ("weather_ecs/clock.py", "import pyglet"),
    ("weather_ecs/clock.py", "from weather_ecs.editor import files"),
    ("weather_ecs/weather.py", "from .editor.document import Document"),
    ("weather_ecs/editor/app.py", "import requests"),
    ("weather_ecs/editor/document.py", "import imgui_bundle"),
    ("weather_ecs/editor/commands.py", "import pyglet"),
    ("demo_game/game.py", "from weather_ecs.editor.files import Files"),
    ("demo_game/game.py", "from weather_ecs.weather import Weather"),
    ("demo_game/game.py", "import weather_ecs.gpu.renderer"),
    ("demo_game/game.py", "from weather_ecs import physics, gpu"),
    ("demo_game/game.py", "from weather_ecs.components import _base"),
    ("benchmarks/rain.py", "from weather_ecs.physics.drops import extinction"),
    ("benchmarks/rain.py", "from weather_ecs import _secret"),
]  # fmt: skip


def plant(root: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text + "\n", encoding="utf-8")


def test_the_checker_lets_good_imports_pass(tmp_path: Path) -> None:
    plant(tmp_path, GOOD | {"weather_ecs/presets.py": "", "weather_ecs/components/__init__.py": ""})
    assert breaches(tmp_path) == []


@pytest.mark.parametrize(("name", "text"), PLANTED)
def test_the_checker_catches_a_planted_breach(tmp_path: Path, name: str, text: str) -> None:
    folders = [f"weather_ecs/{part}/__init__.py" for part in ("components", "gpu", "physics")]
    plant(tmp_path, GOOD | dict.fromkeys(folders, "") | {name: text})
    found = breaches(tmp_path)
    assert found
    assert all(line.startswith(name) for line in found)
