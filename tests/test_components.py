"""Components: every field is checked, when made and when set."""

from __future__ import annotations

import copy
import dataclasses
import math
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import weather_ecs.components as components
from tests.cloud_fields import FIELDS as CLOUD_FIELDS
from weather_ecs.components import (
    SNAPSHOT_COMPONENTS,
    Air,
    Atmosphere,
    CloudShading,
    CollisionHeightmap,
    Fog,
    Lightning,
    Observer,
    PointLight,
    RainArea,
    RainContainer,
    RainGauge,
    RippleSurface,
    SnowFlakes,
    SplashEmitter,
    Sun,
    Wind,
)
from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import CloudLook, DropLook, SkyLight, SnowLook, SplashLook

ROOT = Path(__file__).resolve().parent.parent
NAN, INF = math.nan, math.inf
NOT_NUMBERS = [NAN, INF, -INF, None, "5", True, np.bool_(True), 1j, [1.0], np.ones(1), 10**400]


def area() -> RainArea:
    return RainArea((0, 0), (60, 40))


REQUIRED = {
    RainArea: {"center": (0, 0), "radii": (60, 40)},
    RippleSurface: {"center": (0, 0, 0), "size": (4, 3)},
}


def make(kind: type) -> object:
    return kind(**REQUIRED.get(kind, {}))


