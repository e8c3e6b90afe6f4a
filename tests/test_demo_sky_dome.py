"""The sky's dome: what of it is left out is always behind the ground."""

from __future__ import annotations

import numpy as np

from demo_game.place import Place
from demo_game.place.ground_mesh import HILL_RINGS
from demo_game.render.sky_dome import (
    HIDDEN,
    HIDDEN_FROM,
    RINGS,
    SECTORS,
    dome,
    first_index,
)


def test_triangles_go_from_the_lowest_band_up() -> None:
    directions, triangles = dome()
    up = np.degrees(np.arcsin(np.clip(directions[triangles][:, :, 1], -1.0, 1.0)))
    assert len(triangles) == 2 * SECTORS * (len(RINGS) - 1)
    assert (np.diff(up.min(axis=1)) > -1e-3).all()
    first = first_index(HIDDEN_FROM - 0.1) // 3
    assert up[:first].max() < RINGS[HIDDEN] + 1e-3
    assert up[first:].min() > RINGS[HIDDEN] - 1e-3
    assert first_index(HIDDEN_FROM) == 0


def test_the_ground_hides_the_bands_that_low_eyes_leave_out() -> None:
    place = Place()
    slope = np.tan(np.radians(RINGS[HIDDEN]))
    away = np.linspace(20.0, 2100.0, 400)[:, None]
    turn = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    for x, z in ((0.0, 74.0), (-28.0, -70.0), (190.0, 150.0), (-190.0, -230.0)):
        far_x, far_z = x + away * np.cos(turn), z + away * np.sin(turn)
        assert np.hypot(far_x, far_z + 40.0).max() < HILL_RINGS[-1]
        ray = HIDDEN_FROM + away * slope
        assert (place.terrain.surface(far_x, far_z) > ray).any(axis=0).all()
