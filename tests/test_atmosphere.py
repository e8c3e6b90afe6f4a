"""The clear sky, daylight and twilight against published figures."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics import atmosphere, daylight, illuminance
from weather_ecs.physics.daylight import LUMINANCE, SUN_LUX, clear_sky, scene


def sine(degrees: float) -> float:
    return math.sin(math.radians(degrees))


def day(altitude: float, **how: float) -> daylight.Scene:
    """A sky without a moon."""
    sun, moon = clear_sky(altitude), clear_sky(-30.0)
    return scene(sun, sine(altitude), moon, -0.5, 180.0, **how)


def radiance(altitude: float) -> NDArray[np.float64]:
    """(ROWS, COLUMNS, 3) of the whole sky."""
    sky = clear_sky(altitude)
    up, away = atmosphere.table_directions()
    h = math.radians(altitude)
    cosine = np.sqrt(1.0 - up * up) * np.cos(away) * math.cos(h) + up * math.sin(h)
    return sky.air + sky.haze / daylight.HAZE_SHARE * atmosphere.haze_phase(cosine)[..., None]


def test_phase_functions_scatter_all_there_is() -> None:
    c = np.linspace(-1.0, 1.0, 20001)
    for phase in (atmosphere.rayleigh_phase, atmosphere.haze_phase):
        assert 2.0 * math.pi * np.trapezoid(phase(c), c) == pytest.approx(1.0, abs=1e-4)


def test_transmittance_of_clean_air_as_published() -> None:
    """Rayleigh's optical depths (Bodhaine et al. 1999) and 300 Dobson units of ozone."""
    depth = -np.log(atmosphere.transmittance(90.0, 1.0))
    ozone = np.array([0.0299, 0.0234, 0.0014])
    assert np.allclose(depth, np.array([0.0559, 0.1051, 0.2226]) + ozone, rtol=0.1)


def test_sunlight_reddens_with_the_air_mass() -> None:
    """Beer's law with Kasten and Young's air mass (1989), and a redder sun the lower it is."""
    overhead = -np.log(atmosphere.transmittance(90.0))
    for altitude, mass in ((60.0, 1.154), (30.0, 1.994), (15.0, 3.814), (10.0, 5.586)):
        depth = -np.log(atmosphere.transmittance(altitude))
        assert np.allclose(depth / overhead, mass, rtol=0.03)
    ratios = [
        float(t[0] / t[2]) for t in map(atmosphere.transmittance, (90.0, 40.0, 20.0, 10.0, 5.0))
    ]
    assert ratios == sorted(ratios)
    assert ratios[-1] > 5.0
    assert not atmosphere.transmittance(-1.0).any()


@pytest.mark.parametrize(
    ("altitude", "lux"), [(60, 105_000), (45, 78_000), (30, 47_900), (10, 11_000)]
)
def test_daylight_as_measured(altitude: float, lux: float) -> None:
    """Janiczek and DeYoung 1987, who fitted measurements; clear sky and sun on level ground."""
    sky = clear_sky(altitude)
    ours = SUN_LUX * float((sky.diffuse + sky.sun * sine(altitude)) @ LUMINANCE)
    assert ours == pytest.approx(lux, rel=0.3)
    assert 0.1 < float(sky.diffuse @ LUMINANCE) / (ours / SUN_LUX) < 0.65


@pytest.mark.parametrize(("altitude", "lux"), [(0, 759.0), (-3, 90.0), (-6, 3.4), (-9, 0.15)])
def test_the_tables_alone_come_near_in_twilight(altitude: float, lux: float) -> None:
    """What Hillaire's model has of itself, without the published figures: within three times."""
    table = atmosphere.sky_table(altitude)
    up, away = atmosphere.table_directions()
    h = math.radians(altitude)
    cosine = np.sqrt(1.0 - up * up) * np.cos(away) * math.cos(h) + up * math.sin(h)
    shown = (table.air + table.haze * atmosphere.haze_phase(cosine)[..., None]) @ LUMINANCE
    rows = 2.0 * np.trapezoid(shown * up, away[0], axis=1)
    ours = SUN_LUX * float(np.trapezoid(rows, up[:, 0]))
    assert lux / 3.0 < ours < lux * 3.0


