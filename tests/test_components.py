"""Components: every field is checked, when made and when set."""

from __future__ import annotations

import copy
import dataclasses
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import weather_ecs.components as components
from tests.cloud_fields import FIELDS as CLOUD_FIELDS
from tests.component_values import BAD, CASES, NOT_NUMBERS, REQUIRED
from weather_ecs.components import (
    SNAPSHOT_COMPONENTS,
    CloudShading,
    Observer,
    RainArea,
    RainContainer,
    RainGauge,
    SnowFlakes,
    SplashEmitter,
    Sun,
    Wind,
)
from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import CloudLook, DropLook, SkyLight, SnowLook, SplashLook

ROOT = Path(__file__).resolve().parent.parent


def area() -> RainArea:
    return RainArea((0, 0), (60, 40))


def make(kind: type) -> object:
    return kind(**REQUIRED.get(kind, {}))


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
