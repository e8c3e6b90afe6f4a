"""`FrameData`: the only value that crosses from the ECS to the GPU.

Plain arrays, made once a frame by the extract system, read-only, with no entity ids and no
OpenGL names in it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

AREA_DTYPE = np.dtype(
    [
        ("key", "i8"),  # stable for the life of the area; only ever compared
        ("center", "f8", 2),  # (x, z), m
        ("radii", "f8", 2),  # (a, b), m, a >= b > 0
        ("heading", "f8"),  # rad, counter-clockwise seen from above
        ("rain_rate", "f8"),  # mm/h
        ("soft_edge", "f8"),  # m, inside the ellipse
        ("ceiling", "f8"),  # m, world height
    ]
)

LIGHT_DTYPE = np.dtype(
    [
        ("position", "f8", 3),  # m
        ("color", "f8", 3),  # linear RGB times strength
        ("reach", "f8"),  # m, the distance at which it has faded to nothing
    ]
)


RAIN, SNOW = 0, 1  # kinds of containers
Spells = tuple[float, float, float, float]  # from, to, from, to, s ago
NO_FRONTS: Mapping[int, Spells] = MappingProxyType({})


def empty(dtype: np.dtype) -> NDArray:
    array = np.zeros(0, dtype)
    array.setflags(write=False)
    return array


@dataclass(frozen=True, slots=True)
class SkyLight:
    """Light of sun, sky and ground, linear RGB."""

    sun_direction: tuple[float, float, float] = (0.35, 0.8, 0.48)  # unit, towards the sun
    sun_color: tuple[float, float, float] = (1.0, 0.95, 0.86)
    zenith_color: tuple[float, float, float] = (0.36, 0.47, 0.62)
    horizon_color: tuple[float, float, float] = (0.68, 0.73, 0.78)
    ground_color: tuple[float, float, float] = (0.20, 0.20, 0.17)


@dataclass(frozen=True, slots=True)
class DropLook:
    """Looks of the drops of a container; see `components.RainContainer`."""

    reach: float = 30.0  # m, semi-axis of the near container
    height: float = 20.0  # m, of the near container
    margin: float = 0.75  # m, observer's movement that leaves the container where it is
    size_maximum: float = 8.0  # Eq. 3's factor at the container's rim
    exposure: float = 1.0 / 24.0  # s, length of the path a streak shows
    width: float = 4.0  # factor on the drop's diameter, look only
    density: float = 3.7  # factor on how much the drops cover: 1 is what nature shows
    brightness: float = 1.6  # factor on the light of the sky that drops show
    opacity: float = 0.6  # greatest opacity of one streak
    veil: float = 2.5  # factor on the veil's extinction, look only
    fastest: float = 8.0  # m/s, of the observer's own speed that slants the streaks at most


@dataclass(frozen=True, slots=True)
class SnowLook:
    """Looks of falling snow; see `components.SnowFlakes`."""

    model: str = "physical"  # or "liu_tong"
    size: float = 4.0  # factor on the flake's diameter, look only
    size_maximum: float = 7.0  # Eq. 3's factor at the container's rim
    exposure: float = 1.0 / 90.0  # s, over which a flake in motion is drawn out
    flutter: float = 1.0  # factor on how far flakes sway
    density: float = 5.0  # factor on how much the flakes cover: 1 is what nature shows
    brightness: float = 1.7  # factor on the light of sky and ground that flakes show
    opacity: float = 0.9  # greatest opacity of one flake
    aperture: float = 0.004  # m, of the eye or lens that sees near flakes out of focus
    veil: float = 1.0  # factor on the veil's extinction, look only
    settling: float = 1.0  # factor on how fast snow collects


@dataclass(frozen=True, slots=True)
class SplashLook:
    """Looks of the splashes; see `components.SplashEmitter`."""

    size: float = 26.0  # factor on the radius to which the drop's water spreads
    largest: float = 0.12  # m, radius that no crown exceeds
    duration: float = 0.3  # s, from the hit until the crown has sunk
    opacity: float = 0.85  # greatest of one splash
    share: float = 0.005  # of the real drops whose splash is shown full-grown
    droplets: float = 4.0  # mean number that one splash throws, 5 at most
    droplet_size: float = 4.5  # mm, as they are drawn
    droplet_speed: float = 0.28  # of the drop's own speed at the hit
    spread: float = 0.7  # rad, greatest angle between a droplet's way and the normal
    drift: float = 0.3  # share of the wind that there is so close to the surface
    detail: float = 9.0  # m, distance up to which droplets and films are drawn


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


@dataclass(frozen=True, slots=True)
class AirData:
    """The air at the ground; see `components.Air` and `physics.phase`."""

    temperature: float = 15.0  # degrees Celsius
    humidity: float = 0.8  # 0 to 1, relative
    wet_bulb: float = 12.73  # degrees Celsius
    snow_share: float = 0.0  # of the water that falls, 0 rain to 1 snow; between: sleet


@dataclass(frozen=True, slots=True)
class FogData:
    """What the air takes from the view; see `components.Fog`."""

    extinction: float = 3.912 / 50_000.0  # 1/m, of the air and its fog; rain and snow are more
    color: tuple[float, float, float] = (0.64, 0.70, 0.77)  # linear RGB
    depth: float = 250.0  # m of it above the eye, before the sky
    draw: bool = False  # over the whole picture, for games whose shaders know no fog


@dataclass(frozen=True, slots=True, eq=False)
class AtmosphereData:
    """What the sky is drawn from; see `physics.sky_map`. Light is linear RGB, as it is shown."""

    sun_direction: tuple[float, float, float]  # unit, to where it is seen
    moon_direction: tuple[float, float, float]
    star_axes: NDArray  # (3, 3): world = axes @ equatorial
    sun_air: NDArray  # `physics.daylight.ClearSky` of the sun
    sun_haze: NDArray
    moon_air: NDArray  # and of the moon
    moon_haze: NDArray
    sun_scale: NDArray  # (3,), factor on the sun's clear sky
    moon_scale: NDArray
    overcast_light: NDArray  # (3,), at the zenith; a third of it at the horizon
    night_light: NDArray  # (3,), at the zenith
    ground_light: NDArray  # (3,)
    shift: float  # 0 to 1, of the colours towards those of the night
    sun_disc: NDArray  # (3,)
    moon_disc: NDArray  # (3,)
    faintest: float  # magnitude of the faintest star that is seen
    stars: float  # factor on their light
    disc: float  # factor on the width of sun and moon
    halo: float  # 0 to 1
    rainbow: float  # factor
    draw: bool


@dataclass(frozen=True, slots=True)
class WindProfile:
    """How the wind varies in space; `FrameData.wind` is that at the reference height, now."""

    reference: float = 10.0  # m above the ground
    exponent: float = 0.0  # of the power law; 0: the same at every height
    ground: float = 0.0  # m, world height
    turbulence: float = 0.0  # m/s, standard deviation of one component
    scale: float = 6.0  # m, of the largest eddies


CLOUD_DTYPE = np.dtype(
    [
        ("key", "i8"),  # stable for the life of the cloud; only ever compared
        ("shape", "i8"),  # index into FrameData.cloud_shapes
        ("position", "f8", 3),  # m, of the shape's centre
        ("velocity", "f8", 3),  # m/s
        ("scale", "f4"),  # factor on the shape
        ("mirror", "f4"),  # 1 or -1: factor on the shape's x
        ("heading", "f4"),  # rad, the shape turned about +y
        ("shear", "f4", 2),  # (x, z), m of lean per m above the centre
        ("growth", "f4"),  # 0 gone to 1 whole
        ("mode", "f4"),  # of dissolving: 0 from the rim inwards, 1 from the inside out
        ("opacity", "f4"),  # 0 to 1
        ("darkness", "f4"),  # 0 fair to 1: of the base, by how deep the cloud is and its rain
        ("flash", "f4"),  # light from inside, 0 but while lightning is in it
    ]
)


@dataclass(frozen=True, slots=True, eq=False)
class CloudShapeData:
    """One cloud that a model gave, about its centre; many clouds may stand in the sky with it."""

    key: int  # stable for the life of the shape; only ever compared
    centers: NDArray  # (s, 3) float32, m, of the seeds' boxes
    sizes: NDArray  # (s, 3) float32, m, whole widths
    absorbed: NDArray  # (s,) float32, 0 to 1, of each seed for `light`; a new array when computed
    light: tuple[float, float, float]  # unit, towards the light that `absorbed` is for
    billboards: NDArray  # BILLBOARD_DTYPE, (n,)
    radius: float  # m, of the sphere round the centre that holds every seed
    penetration: float  # m, that light goes inside before all of it is absorbed; may be inf


BILLBOARD_DTYPE = np.dtype(
    [
        ("position", "f4", 3),  # m, from the cloud's centre
        ("size", "f4", 2),  # m, width and height
        ("turn", "f4"),  # rad, in the plane of the picture
        ("image", "i4"),  # of the array of cloud images
        ("seed", "i4"),  # index of the seed it stands in
        ("order", "f4"),  # 0 to 1: when it comes and goes while the cloud grows or dissolves
        ("opacity", "f4"),  # 0 to 1
    ]
)


@dataclass(frozen=True, slots=True)
class CloudLook:
    """Looks of the clouds; see `components.CloudShading`."""

    plain: bool = False  # the dissertation's own light and nothing else
    rays: bool = False  # show the absorption rays
    silver: float = 1.0  # strength of the lining towards the sun
    base: float = 1.0  # darkness of the bases
    ambient: float = 1.0  # factor on the light of sky and ground
    softness: float = 1.0  # factor on the depth over which a billboard fades at what it meets
    shadows: bool = True


STRIKE_DTYPE = np.dtype(
    [
        ("number", "i8"),  # of the strike; only ever compared
        ("word", "i8"),  # that its shape follows from; see `physics.lightning_bolt`
        ("origin", "f8", 3),  # m
        ("target", "f8", 3),  # m
        ("place", "f8", 3),  # m, where its light comes from for what is below the clouds
        ("cloud_place", "f8", 3),  # m, and for the clouds
        ("age", "f8"),  # s
        ("light", "f8"),  # of it now, times the look's colour; 1: of a day, nearby
        ("leader", "f8"),  # 0 to 1: how far it has come
        ("ground", "?"),  # it comes down
        ("again", "?"),  # a later stroke: the branches are dark
    ]
)


@dataclass(frozen=True, slots=True)
class LightningLook:
    """Looks of lightning; see `components.Lightning`."""

    color: tuple[float, float, float] = (0.80, 0.88, 1.0)  # linear RGB
    width: float = 2.2  # m that the channel seems wide
    glow: float = 1.0  # factor on the air's glow round it
    branches: float = 1.0  # factor on their number


@dataclass(frozen=True, slots=True)
class FrameData:
    """One frame's weather, world axes, SI units unless a field says otherwise."""

    time: float = 0.0  # s, the weather's clock, remainder included
    step: int = 0  # fixed steps done
    areas: NDArray = field(default_factory=lambda: empty(AREA_DTYPE))
    lights: NDArray = field(default_factory=lambda: empty(LIGHT_DTYPE))
    wind: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m/s
    sky: SkyLight = field(default_factory=SkyLight)
    look: DropLook = field(default_factory=DropLook)
    occluders: tuple[OccluderData, ...] = ()
    splash: SplashLook | None = None  # None: no splashes
    ripples: tuple[RippleData, ...] = ()
    wetness: WetnessData | None = None
    snow_ground: WetnessData | None = None  # the same of snow that lies, mm of water
    heightmap: HeightmapLook = field(default_factory=HeightmapLook)
    gauges: tuple[GaugeData, ...] = ()
    air: AirData = field(default_factory=AirData)
    fog: FogData = field(default_factory=FogData)
    profile: WindProfile = field(default_factory=WindProfile)
    clouds: NDArray = field(default_factory=lambda: empty(CLOUD_DTYPE))
    cloud_shapes: tuple[CloudShapeData, ...] = ()
    cloud_look: CloudLook = field(default_factory=CloudLook)
    # Areas whose rain has begun or ended of late, by key: spells without, s; see `physics.front`.
    fronts: Mapping[int, Spells] = field(default_factory=lambda: NO_FRONTS)
    flakes: SnowLook = field(default_factory=SnowLook)
    atmosphere: AtmosphereData | None = None  # None where there is none, or nobody draws
    strikes: NDArray = field(default_factory=lambda: empty(STRIKE_DTYPE))
    lightning: LightningLook = field(default_factory=LightningLook)


