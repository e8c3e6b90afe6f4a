"""Pictures of the rain, held against those that were looked at and found good.

After a change of the looks that is meant, look at the new pictures and keep them:

    REGENERATE_GOLDEN=1 python -m pytest tests/test_golden.py

They were made with Mesa's llvmpipe. Other drivers round and rasterise otherwise, so that there the
pictures are only compared as a whole: how bright, and whether the rain is where it should be.
"""

from __future__ import annotations

import os
from pathlib import Path

import moderngl
import pytest
from PIL import Image

from tests.golden_pictures import GOLDEN, check, difference, kept
from tests.golden_scenes import SCENES, picture
from weather_ecs.gpu.context import probe


@pytest.mark.parametrize("name", SCENES)
def test_the_picture_is_the_one_that_was_kept(
    ctx: moderngl.Context, name: str, tmp_path: Path
) -> None:
    found = picture(ctx, name)
    if os.environ.get("REGENERATE_GOLDEN"):
        GOLDEN.mkdir(exist_ok=True)
        Image.fromarray(found).save(GOLDEN / f"{name}.png", optimize=True)
    check(ctx, found, name, tmp_path)


@pytest.mark.parametrize("name", ["near", "cloudburst"])
def test_the_other_backend_draws_it_too(ctx: moderngl.Context, name: str, tmp_path: Path) -> None:
    if not probe(ctx).compute:
        pytest.skip("there is only one here")
    check(ctx, picture(ctx, name, "feedback"), name, tmp_path)


def test_no_two_pictures_pass_for_each_other() -> None:
    names = list(SCENES)
    for k, one in enumerate(names):
        assert kept(one).shape == (180, 320, 3)
        for other in names[k + 1 :]:
            mean, others = difference(kept(one), kept(other))
            assert mean > 4.0 and others > 0.05
