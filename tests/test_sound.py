"""What the walk sounds like: levels, spectra, times; and that it does without a device."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from demo_game.sound import Soundscape, laws
from demo_game.sound.overlap import FREQUENCIES, HOP, RATE, Overlap, amplitudes
from demo_game.sound.synth import FLUTTER, TURBULENCE, Heard, Synth, to_bytes
from tests.sound_levels import SETTLING, onset


def heard(blocks: int = 120, seed: int = 3, **told: float) -> NDArray:
    """(2, n) samples of a steady weather."""
    synth = Synth(seed)
    synth.hear(Heard(**told))
    made = [synth.block() for _ in range(SETTLING + blocks)]
    return np.concatenate(made[SETTLING:], axis=1)


def power(signal: NDArray) -> NDArray:
    """Power in the bins of a frame, the mean over a signal."""
    row = signal.reshape(-1)
    frames = row[: row.size // 2048 * 2048].reshape(-1, 2048) * np.hanning(2048)
    return (np.abs(np.fft.rfft(frames, axis=1)) ** 2).mean(axis=0)


def band(signal: NDArray, low: float, high: float) -> float:
    """dB in a band."""
    inside = (low <= FREQUENCIES) & (high > FREQUENCIES)
    return float(10.0 * np.log10(power(signal)[inside].sum()))


def db(signal: NDArray) -> float:
    return float(20.0 * np.log10(signal.std()))


def test_rain_is_as_loud_as_its_law_says() -> None:
    rates = np.array([2.0, 10.0, 50.0])
    levels = [db(heard(200, rain_rate=rate)) for rate in rates]
    slope = np.polyfit(np.log10(rates), levels, 1)[0]
    assert pytest.approx(1.892, abs=1e-3) == laws.RAIN_EXPONENT
    assert slope == pytest.approx(10.0 * laws.RAIN_EXPONENT * laws.RANGE, abs=1.0)
    for rate, level in zip(rates, levels, strict=True):
        assert level == pytest.approx(20.0 * np.log10(laws.rain_level(rate)), abs=1.2)


def test_heavier_rain_is_darker() -> None:
    centres = []
    for rate in (2.0, 10.0, 50.0):
        found = power(heard(rain_rate=rate))
        centres.append(float(np.exp((found * np.log(FREQUENCIES + 1.0)).sum() / found.sum())))
    assert centres[0] > centres[1] > centres[2]
    assert laws.rain_peak(2.0) == pytest.approx(2900.0, rel=0.03)  # 7.4 m/s over 2.5 mm
    assert laws.rain_peak(50.0) == pytest.approx(1830.0, rel=0.03)


def test_single_drops_are_heard_over_the_bed() -> None:
    def crest(signal: NDArray) -> float:
        return float(np.mean(signal**4) / np.mean(signal**2) ** 2)

    assert crest(heard(rain_rate=1.0)) > 6.0  # a gaussian has 3
    assert crest(heard(rain_rate=50.0)) < 6.0


def test_a_roof_is_a_low_pass() -> None:
    f = np.array([125.0, 650.0, 1300.0, 2600.0, 5200.0])
    gain = 20.0 * np.log10(laws.shelter_gain(f, 0.0, 1.0)) + laws.ROOF_LOSS
    assert gain == pytest.approx([0.0, -3.0, -12.3, -24.1, -36.1], abs=0.15)
    windy = {"wind_speed": 14.0}
    outside, inside = heard(400, **windy), heard(400, roof=1.0, **windy)
    for low, high in ((100, 200), (1200, 1400), (2400, 2800), (4800, 5600)):
        middle = laws.shelter_gain(np.array([0.5 * (low + high)]), 0.0, 1.0)[0]
        lost = band(outside, low, high) - band(inside, low, high)
        assert lost == pytest.approx(-20.0 * np.log10(middle), abs=1.5), low


def test_a_roof_is_drummed_upon_by_the_rain_above_it() -> None:
    outside, inside = heard(rain_rate=20.0), heard(rain_rate=20.0, roof=1.0)
    assert band(inside, 100, 400) > band(outside, 100, 400) + 3.0
    assert band(inside, 3000, 9000) < band(outside, 3000, 9000) - 15.0
    louder = heard(rain_rate=60.0, roof=1.0)
    assert db(louder) > db(inside) + 5.0
    assert db(heard(rain_rate=20.0, leaves=1.0)) > db(outside)
    leaf_band = heard(rain_rate=20.0, leaves=1.0)
    assert band(leaf_band, 9000, 16000) < band(outside, 9000, 16000) - 4.0
    assert db(heard(rain_rate=20.0, snow_depth=0.1)) < db(outside) - 3.0


def test_no_pitch_moves_under_a_closing_filter() -> None:
    frames, tones = Overlap(0), (12, 24, 48)  # bins
    t, out = np.arange(80 * HOP), []
    tone = sum(np.sin(2.0 * np.pi * k * t / 2048.0) for k in tones) * np.ones((2, 1)) / 4.0
    for k in range(80):
        gain = laws.shelter_gain(FREQUENCIES, 0.0, min(k / 60.0, 1.0))
        out.append(frames.block(tone[:, k * HOP : (k + 1) * HOP], gain, 0.0 * FREQUENCIES))
    made = np.concatenate(out, axis=1)[0]
    for first in (2 * HOP, 30 * HOP, 70 * HOP):
        found = np.abs(np.fft.rfft(made[first : first + 4 * HOP] * np.hanning(4 * HOP)))
        loud = {int(k) for k in np.flatnonzero(found > 0.03 * found.max())}
        assert loud <= {2 * k + d for k in tones for d in (-1, 0, 1)}
        assert 24 in loud


def test_a_filter_that_is_open_changes_nothing() -> None:
    frames, signal = Overlap(0), np.random.default_rng(1).normal(0, 0.1, (2, 6 * HOP))
    open_, silent = np.ones_like(FREQUENCIES), np.zeros_like(FREQUENCIES)
    out = [frames.block(signal[:, k * HOP : (k + 1) * HOP], open_, silent) for k in range(6)]
    # Given one block ahead, it comes one block later.
    assert np.concatenate(out[1:], axis=1) == pytest.approx(signal[:, : 5 * HOP], abs=1e-6)
    noise = amplitudes(laws.rain_shape(FREQUENCIES, 2000.0), 0.1)
    made = [frames.block(np.zeros((2, HOP)), open_, noise) for _ in range(200)]
    assert np.std(made[2:]) == pytest.approx(0.1, rel=0.02)


def test_wind_is_as_loud_as_its_speed_says() -> None:
    speeds = np.array([5.0, 8.0, 12.0, 18.0])
    levels = [db(heard(700, wind_speed=speed)) for speed in speeds]
    slope = np.polyfit(np.log10(speeds), levels, 1)[0]
    assert slope == pytest.approx(10.0 * laws.WIND_EXPONENT * laws.RANGE, abs=4.0)
    assert not heard(20, wind_speed=1.0).any()
    assert 0.0 < TURBULENCE * FLUTTER < 0.5  # gusts come from the weather, not from here
    low, high = heard(200, wind_speed=6.0), heard(200, wind_speed=18.0)
    rises = [band(high, a, 2 * a) - band(low, a, 2 * a) for a in (200, 400, 800, 1600)]
    assert rises == sorted(rises) and rises[-1] > rises[0] + 6.0  # its band moves up


def test_a_gust_is_followed_without_a_click() -> None:
    synth, made = Synth(5), []
    for k in range(160):
        synth.hear(Heard(wind_speed=4.0 if k // 20 % 2 else 16.0, roof=1.0 if k > 80 else 0.0))
        made.append(synth.block())
    signal = np.concatenate(made, axis=1)[0]
    bend = np.abs(np.diff(signal, 2))
    places = np.arange(HOP, signal.size - 1, HOP)
    at_joints = np.maximum(bend[places - 1], bend[places - 2])
    # As much as anywhere else: beside each joint's own neighbours, and over all of them.
    around = np.array([bend[p - 200 : p + 200].mean() for p in places])
    assert (at_joints / around).max() < 6.0
    assert (at_joints / around).mean() < 1.8
    levels = [np.std(block) for block in made]
    assert max(levels[10:20]) > 3.0 * max(levels[32:40])


@pytest.mark.parametrize("delay", [0.0, 0.4, 1.7, 5.88])
def test_thunder_begins_when_it_is_due(delay: float) -> None:
    synth = Synth(2)
    synth.hear(Heard())
    for _ in range(SETTLING):
        synth.block()
    synth.thunder(2000.0, delay)
    made = np.concatenate([synth.block() for _ in range(300)], axis=1)
    assert onset(made, 0.004) == pytest.approx(delay, abs=HOP / RATE + 0.002)


def thunder(distance: float, seed: int = 4) -> NDArray:
    synth = Synth(seed)
    synth.hear(Heard())
    for _ in range(SETTLING):
        synth.block()
    synth.thunder(distance, 0.1)
    return np.concatenate([synth.block() for _ in range(1100)], axis=1)


def test_near_thunder_cracks_and_far_thunder_rumbles() -> None:
    near, far = thunder(80.0), thunder(9000.0)
    assert np.abs(near).max() > 0.45 and 0.03 < np.abs(far).max() < 0.2
    for signal in (near, far):
        assert np.abs(signal[:, -HOP:]).max() < 0.01  # it ends

    def lasts(signal: NDArray) -> float:
        sum_ = np.cumsum((signal**2).sum(axis=0))
        return float(np.searchsorted(sum_, 0.9 * sum_[-1])) / RATE

    assert lasts(near) < 2.5 and lasts(far) > 1.7 * lasts(near)
    shares = [10.0 ** ((band(s, 1000, 8000) - band(s, 20, 8000)) / 10.0) for s in (near, far)]
    assert shares[0] > 20.0 * shares[1]
    assert not thunder(30_000.0).any()
    assert not thunder(float("nan")).any()
    assert np.abs(thunder(0.0)).max() < 1.0  # on the listener


def test_air_keeps_the_high_frequencies() -> None:
    lost = 1000.0 * laws.air_absorption(np.array([125.0, 1000.0, 4000.0, 8000.0]))
    # ISO 9613-2, table 2: 10 degrees, 70 % humidity.
    assert lost == pytest.approx([0.4, 3.7, 32.8, 117.0], rel=0.16)


@pytest.mark.parametrize(
    "told",
    [
        {"rain_rate": 1e6, "wind_speed": 999.0},
        {"rain_rate": 150.0, "roof": 1.0, "leaves": 1.0, "wind_speed": 40.0},
        {"rain_rate": -5.0, "wind_speed": -3.0, "snow_depth": -1.0},
        {},
    ],
)
def test_it_stays_finite_and_within_bounds(told: dict[str, float]) -> None:
    synth = Synth(1)
    synth.hear(Heard(**told))
    synth.thunder(10.0, 0.0)
    made = np.concatenate([synth.block() for _ in range(60)], axis=1)
    assert np.isfinite(made).all() and np.abs(made).max() <= 1.0
    assert len(to_bytes(made)) == made.size * 2


def test_the_same_calls_give_the_same_sound() -> None:
    told = {"rain_rate": 8.0, "wind_speed": 7.0}
    assert (heard(30, seed=9, **told) == heard(30, seed=9, **told)).all()
    assert (heard(30, seed=9, **told) != heard(30, seed=10, **told)).any()
    assert (thunder(700.0, 5) == thunder(700.0, 5)).all()


def test_volume_and_mute_fade() -> None:
    sound = Soundscape(1, device=False)
    levels = []
    for volume, muted in ((1.0, False), (0.5, False), (1.0, True)):
        sound.volume, sound.muted = volume, muted
        sound.update(0.1, 30.0, wind_speed=6.0)
        made = [sound.synth.block() for _ in range(80)]
        levels.append(np.std(made[60:]))
    assert levels[1] == pytest.approx(0.25 * levels[0], rel=0.1)
    assert levels[2] == 0.0
    sound.muted = False
    sound.update(0.1, 30.0)
    assert np.std([sound.synth.block() for _ in range(60)][40:]) > 0.01
    sound.hush()
    assert not np.any([sound.synth.block() for _ in range(80)][70:])
    sound.close()
    sound.close()
