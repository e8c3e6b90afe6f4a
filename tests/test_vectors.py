"""The cross product, number for number numpy's."""

from __future__ import annotations

import numpy as np
import pytest

from weather_ecs.physics.vectors import cross


@pytest.mark.parametrize("shapes", [((3,), (3,)), ((5, 3), (5, 3)), ((5, 3), (3,)), ((0, 3), (3,))])
def test_it_is_numpys_own(shapes):
    rng = np.random.default_rng(3)
    a, b = (rng.normal(size=shape) for shape in shapes)
    assert np.array_equal(cross(a, b), np.cross(a, b))
