"""Ready weathers for a document: presets, skies, and the weather of a METAR report."""

from __future__ import annotations

import itertools
from dataclasses import replace

import esper

from weather_ecs import CloudFile, Weather, presets
from weather_ecs.cloud_world import gather
from weather_ecs.components import (
    Air,
    Atmosphere,
    Climate,
    CloudModel,
    Fog,
    RainArea,
    SkyLayer,
    Wind,
)
from weather_ecs.editor.inside import covered_by, in_world
from weather_ecs.metar import MetarReport, read_metar
from weather_ecs.weathers import WholeWeather

AREA = (800.0, 500.0)  # m, radii of a rain area that a preset has to make
_numbers = itertools.count(1)


def with_whole(
    content: CloudFile, whole: str | WholeWeather, center: tuple[float, float] = (0.0, 0.0)
) -> CloudFile:
    """The content with a whole weather's layers, climate, rain, wind, air, fog and lightning.

    Models, clouds, looks and the place of the sun stay; the sky is as covered as the weather says.
    What rains falls in the weather's own area, as in a game: clouds that would bring rain besides
    are made to stay dry. Raises InvalidValueError.
    """
    world = f"weather_ecs.editor whole {next(_numbers)}"
    try:
        with in_world(world), Weather() as weather:
            weather.change_to(whole, center=center)
            made = gather(weather.inner_state)
            now = weather.whole
            overcast = 0.0 if now is None else covered_by(now.conditions.overcast)
    finally:
        if world in esper.list_worlds():
            esper.delete_world(world)
    areas = tuple(area for area in made.rain_areas if area.rain_rate > 0.0)
    models, layers = content.models, made.layers
    if areas:
        models, layers = _dry(models, layers)
    states = [climate.initial for climate in made.layer_climates if climate is not None]
    state = states[0] if states else 0.0
    return replace(
        content,
        models=models,
        layers=tuple(replace(layer, skies=(replace(layer.skies[-1], state=state),))
                     for layer in layers),
        layer_climates=(),
        climate=Climate(state, state, 600.0, running=False),
        rain_areas=areas,
        winds=made.winds,
        air=made.air,
        fog=made.fog,
        lightning=made.lightning,
        atmosphere=_covered(content, overcast),
    )  # fmt: skip


def with_sky(content: CloudFile, name: str, to: str | None, duration: float) -> CloudFile:
    """The content with layers and climate of one of `presets.SKIES`, or from one to another.

    Raises InvalidValueError.
    """
    sky = presets.sky(name, to, duration)
    air = content.atmosphere
    if air is not None and air.overcast is not None:
        air = replace(air, overcast=None)  # by the climate again
    return replace(
        content, layers=sky.layers, layer_climates=(), climate=sky.climate, atmosphere=air
    )


def with_preset(content: CloudFile, name: str, area: int = 0) -> CloudFile:
    """The content with the rain, wind, air and fog of one of `presets.PRESETS`.

    Rain goes into the area at this index; one is made where there is none and it rains.
    Raises InvalidValueError.
    """
    preset = presets.find(name)
    areas = content.rain_areas
    if areas:
        index = min(max(area, 0), len(areas) - 1)
        wet = replace(areas[index], rain_rate=preset.rain_rate)
        areas = (*areas[:index], wet, *areas[index + 1 :])
    elif preset.rain_rate > 0.0:
        areas = (RainArea((0.0, 0.0), AREA, preset.rain_rate, soft_edge=80.0),)
    first = content.winds[0] if content.winds else Wind()
    wind = replace(first, speed=preset.wind_speed, gustiness=preset.gustiness)
    air = replace(content.air or Air(), temperature=preset.temperature, humidity=preset.humidity)
    fog = replace(content.fog or Fog(), visibility=preset.visibility)
    return replace(content, rain_areas=areas, winds=(wind, *content.winds[1:]), air=air, fog=fog)


def read(text: str) -> MetarReport:
    """A METAR report. Raises MetarError, MissingExtraError."""
    return read_metar(text)


def _covered(content: CloudFile, overcast: float) -> Atmosphere | None:
    """The document's sky, covered so far; where a sun gives the light there is none."""
    if content.atmosphere is None and content.sun is not None:
        return None
    return replace(content.atmosphere or Atmosphere(), overcast=round(overcast, 3))


def _dry(
    models: tuple[CloudModel, ...], layers: tuple[SkyLayer, ...]
) -> tuple[tuple[CloudModel, ...], tuple[SkyLayer, ...]]:
    """Copies without rain of the package's models that rain, and layers that have them."""
    known = {model.name: model for model in models}
    added: dict[str, CloudModel] = {}

    def dry(name: CloudModel | str) -> CloudModel | str:
        if not isinstance(name, str):
            return name
        wet = known.get(name) or presets.cloud_model(name)
        if wet.rain_rate == 0.0:
            return name
        called = f"dry {name}"[:64]
        if called not in known and called not in added:
            added[called] = replace(wet, name=called, rain_rate=0.0)
        return called

    changed = tuple(
        replace(
            layer,
            skies=tuple(replace(sky, models=tuple(map(dry, sky.models))) for sky in layer.skies),
        )
        for layer in layers
    )
    return (*models, *added.values()), changed
