"""What the GPU is told of occluders, waters, strikes, shafts: made anew only where it must be."""

from __future__ import annotations

import math
from dataclasses import replace

import esper
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.rain_frames import area, camera, frame, quality
from weather_ecs import Weather
from weather_ecs.components import Occluder, RippleSurface
from weather_ecs.frame import CLOUD_DTYPE, CloudShapeData
from weather_ecs.physics import lightning
from weather_ecs.physics.drops import extinction
from weather_ecs.systems.occluders import OccluderList
from weather_ecs.systems.rain_view import RainView
from weather_ecs.systems.ripples import RippleList
from weather_ecs.systems.strike_list import IN_CLOUD, NO_STRIKES, OWN, StrikeList

pytestmark = pytest.mark.usefixtures("world")


def box(x: float, **fields: object) -> Occluder:
    return Occluder(CORNERS, TRIANGLES, placed((x, 1.0, 0.0), (1.0, 1.0, 1.0)), **fields)


# Occluders


def test_occluders_are_the_same_until_one_of_them_changes() -> None:
    first, second = box(0.0), box(5.0, dynamic=True)
    entities = [esper.create_entity(first), esper.create_entity(second)]
    them = OccluderList()
    before = them.collect()
    assert them.collect() is before and len(before) == 2
    assert [data.dynamic for data in before] == [False, True]
    second.transform = placed((9.0, 1.0, 0.0), (1.0, 1.0, 1.0))
    after = them.collect()
    assert after is not before and after[0] is before[0] and after[1] is not before[1]
    assert after[1].key == before[1].key != before[0].key
    assert after[1].transform[0, 3] == 9.0
    esper.delete_entity(entities[0])  # pending: esper still lists it
    assert them.collect() == (after[1],)
    esper.create_entity(box(20.0))
    assert len({data.key for data in them.collect()} | {before[0].key}) == 3  # no key comes again


def test_occluders_of_other_layers_are_left_out() -> None:
    low, high = box(0.0, layers=1), box(5.0, layers=6)
    esper.create_entity(low), esper.create_entity(high)
    them = OccluderList()
    every = them.collect()
    assert len(every) == 2 and them.collect(1) == every[:1]
    assert them.collect(2) == them.collect(4) == every[1:]
    assert them.collect(8) == () and them.collect() == every
    low.layers = 8
    assert them.collect(8)[0] is every[0]


# Waters


def test_waters_keep_their_face_while_only_their_look_changes() -> None:
    with Weather() as weather:
        pond = RippleSurface((3.0, 0.5, -2.0), (6.0, 4.0), heading=0.7, shape="ellipse")
        tub = RippleSurface((20.0, 0.0, 0.0), (2.0, 1.0), catches_rain=False)
        esper.create_entity(pond), esper.create_entity(tub)
        them, state = RippleList(), weather._state
        state.uids.commit()
        them.collect(state)
        before, faces = them.surfaces, them.with_faces(())
        assert [data.ellipse for data in before] == [True, False] and len(faces) == 1
        them.collect(state)
        assert them.surfaces is before and them.with_faces(()) is faces
        pond.color = (0.3, 0.2, 0.1)
        them.collect(state)
        assert them.surfaces is not before and them.surfaces[1] is before[1]
        assert them.with_faces(())[0] is faces[0]  # what rain falls on has not moved
        assert them.find(pond) is them.surfaces[0] and them.find(tub) is them.surfaces[1]
        pond.center = (3.0, 0.6, -2.0)
        them.collect(state)
        assert them.with_faces(())[0] is not faces[0]
        given = OccluderList()
        esper.create_entity(box(0.0))
        assert them.with_faces(given.collect())[:1] == given.collect()
        assert them.with_faces(given.collect()) is them.with_faces(given.collect())


@pytest.mark.parametrize(("shape", "share"), [("rectangle", 1.0), ("ellipse", math.pi / 4.0)])
def test_a_face_is_level_and_covers_the_water_once(shape: str, share: float) -> None:
    with Weather() as weather:
        esper.create_entity(RippleSurface((3.0, 0.5, -2.0), (6.0, 4.0), heading=0.7, shape=shape))
        them = RippleList()
        weather._state.uids.commit()
        them.collect(weather._state)
        (face,) = them.with_faces(())
        assert face.key < 0 and not face.dynamic
        corners = face.vertices[face.indices].reshape(-1, 3, 3).astype(float)
        normals = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert (normals[:, 1] < 0.0).all() and np.allclose(normals[:, ::2], 0.0, atol=1e-5)
        assert -normals[:, 1].sum() == pytest.approx(share * 24.0, rel=0.004)
        assert np.allclose(face.vertices[:, 1], 0.5)
        along = np.array([math.cos(0.7), -math.sin(0.7)])  # of the heading, seen from above
        reach = (face.vertices[:, ::2] - (3.0, -2.0)) @ along
        assert reach.max() == pytest.approx(3.0, abs=1e-5) == -reach.min()


# Strikes


