"""`glsl`: pieces of shader for a game's own shaders."""

from __future__ import annotations

from functools import cache
from importlib import resources

from weather_ecs.errors import InvalidValueError

PUBLIC = (
    "cloud_shadow.glsl", "heightmap.glsl", "ripple_sample.glsl", "sky.glsl", "weather.glsl",
    "wetness.glsl",
)  # fmt: skip


@cache
def glsl(name: str) -> str:
    """Text of one of the package's public includes, without `#version`, to be pasted in.

    `cloud_shadow.glsl`: see `Weather.cloud_shadow`; `heightmap.glsl`: see `Weather.heightmap`;
    `ripple_sample.glsl`: see `Weather.ripples`; `sky.glsl`: see `Weather.sky`; `weather.glsl`: see
    `Weather.air`; `wetness.glsl`: see `Weather.wetness`. One shader may have several; their
    functions are in docs/shaders.md and the pages that it names.

    Raises InvalidValueError for another name.
    """
    if name not in PUBLIC:
        raise InvalidValueError("name", name, ", ".join(PUBLIC))
    shaders = resources.files("weather_ecs").joinpath("shaders")
    return shaders.joinpath(name).read_text(encoding="utf-8")
