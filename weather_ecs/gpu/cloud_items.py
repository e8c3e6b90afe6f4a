"""How each cloud of a view is drawn: soft or not, as a picture, two of them, or a lit one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu.cloud_scene import CloudScene
from weather_ecs.gpu.cloud_sequence import FADING, LIT, LIT_FADING, PICTURE, Items
from weather_ecs.gpu.flash import lit_by_flashes

SOFT_HEIGHT = 400.0  # m over the ground, below which billboards are soft where they meet the scene
SOFT_REACH = 1500.0  # m, as far as they are
INSIDE = 0.5  # of a cloud's reach: what is nearer to its middle is behind its picture


def meeting(view: ViewData, scene: CloudScene, which: NDArray[np.intp]) -> NDArray[np.bool_]:
    """(m,) which of the clouds may meet the scene."""
    near = scene.away[which] - scene.reach[which] < SOFT_REACH
    height = scene.center[which, 1] + scene.base[which] + view.position[1]
    low = height < view.frame.profile.ground + SOFT_HEIGHT * view.frame.cloud_look.softness
    meet: NDArray[np.bool_] = near & low
    return meet


def picture_kinds(
    view: ViewData, scene: CloudScene, which: NDArray[np.intp], quads: NDArray[np.float32]
) -> NDArray[np.intp]:
    """(m,) how the pictures of the clouds are drawn; quads: their rows."""
    kinds = np.where(quads[:, 1, 3] < 1.0, FADING, PICTURE)
    if not view.frame.cloud_look.plain:
        lit = lit_by_flashes(view, scene.center[which], scene.reach[which])
        lit |= quads[:, 2, 3] > 0.0
        kinds[lit] = np.where(kinds[lit] == FADING, LIT_FADING, LIT)
    return kinds


def items_of(
    bills: NDArray[np.bool_],
    soft: NDArray[np.intp],
    stretches: tuple[NDArray[np.intp], NDArray[np.intp]],
    pictures: NDArray[np.bool_],
    kinds: NDArray[np.intp],
) -> Items:
    """All that is drawn, (n,): `bills` with billboards, `pictures` not; the rest is nothing yet.

    soft, stretches: kinds of the first and where they are in the stream; kinds: of the others.
    """
    found = np.full(len(bills), PICTURE)
    begins, ends = np.zeros_like(found), np.zeros_like(found)
    found[bills], (begins[bills], ends[bills]) = soft, stretches
    count = np.arange(len(kinds))
    found[pictures], begins[pictures], ends[pictures] = kinds, count, count + 1
    return Items(found, begins, ends)