def test_a_strike_is_a_leader_first_then_as_bright_as_its_course() -> None:
    with Weather(seed=4) as weather:
        them, state = StrikeList(), weather._state
        assert them.rows(state, 4.0) is NO_STRIKES
        weather.strike((100.0, 0.0, 0.0), origin=(0.0, 1500.0, 0.0), current=30.0)
        esper.process(0.05)
        (strike,) = state.strikes.struck
        flash = lightning.course(strike.word, True)
        seen = []
        for age in (0.0, 0.5 * flash.times[0], flash.times[0] + 1e-4, flash.end + 0.01):
            state.clock.steps = strike.step + int(age / 0.05)
            state.clock.remainder = age - 0.05 * int(age / 0.05)
            seen.append(them.rows(state, 4.0))
        assert [len(rows) for rows in seen] == [1, 1, 1, 0]
        assert [float(rows["leader"][0]) for rows in seen[:3]] == pytest.approx([0.0, 0.5, 1.0])
        level = lightning.strength(30.0) * lightning.intensity(flash, flash.times[0] + 1e-4)
        assert float(seen[2]["light"][0]) == pytest.approx(4.0 * level, rel=1e-6)
        assert seen[2]["cloud_place"][0][1] > seen[2]["place"][0][1] > 0.0
        assert not seen[2]["again"][0] and not seen[2].flags.writeable


def test_a_flash_within_a_cloud_is_dimmer_and_in_its_middle() -> None:
    with Weather(seed=4) as weather:
        them, state = StrikeList(), weather._state
        weather.strike((400.0, 2000.0, 0.0), origin=(0.0, 2600.0, 0.0), current=30.0)
        esper.process(0.05)
        (strike,) = state.strikes.struck
        state.strikes.struck[:] = [strike._replace(ground=False)]
        flash = lightning.course(strike.word, False)
        age = float(flash.times[0]) + 1e-4
        state.clock.steps, state.clock.remainder = strike.step + int(age / 0.05), age % 0.05
        (row,) = them.rows(state, 1.0)
        level = lightning.strength(30.0) * lightning.intensity(flash, age)
        assert float(row["light"]) == pytest.approx(IN_CLOUD * level, rel=1e-6)
        assert row["place"].tolist() == row["cloud_place"].tolist() == [200.0, 2300.0, 0.0]


def test_a_flash_lights_the_whole_of_its_own_cloud_a_little() -> None:
    clouds = np.zeros(3, CLOUD_DTYPE)
    clouds["scale"] = 1.0
    clouds["position"] = [(0.0, 1000.0, 0.0), (300.0, 1000.0, 0.0), (5000.0, 1000.0, 0.0)]
    shape = object.__new__(CloudShapeData)
    object.__setattr__(shape, "radius", 600.0)
    strikes = np.zeros(1, NO_STRIKES.dtype)
    strikes["cloud_place"], strikes["light"] = (0.0, 1000.0, 0.0), 2.0
    them = StrikeList()
    lit = them.lit(clouds, (shape,), strikes)
    assert lit["flash"] == pytest.approx([2.0 * OWN, 2.0 * OWN * 0.75**2, 0.0])
    assert not clouds["flash"].any() and them.lit(clouds, (shape,), strikes) is lit
    assert them.lit(clouds, (shape,), strikes.copy()) is not lit
    assert them.lit(clouds, (shape,), NO_STRIKES) is clouds


# Shafts


def test_rain_that_a_cloud_carries_hangs_in_its_shade_within_its_own_width() -> None:
    row = area(5, (0.0, -3000.0), radii=(500.0, 400.0), ceiling=900.0, rain_rate=20.0)
    seen = frame(row)
    at = camera((0.0, 2.0, 0.0), math.pi / 2)
    (plain,) = RainView().view(seen, at, 0, quality()).veils
    under = replace(seen, carried=frozenset({5}))
    (shaft,) = RainView().view(under, at, 0, quality()).veils
    assert shaft.cloud == 1.0 and shaft.top > 0.0 and shaft.span[1] > 900.0 == plain.span[1]
    # Of the look, which makes a small shower more than it is, a whole shaft has nothing.
    assert shaft.extinction == pytest.approx(float(extinction(20.0)))
    assert plain.extinction > 1.5 * shaft.extinction
    assert shaft.shape[:2] == plain.shape[:2] and shaft.shape[2] <= plain.shape[2]
    above = camera((0.0, 1500.0, 0.0), math.pi / 2)
    assert RainView().view(under, above, 0, quality()).veils == ()  # the cloud is before it
    half = camera((0.0, 1150.0, 0.0), math.pi / 2)
    (left,) = RainView().view(under, half, 0, quality()).veils
    assert left.extinction == pytest.approx(0.5 * shaft.extinction)


def test_a_shower_is_plain_from_within_and_a_curtain_from_outside() -> None:
    row = area(5, (0.0, 0.0), radii=(60.0, 40.0), rain_rate=20.0)
    (inside,) = RainView().view(frame(row), camera((0.0, 2.0, 0.0)), 0, quality()).veils
    assert (inside.cloud, inside.ragged, inside.drift) == (0.0, 0.0, (0.0, 0.0))
    shades = []
    for z in (45.0, 60.0, 90.0, 400.0):
        (veil,) = (
            RainView().view(frame(row), camera((0.0, 2.0, z), math.pi / 2), 0, quality()).veils
        )
        shades.append(veil.cloud)
    assert 0.0 < shades[0] < shades[1] < shades[2] == shades[3] <= 1.0
