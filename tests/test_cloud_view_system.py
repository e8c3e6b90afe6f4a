"""The clouds of one layer as rows: where they are, how large, how far grown; no OpenGL."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.cloud_worlds import model
from weather_ecs.components import CloudModel, SkyLayer
from weather_ecs.frame import WindProfile
from weather_ecs.systems.cloud_array import WHOLE
from weather_ecs.systems.cloud_layer import FORMING, TICK, Box, LayerClouds
from weather_ecs.systems.cloud_mix import Kind
from weather_ecs.systems.cloud_place import QUANTUM
from weather_ecs.systems.cloud_shapes import ShapeLibrary
from weather_ecs.systems.cloud_view import (
    LARGEST,
    SMALLEST,
    STEEPEST,
    LayerView,
    ease,
    growth,
    inside,
    key_of,
    lean,
    lifts,
    rim,
    scales,
)

LAYER = SkyLayer(base=1200.0, variation=80.0, size=(8000.0, 4000.0), center=(500.0, -300.0))
EVEN, UP = WindProfile(), (0.0, 1.0, 0.0)
MODELS = {(0.0, "fair"): model("fair"), (1.0, "grey"): model("grey", size=700.0, darkness=0.6)}
FAIR, GREY = Kind(0.0, "fair", 0), Kind(1.0, "grey", 2)


def record(*kinds: Kind, uid: int = 3) -> LayerClouds:
    """Clouds in a line, 500 m apart, from the layer's middle on."""
    found = LayerClouds(1, uid, Box(500.0, -300.0, 8000.0, 4000.0), (10.0, -4.0))
    places = np.column_stack((1000 * (1 + np.arange(len(kinds))), np.full(len(kinds), -600)))
    found.array.add(list(kinds), places, np.arange(len(kinds)), WHOLE)
    return found


def built(of: LayerClouds, models: dict[tuple[float, str], CloudModel] = MODELS) -> LayerView:
    """Its view, after everything was lit."""
    view, library = LayerView(), ShapeLibrary()
    for shape in view.build(of, LAYER, models, library):
        library.light_new(shape, UP)
    assert view.build(of, LAYER, models, library) == []
    return view


def test_clouds_wait_until_their_shapes_are_lit() -> None:
    view, library, clouds = LayerView(), ShapeLibrary(), record(FAIR, GREY, FAIR)
    wanted = view.build(clouds, LAYER, MODELS, library)
    assert len(wanted) == 2 and len(view.at(clouds, LAYER, EVEN, 0.0)) == 0
    library.light_new(wanted[0], UP)
    assert view.build(clouds, LAYER, MODELS, library) == wanted[1:]
    assert view.shown.tolist() == [0, 2] and view.shapes == wanted[:1]


def test_they_are_where_the_layer_has_them_and_go_with_it_between_ticks() -> None:
    clouds = record(FAIR, FAIR)
    clouds.offset = (40.0, 7.0)
    rows = built(clouds).at(clouds, LAYER, EVEN, 0.5)
    along = 1000 * QUANTUM * np.array([1.0, 2.0]) + 40.0 + 5.0
    assert rows["position"][:, 0] == pytest.approx(along)
    assert rows["position"][:, 2] == pytest.approx([-600 * QUANTUM + 7.0 - 2.0] * 2)
    assert rows["velocity"].tolist() == [[10.0, 0.0, -4.0]] * 2


def test_each_stands_with_its_base_on_the_layer_s_give_or_take_its_variation() -> None:
    clouds = record(FAIR, GREY, GREY)
    view = built(clouds)
    rows = view.at(clouds, LAYER, EVEN, 0.0)
    half = np.array([view.shapes[k].half[1] for k in rows["shape"].tolist()])
    bases = rows["position"][:, 1] - half * rows["scale"]
    assert bases == pytest.approx(1200.0 + lifts(np.arange(3), 3, 80.0), abs=1e-3)
    assert np.abs(bases - 1200.0).max() <= 80.0 and np.ptp(bases) > 1.0
    assert rows["darkness"] == pytest.approx([0.0, 0.6, 0.6])


def test_sizes_are_a_cloud_s_own_for_life() -> None:
    serial = np.arange(500)
    factors = scales(serial, 3)
    assert SMALLEST <= factors.min() < 0.9 < 1.15 < factors.max() <= LARGEST
    assert (scales(serial[100:], 3) == factors[100:]).all()
    assert (scales(serial, 4) != factors).mean() > 0.9


