"""The drops' step keeps the law of Eq. 2, wherever the observer goes."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from weather_ecs.physics import rain_step
from weather_ecs.physics.container import Area, Container, ContainerSettings, births, place
from weather_ecs.physics.drops import diameter_quantile, terminal_speed
from weather_ecs.physics.rain_place import to_container
from weather_ecs.physics.turbulence import air_flow
from weather_ecs.physics.words import hash_unit, hash_word

SIZE = ContainerSettings(40.0, 24.0, 0.75)
AREA = Area((0.0, 0.0), (5000.0, 4000.0), 0.0, 400.0)
N = 60_000


def make(
    before: Container, now: Container, seed: int, dt: float = 0.05,
    wind: tuple[float, float, float] = (8.0, 0.0, 3.0), fresh: int = N,
) -> rain_step.Step:  # fmt: skip
    return rain_step.Step(
        rain_step.axis_of(before), rain_step.shape_of(before),
        rain_step.axis_of(now), rain_step.shape_of(now),
        (*wind, dt), rain_step.law_of(25.0), seed, fresh,
    )  # fmt: skip


def own_axes(p: np.ndarray, container: Container) -> np.ndarray:
    return to_container(p[:, [0, 2]], rain_step.axis_of(container), rain_step.shape_of(container))


def assert_even(p: np.ndarray, record: np.ndarray, container: Container) -> None:
    """Distances as in Eq. 2, headings and heights even, no drop outside its own half disc."""
    q = own_axes(p, container)
    d = np.hypot(q[:, 0], q[:, 1])
    edges = np.linspace(0, 1, 11)
    expected = (1 - edges[:-1]) ** 2 - (1 - edges[1:]) ** 2
    assert np.allclose(np.histogram(d, edges)[0] / len(d), expected, atol=0.006)
    angles = np.histogram(np.arctan2(q[:, 1], q[:, 0]), 6, (-math.pi / 2, math.pi / 2))[0]
    assert np.allclose(angles / len(d), 1 / 6, atol=0.008)
    heights = np.histogram((p[:, 1] - container.bottom) / container.height, 8, (0, 1))[0]
    assert np.allclose(heights / len(d), 1 / 8, atol=0.008)
    assert (d <= record[:, 2] * 1.001 + 1e-4).all() and (q[:, 0] >= -1e-3).all()


PATHS = {
    "standing": lambda t: ((0.0, 1.7, 0.0), 0.0),
    "running": lambda t: ((6.0 * t, 1.7, 0.0), 0.0),
    "sidling": lambda t: ((6.0 * t, 1.7, 0.0), 1.57),
    "turning": lambda t: ((math.sin(t), 1.7, 0.0), 2.0 * t),
    "roaming": lambda t: (
        (6 * t * math.cos(0.2 * t), 1.7 + 4 * math.sin(t), -6 * t * math.sin(0.3 * t)),
        1.8 * math.sin(0.7 * t),
    ),
    "jumping about": lambda t: ((97.0 * (int(t * 4) % 7), 1.7, 31.0 * (int(t * 3) % 5)), 0.1 * t),
}


@pytest.mark.parametrize("name", PATHS)
def test_the_filling_stays_even(name: str) -> None:
    record = births(N, np.random.default_rng(1))
    p = v = np.zeros((N, 3), np.float32)
    before = None
    for k in range(100):
        observer, heading = PATHS[name](k * 0.05)
        now = place(AREA, observer, heading, math.radians(50), SIZE, before, 0.05)
        fresh = 0 if before is None else N
        p, v = rain_step.step(record, p, v, make(before or now, now, k + 1, fresh=fresh))
        before = now
        if k % 33 == 0 or k == 99:
            assert np.isfinite(p).all()
            assert_even(p, record, now)


def test_the_filling_stays_even_in_turbulent_air() -> None:
    # Air that brings drops in at different speeds must bring in as many more where it is quicker:
    # those let in anywhere alike were a fifth too many below the top and behind the windward side.
    record = births(15_000, np.random.default_rng(1))
    now = place(AREA, (0.0, 6.0, 0.0), 0.0, math.radians(50), SIZE)
    p = v = np.zeros((len(record), 3), np.float32)
    heights, windward, inside = np.zeros(12), 0.0, 0.0
    for k in range(110):
        run = (9.0 * 0.1 * k, 0.0, 2.25 * 0.1 * k)
        flow = air_flow((9.0, 0.0, 0.0), turbulence=2.25, scale=5.0, run=run)
        fresh = len(record) if k else 0
        p, v = rain_step.step(
            record, p, v, replace(make(now, now, k + 1, 0.1, fresh=fresh), flow=flow)
        )
        if k >= 30:
            heights += np.histogram((p[:, 1] - now.bottom) / now.height, 12, (0, 1))[0]
            share = own_axes(p, now)[:, 0] / record[:, 2]  # of its own half disc
            windward += np.mean(share < 0.05)
            inside += np.mean((share >= 0.05) & (share < 0.25))
    assert heights[-1] / heights[1:].mean() == pytest.approx(1.0, abs=0.05)
    across = {a: 2.0 / math.pi * (a * math.sqrt(1 - a * a) + math.asin(a)) for a in (0.05, 0.25)}
    assert windward / 80 == pytest.approx(across[0.05], rel=0.05)
    assert inside / 80 == pytest.approx(across[0.25] - across[0.05], rel=0.05)


def test_what_stays_inside_keeps_its_place_in_the_world() -> None:
    record = births(N, np.random.default_rng(2))
    first = place(AREA, (0.0, 1.7, 0.0), 0.0, math.radians(45), SIZE)
    zero = np.zeros((N, 3), np.float32)
    p, v = rain_step.step(record, zero, zero, make(first, first, 1, fresh=0))
    now = place(AREA, (3.0, 1.7, 2.0), 1.0, math.radians(45), SIZE, first, 0.05)
    assert now.center != first.center and now.heading != first.heading
    moved, _ = rain_step.step(record, p, v, make(first, now, 2, dt=0.0))
    q = own_axes(p, now)
    stays = (q[:, 0] > 1e-3) & (np.hypot(q[:, 0], q[:, 1]) < record[:, 2] - 1e-3)
    assert stays.mean() > 0.5
    assert np.array_equal(moved[stays], p[stays])


def test_terminal_motion_and_drift_with_the_wind() -> None:
    record = births(2000, np.random.default_rng(2))
    first = place(AREA, (0.0, 1.7, 0.0), 0.0, math.radians(45), SIZE)
    zero = np.zeros((2000, 3), np.float32)
    s = make(first, first, 1, fresh=0, wind=(5.0, 0.0, -2.0))
    p, v = rain_step.step(record, zero, zero, s)
    fall = terminal_speed(diameter_quantile(record[:, 3], 25.0))
    assert np.allclose(v[:, 1], -fall, atol=1e-4)
    assert np.allclose(v[:, 0], 5.0) and np.allclose(v[:, 2], -2.0)
    # Small drops take up a change of wind sooner than large ones.
    gust = make(first, first, 2, dt=0.1, wind=(15.0, 0.0, -2.0), fresh=2000)
    moved, after = rain_step.step(record, p, v, gust)
    # A drop that began anew moves with the new wind already.
    kept = np.hypot(*(moved - p)[:, [0, 2]].T) < 2.0
    kept &= (moved[:, 1] < p[:, 1]) & (after[:, 0] < 14.99)
    assert kept.mean() > 0.8
    order = np.flatnonzero(kept)[np.argsort(record[kept, 3])]
    assert (np.diff(after[order, 0]) <= 1e-5).all()


def test_zero_dt_at_the_same_place_changes_nothing() -> None:
    record = births(500, np.random.default_rng(5))
    first = place(AREA, (0.0, 1.7, 0.0), 0.0, math.radians(45), SIZE)
    zero = np.zeros((500, 3), np.float32)
    p, v = rain_step.step(record, zero, zero, make(first, first, 1, fresh=0))
    again, _ = rain_step.step(record, p, v, make(first, first, 2, dt=0.0, fresh=500))
    assert np.array_equal(p, again)


def test_hash_is_even_and_words_differ() -> None:
    words = hash_word(np.arange(100_000, dtype=np.uint32))
    assert len(np.unique(words)) > 99_990
    units = hash_unit(np.arange(100_000, dtype=np.uint32))
    assert units.min() >= 0 and units.max() < 1
    assert np.allclose(np.histogram(units, 10, (0, 1))[0] / 1e5, 0.1, atol=0.005)
