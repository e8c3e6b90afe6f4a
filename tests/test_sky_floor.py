"""What is seen under the horizon from high up: clouds, and ground behind clean air."""

from __future__ import annotations

import esper
import moderngl
import numpy as np
import pytest

from tests.cloud_stage import clouds, shape, sky_frame, view_of
from tests.sky_stage import Stage
from tests.worlds import fresh_world
from weather_ecs.components import Cloud
from weather_ecs.gpu.sky_floor import SkyFloor
from weather_ecs.physics import sky_floor, sky_map
from weather_ecs.physics.cloud_light import CLEAN, CLEAN_HEIGHT, surround

SKY, LAND, TOPS = np.array([0.5, 0.6, 0.7]), np.array([0.10, 0.12, 0.08]), np.array([0.8] * 3)


def seen(sines: list[float], share: float, depth: float) -> np.ndarray:
    level = np.tile(SKY, (len(sines), 1))
    return sky_floor.floor_light(level, LAND, TOPS, share, depth, np.array(sines))


def test_the_air_below_is_as_deep_as_its_law_says() -> None:
    heights = np.linspace(0.0, 5000.0, 20_001)
    whole = np.trapezoid(CLEAN * np.exp(-heights / CLEAN_HEIGHT), heights)
    assert sky_floor.depth_below(5000.0) == pytest.approx(whole, rel=1e-4)
    upper = heights >= 2500.0
    part = np.trapezoid(CLEAN * np.exp(-heights[upper] / CLEAN_HEIGHT), heights[upper])
    assert sky_floor.depth_below(5000.0, 2500.0) == pytest.approx(part, rel=1e-3)
    assert sky_floor.depth_below(0.0) == sky_floor.depth_below(-20.0) == 0.0


def test_the_horizon_is_as_bright_as_the_sky_over_it() -> None:
    """Without air a dark land would begin there; from 5 km it comes out of haze by and by."""
    high = seen([0.0, -0.03, -0.1, -0.3, -1.0], 0.0, sky_floor.depth_below(5000.0))
    low = seen([0.0, -0.1], 0.0, sky_floor.depth_below(1.7))
    assert np.allclose(high[0], SKY) and np.allclose(low[0], SKY)
    assert (np.diff(high[:, 0]) < 0.0).all()
    assert high[1, 0] > 0.8 * SKY[0]
    assert low[1, 0] < 0.25 * SKY[0]
    assert high[4] == pytest.approx(LAND, abs=0.09)


def test_a_deck_hides_the_land() -> None:
    deck = seen([-0.2], 1.0, 0.0)[0]
    assert deck == pytest.approx(TOPS, abs=1e-3)
    half = seen([-0.2], 0.5, 0.0)[0]
    assert half == pytest.approx(0.5 * (TOPS + LAND), abs=1e-3)


def test_so_many_clouds_cover_so_much() -> None:
    around = np.pi * sky_floor.AROUND**2
    assert sky_floor.share_covered(np.zeros(0)) == 0.0
    assert sky_floor.share_covered(np.full(10, 0.01 * around)) == pytest.approx(
        1.0 - np.exp(-0.1 * sky_floor.FILLED)
    )
    assert sky_floor.share_covered(np.full(100, 0.1 * around)) > 0.99


def test_tops_are_as_bright_as_the_sun_that_they_have() -> None:
    def top(high: float, sun: float, darkness: float = 0.0) -> float:
        towards = (0.0, high, (1.0 - high * high) ** 0.5)
        light = surround(towards, (sun,) * 3, (0.2, 0.3, 0.6), (0.5, 0.6, 0.7), (0.2,) * 3)
        return float(sky_floor.top_light(light, darkness).mean())

    assert top(0.9, 1.0) > 1.2 * top(0.1, 1.0)
    assert top(0.1, 1.0) > 1.5 * top(0.9, 0.0)
    assert top(0.5, 1.0, 0.9) == pytest.approx(top(0.5, 1.0), rel=0.05)


def test_light_that_is_bent_in_the_picture_is_bent_back() -> None:
    light = np.linspace(0.0, 2.0, 50)
    shown = sky_map.shown(light) ** 2.2
    assert sky_floor.unbent(shown[shown < 0.96]) == pytest.approx(light[shown < 0.96], abs=1e-6)


def below(stage: Stage, share: float, tops: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(drawn, wanted) of what is seen under the horizon from 5 km, rows of pixels."""
    drawn = stage.picture(0.4, -0.3, 60.0, height=5000.0)
    ways = stage.directions()
    data = stage.weather._frame().atmosphere
    assert data is not None
    level = ways * (1.0, 0.0, 1.0)
    level /= np.linalg.norm(level, axis=-1, keepdims=True)
    depth = sky_floor.depth_below(5000.0)
    light = sky_floor.floor_light(
        sky_map.radiance(data, level), np.asarray(data.ground_light), tops, share, depth,
        ways[..., 1],
    )  # fmt: skip
    under = ways[..., 1] < -0.01
    return drawn[under], np.clip(sky_map.shown(light), 0.0, 1.0)[under]


def test_a_low_deck_comes_to_cover_the_land_little_by_little() -> None:
    wide = shape(size=(9000.0, 100.0, 9000.0))
    places = [(x, 60.0, z) for x in (-6000.0, 6000.0) for z in (-6000.0, 6000.0)]
    frame = sky_frame(clouds(*({"position": at} for at in places)), wide)
    heights = [250.0, 299.0, 301.0, *np.linspace(320.0, 1400.0, 28)]
    floors = [SkyFloor().of(view_of(frame, position=(0.0, h, 0.0))) for h in heights]
    shares = np.array([floor.share for floor in floors])
    assert shares[0] == 0.0 and shares[-1] > 0.15
    assert (np.diff(shares) >= 0.0).all() and np.diff(shares).max() < 0.1 * shares[-1]


def test_what_is_drawn_under_the_horizon_is_the_oracles(ctx: moderngl.Context) -> None:
    with fresh_world():
        stage = Stage(ctx)
        try:
            stage.air.time = "2025-06-21T15:00:00Z"
            drawn, wanted = below(stage, 0.0, np.zeros(3))
            assert np.abs(drawn - wanted).mean() < 0.004
            assert np.quantile(np.abs(drawn - wanted), 0.99) < 0.02
            assert wanted.std() > 0.02  # there is something to compare
        finally:
            stage.release()


def test_over_a_deck_the_far_end_is_bright(ctx: moderngl.Context) -> None:
    """Clouds behind the camera: what is seen is none of them."""
    with fresh_world():
        stage = Stage(ctx)
        try:
            stage.air.time = "2025-06-21T15:00:00Z"
            bare, _ = below(stage, 0.0, np.zeros(3))
            for k in range(14):
                place = (-9000.0 + 500.0 * k, 1000.0, 3000.0)
                esper.create_entity(Cloud("nimbostratus", place, drift=0.0, number=k % 3))
            for _ in range(4):
                esper.process(0.05)
            stage.weather._renderer.clouds.draws = lambda view: False  # type: ignore[union-attr]
            over, _ = below(stage, 0.0, np.zeros(3))
            assert over.mean() > 1.25 * bare.mean()
            assert np.ptp(over.mean(axis=1)) < np.ptp(bare.mean(axis=1))
        finally:
            stage.release()
