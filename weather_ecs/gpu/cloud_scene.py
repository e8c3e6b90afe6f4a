"""The clouds of one view as arrays: what is in the picture, how large, in which order."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu.cloud_store import CloudStore
from weather_ecs.gpu.view_block import encode
from weather_ecs.physics import cloud_light, cloud_view
from weather_ecs.physics.cloud_light import Surround
from weather_ecs.physics.cloud_shade import packed
from weather_ecs.physics.sky_map import shown

REACH = 200_000.0  # m, beyond which no cloud is drawn
LOST = 0.90, 0.99  # share of haze from which a cloud fades, and at which it is gone
UNDER = 0.08  # of half its height, as far as a cloud shows below its base; see cloud.vert
Floats = NDArray[np.float64]


@dataclass(slots=True)
class CloudScene:
    """All arrays are aligned with `FrameData.clouds`; places are relative to the camera, m."""

    clouds: NDArray  # CLOUD_DTYPE
    shapes: NDArray[np.intp]
    center: Floats  # (n, 3)
    half: Floats  # (n, 3) of the box round the billboards, scaled
    base: Floats  # (n,) scaled, from the centre
    thick: Floats  # (n,) 1/m, of way inside, over the light's penetration
    reach: Floats  # (n,) of the sphere that holds what is drawn
    away: Floats  # (n,)
    visible: NDArray[np.bool_]
    order: NDArray[np.intp]  # of those that are visible, back to front
    # (n,) half of the greater of width and twice the height in the picture, as far as they show.
    pixels: Floats
    unit: float  # pixels that a unit of width at unit depth takes
    parallel: bool  # the camera's rays are: no impostors then

    @property
    def lowest(self) -> Floats:
        """(n,) m over the camera, that anything shows of each."""
        low: Floats = self.center[:, 1] + self.base - UNDER * self.half[:, 1]
        return low

    def hide(self) -> None:
        """None of the clouds is seen after all."""
        self.visible[:] = False
        self.order = self.order[:0]


def surround_of(view: ViewData) -> Surround:
    """The light of a view's sky."""
    sky = view.frame.sky
    return cloud_light.surround(
        sky.cloud_direction, sky.sun_color, sky.zenith_color, sky.horizon_color, sky.ground_color,
        sky.high_colors or None,
    )  # fmt: skip


def scene_of(view: ViewData, store: CloudStore, height: int) -> CloudScene:
    """The clouds of `view` in a picture `height` pixels high; the store is up to date."""
    clouds = view.frame.clouds
    shapes = clouds["shape"].astype(np.intp)
    scale = clouds["scale"].astype(np.float64)
    center = clouds["position"] - np.array(view.position)
    half = store.half[shapes] * scale[:, None]
    lean = np.hypot(clouds["shear"][:, 0], clouds["shear"][:, 1]).astype(np.float64)
    half[:, (0, 2)] += (lean * half[:, 1])[:, None]
    reach = store.reach[shapes] * scale * (1.0 + lean)
    seen = cloud_view.frustum(view.view, view.projection, REACH)
    visible = cloud_view.visible(seen, center, reach)
    visible &= (clouds["growth"] > 0.0) & (clouds["opacity"] > 0.002)
    found = np.flatnonzero(visible)
    order = found[cloud_view.draw_order(center[found], half[found, 1])]
    away = np.linalg.norm(center, axis=1)
    wide, high = cloud_view.silhouette(center, half)
    unit = cloud_view.pixels_per_radian(view.projection, height)
    pixels = np.maximum(wide, 2.0 * high) * unit / np.maximum(away, 1.0)
    pixels *= store.detail[shapes]
    parallel = bool(view.projection[3, 3] == 1.0)
    return CloudScene(
        clouds, shapes, center, half, store.base[shapes] * scale,
        store.thick[shapes] / np.maximum(scale, 1e-9),
        reach, away, visible, order, pixels, unit, parallel,
    )  # fmt: skip


def haze_of(view: ViewData, light: Surround, center: Floats) -> NDArray[np.float32]:
    """(n, 4): encoded colour of the air before clouds, and its share."""
    haze = np.zeros((len(center), 4), np.float32)
    if not view.frame.cloud_look.plain:
        sky = view.frame.sky
        color = cloud_light.haze_color(center, sky.horizon_color, sky.zenith_color, light)
        # What is drawn of the sky behind them is bent below 1: they shall vanish in it.
        air = view.frame.atmosphere
        haze[:, :3] = shown(color) if air is not None and air.draw else encode(color)
        extinction = view.frame.fog.extinction
        haze[:, 3] = cloud_light.haze_share(center, view.position[1], extinction)
    return haze


def left_by_haze(share: NDArray[np.float32]) -> NDArray[np.float32]:
    """What is left of the opacity of clouds before which the air has this share of the light.

    Of one that is all haze no outline may show against the sky, whose haze the host has painted.
    """
    t = np.clip((share - LOST[0]) / (LOST[1] - LOST[0]), 0.0, 1.0)
    return np.asarray(1.0 - t * t * (3.0 - 2.0 * t), np.float32)


def rows_of(
    scene: CloudScene, which: NDArray[np.intp], fresh: NDArray, haze: NDArray[np.float32]
) -> NDArray[np.float32]:
    """Rows of the clouds `which`, (m, 6, 4), as shaders/cloud_row.glsl reads them.

    fresh: (m,) share of the newer absorption; haze: (m, 4).
    """
    clouds = scene.clouds[which]
    rows = np.zeros((len(which), 6, 4), np.float32)
    rows[:, 0, :3], rows[:, 0, 3] = scene.center[which], clouds["opacity"]
    rows[:, 1, 0], rows[:, 1, 1] = np.cos(clouds["heading"]), np.sin(clouds["heading"])
    rows[:, 1, 2], rows[:, 1, 3] = clouds["scale"] * clouds["mirror"], packed(clouds["shaded"])
    rows[:, 2, :2] = clouds["shear"]
    rows[:, 2, 2], rows[:, 2, 3] = clouds["growth"], clouds["mode"]
    rows[:, 3, 0], rows[:, 3, 1], rows[:, 3, 2] = clouds["darkness"], clouds["flash"], fresh
    rows[:, 3, 3] = scene.thick[which]
    rows[:, 4, :3], rows[:, 4, 3] = half_sizes(scene, which), scene.base[which]
    rows[:, 5] = haze
    return rows


def half_sizes(scene: CloudScene, which: NDArray[np.intp]) -> Floats:
    """(m, 3) of the ellipsoid that the light reckons with: as wide one way as the other."""
    half = scene.half[which].copy()
    half[:, 0] = half[:, 2] = np.maximum(half[:, 0], half[:, 2])
    return half


def light_numbers(view: ViewData, light: Surround) -> Floats:
    """What all impostors are lit by; a change of 0.02 in one of them is too much."""
    look = view.frame.cloud_look
    colors = np.concatenate([light.sun, light.suns.ravel(), light.above, light.below, light.plain])
    strengths = (look.silver, look.base, look.ambient, float(look.plain))
    return np.concatenate([light.direction, colors, strengths])
