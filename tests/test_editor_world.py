"""The world view: what a player would see, drawn off screen."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from weather_ecs import CloudFile
from weather_ecs.components import Air, Atmosphere, Fog, RainArea, Sky, SkyLayer, Sun
from weather_ecs.editor.document import Document
from weather_ecs.editor.shared import Shared
from weather_ecs.editor.studio import SETTLED, Studio, studio_of

SIZE = (320, 180)
CUMULI = CloudFile(
    layers=(SkyLayer(700.0, (0.0, -1500.0), (5000.0, 3000.0), (Sky(0.0, ("cumulus",), 2, 14),)),)
)


@pytest.fixture(scope="module")
def studio() -> Iterator[Studio]:
    context = moderngl.create_context(standalone=True, backend="egl")
    made = Studio(context)
    yield made
    made.close()
    made.close()
    assert context.error == "GL_NO_ERROR"
    context.release()


def seen(studio: Studio, content: CloudFile, seconds: float = 0.0) -> NDArray[np.float64]:
    """The picture at a moment, (height, width, 3), top row first, 0 to 1."""
    studio.simulation.show(content, fresh=True)
    studio.simulation.seek(seconds)
    studio.simulation.finish()
    for _ in range(3):
        studio.simulation.update(0.0)
        studio.picture(SIZE, 0.0, 0)
    width, height = studio.target.size
    assert (width, height) == SIZE
    rows = np.frombuffer(studio.target.read(), np.uint8).reshape(height, width, 3)[::-1]
    assert studio.gl.error == "GL_NO_ERROR"
    return rows / 255.0


def test_there_are_sky_land_and_clouds(studio: Studio) -> None:
    clear = seen(studio, CloudFile())
    top, land = clear[:30].mean((0, 1)), clear[-30:].mean((0, 1))
    assert top[2] > top[0] + 0.1  # blue
    assert land[1] > land[2] + 0.1  # green
    cloudy = seen(studio, CUMULI)
    along = [picture[:90].mean(2).std(1).mean() for picture in (clear, cloudy)]
    assert along[1] > 4.0 * along[0]  # a clear sky is even along the horizon
    studio.camera.pitch = -1.2  # at one's feet
    assert abs(seen(studio, CloudFile())[..., 1] - land[1]).mean() < 0.15
    studio.camera.pitch = math.radians(12.0)


def test_it_rains_snows_and_fogs_as_the_document_says(studio: Studio) -> None:
    dry = seen(studio, CloudFile())
    area = RainArea((0.0, 0.0), (3000.0, 3000.0), 60.0)
    wet = seen(studio, CloudFile(rain_areas=(area,)), 4.0)
    assert abs(wet - dry).mean() > 0.03
    assert wet[-20:].mean() < 1.1 * dry[-20:].mean()  # wet ground is dark
    fog = seen(studio, CloudFile(fog=Fog(40.0)))
    assert fog[60:150].std() < 0.5 * dry[60:150].std()
    snow = seen(studio, CloudFile(rain_areas=(area,), air=Air(-8.0)), 60.0)
    assert snow[-20:].mean() > dry[-20:].mean() + 0.15  # white ground


def test_the_sun_is_the_documents(studio: Studio) -> None:
    noon = seen(studio, CloudFile(atmosphere=Atmosphere("2025-06-21T12:00:00Z")))
    night = seen(studio, CloudFile(atmosphere=Atmosphere("2025-06-21T00:00:00Z")))
    assert night.mean() < 0.4 * noon.mean()
    red = Sun(zenith_color=(0.8, 0.1, 0.1), horizon_color=(0.8, 0.2, 0.1))
    painted = seen(studio, CloudFile(sun=red))
    assert painted[:40, :, 0].mean() > painted[:40, :, 2].mean() + 0.3  # a sky without atmosphere


def test_a_picture_is_taken_only_when_it_would_be_another(studio: Studio) -> None:
    seen(studio, CUMULI)
    first, taken = studio.drawn, 0
    while studio.picture(SIZE, 1.0, 0):  # a frame a second: clouds come in by draws, not by time
        taken += studio.simulation.weather.stats.impostors_refreshed
        assert studio.drawn < first + 4 * SETTLED
    assert taken > 0 and studio.drawn - first >= SETTLED
    before = studio.drawn
    studio.picture(SIZE, 1.0, 0)
    assert studio.drawn == before
    studio.camera.look(5.0, 0.0)
    assert studio.picture(SIZE, 0.01, 0) and studio.drawn == before + 1
    assert studio.picture(SIZE, 0.01, 1)  # the document has changed


def test_going_far_takes_the_ground_along(studio: Studio) -> None:
    home = studio.camera.x, studio.camera.z
    studio.camera.go(9000.0, -7000.0)
    far = seen(studio, CloudFile())
    assert far[-30:].mean((0, 1))[1] > 0.1 and far[-30:].std() > 0.005
    studio.camera.go(*home)


def test_another_document_begins_at_its_start_and_brings_its_quality(studio: Studio) -> None:
    shared, document = Shared(studio.gl), Document(replace(CUMULI, quality="low"))
    made = studio_of(shared)
    assert studio_of(shared) is made
    made.update(document, shared)
    assert made.simulation.weather.quality == "low" and made.simulation.time == 0.0
    made.simulation.running = True
    made.update(document, shared)
    assert made.simulation.time > 0.0
    document.reset(CloudFile())
    made.update(document, shared)
    assert made.simulation.time == 0.0 and not made.simulation.running
    assert made.simulation.weather.quality == "medium"
    made.close()
