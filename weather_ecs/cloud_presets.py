"""The package's own clouds, from the files in `clouds/`: kinds of cloud, and skies of them."""

from __future__ import annotations

from dataclasses import replace
from importlib import resources

from weather_ecs.cloud_files import CLOUD_MODELS, CloudFile, load_cloud_model, load_clouds
from weather_ecs.components import Climate, CloudModel
from weather_ecs.errors import InvalidValueError

# States of the skies of `sky`.
SKIES: dict[str, float] = {
    "clear": 0.0,
    "fair": 0.25,
    "cloudy": 0.5,
    "overcast": 0.75,
    "storm": 1.0,
}


def cloud_model(name: str) -> CloudModel:
    """A new model of the package's, one of CLOUD_MODELS. Raises InvalidValueError for others."""
    if name not in CLOUD_MODELS:
        raise InvalidValueError("name", name, ", ".join(CLOUD_MODELS))
    with resources.as_file(resources.files("weather_ecs") / "clouds" / f"{name}.toml") as path:
        return load_cloud_model(path)


def find_model(name: str) -> CloudModel | None:
    """The package's model of this name, if there is one."""
    return cloud_model(name) if name in CLOUD_MODELS else None


def sky(name: str, to: str | None = None, duration: float = 600.0) -> CloudFile:
    """Layers from high to low, with a climate that stands at the sky of this name.

    With `to` it runs from there to that sky in `duration` seconds. Add the layers and the climate
    as entities; `weather_ecs/clouds/skies.toml` is what they are made from.
    """
    for each in (name, to):
        if each is not None and each not in SKIES:
            raise InvalidValueError("name", each, ", ".join(SKIES))
    with resources.as_file(resources.files("weather_ecs") / "clouds" / "skies.toml") as path:
        layers = load_clouds(path)
    start = SKIES[name]
    end = start if to is None else SKIES[to]
    return replace(layers, climate=Climate(start, end, duration, running=to is not None))
