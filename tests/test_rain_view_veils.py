"""Veils of a view: how deep, how clear, begun when."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.rain_frames import area, camera, frame, quality
from tests.rain_views import FAR, LOOK, NEAR, NORTH
from weather_ecs.frame import AirData, DropLook, FrameData, VeilData
from weather_ecs.physics.drops import extinction
from weather_ecs.systems.falls import shown_distance
from weather_ecs.systems.rain_view import RainView

# Veils


def veils(seen: FrameData, at: Any, choice: Any = None) -> tuple[VeilData, ...]:
    return RainView().view(seen, at, 0, choice or quality()).veils


def test_a_veil_says_how_deep_the_rain_is():
    row = area(0, (0.0, -150.0), (80.0, 40.0), 25.0, 0.4, 10.0, 350.0)
    (veil,) = veils(frame(row), camera((0.0, 30.0, 0.0), NORTH))
    assert veil.axis == pytest.approx((0.0, -150.0, math.cos(0.4), math.sin(0.4)))
    assert veil.shape == pytest.approx((80.0, 40.0, (1.0 - 10.0 / 40.0) ** 2))
    assert veil.span[0] < -200.0 and veil.span[1] == 350.0
    assert veil.extinction == pytest.approx(LOOK.veil * float(extinction(25.0)), rel=0.01)


def test_vast_rain_is_as_clear_as_its_law_says():
    found = []
    for radius in (40.0, 500.0, 20_000.0):
        row = area(0, (0.0, -150.0), (2.0 * radius, radius), 25.0, 0.4, 10.0, 350.0)
        (veil,) = veils(frame(row), camera((0.0, 30.0, 0.0), NORTH))
        found.append(veil.extinction / float(extinction(25.0)))
    assert found == pytest.approx([LOOK.veil, 0.5 * (1.0 + LOOK.veil), 1.0], rel=0.01)


def test_soft_edges_of_a_veil_from_none_to_all():
    for soft, inner in ((0.0, 0.9999), (10.0, 0.5625), (40.0, 0.0), (900.0, 0.0)):
        (veil,) = veils(frame(area(soft_edge=soft)), camera())
        assert veil.shape[2] == pytest.approx(inner)


def test_no_veils_where_the_quality_or_the_look_has_none():
    assert veils(frame(NEAR), camera(), quality(veil=False)) == ()
    assert veils(frame(NEAR, look=DropLook(veil=0.0)), camera()) == ()


def test_the_drops_share_of_the_veil_ends_where_there_are_no_drops():
    shown = []
    for share in (-0.2, 0.0, 0.3, 0.6, 0.99, 1.01, 9.0):  # of the reach, from the observer
        z = -40.0 - share * LOOK.reach
        (veil,) = veils(frame(area(0, (0.0, z))), camera(heading=NORTH))
        shown.append(veil.shown)
    assert shown == sorted(shown, reverse=True)
    assert shown[0] == shown_distance(LOOK, 25.0, 1000)
    assert shown[-2:] == [0.0, 0.0] and shown[-3] > 0.0


def test_what_drops_show_grows_with_their_number_and_falls_with_the_rain():
    by_count = [shown_distance(LOOK, 25.0, n) for n in (1, 100, 1000, 10_000, 100_000, 10**7)]
    by_rate = [shown_distance(LOOK, rate, 10_000) for rate in (0.5, 5.0, 50.0, 500.0)]
    assert by_count == sorted(by_count) and by_rate == sorted(by_rate, reverse=True)
    assert 0.0 < by_count[0] < 1.0
    # As many drops as in nature show all of it, but for the last quarter, where they thin out:
    # the line from 1 to 0 that has the integral of that, 7/8 of the reach.
    assert by_count[-1] == pytest.approx(2.0 * 0.875 * LOOK.reach, rel=0.01)
    assert shown_distance(replace(LOOK, opacity=0.0), 25.0, 1000) == 0.0


def test_containers_and_veils_know_when_the_rain_began() -> None:
    dry = (20.0, 1e9, 0.0, 0.0)
    seen = frame(area(3), area(5, (10.0, 0.0)), fronts={5: dry})
    view = RainView(1).view(seen, camera(), 0, quality())
    assert {c.area: c.dry for c in view.containers} == {3: (0.0, 0.0, 0.0, 0.0), 5: dry}
    assert [veil.dry for veil in view.veils] == [(0.0, 0.0, 0.0, 0.0), dry]
    assert view.veils[0].slope == pytest.approx(4.1 * 25.0**-0.21)


def test_snow_that_begins_fades_in_with_its_water() -> None:
    cold, dry = AirData(-5.0, 0.9, -5.5, 1.0), (60.0, 1e9, 0.0, 0.0)
    loads = []
    for fronts in ({}, {0: dry}):
        seen = frame(area(rain_rate=3.0), air=cold, fronts=fronts)
        (container, *_) = RainView(1).view(seen, camera(), 0, quality()).containers
        assert container.dry == (0.0, 0.0, 0.0, 0.0)
        loads.append(container.load)
    assert 0.0 < loads[1] < 0.9 * loads[0]


def test_a_shower_is_a_darker_curtain_from_outside_and_plain_within() -> None:
    """Little by little from its rim on; light rain hangs from thin clouds."""
    wet = frame(area(radii=(60.0, 40.0), rain_rate=25.0), wind=(6.0, 0.0, 0.0))
    seen = [veils(wet, camera((0.0, 1.7, z), NORTH))[0] for z in np.linspace(0.0, 120.0, 241)]
    shade, rays = np.array([(veil.cloud, veil.ragged) for veil in seen]).T
    inside = np.linspace(0.0, 120.0, 241) < 39.0
    assert not shade[inside].any() and not rays[inside].any()
    assert (np.diff(shade) >= 0.0).all() and np.diff(shade).max() < 0.03
    assert shade[-1] > 0.9 and rays[-1] > 0.5 and seen[-1].drift[0] > 0.0
    thin = frame(area(radii=(60.0, 40.0), rain_rate=0.5))
    assert 0.0 < veils(thin, camera((0.0, 1.7, 120.0), NORTH))[0].cloud < 0.2


def test_rain_is_hidden_by_its_cloud_from_above():
    carried = replace(frame(FAR), carried=frozenset((1,)))
    top = 400.0  # m, the ceiling of every area here

    def extinction_from(height: float, seen: FrameData) -> float:
        found = RainView().view(seen, camera((0.0, height, 0.0), NORTH, -0.5), 0, quality()).veils
        return sum(veil.extinction for veil in found)

    below, between, above = (extinction_from(top + rise, carried) for rise in (-10.0, 250.0, 600.0))
    assert 0.0 < between < 0.7 * below
    assert above == 0.0
    assert extinction_from(top + 600.0, frame(FAR)) > 0.0  # there is no cloud over a game's own
