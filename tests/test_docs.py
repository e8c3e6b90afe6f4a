"""What README and docs say is so."""

from __future__ import annotations

import re
import subprocess
import sys
from dataclasses import fields, is_dataclass
from pathlib import Path
from types import SimpleNamespace

import esper
import pytest

from weather_ecs import components, errors, presets
from weather_ecs.components import Observer, RainArea
from weather_ecs.quality import LEVELS
from weather_ecs.weather import Weather

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
INTEGRATION = (ROOT / "docs" / "integration.md").read_text(encoding="utf-8")
FOLDERS = ("weather_ecs", "demo_game", "benchmarks", "tests", "tools", "docs")
PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").glob("*.md"))]


def blocks(text: str) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```", text, re.M | re.S)


def anchors(page: Path) -> set[str]:
    titles = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.M)
    return {re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
        path, _, part = target.partition("#")
        if "://" not in target:
            assert (page.parent / path).exists(), target
            assert not part or part in anchors(page.parent / path if path else page), target


def test_every_page_and_picture_is_linked() -> None:
    linked = {
        (page.parent / target.partition("#")[0]).resolve()
        for page in PAGES
        for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8"))
    }
    there = [*(ROOT / "docs").glob("*.md"), *(ROOT / "docs" / "images").iterdir()]
    assert not [path.name for path in there if path.resolve() not in linked]


@pytest.mark.parametrize("page", PAGES[:1] + PAGES[2:], ids=lambda page: page.name)
def test_named_files_are_there(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for name in re.findall(r"`([\w./]+\.(?:py|glsl|frag|vert|geom|comp|md))`", text):
        found = [path for folder in FOLDERS for path in (ROOT / folder).rglob(Path(name).name)]
        assert any(path.as_posix().endswith(f"/{name}") for path in found), name


@pytest.mark.parametrize("page", PAGES[:1] + PAGES[2:], ids=lambda page: page.name)
def test_named_attributes_are_there(page: Path) -> None:
    """Fields and functions that pages name as `weather.name` or `Component.name`."""
    known = {name: getattr(components, name) for name in components.__all__} | {"weather": Weather}
    for owner, name in re.findall(r"`(\w+)\.(\w+)\b", page.read_text(encoding="utf-8")):
        thing = known.get(owner)
        if thing is not None and name not in ("glsl", "py"):
            own = {field.name for field in fields(thing)} if is_dataclass(thing) else set()
            assert name in own or hasattr(thing, name), f"{owner}.{name}"


@pytest.mark.parametrize("page", PAGES[:1] + PAGES[2:], ids=lambda page: page.name)
def test_named_modules_run(page: Path) -> None:
    for name in re.findall(r"python -m ([\w.]+)", page.read_text(encoding="utf-8")):
        if name.split(".")[0] in ("weather_ecs", "demo_game", "benchmarks", "tools"):
            path = ROOT / name.replace(".", "/")
            assert path.with_suffix(".py").is_file() or (path / "__main__.py").is_file(), name


def test_every_component_is_described() -> None:
    table = README.partition("## Components")[2].partition("\n## ")[0]
    rows = dict(re.findall(r"^\| `(\w+)` \|(.*)$", table, re.M))
    exported = {name: getattr(components, name) for name in components.__all__}
    public = {name for name, thing in exported.items() if is_dataclass(thing)}
    assert rows.keys() == public
    for name, row in rows.items():
        names = [field.name for field in fields(exported[name])]
        missing = [field for field in names if f"`{field}`" not in row]
        assert not missing, (name, missing)


def test_defaults_in_the_table_are_true() -> None:
    checked = 0
    for name, row in re.findall(r"^\| `([A-Z]\w+)` \|(.*)$", README, re.M):
        for field in fields(getattr(components, name)):
            written = re.search(rf"`{field.name}` ([\d.]+)(?:/([\d.]+))?(?! to)", row)
            if written and isinstance(field.default, int | float):
                value = float(written[1]) / float(written[2] or 1)
                assert value == pytest.approx(field.default), (name, field.name)
                checked += 1
    assert checked >= 8


def test_every_preset_and_error_is_named() -> None:
    assert all(name in README for name in presets.PRESETS)
    concrete = {name for name in vars(errors) if name.endswith("Error")}
    assert all(f"`{name}`" in INTEGRATION for name in concrete - {"WeatherError"})


def test_quality_table_is_true() -> None:
    for name in ("low", "medium", "high", "ultra"):
        level = LEVELS[name]
        drops = f"{level.drops:,}".replace(",", " ")
        assert f"| `{name}` | {drops} | {level.containers} |" in README


def test_server_example_runs() -> None:
    code = next(block for block in blocks(INTEGRATION) if "clients" in block)
    world = "server example"
    esper.switch_world(world)
    sent: list[bytes] = []
    names = {
        "Weather": Weather,
        "RainArea": RainArea,
        "esper": esper,
        "clients": SimpleNamespace(send=sent.append),
    }
    try:
        exec(compile(code, "the server's example", "exec"), names)
        assert names["weather"].backend == "none"
        assert names["weather"].sample((0, 1.7, 0)).rain_rate == 25.0
        assert len(sent[0]) < 4096
        with pytest.raises(errors.ContextError):
            names["weather"].draw(range(16), range(16))
        names["weather"].close()
    finally:
        esper.switch_world("default")
        esper.delete_world(world)


def test_observers_example_is_python() -> None:
    code = next(block for block in blocks(INTEGRATION) if "observer=left" in block)
    drawn: list[Observer] = []
    names = {
        "Observer": Observer,
        "esper": SimpleNamespace(create_entity=lambda *parts: 1),
        "weather": SimpleNamespace(draw=lambda view, projection, observer: drawn.append(observer)),
        **dict.fromkeys(("view_left", "view_right", "projection")),
    }
    exec(compile(code, "the observers' example", "exec"), names)
    assert drawn == [names["left"], names["right"]]


def test_make_targets_are_there() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in re.findall(r"(?:^    |`)make (\w+)", README, re.M):
        assert re.search(rf"^{target}:", makefile, re.M), target


@pytest.mark.parametrize("module", ["demo_game", "benchmarks"])
def test_help_is_printed(module: str) -> None:
    run = [sys.executable, "-m", module, "--help"]
    done = subprocess.run(run, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0
    assert "usage" in done.stdout
