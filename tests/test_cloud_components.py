"""The components of clouds, skies and climate: each field, their agreement, what they hold."""

from __future__ import annotations

import copy
import dataclasses
import math

import esper
import numpy as np
import pytest

from tests.cloud_fields import FIELDS, MAKE
from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import (
    Climate,
    Cloud,
    CloudModel,
    CloudRoot,
    CloudSeed,
    Sky,
    SkyLayer,
)
from weather_ecs.errors import InvalidValueError, SnapshotError

NAN, INF = math.nan, math.inf
ODD = [NAN, -INF, None, "5", True, 1j, np.ones(1), 10**400]
CASES = [(kind, name, *values) for kind, them in FIELDS.items() for name, values in them.items()]


def test_every_field_is_among_the_cases():
    for kind, them in FIELDS.items():
        assert list(them) == [field.name for field in dataclasses.fields(kind)]
        assert list(them) == list(kind.checks)


def test_a_model_without_seeds_is_refused_with_what_is_missing():
    with pytest.raises(InvalidValueError, match="at least one seed"):
        CloudModel()
    assert CloudModel(seeds=[CloudSeed()]).name == "cloud"


def test_two_models_of_one_name_in_a_sky_are_refused():
    one, other = CloudModel(seeds=[CloudSeed()]), CloudModel(seeds=[CloudSeed(width=7.0)])
    for models in ((one, other), (one, one), (one, "cloud")):
        with pytest.raises(InvalidValueError, match="two called 'cloud'"):
            Sky(0.5, models, count=1)
    assert Sky(0.5, ("cumulus", "cumulus", one), count=1).models[2] is one


@pytest.mark.parametrize(("kind", "name", "good", "bad"), CASES)
def test_good_values_are_taken(kind, name, good, bad):
    for value in good:
        it = kind(**MAKE[kind])
        setattr(it, name, value)
        got = getattr(it, name)
        assert type(got) is type(getattr(kind(**MAKE[kind]), name)) or name == "model"
        if not isinstance(got, tuple):
            assert got == pytest.approx(value) if isinstance(got, float) else got == value
        else:
            assert len(got) == len(value)


@pytest.mark.parametrize(("kind", "name", "good", "bad"), CASES)
def test_bad_values_name_the_component_and_change_nothing(kind, name, good, bad):
    it = kind(**MAKE[kind])
    before = getattr(it, name)
    odd = [value for value in ODD if not (isinstance(before, bool) and value is True)]
    for value in [*bad, *odd]:
        with pytest.raises(InvalidValueError, match=f"{kind.__name__}.*allowed"):
            setattr(it, name, value)
        assert getattr(it, name) is before
        with pytest.raises(ValueError, match=kind.__name__):
            kind(**{**MAKE[kind], name: value})
    with pytest.raises(AttributeError):
        it.no_such_field = 1


def test_too_many_descendants_are_refused_with_their_count():
    with pytest.raises(InvalidValueError, match=r"20000000 descendants.*1000000"):
        CloudRoot(reproductions_max=10_000, seeds_start=2000, seeds_end=2000)
    root = CloudRoot(reproductions_max=1000, seeds_start=1000, seeds_end=1000)
    assert root.descendants() == 1_000_000
    with pytest.raises(InvalidValueError, match="1001000 descendants"):
        root.seeds_end = 1002  # on average 1001 a level: 1 001 000
    with pytest.raises(InvalidValueError, match="1000001 seeds"):
        CloudModel("big", (CloudSeed(roots=(root,)),))
    small = CloudRoot(reproductions_max=100, seeds_start=100, seeds_end=100)
    with pytest.raises(InvalidValueError, match="10001000 billboards"):
        CloudModel("big", (CloudSeed(roots=(small,)),), billboards_max=1000)


@pytest.mark.parametrize(
    ("levels", "start", "end", "count"), [(0, 5, 5, 0), (1, 3, 9, 3), (2, 3, 1, 4), (4, 0, 3, 6)]
)
def test_descendants_are_the_most_that_a_root_adds(levels, start, end, count):
    root = CloudRoot(
        reproductions_min=0, reproductions_max=levels, seeds_start=start, seeds_end=end
    )
    assert root.descendants() == count


