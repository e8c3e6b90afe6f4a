"""`Occluder`: meshes and callbacks that rain falls on."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from weather_ecs.components import Occluder
from weather_ecs.errors import InvalidValueError

CORNERS = np.array([(0, 0, 0), (1, 0, 0), (0, 0, 1), (1, 0, 1)], np.float64)
TRIANGLES = [0, 1, 2, 1, 3, 2]


def roof() -> Occluder:
    return Occluder(CORNERS, TRIANGLES)


def test_the_mesh_is_copied_and_read_only():
    mine = CORNERS.copy()
    it = Occluder(mine, np.array(TRIANGLES).reshape(2, 3))
    mine[:] = 9.0
    assert it.vertices.dtype == np.float32
    assert it.indices.dtype == np.uint32
    assert it.indices.tolist() == TRIANGLES
    assert it.vertices.tolist() == CORNERS.tolist()
    for array in (it.vertices, it.indices, it.transform):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_without_a_transform_it_stays_where_it_is():
    assert roof().transform.tolist() == np.eye(4).tolist()


@pytest.mark.parametrize(
    "vertices",
    [
        None,
        [],
        np.zeros((0, 3)),
        CORNERS[:2],
        CORNERS[:, :2],
        CORNERS.ravel(),
        np.where(CORNERS == 1, np.nan, CORNERS),
        np.where(CORNERS == 1, np.inf, CORNERS),
        CORNERS * 1e8,
        CORNERS.astype(complex),
        CORNERS.astype(str),
        CORNERS.astype(bool),
        [[0, 0, 0], [1, 1]],
        "mesh",
    ],
)
def test_bad_vertices(vertices):
    with pytest.raises(InvalidValueError):
        Occluder(vertices, TRIANGLES)
    it = roof()
    before = it.vertices
    with pytest.raises(InvalidValueError, match="vertices"):
        it.vertices = vertices
    assert it.vertices is before


@pytest.mark.parametrize(
    "indices",
    [
        None,
        [],
        [0, 1],
        [0, 1, 2, 3],
        [0, 1, 4],
        [0, 1, -1],
        [0.0, 1.0, 2.0],
        [[0, 1], [2, 3], [0, 1]],
        np.zeros((1, 1, 3), int),
        [True, False, True],
        "012",
        [2**64, 0, 1],
    ],
)
def test_bad_indices(indices):
    with pytest.raises(InvalidValueError):
        Occluder(CORNERS, indices)
    it = roof()
    before = it.indices
    with pytest.raises(InvalidValueError, match="indices"):
        it.indices = indices
    assert it.indices is before


def test_vertices_that_the_indices_still_need_cannot_go():
    it = roof()
    with pytest.raises(InvalidValueError):
        it.vertices = CORNERS[:3]
    it.set_mesh(CORNERS[:3], [0, 1, 2])
    assert len(it.vertices) == 3
    with pytest.raises(InvalidValueError):
        it.set_mesh(CORNERS, [0, 1, 9])
    assert len(it.vertices) == 3
    assert it.indices.tolist() == [0, 1, 2]
    it.vertices = CORNERS
    assert len(it.vertices) == 4


def translation(x: float, y: float, z: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = (x, y, z)
    return matrix


def test_transforms_as_arrays_and_column_by_column():
    it, matrix = roof(), translation(1, 2, 3)
    it.transform = matrix
    matrix[0, 3] = 50.0
    assert it.transform[:3, 3].tolist() == [1, 2, 3]
    it.transform = tuple(translation(4, 5, 6).T.ravel())
    assert it.transform[:3, 3].tolist() == [4, 5, 6]
    it.transform = None
    assert it.transform.tolist() == np.eye(4).tolist()


@pytest.mark.parametrize(
    "transform",
    [
        np.zeros((4, 4)),
        np.diag([1.0, 0.0, 1.0, 1.0]),
        np.full((4, 4), math.nan),
        translation(math.inf, 0, 0),
        translation(0, math.nan, 0),
        translation(1, 2, 3).T,
        np.eye(3),
        [1, 2, 3],
        "matrix",
        np.diag([1.0, 1.0, 1.0, 0.0]),
        np.diag([1e9, 1.0, 1.0, 1.0]),
    ],
)
def test_bad_transforms(transform):
    it = roof()
    before = it.transform
    with pytest.raises(InvalidValueError, match=r"Occluder\.transform"):
        it.transform = transform
    assert it.transform is before
    with pytest.raises(InvalidValueError):
        Occluder(CORNERS, TRIANGLES, transform)


@settings(deadline=None)
@given(st.floats(1e-3, 1e3), st.floats(-4, 4), st.floats(-1e6, 1e6))
def test_turned_scaled_and_moved_is_fine_at_any_scale(scale, angle, shift):
    c, s = math.cos(angle) * scale, math.sin(angle) * scale
    matrix = np.array([(c, 0, s, shift), (0, scale, 0, 0), (-s, 0, c, 1), (0, 0, 0, 1)])
    assert Occluder(CORNERS, TRIANGLES, matrix).transform.tolist() == matrix.tolist()


def test_a_mesh_or_a_callback_never_both():
    def paint(matrix: np.ndarray) -> None:
        raise AssertionError("nobody draws here")

    assert Occluder(draw=paint).draw is paint
    for arguments in ({}, {"vertices": CORNERS}, {"indices": TRIANGLES}):
        with pytest.raises(InvalidValueError):
            Occluder(**arguments)
    with pytest.raises(InvalidValueError):
        Occluder(CORNERS, TRIANGLES, draw=paint)
    with pytest.raises(InvalidValueError):
        Occluder(draw="paint")
    it = Occluder(draw=paint)
    for change in (
        lambda: it.set_mesh(CORNERS, TRIANGLES),
        lambda: setattr(it, "vertices", CORNERS),
        lambda: setattr(it, "indices", TRIANGLES),
        lambda: setattr(it, "draw", None),
        lambda: setattr(roof(), "draw", paint),
    ):
        with pytest.raises(InvalidValueError):
            change()
    assert it.vertices is None
    assert it.draw is paint


@pytest.mark.parametrize("layers", [0, -1, 2**32, 1.0, True, None])
def test_bad_layers(layers):
    with pytest.raises(InvalidValueError, match="layers"):
        Occluder(CORNERS, TRIANGLES, layers=layers)


def test_flags_and_unknown_names():
    it = Occluder(CORNERS, TRIANGLES, dynamic=np.bool_(True), layers=np.int64(6))
    assert it.dynamic is True
    assert it.layers == 6
    with pytest.raises(InvalidValueError, match="dynamic"):
        it.dynamic = 1
    with pytest.raises(AttributeError):
        it.transfrom = np.eye(4)
