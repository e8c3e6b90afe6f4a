"""The editor's simulation: any moment, reached by running, seeking or going back, is the same."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from types import SimpleNamespace

import esper
import pytest

from weather_ecs import CloudFile, Weather, presets
from weather_ecs.components import Climate, Fog, RainArea, SkyLayer, Wind
from weather_ecs.editor import simulation as module
from weather_ecs.editor.bands import BANDS, LEVELS, REGIONS, describe, levels_at
from weather_ecs.editor.inside import in_world, steps_of
from weather_ecs.editor.simulation import Simulation
from weather_ecs.editor.stage import groups_of
from weather_ecs.editor.timeline import Timeline


def seen(seed: int) -> Weather:
    """A weather without OpenGL that knows its clouds as one that draws does."""
    weather = Weather(seed=seed)
    weather._state.drawn = True
    return weather


@pytest.fixture
def simulation() -> Iterator[Simulation]:
    made = Simulation(seen, seed=5)
    yield made
    made.close()
    assert made.world not in esper.list_worlds()


def a_document() -> CloudFile:
    content = presets.sky("fair", to="storm", duration=40.0)
    return replace(
        content,
        rain_areas=(
            RainArea((0.0, 0.0), (60.0, 40.0), 20.0, drift=1.0),
            RainArea((500, 0), (9, 9)),
        ),
        winds=(Wind((1.0, 0.0), 6.0, gustiness=0.5),),
        fog=Fog(4000.0),
    )


def reach(simulation: Simulation, time: float) -> bytes:
    simulation.seek(time)
    simulation.finish()
    assert simulation.time == pytest.approx(time)
    return simulation.weather.snapshot()


def test_a_moment_is_the_same_however_it_was_come_to(simulation: Simulation) -> None:
    simulation.show(a_document())
    there = reach(simulation, 31.0)
    reach(simulation, 52.0)
    assert reach(simulation, 31.0) == there  # back
    reach(simulation, 7.0)
    assert reach(simulation, 31.0) == there  # forward again, by the snapshots between
    simulation.restart()
    assert simulation.time == 0.0
    simulation.running = True
    for _ in range(3000):  # frames of no even length
        simulation.update(0.0171, budget=10.0)
        if simulation.time > 31.2:
            break
    assert reach(simulation, 31.0) == there


def test_the_start_is_what_a_game_gets_from_the_same_file(simulation: Simulation) -> None:
    content = a_document()
    simulation.show(content)
    simulation.seek(9.0)
    simulation.finish()
    with in_world("a game's"), seen(5) as weather:
        weather.add(content)
        for _ in range(9):
            esper.process(1.0)
        here = weather._frame().clouds["position"].tolist()
        sample = weather.sample((0.0, 1.7, 0.0))
    esper.delete_world("a game's")
    assert len(here) > 100 and simulation.frame.clouds["position"].tolist() == here
    assert simulation.weather.sample((0.0, 1.7, 0.0)).wind == sample.wind
    assert simulation.weather.sample((0.0, 1.7, 0.0)).rain_rate == sample.rain_rate


def test_the_document_stays_as_it_is_while_its_weather_runs(simulation: Simulation) -> None:
    content = a_document()
    simulation.show(content)
    reach(simulation, 20.0)
    assert content.climate is not None and content.climate.elapsed == 0.0
    live = simulation.live(content.climate)
    assert live is not None and live.elapsed == pytest.approx(20.0)
    area = simulation.live(content.rain_areas[0])
    assert area is not None and area.center[0] > 50.0
    assert content.rain_areas[0].center == (0.0, 0.0)


def test_an_edit_shows_at_once_and_leaves_the_rest_where_it_is(simulation: Simulation) -> None:
    content = a_document()
    simulation.show(content)
    reach(simulation, 20.0)
    place = simulation.live(content.rain_areas[0]).center  # type: ignore[union-attr]
    heavier = replace(content.rain_areas[0], rain_rate=80.0)
    edited = replace(content, rain_areas=(heavier, content.rain_areas[1]))
    simulation.show(edited)
    live = simulation.live(heavier)
    assert live is not None and live.rain_rate == 80.0 and live.center == place
    assert not simulation.follows  # the way here was another weather's
    simulation.step(1.0)
    simulation.finish()
    assert simulation.time == pytest.approx(21.0) and not simulation.follows  # on from here
    simulation.step(-1.0)
    simulation.finish()
    assert simulation.time == pytest.approx(20.0) and simulation.follows  # anew from the start
    simulation.show(content)
    simulation.show(edited)
    simulation.again()
    simulation.finish()
    assert simulation.follows and simulation.time == pytest.approx(20.0)
    assert simulation.live(heavier).rain_rate == 80.0  # type: ignore[union-attr]


def test_what_comes_and_goes_in_the_document_comes_and_goes_in_the_world(
    simulation: Simulation,
) -> None:
    content = a_document()
    simulation.show(content)
    reach(simulation, 2.0)

    def areas() -> list[float]:
        with in_world(simulation.world):
            return sorted(area.rain_rate for _, area in esper.get_component(RainArea))

    carried = len(areas()) - 2
    simulation.show(replace(content, rain_areas=content.rain_areas[1:]))
    assert 20.0 not in areas() and len(areas()) == 1 + carried
    more = (*content.rain_areas, RainArea((0.0, 9.0), (5.0, 5.0), 3.5))
    simulation.show(replace(content, rain_areas=more))
    assert {20.0, 3.5} <= set(areas()) and len(areas()) == 3 + carried
    simulation.show(replace(content, fog=None))
    with in_world(simulation.world):
        assert not esper.get_component(Fog)


def test_edits_before_the_first_step_are_the_start(simulation: Simulation) -> None:
    content = a_document()
    simulation.show(content)
    calmer = replace(content, winds=(replace(content.winds[0], speed=1.0),))
    simulation.show(calmer)
    simulation.show(replace(calmer, rain_areas=()))
    assert simulation.follows
    there = reach(simulation, 6.0)
    other = Simulation(seed=5)
    other.show(replace(calmer, rain_areas=()))
    assert reach(other, 6.0) == there
    other.close()


def test_a_layer_keeps_its_own_climate(simulation: Simulation) -> None:
    own = Climate(0.5, 0.5, 1.0, running=False)
    layers = (SkyLayer(500.0), SkyLayer(900.0))
    content = CloudFile(layers=layers, climate=Climate(), layer_climates=(None, own))
    assert groups_of(content)["layers"] == ((layers[0],), (layers[1], own))
    simulation.show(content)
    with in_world(simulation.world):
        found = [c for _, (_, c) in esper.get_components(SkyLayer, Climate)]
    assert [c.initial for c in found] == [0.5]
    simulation.show(replace(content, layer_climates=()))
    with in_world(simulation.world):
        assert not esper.get_components(SkyLayer, Climate)


def test_time_is_the_simulations_own(simulation: Simulation, monkeypatch: object) -> None:
    simulation.show(a_document())
    simulation.update(0.5)
    assert simulation.time == 0.0  # it stands
    simulation.running, simulation.speed = True, 4.0
    simulation.update(0.125, budget=10.0)
    assert simulation.time == pytest.approx(0.5)
    simulation.step(1.0)
    simulation.finish()
    assert simulation.time == pytest.approx(1.5) and not simulation.running
    simulation.step(-5.0)
    simulation.finish()
    assert simulation.time == 0.0
    assert simulation.span == 40.0


def test_a_frame_takes_no_more_than_its_budget(
    simulation: Simulation, monkeypatch: pytest.MonkeyPatch
) -> None:
    ticks = iter(range(100_000))
    watch = SimpleNamespace(perf_counter=lambda: next(ticks) * 0.004)
    monkeypatch.setattr(module, "clock", watch)
    simulation.show(a_document())
    simulation.seek(60.0)
    simulation.update(0.0, budget=0.012)
    assert simulation.seeking and 0 < steps_of(simulation.weather) <= 60  # three chunks
    assert simulation.target == 60.0
    simulation.seek(1.0)  # another wish takes the place of the first
    simulation.finish()
    assert simulation.time == pytest.approx(1.0)


def test_another_seed_is_another_weather_and_back(simulation: Simulation) -> None:
    simulation.show(a_document())
    first = simulation.frame.clouds["position"].copy()
    assert len(first) > 100
    simulation.reseed(77)
    assert simulation.frame.clouds["position"].tolist() != first.tolist()
    simulation.reseed(5)
    assert simulation.frame.clouds["position"].tolist() == first.tolist()


def test_a_timeline_keeps_its_start_and_stays_small() -> None:
    timeline = Timeline(most=8, spacing=10)
    for step in range(4000):
        if timeline.wants(step):
            timeline.add(step, bytes([step % 251]) * 3)
    assert 4 <= len(timeline) <= 8 and timeline.steps[0] == 0
    assert all(step % timeline.spacing == 0 for step in timeline.steps)
    assert timeline.before(3999)[0] > 3999 - 2 * timeline.spacing  # type: ignore[index]
    step, data = timeline.before(2500)  # type: ignore[misc]
    assert step <= 2500 and data == bytes([step % 251]) * 3
    assert not timeline.wants(step)
    timeline.clear()
    assert timeline.before(5) is None and timeline.spacing == 10
    assert timeline.until_next(7) == 3 and timeline.until_next(10) == 10


def test_the_bands_are_those_of_the_table() -> None:
    assert set(BANDS) == set(REGIONS)
    assert BANDS["tropical"]["middle"] == (2000.0, 8000.0)
    assert BANDS["temperate"]["high"] == (5000.0, 13_000.0)
    assert BANDS["polar"]["high"] == (3000.0, 8000.0)
    assert all(BANDS[region]["low"] == (0.0, 2000.0) for region in REGIONS)
    assert levels_at(2000.0, "polar") == ("middle",)
    assert levels_at(6500.0, "temperate") == ("middle", "high")
    assert levels_at(18_000.0, "tropical") == ("high",)
    assert levels_at(9000.0, "polar") == () and describe(9000.0, "polar") == "above the clouds"
    assert describe(-5.0, "polar") == "below the ground"
    assert describe(6500.0, "temperate") == "middle or high"
    assert {name for region in REGIONS for name in BANDS[region]} == set(LEVELS)


def test_clouds_that_an_edit_takes_from_a_weather_that_stands_are_gone(
    simulation: Simulation,
) -> None:
    content = a_document()
    simulation.show(content)
    reach(simulation, 5.0)
    simulation.update(0.1)
    assert len(simulation.frame.clouds) > 100
    simulation.show(replace(content, layers=(), layer_climates=()))
    assert len(simulation.frame.clouds) == 0
    simulation.show(content)
    simulation.running = True
    simulation.update(0.1, budget=10.0)
    simulation.show(replace(content, layers=()))
    simulation.update(0.1, budget=10.0)
    assert len(simulation.frame.clouds) > 0  # they dissolve
