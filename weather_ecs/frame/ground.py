"""What rain meets, as a frame has it: occluders, water, wet ground, gauges."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class OccluderData:
    """Something rain can hit: a mesh with its place, or a callback that draws it."""

    key: int  # stable for the life of the occluder; only ever compared
    transform: NDArray  # (4, 4) float64, mesh to world; a new array whenever it has moved
    dynamic: bool  # drawn at every capture instead of into the cached layer
    vertices: NDArray | None = None  # (n, 3) float32, m; a new array whenever the mesh changes
    indices: NDArray | None = None  # (3 t,) uint32
    draw: Callable[[NDArray], None] | None = None  # called with a view-projection matrix


@dataclass(frozen=True, slots=True)
class RippleData:
    """Water on which rain makes rings; see `components.RippleSurface`."""

    key: int  # stable for the life of the surface; only ever compared
    center: tuple[float, float, float]  # m
    size: tuple[float, float]  # m, along and across the heading
    heading: float  # rad, counter-clockwise seen from above
    ellipse: bool  # only the ellipse inside the rectangle is water
    cell: float  # m
    speed: float  # m/s, of the rings
    damping: int
    amplitude: float  # factor on the height of the waves
    color: tuple[float, float, float]  # linear RGB
    clarity: float  # m
    draw: bool


@dataclass(frozen=True, slots=True)
class HeightmapLook:
    """How the map of what rain hits is made; see `components.CollisionHeightmap`."""

    resolution: float = 1.0  # factor on the texels a side that the quality gives
    extent: float = 1.25  # half of its side over the container's reach


@dataclass(frozen=True, slots=True)
class GaugeData:
    """A level opening that rain falls into; see `components.RainGauge`."""

    key: int  # stable for the life of the gauge; only ever compared
    position: tuple[float, float, float]  # m
    area: float  # m2
    window: float  # s


@dataclass(frozen=True, slots=True)
class GaugeReading:
    """What one gauge has measured in one frame; comes back from the GPU some frames later."""

    key: int  # of the gauge
    time: float  # s, the weather's clock at the frame's end
    seconds: float  # that the frame lasted
    exposure: float  # 0 to 1, share of the opening that rain reaches
    # By area: (key, mm/h times m2 caught, m2 that were watched, m2 that could have been).
    areas: tuple[tuple[int, float, float, float], ...]


@dataclass(frozen=True, slots=True, eq=False)
class WetTileData:
    """Wet cells of one size, in tiles of 8 by 8."""

    cell: float  # m
    places: NDArray  # (n, 2) int64: tile (i, j) begins at (8 i, 8 j) cells, along x and z
    water: NDArray  # (n, 8, 8) float32, mm; rows along z
    since: int  # the tick it is of
    rows: NDArray  # AREA_DTYPE, the areas whose rain has been falling since then
    melt: float = 0.0  # mm/s that have melted since then, of snow


@dataclass(frozen=True, slots=True, eq=False)
class WetnessData:
    """Water on level ground under the open sky: where the GPU's own map begins, and beyond it.

    Or snow there.
    """

    number: int  # another one where the ground is another, as when a snapshot was restored
    ticks: int  # seconds of weather done
    levels: tuple[WetTileData, ...]