CASES = [
    (Air, "temperature", [-60, 60.0, np.float32(-0.5)]),
    (Air, "humidity", [0, 1]),
    (Atmosphere, "time", [-2208988800, 0, 1.7e9]),
    (Atmosphere, "latitude", [-90, 90]),
    (Atmosphere, "longitude", [-180, 180]),
    (Atmosphere, "speed", [-1e6, 0, 1e6]),
    (Atmosphere, "turbidity", [1, 10]),
    (Atmosphere, "overcast", [0, 1.0]),
    (Atmosphere, "exposure", [0, 1000]),
    (Atmosphere, "adaptation", [0, 1]),
    (Atmosphere, "draw", [True, np.bool_(False)]),
    (Atmosphere, "stars", [0, 100]),
    (Atmosphere, "disc", [0.1, 20]),
    (Atmosphere, "halo", [0, 1]),
    (Atmosphere, "rainbow", [0, 10]),
    (Fog, "visibility", [0, 50.0, 1e7]),
    (Fog, "color", [(0, 0, 0), np.array([1, 2, 1000])]),
    (Fog, "depth", [0, 1e5]),
    (Fog, "draw", [True, np.bool_(False)]),
    (Lightning, "rate", [0, 1000]),
    (Lightning, "most", [0, 600]),
    (Lightning, "ground_share", [0, 1]),
    (Lightning, "audible", [0, 1e5]),
    (Lightning, "brightness", [0, 1000]),
    (Lightning, "color", [(0, 0, 0), (1000, 1, 1)]),
    (Lightning, "width", [0.01, 100]),
    (Lightning, "glow", [0, 10]),
    (Lightning, "branches", [0, 3]),
    (RainArea, "center", [(1, 2), [1, 2], np.array([1.0, 2.0]), np.array([1, 2], np.int32)]),
    (RainArea, "radii", [(5, 5), (60.0, 40.0), np.array([9, 1])]),
    (RainArea, "rain_rate", [0, 25.0, np.float32(3.0), np.int64(7), Fraction(1, 2)]),
    (RainArea, "heading", [-7.0, 0, 1e6]),
    (RainArea, "soft_edge", [0, 1e5]),
    (RainArea, "ceiling", [-5, 3000]),
    (RainArea, "velocity", [(150, -150)]),
    (RainArea, "drift", [0, 1, 0.5]),
    (RainArea, "onset", [0, 1, 0.3]),
    (RainContainer, "reach", [2, 500]),
    (RainContainer, "height", [2, 500]),
    (RainContainer, "margin", [0, 100]),
    (RainContainer, "size_maximum", [1, 50]),
    (RainContainer, "exposure", [1e-4, 1]),
    (RainContainer, "width", [0.05, 20]),
    (RainContainer, "opacity", [0, 1]),
    (RainContainer, "brightness", [0, 10]),
    (RainContainer, "density", [0, 100]),
    (RainContainer, "veil", [0, 10]),
    (RainContainer, "fastest", [0, 1000]),
    (RippleSurface, "center", [(1, 2, 3), np.arange(3)]),
    (RippleSurface, "size", [(0.01, 1e5), np.array([3, 2])]),
    (RippleSurface, "heading", [-7.0, 1e6]),
    (RippleSurface, "shape", ["rectangle", "ellipse"]),
    (RippleSurface, "cell", [0.001, 10]),
    (RippleSurface, "speed", [0.01, 10]),
    (RippleSurface, "damping", [5, np.int64(9)]),
    (RippleSurface, "amplitude", [0, 100]),
    (RippleSurface, "color", [(0, 0, 0), (1, 1, 1)]),
    (RippleSurface, "clarity", [0.001, 1000]),
    (RippleSurface, "draw", [True, np.bool_(False)]),
    (RippleSurface, "catches_rain", [False, True]),
    (CloudShading, "plain", [True, np.bool_(False)]),
    (CloudShading, "rays", [True, np.bool_(False)]),
    (CloudShading, "silver", [0, 10]),
    (CloudShading, "base", [0, 1]),
    (CloudShading, "ambient", [0, 10]),
    (CloudShading, "softness", [0, 10]),
    (CloudShading, "shadows", [False, True]),
    (SnowFlakes, "model", ["physical", "liu_tong"]),
    (SnowFlakes, "size", [0.05, 50]),
    (SnowFlakes, "settling", [0, 100]),
    (SnowFlakes, "size_maximum", [1, 50]),
    (SnowFlakes, "exposure", [1e-4, 1]),
    (SnowFlakes, "flutter", [0, 2]),
    (SnowFlakes, "density", [0, 100]),
    (SnowFlakes, "brightness", [0, 10]),
    (SnowFlakes, "opacity", [0, 1]),
    (SnowFlakes, "aperture", [0, 0.1]),
    (SnowFlakes, "veil", [0, 10]),
    (SplashEmitter, "size", [0, 200]),
    (SplashEmitter, "largest", [0.001, 10]),
    (SplashEmitter, "duration", [0.02, 5]),
    (SplashEmitter, "opacity", [0, 1]),
    (SplashEmitter, "share", [0, 1]),
    (SplashEmitter, "droplets", [0, 5]),
    (SplashEmitter, "droplet_size", [0.1, 100]),
    (SplashEmitter, "droplet_speed", [0, 1]),
    (SplashEmitter, "spread", [0, 1.57]),
    (SplashEmitter, "drift", [0, 1]),
    (SplashEmitter, "detail", [0, 100]),
    (Wind, "direction", [(0, 3), [-1e-200, 0], np.array([1e308, 1e308])]),
    (Wind, "speed", [0, 100, 150]),
    (Wind, "law", ["constant", "gust", "steady"]),
    (Wind, "start", [-10, 0, 1e9]),
    (Wind, "times", [(1, 2, 3), [0.1, 1.0, 1e6], np.array([1.0, 2.0, 3.0])]),
    (Wind, "coefficients", [(1, 0, 1, 0.3, 1, 1), np.zeros(6), [-100] * 6]),
    (Wind, "period", [0, 60]),
    (Wind, "gustiness", [0, 1]),
    (Wind, "interval", [0.5, 600]),
    (Wind, "veer", [0, math.pi]),
    (Wind, "veer_period", [1, 600]),
    (Wind, "exponent", [0, 1 / 7, 1]),
    (Wind, "ground", [-5, 300]),
    (Wind, "turbulence", [0, 0.2, 1]),
    (Wind, "scale", [0.5, 1000]),
    (Sun, "direction", [(0, -1, 0)]),
    (Sun, "color", [(0, 0, 0), (1000, 0.5, 3)]),
    (Sun, "zenith_color", [(0, 0, 0)]),
    (Sun, "horizon_color", [(0, 0, 0)]),
    (Sun, "ground_color", [(0, 0, 0)]),
    (PointLight, "position", [(1, 2, 3)]),
    (PointLight, "color", [(1e6, 0, 0)]),
    (PointLight, "reach", [1e-3, 1e4]),
    (Observer, "position", [(-1e7, 0, 1e7), np.arange(3)]),
    (CollisionHeightmap, "resolution", [0.125, 4]),
    (CollisionHeightmap, "extent", [1.05, 8]),
    (CollisionHeightmap, "layers", [0, np.int64(2**32 - 1)]),
    (RainGauge, "position", [(-1e7, 0, 1e7), np.arange(3)]),
    (RainGauge, "area", [1e-9, 1e6]),
    (RainGauge, "window", [0.1, 3600]),
]
BAD = [
    (Air, "temperature", [-101, 100.1]),
    (Air, "humidity", [-0.1, 1.1, 80]),
    (Atmosphere, "time", [-3e9, 4.2e9, "", "noon", "2025-13-01", "2150-01-01", "1" * 99, "٢٠٢٥"]),
    (Atmosphere, "latitude", [-90.1, 91]),
    (Atmosphere, "longitude", [-181, 360]),
    (Atmosphere, "speed", [-2e6, 2e6]),
    (Atmosphere, "turbidity", [0.9, 11]),
    (Atmosphere, "exposure", [-1, 1001]),
    (Atmosphere, "adaptation", [-0.1, 1.1]),
    (Atmosphere, "draw", [0, "yes"]),
    (Atmosphere, "stars", [-1, 101]),
    (Atmosphere, "disc", [0, 21]),
    (Atmosphere, "rainbow", [-1, 11]),
    (Fog, "visibility", [-1, 2e7]),
    (Fog, "depth", [-1, 2e5]),
    (Fog, "draw", [0, 1, "yes"]),
    (Lightning, "rate", [-1, 1001]),
    (Lightning, "most", [-1, 601]),
    (Lightning, "ground_share", [-0.1, 1.1]),
    (Lightning, "audible", [-1, 2e5]),
    (Lightning, "brightness", [-1, 1001]),
    (Lightning, "color", [(-1, 0, 0), (0, 0), (0, 0, 1001)]),
    (Lightning, "width", [0, 101]),
    (Lightning, "glow", [-1, 11]),
    (Lightning, "branches", [-1, 3.1]),
    (CollisionHeightmap, "resolution", [0.12, 4.1]),
    (CollisionHeightmap, "extent", [1.0, 8.1]),
    (CollisionHeightmap, "layers", [-1, 2**32, 1.0]),
    (RainGauge, "position", [(1, 2), (1e8, 0, 0)]),
    (RainGauge, "area", [0, 0.0, -1, 1.1e6]),
    (RainGauge, "window", [0, 0.09, 3601]),
    (RainArea, "center", [(1,), (1, 2, 3), (1e8, 0), "ab", {1, 2}, np.ones((2, 1)), 3]),
    (RainArea, "radii", [(0, 0), (10, 0), (-3, -4), (40, 60), (1e7, 1), (60,), (5, -1)]),
    (RainArea, "rain_rate", [-1e-9, 10001]),
    (RainArea, "soft_edge", [-0.1]),
    (RainArea, "ceiling", [2e5]),
    (RainArea, "velocity", [(151, 0), (0,)]),
    (RainArea, "drift", [-0.1, 1.1]),
    (RainArea, "onset", [-0.1, 1.1]),
    (RainContainer, "reach", [0, -1, 501]),
    (RainContainer, "height", [0]),
    (RainContainer, "margin", [-1]),
    (RainContainer, "size_maximum", [0.5]),
    (RainContainer, "exposure", [0]),
    (RainContainer, "width", [0]),
    (RainContainer, "opacity", [1.5]),
    (RainContainer, "brightness", [-1, 11]),
    (RainContainer, "density", [-1, 101]),
    (RainContainer, "veil", [-1]),
    (RainContainer, "fastest", [-1, 1001]),
    (RippleSurface, "center", [(1, 2), (1e8, 0, 0)]),
    (RippleSurface, "size", [(0, 1), (1,), (1, 2, 3), (2e5, 1)]),
    (RippleSurface, "heading", []),
    (RippleSurface, "shape", ["", "Ellipse", b"ellipse", ("ellipse",)]),
    (RippleSurface, "cell", [0, -1, 11]),
    (RippleSurface, "speed", [0, 11]),
    (RippleSurface, "damping", [4, 10, 5.0, 5.5]),
    (RippleSurface, "amplitude", [-1, 101]),
    (RippleSurface, "color", [(-1, 0, 0), (0, 0, 1.5), (0, 0)]),
    (RippleSurface, "clarity", [0, 1001]),
    (RippleSurface, "draw", [0, 1, "yes"]),
    (RippleSurface, "catches_rain", [0, "no"]),
    (CloudShading, "plain", [0, "yes"]),
    (CloudShading, "rays", [0, "yes"]),
    (CloudShading, "silver", [-0.1, 11]),
    (CloudShading, "base", [-0.1, 1.1]),
    (CloudShading, "ambient", [-0.1, 11]),
    (CloudShading, "softness", [-0.1, 11]),
    (CloudShading, "shadows", [1, "no"]),
    (SnowFlakes, "model", ["swiss", "", 1, None]),
    (SnowFlakes, "size", [0, 51]),
    (SnowFlakes, "size_maximum", [0.5, 51]),
    (SnowFlakes, "exposure", [0, 2]),
    (SnowFlakes, "flutter", [-0.1, 2.1]),
    (SnowFlakes, "density", [-1, 101]),
    (SnowFlakes, "brightness", [-1, 11]),
    (SnowFlakes, "opacity", [-0.1, 1.1]),
    (SnowFlakes, "aperture", [-0.1, 0.2]),
    (SnowFlakes, "veil", [-1, 11]),
    (SplashEmitter, "size", [-1, 201]),
    (SplashEmitter, "largest", [0, 11]),
    (SplashEmitter, "duration", [0, 6]),
    (SplashEmitter, "opacity", [-0.1, 1.5]),
    (SplashEmitter, "share", [-0.1, 1.1]),
    (SplashEmitter, "droplets", [-1, 6]),
    (SplashEmitter, "droplet_size", [0, 101]),
    (SplashEmitter, "droplet_speed", [-0.1, 1.1]),
    (SplashEmitter, "spread", [-0.1, 1.6]),
    (SplashEmitter, "drift", [-0.1, 1.1]),
    (SplashEmitter, "detail", [-1, 101]),
    (Wind, "direction", [(0, 0), (1, 0, 0), (-0.0, 0.0)]),
    (Wind, "speed", [-1, 151]),
    (Wind, "law", ["", "storm", None, 1, b"gust"]),
    (Wind, "start", [NAN, INF, 2e9]),
    (Wind, "times", [(2, 1, 3), (0, 1, 2), (1, 2, 2), (1, 1, 2), (1, 2), (1, NAN, 3), (1, 2, INF)]),
    (Wind, "coefficients", [(1, 0, 1, 0.3, 1), (1, 0, 1, 0.3, 1, NAN), (1, 0, 1, 0.3, 1, 101), 1]),
    (Wind, "period", [-1, 2e6]),
    (Wind, "gustiness", [-0.1, 1.1]),
    (Wind, "interval", [0, 0.4, 2e6]),
    (Wind, "veer", [-0.1, 3.2]),
    (Wind, "veer_period", [0, 2e6]),
    (Wind, "exponent", [-0.1, 1.1]),
    (Wind, "ground", [2e5]),
    (Wind, "turbulence", [-0.1, 1.1]),
    (Wind, "scale", [0.4, 1001]),
    (Sun, "direction", [(0, 0, 0), (1, 0)]),
    (Sun, "color", [(-1, 0, 0), (1001, 0, 0), (1, 1)]),
    (PointLight, "reach", [0, -1, 1e5]),
    (PointLight, "color", [(0, 0, -1)]),
    (Observer, "position", [(1, 2), (1e8, 0, 0)]),
]


