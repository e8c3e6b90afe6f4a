"""The veil's closed integral against the profile it is of."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.veil_stage import HERE, axis_of
from weather_ecs.physics import veil
from weather_ecs.physics.front import LONG, extinction_arrived

# The closed integral


def brute_path(
    position: Any, ray: np.ndarray, end: float, axis: Any, shape: Any, ceiling: float, shown: float
) -> float:
    """Midpoint sum of the soft profile along one ray, less the drops' share."""
    level = float(np.hypot(ray[0], ray[2]))
    # Nothing falls farther off than the ellipse's farther end.
    reach = math.dist((position[0], position[2]), axis[:2]) + shape[0]
    last = min(end, veil.BEYOND, reach / max(level, 1e-9))
    t = (np.arange(30_000) + 0.5) * (last / 30_000)
    at = np.asarray(position) + ray * t[:, None]
    share = veil.full_share(at[:, [0, 2]], axis, shape) * (at[:, 1] <= ceiling)
    share *= 1.0 - veil.drops_share(t * np.linalg.norm(ray), shown)
    return float(share.sum() * last / 30_000 * np.linalg.norm(ray))


heading = st.floats(-math.pi, math.pi)
length = st.floats(1.0, 400.0)
place = st.tuples(st.floats(-500, 500), st.floats(0, 500), st.floats(-500, 500))
ways = st.builds(
    lambda h, p: np.array([math.cos(h) * math.cos(p), math.sin(p), -math.sin(h) * math.cos(p)]),
    heading, st.floats(-1.5, 1.5),
)  # fmt: skip


@settings(max_examples=50, deadline=None)
@given(place, ways, length, length, heading, st.floats(0, 0.99), st.floats(20, 400),
       st.floats(0.5, 3000))  # fmt: skip
def test_the_integral_is_that_of_the_profile(
    position: Any, ray: np.ndarray, a: float, b: float, turn: float, inner: float, ceiling: float,
    end: float,
) -> None:  # fmt: skip
    assume(abs(position[1] - ceiling) > 0.01)  # along the ceiling itself either answer is right
    axis, shape = axis_of((20.0, -30.0), turn), (max(a, b), min(a, b), inner)
    found = veil.rain_path(position, ray[None], [end], axis, shape, ceiling)[0]
    expected = brute_path(position, ray, end, axis, shape, ceiling, 0.0)
    assert found == pytest.approx(expected, rel=2e-3, abs=0.05)


@pytest.mark.parametrize("shown", [0.3, 10.0, 60.0])
@pytest.mark.parametrize("end", [0.1, 8.0, 45.0, 90.0, math.inf])
def test_the_drops_share_is_left_out_where_it_rains_at_the_full_rate(
    shown: float, end: float
) -> None:
    """Of a ray inside the full rate, what is left is the integral of what the drops do not show."""
    axis, shape = axis_of((0.0, 0.0), 0.3), (900.0, 800.0, 0.9)
    for pitch in (0.0, 0.5, -0.3):
        ray = np.array([math.cos(pitch), math.sin(pitch), 0.0])
        found = veil.rain_path((1.0, 2.0, 3.0), ray[None], [end], axis, shape, 5000.0, shown)[0]
        expected = brute_path((1.0, 2.0, 3.0), ray, end, axis, shape, 5000.0, shown)
        assert found == pytest.approx(expected, rel=1e-3, abs=1e-3)


@settings(max_examples=50, deadline=None)
@given(place, ways, st.floats(0, 0.99), st.floats(0, 200), st.floats(0, 500), st.floats(0, 500))
def test_a_path_grows_with_its_end_and_shrinks_with_what_is_shown(
    position: Any, ray: np.ndarray, inner: float, shown: float, first: float, more: float
) -> None:
    axis, shape = axis_of((0.0, 0.0), 0.4), (120.0, 60.0, inner)
    rays = np.tile(ray, (2, 1))
    near, far = veil.rain_path(position, rays, [first, first + more], axis, shape, 300.0)
    assert 0.0 <= near <= far + 1e-9
    assert near <= first + 1e-9 and far <= first + more + 1e-9
    left = veil.rain_path(position, rays, [first, first + more], axis, shape, 300.0, shown)
    assert 0.0 <= left[0] <= near + 1e-9 and 0.0 <= left[1] <= far + 1e-9


def test_the_profile_and_the_opacity() -> None:
    axis, shape = axis_of((5.0, 5.0), 1.0), (50.0, 30.0, 0.64)
    rim = np.array([[5.0 + 50.0 * math.cos(1.0) * r, 5.0 - 50.0 * math.sin(1.0) * r]
                    for r in (0.0, 0.79, 0.81, 1.0, 1.2)])  # fmt: skip
    share = veil.full_share(rim, axis, shape)
    assert share[0] == share[1] == 1.0 and share[3:] == pytest.approx([0.0, 0.0])
    assert share[2] == pytest.approx((1 - 0.81**2) / 0.36)
    assert veil.opacity([0.0, 100.0], 0.01) == pytest.approx([0.0, 1 - math.exp(-1)])


def test_where_rain_begins_its_lower_edge_is_that_of_the_drops() -> None:
    """Against a sum over small steps, each with the share that has come down there."""
    axis, shape, dry = axis_of((0.0, -150.0), 0.4), (70.0, 45.0, 0.5), (20.0, LONG, 0.0, 0.0)
    for pitch in (-0.2, 0.0, 0.1, 0.3, 0.6):
        ray = np.array([0.0, math.sin(pitch), -math.cos(pitch)])
        t = (np.arange(40_000) + 0.5) * 0.01
        at = np.array(HERE) + ray * t[:, None]
        share = veil.full_share(at[:, [0, 2]], axis, shape) * (at[:, 1] <= 200.0)
        share *= extinction_arrived(200.0 - at[:, 1], dry, 25.0)
        found = veil.rain_path(
            HERE, ray[None], [math.inf], axis, shape, 200.0, 0.0, dry, 25.0
        )[0]  # fmt: skip
        assert found == pytest.approx(float(share.sum() * 0.01), rel=0.05, abs=0.5)
