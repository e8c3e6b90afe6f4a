"""Clouds that the game makes itself, as rows."""

from __future__ import annotations

import math

import esper
import pytest

from tests.cloud_worlds import model
from weather_ecs.components import Cloud
from weather_ecs.frame import WindProfile
from weather_ecs.physics.wind import height_share
from weather_ecs.systems.cloud_made import MadeClouds, share_of
from weather_ecs.systems.cloud_models import ModelBook
from weather_ecs.systems.cloud_shapes import ShapeLibrary
from weather_ecs.systems.uids import Uids

pytestmark = pytest.mark.usefixtures("world")

UP, STILL, EVEN = (0.0, 1.0, 0.0), (0.0, 0.0, 0.0), WindProfile()
HIGH = (100.0, 1500.0, -200.0)


class Sky:
    """Made clouds, and what they are made with; all shapes are lit as soon as they are wanted."""

    def __init__(self) -> None:
        self.made, self.library = MadeClouds(), ShapeLibrary()
        self._book, self._uids = ModelBook(), Uids()

    def collect(self, profile: WindProfile = EVEN) -> bool:
        return self.made.collect(self._book, self.library, self._uids, profile)

    def lit(self, profile: WindProfile = EVEN) -> MadeClouds:
        self.collect(profile)
        for shape in self.made.wanted:
            self.library.light_new(shape, UP)
        self.collect(profile)
        return self.made


def test_a_cloud_is_shown_once_its_shape_is_lit() -> None:
    sky = Sky()
    esper.create_entity(Cloud(model("one"), HIGH))
    assert sky.collect()
    assert len(sky.made.at(STILL, 0.0)) == 0 and len(sky.made.wanted) == 1
    made = sky.lit()
    assert len(made.at(STILL, 0.0)) == 1 and made.wanted == []


def test_its_row_is_what_the_component_says() -> None:
    sky = Sky()
    esper.create_entity(
        Cloud(
            model("one"), HIGH, scale=2.0, heading=7.0, shear=(0.1, -0.2), growth=0.5, hollow=1.0,
            opacity=0.25,
        )
    )  # fmt: skip
    made = sky.lit()
    row = made.at(STILL, 0.0)[0]
    # The position is that of the base, a row's that of the middle.
    height = 1500.0 + 2.0 * made.shapes[0].half[1]
    assert row["position"] == pytest.approx((100.0, height, -200.0))
    assert row["heading"] == pytest.approx(7.0 - 2.0 * math.pi)
    assert row["shear"] == pytest.approx((0.1, -0.2))
    numbers = [float(row[name]) for name in ("scale", "growth", "mode", "opacity", "mirror")]
    assert numbers == pytest.approx([2.0, 0.5, 1.0, 0.25, 1.0])


def test_clouds_of_one_model_number_and_heading_share_a_shape() -> None:
    sky, one = Sky(), model("one")
    for number, heading in ((0, 0.0), (1, 0.0), (0, 0.001), (0, 1.5), (1, 0.0)):
        esper.create_entity(Cloud(one, HIGH, number=number, heading=heading))
    made = sky.lit()
    assert made.at(STILL, 0.0)["shape"].tolist() == [0, 1, 0, 2, 1]
    assert [(each.turn, len(each.made.centers) > 0) for each in made.shapes] == [
        (0, True), (0, True), (6, True),
    ]  # fmt: skip


def test_a_cloud_whose_model_nobody_knows_is_left_out() -> None:
    sky = Sky()
    esper.create_entity(Cloud("unheard of", HIGH))
    esper.create_entity(Cloud(model("one"), HIGH))
    assert len(sky.lit().at(STILL, 0.0)) == 1


def test_it_goes_with_its_own_motion_and_its_share_of_the_wind() -> None:
    sky = Sky()
    esper.create_entity(Cloud(model("one"), HIGH, velocity=(3.0, -1.0), drift=0.5))
    esper.create_entity(Cloud(model("one"), HIGH, drift=0.0))
    rows = sky.lit().at((8.0, 0.0, 4.0), 0.5)
    assert rows["velocity"].tolist() == [[7.0, 0.0, 1.0], [0.0, 0.0, 0.0]]
    assert rows["position"][:, 0] == pytest.approx([103.5, 100.0])
    assert rows["position"][:, 2] == pytest.approx([-199.5, -200.0])


def test_the_wind_that_carries_it_is_that_of_its_height() -> None:
    profile = WindProfile(reference=10.0, exponent=0.2, ground=100.0)
    cloud = Cloud(model("one"), (0.0, 250.0, 0.0), drift=0.5)
    assert share_of(cloud, profile) == pytest.approx(0.5 * height_share(150.0, 10.0, 0.2))
    assert share_of(cloud, profile) > 0.5
    cloud.drift = 0.0
    assert share_of(cloud, profile) == 0.0


def test_nothing_is_made_again_until_something_changes() -> None:
    sky = Sky()
    cloud = Cloud(model("one"), HIGH)
    entity = esper.create_entity(cloud)
    sky.lit()
    assert not sky.collect()
    cloud.scale = 3.0
    assert sky.collect()
    assert sky.made.at(STILL, 0.0)["scale"].tolist() == [3.0]
    assert sky.collect(WindProfile(exponent=0.3))
    assert not sky.collect(WindProfile(exponent=0.3))
    esper.delete_entity(entity)
    assert sky.collect(WindProfile(exponent=0.3))
    assert len(sky.made.at(STILL, 0.0)) == 0 and sky.made.shapes == []


def test_it_tells_whether_a_model_was_edited() -> None:
    sky, mine = Sky(), model("mine")
    esper.create_entity(mine)
    cloud = Cloud("mine", HIGH)
    esper.create_entity(cloud)
    sky.lit()
    cloud.growth = 0.5
    told = [(sky.collect(), sky.made.edited)]
    mine.size_max = 120.0
    told.append((sky.collect(), sky.made.edited))
    assert told == [(True, False), (True, True)]
    assert [shape.model for shape in sky.made.wanted] == [mine]
