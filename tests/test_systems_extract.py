"""`ExtractSystem`: one `FrameData` that says what the components say."""

from __future__ import annotations

import esper
import numpy as np
import pytest

from tests.cloud_worlds import model
from weather_ecs.components import (
    Atmosphere,
    Cloud,
    Fog,
    Occluder,
    PointLight,
    RainArea,
    RainContainer,
    RainGauge,
    RippleSurface,
    Sun,
    Wind,
)
from weather_ecs.frame import DropLook, SkyLight
from weather_ecs.systems import ExtractSystem, WeatherState

pytestmark = pytest.mark.usefixtures("world")

CORNERS, TRIANGLE = np.eye(3), [0, 1, 2]


@pytest.fixture
def state():
    return WeatherState(0)


def test_an_empty_world(state):
    frame = ExtractSystem().frame(state)
    assert len(frame.areas) == len(frame.lights) == len(frame.occluders) == 0
    assert frame.wind == (0.0, 0.0, 0.0)
    assert frame.sky == SkyLight()
    assert frame.look == DropLook()
    assert (frame.time, frame.step) == (0.0, 0)


def test_everything_arrives(state):
    esper.create_entity(RainArea((1, 2), (60, 40), 25.0, 0.5, 70.0, 300.0))
    esper.create_entity(PointLight((1, 2, 3), (4, 5, 6), 7.0))
    esper.create_entity(Wind((0, 1), 6.0))
    esper.create_entity(Sun((0, 2, 0), (1, 1, 1), (2, 2, 2), (3, 3, 3), (4, 4, 4)))
    esper.create_entity(RainContainer(30.0, 20.0, 1.0, 3.0, 0.02, 2.0, 0.5, 0.25))
    frame = ExtractSystem().frame(state)
    (row,) = frame.areas
    assert row["center"].tolist() == [1, 2]
    assert row["radii"].tolist() == [60, 40]
    assert [row[name] for name in ("rain_rate", "heading", "ceiling")] == [25.0, 0.5, 300.0]
    assert row["soft_edge"] == 40.0  # clipped to b
    (lamp,) = frame.lights
    assert lamp["position"].tolist() == [1, 2, 3]
    assert lamp["color"].tolist() == [4, 5, 6]
    assert lamp["reach"] == 7.0
    assert frame.wind == (0.0, 0.0, 6.0)
    assert frame.sky == SkyLight((0, 1, 0), (1, 1, 1), (2, 2, 2), (3, 3, 3), (4, 4, 4))
    assert frame.look == DropLook(30.0, 20.0, 1.0, 3.0, 0.02, 2.0, 0.5, 0.25)


def test_the_arrays_are_read_only(state):
    esper.create_entity(RainArea((0, 0), (2, 1), velocity=(1, 0)), PointLight())
    state.clock.advance(0.02)
    frame = ExtractSystem().frame(state)
    for array in (frame.areas, frame.lights):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = array[0]


def test_the_oldest_sun_counts(state):
    for level in (5.0, 9.0):
        esper.create_entity(Sun(color=(level, 0, 0)))
        esper.create_entity(RainContainer(reach=10.0 * level))
    system = ExtractSystem()
    assert system.frame(state).sky.sun_color[0] == 5.0
    assert system.frame(state).look.reach == 50.0
    esper.delete_entity(1)
    esper.delete_entity(2)
    assert system.frame(state).sky.sun_color[0] == 9.0
    assert system.frame(state).look.reach == 90.0


def test_what_has_not_changed_is_the_same_object(state):
    esper.create_entity(RainArea((0, 0), (2, 1)))
    esper.create_entity(Occluder(CORNERS, TRIANGLE))
    system = ExtractSystem()
    first = system.frame(state)
    assert system.frame(state) is first
    state.clock.advance(0.02)
    second = system.frame(state)
    assert second is not first
    assert second.time == 0.02
    assert second.areas is first.areas
    assert second.occluders is first.occluders
    system.run(state)
    assert system.frame(state) is not second


