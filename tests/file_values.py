"""Strategies for all that a file can hold, out of the limits that the components' checks have."""

from __future__ import annotations

import math
from dataclasses import MISSING, fields
from typing import Any

from hypothesis import strategies as st

from weather_ecs import CloudFile
from weather_ecs.components import (
    Cloud,
    CloudModel,
    CloudRoot,
    CloudSeed,
    RainArea,
    Sky,
    SkyLayer,
    Wind,
)
from weather_ecs.components._base import Component, limits_of
from weather_ecs.errors import InvalidValueError
from weather_ecs.file_content import MANY, ONE
from weather_ecs.quality import QUALITIES

NAMES = st.from_regex(r"[A-Za-z][A-Za-z0-9_ -]{0,12}", fullmatch=True)
IMAGES = st.lists(st.sampled_from(["puff", "wisp", "sheet", "puff_1"]), min_size=1, max_size=3)

# What is put into the text of a good file to see what becomes of it.
SNIPPETS = [
    *("[", "]", "[[", "]]", "{", "}", "=", '"', "'", '"""', "'''", ".", ",", "\n", "#", "-", "0"),
    *("nan", "inf", "-inf", "true", "1e9999", "0x1F", "1_0", "1979-05-27T07:32:00Z", "\r"),
    *("[[models]]\n", "[models]\n", "[climate]\n", "[[winds]]\n", "[fog]\n", "[[rain_areas]]\n"),
    *("[layers.climate]\n", "[[layers.skies]]\n", "[[models.seeds]]\n", "[[models.seeds.roots]]\n"),
    *("x_a = 1\n", "[extra.a]\n", "extra = {}\n", "climate.duration = 5\n", "state = 1\n", "width"),
    *("\\", "\0", "é", "💧", "\ufeff"),
]  # fmt: skip


def changed(text: str) -> st.SearchStrategy[str]:
    """The text of a good file with up to four places in which something else stands."""

    def edited(edits: list[tuple[int, int, str]]) -> str:
        found = text
        for place, cut, new in edits:
            found = found[:place] + new + found[place + cut :]
        return found

    new = st.sampled_from(SNIPPETS) | st.text(max_size=4)
    edit = st.tuples(st.integers(0, len(text)), st.integers(0, 12), new)
    return st.lists(edit, min_size=1, max_size=4).map(edited)


def floats(low: float, high: float, above: bool = False) -> st.SearchStrategy[float]:
    """Any floats within, the ends and the odd ones too."""
    if not math.isfinite(low):
        return st.floats(-1e300, 1e300)
    return st.floats(low, high, exclude_min=above)


def value(kind: type[Component], name: str) -> st.SearchStrategy[Any]:
    """Good values of a field that is neither a name nor a part."""
    limits = limits_of(kind.checks[name])
    assert limits is not None, (kind, name)
    numbers = floats(limits.low, limits.high, limits.above)
    found: st.SearchStrategy[Any]
    if limits.kind == "number":
        found = numbers
    elif limits.kind == "integer":
        found = st.integers(int(limits.low), int(limits.high))
    elif limits.kind == "flag":
        found = st.booleans()
    elif limits.kind == "choice":
        found = st.sampled_from(limits.choices)
    elif limits.kind == "direction":
        found = st.tuples(*[st.floats(0.001, 1e6)] * limits.size)
    else:
        found = st.tuples(*[numbers] * limits.size)
    return st.none() | found if limits.optional else found


def component(kind: type[Component], **given: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    """Components of a kind; of fields that do not agree by chance the defaults are taken."""
    names = [
        entry.name
        for entry in fields(kind)  # type: ignore[arg-type]
        if entry.name not in given and limits_of(kind.checks[entry.name]) is not None
    ]
    own = {name: value(kind, name) for name in names}
    if kind is RainArea:
        own["radii"] = st.tuples(st.floats(5.0, 1e6), st.floats(1e-3, 5.0))
    if kind is Wind:
        own["times"] = st.tuples(st.floats(1e-3, 1.0), st.floats(2.0, 5.0), st.floats(6.0, 1e6))
    needed = {
        entry.name: own.pop(entry.name)
        for entry in fields(kind)  # type: ignore[arg-type]
        if entry.default is MISSING and entry.name in own
    }
    rest = st.fixed_dictionaries({**needed, **given}, optional=own)
    return rest.map(lambda values: _made(kind, values, (*needed, *given)))


def _made(kind: type[Component], values: dict[str, Any], needed: tuple[str, ...]) -> Any:
    try:
        return kind(**values)
    except InvalidValueError:  # least above most
        return kind(**{name: values[name] for name in needed})


FEW = st.integers(0, 9)  # levels and seeds: clouds of many thousands are another test's affair
ROOTS = component(
    CloudRoot,
    reproductions_min=FEW,
    reproductions_max=FEW.map(lambda levels: levels + 9),
    seeds_start=FEW,
    seeds_end=FEW,
)
NEAR, WIDE = st.floats(-5000.0, 5000.0), st.floats(20_000.0, 1e7)  # m: clouds fit in their layers
SEEDS = component(
    CloudSeed,
    center=st.tuples(NEAR, NEAR, NEAR),
    width=st.floats(1e-3, 5000.0),
    depth=st.floats(1e-3, 5000.0),
    roots=st.lists(ROOTS, max_size=2),
    images=IMAGES,
)
MODELS = component(
    CloudModel, name=NAMES, seeds=st.lists(SEEDS, min_size=1, max_size=3), images=IMAGES
)


@st.composite
def contents(draw: Any) -> CloudFile:
    """Whole files."""
    models = draw(st.lists(MODELS, max_size=3, unique_by=lambda model: model.name))
    names = st.sampled_from(["cumulus", "stratus", *[model.name for model in models]])
    clouds = st.lists(component(Cloud, model=names), max_size=2)
    sky = component(Sky, models=st.lists(names, max_size=3), weights=st.just(()))
    skies = st.lists(sky, max_size=3, unique_by=lambda each: each.state)
    sizes = st.tuples(WIDE, WIDE)
    layers = draw(st.lists(component(SkyLayer, skies=skies, size=sizes), max_size=2))
    climates = st.lists(
        st.none() | component(ONE["climate"]), min_size=len(layers), max_size=len(layers)
    )
    own = tuple(draw(climates))
    values: dict[str, Any] = {
        key: tuple(draw(st.lists(component(MANY[key]), max_size=2)))
        for key in ("rain_areas", "winds")
    }
    for key, kind in ONE.items():
        values[key] = draw(st.none() | component(kind))
    return CloudFile(
        tuple(models),
        tuple(draw(clouds)),
        tuple(layers),
        layer_climates=own if any(own) else (),
        quality=draw(st.none() | st.sampled_from(QUALITIES)),
        extra=draw(
            st.dictionaries(st.text(max_size=5), st.integers() | st.text(max_size=9), max_size=2)
        ),
        **values,
    )
