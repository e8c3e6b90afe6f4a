"""Files of clouds: exact round trips, errors that say where and what, and fuzzing."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.cloud_texts import GOOD, QUICK, plain
from tests.toml_files import load
from weather_ecs import (
    CloudFile,
    WeatherFileError,
    load_cloud_model,
    load_clouds,
    save_cloud_model,
    save_clouds,
)
from weather_ecs.components import Climate, Cloud, CloudModel, CloudRoot, CloudSeed, Sky, SkyLayer


def test_a_file_is_what_it_says(tmp_path):
    got = load(tmp_path, GOOD)
    assert [model.name for model in got.models] == ["puffy", "flat"]
    puffy = got.models[0]
    assert (puffy.size_max, puffy.size_min, puffy.light_penetration) == (200.0, 60.0, math.inf)
    assert puffy.seeds[0].center == (0.0, 50.5, 0.0)
    assert puffy.seeds[0].roots[0].open_pitch == 20.25
    assert puffy.seeds[1].width == 250.0
    assert got.clouds[0].position == (1.0, 2.0, 3.0)
    assert got.layers[0].skies[1].models == ("flat", "cumulus")
    assert got.climate is not None
    assert got.climate.duration == 120.5
    assert load(tmp_path, "version = 1").climate is None


def test_what_is_saved_comes_back_to_the_bit(tmp_path):
    path = tmp_path / "saved.toml"
    first = load(tmp_path, GOOD)
    save_clouds(path, first)
    again = load_clouds(path)
    for name in ("models", "clouds", "layers", "climate"):
        assert plain(getattr(again, name)) == plain(getattr(first, name))
    text = path.read_text(encoding="utf-8")
    save_clouds(path, again)
    assert path.read_text(encoding="utf-8") == text


NUMBER = st.floats(-1e6, 1e6)
SIZE = st.floats(1e-3, 1e6)
ROOTS = st.builds(
    CloudRoot,
    pitch=st.floats(-360, 360),
    open_yaw=st.floats(0, 360),
    reproductions_max=st.integers(1, 9),
)
SEEDS = st.builds(
    CloudSeed,
    center=st.tuples(NUMBER, NUMBER, NUMBER),
    width=SIZE,
    depth=SIZE,
    roots=st.lists(ROOTS, max_size=3),
)
MODELS = st.builds(
    CloudModel,
    name=st.from_regex(r"[A-Za-z][A-Za-z0-9_ -]{0,63}", fullmatch=True),
    seeds=st.lists(SEEDS, min_size=1, max_size=4),
    size_min=st.floats(1e-3, 1.0),
    light_penetration=st.floats(5e-324, math.inf),
    aspect=st.floats(0.05, 20),
)


@QUICK
@given(MODELS)
def test_any_model_comes_back_to_the_bit(tmp_path, model):
    path = tmp_path / "model.toml"
    save_cloud_model(path, model)
    assert plain(load_cloud_model(path)) == plain(model)


def test_models_that_are_held_are_written_once_and_named(tmp_path):
    model = CloudModel("mine", (CloudSeed(),))
    layer = SkyLayer(skies=(Sky(0.5, (model, "cumulus"), count=3),))
    path = tmp_path / "held.toml"
    save_clouds(path, CloudFile((model,), (Cloud(model, (0, 1, 2)),), (layer,), Climate()))
    got = load_clouds(path)
    assert len(got.models) == 1
    assert got.clouds[0].model == "mine"
    assert got.layers[0].skies[0].models == ("mine", "cumulus")
    other = CloudModel("mine", (CloudSeed(),))
    before = path.read_bytes()
    with pytest.raises(WeatherFileError, match=r"mine.*differ"):
        save_clouds(path, CloudFile((model, other)))
    assert path.read_bytes() == before


def test_a_layer_with_no_room_for_a_model_of_its_file_is_refused(tmp_path):
    model = CloudModel("mine", (CloudSeed(width=900.0),))
    layer = SkyLayer(size=(800.0, 800.0), skies=(Sky(0.5, ("mine",), count=3),))
    with pytest.raises(WeatherFileError, match=r"layers\[0\]\.size.*mine: 100 by 900 m"):
        save_clouds(tmp_path / "narrow.toml", CloudFile((model,), layers=(layer,)))


def test_a_layer_with_no_room_for_a_model_of_the_package_is_refused(tmp_path):
    layer = SkyLayer(size=(9000.0, 4000.0), skies=(Sky(0.5, ("cumulonimbus",), count=3),))
    with pytest.raises(WeatherFileError, match=r"layers\[0\]\.size.*cumulonimbus: 5400 by 16800 m"):
        save_clouds(tmp_path / "narrow.toml", CloudFile((), layers=(layer,)))
    # A model of the file takes the place of the package's of that name.
    small = CloudModel("cumulonimbus", (CloudSeed(width=900.0),))
    save_clouds(tmp_path / "own.toml", CloudFile((small,), layers=(layer,)))


def test_the_example_of_the_documentation_loads(tmp_path):
    page = (Path(__file__).parent.parent / "docs" / "cloud-files.md").read_text(encoding="utf-8")
    got = load(tmp_path, page.partition("```toml\n")[2].partition("```")[0])
    assert got.models[0].seeds[0].roots[0].reproductions_max == 4
    assert got.layers[0].skies[1].models == ("tower", "cumulus")
