"""Rain gauges on the GPU: counts the drops over every gauge, and reads the counts some frames late.

One texel holds what one container says of one gauge. A gauge's opening is small against the drawn
drops' distances, so drops are counted in a catch about it, wide enough for a steady reading, and
related to the part of the catch that is open to the rain; what the area's edge takes off at the
gauge itself comes in as a factor, and what covers the opening as its exposure. A drop stands for
`weight` real ones of the water that drops carry on average (`physics.gauge.landing_water`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import moderngl
import numpy as np

from weather_ecs.frame import SNOW, ContainerData, GaugeData, GaugeReading, ViewData
from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.gpu.rain_pass import SHELTER_UNIT, RainPass, drops_used
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics.footprint import fall_speed_of
from weather_ecs.physics.front import SETTLED, landing_share
from weather_ecs.physics.gauge import catch_middle, catch_radius, landing_water
from weather_ecs.physics.rain_field import RainField
from weather_ecs.physics.snowfall import snowfall

MAX_GAUGES = 32  # counted; the others read the areas' rates
MAX_ROWS = 32  # containers
STRONG = 0.5  # of the mean fall, a deviation of the air above which drops are not counted
CATCH, OWN = 128, 32  # points; also in gauge_area.vert
RING = 4  # frames between counting and reading; half of it until the copy is asked for

GAUGE = UniformBlock(
    "Gauge",
    ("gauge_place", "vec4", MAX_GAUGES),  # m, of the opening's middle; radius of it
    ("gauge_catch", "vec4", MAX_GAUGES),  # m, x and z of the catch's middle; radius of it
    # Share of the area's rain at the opening; mean water of its drops over the area's.
    ("gauge_share", "vec4", MAX_GAUGES),
    ("gauge_scale", "vec2"),  # of a texel in clip space
    ("gauge_row", "float"),
    ("gauge_water", "float"),  # mm3, of a drop that lands, on average
    ("gauge_turn", "float"),  # rad, another one every time
)
AREA = ProgramKey(vertex="gauge_area.vert", fragment="gauge.frag")
DROPS = ProgramKey(vertex="gauge_drops.vert", fragment="gauge.frag")


@dataclass(slots=True)
class _Counted:
    """One frame's counts on their way back."""

    target: moderngl.Framebuffer
    texture: moderngl.Texture
    copy: moderngl.Buffer
    gauges: tuple[GaugeData, ...] = ()
    # Key of the area, and what is the same for what falls of all kinds in one half of a container.
    rows: tuple[tuple[int, int], ...] = ()
    catches: tuple[tuple[float, ...], ...] = ()  # m2, by row and gauge
    time: float = 0.0
    seconds: float = 0.0


