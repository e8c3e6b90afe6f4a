"""The lamps' light on the ground is drawn as far as it adds anything."""

from __future__ import annotations

import numpy as np
import pytest

from demo_game.place import Place
from demo_game.render import water


def added(lamp: np.ndarray, points: np.ndarray) -> np.ndarray:
    """What lamp_pool.frag adds at points, in display values."""
    way = lamp - points
    d2 = (way**2).sum(-1)
    light = 9.0 * way[..., 1] / np.sqrt(d2) / (d2 + 1.5)
    rim = np.clip(1.0 - (way[..., [0, 2]] ** 2).sum(-1) * 0.016, 0.0, 1.0)
    return np.asarray(max(water.POOL_TINT) * light * rim * rim)


def test_what_is_left_out_of_a_pool_adds_less_than_half_a_step() -> None:
    place, rng = Place(0), np.random.default_rng(4)
    lamp = np.array(place.lamps[0].position)
    mesh = place.ground
    whole = mesh.vertices[mesh.indices[: mesh.chunks.sum(1).max()]]
    middle = whole.mean(1)
    close = np.hypot(*(middle - lamp)[:, [0, 2]].T) < water.POOL_RADIUS
    triangles = whole[close]
    most = water.pool_light(lamp, triangles)
    shares = rng.dirichlet((1.0, 1.0, 1.0), 60)
    found = added(lamp, shares @ triangles).max(1)
    assert most.max() == pytest.approx(found.max(), rel=0.3)
    for burn in (0.04, 0.3, 1.0):
        left_out = burn * most < water.UNSEEN
        assert 0.0 < left_out.mean() < 1.0
        assert burn * found[left_out].max() < 0.5 / 255.0
