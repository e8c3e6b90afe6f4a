"""Products that are numpy's: the cross product number for number."""

from __future__ import annotations

import numpy as np
import pytest

from weather_ecs.physics.vectors import cross, product_columns


@pytest.mark.parametrize("shapes", [((3,), (3,)), ((5, 3), (5, 3)), ((5, 3), (3,)), ((0, 3), (3,))])
def test_it_is_numpys_own(shapes):
    rng = np.random.default_rng(3)
    a, b = (rng.normal(size=shape) for shape in shapes)
    assert np.array_equal(cross(a, b), np.cross(a, b))


def test_a_product_column_by_column():
    a, b = np.random.default_rng(4).normal(size=(2, 4, 4))
    found = product_columns(a.tolist(), b.tolist())
    assert np.allclose(found, (a @ b).T.ravel(), rtol=1e-14, atol=1e-15)
