"""Shelter as a game asks for it: samples under roofs, behind walls, among thousands."""

from __future__ import annotations

import esper
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from weather_ecs import Weather
from weather_ecs.components import CollisionHeightmap, Occluder, RainArea, Wind
from weather_ecs.physics.footprint import fall_speed_over

pytestmark = pytest.mark.usefixtures("world")


# What the game asks


def roof(x: float = 0.0, y: float = 3.0, z: float = 0.0, **rest: object) -> Occluder:
    """Six by four metres."""
    return Occluder(CORNERS, TRIANGLES, placed((x, y, z), (3, 0.05, 2)), **rest)  # type: ignore[arg-type]


def test_a_sample_under_a_roof_is_dry_and_right_within_a_metre_of_its_edge():
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    esper.create_entity(roof())
    for _ in range(40):
        esper.process(0.5)
    for y in (0.0, 1.7, 2.6):
        for edge, step in ((3.0, (1, 0)), (2.0, (0, 1))):
            for sign in (-1, 1):
                for away, covered in ((-0.1, True), (0.1, False)):
                    x, z = (sign * (edge + away) * s for s in step)
                    got = weather.sample((x, y, z))
                    assert got.sheltered is covered
                    assert got.rain_rate == (0.0 if covered else 25.0)
                    assert (got.wetness == 0.0) is covered
                    assert got.visibility < 5000.0  # what one sees through is outside
    above = weather.sample((0, 3.1, 0))
    assert not above.sheltered and above.rain_rate == 25.0


def test_the_dry_place_moves_downwind_of_its_roof():
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    esper.create_entity(Wind((0, 1), 8.0))
    esper.create_entity(roof(y=5.0))
    slope = 8.0 / fall_speed_over(np.array([25.0]))
    shift = 5.0 * slope
    assert not weather.sample((0, 0, 0)).sheltered  # it blows in under the windward edge
    assert weather.sample((0, 0, shift)).sheltered
    assert weather.sample((0, 0, shift + 1.8)).sheltered
    assert not weather.sample((0, 0, shift + 2.3)).sheltered
    assert weather.sample((0, 4.6, 0.4)).sheltered


def test_a_sample_knows_what_has_moved_a_quarter_of_a_second_ago():
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (90, 90), 25.0))
    cart = roof(dynamic=True)
    esper.create_entity(cart)
    assert weather.sample((0, 0, 0)).sheltered
    for k in range(1, 40):
        cart.transform = placed((k, 3.0, 0), (3, 0.05, 2))
        for _ in range(5):
            esper.process(0.05)
        assert weather.sample((k + 2.5, 0, 0)).sheltered
        assert not weather.sample((k - 3.5, 0, 0)).sheltered


@pytest.mark.parametrize("many", [False, True])
def test_who_stands_behind_a_wall_is_dry_in_any_wind(many):
    # Rain of more than 45 degrees goes over the wall, or meets it less than MARGIN above the point.
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    esper.create_entity(Wind((1, 0), 12.0))
    parts = [placed((0.0, 1.4, 0.0), (0.08, 1.4, 8.0))]
    parts += [placed((30.0 + k, 0.5, 0.0), (0.1, 0.5, 0.1)) for k in range(4 if many else 0)]
    corners = np.concatenate([CORNERS @ m[:3, :3].T + m[:3, 3] for m in parts])
    faces = np.concatenate([TRIANGLES + len(CORNERS) * k for k in range(len(parts))])
    esper.create_entity(Occluder(corners, faces))
    esper.process(0.1)
    for away in (0.16, 0.3, 0.6):
        for y in (0.0, 0.8, 1.6):
            assert weather.sample((away, y, 0.5)).sheltered, (away, y)
            assert not weather.sample((-away, y, 0.5)).sheltered, (away, y)
    assert not weather.sample((0.3, 2.75, 0.5)).sheltered
    assert not weather.sample((6.5, 0.8, 0.5)).sheltered
    # Ground counts only from MARGIN on, as it may be coarser than what is drawn.
    esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((0, -0.9, 20), (20, 1.0, 10))))
    esper.process(0.1)
    assert not weather.sample((0.0, 0.0, 20.0)).sheltered


def test_rain_passes_what_lies_on_layers_it_ignores():
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    leaves = roof(layers=0b100)
    esper.create_entity(leaves)
    rule = CollisionHeightmap(layers=0b011)
    entity = esper.create_entity(rule)
    assert not weather.sample((0, 0, 0)).sheltered
    leaves.layers = 0b110
    assert weather.sample((0, 0, 0)).sheltered
    rule.layers = 0
    assert not weather.sample((0, 0, 0)).sheltered
    esper.delete_entity(entity)
    assert weather.sample((0, 0, 0)).sheltered


def test_thousands_of_occluders_come_and_go_without_a_trace():
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    for k in range(2000):
        entity = esper.create_entity(roof(dynamic=bool(k % 2)))
        if k % 20 == 0:
            esper.process(0.05)
            weather.sample((0, 0, 0))
        esper.delete_entity(entity, immediate=bool(k % 3))
    esper.process(0.2)
    assert not weather.sample((0, 0, 0)).sheltered
    weather._shelter._meshes.keep_used()
    assert len(weather._shelter._meshes._known) < 200
    assert len(weather._shelter._facets._known) <= 4096
