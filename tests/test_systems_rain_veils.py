"""`veils`: one for each area in view, of what its drops leave over."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.rain_frames import area, frame
from tests.rain_views import LOOK
from weather_ecs.frame import AirData, ContainerData, FrameData, VeilData
from weather_ecs.physics.container import Area, Container, ContainerSettings, place
from weather_ecs.physics.drops import extinction
from weather_ecs.physics.snow import snow_extinction
from weather_ecs.systems.falls import shown_distance
from weather_ecs.systems.rain_veils import veils

SIZE = ContainerSettings(LOOK.reach, LOOK.height, LOOK.margin)
EYE = 1.7


def placed(row: tuple[Any, ...], z: float = 0.0, **changes: Any) -> Container:
    """The container of an area for somebody at (0, z) who looks along -z."""
    _, center, radii, heading, _, _, ceiling = row
    it = place(Area(center, radii, heading, ceiling), (0.0, EYE, z), math.pi / 2, 1.0, SIZE)
    return it._replace(**changes)


def drops(key: int, count: float, kind: int = 0, rear: int = 0) -> ContainerData:
    shape = (LOOK.reach, LOOK.reach, -2.0, LOOK.height)
    births = np.zeros((1, 4), np.float32)
    number = 4 * key + 2 * kind + rear
    four = (0.0, 0.0, 1.0, 0.0)
    return ContainerData(number, four, shape, four, four, four, 1.0, count, 1.0, births, kind=kind)


def veil_of(
    seen: FrameData, row: tuple[Any, ...], *containers: ContainerData, z: float = 0.0, **to: Any
) -> VeilData:
    (found,) = veils(seen, {row[0]: placed(row, z, **to)}, containers, EYE)
    return found


def test_areas_that_are_out_of_view_have_none() -> None:
    rows = [area(k, (20.0 * k, 0.0)) for k in range(4)]
    known = {k: placed(rows[k], visible=k != 1) for k in (0, 1, 3)}
    found = list(veils(frame(*rows), known, (), EYE))
    assert [veil.axis[0] for veil in found] == [0.0, 60.0]


def test_without_drops_a_veil_is_all_there_is() -> None:
    row = area()
    veil = veil_of(frame(row), row)
    assert veil.shown == 0.0
    assert veil.extinction == pytest.approx(LOOK.veil * float(extinction(25.0)), rel=0.01)
    assert veil.span == (placed(row).bottom - 300.0, 400.0)


def test_drops_show_their_share_near_the_eye() -> None:
    """Of both halves of a cylinder the front one counts: it has the eye's side."""
    row = area()
    seen = frame(row)
    wanted = shown_distance(LOOK, 25.0, 1000)
    assert veil_of(seen, row, drops(0, 1000.0)).shown == pytest.approx(wanted)
    both = veil_of(seen, row, drops(0, 1000.0), drops(0, 800.0, rear=1))
    assert both.shown == pytest.approx(wanted)
    other = veil_of(seen, row, drops(7, 1000.0))  # another area's
    assert other.shown == 0.0
    half = veil_of(seen, row, drops(0, 1000.0), distance=0.5 * LOOK.reach)
    assert half.shown == pytest.approx(0.5 * wanted)
    assert veil_of(seen, row, drops(0, 1000.0), distance=1.5 * LOOK.reach).shown == 0.0


def test_sleet_has_both_and_snow_its_own() -> None:
    row = area(rain_rate=4.0)
    shares = []
    for share in (0.0, 0.5, 1.0):
        seen = frame(row, air=AirData(0.5, 0.9, 0.0, share))
        veil = veil_of(seen, row)
        rain, snow = 4.0 * (1.0 - share), 4.0 * share
        lost = LOOK.veil * float(extinction(rain)) if rain else 0.0
        white = seen.flakes.veil * float(snow_extinction(snow)) if snow else 0.0
        assert veil.extinction == pytest.approx(lost + white, rel=0.02)
        shares.append(veil.snow)
    assert shares[0] == 0.0 and 0.5 < shares[1] < 1.0 and shares[2] == 1.0


def test_a_shaft_reaches_into_the_cloud_that_carries_it() -> None:
    row = area(3, (0.0, -4000.0), (400.0, 300.0), 20.0, 0.0, 100.0, 1000.0)
    own, wind = frame(row), (12.0, 0.0, -6.0)
    seen = replace(own, carried=frozenset((3,)), wind=wind)
    far = placed(row).distance
    plain, shaft = veil_of(own, row, distance=far), veil_of(seen, row, distance=far)
    assert plain.span[1] == 1000.0 < shaft.span[1]
    assert (plain.top, shaft.top) == (0.0, 250.0)
    assert shaft.cloud == 1.0
    assert shaft.shape[2] < plain.shape[2]  # its sides are thin from afar
    assert shaft.drift == pytest.approx((0.8, -0.4))
    beneath = veil_of(seen, row, z=-4000.0)
    assert (beneath.span[1], beneath.ragged, beneath.drift) == (1000.0, 0.0, shaft.drift)


def test_the_ends_of_what_there_may_be_stay_numbers() -> None:
    for rate in (5e-324, 1e-9, 1.0e4):
        for radii in ((1e-2, 1e-3), (1e6, 1e6)):
            for soft in (0.0, 1e7):
                row = area(0, (0.0, 0.0), radii, rate, 0.0, soft, 1e7)
                for carried in (frozenset(), frozenset((0,))):
                    seen = replace(frame(row), carried=carried)
                    veil = veil_of(seen, row, drops(0, 1.0))
                    numbers = (*veil.axis, *veil.shape, *veil.span, *veil.drift, veil.slope)
                    numbers += (veil.extinction, veil.shown, veil.snow, veil.phase, veil.top)
                    assert all(map(math.isfinite, numbers))
                    assert veil.extinction >= 0.0 and veil.shape[2] < 1.0
