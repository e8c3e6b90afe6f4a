"""`Weather.add`, `load` and `save`: skies of files and presets in the world."""

from __future__ import annotations

import esper
import pytest

from tests.cloud_worlds import drawn, model, record, seconds
from tests.worlds import fresh_world
from weather_ecs import InvalidValueError, Weather, WeatherError, presets
from weather_ecs.components import Climate, Cloud, CloudModel, RainArea, SkyLayer

pytestmark = pytest.mark.usefixtures("world")


@pytest.mark.parametrize("name", sorted(presets.SKIES))
def test_a_preset_is_up_in_a_line(name):
    weather = Weather(seed=1)
    entities = weather.add(presets.sky(name))
    esper.process(1.0)
    rows = drawn(weather).clouds
    assert len(entities) == len(esper.get_component(SkyLayer)) + 1
    assert weather.stats.state == presets.SKIES[name]
    assert len(rows) == weather.stats.clouds > 10
    rains = bool(esper.get_component(RainArea))
    assert rains == (presets.SKIES[name] >= 0.75)
    for entity in entities:
        esper.delete_entity(entity)
    seconds(2.0)
    assert weather.stats.clouds == 0
    assert not esper.get_component(RainArea)


def test_from_clear_to_storm_and_back():
    weather = Weather(seed=1)
    weather.add(presets.sky("clear", to="storm", duration=100.0))
    [(_, climate)] = esper.get_component(Climate)
    for _, each in esper.get_component(SkyLayer):
        each.turnover = 60.0
    esper.process(1.0)
    clear, dark = weather.stats.clouds, drawn(weather).clouds["darkness"].max()
    seconds(300.0, 5.0)
    assert weather.stats.state == 1.0
    assert weather.stats.clouds > 4 * clear
    assert drawn(weather).clouds["darkness"].max() > dark
    assert len(esper.get_component(RainArea)) > 10
    climate.speed = -1.0
    seconds(400.0, 5.0)
    assert weather.stats.state == 0.0
    assert weather.stats.clouds < 1.6 * clear
    assert not esper.get_component(RainArea)


def test_what_is_saved_is_loaded_back(tmp_path):
    path = tmp_path / "sky.toml"
    with Weather(seed=3) as weather:
        weather.add(presets.sky("fair"))
        esper.create_entity(model("mine", rain_rate=3.0))
        esper.create_entity(Cloud("mine", (1.0, 800.0, 2.0), number=4))
        esper.process(1.0)
        weather.save(path)
        expected = drawn(weather).clouds
    with fresh_world(), Weather(seed=3) as twin:
        entities = twin.load(path)
        esper.process(1.0)
        rows = drawn(twin).clouds
        assert len(entities) == 4 + 1 + 1 + 1
        assert len(rows) == len(expected)
        [(_, cloud)] = esper.get_component(Cloud)
        assert (cloud.model, cloud.position, cloud.number) == ("mine", (1.0, 800.0, 2.0), 4)
        assert twin.stats.state == 0.25


def test_a_model_takes_the_place_of_one_of_its_name(tmp_path):
    weather = Weather()
    entity = esper.create_entity(model("mine", size=100.0))
    esper.create_entity(Cloud("mine", (0, 900, 0)))
    esper.process(1.0)
    before = drawn(weather).cloud_shapes[0].radius
    path = tmp_path / "mine.toml"
    with fresh_world(), Weather() as other:
        esper.create_entity(model("mine", size=300.0))
        other.save(path)
    assert weather.load(path) == (entity,)
    assert len(esper.get_component(CloudModel)) == 1
    esper.process(1.0)
    assert drawn(weather).cloud_shapes[0].radius > 2.0 * before


@pytest.mark.parametrize("text", ["", "version = 3", "version = 1\n[[layers]]\nbase = 'x'", "\0"])
def test_a_bad_file_changes_nothing(tmp_path, text):
    weather = Weather()
    weather.add(presets.sky("fair"))
    esper.process(1.0)
    data, path = weather.snapshot(), tmp_path / "bad.toml"
    path.write_text(text)
    with pytest.raises(WeatherError):
        weather.load(path)
    with pytest.raises(WeatherError):
        weather.load(tmp_path / "no such file")
    with pytest.raises(InvalidValueError, match="content"):
        weather.add(SkyLayer())
    assert weather.snapshot() == data
    assert record(weather).array.standing > 0


def test_a_closed_weather_neither_loads_nor_saves(tmp_path):
    weather = Weather()
    weather.close()
    for act in (lambda: weather.load(tmp_path / "a"), lambda: weather.save(tmp_path / "a")):
        with pytest.raises(WeatherError, match="closed"):
            act()
    assert list(tmp_path.iterdir()) == []