@pytest.mark.parametrize(("kind", "name", "values"), CASES)
def test_good_values_are_kept_as_plain_values(kind, name, values):
    for value in values:
        component = make(kind)
        before = getattr(component, name)
        setattr(component, name, value)
        got = getattr(component, name)
        if isinstance(got, tuple):
            assert all(type(item) is float for item in got)
        else:
            assert type(got) is type(before) or before is None
            assert got == (value if type(got) is not float else pytest.approx(float(value)))


@pytest.mark.parametrize(("kind", "name", "values"), BAD)
def test_bad_values_name_the_field_and_change_nothing(kind, name, values):
    component = make(kind)
    before = getattr(component, name)
    size = len(before) if isinstance(before, tuple) else 0
    odd = [(bad,) + before[1:] for bad in NOT_NUMBERS] if size else NOT_NUMBERS
    if isinstance(before, bool):
        odd = [value for value in odd if not isinstance(value, (bool, np.bool_))]
    for value in [*values, *odd, None, "x" * size]:
        with pytest.raises(InvalidValueError) as caught:
            setattr(component, name, value)
        assert caught.value.field == f"{kind.__name__}.{name}"
        assert name in str(caught.value)
        assert "allowed" in str(caught.value)
        assert getattr(component, name) is before
        arguments = REQUIRED.get(kind, {})
        with pytest.raises(ValueError, match=name):
            kind(**{**arguments, name: value})