def test_fields_that_depend_on_each_other_change_together():
    model = CloudModel("a", (CloudSeed(),))
    model.change(size_min=500.0, size_max=900.0)
    assert (model.size_min, model.size_max) == (500.0, 900.0)
    with pytest.raises(InvalidValueError, match="size_min"):
        model.change(darkness=0.5, size_min=1000.0)
    assert (model.darkness, model.size_min) == (0.0, 500.0)
    sky = Sky(0.5, ("a",), count=5, weights=(1.0,))
    sky.change(models=("a", "b"), weights=(1, 2))
    with pytest.raises(InvalidValueError, match=r"Sky\.weights"):
        sky.models = ("a",)
    with pytest.raises(InvalidValueError, match=r"Sky\.count"):
        sky.change(models=(), weights=())


def test_the_revision_counts_what_is_set_inside():
    root = CloudRoot()
    CloudModel("a", (CloudSeed(roots=(root,)),))
    before = CloudModel.revision()
    root.pitch = 45
    assert CloudModel.revision() > before


def test_copies_hold_the_same_and_are_checked():
    model = CloudModel("a", (CloudSeed(roots=(CloudRoot(pitch=30),)),), size_max=500)
    for it in (copy.copy(model), copy.deepcopy(model)):
        assert it.size_max == 500
        assert it.seeds[0].roots[0].pitch == 30
        with pytest.raises(InvalidValueError):
            it.size_min = 501
    assert copy.deepcopy(model).seeds[0] is not model.seeds[0]


def test_a_snapshot_holds_models_skies_and_climate():
    root = CloudRoot(pitch=12.3456789, open_yaw=40)
    model = CloudModel("mine", (CloudSeed((1, 2, 3), roots=(root,)),), light_penetration=INF)
    skies = (Sky(0.1), Sky(0.9, ("cumulus", model), count=40, weights=(1, 2)))
    with fresh_world(), Weather() as weather:
        entity = esper.create_entity(SkyLayer(skies=skies), Climate(speed=-2.0, elapsed=30.0))
        esper.create_entity(model)
        cloud = Cloud(model, (0, 900, 0), number=3)
        esper.create_entity(cloud)
        data = weather.snapshot()
        model.change(size_min=5000, size_max=6000)
        cloud.model = "cumulus"
        esper.delete_entity(entity, immediate=True)
        weather.restore(data)
        assert weather.snapshot() == data
        [(_, layer)] = esper.get_component(SkyLayer)
        inner = layer.skies[1].models[1]
        assert inner.light_penetration == INF
        assert inner.seeds[0].roots[0].pitch == 12.3456789
        assert (model.size_min, model.size_max) == (60.0, 120.0)
        assert cloud.model.seeds[0].center == (1.0, 2.0, 3.0)
        assert cloud.number == 3


def test_a_snapshot_with_values_nested_too_deeply_is_refused():
    from weather_ecs import snapshot

    with fresh_world(), Weather() as weather:
        esper.create_entity(Climate())
        document = snapshot.decode(weather.snapshot())
        deep: list = []
        for _ in range(300):
            deep = [deep]
        document["entities"][0][1]["Climate"]["speed"] = deep
        with pytest.raises(SnapshotError, match="deep"):
            weather.restore(snapshot.encode(document))


def test_a_rectangle_smaller_than_a_cloud_is_refused() -> None:
    seeds = (CloudSeed((-300.0, 0.0, 0.0), 400.0, 100.0, 500.0), CloudSeed((300.0, 0.0, 100.0)))
    model = CloudModel("wide", seeds)
    assert model.span() == (850.0, 500.0)
    skies = (Sky(0.0, (model,), count=3),)
    with pytest.raises(InvalidValueError, match=r"SkyLayer\.size.*wide: 500 by 850 m"):
        SkyLayer(size=(2000.0, 499.0), skies=skies)
    layer = SkyLayer(size=(500.0, 850.0), skies=skies)  # it may be turned
    with pytest.raises(InvalidValueError, match="wide"):
        layer.size = (800.0, 800.0)
    assert layer.size == (500.0, 850.0)
    # What a name means is known to who looks it up.
    SkyLayer(size=(1.0, 1.0), skies=(Sky(0.0, ("wide",), count=3),))
