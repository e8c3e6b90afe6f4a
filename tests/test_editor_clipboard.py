"""Copy and paste of parts as text, and the commands with their keys."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.file_values import MODELS, component
from weather_ecs import CloudFile, WeatherFileError
from weather_ecs.components import (
    Cloud,
    CloudModel,
    CloudRoot,
    CloudSeed,
    Fog,
    Observer,
    RainArea,
    Sky,
    SkyLayer,
    Wind,
)
from weather_ecs.components._base import Component
from weather_ecs.editor import pasting
from weather_ecs.editor.clipboard import copied, kind_name, pasted
from weather_ecs.editor.commands import COMMANDS, Command, Commands
from weather_ecs.editor.document import Document
from weather_ecs.editor.shared import Selection
from weather_ecs.file_tables import table_of

ROOT = CloudRoot(pitch=90.0, seeds_start=4)
SEED = CloudSeed((1.0, 2.0, 3.0), width=44.0, roots=(ROOT, CloudRoot()))
QUICK = settings(
    deadline=None,
    max_examples=40,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow],
)


def same(a: Component, b: Component) -> bool:
    return type(a) is type(b) and repr(table_of(a)) == repr(table_of(b))


def document() -> Document:
    models = (CloudModel("a", (SEED, CloudSeed())), CloudModel("b", (CloudSeed(),)))
    layers = (SkyLayer(skies=(Sky(0.0), Sky(1.0, ("a",), count=2))),)
    return Document(CloudFile(models, (Cloud("a", (0, 0, 0)),), layers))


@QUICK
@given(st.lists(MODELS | component(RainArea) | component(Wind), min_size=1, max_size=3))
def test_any_parts_come_back(parts):
    again = pasted(copied(parts))
    assert len(again) == len(parts)
    for part in parts:
        assert any(same(part, other) for other in again)


def test_parts_of_every_kind_come_back():
    for part in (SEED, ROOT, Sky(0.5, ("a",), count=2), SkyLayer(), Cloud("a", (1, 2, 3)), Fog()):
        [again] = pasted(copied([part]))
        assert same(part, again)
    with pytest.raises(TypeError, match="no Observer"):
        copied([Observer((0.0, 0.0, 0.0))])


def test_text_that_was_cut_out_of_a_file_is_understood():
    [seed] = pasted("[[models.seeds]]\nwidth = 5\n[[models.seeds.roots]]\npitch = 9\n")
    assert isinstance(seed, CloudSeed) and seed.width == 5.0 and seed.roots[0].pitch == 9.0
    [root] = pasted("[[models.seeds.roots]]\npitch = 9\n")
    assert isinstance(root, CloudRoot)
    [sky] = pasted("[[layers.skies]]\nstate = 0.25\n")
    assert isinstance(sky, Sky)
    model, layer, fog = pasted(
        "version = 2\nx_a = 1\n[[models]]\nname = 'm'\n[[models.seeds]]\n"
        "[[layers]]\n[layers.climate]\nduration = 5\n[fog]\nvisibility = 3\n"
    )
    assert isinstance(model, CloudModel) and isinstance(layer, SkyLayer) and isinstance(fog, Fog)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty"),
        ("hello", "not valid TOML"),
        ("a = 1", "holds nothing of a weather"),
        ("[[seeds]]\nwidth = 0", r"line 2, seeds\[0\].width: got 0"),
        ("[[seeds]]\nwide = 1", r"seeds\[0\].wide.*the keys center"),
        ("seeds = 3", r"seeds: got 3"),
        ("roots = [3]", r"roots\[0\]: got 3"),
        ("x = " + "[" * 400, "nested too deeply"),
        ("#" * 3_000_000, "longer than"),
        ("[models]\nseeds = {}", "array of tables"),
    ],
)
def test_other_text_is_refused(text, words):
    with pytest.raises(WeatherFileError, match=f"the clipboard: .*{words}"):
        pasted(text)


@QUICK
@given(st.text(max_size=60) | st.sampled_from(["[[seeds]]\n", "[seeds]\n", "seeds = [{}]"]))
def test_noise_is_refused_or_parts(text):
    try:
        assert pasted(text)
    except WeatherFileError:
        pass


def test_a_seed_is_copied_cut_and_pasted():
    doc, where = document(), Selection()
    text = pasting.copy(doc, "seed", where)
    assert text is not None and pasting.paste(doc, text, where)
    assert where.seed == 1 and len(doc.content.models[0].seeds) == 3
    assert same(doc.content.models[0].seeds[1], SEED)
    assert doc.undo_label == "Paste seed"
    assert pasting.cut(doc, "seed", where) == text
    assert where.seed == 0 and len(doc.content.models[0].seeds) == 2
    assert doc.undo_label == "Cut seed"
    where.model = 1
    assert pasting.paste(doc, text, where)
    assert [len(model.seeds) for model in doc.content.models] == [2, 2]
    while doc.undo():
        pass
    assert not doc.dirty


def test_a_root_is_pasted_into_the_chosen_seed():
    doc, where = document(), Selection(seed=1)
    assert pasting.paste(doc, copied([ROOT, ROOT]), where)
    assert [len(seed.roots) for seed in doc.content.models[0].seeds] == [2, 2]
    assert doc.undo_label == "Paste 2 roots"
    assert pasting.delete(doc, "root", where) and len(doc.content.models[0].seeds[1].roots) == 1
    assert pasting.duplicate(doc, "root", Selection())
    assert same(doc.content.models[0].seeds[0].roots[1], ROOT)


def test_a_model_gets_a_name_that_is_free():
    doc, where = document(), Selection()
    assert pasting.duplicate(doc, "model", where)
    assert [model.name for model in doc.content.models] == ["a", "a 2", "b"] and where.model == 1
    assert pasting.duplicate(doc, "model", where)
    assert doc.content.models[2].name == "a 3"


def test_skies_layers_areas_and_singles_are_pasted():
    doc, where = document(), Selection(sky=1)
    assert pasting.duplicate(doc, "sky", where) and where.sky == 2
    assert len({sky.state for sky in doc.content.layers[0].skies}) == 3
    assert pasting.duplicate(doc, "layer", where) and where.layer == 1
    parts = [RainArea((0, 0), (2, 1)), Wind(), Fog(5.0), Fog(6.0)]
    assert pasting.insert(doc, parts, where, "Things")
    content = doc.content
    assert len(content.rain_areas) == 1 and len(content.winds) == 1
    assert content.fog is not None and content.fog.visibility == 6.0
    assert pasting.delete(doc, "area", where) and doc.content.rain_areas == ()
    assert pasting.duplicate(doc, "wind", where) and where.wind == 1


def test_what_cannot_be_is_refused_and_nothing_changes():
    doc, where = document(), Selection()
    before = doc.content
    assert not pasting.delete(doc, "area", where)
    assert pasting.copy(doc, "area", where) is None
    assert not pasting.paste(doc, copied([Cloud("nobody", (0, 0, 0))]), where)
    assert doc.problem is not None and "nobody" in doc.problem
    assert not pasting.delete(doc, "seed", Selection(model=1))  # a model has one at least
    assert doc.content is before and where == Selection()
    empty = Document()
    assert not pasting.paste(empty, copied([ROOT]), where)
    assert not pasting.paste(empty, copied([Sky(0.0)]), where)
    model = replace(before.models[0], seeds=(SEED,) * 4096)
    full = Document(CloudFile((model,)))
    assert not pasting.paste(full, copied([SEED]), where) and "4096" in (full.problem or "")


def test_names_of_parts():
    assert kind_name([SEED]) == "seed" and kind_name([ROOT, ROOT]) == "2 roots"
    assert kind_name([Sky(0.0), Sky(0.1)]) == "2 skies" and kind_name([Wind()]) == "wind"
    assert kind_name([SEED, ROOT]) == "2 things"
    assert kind_name([RainArea((0, 0), (2, 1))]) == "rain area"


def test_keys_run_commands():
    done: list[str] = []
    commands = Commands()
    for command in COMMANDS:
        commands.bind(command.name, lambda name=command.name: done.append(name))
    for key, ctrl, shift, name in [
        ("S", True, False, "save"),
        ("s", True, True, "save_as"),
        ("Z", True, False, "undo"),
        ("z", True, True, "redo"),
        ("Y", True, False, "redo"),
        ("F1", False, False, "help"),
        ("Delete", False, False, "delete"),
    ]:
        assert commands.press(key, ctrl=ctrl, shift=shift)
        assert done.pop() == name
    assert not commands.press("S") and not commands.press("K", ctrl=True)
    assert not commands.press("S", ctrl=True, alt=True)
    assert done == []


def test_commands_that_cannot_be_done_are_not():
    done: list[int] = []
    commands = Commands()
    can = [False]
    commands.bind("undo", lambda: done.append(1), enabled=lambda: can[0], label=lambda: "Undo Fog")
    assert commands.press("Z", ctrl=True) and done == []
    assert not commands.is_enabled("undo") and not commands.run("undo")
    can[0] = True
    assert commands.run("undo") and done == [1]
    assert commands.label("undo") == "Undo Fog" and commands.label("redo") == "Redo"
    assert not commands.run("redo") and not commands.press("Y", ctrl=True)  # is not bound
    with pytest.raises(KeyError):
        commands.bind("nothing", lambda: None)


def test_menus_have_what_is_bound():
    commands = Commands()
    for name in ("new", "save", "reload", "undo", "help"):
        commands.bind(name, lambda: None)
    menus = {
        title: [None if command is None else command.name for command in group]
        for title, group in commands.menus()
    }
    assert menus == {"File": ["new", None, "reload", "save"], "Edit": ["undo"], "Help": ["help"]}


def test_no_two_commands_share_a_key_or_a_name():
    keys = [keys for command in COMMANDS for keys in (command.keys, *command.other_keys) if keys]
    assert len({key.lower() for key in keys}) == len(keys)
    assert len({command.name for command in COMMANDS}) == len(COMMANDS)
    assert all(isinstance(command, Command) and command.help.strip() for command in COMMANDS)
