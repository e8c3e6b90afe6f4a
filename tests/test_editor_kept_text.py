"""A file's own text: what has not changed is written as it was."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from tests.editor_texts import WRITTEN
from tests.file_values import contents
from weather_ecs import CloudFile
from weather_ecs.cloud_files import read_content
from weather_ecs.components import Climate, CloudModel, CloudSeed, RainArea, Wind
from weather_ecs.editor import content as changes
from weather_ecs.editor.kept_text import kept_text, match
from weather_ecs.file_tables import document_of

QUICK = settings(
    deadline=None,
    max_examples=60,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)


def kept(content: CloudFile) -> str:
    return kept_text("f", WRITTEN, read_content("f", WRITTEN), content)


def lines_gone(text: str) -> list[str]:
    """Lines of WRITTEN that are missing in the text, whatever their order."""
    rest = text.splitlines()
    gone = []
    for line in WRITTEN.splitlines():
        if line in rest:
            rest.remove(line)
        elif line:
            gone.append(line)
    return gone


def test_what_has_not_changed_is_written_as_it_was():
    assert kept(read_content("f", WRITTEN)) == WRITTEN


def test_a_value_changes_in_its_line_alone():
    content = read_content("f", WRITTEN)
    got = kept(changes.with_item(content, "models", 0, replace(content.models[0], size_max=300.5)))
    assert got == WRITTEN.replace("size_max = 200", "size_max = 300.5")
    got = kept(changes.rename_model(content, 0, "spire"))
    assert got == WRITTEN.replace('name = "tower"  #', 'name = "spire"  #')
    seed = replace(content.models[0].seeds[0], center=(1.0, 50.5, 0.0))
    got = kept(changes.with_seed(content, 0, 0, seed))
    assert got == WRITTEN.replace("[0, 50.5, 0]", "[1.0, 50.5, 0.0]")
    got = kept(replace(content, climate=replace(content.climate, duration=3.0)))
    assert got == WRITTEN.replace("120.5 #", "3.0 #")


def test_a_new_value_stands_last_in_its_table():
    content = read_content("f", WRITTEN)
    got = kept(changes.with_item(content, "models", 0, replace(content.models[0], opacity=0.5)))
    assert got == WRITTEN.replace('x_note = "keep"\n', 'x_note = "keep"\nopacity = 0.5\n')


def test_what_is_deleted_takes_its_own_comments_along():
    content = read_content("f", WRITTEN)
    got = kept(changes.without(content, "models", 0))
    assert "The tall one" not in got and "lower box" not in got and "models.x_own" not in got
    assert "==== the flat one ====" in got and "# made by hand" in got and "# storm" in got
    got = kept(replace(content, climate=None))
    assert lines_gone(got) == ["[climate]", "duration = 120.5 # s"]
    got = kept(changes.with_seed(content, 0, 0, replace(content.models[0].seeds[0], roots=())))
    assert lines_gone(got) == ["[[models.seeds.roots]]", "pitch = 90"]


def test_models_take_their_comments_to_another_place():
    content = read_content("f", WRITTEN)
    got = kept(changes.moved(content, "models", 0, 1))
    assert lines_gone(got) == []
    assert got.index("the flat one") < got.index("The tall one") < got.index("[[layers]]")


def test_seeds_of_one_line_are_written_out_when_they_change():
    content = read_content("f", WRITTEN)
    model = content.models[1]
    new = replace(model, seeds=(CloudSeed(), *model.seeds))
    got = kept(changes.with_item(content, "models", 1, new))
    assert lines_gone(got) == ["seeds = [ {height = 5e-1, x_q = 3, roots = [{pitch = 5}]} ]"]
    assert "x_q = 3" in got and "height = 0.5" in got
    got = kept(changes.with_layer_climate(content, 0, Climate(duration=6.0)))
    assert lines_gone(got) == ["climate.duration = 5"]
    assert "[layers.climate]\nduration = 6.0\n" in got


def test_new_tables_come_where_their_like_are_or_last():
    content = read_content("f", WRITTEN)
    third = CloudModel("third", (CloudSeed(),))
    got = kept(changes.with_new(content, "models", third))
    assert lines_gone(got) == []
    assert got.index('"flat"') < got.index('"third"') < got.index("[[layers]]")
    got = kept(replace(content, rain_areas=(RainArea((0, 0), (2, 1)),), quality="low"))
    assert lines_gone(got) == []
    assert got.index("[climate]") < got.index("[[rain_areas]]")
    assert got.index('quality = "low"') < got.index("[[models]]")


@pytest.mark.parametrize(
    "text",
    [
        "version = 2\n[climate.x_mine]\na = 1 # one\n",
        "version = 2\n[[layers]]\n[layers.climate.x_mine]\na = 1 # one",
        "version = 2\nclimate.x_mine.a = 1 # one\n",
        "'version' = 2\n[\"climate\"] # one\n",
        "version = 0x2\nclimate = {x_mine = {a = 1}} # one\n[[layers]]\n",
        "version = 2\n[[layers]]\n[extra] # one\n[[layers.skies]]\nstate = 1\n",
    ],
)
def test_ways_of_writing_that_few_know(text, monkeypatch):
    content = read_content("f", text)
    changed = replace(content, climate=Climate(duration=7.0), winds=(Wind(),))
    if content.layers:
        changed = changes.with_layer_climate(changed, 0, Climate(duration=8.0))
    monkeypatch.setattr("weather_ecs.editor.kept_text.text_of", None)  # nothing is written anew
    got = kept_text("f", text, content, changed)
    assert repr(document_of(read_content("f", got))) == repr(document_of(changed))
    assert "# one" in got or "climate.x_mine.a" in text or "{x_mine" in text
    assert ("x_mine" in got) == ("x_mine" in text)


@settings(QUICK, max_examples=25, phases=[Phase.generate])
@given(contents(), contents(), st.data())
def test_any_change_is_written_and_comments_stay(before, after, data):
    """Parts of two files, in any mixture, over a text with a comment on every line."""
    plain = "\n".join(f"{line}  # {n}" if line[-1:] not in ("", "[", ",") else line
                      for n, line in enumerate(_text(before).split("\n")))  # fmt: skip
    assert repr(document_of(read_content("f", plain))) == repr(document_of(before))
    names = ["rain_areas", "winds", "fog", "air", "sun", "climate", "extra", "quality"]
    other = {name: getattr(after, name) for name in names if data.draw(st.booleans())}
    mixed = replace(before, **other)
    if data.draw(st.booleans()) and before.models:
        models = data.draw(st.permutations(before.models))
        mixed = replace(mixed, models=tuple(models))
    if data.draw(st.booleans()):
        mixed = replace(mixed, layers=mixed.layers[::-1], layer_climates=())
    got = kept_text("f", plain, before, mixed)
    assert repr(document_of(read_content("f", got))) == repr(document_of(mixed))
    assert "version = 2  # 0\n" in got  # it is not written anew as a whole
    for number, line in enumerate(plain.split("\n")):  # of what nobody has touched
        if line.startswith("name = "):
            assert line in got, number


def _text(content: CloudFile) -> str:
    from weather_ecs.cloud_files import text_of

    return text_of("f", content)


@QUICK
@given(st.lists(st.sampled_from("abcd"), max_size=6), st.lists(st.sampled_from("abcd"), max_size=6))
def test_things_are_matched_once_each(old, new):
    a = [{"name": name, "x": k} for k, name in enumerate(old)]
    b = [{"name": name, "x": -k} for k, name in enumerate(new)]
    pairs = match(a, b)
    taken = [at for at in pairs if at is not None]
    assert len(set(taken)) == len(taken)
    for item, at in zip(b, pairs, strict=True):
        if at is None:
            assert new.count(item["name"]) > old.count(item["name"]) or not old
    assert match(a, a) == list(range(len(a)))


def test_of_a_text_that_cannot_be_kept_the_opening_stays(monkeypatch):
    content = read_content("f", WRITTEN)
    monkeypatch.setattr("weather_ecs.editor.toml_tree.Node.set", lambda *_: None)
    got = kept(changes.with_item(content, "models", 0, replace(content.models[0], size_max=300.5)))
    assert got.startswith("# An evening by the sea\n# made by hand\n")
    assert read_content("f", got).models[0].size_max == 300.5
