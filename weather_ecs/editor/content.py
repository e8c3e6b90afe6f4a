"""Changes of what a file holds, as functions from one content to another."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from weather_ecs import CloudFile
from weather_ecs.cloud_files import CLOUD_MODELS, check_content
from weather_ecs.components import Climate, Cloud, CloudModel, CloudSeed, SkyLayer
from weather_ecs.errors import InvalidValueError

# Fields of a content that are lists, and what their items are called in menus.
LISTS = {
    "models": "cloud model",
    "clouds": "cloud",
    "layers": "layer",
    "rain_areas": "rain area",
    "winds": "wind",
}


def check(content: CloudFile, before: CloudFile | None = None) -> None:
    """Raises InvalidValueError for what could not be saved and loaded back.

    What is the same object as in `before`, which was good, is not looked at again.
    """
    check_content(content, before)


def with_item(content: CloudFile, field: str, index: int, item: Any) -> CloudFile:
    """Another item in place of the one at `index` of a list."""
    return put(content, **{field: swapped(getattr(content, field), index, item)})


def put(content: CloudFile, **values: Any) -> CloudFile:
    """Other values of fields whose names are only known as text."""
    return replace(content, **values)


def with_new(content: CloudFile, field: str, item: Any, index: int | None = None) -> CloudFile:
    """One more item, before the one at `index`, or last."""
    items = getattr(content, field)
    at = len(items) if index is None else index
    changed = put(content, **{field: (*items[:at], item, *items[at:])})
    if field == "layers" and at < len(content.layer_climates):
        own = content.layer_climates
        changed = replace(changed, layer_climates=(*own[:at], None, *own[at:]))
    return changed


def without(content: CloudFile, field: str, index: int) -> CloudFile:
    """One item less. A model that skies and clouds use is taken out of them too."""
    items = getattr(content, field)
    gone = items[index]
    rest = items[:index] + items[index + 1 :]
    if field == "layers":
        own = content.layer_climates
        return replace(content, layers=rest, layer_climates=own[:index] + own[index + 1 :])
    if field == "models" and gone.name not in CLOUD_MODELS:  # else the package's own serves
        content = _renamed(content, gone.name, None)
    return put(content, **{field: rest})


def moved(content: CloudFile, field: str, index: int, to: int) -> CloudFile:
    """An item at another place of its list."""
    changed: dict[str, Any] = {field: shifted(getattr(content, field), index, to)}
    if field == "layers":
        own = content.layer_climates + (None,) * (len(content.layers) - len(content.layer_climates))
        changed["layer_climates"] = shifted(own, index, to)
    return put(content, **changed)


def rename_model(content: CloudFile, index: int, name: str) -> CloudFile:
    """A model under another name, also where skies and clouds use it."""
    model = replace(content.models[index], name=name)
    if name != content.models[index].name and name in [each.name for each in content.models]:
        raise InvalidValueError("CloudModel.name", name, "a name that no other model has")
    content = _renamed(content, content.models[index].name, name)
    return with_item(content, "models", index, model)


def layer_climate(content: CloudFile, index: int) -> Climate | None:
    """A layer's own climate; None where it follows the file's."""
    own = content.layer_climates
    return own[index] if index < len(own) else None


def with_layer_climate(content: CloudFile, index: int, climate: Climate | None) -> CloudFile:
    """Another climate of a layer's own, or none."""
    own = content.layer_climates + (None,) * (len(content.layers) - len(content.layer_climates))
    return replace(content, layer_climates=swapped(own, index, climate))


def with_seed(content: CloudFile, model: int, index: int, seed: CloudSeed) -> CloudFile:
    """Another seed in place of one of a model's."""
    old = content.models[model]
    return with_item(content, "models", model, replace(old, seeds=swapped(old.seeds, index, seed)))


def users(content: CloudFile, name: str) -> int:
    """How many clouds and skies use a model."""
    skies = [sky for layer in content.layers for sky in layer.skies]
    used = sum(cloud.model == name for cloud in content.clouds)
    return used + sum(name in sky.models for sky in skies)


def free_name(content: CloudFile, name: str) -> str:
    """The name, or with a number where a model has it already."""
    taken = {model.name for model in content.models}
    if name not in taken:
        return name
    stem = name.rstrip("0123456789").rstrip()
    return next(f"{stem[:58]} {n}" for n in range(2, 10_000) if f"{stem[:58]} {n}" not in taken)


def swapped(items: tuple[Any, ...], index: int, item: Any) -> tuple[Any, ...]:
    """A tuple with another item at `index`."""
    return (*items[:index], item, *items[index + 1 :])


def shifted(items: tuple[Any, ...], index: int, to: int) -> tuple[Any, ...]:
    """A tuple with the item at `index` taken out and put in again at `to`."""
    rest = items[:index] + items[index + 1 :]
    return (*rest[:to], items[index], *rest[to:])


def _renamed(content: CloudFile, old: str, new: str | None) -> CloudFile:
    """Another name for a model wherever it is used; without one, what uses it is taken out."""
    clouds: list[Cloud] = []
    for cloud in content.clouds:
        if _name(cloud.model) != old:
            clouds.append(cloud)
        elif new is not None:
            clouds.append(replace(cloud, model=new))
    layers = tuple(_layer(layer, old, new) for layer in content.layers)
    return replace(content, clouds=tuple(clouds), layers=layers)


def _layer(layer: SkyLayer, old: str, new: str | None) -> SkyLayer:
    if not any(_name(model) == old for sky in layer.skies for model in sky.models):
        return layer
    skies = []
    for sky in layer.skies:
        kept: list[tuple[CloudModel | str, int]] = []
        for at, model in enumerate(sky.models):
            if _name(model) != old:
                kept.append((model, at))
            elif new is not None:
                kept.append((new, at))
        weights = tuple(sky.weights[at] for _, at in kept) if sky.weights else ()
        if not any(weights):
            weights = ()
        models = tuple(model for model, _ in kept)
        count = sky.count if models else 0
        skies.append(replace(sky, models=models, weights=weights, count=count))
    return replace(layer, skies=tuple(skies))


def _name(model: CloudModel | str | None) -> str | None:
    return model.name if isinstance(model, CloudModel) else model


def weight(before: CloudFile, after: CloudFile) -> int:
    """Bytes, about, that a content has which another does not share with it."""
    total = 500
    for field in LISTS:
        old, new = getattr(before, field), getattr(after, field)
        if new is not old:
            known = set(map(id, old))
            total += 8 * len(new)
            total += sum(_bytes(item) for item in new if id(item) not in known)
    return total


def _bytes(item: Any) -> int:
    """Of a component: its fields, and the lists in it, whose items are shared as a rule."""
    lists = getattr(item, "seeds", None) or getattr(item, "skies", None) or ()
    return 600 + 8 * len(lists)
