"""The package's own clouds: each genus has its height, its shape and its looks."""

from __future__ import annotations

from pathlib import Path

import esper
import numpy as np
import pytest

from tests.worlds import fresh_world
from weather_ecs import Weather, presets
from weather_ecs.clock import STEP
from weather_ecs.components import Cloud, CloudModel, CloudSeed, Sky, SkyLayer
from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.cloud_images import CLOUD_IMAGES
from weather_ecs.physics.cloud_shape import CloudShape, shape

FOLDER = Path(presets.__file__).parent / "clouds"
GENERA = {
    "high": ["cirrus", "cirrostratus", "cirrocumulus"],
    "middle": ["altostratus", "altocumulus"],
    "low": ["stratus", "stratocumulus", "cumulus", "cumulonimbus", "fractostratus"],
    "several": ["nimbostratus"],  # low to middle
}
# Heights of the bases, m: Ahrens, as Torchelsen 2005 has them in Table 2, any latitude.
BANDS = {"high": (3000, 18000), "middle": (2000, 8000), "low": (0, 2000), "several": (0, 8000)}


def made(name: str, n: int = 8) -> tuple[CloudModel, list[CloudShape]]:
    model = presets.cloud_model(name)
    return model, [shape(model, number) for number in range(n)]


def outline(it: CloudShape) -> np.ndarray:
    """(n, 4): of what billboards show, least and greatest x, least and greatest height, m."""
    reach = 0.375 * it.billboards["size"]
    place = it.billboards["position"]
    low = place[:, 1] + it.half[1] - reach[:, 1]
    return np.stack(
        (place[:, 0] - reach[:, 0], place[:, 0] + reach[:, 0], low, low + 2 * reach[:, 1]), axis=1
    )


def test_there_is_a_file_for_each_and_no_other():
    assert sorted(presets.CLOUD_MODELS) == sorted(
        [name for names in GENERA.values() for name in names]
    )
    files = {path.name for path in FOLDER.iterdir() if path.name != "__pycache__"}
    assert files == {f"{name}.toml" for name in presets.CLOUD_MODELS} | {"skies.toml"}


@pytest.mark.parametrize(("band", "name"), [(b, n) for b, names in GENERA.items() for n in names])
def test_a_genus_has_its_height_and_a_modest_cost(band, name):
    model, shapes = made(name)
    assert model.name == name
    low, high = BANDS[band]
    assert low <= model.base[0] < model.base[1] <= high
    for it in shapes:
        assert 4 <= len(it.centers) <= 40
        assert 10 <= len(it.billboards) <= 150
    assert len({it.centers.tobytes() for it in shapes}) == len(shapes)
    assert np.mean([len(it.billboards) for it in shapes]) <= (
        130 if name == "cumulonimbus" else 105
    )


def test_cumulus_stand_on_a_level_base_and_are_as_high_as_wide():
    _, shapes = made("cumulus")
    for it in shapes:
        edges = outline(it)
        assert edges[:, 2].min() == pytest.approx(0.0, abs=1.0)
        base = edges[edges[:, 2] < 40.0]  # what stands on it carries most of the cloud's width
        assert len(base) >= 8
        wide = np.ptp(edges[:, :2])
        assert np.ptp(base[:, :2]) > 0.7 * wide
        assert 0.4 < edges[:, 3].max() / wide < 1.2


def test_cumulonimbus_has_a_tower_and_an_anvil_wider_than_it():
    model, shapes = made("cumulonimbus")
    assert model.rain_rate > 10.0 and model.lightning > 0.0 and model.darkness > 0.7
    for it in shapes:
        edges = outline(it)
        assert 8000.0 < edges[:, 3].max() < 12_000.0
        anvil = edges[edges[:, 2] > 7500.0]
        tower = edges[(edges[:, 2] > 3500.0) & (edges[:, 3] < 7500.0)]
        assert np.ptp(anvil[:, :2]) > 12_000.0
        assert np.ptp(anvil[:, :2]) > 1.7 * np.ptp(tower[:, :2])
        assert anvil[:, 3].max() - np.median(anvil[:, 2]) < 2500.0  # flat
        streaks = [CLOUD_IMAGES[image].startswith("streak") for image in it.billboards["image"]]
        assert any(streaks)
        assert it.billboards["position"][streaks, 1].min() + it.half[1] > 8000.0