class GaugePass:
    """Counts for the gauges of a view; makes nothing on the GPU before the first gauge."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader, rain: RainPass) -> None:
        self._ctx = ctx
        self._shaders = shaders
        self._rain = rain
        self._ring: list[_Counted] = []
        self._count = 0
        self._readings: list[GaugeReading] = []

    def take(self) -> list[GaugeReading]:
        """What has come back since the last call."""
        readings, self._readings = self._readings, []
        return readings

    def update(self, view: ViewData, sheltered: bool) -> None:
        """Count the drops as they are now; after the rain's update, and with its blocks bound.

        Changes framebuffer, blending and the block RainDraw: the caller restores.
        """
        gauges = view.frame.gauges[:MAX_GAUGES]
        if not gauges or not view.containers or view.dt <= 0.0:
            return
        if not self._ring:
            self._make()
        slot = self._ring[self._count % RING]
        self._collect(slot)
        older = self._ring[(self._count - RING // 2) % RING]
        if older.gauges:
            older.texture.read_into(older.copy)
        containers = view.containers[:MAX_ROWS]
        slot.gauges, slot.time, slot.seconds = gauges, view.frame.time, view.dt
        slot.rows = tuple([(c.area, c.key & ~2) for c in containers])
        slot.target.use()
        slot.target.clear()
        self._ctx.enable_only(moderngl.BLEND)
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE
        catches = [
            self._draw(row, container, gauges, view, sheltered)
            for row, container in enumerate(containers)
        ]
        self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        slot.catches = tuple(catches)
        self._count += 1

    def _make(self) -> None:
        self._block = BlockBuffer(self._ctx, GAUGE)
        self._areas, self._names = [], []
        for defines in ((), ("SHELTER",)):
            area = self._shaders.program(replace(AREA, defines=defines))
            drops = self._shaders.program(replace(DROPS, defines=defines))
            for program in (area, drops):
                if "shelter_map" in program:
                    program["shelter_map"] = SHELTER_UNIT
            self._areas.append(self._ctx.vertex_array(area, []))
            self._names.append(" ".join(("gauge", *defines)))
            self._rain.add_reader(self._names[-1], drops)
        for _ in range(RING):
            texture = self._ctx.texture((MAX_GAUGES, MAX_ROWS), 4, dtype="f4")
            texture.filter = moderngl.NEAREST, moderngl.NEAREST
            target = self._ctx.framebuffer([texture])
            copy = self._ctx.buffer(reserve=MAX_GAUGES * MAX_ROWS * 16)
            self._ring.append(_Counted(target, texture, copy))

    def _draw(
        self,
        row: int,
        container: ContainerData,
        gauges: tuple[GaugeData, ...],
        view: ViewData,
        sheltered: bool,
    ) -> tuple[float, ...]:
        radii = self._fill(row, container, gauges, view)
        self._rain.fill_container(container, view)
        self._areas[sheltered].render(moderngl.POINTS, CATCH + OWN, instances=len(gauges))
        drops = self._rain.sets(view.key).get(container.key)
        if drops is not None and drops.alive:
            count = min(drops_used(container, drops), drops.alive)
            array = drops.array(self._names[sheltered])
            array.render(moderngl.POINTS, count, instances=len(gauges))
        return tuple([math.pi * radius * radius for radius in radii])

    def _fill(
        self,
        row: int,
        container: ContainerData,
        gauges: tuple[GaugeData, ...],
        view: ViewData,
    ) -> list[float]:
        """Upload the block; returns the radii of the catches."""
        areas = view.frame.areas
        area = areas[areas["key"] == container.area]
        field = RainField(area)
        full, (water, speed) = float(area["rain_rate"][0]), _landing(container, view)
        # Strong eddies sweep down what falls faster than in still air, and the number of the drawn
        # drops, which stays, says too much: no catch then.
        counted = view.frame.profile.turbulence <= STRONG * speed
        radii = []
        for k, gauge in enumerate(gauges):
            share = field.rate(*gauge.position) / full
            heavier = _water_share(container, gauge.position[1])
            x, z, radius = _catch(gauge, container, speed)
            radius *= counted
            radii.append(radius)
            self._block["gauge_place"][k] = (*gauge.position, math.sqrt(gauge.area / math.pi))
            self._block["gauge_catch"][k] = (x, z, radius, 0.0)
            self._block["gauge_share"][k] = (share, heavier, 0.0, 0.0)
        data = self._block.data
        data["gauge_scale"] = (2.0 / MAX_GAUGES, 2.0 / MAX_ROWS)
        data["gauge_row"] = row
        data["gauge_water"] = water
        data["gauge_turn"] = 0.7548777 * self._count % 1.0 * 2.0 * math.pi
        self._block.upload()
        self._block.bind()
        return radii

    def _collect(self, slot: _Counted) -> None:
        """What the slot has counted, a ring's length ago."""
        if not slot.gauges:
            return
        raw = np.frombuffer(slot.copy.read(), np.float32).reshape(MAX_ROWS, MAX_GAUGES, 4)
        sums = raw[: len(slot.rows), : len(slot.gauges)].astype(float)
        for k, gauge in enumerate(slot.gauges):
            exposure = min(float(sums[0, k, 2]), 1.0)
            areas = _joined(slot.rows, sums[:, k, :2].tolist(), [c[k] for c in slot.catches])
            reading = GaugeReading(gauge.key, slot.time, slot.seconds, exposure, areas)
            self._readings.append(reading)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for slot in self._ring:
            for thing in (slot.copy, slot.target, slot.texture):
                thing.release()
        if self._ring:
            for array in self._areas:
                array.release()
            self._block.release()
        self._ring.clear()


def _landing(container: ContainerData, view: ViewData) -> tuple[float, float]:
    """mm3 that what lands carries on average; its mean fall, m/s."""
    if container.kind == SNOW:
        air, model = view.frame.air, view.frame.flakes.model
        fall = snowfall(container.rate, 1.0 - air.snow_share, air.temperature, model)
        return fall.water, fall.speed
    return landing_water(container.rate), fall_speed_of(container.rate)


def _joined(
    rows: tuple[tuple[int, int], ...], sums: list[list[float]], catches: list[float]
) -> tuple[tuple[int, float, float, float], ...]:
    """What rain and snow have brought, together for each half of an area's container.

    Each kind has a catch of its own; what one caught counts for as much of the other's as was
    watched. Where one kind could not be watched, nothing was.
    """
    found: dict[int, tuple[int, float, float, float]] = {}
    for (area, half), (caught, watched), catch in zip(rows, sums, catches, strict=True):
        if half not in found:
            found[half] = (area, caught, watched, catch)
            continue
        _, before, seen, first = found[half]
        if watched > 0.0:
            found[half] = (area, before + caught * seen / watched, seen, first)
        else:
            found[half] = (area, 0.0, 0.0, first)
    return tuple(found.values())


def _water_share(container: ContainerData, y: float) -> float:
    """Mean water of the drops that land at a height over that of all the area's."""
    if container.dry == SETTLED or container.kind == SNOW:
        return 1.0
    fall = container.area_shape[3] - y
    number, water = landing_share(fall, container.dry, container.rate)
    return water / number if number > 1e-6 else 1.0


def _catch(
    gauge: GaugeData, container: ContainerData, fall_speed: float
) -> tuple[float, float, float]:
    """Middle (x, z) and radius of a gauge's catch among a container's drops, m."""
    (cx, cz, c, s), (forward, lateral, _, height) = container.axis, container.shape
    x, z = gauge.position[0] - cx, gauge.position[2] - cz
    q = (x * c - z * s) / forward, (x * s + z * c) / lateral
    opening, reach = math.sqrt(gauge.area / math.pi), (forward, lateral)
    radius = catch_radius(
        opening, gauge.window, math.hypot(*q), reach, height, container.count, fall_speed
    )
    u, w = catch_middle(*q, radius / min(reach))
    u, w = u * forward, w * lateral
    return cx + u * c + w * s, cz - u * s + w * c, radius
