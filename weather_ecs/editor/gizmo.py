"""A gizmo that moves and sizes a seed in the picture."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from imgui_bundle import imgui
from imgui_bundle.imguizmo import im_guizmo
from numpy.typing import NDArray

from weather_ecs.components import CloudSeed
from weather_ecs.components.cloud_seed import LARGEST, SMALLEST
from weather_ecs.editor.view import Rect

_HALF = [-0.5, -0.5, -0.5, 0.5, 0.5, 0.5]
_STEPS = {"move": im_guizmo.OPERATION.translate, "size": im_guizmo.OPERATION.bounds}


def edit_seed(
    seed: CloudSeed, kind: str, view: NDArray, projection: NDArray, rect: Rect
) -> CloudSeed | None:
    """The seed as the mouse has made it; None while nothing changes.

    kind: "move", or "size", which moves a side and leaves the opposite one where it is; with Ctrl
    in steps of 10 m. The matrices are for column vectors, in the model's axes.
    """
    im_guizmo.set_drawlist(imgui.get_window_draw_list())
    im_guizmo.set_rect(*rect)
    im_guizmo.set_orthographic(False)
    matrix = np.diag([*seed.size, 1.0])
    matrix[:3, 3] = seed.center
    thing = im_guizmo.Matrix16(_flat(matrix))
    snap = im_guizmo.Matrix3([10.0, 10.0, 10.0]) if imgui.get_io().key_ctrl else None
    size = kind == "size"
    changed = im_guizmo.manipulate(
        im_guizmo.Matrix16(_flat(view)),
        im_guizmo.Matrix16(_flat(projection)),
        _STEPS[kind],
        im_guizmo.MODE.world if not size else im_guizmo.MODE.local,
        thing,
        None,
        None if size else snap,
        im_guizmo.Matrix6(_HALF) if size else None,
        snap if size else None,
    )
    if not changed:
        return None
    made = np.array(thing.values, np.float64).reshape(4, 4).T
    if not np.isfinite(made).all():
        return None
    center = np.clip(made[:3, 3], -LARGEST, LARGEST)
    if not size:
        return replace(seed, center=_rounded(center))
    sides = np.clip(np.abs(np.diag(made)[:3]), max(SMALLEST, 0.1), LARGEST)
    width, height, depth = _rounded(sides)
    return replace(seed, center=_rounded(center), width=width, height=height, depth=depth)


def busy() -> bool:
    """Whether the gizmo has the mouse, or would have it at a click."""
    if im_guizmo.is_using_any():
        return True
    return bool(im_guizmo.is_over() and imgui.is_window_hovered() and not imgui.is_mouse_down(1))


def dragging() -> bool:
    """Whether the gizmo is being dragged."""
    return bool(im_guizmo.is_using_any())


def _flat(matrix: NDArray) -> list[float]:
    return [float(value) for value in matrix.T.ravel()]


def _rounded(values: NDArray) -> tuple[float, float, float]:
    """To the centimetre: a file is read by people too."""
    x, y, z = (round(float(value), 2) for value in values)
    return x, y, z
