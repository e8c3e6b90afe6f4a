"""Clouds of a layer: chance, and the shares in which skies and models come."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from tests.cloud_worlds import four_skies, sky
from weather_ecs.components import Sky
from weather_ecs.physics.chance import uniform, uniforms
from weather_ecs.systems.cloud_mix import Chooser, Mix, mix_at, nearest_mix
from weather_ecs.systems.cloud_place import scattered

pytestmark = pytest.mark.usefixtures("world")


# Chance


def test_chance_is_the_same_in_any_order_and_uniform():
    numbers = np.arange(20_000)
    values = uniforms(numbers, 7, 3)
    assert [uniform(7, 3, n) for n in (0, 5, 19_999)] == values[[0, 5, 19_999]].tolist()
    assert np.array_equal(uniforms(numbers[::-1], 7, 3), values[::-1])
    counts = np.histogram(values, 20, (0.0, 1.0))[0]
    assert ((counts - 1000.0) ** 2 / 1000.0).sum() < 50.0  # chi squared, 19 degrees: p < 1e-4
    assert abs(np.corrcoef(values, uniforms(numbers, 7, 4))[0, 1]) < 0.03


@pytest.mark.parametrize(("count", "width", "depth"), [(1, 5, 5), (97, 4000, 900), (1000, 1, 1e7)])
def test_scattered_places_fill_a_rectangle_evenly(count, width, depth):
    found = scattered(count, width, depth, 3)
    assert found.shape == (count, 2)
    assert (np.abs(found) <= (0.5 * width, 0.5 * depth)).all()
    if count > 50:
        halves = np.count_nonzero(found < 0.0, axis=0)
        assert (np.abs(halves - count / 2) <= 0.15 * count).all()
    assert not np.array_equal(found, scattered(count, width, depth, 4))


# Shares


def test_the_worked_example_shares_what_comes_in_by_halves():
    mix = mix_at(four_skies(), 0.5)
    assert [(part.sky, part.share) for part in mix.parts] == [(0.25, 0.5), (0.75, 0.5)]
    chooser = Chooser()
    drawn_from = [chooser.take(mix).sky for _ in range(1000)]
    assert Counter(drawn_from) == {0.25: 500, 0.75: 500}


@pytest.mark.parametrize("state", [0.0, 0.03, 0.25, 0.4, 0.6, 0.98, 1.0])
def test_whatever_has_come_in_has_its_share_to_within_one(state):
    mix = mix_at(four_skies(), state)
    chooser, counts = Chooser(), Counter()
    for number in range(1, 200):
        counts[chooser.take(mix).sky] += 1
        for part in mix.parts:
            assert abs(counts[part.sky] - number * part.share) < 1.0
    assert set(counts) == {part.sky for part in mix.parts}


def test_models_and_numbers_have_their_shares_too():
    mix = mix_at([sky(0.5, 10, "a", "b", weights=(3, 1), generated=5)], 0.5)
    chooser = Chooser()
    kinds = [chooser.take(mix) for _ in range(400)]
    assert Counter(kind.model for kind in kinds) == {"a": 300, "b": 100}
    assert Counter(kind.number for kind in kinds if kind.model == "a") == dict.fromkeys(
        range(5), 60
    )


def test_a_model_that_is_named_twice_has_both_shares():
    mix = mix_at([Sky(0.5, ["cumulus", "stratus", "cumulus"], count=10)], 0.5)
    chooser = Chooser()
    drawn_names = Counter(chooser.take(mix).model for _ in range(3000))
    assert drawn_names == {"cumulus": 2000, "stratus": 1000}
    assert Chooser.from_state(chooser.state()).state() == chooser.state()


def test_a_sky_without_clouds_thins_the_other_out():
    skies = (Sky(0.0), sky(1.0, 100))
    assert mix_at(skies, 0.25) == Mix(25, mix_at(skies, 1.0).parts)
    assert mix_at(skies, 0.0) == Mix(0, ())
    assert mix_at((), 0.5) == nearest_mix((), 0.5) == Mix(0, ())
    assert nearest_mix(skies, 0.4).target == 0
    assert nearest_mix(skies, 0.6).target == 100
    assert nearest_mix(skies, 0.5).target == 0  # of two as near the clearer