def test_every_field_of_every_component_is_among_the_cases():
    tried = {(kind, name) for kind, name, _ in CASES}
    tried |= {(kind, name) for kind, them in CLOUD_FIELDS.items() for name in them}
    for kind in (*SNAPSHOT_COMPONENTS.values(), Observer, RainGauge):
        for field in dataclasses.fields(kind):
            assert (kind, field.name) in tried


def test_defaults_are_those_of_the_frame():
    for look, component in (
        (DropLook(), RainContainer()), (SnowLook(), SnowFlakes()), (SplashLook(), SplashEmitter()),
        (CloudLook(), CloudShading()),
    ):  # fmt: skip
        names = [field.name for field in dataclasses.fields(look)]
        assert [field.name for field in dataclasses.fields(component)] == names
        assert all(getattr(component, name) == getattr(look, name) for name in names)
    sky, sun = SkyLight(), Sun()
    for field in dataclasses.fields(Sun):
        name = field.name if field.name.endswith("r") and "_" in field.name else f"sun_{field.name}"
        assert getattr(sun, field.name) == pytest.approx(getattr(sky, name), rel=5e-3)


def test_misspelt_fields_and_deletion_are_refused():
    it = area()
    with pytest.raises(AttributeError, match="rain_rat"):
        it.rain_rat = 5.0
    with pytest.raises(AttributeError):
        del it.rain_rate
    assert it.rain_rate == 5.0


