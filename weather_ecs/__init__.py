"""Weather for Python games: rain areas to walk into and out of, on esper, pyglet and moderngl.

Importing the package touches no OpenGL.
"""

from __future__ import annotations

from weather_ecs.cloud_files import (
    CloudFile,
    load_cloud_model,
    load_clouds,
    save_cloud_model,
    save_clouds,
)
from weather_ecs.errors import (
    ClosedError,
    ContextError,
    InvalidValueError,
    ShaderError,
    SnapshotError,
    WeatherError,
    WeatherFileError,
)
from weather_ecs.public_glsl import glsl
from weather_ecs.quality import QualitySettings
from weather_ecs.sampling import Sample, Samples
from weather_ecs.stats import Stats
from weather_ecs.weather import Weather

__version__ = "0.1.0"

__all__ = [
    "ClosedError",
    "CloudFile",
    "ContextError",
    "InvalidValueError",
    "QualitySettings",
    "Sample",
    "Samples",
    "ShaderError",
    "SnapshotError",
    "Stats",
    "Weather",
    "WeatherError",
    "WeatherFileError",
    "__version__",
    "glsl",
    "load_cloud_model",
    "load_clouds",
    "save_cloud_model",
    "save_clouds",
]