def test_a_model_that_is_gone_takes_its_clouds_along() -> None:
    clouds = record(FAIR, GREY, FAIR)
    rows = built(clouds, {(0.0, "fair"): MODELS[0.0, "fair"]}).at(clouds, LAYER, EVEN, 0.0)
    assert (rows["key"] - key_of(3)).tolist() == [0, 2]


@given(st.integers(0, 2000), st.integers(0, 2000), st.integers(0, 10**9), st.integers(0, 10**9))
def test_no_two_clouds_have_one_key(one: int, other: int, first: int, second: int) -> None:
    keys = key_of(one) + first, key_of(other) + second
    assert (keys[0] == keys[1]) == ((one, first) == (other, second))


def test_growth_goes_up_while_it_forms_and_down_while_it_dissolves() -> None:
    clouds = record(FAIR, FAIR, FAIR)
    array = clouds.array
    array.born = np.array([WHOLE, 10, WHOLE])
    array.dissolve(2, 10)
    at = [growth(array, 10.0 + share * FORMING).tolist() for share in (0.0, 0.5, 1.0)]
    assert at == [[1.0, 0.0, 1.0], [1.0, 0.5, 0.5], [1.0, 1.0, 0.0]]
    # And the same in the rows, between two ticks too.
    clouds.ticks = 10 + FORMING // 2
    rows = built(clouds).at(clouds, LAYER, EVEN, 0.5 * TICK)
    share = ease(np.array(0.5 * (FORMING // 2 * 2 + 1) / FORMING))
    assert rows["growth"] == pytest.approx([1.0, float(share), float(1.0 - share)])


def test_every_other_one_dissolves_from_the_inside_out() -> None:
    clouds = record(FAIR, FAIR, FAIR, FAIR)
    for row in (1, 2, 3):
        clouds.array.dissolve(row, 0)
    assert built(clouds).rows["mode"].tolist() == [0.0, 1.0, 0.0, 1.0]


def test_clouds_fade_in_the_rim_of_the_rectangle() -> None:
    wide = rim(LAYER)
    assert wide == pytest.approx(0.06 * 4000.0)
    edge, middle = 500.0 + 4000.0, np.full(4, -300.0)
    x = np.array([edge + 1.0, edge, edge - 0.5 * wide, edge - wide])
    assert inside(x, middle, LAYER) == pytest.approx([0.0, 0.0, 0.5, 1.0])
    z = -300.0 - 2000.0 + np.array([-5.0, 0.5 * wide])
    assert inside(np.full(2, 500.0), z, LAYER) == pytest.approx([0.0, 0.5])
    clouds = record(*[FAIR] * 9)
    clouds.offset = (-0.5 * wide, 0.0)
    shown = built(clouds).at(clouds, LAYER, EVEN, 0.0)["opacity"]
    assert shown[:8] == pytest.approx(1.0) and shown[8] == pytest.approx(0.5)


def test_clouds_lean_with_wind_that_grows_with_height_but_not_flat() -> None:
    clouds = record(FAIR)
    leaning = SkyLayer(base=500.0, shear=(0.02, 0.0), drift=1.0)
    assert lean(clouds, leaning, EVEN) == (0.02, 0.0)
    clouds.wind = (4.0, 3.0)
    assert lean(clouds, leaning, EVEN) == (0.02, 0.0)
    profile = WindProfile(exponent=0.2)
    x, z = lean(clouds, leaning, profile)
    grows = 150.0**0.2 - 50.0**0.2
    assert (x - 0.02, z) == pytest.approx((4.0 * grows * 0.05, 3.0 * grows * 0.05))
    clouds.wind = (80.0, 60.0)
    x, z = lean(clouds, leaning, profile)
    assert np.hypot(x - 0.02, z) == pytest.approx(STEEPEST)


def test_rows_are_the_caller_s_own() -> None:
    clouds = record(FAIR)
    view = built(clouds)
    view.at(clouds, LAYER, EVEN, 0.0)["position"] += 99.0
    again = view.at(clouds, LAYER, EVEN, 0.0)["position"]
    assert again[0, 0] == pytest.approx(1000 * QUANTUM)


def test_an_empty_layer_has_no_rows() -> None:
    clouds = LayerClouds(1, 3, Box(0.0, 0.0, 8000.0, 4000.0), (0.0, 0.0))
    assert len(built(clouds).at(clouds, LAYER, EVEN, 0.0)) == 0
