"""Three wavelengths as linear RGB, against the colours of whole spectra."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray

from weather_ecs.physics import atmosphere
from weather_ecs.physics.daylight import LUMINANCE
from weather_ecs.physics.spectrum import SEEN, WAVELENGTHS, seen

Array = NDArray[np.float64]

WAVES = np.arange(390.0, 711.0, 20.0)  # nm
# 1e-26 m2 a molecule, in steps of 10 nm from 390 (Serdyuchenko and others 2014, at 233 K).
OZONE = np.array(
    [0.066, 0.153, 0.276, 0.552, 0.845, 1.58, 2.32, 3.67, 4.92, 7.75, 9.02, 14.8, 16.0, 21.4, 27.6,
     30.9, 35.0, 42.7, 46.7, 44.0, 47.0, 50.2, 43.1, 37.4, 32.2, 26.6, 22.4, 18.5, 14.7, 12.1, 9.42,
     7.46, 6.57]
)  # fmt: skip
TO_RGB = np.array(
    [[3.2405, -1.5371, -0.4985], [-0.9693, 1.8760, 0.0416], [0.0556, -0.2040, 1.0572]]
)


def rayleigh(wave: Array) -> Array:
    """1/km at the ground (Bodhaine and others 1999, Eq. 30)."""
    two = (wave / 1000.0) ** 2
    above, below = 1.0455996 - 341.29061 / two - 0.90230850 * two, 1.0 + 0.0027059889 / two
    return np.asarray(0.0021520 * above / (below - 85.968563 * two) / atmosphere.RAYLEIGH_HEIGHT)


def ozone(wave: Array) -> Array:
    """1/km at 25 km, for 300 Dobson units in a layer that is 15 km at its full density."""
    return 300.0 * 2.687e20 / 15.0 * 1e-26 * np.interp(wave, 390.0 + 10.0 * np.arange(33), OZONE)


def matching(wave: Array) -> Array:
    """(3, n): CIE 1931 (Wyman, Sloan and Shirley 2013)."""

    def lobe(middle: float, below: float, above: float) -> Array:
        x = (wave - middle) * np.where(wave < middle, below, above)
        return np.exp(-0.5 * x * x)

    red = 1.056 * lobe(599.8, 0.0264, 0.0323) - 0.065 * lobe(501.1, 0.0490, 0.0382)
    return np.stack([
        0.362 * lobe(442.0, 0.0624, 0.0374) + red,
        0.821 * lobe(568.8, 0.0213, 0.0247) + 0.286 * lobe(530.9, 0.0613, 0.0322),
        1.217 * lobe(437.0, 0.0845, 0.0278) + 0.681 * lobe(459.0, 0.0385, 0.0725),
    ])  # fmt: skip


def weights() -> Array:
    """(3, n): linear RGB of a spectrum over the sun's own."""
    sun = WAVES**-5.0 / np.expm1(1.4388e7 / (WAVES * 5778.0))
    rgb = TO_RGB @ (matching(WAVES) * sun)
    return np.asarray(rgb / rgb.sum(1, keepdims=True))


@pytest.fixture
def whole_spectra(monkeypatch: pytest.MonkeyPatch) -> Iterator[pytest.MonkeyPatch]:
    """Leaves no table of other wavelengths behind."""
    atmosphere._orders.cache_clear()
    yield monkeypatch
    atmosphere._orders.cache_clear()


def spectra(altitudes: tuple[float, ...], patch: pytest.MonkeyPatch) -> dict[float, Array]:
    """The sky's, (parts of the sky, wavelengths), three wavelengths at a time."""
    found: dict[float, list[Array]] = {altitude: [] for altitude in altitudes}
    padded = np.concatenate([WAVES, WAVES[-1:]])
    for three in padded.reshape(-1, 3):
        patch.setattr(atmosphere, "RAYLEIGH", rayleigh(three))
        patch.setattr(atmosphere, "OZONE", ozone(three))
        patch.setattr(atmosphere, "HAZE_COLOR", (three / 550.0) ** -1.3)
        atmosphere._orders.cache_clear()
        for altitude in altitudes:
            found[altitude].append(part(altitude))
    return {key: np.concatenate(parts, 1)[:, : len(WAVES)] for key, parts in found.items()}


def part(altitude: float) -> Array:
    """Low, middle and high sky, towards the sun and away from it, and the sun where it is up."""
    air, haze = atmosphere.sky_part(altitude, 2.2, 1)
    light = (air + 0.06 * haze)[::3, ::8].reshape(-1, 3)
    sun = atmosphere.transmittance(altitude)
    return np.concatenate([light, sun[None]]) if altitude > 0.0 else light


def test_the_coefficients_are_those_of_the_wavelengths() -> None:
    waves = np.array(WAVELENGTHS)
    assert np.allclose(atmosphere.RAYLEIGH, rayleigh(waves), rtol=0.005)
    assert np.allclose(atmosphere.OZONE, ozone(waves), rtol=0.05)
    assert np.allclose(atmosphere.HAZE_COLOR, (waves / 550.0) ** -1.3, rtol=0.005)


def test_colours_of_the_sky_are_those_of_its_whole_spectrum(
    whole_spectra: pytest.MonkeyPatch,
) -> None:
    """At noon, at sunset and in twilight; as they are the wavelengths are five times as far off."""
    altitudes = (53.0, 8.0, 0.0, -4.0)
    three = {altitude: part(altitude) for altitude in altitudes}
    whole = spectra(altitudes, whole_spectra)
    true = np.concatenate([whole[altitude] @ weights().T for altitude in altitudes])
    raw = np.concatenate([three[altitude] for altitude in altitudes])
    light = (true @ LUMINANCE)[:, None]
    ours, as_it_is = (np.abs(x - true) / light for x in (seen(raw), raw))
    assert (ours.mean(0) < (0.025, 0.02, 0.02)).all()
    assert ours.max() < 0.1
    assert as_it_is[:, 0].mean() > 5.0 * ours[:, 0].mean()


def test_white_is_white_and_nothing_is_darker_than_dark() -> None:
    assert np.allclose(SEEN.sum(1), 1.0, atol=1e-9)
    ember = seen(np.array([[0.2, 0.0, 0.0], [0.0, 0.0, 1.0]]))
    assert ember.min() == 0.0
    assert ember[0, 0] > 0.2 and math.isclose(ember[1, 2], SEEN[2, 2])