@pytest.mark.parametrize("name", ["stratus", "nimbostratus", "altostratus", "cirrostratus"])
def test_layers_are_wide_and_thin_and_nearly_closed(name):
    _, shapes = made(name)
    closed = []
    for it in shapes:
        edges = outline(it)
        wide = np.ptp(edges[:, :2])
        assert wide > 4500.0
        high = edges[:, 3].max() - edges[:, 2].min()
        assert high < (0.45 if name == "nimbostratus" else 0.15) * wide
        # Seen from below, what the billboards show covers the middle of the cloud.
        axis = np.linspace(-0.2, 0.2, 21) * wide
        grid = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
        away = np.linalg.norm(it.billboards["position"][:, None, ::2] - grid[None], axis=2)
        closed.append((away < 0.375 * it.billboards["size"][:, 0, None]).any(axis=0).mean())
        # Large ones cost a viewer below most: all of them together are a few times the cloud.
        area = (it.billboards["size"][:, 0].astype(float) ** 2).sum()
        assert area < 7.0 * 4.0 * it.half[0] * it.half[2]
    assert np.mean(closed) > 0.8


@pytest.mark.parametrize(("name", "width"), [("altocumulus", 450), ("cirrocumulus", 450)])
def test_patches_are_many_small_heaps(name, width):
    _, shapes = made(name)
    for it in shapes:
        assert it.billboards["size"][:, 0].max() < width
        assert len(it.billboards) > 50
        assert it.half[0] > 1000.0


def test_cirrus_is_drawn_out_and_white():
    model, shapes = made("cirrus")
    assert np.isinf(model.light_penetration) and model.darkness == 0.0
    for it in shapes:
        streaks = [CLOUD_IMAGES[image].startswith("streak") for image in it.billboards["image"]]
        assert np.mean(streaks) > 0.7
        assert np.abs(it.billboards["turn"]).max() < np.radians(10)


def test_looks_go_with_the_weather():
    models = {name: presets.cloud_model(name) for name in presets.CLOUD_MODELS}
    rain = {name for name, model in models.items() if model.rain_rate > 1.0}
    assert rain == {"nimbostratus", "cumulonimbus"}
    assert {name for name, model in models.items() if model.halo} == {"cirrostratus"}
    dark = sorted(models, key=lambda name: models[name].darkness)
    assert set(dark[-2:]) == rain
    assert all(models[name].darkness == 0.0 for name in GENERA["high"])


def test_models_are_new_each_time_and_unknown_names_are_refused():
    assert presets.cloud_model("cumulus") is not presets.cloud_model("cumulus")
    with pytest.raises(InvalidValueError, match=r"plume.*cumulus"):
        presets.cloud_model("plume")


def test_skies_are_layers_at_their_heights_with_a_climate():
    got = presets.sky("clear", "storm", duration=300.0)
    assert got.climate is not None
    assert (got.climate.initial, got.climate.final, got.climate.duration) == (0.0, 1.0, 300.0)
    assert got.climate.running
    assert [layer.base for layer in got.layers] == [8500.0, 3800.0, 1100.0, 480.0]
    for layer in got.layers:
        assert {sky.state for sky in layer.skies} <= set(presets.SKIES.values())
        assert {0.0, 1.0} <= {sky.state for sky in layer.skies}
        for sky in layer.skies:
            for name in sky.models:
                low, high = presets.cloud_model(name).base
                assert low <= layer.base <= high
    still = presets.sky("overcast").climate
    assert still is not None
    assert (still.initial, still.final, still.running) == (0.75, 0.75, False)
    for names in (("fog",), ("clear", "fog")):
        with pytest.raises(InvalidValueError, match=r"fog.*overcast"):
            presets.sky(*names)


def test_a_weather_knows_the_packages_models_and_the_worlds_come_first():
    sky = Sky(0.0, ("cumulus",), generated=1, count=1)
    layer = SkyLayer(size=(5000.0, 5000.0), skies=(sky,))
    with fresh_world(), Weather() as weather:
        esper.create_entity(layer)
        esper.create_entity(Cloud("cumulonimbus", (0.0, 900.0, 0.0)))
        esper.process(STEP)
        found = weather._state.models.find("cumulus", weather._state.uids)
        assert (
            found is not None
            and found.seeds[0].width == presets.cloud_model("cumulus").seeds[0].width
        )
        assert weather.stats.clouds == 2
        mine = CloudModel("cumulus", (CloudSeed(),))
        esper.create_entity(mine)
        assert weather._state.models.find("cumulus", weather._state.uids) is mine
