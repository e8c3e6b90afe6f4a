"""The order of drawing where clouds change places; no OpenGL."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from tests.cloud_stage import clouds
from weather_ecs.gpu.cloud_order import FADE, CloudOrder


def scene(*places: tuple[float, float, float], reach: float = 200.0) -> Any:
    """Clouds at places from the camera, all in view, in the order of their distance."""
    center = np.array(places)
    away = np.linalg.norm(center, axis=1)
    return SimpleNamespace(
        clouds=clouds(*({} for _ in places)),
        center=center,
        away=away,
        reach=np.full(len(places), reach),
        order=np.argsort(-away, kind="stable"),
    )


def drawn(order: CloudOrder, made: Any, dt: float = 0.1) -> list[tuple[int, float]]:
    which, shares = order.update(made, dt)
    return [(int(k), round(float(s), 3)) for k, s in zip(which, shares, strict=True)]


NEAR, FAR = (0.0, 0.0, -990.0), (0.0, 0.0, -1000.0)


def test_the_one_that_comes_to_the_front_is_drawn_in_both_places_for_a_while() -> None:
    order = CloudOrder()
    assert drawn(order, scene(FAR, NEAR)) == [(0, 1.0), (1, 1.0)]
    first = drawn(order, scene(NEAR, FAR))
    assert first == [(0, 1.0), (1, 1.0), (0, 0.208)]
    below, above = [], []
    for _ in range(round(FADE / 0.1)):
        now = drawn(order, scene(NEAR, FAR))
        below.append(now[0][1] if len(now) == 3 else 0.0)
        above.append(now[-1][1])
    assert above == sorted(above)
    assert below == sorted(below, reverse=True)
    # One of them is always whole.
    assert all(max(pair) == 1.0 for pair in zip(below, above, strict=True))
    assert drawn(order, scene(NEAR, FAR)) == [(1, 1.0), (0, 1.0)]


def test_turning_back_goes_on_from_there() -> None:
    order = CloudOrder()
    drawn(order, scene(FAR, NEAR))
    for _ in range(2):
        drawn(order, scene(NEAR, FAR))
    # A quarter of the time has passed: three quarters of it are done the other way.
    assert drawn(order, scene(FAR, NEAR)) == [(1, 0.312), (0, 1.0), (1, 1.0)]


def test_clouds_beside_each_other_change_at_once() -> None:
    order = CloudOrder()
    left, right = (-900.0, 0.0, -990.0), (900.0, 0.0, -1000.0)
    drawn(order, scene((-900.0, 0.0, -1010.0), right))
    assert drawn(order, scene(left, right)) == [(1, 1.0), (0, 1.0)]


def test_what_leaves_the_picture_is_forgotten() -> None:
    order = CloudOrder()
    drawn(order, scene(FAR, NEAR))
    drawn(order, scene(NEAR, FAR))
    gone = scene(NEAR, FAR)
    gone.order = gone.order[gone.order != 1]
    assert drawn(order, gone) == [(0, 1.0)]
    assert drawn(order, scene(NEAR, FAR)) == [(1, 1.0), (0, 1.0)]
    empty = scene(NEAR, FAR)
    empty.order = empty.order[:0]
    assert drawn(order, empty) == []
