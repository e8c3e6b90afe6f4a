"""Halo and rainbows as they are drawn."""

from __future__ import annotations

import math
from collections.abc import Iterator

import esper
import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tests.sky_stage import Stage, profile
from weather_ecs.components import RainArea, RainContainer
from weather_ecs.gpu import sky_ring
from weather_ecs.gpu.sky_ring import thinned
from weather_ecs.physics import bows
from weather_ecs.presets import WholeWeather

pytestmark = pytest.mark.usefixtures("world")


@pytest.fixture
def stage(ctx: moderngl.Context) -> Iterator[Stage]:
    made = Stage(ctx)
    yield made
    made.release()


def test_halo_is_at_22_degrees(stage: Stage) -> None:
    stage.air.time = "2025-06-21T15:30:00Z"
    data = stage.weather._frame().atmosphere
    assert data is not None
    without = stage.toward(data.sun_direction, 80.0)
    stage.air.halo = 1.0
    ring = stage.toward(data.sun_direction, 80.0) - without
    apart = np.degrees(np.arccos(np.clip(stage.directions() @ np.array(data.sun_direction), -1, 1)))
    angles = np.arange(18.0, 34.0, 0.5)
    light = profile(ring, apart, angles)
    assert angles[light.sum(1).argmax()] == pytest.approx(22.0, abs=0.6)
    assert light[angles < 20.5].max() < 0.1 * light.max()
    assert angles[light[:, 0].argmax()] <= angles[light[:, 2].argmax()]  # red inside


def bow(stage: Stage, rate: float) -> tuple[NDArray, NDArray]:
    """(picture, degrees from the point opposite the sun) with rain there."""
    stage.air.time = "2025-06-21T18:00:00Z"
    esper.process(0.0)
    data = stage.weather._frame().atmosphere
    assert data is not None
    x, _, z = np.negative(data.sun_direction)
    if rate > 0.0:
        esper.create_entity(RainArea((900 * x, 900 * z), (800, 700), rain_rate=rate))
        esper.create_entity(RainContainer(veil=0.0, opacity=0.0))
    picture = stage.picture(math.atan2(-z, x), 0.35, 90.0)
    cosine = np.clip(stage.directions() @ np.array((x, -data.sun_direction[1], z)), -1, 1)
    return picture, np.degrees(np.arccos(cosine))


def test_rainbow_is_at_42_degrees_and_the_secondary_at_51(stage: Stage) -> None:
    without, _ = bow(stage, 0.0)
    with_rain, apart = bow(stage, 10.0)
    light = with_rain - without
    light[stage.directions()[..., 1] < 0.06] = 0.0
    seen = np.where(stage.directions()[..., 1] > 0.06, apart, -1.0)
    angles = np.arange(34.0, 58.0, 0.5)
    rings = profile(light, seen, angles)
    total = rings.sum(1)
    primary, secondary = angles < 46.0, angles > 48.0
    assert angles[primary][total[primary].argmax()] == pytest.approx(42.0, abs=1.0)
    assert angles[secondary][total[secondary].argmax()] == pytest.approx(51.0, abs=1.2)
    red, blue = (angles[primary][rings[primary, c].argmax()] for c in (0, 2))
    assert red > blue
    red, blue = (angles[secondary][rings[secondary, c].argmax()] for c in (0, 2))
    assert red < blue
    band = total[(angles > 44.5) & (angles < 48.5)]  # Alexander's
    assert band.max() < 0.15 * total.max()
    assert total[angles < 39.0].min() > band.max()


def test_rings_have_as_many_angles_as_their_colours_ask_for() -> None:
    angles = np.linspace(10.0, 30.0, 81)
    colors = np.stack([np.maximum(angles - 25.0, 0.0), 0.0 * angles, angles], 1)
    kept = thinned(angles, colors, 1e-9)
    assert [angles[k] for k in kept] == [10.0, 25.0, 30.0]  # straight on both sides of a corner
    for table in (bows.rainbow(), bows.halo()):
        kept = thinned(np.arange(len(table)), table, 0.005)
        line = [np.interp(np.arange(len(table)), kept, table[kept][:, c]) for c in range(3)]
        assert np.abs(np.stack(line, 1) - table).max() <= 0.005
        assert len(kept) < len(table) / 4


@pytest.mark.parametrize("halo", [0.0, 1.0])
def test_what_of_a_ring_is_left_out_is_not_to_be_seen(
    stage: Stage, monkeypatch: pytest.MonkeyPatch, halo: float
) -> None:
    """Segments below the horizon, and those where no rain is."""
    stage.air.time, stage.air.halo = "2025-06-21T18:00:00Z", halo
    stage.air.rainbow = 1.0 - halo
    if halo == 0.0:
        bow(stage, 10.0)
    x, _, z = stage.weather.light.sun_direction
    heading = math.atan2(-z, x) + (0.0 if halo else math.pi)
    drawn = stage.picture(heading, 0.2, 100.0)
    monkeypatch.setattr(sky_ring, "LEVEL", -2.0)
    monkeypatch.setattr(sky_ring, "FAINTEST", -1.0)
    whole = stage.picture(heading, 0.2, 100.0)
    assert np.abs(whole - drawn).max() <= 1.5 / 255.0
    stage.air.halo = stage.air.rainbow = 0.0
    assert np.abs(stage.picture(heading, 0.2, 100.0) - drawn).max() > 0.05  # there is a ring


def test_no_rainbow_without_rain_or_under_a_high_sun(stage: Stage) -> None:
    stage.air.time = "2025-06-21T12:00:00Z"
    esper.create_entity(RainArea((0, -900), (800, 700), rain_rate=10.0))
    esper.process(0.0)
    stage.picture(math.pi / 2, 0.2)
    sky = stage.weather._renderer._layers._sky  # type: ignore[union-attr]
    assert sky is not None
    assert not sky.has_bow


def test_a_rainbow_too_faint_for_any_pixel_is_not_drawn(stage: Stage) -> None:
    bow(stage, 10.0)
    sky = stage.weather._renderer._layers._sky  # type: ignore[union-attr]
    assert sky is not None and sky.has_bow
    stage.air.rainbow = 0.004
    bow(stage, 0.0)
    assert not sky.has_bow


def test_closed_clouds_leave_no_sun_for_a_rainbow(stage: Stage) -> None:
    stage.air.overcast = 0.0
    strengths = []
    for overcast in (0.0, 0.6, 1.0):
        stage.weather.change_to(WholeWeather("so", 0.0, overcast=overcast), 0.0)
        data = stage.weather._frame().atmosphere
        assert data is not None
        strengths.append(data.rainbow)
    assert strengths[0] == 1.0 > strengths[1] > 0.7 and strengths[2] == 0.0