@pytest.mark.parametrize(
    "change",
    [
        lambda area: setattr(area, "rain_rate", 7.0),
        lambda area: esper.create_entity(RainArea((1, 1), (3, 3))),
        lambda area: esper.delete_entity(1),
        lambda area: esper.delete_entity(1, immediate=True),
        lambda area: esper.remove_component(1, RainArea),
        lambda area: esper.add_component(1, RainArea((0, 0), (2, 1), 9.0)),
        lambda area: esper.clear_database(),
        lambda area: esper.create_entity(Wind((1, 0), 3.0)),
    ],
)
def test_a_change_is_seen_without_a_process(state, change):
    area = RainArea((0, 0), (2, 1), 5.0)
    esper.create_entity(area)
    system = ExtractSystem()
    before = system.frame(state)
    change(area)
    after = system.frame(state)
    assert after is not before
    same = len(before.areas) == len(after.areas) and np.array_equal(before.areas, after.areas)
    assert not same or before.wind != after.wind
    assert before.areas["rain_rate"].tolist() == [5.0]  # a frame, once out, stays as it was


@pytest.mark.parametrize(
    ("change", "shown"),
    [
        (lambda: esper.create_entity(Atmosphere(time=1.7e9)), lambda frame: frame.sky),
        (lambda: esper.component_for_entity(1, Fog).__setattr__("depth", 7.0), lambda f: f.fog),
        (lambda: esper.delete_entity(1), lambda frame: frame.fog),
        (lambda: esper.create_entity(RainGauge((1, 2, 3))), lambda frame: len(frame.gauges)),
        (
            lambda: esper.create_entity(Cloud(model("boxy"), (0, 900, 0))),
            lambda frame: len(frame.clouds),
        ),
        (lambda: esper.create_entity(Occluder(CORNERS, TRIANGLE)), lambda f: len(f.occluders)),
    ],
)
def test_a_look_later_in_a_frame_sees_what_has_changed(state, change, shown):
    state.drawn = True
    esper.create_entity(Fog())
    system = ExtractSystem()
    before = system.frame(state)
    assert system.frame(state) is before
    change()
    after = system.frame(state)
    assert shown(after) != shown(before)
    assert system.frame(state) is after


def test_a_second_look_in_a_frame_costs_little(state, monkeypatch):
    esper.create_entity(Atmosphere(time=1.7e9))
    system = ExtractSystem()
    asked = []
    monkeypatch.setattr(system._daylight, "update", lambda state: asked.append(state))
    for _ in range(3):
        system.frame(state)
    assert len(asked) == 1
    system.run(state)
    system.frame(state)
    assert len(asked) == 2


def test_moving_areas_are_carried_on_by_the_remainder(state):
    esper.create_entity(Wind((1, 0), 10.0))
    esper.create_entity(RainArea((0, 0), (2, 1), velocity=(0, 4), drift=0.5))
    still = RainArea((9, 9), (2, 1))
    esper.create_entity(still)
    state.clock.advance(0.13)
    frame = ExtractSystem().frame(state)
    left = state.clock.remainder
    assert left == pytest.approx(0.03)
    assert frame.areas["center"].tolist() == [[5.0 * left, 4.0 * left], [9.0, 9.0]]
    assert still.center == (9.0, 9.0)


def test_keys_last_as_long_as_the_areas(state):
    system = ExtractSystem()
    entities = [esper.create_entity(RainArea((i, 0), (2, 1))) for i in range(4)]
    keys = dict(zip(entities, system.frame(state).areas["key"].tolist(), strict=True))
    assert len(set(keys.values())) == 4
    state.uids.commit()
    esper.delete_entity(entities[1], immediate=True)
    fresh = esper.create_entity(RainArea((7, 0), (2, 1)))
    state.uids.commit()
    after = dict(
        zip(
            [entities[0], entities[2], entities[3], fresh],
            system.frame(state).areas["key"].tolist(),
            strict=True,
        )
    )
    for entity in (entities[0], entities[2], entities[3]):
        assert after[entity] == keys[entity]
    assert after[fresh] not in keys.values()