def test_equal_components_stay_two():
    one, other = area(), area()
    assert one != other
    assert len({one, other}) == 2


def test_copies_are_checked_too():
    it = copy.copy(area())
    with pytest.raises(InvalidValueError):
        it.radii = (1, 2)
    assert it.radii == (60.0, 40.0)


def test_a_revision_counts_assignments_of_its_own_class():
    it, before = area(), RainArea.revision()
    it.rain_rate = 7
    assert RainArea.revision() == before + 1
    Wind().speed = 3.0
    with pytest.raises(InvalidValueError):
        it.rain_rate = -1
    assert RainArea.revision() == before + 1

    class Shower(RainArea):
        pass

    Shower((0, 0), (2, 1))
    assert RainArea.revision() > before + 1


vectors = st.tuples(*[st.floats(-1e308, 1e308)] * 3).filter(any)


@settings(deadline=None)
@given(vectors)
def test_directions_have_length_one_and_a_second_pass_changes_nothing(vector):
    once = Sun(direction=vector).direction
    assert math.hypot(*once) == pytest.approx(1.0, abs=1e-12)
    assert Sun(direction=once).direction == once
    greatest = max(map(abs, vector))
    scaled = np.array(vector) / greatest
    assert once == pytest.approx(scaled / np.linalg.norm(scaled), abs=1e-12)


@settings(deadline=None)
@given(st.floats(), st.floats())
def test_radii_are_taken_exactly_when_they_are_an_ellipse(a, b):
    good = math.isfinite(a) and math.isfinite(b) and 1e6 >= a >= b >= 1e-3
    if good:
        assert RainArea((0, 0), (a, b)).radii == (a, b)
    else:
        with pytest.raises(InvalidValueError):
            RainArea((0, 0), (a, b))


def test_components_load_without_esper_and_without_opengl():
    program = (
        "import sys, types; p = types.ModuleType('weather_ecs'); p.__path__ = ['weather_ecs'];"
        "sys.modules['weather_ecs'] = p; import weather_ecs.components;"
        "assert not {'esper', 'moderngl', 'pyglet'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", program], check=True, timeout=60, cwd=ROOT)


def test_what_is_exported_exists():
    for name in components.__all__:
        assert hasattr(components, name)
