"""Files of a whole weather: version 2, what came before it, worlds saved and loaded, fuzzing."""

from __future__ import annotations

from datetime import date, datetime, timedelta, timezone
from datetime import time as clock
from pathlib import Path
from typing import Any

import esper
import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from tests.file_values import changed, contents
from tests.toml_files import load, refused
from tests.worlds import fresh_world
from weather_ecs import CloudFile, Weather, WeatherFileError, load_clouds, presets, save_clouds
from weather_ecs.components import (
    Air,
    Atmosphere,
    Climate,
    Cloud,
    CloudModel,
    CloudSeed,
    Fog,
    RainArea,
    Sky,
    SkyLayer,
    Wind,
)
from weather_ecs.file_content import ONE
from weather_ecs.file_tables import VERSION, document_of

QUICK = settings(
    deadline=None,
    max_examples=60,
    derandomize=True,
    phases=[Phase.explicit, Phase.generate],  # a failure is told at once, not made small
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
WHOLE = """version = 2
quality = "high"
x_by = "me"

[[models]]
name = "mine"
x_note = {kept = true}
[[models.seeds]]
x_n = 1

[[layers]]
base = 900
[layers.climate]
duration = 50
[[layers.skies]]
state = 0.5
models = ["mine"]

[[layers]]
base = 4000

[[rain_areas]]
center = [1, 2]
radii = [300, 200]

[[winds]]
speed = 7
law = "gust"

[[winds]]
speed = 2

[air]
temperature = -3

[fog]
visibility = 800
color = [0.5, 0.5, 0.5]

[atmosphere]
time = 2025-12-24T17:30:00Z
latitude = 52.5

[sun]
color = [1, 1, 1]

[extra]
level = "village"
[extra.music]
loud = 0.5
"""


def test_a_file_of_a_whole_weather(tmp_path):
    got = load(tmp_path, WHOLE)
    assert got.quality == "high"
    assert [None if c is None else c.duration for c in got.layer_climates] == [50.0, None]
    assert got.rain_areas[0].radii == (300.0, 200.0)
    assert [(wind.speed, wind.law) for wind in got.winds] == [(7, "gust"), (2, "constant")]
    assert got.air is not None and got.air.temperature == -3.0
    assert got.fog is not None and got.fog.color == (0.5, 0.5, 0.5)
    assert got.atmosphere is not None and got.atmosphere.time == 1766597400.0
    assert got.extra == {"level": "village", "music": {"loud": 0.5}}
    assert got.climate is None and got.lightning is None


@QUICK
@given(contents())
def test_any_file_comes_back_to_the_bit(tmp_path, content):
    path = tmp_path / "any.toml"
    save_clouds(path, content)
    again = load_clouds(path)
    assert repr(document_of(again)) == repr(document_of(content))
    text = path.read_bytes()
    save_clouds(path, again)
    assert path.read_bytes() == text


# A change of WHOLE, the line and key that the error names, and words of what is allowed.
BAD = [
    ('quality = "high"', 'quality = "best"', 2, "quality", "low, medium"),
    ("speed = 7", "speed = -7", 27, "winds[0].speed", ">= 0 and <= 150"),
    ('law = "gust"', 'law = "blow"', 28, "winds[0].law", "constant, gust, steady"),
    ("radii = [300, 200]", "radii = [200, 300]", 24, "rain_areas[0].radii", "a >= b"),
    ("center = [1, 2]", "", 22, "rain_areas[0].center", "every RainArea has one"),
    ("[air]", "[[air]]", 33, "air", "a table with the fields of Air"),
    ("duration = 50", "duration = 0", 14, "layers[0].climate.duration", "> 0"),
    ("duration = 50", "length = 1", 14, "layers[0].climate.length", "duration"),
    ("[layers.climate]", "[[layers.climate]]", 13, "layers[0].climate", "fields of Climate"),
    ("time = 2025-12-24T17:30:00Z", 'time = "noon"', 41, "atmosphere.time", "ISO|UTC"),
    ("time = 2025-12-24T17:30:00Z", "time = 07:32:00", 41, "atmosphere.time", "number"),
    ("color = [0.5, 0.5, 0.5]", 'color = "grey"', 38, "fog.color", "3 numbers"),
    ("[extra]\nlevel", "extra = 3\n[x_extra]\nlevel", None, "sun.extra", "the keys"),
    ('x_by = "me"', 'by = "me"', 3, "by", "begin with x_"),
    ('x_note = {kept = true}', "note = 1", 7, "models[0].note", "begin with x_"),
    ("[sun]", "[sum]", 44, "sum", "sun"),
    ("version = 2", "version = 3", 1, "version", "1 to 2"),
    ("version = 2", "version = 1", 2, "quality", "version, models, clouds, layers, climate"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "line", "key", "allowed"), BAD)
def test_bad_values_are_named_with_line_key_and_what_is_allowed(
    tmp_path, old, new, line, key, allowed
):
    assert old in WHOLE
    error = refused(tmp_path, WHOLE.replace(old, new, 1))
    assert (error.key, error.line if line else None) == (key, line)
    shown = str(error).partition("allowed: ")[2]
    assert any(word in shown for word in allowed.split("|"))


def test_a_file_of_version_1_is_taken_as_it_was_meant(tmp_path):
    old = "version = 1\n[[layers]]\nbase = 5\n[climate]\nduration = 9\n"
    got = load(tmp_path, old)
    assert got.layers[0].base == 5.0 and got.climate is not None and got.climate.duration == 9.0
    save_clouds(tmp_path / "new.toml", got)
    assert f"version = {VERSION}\n" in (tmp_path / "new.toml").read_text()
    for more in ("[fog]\n", "[[winds]]\n", "[extra]\n", "quality = 'low'\n"):
        assert "allowed: the keys" in str(refused(tmp_path, old.partition("[[")[0] + more))
    own = "version = 1\n[[layers]]\n[layers.climate]\n"
    assert refused(tmp_path, own).key == "layers[0].climate"
    assert load(tmp_path, "version = 1\nx_anything = 5\n") == CloudFile()


def test_a_world_is_saved_and_loaded_exactly(tmp_path):
    first, second = tmp_path / "first.toml", tmp_path / "second.toml"
    with fresh_world(), Weather(seed=4) as weather:
        weather.load(_written(tmp_path, WHOLE))
        esper.create_entity(Climate(duration=77.0, elapsed=3.3))
        esper.create_entity(Cloud("cumulonimbus", (1.0, 900.0, 2.0)))
        esper.process(3.0)  # the cloud brings rain of its own
        assert len(esper.get_component(RainArea)) == 2
        weather.save(first)
        content = load_clouds(first)
    assert len(content.rain_areas) == 1 and content.rain_areas[0].radii == (300.0, 200.0)
    assert content.climate is not None and content.climate.duration == 77.0
    assert [None if c is None else c.duration for c in content.layer_climates] == [50.0, None]
    with fresh_world(), Weather(seed=4) as weather:
        weather.load(first)
        weather.save(second)
        assert second.read_bytes() == first.read_bytes()
        with fresh_world(), Weather(seed=4) as twin:
            twin.load(second)
            esper.process(2.0)
            states = [twin.snapshot()]
        with fresh_world(), Weather(seed=4) as twin:
            twin.load(first)
            esper.process(2.0)
            assert twin.snapshot() == states[0]


def test_a_layers_own_climate_is_not_everybodys():
    with fresh_world(), Weather() as weather:
        layers = (SkyLayer(skies=(Sky(0.0),)),) * 1 + (SkyLayer(skies=(Sky(0.0),)),)
        own = Climate(0.9, 0.9)
        weather.add(CloudFile(layers=layers, layer_climates=(own,), climate=Climate(0.25, 0.25)))
        assert weather.stats.state == 0.25
        for entity, climate in esper.get_component(Climate):
            if climate is not own:
                esper.delete_entity(entity, immediate=True)
        assert weather.stats.state == 0.9  # of all there are the oldest


def test_of_what_counts_once_the_oldest_is_saved(tmp_path):
    path = tmp_path / "one.toml"
    with fresh_world(), Weather() as weather:
        esper.create_entity(Fog(10.0))
        esper.create_entity(Fog(20.0), Air(3.0))
        weather.save(path)
    got = load_clouds(path)
    assert got.fog is not None and got.fog.visibility == 10.0
    assert got.air is not None and got.air.temperature == 3.0


def test_loading_leaves_the_quality_alone(tmp_path):
    with fresh_world(), Weather(quality="low") as weather:
        weather.load(_written(tmp_path, 'version = 2\nquality = "ultra"\n'))
        assert weather.quality == "low"


def test_a_bad_content_is_neither_added_nor_saved(tmp_path):
    bad = CloudFile(clouds=(Cloud("nothing", (0, 0, 0)),))
    path = tmp_path / "bad.toml"
    with pytest.raises(WeatherFileError, match=r"bad.toml: clouds\[0\].model: got 'nothing'"):
        save_clouds(path, bad)
    zone = timezone(timedelta(hours=1))
    for extra in (
        *({"a": None}, {"a": {"b": object()}}, {"a": [b"x"]}, {5: 6}, {"a": "\ud800"}),
        *({"a": clock(7, 30, tzinfo=zone)}, {"a": 10**5000}),
    ):
        with pytest.raises(WeatherFileError, match=r"bad.toml: extra: .*cannot hold"):
            save_clouds(path, CloudFile(extra=extra))
    deep: Any = 1
    for _ in range(5000):
        deep = [deep]
    with pytest.raises(WeatherFileError, match="deeper"):
        save_clouds(path, CloudFile(extra={"deep": deep}))
    assert not path.exists()
    with fresh_world(), Weather() as weather:
        with pytest.raises(Exception, match="nothing"):
            weather.add(bad)
        assert not esper.get_component(Cloud)


def test_extra_holds_whatever_toml_does(tmp_path):
    extra = {
        "a key": [1, 2.5, "x", True, [], {}, [{"b": 1}]],
        "when": datetime(2025, 1, 2, 3, 4, 5, tzinfo=timezone(timedelta(hours=1))),
        "day": date(2025, 1, 2),
        "at": clock(7, 30),
        "few": np.float64(0.1),
        "": {"ä": "é \x7f \n\t\"'"},
    }
    save_clouds(tmp_path / "extra.toml", CloudFile(extra=extra))
    assert load_clouds(tmp_path / "extra.toml").extra == extra


def test_every_preset_of_a_sky_comes_back(tmp_path):
    for name in presets.SKIES:
        content = presets.sky(name)
        save_clouds(tmp_path / "sky.toml", content)
        assert repr(document_of(load_clouds(tmp_path / "sky.toml"))) == repr(document_of(content))


def test_long_lists_are_written_in_short_lines(tmp_path):
    names = [f"model {number:03} {'x' * 50}" for number in range(64)]
    models = tuple(CloudModel(name, (CloudSeed(),)) for name in names)
    content = CloudFile(models, layers=(SkyLayer(skies=(Sky(0.5, names, weights=[1] * 64),)),))
    save_clouds(tmp_path / "long.toml", content)
    assert load_clouds(tmp_path / "long.toml").layers[0].skies[0].models == tuple(names)


@settings(QUICK, max_examples=250)
@given(changed(WHOLE))
def test_changed_files_are_good_or_refused(tmp_path, text):
    try:
        got = load(tmp_path, text.encode("utf-8", "surrogatepass"))
    except WeatherFileError as error:
        assert str(tmp_path) in str(error)
        return
    save_clouds(tmp_path / "again.toml", got)  # a file that is taken is good from end to end
    assert repr(document_of(load_clouds(tmp_path / "again.toml"))) == repr(document_of(got))


KINDS = [*ONE, "winds", "rain_areas", "clouds", "layers", "models", "extra", "quality", "version"]
ODD: st.SearchStrategy[Any] = st.recursive(
    st.sampled_from(["1", "-1", "1e400", "nan", "inf", "''", "'gust'", "true", "[]", "{}"])
    | st.sampled_from(["1979-05-27", "07:32:00", "'2025-01-01'", "9" * 400, "{x_a = 1}"]),
    lambda inner: st.lists(inner, max_size=3).map(lambda items: f"[{', '.join(items)}]"),
    max_leaves=4,
)


@settings(QUICK, max_examples=200)
@given(st.lists(st.tuples(st.sampled_from(KINDS), st.integers(0, 40), ODD), max_size=3))
def test_odd_values_in_known_places_are_good_or_refused(tmp_path, lines):
    text = "" if any(kind == "version" for kind, _, _ in lines) else "version = 2\n"
    tables = ""
    for kind, number, value in lines:
        if kind in ONE or number % 2:
            names = list(ONE[kind].checks) if kind in ONE else ["center", "speed", "base", "name"]
            mark = "[{}]" if kind in ONE else "[[{}]]"
            tables += f"{mark.format(kind)}\n{names[number % len(names)]} = {value}\n"
        else:
            text += f"{kind} = {value}\n"
    try:
        got = load(tmp_path, text + tables)
    except WeatherFileError:
        return
    assert isinstance(got, CloudFile)


def test_atmospheres_keep_their_moment(tmp_path):
    for moment in ("1900-01-01T00:00:00Z", 0.1, -1.5e9 + 0.123456789, 4102444799.0):
        path = tmp_path / "a.toml"
        save_clouds(path, CloudFile(atmosphere=Atmosphere(moment), winds=(Wind(),)))
        got = load_clouds(path).atmosphere
        assert got is not None and got.time == Atmosphere(moment).time


def _written(folder: Path, text: str) -> Path:
    path = folder / "given.toml"
    path.write_text(text)
    return path
