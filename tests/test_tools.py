"""What tools of a game's own may ask of a weather."""

from __future__ import annotations

import esper
import numpy as np
import pytest

from weather_ecs import ClosedError, Weather
from weather_ecs.components import RainArea
from weather_ecs.tools import (
    CLOUD_IMAGES,
    FrameData,
    climate_state,
    cloud_images,
    frame_of,
    sky_shares,
)
from worlds import fresh_world


def test_a_map_reads_the_areas_from_the_frame() -> None:
    with fresh_world():
        weather = Weather()
        area = RainArea((30.0, -40.0), (60.0, 50.0), 12.0)
        esper.create_entity(area)
        frame = frame_of(weather)
        assert isinstance(frame, FrameData) and frame_of(weather) is frame
        assert frame.areas["center"].tolist() == [[30.0, -40.0]]
        with pytest.raises(ValueError, match="read-only"):
            frame.areas["center"] = 0.0
        area.rain_rate = 5.0
        assert frame_of(weather).areas["rain_rate"].tolist() == [5.0]
        weather.close()
        with pytest.raises(ClosedError):
            frame_of(weather)


def test_images_are_as_many_as_their_names() -> None:
    images = cloud_images()
    assert images.shape == (len(CLOUD_IMAGES), 256, 256, 4) and images.dtype == np.uint8
    assert not images.flags.writeable and (images[..., 3].max(axis=(1, 2)) > 200).sum() > 6


def test_a_climate_goes_from_sky_to_sky() -> None:
    assert climate_state(0.2, 0.8, 60.0, 30.0) == pytest.approx(0.5)
    np.testing.assert_allclose(sky_shares([0.0, 1.0], 0.25), [0.75, 0.25])