def test_areas_come_in_the_order_of_their_entities(state):
    entities = [esper.create_entity() for _ in range(300)]
    for entity in entities[::-29]:
        esper.add_component(entity, RainArea((entity, 0), (2, 1)))
    order = ExtractSystem().frame(state).areas["center"][:, 0].tolist()
    assert order == sorted(order)
    assert len(order) == 11


def test_occluders(state):
    def paint(matrix: np.ndarray) -> None:
        raise AssertionError("nobody draws here")

    roof = Occluder(CORNERS, TRIANGLE)
    other = Occluder(CORNERS, TRIANGLE, dynamic=True)
    for occluder in (roof, other, Occluder(draw=paint)):
        esper.create_entity(occluder)
    system = ExtractSystem()
    first = system.frame(state).occluders
    assert [item.dynamic for item in first] == [False, True, False]
    assert first[2].draw is paint
    assert first[0].transform is roof.transform
    assert len({item.key for item in first}) == 3
    roof.transform = np.diag([2.0, 2.0, 2.0, 1.0])
    second = system.frame(state).occluders
    assert second[0].key == first[0].key
    assert second[0].transform is roof.transform
    assert second[1] is first[1]
    assert second[2] is first[2]
    esper.delete_entity(2)
    esper.create_entity(Occluder(CORNERS, TRIANGLE))
    third = system.frame(state).occluders
    assert [item.key for item in third[:2]] == [first[0].key, first[2].key]
    assert third[2].key not in {item.key for item in first}


def test_ripple_surfaces_and_the_faces_that_catch_rain(state):
    roof = Occluder(CORNERS, TRIANGLE)
    pond = RippleSurface((5, 2, -7), (4, 2), heading=np.pi / 2, shape="ellipse", cell=0.05)
    basin = RippleSurface((0, 1, 0), (1, 1), catches_rain=False)
    esper.create_entity(pond)
    esper.create_entity(basin)
    esper.create_entity(roof)
    system = ExtractSystem()
    first = system.frame(state)
    a, b = first.ripples
    assert (a.center, a.size, a.ellipse, a.cell, a.damping) == (
        (5.0, 2.0, -7.0), (4.0, 2.0), True, 0.05, 5,
    )  # fmt: skip
    assert not b.ellipse and a.key != b.key
    own, face = first.occluders  # the basin's owner has its own
    assert own.transform is roof.transform and not face.dynamic
    assert face.key < 0 and face.vertices.shape == (48, 3)
    assert (face.vertices[:, 1] == 2.0).all()
    # A quarter turn puts the long side along -z.
    assert np.allclose(np.ptp(face.vertices, axis=0), (2.0, 0.0, 4.0), atol=1e-5)
    assert np.allclose(face.vertices.mean(axis=0), (5, 2, -7), atol=1e-5)
    pond.amplitude = 2.0
    second = system.frame(state)
    assert second.ripples[0].amplitude == 2.0 and second.ripples[1] is b
    assert second.occluders is first.occluders  # nothing to capture again
    pond.center = (5, 3, -7)
    third = system.frame(state)
    assert third.occluders[0] is own and (third.occluders[1].vertices[:, 1] == 3.0).all()
    esper.delete_entity(1)
    last = system.frame(state)
    assert last.ripples == (b,) and last.occluders == (own,)


def test_ten_thousand_lives_leave_nothing_behind(state):
    system = ExtractSystem()
    for number in range(10_000):
        entity = esper.create_entity(RainArea((number, 0), (2, 1)), Occluder(CORNERS, TRIANGLE))
        if number % 50 == 0:
            state.uids.commit()
            assert len(system.frame(state).areas) == 1
        esper.delete_entity(entity, immediate=True)
    state.uids.commit()
    frame = system.frame(state)
    assert len(frame.areas) == len(frame.occluders) == 0
    assert not state.uids.by_entity
    assert not state.uids.current()
    assert len(system._occluders._known) <= 1
    assert not system._entities