def test_published_illuminances() -> None:
    """Civil and nautical twilight, and the full moon."""
    assert illuminance.sun_illuminance(-6.0) == pytest.approx(3.4, rel=0.03)
    assert illuminance.sun_illuminance(-12.0) == pytest.approx(0.008, rel=0.03)
    assert 0.1 < illuminance.moon_illuminance(60.0, 0.0) < 0.3
    assert illuminance.moon_phase_factor(90.0) == pytest.approx(0.1, rel=0.25)  # half: a tenth
    assert illuminance.moon_illuminance(-5.0, 0.0) == 0.0
    for edge in (20.0, 5.0, -0.8, -5.0, -12.0):
        below, above = illuminance.sun_illuminance(edge - 1e-6), illuminance.sun_illuminance(edge)
        assert below == pytest.approx(above, rel=0.06)


@pytest.mark.parametrize("altitude", [-3.0, -6.0, -9.0, -12.0])
def test_twilight_has_the_published_light(altitude: float) -> None:
    ours = SUN_LUX * float(clear_sky(altitude).diffuse @ LUMINANCE)
    assert ours == pytest.approx(illuminance.sun_illuminance(altitude), rel=0.1)


def test_zenith_is_blue_and_the_horizon_pale() -> None:
    sky = radiance(45.0)
    zenith, horizon = sky[-1, 0], sky[1].mean(0)
    assert zenith[2] > 2.0 * zenith[0]
    assert horizon[2] < 1.3 * horizon[0]
    assert horizon @ LUMINANCE > 2.0 * (zenith @ LUMINANCE)


def test_near_sunset_the_horizon_is_red_and_the_zenith_blue() -> None:
    sky = radiance(1.0)
    toward = sky[2, 0]
    assert toward[0] > 2.0 * toward[1] > 2.0 * toward[2]
    assert sky[-1, 0, 2] > 1.5 * sky[-1, 0, 0]
    twilight = radiance(-5.0)
    assert twilight[-1, 0, 2] > 2.0 * twilight[-1, 0, 0]  # the blue hour


def test_distribution_is_near_the_cie_clear_sky() -> None:
    """CIE clear sky, type 12, over the zenith, sun at 40 degrees: within a factor of 1.8."""
    altitude = 40.0
    ours = radiance(altitude) @ LUMINANCE
    up, away = atmosphere.table_directions()
    h = math.radians(altitude)
    apart = np.arccos(
        np.clip(np.sqrt(1 - up**2) * np.cos(away) * math.cos(h) + up * math.sin(h), -1, 1)
    )

    def scattered(x: NDArray[np.float64] | float) -> NDArray[np.float64]:
        return (
            1.0
            + 10.0 * (np.exp(-3.0 * np.asarray(x)) - math.exp(-1.5 * math.pi))
            + 0.45 * np.cos(x) ** 2
        )

    cie = (1.0 - np.exp(-0.32 / np.maximum(up, 1e-3))) / (1.0 - math.exp(-0.32))
    cie *= scattered(apart) / scattered(math.pi / 2.0 - h)
    part = (up > sine(8.0)) & (apart > math.radians(15.0))
    ratio = (ours / ours[-1, 0] / cie)[part]
    assert 1.0 / 1.8 < ratio.min() < ratio.max() < 1.8


def test_a_clear_noon_keeps_the_levels_of_the_package() -> None:
    noon = day(daylight.HIGH)
    assert np.allclose(noon.sun_color, (1.0, 0.95, 0.86), rtol=1e-3)
    for ours, usual in ((noon.zenith, (0.36, 0.47, 0.62)), (noon.horizon, (0.68, 0.73, 0.78))):
        assert ours @ LUMINANCE == pytest.approx(np.array(usual) @ LUMINANCE, rel=0.3)
        assert np.allclose(ours, usual, rtol=0.4)


def test_the_eye_follows_but_never_quite() -> None:
    """Each darker sky is shown darker, and under the stars there is still something to see."""
    heights = (60.0, 40.0, 20.0, 10.0, 3.0, 0.0, -3.0, -6.0, -9.0, -13.0)
    shown = []
    for height in heights:
        it = day(height)
        ground = it.sun_color * max(sine(height), 0.0) + 0.5 * it.zenith + 0.25 * it.horizon
        shown.append(float(ground @ LUMINANCE))
    assert shown == sorted(shown, reverse=True)
    night = day(-40.0)
    assert 0.005 < float(night.zenith @ LUMINANCE) < 0.06
    assert night.zenith[2] > 2.0 * night.zenith[0]  # dark blue
    camera = day(-6.0, adaptation=0.0)
    assert camera.exposure == 1.0
    assert float(camera.zenith @ LUMINANCE) < 1e-3
    assert day(-6.0, exposure=2.0).exposure == pytest.approx(2.0 * day(-6.0).exposure)


