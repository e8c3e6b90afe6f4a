"""Files of clouds and weather from texts: what is read of them, or the error."""

from __future__ import annotations

from pathlib import Path

import pytest

from weather_ecs import CloudFile, WeatherFileError, load_clouds

NAME = "clouds.toml"


def load(folder: Path, text: str | bytes) -> CloudFile:
    """What a file with this text holds."""
    path = folder / NAME
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return load_clouds(path)


def refused(folder: Path, text: str | bytes) -> WeatherFileError:
    """The error of a file with this text; it names the file."""
    with pytest.raises(WeatherFileError) as caught:
        load(folder, text)
    assert str(folder / NAME) in str(caught.value)
    return caught.value
