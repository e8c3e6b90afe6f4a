"""The clouds' images: enough of them, always the same, and fit to be drawn."""

from __future__ import annotations

import moderngl
import numpy as np
import pytest

from weather_ecs.gpu.cloud_images import SIZE, SOFTWARE, hulls, image_array, images
from weather_ecs.physics.cloud_images import CLOUD_IMAGES, image_index


def test_there_are_sixteen_of_five_families_and_no_two_alike() -> None:
    assert len(CLOUD_IMAGES) == len(set(CLOUD_IMAGES)) == len(images()) >= 16
    families = {name.split("_")[0] for name in CLOUD_IMAGES}
    assert families == {"puff", "ragged", "wisp", "streak", "sheet"}
    flat = images().reshape(len(CLOUD_IMAGES), -1)
    assert len({layer.tobytes() for layer in flat}) == len(CLOUD_IMAGES)
    assert image_index(CLOUD_IMAGES[3]) == 3


def test_they_are_made_the_same_each_time() -> None:
    again = images.__wrapped__()  # past the cache
    assert again.tobytes() == images().tobytes()
    with pytest.raises(ValueError):
        images()[0, 0, 0, 0] = 1


@pytest.mark.parametrize("name", CLOUD_IMAGES)
def test_none_shows_its_square(name: str) -> None:
    cover = images()[image_index(name), ..., 3].astype(float) / 255.0
    rim = np.concatenate([cover[0], cover[-1], cover[:, 0], cover[:, -1]])
    assert rim.max() == 0.0
    assert cover.max() > 0.4
    # It fills a fair part of the image: what is empty is drawn for nothing.
    assert (cover > 0.1).mean() > 0.15


def test_puffs_are_dense_and_crisp_and_sheets_have_no_outline() -> None:
    def steepest(family: str) -> float:
        layers = [images()[image_index(n), ..., 3] for n in CLOUD_IMAGES if n.startswith(family)]
        slopes = [np.abs(np.diff(layer.astype(float), axis=1)) for layer in layers]
        return float(np.mean([np.percentile(s[s > 1.0], 95) for s in slopes]))

    puffs = [images()[image_index(n), ..., 3] for n in CLOUD_IMAGES if n.startswith("puff")]
    assert all(puff.max() > 240 for puff in puffs)
    assert steepest("puff") > 2.0 * steepest("sheet")


def test_relief_is_level_on_the_whole_and_shade_bright() -> None:
    data = images().astype(float) / 255.0
    seen = data[..., 3] > 0.5
    for layer, mask in zip(data, seen, strict=True):
        assert np.abs(layer[mask][:, :2].mean(axis=0) - 0.5).max() < 0.08
        assert layer[mask][:, 2].mean() > 0.75


def test_they_are_on_the_gpu_with_mipmaps(ctx: moderngl.Context) -> None:
    array = image_array(ctx)
    try:
        assert (array.width, array.height, array.layers) == (SIZE, SIZE, len(CLOUD_IMAGES))
        slow = any(name in ctx.info["GL_RENDERER"] for name in SOFTWARE)
        wanted = moderngl.LINEAR_MIPMAP_NEAREST if slow else moderngl.LINEAR_MIPMAP_LINEAR
        assert array.filter[0] == wanted
        assert array.read() == images().tobytes()
    finally:
        array.release()


def test_octagons_hold_what_the_images_show_and_not_much_more() -> None:
    axis = (np.arange(SIZE) + 0.5) / SIZE * 2.0 - 1.0
    x, y = np.meshgrid(axis, axis)
    for cover, hull in zip(images()[..., 3], hulls(), strict=True):
        inside = np.ones_like(x, bool)
        for (x0, y0), (x1, y1) in zip(hull, np.roll(hull, -1, axis=0), strict=True):
            inside &= (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0) >= -1e-6
        assert not cover[~inside].any()
        assert inside.mean() < 0.8
        assert np.abs(hull).max() <= 1.0