@dataclass(frozen=True, slots=True)
class ContainerData:
    """A placed container and the drops or flakes it holds; see `physics.container`, `shaders/`."""

    key: int  # stable for an area as one observer sees it; only ever compared
    axis: tuple[float, float, float, float]  # centre x, centre z, cos heading, sin heading
    shape: tuple[float, float, float, float]  # forward, lateral reach, bottom, height, m
    area_axis: tuple[float, float, float, float]
    area_shape: tuple[float, float, float, float]  # a, b, soft edge, ceiling, m
    # Of the diameters: slope, 1 - exp(-5.5 slope), 0, 0; of flakes as in `physics.snow.SnowLaw`.
    law: tuple[float, float, float, float]
    load: float  # real drops that one drop stands for, over d / weight_shape(d)
    count: float  # drops in use
    size_scale: float  # 1 near, more for far rain
    births: NDArray  # (n, 4) float32, n >= count: original position, own reach, size quantile
    dry: Spells = (0.0, 0.0, 0.0, 0.0)  # fall times of the drops that are missing
    kind: int = 0  # RAIN or SNOW
    rate: float = 0.0  # mm/h of water, of this kind where the area's is full
    cover: float = 1.0  # share of its disc that a drop or flake hides

    @property
    def area(self) -> int:
        """Key of the area."""
        return self.key >> 2

    @property
    def word(self) -> int:
        """What its chances are made of: each kind and half has its own."""
        return 2 * self.area + (self.key & 1) + 0x51F15E * self.kind


