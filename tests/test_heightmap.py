"""The collision heightmap: what rain meets first, against rays; and what stays dry below it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, box, placed
from tests.heightmap_stage import HERE, REACH, SIZE, Maps, assert_as_rays
from weather_ecs.gpu.heightmap import fall_speed_of
from weather_ecs.physics.drops import diameter_quantile, terminal_speed


@pytest.fixture
def maps(ctx: moderngl.Context) -> Iterator[Maps]:
    made = Maps(ctx)
    yield made
    made.release()


def village(seed: int, count: int) -> list[np.ndarray]:
    """Boxes of all sizes, heights and turns around the observer."""
    rng = np.random.default_rng(seed)
    return [
        placed(
            (HERE[0] + rng.uniform(-25, 25), rng.uniform(-2, 15), HERE[2] + rng.uniform(-25, 25)),
            tuple(rng.uniform(0.5, 5.0, 3).tolist()),
            rng.uniform(-3, 3),
            rng.uniform(-0.6, 0.6),
        )
        for _ in range(count)
    ]


# The capture


@pytest.mark.parametrize("wind", [(0.0, 0.0, 0.0), (6.0, 0.0, 0.0), (-4.0, 0.0, 9.0)])
def test_the_map_is_what_falling_lines_meet(maps: Maps, wind: tuple[float, float, float]) -> None:
    transforms = village(1, 14)
    assert maps.capture(*[box(k, t) for k, t in enumerate(transforms)], wind=wind)
    place = maps.map.footprint
    assert place is not None
    assert place.slope == pytest.approx((wind[0] / 8.0, wind[2] / 8.0), abs=0.011)
    assert_as_rays(maps, transforms)


def test_it_covers_the_observers_rain_whatever_its_height(maps: Maps) -> None:
    for wind in ((0.0, 0.0, 0.0), (10.0, 0.0, -10.0)):
        for y in (1.7, 40.0, -30.0):
            position = (100.0, y, -70.0)
            maps.capture(box(0, placed(position, (1, 1, 1))), position=position, wind=wind)
            place = maps.map.footprint
            assert place is not None
            for dx, dz in ((REACH, 0.0), (0.0, -REACH), (-REACH, 0.0)):
                u, v, depth = (place.matrix() @ (100.0 + dx, y, -70.0 + dz, 1.0))[:3]
                assert 0.0 < u < 1.0 and 0.0 < v < 1.0 and 0.0 < depth < 1.0


def test_what_stands_above_the_map_keeps_the_rain_off(maps: Maps) -> None:
    """A bridge far overhead, and a cellar far below, which nothing needs."""
    maps.capture(
        box(0, placed((3.0, 400.0, -5.0), (4.0, 1.0, 4.0))),
        box(1, placed((15.0, -300.0, -5.0), (4.0, 1.0, 4.0))),
    )
    place = maps.map.footprint
    assert place is not None
    assert maps.at(3.0, -5.0) == pytest.approx(place.top)
    assert maps.at(15.0, -5.0) == -math.inf


def test_the_lee_side_lies_in_the_rain_shadow(maps: Maps) -> None:
    """A thin roof 8 m up, wind along +x as fast as the fall: 45 degrees."""
    roof = box(0, placed((3.0, 8.0, -5.0), (2.0, 0.01, 2.0)))
    maps.capture(roof, wind=(8.0, 0.0, 0.0), fall_speed=8.0)
    dry = [x for x in np.arange(-10.0, 20.0, 0.5) if maps.at(x, -5.0, 0.0) > 0.0]
    assert dry[0] == pytest.approx(3.0 + 8.0 - 2.0, abs=0.6)
    assert dry[-1] == pytest.approx(3.0 + 8.0 + 2.0, abs=0.6)
    # Half way up, the shadow is half as far off.
    half_way = [x for x in np.arange(-10.0, 20.0, 0.5) if maps.at(x, -5.0, 4.0) > 4.0]
    assert half_way[0] == pytest.approx(3.0 + 4.0 - 2.0, abs=0.6)


def test_the_fall_is_that_of_the_median_drop() -> None:
    for rate in (1.0, 25.0, 100.0):
        d = np.sort(diameter_quantile(np.linspace(0, 1, 20001)[:-1], rate))
        water = np.cumsum(d**3)
        median = d[np.searchsorted(water, 0.5 * water[-1])]
        assert fall_speed_of(rate) == pytest.approx(float(terminal_speed(median)), rel=0.12)
    assert fall_speed_of(0.0) > 0.0


# What is captured again, and what is not


def test_the_static_layer_is_kept(maps: Maps) -> None:
    house, tree = box(0, placed(HERE, (2, 2, 2))), box(1, placed((9.0, 1.0, 0.0), (1, 5, 1)))
    walker = box(2, placed((0.0, 1.0, 0.0), (0.4, 0.9, 0.4)), dynamic=True)
    assert maps.capture(house, tree, walker)
    assert maps.counts == (1, 1)
    assert not maps.capture(house, tree, walker)
    assert maps.counts == (1, 1)
    for k in range(1, 5):
        moved = replace(walker, transform=placed((0.5 * k, 1.0, 0.0), (0.4, 0.9, 0.4)))
        assert maps.capture(house, tree, moved)
        assert maps.counts == (1, 1 + k)
        assert maps.at(0.5 * k, 0.0) == pytest.approx(1.9)
        assert maps.at(0.5 * k - 1.0, 0.0) == -math.inf  # nothing stays where it was
        assert maps.at(9.0, 0.0) == pytest.approx(6.0)
    maps.capture(house, tree)
    assert maps.counts == (1, 6) and maps.at(2.0, 0.0) == -math.inf


def test_dynamic_and_static_the_higher_one_counts(maps: Maps) -> None:
    roof = box(0, placed((0.0, 6.0, 0.0), (2, 0.5, 2)))
    for y, expected in ((3.0, 6.5), (9.0, 10.0)):
        maps.capture(roof, box(1, placed((0.0, y, 0.0), (1, 1, 1)), dynamic=True))
        assert maps.at(0.0, 0.0) == pytest.approx(expected)


def test_whatever_changes_is_seen(maps: Maps) -> None:
    house = box(0, placed((0.0, 2.0, 0.0), (2, 2, 2)))
    maps.capture(house)
    moved = replace(house, transform=placed((5.0, 2.0, 0.0), (2, 2, 2)))
    assert maps.capture(moved) and maps.at(5.0, 0.0) == pytest.approx(4.0)
    lower = replace(moved, vertices=(CORNERS * np.float32(0.5)).copy())
    assert maps.capture(lower) and maps.at(5.0, 0.0) == pytest.approx(3.0)
    floor = replace(lower, indices=TRIANGLES[12:18].copy())  # one face alone
    assert maps.capture(floor) and maps.at(5.0, 0.0) == pytest.approx(1.0)
    assert maps.capture(floor, house) and maps.at(0.0, 0.0) == pytest.approx(4.0)
    assert maps.capture(floor) and maps.at(0.0, 0.0) == -math.inf
    swapped = replace(floor, dynamic=True)
    assert maps.capture(swapped) and maps.at(5.0, 0.0) == pytest.approx(1.0)


def test_moves_inside_the_margin_capture_nothing(maps: Maps) -> None:
    still = [box(k, t) for k, t in enumerate(village(2, 6))]
    maps.capture(*still)
    for dx, dy, dz in ((0.19, 0.0, 0.0), (0.0, 0.0, -0.19), (-0.1, 0.9, 0.1), (0.0, -0.9, 0.0)):
        position = (HERE[0] + dx * REACH, HERE[1] + dy * REACH, HERE[2] + dz * REACH)
        assert not maps.capture(*still, position=position)
    # Nor does a breath of wind.
    assert not maps.capture(*still, wind=(0.05, 0.0, -0.05))
    assert maps.counts == (1, 1)
    assert maps.capture(*still, wind=(2.0, 0.0, 0.0)) and maps.counts == (2, 2)


@pytest.mark.parametrize("wind", [(0.0, 0.0, 0.0), (5.0, 0.0, -3.0)])
def test_a_map_that_moves_shows_every_place_as_before(maps: Maps, wind: Any) -> None:
    """It moves by whole texels, so that no edge of a shadow crawls."""
    still = [box(k, t) for k, t in enumerate(village(3, 14))]
    maps.capture(*still, wind=wind)
    before, first = maps.depth().copy(), maps.map.footprint
    position = (HERE[0] + 7.3, HERE[1], HERE[2] - 5.1)
    assert maps.capture(*still, position=position, wind=wind)
    after, second = maps.depth(), maps.map.footprint
    assert first is not None and second is not None
    texel = 2.0 * first.half / SIZE
    shift = (np.array(second.center) - first.center) / texel
    columns, rows = np.rint(shift).astype(int).tolist()
    assert np.allclose(shift, (columns, rows), atol=1e-6)
    assert (columns, rows) != (0, 0)
    old = before[max(rows, 0) : SIZE + min(rows, 0), max(columns, 0) : SIZE + min(columns, 0)]
    new = after[max(-rows, 0) : SIZE + min(-rows, 0), max(-columns, 0) : SIZE + min(-columns, 0)]
    assert old.shape == new.shape and (old < 1.0).mean() > 0.05
    # But for rounding, which may put a texel's middle to either side of an edge.
    assert (np.abs(old - new) < 1e-5).mean() > 0.999
