"""`CloudFile`: what a file of clouds and weather holds, and what has to agree in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from weather_ecs.components import (
    Air,
    Atmosphere,
    Climate,
    Cloud,
    CloudModel,
    CloudShading,
    Fog,
    Lightning,
    RainArea,
    RainContainer,
    SkyLayer,
    SnowFlakes,
    SplashEmitter,
    Sun,
    Wind,
)
from weather_ecs.components._base import Component
from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.reproduction import image_indices
from weather_ecs.quality import QUALITIES
from weather_ecs.toml_scan import Path

# Models that the package brings: the ten genera from the highest to the lowest, and fractostratus.
CLOUD_MODELS = (
    "cirrus",
    "cirrostratus",
    "cirrocumulus",
    "altostratus",
    "altocumulus",
    "nimbostratus",
    "stratocumulus",
    "stratus",
    "cumulus",
    "cumulonimbus",
    "fractostratus",
)

# Tables of a file, in the order in which they are written.
MANY: dict[str, type[Component]] = {
    "models": CloudModel,
    "clouds": Cloud,
    "layers": SkyLayer,
    "rain_areas": RainArea,
    "winds": Wind,
}
ONE: dict[str, type[Component]] = {
    "climate": Climate,
    "air": Air,
    "fog": Fog,
    "atmosphere": Atmosphere,
    "sun": Sun,
    "lightning": Lightning,
    "cloud_shading": CloudShading,
    "rain_container": RainContainer,
    "snow_flakes": SnowFlakes,
    "splash_emitter": SplashEmitter,
}


@dataclass(frozen=True, slots=True)
class CloudFile:
    """What a file holds. Layers and clouds name models of the file or of the package.

    `layer_climates` are the layers' own climates: one for each of the first layers, None for one
    that follows `climate`. `quality` is a word to whoever shows the file; loading leaves a game's
    own alone. `extra` is the table of that name, which is kept and means nothing here.
    """

    models: tuple[CloudModel, ...] = ()
    clouds: tuple[Cloud, ...] = ()
    layers: tuple[SkyLayer, ...] = ()
    climate: Climate | None = None
    layer_climates: tuple[Climate | None, ...] = ()
    rain_areas: tuple[RainArea, ...] = ()
    winds: tuple[Wind, ...] = ()
    air: Air | None = None
    fog: Fog | None = None
    atmosphere: Atmosphere | None = None
    sun: Sun | None = None
    lightning: Lightning | None = None
    cloud_shading: CloudShading | None = None
    rain_container: RainContainer | None = None
    snow_flakes: SnowFlakes | None = None
    splash_emitter: SplashEmitter | None = None
    quality: str | None = None  # low, medium, high, ultra or auto
    extra: Mapping[str, Any] = field(default_factory=dict, hash=False)


class PlacedError(InvalidValueError):
    """A value that is wrong, and where in a document it is."""

    def __init__(self, path: Path, value: object, allowed: str) -> None:
        super().__init__(shown(path), value, allowed)
        self.path = path


def shown(path: Path) -> str:
    """A place in a document as a message has it: models[0].seeds[2].width."""
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else str(part)
    return text


def check_content(content: CloudFile, before: CloudFile | None = None) -> None:
    """Raises PlacedError for a content that a file cannot hold.

    Parts that are the same objects as in `before`, which was good, are not looked at again.
    """
    for key, kind in MANY.items():
        value = getattr(content, key)
        if before is not None and value is getattr(before, key):
            continue
        if not isinstance(value, tuple) or not all(isinstance(item, kind) for item in value):
            raise PlacedError((key,), value, f"a tuple of {kind.__name__}")
    for key, kind in ONE.items():
        value = getattr(content, key)
        if value is not None and not isinstance(value, kind):
            raise PlacedError((key,), value, f"a {kind.__name__} or None")
    own = content.layer_climates
    if not isinstance(own, tuple) or len(own) > len(content.layers):
        raise PlacedError(("layer_climates",), own, "a tuple, not longer than the layers")
    for index, climate in enumerate(own):
        if not isinstance(climate, Climate | None):
            raise PlacedError(("layers", index, "climate"), climate, "a Climate or None")
    if content.quality is not None and content.quality not in QUALITIES:
        raise PlacedError(("quality",), content.quality, ", ".join(QUALITIES))
    if not isinstance(content.extra, Mapping):
        raise PlacedError(("extra",), content.extra, "a table")
    _check_models(content, before)
    _check_names(content, before)


def _check_models(content: CloudFile, before: CloudFile | None) -> None:
    if before is not None and content.models is before.models:
        return
    known = set() if before is None else {id(model) for model in before.models}
    names: set[str] = set()
    for index, model in enumerate(content.models):
        if model.name in names:
            raise PlacedError(("models", index, "name"), model.name, "names that all differ")
        names.add(model.name)
        if id(model) not in known:
            _check_images(model, ("models", index))


def _check_images(model: CloudModel, path: Path) -> None:
    where = [(path, model.images)]
    where += [((*path, "seeds", i), seed.images) for i, seed in enumerate(model.seeds)]
    for place, images in where:
        try:
            image_indices(images)
        except InvalidValueError as error:
            raise PlacedError((*place, "images"), error.value, error.allowed) from None


def _check_names(content: CloudFile, before: CloudFile | None) -> None:
    fields = ("models", "clouds", "layers")
    if before is not None and all(getattr(content, f) is getattr(before, f) for f in fields):
        return
    usable = {*CLOUD_MODELS, *[model.name for model in content.models]}
    for index, cloud in enumerate(content.clouds):
        _check_used([cloud.model], usable, ("clouds", index, "model"))
    for index, layer in enumerate(content.layers):
        for inner, sky in enumerate(layer.skies):
            _check_used(sky.models, usable, ("layers", index, "skies", inner, "models"))
        _check_room(layer, content.models, ("layers", index, "size"))


def _check_room(layer: SkyLayer, models: Sequence[CloudModel], path: Path) -> None:
    """Models are in a file's layers by their names, which say nothing of their size."""
    own = {model.name: model for model in models}
    names = {model for sky in layer.skies for model in sky.models if isinstance(model, str)}
    for name in sorted(names):
        try:
            layer.check_holds(own.get(name) or _packaged(name))
        except InvalidValueError as error:
            raise PlacedError(path, error.value, error.allowed) from None


@cache
def _packaged(name: str) -> CloudModel:
    """A model of the package's, to be looked at only."""
    from weather_ecs.cloud_presets import cloud_model  # which reads files, and so needs this module

    return cloud_model(name)


def _check_used(models: Sequence[CloudModel | str], usable: set[str], path: Path) -> None:
    for model in models:
        if isinstance(model, str) and model not in usable:
            raise PlacedError(path, model, "a model of this file or of the package")