@dataclass(frozen=True, slots=True)
class VeilData:
    """The rain of one area beyond what its drops show."""

    axis: tuple[float, float, float, float]
    shape: tuple[float, float, float]  # a, b, the level of f inside which the rate is full
    span: tuple[float, float]  # bottom, top, m
    extinction: float  # 1/m
    shown: float  # m, the distance at which the drops' share of it has fallen to 0
    dry: Spells = (0.0, 0.0, 0.0, 0.0)  # fall times of the drops that are missing
    slope: float = 2.0  # 1/mm, of the diameters
    snow: float = 0.0  # share of the extinction that is snow's


@dataclass(frozen=True, slots=True)
class ViewData:
    """One frame's weather for one camera."""

    frame: FrameData
    key: int  # of the observer; only ever compared
    view: NDArray  # (4, 4) float64
    projection: NDArray  # (4, 4) float64
    position: tuple[float, float, float]
    velocity: tuple[float, float, float]  # m/s, of the observer
    dt: float  # s, weather time since this observer's last view
    containers: tuple[ContainerData, ...]
    veils: tuple[VeilData, ...]
    # m: how far the air at the reference height has gone along x and z; its turbulence over time.
    air_run: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class GaugeReading:
    """What one gauge has measured in one frame; comes back from the GPU some frames later."""

    key: int  # of the gauge
    time: float  # s, the weather's clock at the frame's end
    seconds: float  # that the frame lasted
    exposure: float  # 0 to 1, share of the opening that rain reaches
    # By area: (key, mm/h times m2 caught, m2 that were watched, m2 that could have been).
    areas: tuple[tuple[int, float, float, float], ...]
