"""The table of fields: it has every field that a file can hold, with the checks' own ranges."""

from __future__ import annotations

from dataclasses import MISSING, fields

import pytest

from weather_ecs.components import CloudRoot, CloudSeed, Fog, RainArea, Sky, Wind
from weather_ecs.components._base import Component
from weather_ecs.editor.field_texts import TEXTS
from weather_ecs.editor.fields import Field, info
from weather_ecs.errors import InvalidValueError
from weather_ecs.file_content import MANY, ONE

KINDS = [*MANY.values(), *ONE.values(), Sky, CloudSeed, CloudRoot]
ALL = [(kind, entry.name) for kind in KINDS for entry in fields(kind)]


def test_the_table_has_every_field_and_no_others():
    assert set(TEXTS) == set(KINDS)
    assert {(kind, name) for kind in TEXTS for name in TEXTS[kind]} == set(ALL)


@pytest.mark.parametrize(("kind", "name"), ALL)
def test_ranges_are_those_of_the_checks(kind: type[Component], name: str):
    field, check = info(kind, name), kind.checks[name]
    assert field.label and field.help.endswith(".")
    assert all(len(line) < 90 for line in field.tooltip().splitlines())
    limits = field.limits
    if limits.kind not in ("number", "integer", "vector"):
        return
    step = 1 if limits.kind == "integer" else max(abs(limits.high), abs(limits.low), 1e-3) * 1e-3
    assert limits.low <= field.soft[0] < field.soft[1] <= limits.high
    whole = limits.kind != "vector"
    soft = [int(value) if limits.kind == "integer" else value for value in field.soft]
    for value in soft if whole else []:
        check(name, value)
    for value in (limits.low - step, limits.high + step):
        if abs(value) != float("inf"):
            with pytest.raises(InvalidValueError):
                check(name, value if whole else (value,) * limits.size)


def test_defaults_are_the_components():
    for kind, name in ALL:
        entry = next(entry for entry in fields(kind) if entry.name == name)
        if entry.default is not MISSING and entry.default is not None:
            assert info(kind, name).default == entry.default


def test_words_of_a_range():
    def words(kind: type[Component], name: str) -> str:
        found: Field = info(kind, name)
        return found.range_text()

    assert words(RainArea, "rain_rate") == "mm/h, 0 to 10 000"
    assert words(CloudRoot, "pitch") == "°, -360 to 360"
    assert words(CloudRoot, "reproductions_min") == "0 to 1 000 000, whole"
    assert words(Wind, "law") == "constant, gust, steady"
    assert words(Wind, "direction") == "2 numbers, kept at length 1"
    assert words(Fog, "draw") == "on or off"
    assert words(Fog, "color").endswith("or none")
    assert info(RainArea, "rain_rate").tooltip().startswith("Water that falls")
