"""Between two processes nothing is looked through twice, and nothing that changes is missed."""

from __future__ import annotations

from collections.abc import Iterator

import esper
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from weather_ecs import Weather
from weather_ecs.components import Air, Observer, Occluder, PointLight, RainArea, Wind
from weather_ecs.systems import extract

pytestmark = pytest.mark.usefixtures("world")
HERE = (0.0, 1.0, 0.0)


@pytest.fixture
def weather() -> Iterator[Weather]:
    with Weather() as it:
        yield it


@pytest.fixture
def looks(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """One entry for every time that all components were looked through."""
    counted: list[int] = []
    whole = extract.look
    monkeypatch.setattr(extract, "look", lambda *a: (counted.append(1), whole(*a))[1])
    return counted


def roof(y: float = 3.0) -> Occluder:
    return Occluder(CORNERS, TRIANGLES, placed((0, y, 0), (3, 0.05, 2)))


def test_a_thousand_samples_look_once(weather: Weather, looks: list[int]) -> None:
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    for frame in range(1, 4):
        esper.process(0.05)
        for k in range(1000):
            weather.sample((0.01 * k, 1.0, 0.0))
        assert len(looks) == frame


def test_every_change_between_two_samples_counts(weather: Weather, looks: list[int]) -> None:
    area = RainArea((0, 0), (60, 40), 25.0)
    entity = esper.create_entity(area)
    assert weather.sample(HERE).rain_rate == 25.0
    area.rain_rate = 4.0  # a field
    assert weather.sample(HERE).rain_rate == 4.0
    cover = roof()
    place = esper.create_entity(cover)  # an entity comes
    assert weather.sample(HERE).sheltered
    cover.transform = placed((50, 3, 0), (3, 0.05, 2))  # a thing moves
    assert not weather.sample(HERE).sheltered
    cover.set_mesh(CORNERS * (40.0, 1.0, 40.0), TRIANGLES)  # a thing grows
    assert weather.sample(HERE).sheltered
    esper.remove_component(place, Occluder)  # a component goes
    assert not weather.sample(HERE).sheltered
    esper.add_component(place, roof())  # and another one comes
    assert weather.sample(HERE).sheltered
    esper.delete_entity(place)  # a deletion is pending
    assert not weather.sample(HERE).sheltered
    esper.create_entity(Air(temperature=-20.0))
    assert weather.sample(HERE).snow_rate == 4.0
    other = esper.create_entity(Wind((1, 0), 3.0))
    assert weather.sample(HERE).wind == (3.0, 0.0, 0.0)
    esper.delete_entity(other, immediate=True)
    assert weather.sample(HERE).wind == (0.0, 0.0, 0.0)
    dark = weather.sample(HERE).light
    esper.create_entity(PointLight((0, 3, 0), (2, 2, 2), 10.0))
    assert weather.sample(HERE).light > dark
    kept = weather.snapshot()
    esper.delete_entity(entity, immediate=True)
    assert weather.sample(HERE).snow_rate == 0.0
    weather.restore(kept)
    assert weather.sample(HERE).snow_rate == 4.0
    esper.process(0.05)
    assert weather.sample(HERE).snow_rate > 0.0
    count = len(looks)
    weather.sample(HERE)
    assert len(looks) == count


def test_what_is_no_weather_changes_no_frame(weather: Weather) -> None:
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    observer = Observer((0, 0, 0))
    esper.create_entity(observer)
    weather.sample(HERE)
    frame = weather._frame()
    observer.position = (1, 2, 3)
    esper.create_entity(object())
    assert weather._frame() is frame


def test_a_sample_out_of_another_world_is_of_the_weather_s_own(weather: Weather) -> None:
    area = RainArea((0, 0), (60, 40), 25.0)
    esper.create_entity(area)
    assert weather.sample(HERE).rain_rate == 25.0
    home = esper.current_world
    esper.switch_world("elsewhere")
    try:
        esper.create_entity(RainArea((0, 0), (60, 40), 9.0), roof())
        assert weather.sample(HERE).rain_rate == 25.0
        area.rain_rate = 7.0
        assert weather.sample(HERE).rain_rate == 7.0
    finally:
        esper.switch_world(home)
        esper.delete_world("elsewhere")
    esper.create_entity(roof())
    assert weather.sample(HERE).sheltered


def test_a_frame_that_failed_is_made_again(
    weather: Weather, monkeypatch: pytest.MonkeyPatch
) -> None:
    area = RainArea((0, 0), (60, 40), 25.0)
    esper.create_entity(area)
    weather.sample(HERE)

    def broken(*_: object) -> None:
        raise RuntimeError("no rows")

    with monkeypatch.context() as patch:
        patch.setattr(extract, "area_rows", broken)
        area.rain_rate = 8.0
        with pytest.raises(RuntimeError, match="no rows"):
            weather.sample(HERE)
    assert weather.sample(HERE).rain_rate == 8.0
