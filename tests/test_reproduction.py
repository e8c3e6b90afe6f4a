"""From models to clouds: reproduction, billboards, and the sphere that holds a cloud."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from weather_ecs.components import CloudModel, CloudRoot, CloudSeed
from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import BILLBOARD_DTYPE
from weather_ecs.physics import reproduction
from weather_ecs.physics.cloud_images import CLOUD_IMAGES
from weather_ecs.physics.cloud_shape import bounding_radius, shape
from weather_ecs.physics.reproduction import Boxes, billboards, descend, level_counts, reproduce


def model(*roots: CloudRoot, **fields: object) -> CloudModel:
    seed = CloudSeed((10.0, 20.0, 30.0), 30.0, 40.0, 120.0, roots=roots)  # radius 65 m
    return CloudModel("test", (seed,), **fields)


def rng(seed: int = 1) -> np.random.Generator:
    return np.random.default_rng(seed)


@pytest.mark.parametrize(
    ("pitch", "yaw", "direction"),
    [
        (0, 0, (1, 0, 0)),
        (90, 77, (0, 1, 0)),
        (0, 90, (0, 0, -1)),  # counter-clockwise seen from above
        (-30, 180, (-(0.75**0.5), -0.5, 0)),
    ],
)
def test_levels_are_radii_apart_in_the_roots_direction(pitch, yaw, direction):
    root = CloudRoot(pitch, yaw, 0, 0, 3, 3, seeds_start=1, seeds_end=1)
    centers, sizes = reproduce(model(root), rng())
    steps = np.arange(4)[:, None] * 65.0 * np.array(direction)
    assert centers == pytest.approx(np.array([10.0, 20.0, 30.0]) + steps, abs=1e-9)
    assert np.all(sizes == (30.0, 40.0, 120.0))


def test_levels_have_between_their_first_and_last_number_of_seeds():
    root = CloudRoot(reproductions_min=4, reproductions_max=4, seeds_start=8, seeds_end=2)
    centers, _ = reproduce(model(root), rng())
    levels = np.rint(np.linalg.norm(centers - (10, 20, 30), axis=1) / 65.0).astype(int)
    assert np.bincount(levels).tolist() == [1, 8, 6, 4, 2]


def test_a_model_may_be_anything_with_the_fields_of_one():
    root = SimpleNamespace(
        pitch=90,
        yaw=0,
        open_pitch=0,
        open_yaw=0,
        reproductions_min=1,
        reproductions_max=1,
        seeds_start=2,
        seeds_end=2,
    )
    plain = SimpleNamespace(width=30, height=40, depth=120)
    rooted = SimpleNamespace(**vars(plain), center=[1, 2, 3], roots=[root])
    centers, sizes = reproduce(SimpleNamespace(seeds=[plain, rooted]), rng())
    assert centers == pytest.approx(np.array([(0, 0, 0), (1, 2, 3), (1, 67, 3), (1, 67, 3)]))
    assert np.all(sizes == (30.0, 40.0, 120.0))


def test_level_counts_of_few_levels():
    assert level_counts(3, 9, 0).tolist() == []
    assert level_counts(3, 9, 1).tolist() == [3]
    assert level_counts(3, 9, 2).tolist() == [3, 9]
    assert level_counts(0, 3, 4).tolist() == [0, 1, 2, 3]


def test_the_number_of_levels_is_drawn_evenly_between_its_bounds():
    root = CloudRoot(reproductions_min=0, reproductions_max=3, seeds_start=1, seeds_end=1)
    draw = rng()
    counts = np.bincount([len(reproduce(model(root), draw)[0]) - 1 for _ in range(2000)])
    assert len(counts) == 4
    assert counts == pytest.approx([500] * 4, abs=100)  # 5 standard deviations


@settings(deadline=None, max_examples=60)
@given(
    st.floats(-89, 89), st.floats(-180, 180), st.floats(0, 180), st.floats(0, 360), st.integers(0)
)
def test_directions_stay_within_the_openings(pitch, yaw, open_pitch, open_yaw, seed):
    open_pitch = min(open_pitch, 2 * (90 - abs(pitch)))  # so that pitch can be read back
    root = CloudRoot(pitch, yaw, open_pitch, open_yaw, 1, 1, 50, 50)
    centers, _ = reproduce(model(root), rng(seed))
    way = (centers[1:] - (10, 20, 30)) / 65.0
    assert np.linalg.norm(way, axis=1) == pytest.approx(1.0)
    pitches = np.degrees(np.arcsin(np.clip(way[:, 1], -1, 1)))
    assert np.all(np.abs(pitches - pitch) <= 0.5 * open_pitch + 1e-4)
    yaws = np.degrees(np.arctan2(-way[:, 2], way[:, 0]))
    apart = np.abs((yaws - yaw + 180) % 360 - 180)
    sure = np.abs(pitches) < 89.9  # straight up every yaw is the same
    assert np.all(apart[sure] <= 0.5 * open_yaw + 1e-4)


def test_a_full_opening_reaches_everywhere():
    root = CloudRoot(reproductions_min=1, reproductions_max=1, seeds_start=4000)
    way = reproduce(model(root), rng())[0][1:] - (10, 20, 30)
    octants = (way > 0) @ (1, 2, 4)
    assert np.bincount(octants, minlength=8) == pytest.approx([500] * 8, abs=105)


def test_every_seed_reproduces_with_each_of_its_roots():
    roots = (CloudRoot(90, 0, 0, 0, 1, 1, 2, 2), CloudRoot(-90, 0, 0, 0, 2, 2, 1, 1))
    seeds = (CloudSeed((0, 0, 0), 2, 4, 4, roots), CloudSeed((100, 0, 0), 2, 4, 4, roots[:1]))
    centers, _ = reproduce(CloudModel("two", seeds), rng())
    heights = [0, 3, 3, -3, -6, 0, 3, 3]
    assert centers == pytest.approx(
        np.array([(100 * (i > 4), y, 0) for i, y in enumerate(heights)]), abs=1e-9
    )


def test_the_same_generator_gives_the_same_cloud_and_another_one_another():
    it = model(CloudRoot())
    one, same, other = (reproduce(it, rng(seed))[0] for seed in (3, 3, 4))
    assert np.array_equal(one, same)
    assert not np.array_equal(one, other)


def test_too_many_seeds_stop_before_they_are_made():
    root = CloudRoot(reproductions_max=1000, seeds_start=900, seeds_end=900, reproductions_min=1000)
    seeds = tuple(CloudSeed(roots=(root,)) for _ in range(2))
    it = CloudModel("test", seeds[:1])

    class Whatever:  # a model that no component has checked
        pass

    it2 = Whatever()
    it2.seeds = seeds
    assert len(reproduce(it, rng())[0]) == 900_001
    with pytest.raises(InvalidValueError, match="1800000"):
        reproduce(it2, rng())
    it2.seeds = ()
    with pytest.raises(InvalidValueError, match="at least one seed"):
        reproduce(it2, rng())


BOXES = Boxes(
    np.array([[0, 50, 0], [200, 300, -50]], float),
    np.array([[100, 100, 100], [60, 20, 80]], float),
    np.array([0, 0]),
)


def spread(n: int = 500, **fields: object) -> np.ndarray:
    fields = {"size_min": 10, "size_max": 30, **fields}
    return billboards(model(billboards_min=n, billboards_max=n, **fields), BOXES, rng())


def test_billboards_are_what_the_frame_has():
    assert reproduction.BILLBOARDS == BILLBOARD_DTYPE


def test_the_number_of_billboards_is_drawn_for_each_seed():
    boxes = Boxes(np.zeros((4000, 3)), np.ones((4000, 3)), np.zeros(4000, int))
    got = billboards(model(billboards_min=2, billboards_max=5), boxes, rng())
    counts = np.bincount(np.bincount(got["seed"], minlength=4000))
    assert counts[:2].tolist() == [0, 0]
    assert counts[2:] == pytest.approx([1000] * 4, abs=140)


def test_billboards_fill_their_boxes():
    got = spread(roundness=0.0)
    for index, (center, size) in enumerate(zip(*BOXES[:2], strict=True)):
        inside = (got["position"][got["seed"] == index] - center) / (0.5 * size)
        assert np.all(np.abs(inside) <= 1.0 + 1e-6)
        assert np.abs(inside).max(axis=0) == pytest.approx(1.0, abs=0.02)
        assert inside.mean(axis=0) == pytest.approx(np.zeros(3), abs=0.13)


def test_round_seeds_keep_to_the_ellipsoid():
    got = spread(roundness=1.0)
    for index, (center, size) in enumerate(zip(*BOXES[:2], strict=True)):
        inside = (got["position"][got["seed"] == index] - center) / (0.5 * size)
        reach = np.linalg.norm(inside, axis=1)
        assert reach.max() == pytest.approx(1.0, abs=0.01)
        assert np.all(reach <= 1.0 + 1e-6)


def test_a_flat_base_lifts_what_would_hang_below_it():
    for flatness in (0.0, 1.0):
        got = spread(flatness=flatness, roundness=0.0)
        lowest = (got["position"][:, 1] - 0.375 * got["size"][:, 1]).min()
        assert lowest == pytest.approx(0.0, abs=1e-4) if flatness else lowest < -7.0


def test_sizes_turns_and_images_are_the_models():
    got = spread(aspect=0.5, turn=20, opacity=0.7, images=("wisp", "puff_2"))
    assert got["size"][:, 0].min() == pytest.approx(10, abs=0.2)
    assert got["size"][:, 0].max() == pytest.approx(30, abs=0.2)
    assert got["size"][:, 1] == pytest.approx(0.5 * got["size"][:, 0])
    assert np.degrees(np.abs(got["turn"])).max() == pytest.approx(20, abs=0.2)
    assert {CLOUD_IMAGES[i] for i in got["image"]} == {f"wisp_{i}" for i in range(1, 5)} | {
        "puff_2"
    }
    assert np.all(got["opacity"] == np.float32(0.7))
    with pytest.raises(InvalidValueError, match=r"images.*plume.*puff"):
        spread(images=("plume",))


def test_the_order_runs_from_the_middle_to_the_rim():
    got = spread()
    order = np.argsort(got["order"])
    assert got["order"][order] == pytest.approx(np.linspace(0, 1, len(got)))
    middle = 0.5 * (got["position"].min(axis=0) + got["position"].max(axis=0))
    half = 0.5 * np.ptp(got["position"], axis=0)
    away = np.linalg.norm((got["position"] - middle) / half, axis=1)
    assert np.all(np.diff(away[order]) >= -1e-4)


def test_a_shape_stands_about_its_middle_and_is_always_the_same():
    it = model(CloudRoot(), billboards_min=0)
    one = shape(it, 5)
    low = (one.centers - 0.5 * one.sizes).min(axis=0)
    high = (one.centers + 0.5 * one.sizes).max(axis=0)
    assert low == pytest.approx(-high, abs=1e-3)
    assert one.half == pytest.approx(tuple(high), abs=1e-3)
    again = shape(it, 5)
    assert one.centers.tobytes() == again.centers.tobytes()
    assert one.billboards.tobytes() == again.billboards.tobytes()
    assert shape(it, 6).centers.tobytes() != one.centers.tobytes()
    it.name = "other"
    assert shape(it, 5).centers.tobytes() != one.centers.tobytes()
    with pytest.raises(ValueError, match="read-only"):
        one.centers[0] = 0


def test_the_radius_reaches_the_farthest_corner():
    boxes = np.array([[0, 0, 0], [-5, 0, 3]]), np.array([[2, 2, 2], [4, 6, 8]])
    assert bounding_radius(*boxes) == pytest.approx((49 + 9 + 49) ** 0.5)
    with pytest.raises(InvalidValueError):
        bounding_radius(np.zeros((0, 3)), np.zeros((0, 3)))


def test_boxes_know_their_seeds_and_seeds_have_billboards_of_their_own():
    root = CloudRoot(reproductions_min=1, reproductions_max=1, seeds_start=40)
    own = CloudSeed(
        roots=(root,), images=("streak",), size_factor=3, aspect_factor=0.5, turn_factor=0
    )
    it = CloudModel("two", (CloudSeed(roots=(root,)), own), 5, 5, 10, 20, aspect=0.8)
    boxes = descend(it, rng())
    assert boxes.seeds.tolist() == [0] * 41 + [1] * 41
    got = billboards(it, boxes, rng())
    mine = got["seed"] >= 41
    kinds = [
        {CLOUD_IMAGES[i].split("_")[0] for i in got["image"][which]} for which in (~mine, mine)
    ]
    assert kinds == [{"puff"}, {"streak"}]
    assert np.unique(got["image"]).tolist() == [
        i for i, name in enumerate(CLOUD_IMAGES) if name.startswith(("puff", "streak"))
    ]
    assert 30 <= got["size"][mine, 0].min() < 31 and 59 < got["size"][mine, 0].max() <= 60
    assert got["size"][~mine, 0].max() <= 20
    assert got["size"][mine, 1] == pytest.approx(0.4 * got["size"][mine, 0])
    assert not got["turn"][mine].any() and got["turn"][~mine].all()
