"""The ripples of all water surfaces: which of them move for a view, and their drawing."""

from __future__ import annotations

import math
from typing import NamedTuple

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import FrameData, RippleData, ViewData
from weather_ecs.gpu.rain_pass import RainPass
from weather_ecs.gpu.ripple_grid import RippleGrid
from weather_ecs.gpu.ripple_map import RippleMap
from weather_ecs.gpu.ripple_sheet import RippleSheet
from weather_ecs.gpu.ripple_solver import RippleSolver, frame_of
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.physics import ripple_place
from weather_ecs.physics.ripple_place import GridPlace

BUDGET = 4  # full grids' worth of cells that are computed for one view, the nearest waters first
AWAKE = 1.25  # reaches from the observer, as far as the rain's impacts are known
_KEPT_DRAWS = 600  # a grid that no view has used for so many draws is given back


class _Waters(NamedTuple):
    """The surfaces of a frame as arrays."""

    surfaces: tuple[RippleData, ...]
    centers: NDArray[np.float64]
    sizes: NDArray[np.float64]
    headings: NDArray[np.float64]
    corners: NDArray[np.float64]


class RipplePass:
    """Make it before the rain's first update. One `RippleGrid` for each surface and observer.

    A surface that is out of view or too far for rings to be seen sleeps: it takes no GPU work.
    """

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader, rain: RainPass) -> None:
        self._ctx = ctx
        self._solver = RippleSolver(ctx, shaders, rain)
        self._sheet = RippleSheet(ctx, shaders)
        self._level = ctx.texture((1, 1), 4, b"\x7f" * 4)
        self._grids: dict[tuple[int, int], RippleGrid] = {}
        self._maps: dict[tuple[int, int], RippleMap] = {}
        self._waters = _as_arrays(())
        self._seen: list[RippleData] = []
        self._sheltered = False
        self._draws = 0

    def grids(self, observer: int = 0) -> dict[int, RippleGrid]:
        """An observer's grids by surface; for tests and statistics."""
        return {key: grid for (who, key), grid in self._grids.items() if who == observer}

    def map(self, observer: int, surface: RippleData) -> RippleMap:
        """A surface as the observer's last draw left it; level where it sleeps."""
        known = self._maps.get((observer, surface.key))
        if known is not None:
            return known
        return RippleMap(self._level, frame_of(surface), (1.0, 1.0, 0.0, 0.0), (0.0,) * 4)

    def update(self, view: ViewData, sheltered: bool, most_cells: int) -> None:
        """Let the waters that matter to a view move on to its time.

        `sheltered`: as for the rain; without it nothing is hit. `most_cells` on a side of a grid.
        Changes framebuffer, viewport and capabilities: the caller restores them.
        """
        self._draws += 1
        frame = view.frame
        if frame.ripples is not self._waters.surfaces:
            self._waters = _as_arrays(frame.ripples)
            living = {surface.key for surface in frame.ripples}
            self._drop([key for key in self._grids if key[1] not in living])
        waters = self._waters
        self._seen, self._sheltered = [], sheltered
        if waters.surfaces:
            shown = ripple_place.in_view(waters.corners, view.projection @ view.view)
            away = ripple_place.distances(
                waters.centers, waters.sizes, waters.headings, view.position
            )
            left = BUDGET * most_cells * most_cells
            for k in np.argsort(away, kind="stable").tolist():
                surface = waters.surfaces[k]
                self._maps.pop((view.key, surface.key), None)
                if not shown[k]:
                    continue
                self._seen.append(surface)
                place = ripple_place.grid_of(surface.size, surface.cell, most_cells)
                left -= place.cells[0] * place.cells[1]
                if left >= 0 and away[k] <= AWAKE * frame.look.reach:
                    rains = sheltered and _rains_on(frame, surface)
                    self._advance(view, surface, place, rains)
        self._forget()

    def _advance(self, view: ViewData, surface: RippleData, place: GridPlace, rains: bool) -> None:
        key = (view.key, surface.key)
        grid = self._grids.get(key)
        if grid is not None and grid.cells != place.cells:
            grid.release()
            grid = None
        if grid is None:
            grid = self._grids[key] = RippleGrid(self._ctx, place.cells)
        grid.last_used = self._draws
        middle, half = ripple_place.window_of(
            place, surface.cell, surface.size, surface.ellipse, _focus(view, surface, place)
        )
        window = (*middle, *half)
        self._maps[key] = self._solver.advance(view, grid, surface, place, window, rains)

    @property
    def draws(self) -> bool:
        """Whether the last update has left anything to draw."""
        return any(surface.draw for surface in self._seen)

    def draw(self, view: ViewData, depth: moderngl.Texture) -> None:
        """Draw the surfaces that nobody else draws, far to near; `depth` is the scene's.

        Blending, the depth test and no depth writes are the caller's.
        """
        self._sheet.begin(view.frame, depth, self._sheltered)
        for surface in reversed(self._seen):
            if surface.draw:
                self._sheet.draw(surface, self.map(view.key, surface))

    def _forget(self) -> None:
        if self._draws % 60:
            return
        oldest = self._draws - _KEPT_DRAWS
        self._drop([key for key, grid in self._grids.items() if grid.last_used < oldest])

    def forget(self, observer: int) -> None:
        """Give back what belongs to an observer who is gone."""
        self._drop([key for key in self._grids if key[0] == observer])
        self._solver.forget(observer)

    def _drop(self, keys: list[tuple[int, int]]) -> None:
        for key in keys:
            self._maps.pop(key, None)
            self._grids.pop(key).release()

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self._drop(list(self._grids))
        self._level.release()
        self._sheet.release()
        self._solver.release()


def _as_arrays(surfaces: tuple[RippleData, ...]) -> _Waters:
    centers = np.array([s.center for s in surfaces], np.float64).reshape(-1, 3)
    sizes = np.array([s.size for s in surfaces], np.float64).reshape(-1, 2)
    headings = np.array([s.heading for s in surfaces], np.float64)
    corners = ripple_place.corners_of(centers, sizes, headings)
    return _Waters(surfaces, centers, sizes, headings, corners)


def _focus(view: ViewData, surface: RippleData, place: GridPlace) -> tuple[float, float]:
    """Where the middle of the window should be: a little in front of the observer, own axes."""
    ahead = 0.35 * max(place.cells) * surface.cell
    fx, fz = -float(view.view[2, 0]), -float(view.view[2, 2])
    size = max(math.hypot(fx, fz), 1e-6)
    x, _, z = view.position
    return ripple_place.to_own(
        surface.center, surface.heading, x + ahead * fx / size, z + ahead * fz / size
    )


def _rains_on(frame: FrameData, surface: RippleData) -> bool:
    """Whether a rain area may reach a surface."""
    areas = frame.areas[frame.areas["rain_rate"] > 0.0]
    x, _, z = surface.center
    reach = areas["radii"][:, 0] + 0.5 * math.hypot(*surface.size)
    away = np.hypot(areas["center"][:, 0] - x, areas["center"][:, 1] - z)
    return bool((away < reach).any())
