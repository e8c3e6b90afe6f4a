"""The editor's document: steps that can be taken back, gestures, and changes that are refused."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from weather_ecs import CloudFile
from weather_ecs.components import (
    Climate,
    Cloud,
    CloudModel,
    CloudRoot,
    CloudSeed,
    Fog,
    RainArea,
    Sky,
    SkyLayer,
)
from weather_ecs.editor import content as changes
from weather_ecs.editor.document import Document
from weather_ecs.editor.history import MOST_STEPS, History
from weather_ecs.errors import InvalidValueError


def model(name: str = "mine", seeds: int = 1, **values: object) -> CloudModel:
    return CloudModel(name, tuple(CloudSeed() for _ in range(seeds)), **values)  # type: ignore[arg-type]


def document() -> Document:
    layer = SkyLayer(skies=(Sky(0.0), Sky(1.0, ("mine", "cumulus"), count=3, weights=(1, 2))))
    return Document(CloudFile((model(), model("other")), (Cloud("mine", (0, 0, 0)),), (layer,)))


def set_opacity(doc: Document, value: float, merge: object = None) -> bool:
    return doc.try_apply(
        "Opacity",
        lambda: changes.with_item(
            doc.content, "models", 0, replace(doc.content.models[0], opacity=value)
        ),
        merge,  # type: ignore[arg-type]
    )


def test_a_step_is_taken_back_and_done_again():
    doc = document()
    before, revision = doc.content, doc.revision
    assert not doc.dirty and not doc.can_undo and doc.undo_label is None
    assert set_opacity(doc, 0.5)
    after = doc.content
    assert doc.dirty and doc.undo_label == "Opacity" and doc.revision != revision
    assert doc.undo() and doc.content is before and not doc.dirty
    assert doc.redo_label == "Opacity" and not doc.undo()
    assert doc.redo() and doc.content is after and not doc.redo()
    doc.undo()
    set_opacity(doc, 0.25)
    assert not doc.can_redo


def test_a_drag_is_one_step_and_the_next_drag_another():
    doc = document()
    for value in (0.9, 0.8, 0.7):
        set_opacity(doc, value, ("opacity", 0))
    assert doc.steps == ("Opacity",)
    doc.end_gesture()
    set_opacity(doc, 0.6, ("opacity", 0))
    assert doc.steps == ("Opacity", "Opacity")
    set_opacity(doc, 0.5, ("opacity", 1))
    set_opacity(doc, 0.4)
    set_opacity(doc, 0.3)
    assert len(doc.steps) == 5
    doc.undo()
    set_opacity(doc, 0.2, ("opacity", 1))  # what came before an undo is over
    assert len(doc.steps) == 5
    for _ in range(4):
        doc.undo()
    assert doc.content.models[0].opacity == 0.7
    doc.undo()
    assert doc.content.models[0].opacity == 1.0


def test_a_bad_value_changes_nothing_and_is_a_problem_where_it_is():
    doc = document()
    before = doc.content
    assert not set_opacity(doc, 2.0, "here")
    assert doc.content is before and not doc.can_undo
    assert doc.problem == "CloudModel.opacity: got 2.0, allowed: a number >= 0 and <= 1"
    assert doc.problem_at("here") == doc.problem and doc.problem_at("there") is None
    assert doc.error is not None and doc.error.field == "CloudModel.opacity"
    assert set_opacity(doc, 0.5) and doc.problem is None


@pytest.mark.parametrize(
    ("bad", "words"),
    [
        ({"models": (model("a"), model("a"))}, r"models\[1\].name: got 'a'"),
        ({"models": (model(images=("plume",)),)}, r"models\[0\].images: got 'plume'"),
        ({"models": (), "clouds": (Cloud("gone", (0, 0, 0)),)}, r"clouds\[0\].model: got 'gone'"),
        ({"layers": (SkyLayer(skies=(Sky(0.0, ("gone",)),)),)}, r"skies\[0\].models: got 'gone'"),
        ({"rain_areas": [RainArea((0, 0), (1, 1))]}, "rain_areas: got .*a tuple of RainArea"),
        ({"fog": RainArea((0, 0), (1, 1))}, "fog: got .*a Fog or None"),
        ({"layer_climates": (None, Climate())}, "layer_climates: .*not longer than the layers"),
        ({"quality": "best"}, "quality: got 'best'.*low, medium"),
        ({"extra": [1]}, "extra: .*a table"),
    ],
)
def test_what_no_file_can_hold_is_refused(bad, words):
    doc = document()
    before = doc.content
    assert not doc.apply("Bad", replace(before, **bad))
    assert doc.content is before
    with pytest.raises(InvalidValueError, match=words):
        changes.check(replace(before, **bad), before)


def test_ten_thousand_steps_are_all_taken_back_and_stay_small():
    doc = Document(CloudFile(tuple(model(f"m{k}", 20) for k in range(50))))
    first = doc.content
    for number in range(MOST_STEPS):
        at, seed = number % 50, number % 20
        old = doc.content.models[at].seeds[seed]
        changed = replace(old, width=1.0 + number)
        doc.apply("Width", changes.with_seed(doc.content, at, seed, changed))
        if number == 100:
            tracemalloc.start()
        elif number == 300:
            used, _ = tracemalloc.get_traced_memory()
            tracemalloc.stop()
            assert used < 200 * 4000  # bytes a step: what has not changed is shared
    last = doc.content
    assert sum(doc.undo() for _ in range(MOST_STEPS + 1)) == MOST_STEPS
    assert doc.content is first and not doc.dirty
    assert sum(doc.redo() for _ in range(MOST_STEPS + 1)) == MOST_STEPS
    assert doc.content is last
    doc.apply("More", replace(last, fog=Fog()))
    assert len(doc.steps) == MOST_STEPS


def test_steps_of_huge_models_take_no_more_than_a_budget(monkeypatch):
    monkeypatch.setattr("weather_ecs.editor.history.MOST_BYTES", 200_000)
    doc = Document(CloudFile((model("huge", 4096),)))  # 32 KiB of references alone
    for number in range(20):
        doc.apply("Name", changes.rename_model(doc.content, 0, f"huge {number}"))
    assert 3 <= len(doc.steps) <= 6
    assert doc.undo() and doc.content.models[0].name == "huge 18"
    assert doc.redo() and doc.content.models[0].name == "huge 19"
    monkeypatch.setattr("weather_ecs.editor.history.MOST_BYTES", 1)
    doc.apply("Name", changes.rename_model(doc.content, 0, "last"))
    assert doc.steps == ("Name",) and doc.undo()  # the last one is kept whatever it takes


def test_a_saved_state_is_clean_again_after_undo_and_redo():
    doc = document()
    set_opacity(doc, 0.5)
    doc.mark_saved(None, "text")
    set_opacity(doc, 0.4)
    assert doc.dirty
    doc.undo()
    assert not doc.dirty
    doc.undo()
    assert doc.dirty
    doc.redo()
    assert not doc.dirty
    doc.mark_unsaved()
    assert doc.dirty


def test_what_has_not_changed_is_the_same_object():
    doc = document()
    before = doc.content
    set_opacity(doc, 0.5)
    assert doc.content.models[1] is before.models[1]
    assert doc.content.layers is before.layers
    assert doc.content.models[0].seeds[0] is before.models[0].seeds[0]
    revision = doc.revision
    assert doc.apply("Nothing", doc.content) and doc.revision == revision


def test_renaming_a_model_renames_it_where_it_is_used():
    got = changes.rename_model(document().content, 0, "yours")
    assert [each.name for each in got.models] == ["yours", "other"]
    assert got.clouds[0].model == "yours"
    assert got.layers[0].skies[1].models == ("yours", "cumulus")
    assert got.layers[0].skies[1].weights == (1.0, 2.0)
    assert changes.users(got, "yours") == 2 and changes.users(got, "mine") == 0
    with pytest.raises(InvalidValueError, match="no other model has"):
        changes.rename_model(got, 0, "other")


def test_a_deleted_model_leaves_what_used_it():
    got = changes.without(document().content, "models", 0)
    changes.check(got)
    assert got.clouds == ()
    assert got.layers[0].skies[1].models == ("cumulus",)
    assert got.layers[0].skies[1].weights == (2.0,)
    alone = CloudFile((model(),), (), (SkyLayer(skies=(Sky(0.5, ("mine",), count=9),)),))
    assert changes.without(alone, "models", 0).layers[0].skies[0].count == 0
    own = CloudFile((model("cumulus"),), (Cloud("cumulus", (0, 0, 0)),))
    assert len(changes.without(own, "models", 0).clouds) == 1  # the package's own serves


def test_layers_keep_their_own_climates_when_they_move():
    climates = [Climate(duration=d) for d in (1.0, 2.0)]
    layers = tuple(SkyLayer(base=base) for base in (10.0, 20.0, 30.0))
    start = CloudFile(layers=layers, layer_climates=(climates[0], climates[1]))

    def pairs(content: CloudFile) -> list[tuple[float, float | None]]:
        changes.check(content)
        own = [changes.layer_climate(content, k) for k in range(len(content.layers))]
        return [
            (layer.base, None if c is None else c.duration)
            for layer, c in zip(content.layers, own, strict=True)
        ]

    assert pairs(start) == [(10, 1), (20, 2), (30, None)]
    assert pairs(changes.without(start, "layers", 0)) == [(20, 2), (30, None)]
    assert pairs(changes.moved(start, "layers", 0, 2)) == [(20, 2), (30, None), (10, 1)]
    new = changes.with_new(start, "layers", SkyLayer(base=5.0), 1)
    assert pairs(new) == [(10, 1), (5, None), (20, 2), (30, None)]
    assert pairs(changes.with_layer_climate(start, 2, climates[0]))[2] == (30, 1)


def test_free_names():
    content = CloudFile(tuple(model(name) for name in ("a", "a 2", "b 7")))
    assert changes.free_name(content, "c") == "c"
    assert changes.free_name(content, "a") == "a 3"
    assert changes.free_name(content, "b 7") == "b 2"
    long = "x" * 64
    named = changes.free_name(CloudFile((model(long),)), long)
    assert replace(model(), name=named).name == named != long


def test_a_model_of_many_roots_can_be_edited():
    seeds = (CloudSeed(roots=(CloudRoot(),) * 8),) * 100
    doc = Document(CloudFile((CloudModel("big", seeds),)))
    changed = replace(seeds[50], roots=())
    assert doc.apply("Roots", changes.with_seed(doc.content, 0, 50, changed))
    assert [len(seed.roots) for seed in doc.content.models[0].seeds].count(0) == 1


@settings(deadline=None, max_examples=60)
@given(st.lists(st.sampled_from(["push", "merge", "end", "undo", "redo"]), max_size=40))
def test_a_history_is_a_list_with_a_place_in_it(actions):
    history: History[int] = History(0, most=6)
    past, future, value, open_key = [], [], 0, False
    for number, action in enumerate(actions, 1):
        if action in ("push", "merge"):
            if action == "push" or not open_key or future or not past:
                past.append(value)
            value, future = number, []
            open_key = action == "merge"
            history.push("x", number, "key" if action == "merge" else None)
        elif action == "end":
            history.end_gesture()
            open_key = False
        elif action == "undo":
            open_key = False
            assert history.undo() is bool(past)
            if past:
                future.append(value)
                value = past.pop()
        else:
            open_key = False
            assert history.redo() is bool(future)
            if future:
                past.append(value)
                value = future.pop()
        past = past[-6:]
        assert history.state == value
        assert len(history.steps) == len(past)