def test_the_moon_lights_the_night() -> None:
    full, new = (
        scene(clear_sky(-40.0), -0.6, clear_sky(50.0), sine(50.0), phase) for phase in (0.0, 175.0)
    )
    assert full.moon_color @ LUMINANCE > 20.0 * (new.moon_color @ LUMINANCE)
    assert full.ground @ LUMINANCE > new.ground @ LUMINANCE
    assert not full.sun_color.any()


def test_clouds_take_the_sun_and_the_colours() -> None:
    skies = [day(40.0, overcast=share) for share in (0.0, 0.5, 1.0)]
    assert [float(s.sun_color.sum()) > 0.0 for s in skies] == [True, True, False]
    grey = skies[2].zenith
    assert np.ptp(grey) < 0.15 * grey.mean()
    assert skies[2].horizon.mean() == pytest.approx(0.5 * grey.mean(), rel=0.02)  # CIE overcast
    lights = [
        float((s.sun_color * sine(40) + 0.5 * (s.zenith + s.horizon)) @ LUMINANCE) for s in skies
    ]
    assert lights[2] < 0.6 * lights[0]


def test_haze_whitens_the_sky_and_dims_the_sun() -> None:
    clean, hazy = clear_sky(40.0, 1.5), clear_sky(40.0, 6.0)
    assert hazy.zenith[2] / hazy.zenith[0] < clean.zenith[2] / clean.zenith[0]
    assert (hazy.sun < clean.sun).all()


@pytest.mark.parametrize("altitude", [90.0, -90.0, 0.0, -0.01, 89.999, 6.0, -18.0])
def test_every_height_is_finite_and_smooth(altitude: float) -> None:
    here, near = clear_sky(altitude), clear_sky(min(altitude + 0.01, 90.0))
    for a, b in zip(here, near, strict=True):
        assert np.isfinite(a).all()
        assert (a >= 0.0).all()
        assert np.allclose(a, b, rtol=0.05, atol=1e-9 + 0.05 * float(np.max(a)))


def test_bad_input() -> None:
    for bad in (math.nan, 91.0, -math.inf):
        with pytest.raises(InvalidValueError, match="altitude"):
            atmosphere.sky_table(bad)
    for bad in (0.9, 10.1, math.nan):
        with pytest.raises(InvalidValueError, match="turbidity"):
            atmosphere.transmittance(10.0, bad)


def test_a_table_made_ahead_in_parts_is_the_one_made_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Before the sun gets there; then nothing is left to be made when it does."""
    monkeypatch.setattr(daylight, "_known", {})
    monkeypatch.setattr(daylight, "_begun", {})
    daylight.clear_sky(8.5)
    assert sum(daylight.look_ahead(8.5) for _ in range(20)) == 2 * atmosphere.PARTS
    table = atmosphere.sky_table(10.0)
    kept, _ = daylight._known[list(daylight._KNOTS).index(10.0), daylight.CLEAR]
    assert np.array_equal(kept.air, math.pi * table.air) and np.array_equal(kept.sun, table.sun)

    def refuse(*_: object) -> None:
        raise AssertionError("a whole table was made")

    monkeypatch.setattr(daylight, "sky_table", refuse)
    for altitude in (7.1, 8.5, 9.99):
        daylight.clear_sky(altitude)
    with pytest.raises(AssertionError):
        daylight.clear_sky(10.5)


def test_many_skies_do_not_keep_each_other_from_looking_ahead(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(daylight, "_known", {})
    monkeypatch.setattr(daylight, "_begun", {})
    monkeypatch.setattr(daylight, "MOST_KEPT", 6)
    for _ in range(6 * atmosphere.PARTS):
        daylight.look_ahead(-90.0)
        daylight.look_ahead(90.0)
        daylight.look_ahead(30.0, 3.0)
        assert len(daylight._known) <= 6
    assert not daylight.look_ahead(-90.0)
