"""Cameras read from matrices."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.views import look_from, perspective
from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.camera import camera_from, wrap_angle


@given(st.floats(-500, 500), st.floats(-500, 500), st.floats(-3.1, 3.1), st.floats(-1.4, 1.4))
def test_position_and_heading_come_back(x: float, z: float, heading: float, pitch: float) -> None:
    camera = camera_from(look_from((x, 2.0, z), heading, pitch), perspective())
    assert np.allclose(camera.position, (x, 2.0, z), atol=1e-6)
    assert abs(wrap_angle(camera.heading - heading)) < 1e-6


def test_level_half_width_is_half_the_horizontal_field() -> None:
    projection = perspective(60.0, 16 / 9)
    camera = camera_from(look_from((0, 0, 0), 0.3, 0.0), projection)
    level = math.atan(math.tan(math.radians(30.0)) * 16 / 9)
    # The corners of a level picture lie at the same azimuth as the middles of its sides.
    assert camera.half_width == pytest.approx(level)


def test_half_width_grows_with_pitch_and_is_whole_straight_down() -> None:
    widths = [
        camera_from(look_from((0, 0, 0), 0.0, -pitch), perspective()).half_width
        for pitch in (0.0, 0.3, 0.6, 1.2)
    ]
    assert widths == sorted(widths)
    assert widths[-1] > math.pi / 2
    down = camera_from(look_from((0, 0, 0), 0.7, -math.pi / 2), perspective())
    assert down.half_width > math.pi / 2
    assert abs(wrap_angle(down.heading - 0.7)) < 1e-6


def test_column_major_floats_equal_the_array() -> None:
    view, projection = look_from((3, 4, 5), 1.0, 0.2), perspective()
    flat = camera_from(tuple(view.T.ravel()), list(projection.T.ravel()))
    assert flat.position == pytest.approx((3, 4, 5))
    assert np.allclose(flat.view, view)


def test_parallel_projection_needs_the_whole_cylinder() -> None:
    assert camera_from(look_from((0, 0, 0), 0, 0), np.eye(4)).half_width == math.pi


@pytest.mark.parametrize(
    "bad",
    [None, 3, "x", np.eye(3), np.zeros((4, 4)), np.full((4, 4), np.nan), [1.0] * 15, [[1], [2, 3]]],
)
def test_what_is_no_camera_is_named(bad: object) -> None:
    with pytest.raises(InvalidValueError, match="view"):
        camera_from(bad, perspective())
    with pytest.raises(InvalidValueError, match="projection"):
        camera_from(np.eye(4), bad)


@pytest.mark.parametrize("factor", [1e16, 1e39, 1e200, -1e39])
def test_numbers_that_shaders_cannot_hold_are_refused(factor: float) -> None:
    view, projection = look_from((0.0, 2.0, 0.0), 0.3), perspective()
    with pytest.raises(InvalidValueError, match="view"):
        camera_from(view * factor, projection)
    with pytest.raises(InvalidValueError, match="projection"):
        camera_from(view, projection * factor)
    assert camera_from(view, projection * 1e10).position == pytest.approx((0.0, 2.0, 0.0))


@given(st.lists(st.floats(-10.0, 10.0), min_size=12, max_size=12))
def test_any_affine_view_is_inverted(numbers: list[float]) -> None:
    view = np.vstack([np.reshape(numbers, (3, 4)), [0.0, 0.0, 0.0, 1.0]])
    assume(abs(np.linalg.det(view)) > 1e-3)
    expected = np.linalg.inv(view)[:3, 3]
    found = camera_from(view, perspective()).position
    assert np.allclose(found, expected, rtol=1e-9, atol=1e-9 * np.linalg.cond(view))


def test_what_is_no_view_is_told_apart() -> None:
    view, projection = look_from((3.0, 4.0, 5.0), 1.0), perspective()
    for wrong in (projection, view.T, view @ projection, projection @ view):
        with pytest.raises(InvalidValueError, match=r"^view: got (?s:.*)neither transposed nor"):
            camera_from(wrong, projection)
    assert camera_from(view + 1e-9, projection).position == pytest.approx((3.0, 4.0, 5.0))


def test_a_view_with_a_scale_of_its_own_is_inverted_too() -> None:
    view = look_from((3.0, 4.0, 5.0), 1.0, 0.2) * 2.0
    assert camera_from(view, perspective()).position == pytest.approx((1.5, 2.0, 2.5))
