"""The wetness map: against its oracle, as its observer walks; and as a game's shader reads it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tests.boxes import box, placed
from tests.gl_host import Host, read_state
from tests.rain_frames import area, camera, frame, quality
from tests.views import look_from, perspective
from tests.worlds import fresh_world
from weather_ecs import Weather, glsl
from weather_ecs.components import (
    CollisionHeightmap,
    Observer,
    Occluder,
    RainArea,
    RainGauge,
    Wind,
)
from weather_ecs.errors import ContextError
from weather_ecs.frame import AirData, FrameData, OccluderData, SnowLook, ViewData, WetnessData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.heightmap import Heightmap
from weather_ecs.gpu.occluder_meshes import OccluderMeshes
from weather_ecs.gpu.rain_blocks import SHELTER
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.gpu.wetness_far import HALF
from weather_ecs.gpu.wetness_map import WEATHER_WETNESS
from weather_ecs.gpu.wetness_pass import DRY_AFTER, ROUND, WetnessPass
from weather_ecs.physics import wet_map
from weather_ecs.physics.ellipse import edge_factor
from weather_ecs.physics.footprint import fall_speed_over
from weather_ecs.physics.front import SETTLED, water_arrived
from weather_ecs.physics.snow_cover import melt_rate
from weather_ecs.physics.wetness import DRYING, FILM, film_capacity, settle_one
from weather_ecs.systems.rain_view import RainView
from weather_ecs.systems.wet_ground import WetGround

SIZE = 128
Point = tuple[float, float, float]


def hilly() -> tuple[np.ndarray, np.ndarray]:
    """Ground with hills and hollows, every metre a vertex."""
    at = np.arange(-60.0, 61.0)
    x, z = np.meshgrid(at, at)
    y = 0.8 * np.sin(x / 7.0) * np.cos(z / 5.0) - 0.06 * np.cos(x * 1.3) * np.cos(z * 1.3)
    n = len(at)
    i, j = np.meshgrid(np.arange(n - 1), np.arange(n - 1))
    a = (j * n + i).ravel()
    quads = np.stack([a, a + n, a + 1, a + 1, a + n, a + n + 1], 1)
    vertices = np.stack([x, y, z], -1).reshape(-1, 3).astype(np.float32)
    return vertices, quads.reshape(-1).astype(np.uint32)


GROUND = OccluderData(0, np.eye(4), False, *hilly())
LEVEL = box(0, placed((0, -1, 0), (200, 1, 200)))
ROOF = box(1, placed((5, 4, 3), (4, 0.1, 3), 0.4, 0.3))


class Maps:
    """A wetness pass and what it needs, driven as a renderer does."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.guard, self.shaders = StateGuard(ctx), ShaderLoader(ctx)
        self.meshes = OccluderMeshes(ctx, self.shaders)
        self.heightmap = Heightmap(ctx, self.guard, self.meshes, SIZE)
        self.block = BlockBuffer(ctx, SHELTER)
        self.wetness = WetnessPass(ctx, GL(), self.shaders)
        self.view_of = RainView()

    def view(self, frame: FrameData, position: Point) -> ViewData:
        return self.view_of.view(frame, camera(position), 0, quality())

    def update(self, frame: FrameData, position: Point = (0.0, 1.7, 0.0)) -> None:
        view = self.view(frame, position)
        speed = fall_speed_over(frame.areas["rain_rate"])
        with self.guard:
            if frame.occluders:
                self.heightmap.capture(frame.occluders, position, 15.0, frame.wind, speed)
                self.heightmap.fill(self.block)
                self.block.upload()
                self.block.bind()
            self.wetness.update(view, self.heightmap if frame.occluders else None)

    @property
    def seen(self) -> Any:
        return self.wetness._observed[0]

    def read(self) -> np.ndarray:
        """(rows along z, columns along x, mm of water, height and mm of snow)."""
        texture = self.seen.textures[self.seen.current]
        raw = np.frombuffer(texture.read(), np.float32).reshape(*texture.size, 4)
        return raw[..., :3].copy()

    def at(self, x: float, y: float, z: float, what: int = 0) -> float:
        """mm of water at the texel over a point; with 2, of snow."""
        place = self.seen.place
        u = (x + y * place.slope[0] - place.center[0]) / place.texel + 0.5 * place.size
        w = (z + y * place.slope[1] - place.center[1]) / place.texel + 0.5 * place.size
        return float(self.read()[int(w), int(u), what])

    def expected(self, frame: FrameData, before: np.ndarray | None, old: Any, ages: Any) -> Any:
        """What the oracle makes of the map before."""
        depths = [
            np.frombuffer(texture.read(), np.float32).reshape(SIZE, SIZE)
            for texture in (self.heightmap.static_texture, self.heightmap.texture)
        ]
        footprint, place = self.heightmap.footprint, self.seen.place
        assert footprint is not None
        found = wet_map.surface(place, footprint, *depths)
        points = found.position.reshape(-1, 3)
        rate = np.zeros(len(points))
        for key, center, radii, heading, full, edge, ceiling in frame.areas.tolist():
            share = edge_factor(points[:, [0, 2]], center, radii, heading, edge)
            share *= water_arrived(ceiling - points[:, 1], frame.fronts.get(key, SETTLED), full)
            rate += np.where(points[:, 1] < ceiling, full * share, 0.0)
        far = self.far(points[:, [0, 2]]).reshape(place.size, place.size, 2)
        water, seconds = wet_map.carried(found, far, before, old, ages)
        rate = rate.reshape(place.size, place.size)
        air = frame.air
        melt = float(melt_rate(air.wet_bulb))
        collects = air.snow_share * frame.flakes.settling
        return found, wet_map.step(found, water, seconds, rate, air.snow_share, melt, collects)

    def far(self, points: np.ndarray) -> np.ndarray:
        texture = self.seen.far.texture
        n = texture.width
        table = np.frombuffer(texture.read(), np.float32).reshape(n, n, 2)
        at = (points - self.seen.far.middle) / (2.0 * HALF) * n + 0.5 * n - 0.5
        low = np.floor(at).astype(int)
        part = at - low
        total = np.zeros((len(points), 2))
        for i in (0, 1):
            for j in (0, 1):
                x, z = np.clip(low + (i, j), 0, n - 1).T
                weight = np.abs(1 - i - part[:, 0]) * np.abs(1 - j - part[:, 1])
                total += weight[:, None] * table[z, x]
        return total

    def release(self) -> None:
        for thing in (self.wetness, self.block, self.heightmap, self.meshes, self.shaders):
            thing.release()
        self.guard.release()


@pytest.fixture
def maps(ctx: moderngl.Context) -> Iterator[Maps]:
    made = Maps(ctx)
    yield made
    made.release()


def dry_ground(time: float, number: int = 1) -> WetnessData:
    """Ground that has been dry up to a time."""
    return WetnessData(number, int(time), ())


def scene(time: float, *occluders: OccluderData, **rest: Any) -> FrameData:
    """Rain of 40 mm/h over half of what there is, on ground that was dry."""
    ground = rest.pop("wetness", dry_ground(time))
    rows = rest.pop("rows", [area(0, (8.0, 0.0), (25.0, 20.0), 40.0, 0.3, 6.0)])
    return frame(*rows, time=time, occluders=occluders, wetness=ground, **rest)


# Against the oracle


RAIN = AirData()
SLEET = AirData(2.0, 0.8, 1.0, 0.4)
SNOW = AirData(-3.0, 0.9, -3.5, 1.0)


@pytest.mark.parametrize(
    ("wind", "air", "fronts"),
    [
        ((0.0, 0.0, 0.0), RAIN, {}),
        ((5.0, 0.0, -3.0), RAIN, {}),
        ((0.0, 0.0, 0.0), SNOW, {}),
        ((2.0, 0.0, 0.0), SLEET, {}),
        ((0.0, 0.0, 0.0), RAIN, {0: (46.0, 1e9, 0.0, 0.0)}),
        ((5.0, 0.0, -3.0), RAIN, {0: (-1.0, 70.0, 0.0, 0.0)}),
    ],
)
def test_the_map_is_what_its_oracle_says(
    maps: Maps, wind: Point, air: AirData, fronts: Any
) -> None:
    before, old, snowed = None, None, False
    ages = np.zeros(wet_map.BANDS)
    cart = placed((-4, 1.5, 0), (1.5, 0.5, 1.5))
    # A start, some bands, all of them, a walk, a turn of the wind, a stay.
    moments = [(10.0, 0, wind), (10.1, 0, wind), (11.2, 0, wind), (11.3, 4.2, wind)]
    moments += [(11.4, 4.2, (-4.0, 0.0, 2.0)), (12.9, 4.2, (-4.0, 0.0, 2.0))]
    for k, (time, x, now) in enumerate(moments):
        things = GROUND, ROOF, box(2, cart, True)
        flakes = SnowLook(settling=3.0 if wind[0] else 1.0)
        data = scene(time, *things, wind=now, air=air, fronts=fronts, flakes=flakes)
        # In the end all of it thaws.
        if k == len(moments) - 1 and air.snow_share == 1.0:
            data = replace(data, air=AirData(6.0, 0.8, 5.0, 0.0))
        if k:
            before, old = maps.read(), maps.seen.place
            ages = time - np.array(maps.seen.times)
        bands = maps.seen.band if k else 0
        maps.update(data, (x, 1.7, 0.0))
        found, expected = maps.expected(data, before, old, ages)
        got, place = maps.read(), maps.seen.place
        np.testing.assert_allclose(got[..., 1], found.position[..., 1], atol=1e-3)
        fresh = np.ones(place.size, bool)
        if place == old:
            due = -(-place.size // place.rows)
            due = int(np.ceil(due * min((time - moments[k - 1][0]) / ROUND, 1.0) - 1e-9))
            turns = (bands + np.arange(due)) % -(-place.size // place.rows)
            fresh = np.isin(np.arange(place.size) // place.rows, turns)
            np.testing.assert_array_equal(got[~fresh], before[~fresh])
        away = np.abs(got[..., [0, 2]] - expected)[fresh]
        # A texel whose point falls on the line between two of the map before may take either.
        assert np.mean(away > 1e-4 + 1e-3 * expected[fresh]) < 0.01, k
        assert np.median(away) < 1e-5
        snowed = snowed or bool(got[..., 2].max() > 0.001)
    assert expected[..., 0].max() > (0.005 if air.snow_share == 1.0 else 0.01)
    assert snowed == (air.snow_share > 0.0)
    assert (expected[found.known] == 0.0).any()


def test_hollows_gather_and_slopes_shed() -> None:
    footprint = wet_map.Footprint((0.0, 0.0), 16.0, (0.0, 0.0), -80.0, 120.0)
    place = wet_map.place_over(footprint, 64)
    pit = np.full((64, 64), 0.5)
    pit[30:34, 30:34] += 0.03 / 200.0
    found = wet_map.surface(place, footprint, pit, pit)
    middle = found.gathers[14:16, 14:16]
    assert (middle > 5.0).all() and found.gathers[3, 3] == 1.0
    assert found.capacity[15, 15] == pytest.approx(FILM + 30.0, abs=0.1)
    # A plane that rises by 0.8 a metre sheds, and is no hollow anywhere.
    close = wet_map.Footprint((0.0, 0.0), 4.0, (0.0, 0.0), -80.0, 120.0)
    plane = np.repeat(0.5 + 0.8 * 0.125 / 200.0 * np.arange(64.0)[:, None], 64, axis=1)
    steep = wet_map.surface(wet_map.place_over(close, 64), close, plane, plane)
    up = 1.0 / np.hypot(1.0, 0.8)
    held = steep.capacity[8:-8, 8:-8]
    np.testing.assert_allclose(held, film_capacity(up), rtol=0.05)
    np.testing.assert_allclose(steep.facing[8:-8, 8:-8], up, rtol=0.02)
    assert (steep.gathers[8:-8, 8:-8] == 1.0).all()
    assert (found.exposed == 1.0).all()
    assert (wet_map.surface(place, footprint, pit, pit - 1.0 / 200.0).exposed == 0.0).all()
    rail = np.full((64, 64), 0.5)
    rail[:, 20] -= 1.0 / 200.0
    railed = wet_map.surface(place, footprint, rail, rail)
    assert np.ptp(railed.position[..., 1]) < 1e-9  # the ground shows beside the rail
    assert sorted(set(railed.exposed.ravel())) == [0.5, 1.0]
    assert not wet_map.surface(place, footprint, np.ones((64, 64)), pit).known.any()


# What it does


def walk(
    maps: Maps, seconds: float, data: Callable[[float], FrameData], step: float = 0.25,
    start: float = 0.0, x: Callable[[float], float] = lambda t: 0.0,
) -> None:  # fmt: skip
    for k in range(round(seconds / step) + 1):
        time = start + k * step
        maps.update(data(time), (x(time), 1.7, 0.0))


def test_level_ground_in_the_open_is_as_wet_as_samples_say(maps: Maps) -> None:
    for rate in (2.0, 25.0):
        rows = [area(0, (0, 0), (80, 80), rate)]
        number = int(rate)

        def data(time: float, rows: Any = rows, number: int = number) -> FrameData:
            return scene(time, LEVEL, rows=rows, wetness=dry_ground(time, number))

        walk(maps, 60.0, data)
        expected = settle_one(0.0, rate / 3600.0, FILM, 60.0)
        for point in ((3.0, 0.0, 4.0), (-12.0, 0.0, 9.0)):
            assert maps.at(*point) == pytest.approx(expected, rel=0.05)


def test_dry_under_a_roof_wet_upon_it_and_dry_where_it_does_not_rain(maps: Maps) -> None:
    roof = box(1, placed((5, 4, 3), (4, 0.1, 3)))
    walk(maps, 30.0, lambda t: scene(t, LEVEL, roof))
    read, place = maps.read(), maps.seen.place
    expected = settle_one(0.0, 40.0 / 3600.0, FILM, 30.0)
    assert maps.at(5.0, 4.1, 3.0) == pytest.approx(expected, rel=0.1)  # the roof's top
    assert maps.at(5.0, 0.0, 8.5) == pytest.approx(expected, rel=0.1)
    assert maps.at(-17.5, 0.0, 0.0) == 0.0
    assert read.shape == (place.size, place.size, 3)


@pytest.mark.parametrize("wind", [(0.0, 0.0, 0.0), (3.0, 0.0, -2.0)])
def test_lamps_and_poles_leave_no_dry_stain(maps: Maps, wind: Point) -> None:
    pole = box(5, placed((5, 1.5, 0), (0.1, 1.5, 0.1)))
    head = box(6, placed((5, 3.2, 0), (0.3, 0.2, 0.3)))
    walk(maps, 20.0, lambda t: scene(t, LEVEL, pole, head, wind=wind))
    open_ground = maps.at(3.0, 0.0, 6.0)
    assert open_ground > 0.1
    # Where the head's shadow lies, and along the upper half of the pole's.
    slope = np.array([wind[0], wind[2]]) / fall_speed_over(np.array([40.0]))
    for high, aside in ((3.2, 0.0), (3.2, 0.3), (2.6, 0.0), (2.0, 0.0)):
        x, z = np.array([5.0 + aside, 0.0]) + high * slope
        assert maps.at(x, 0.0, z) > 0.7 * open_ground, (high, aside)


def test_a_wall_keeps_the_rain_off_behind_it(maps: Maps) -> None:
    wall = box(7, placed((5, 1.5, 0), (0.1, 1.5, 6.0)))
    walk(maps, 20.0, lambda t: scene(t, LEVEL, wall, wind=(8.0, 0.0, 0.0)))
    # Rain meets the wall there and not the ground.
    assert maps.at(7.0, 0.0, 0.0, what=1) > 1.0
    assert abs(maps.at(11.0, 0.0, 0.0, what=1)) < 0.1 < maps.at(11.0, 0.0, 0.0)


def test_snow_lies_on_roof_and_ground_melts_and_wets_them(maps: Maps) -> None:
    roof = box(1, placed((5, 4, 3), (4, 0.1, 3)))
    walk(maps, 30.0, lambda t: scene(t, LEVEL, roof, air=SNOW))
    fallen = 40.0 / 3600.0 * 30.0
    for point in ((5.0, 4.1, 3.0), (5.0, 0.0, 8.5)):
        assert maps.at(*point, 2) == pytest.approx(fallen, rel=0.1)
        assert maps.at(*point) == 0.0
    read = maps.read()
    under = np.abs(read[..., 1]) < 0.5
    assert read[under][:, 2].max() == pytest.approx(fallen, rel=0.1)
    dry = [area(0, (8.0, 0.0), (25.0, 20.0), 0.0)]
    thaw = AirData(8.0, 0.9, 7.0, 0.0)
    rate = float(melt_rate(thaw.wet_bulb))
    walk(maps, 10.0, lambda t: scene(t, LEVEL, roof, rows=dry, air=thaw), start=30.0)
    assert maps.at(5.0, 4.1, 3.0, 2) == pytest.approx(fallen - 10.0 * rate, rel=0.15)
    assert maps.at(5.0, 4.1, 3.0) == pytest.approx(10.0 * rate, rel=0.15)


def test_what_moves_keeps_the_rain_off_and_leaves_the_ground_as_it_was(maps: Maps) -> None:
    def data(time: float) -> FrameData:
        x = 0.0 if 20.0 < time <= 40.0 else 60.0
        return scene(time, LEVEL, box(2, placed((x, 1.5, 0), (3, 0.5, 3)), True))

    walk(maps, 20.0, data)
    before = maps.at(0.0, 0.0, 0.0)
    walk(maps, 19.0, data, start=21.0)
    under = maps.at(0.0, 0.0, 0.0)
    assert under == pytest.approx(before * np.exp(-19.5 / DRYING), rel=0.03)
    assert maps.at(5.0, 0.0, 0.0) > 1.8 * before
    walk(maps, 19.0, data, start=41.0)
    assert maps.at(0.0, 0.0, 0.0) > 1.7 * before


def test_what_was_wet_stays_wet_at_its_place_as_the_observer_walks(maps: Maps) -> None:
    walk(maps, 40.0, lambda t: scene(t, LEVEL))
    place, before = maps.seen.place, maps.read()
    dry = [area(0, (8.0, 0.0), (25.0, 20.0), 0.0)]
    steps = 0
    for k in range(1, 60):
        maps.update(scene(40.0 + 0.02 * k, LEVEL, rows=dry), (0.25 * k, 1.7, 0.0))
        steps += maps.seen.place != place
    assert steps > 0
    moved = maps.seen.place
    shift = round((moved.center[0] - place.center[0]) / place.texel)
    assert shift == pytest.approx((moved.center[0] - place.center[0]) / place.texel)
    after = maps.read()
    # Nothing has been smeared: every texel is where it was, but for what has dried.
    share = np.exp(-1.18 / DRYING)
    np.testing.assert_allclose(
        after[:, :-shift, 0], before[:, shift:, 0] * share, rtol=0.01, atol=1e-5
    )


def test_ground_that_comes_into_the_map_begins_as_the_weather_has_it(maps: Maps) -> None:
    ground = WetGround()
    rows = [area(0, (0, 0), (150, 150), 25.0)]
    for _ in range(40):
        ground.tick(frame(*rows).areas)
    here = scene(40.0, LEVEL, rows=rows, wetness=ground.data())
    maps.update(here)
    expected = settle_one(0.0, 25.0 / 3600.0, FILM, 40.0)
    assert maps.at(2.0, 0.0, 3.0) == pytest.approx(expected, rel=0.02)
    maps.update(here, (90.0, 1.7, 0.0))
    assert maps.at(100.0, 0.0, 3.0) == pytest.approx(expected, rel=0.02)


def test_another_ground_a_long_pause_and_a_jump_back_begin_anew(maps: Maps) -> None:
    walk(maps, 30.0, lambda t: scene(t, LEVEL))
    maps.update(scene(30.1, LEVEL))
    assert maps.at(5.0, 0.0, 3.0) > 0.2
    maps.update(scene(30.2, LEVEL, wetness=dry_ground(30.2, 2)))
    assert maps.at(5.0, 0.0, 3.0) < 0.01
    for later in (500.0, 3.0):
        maps.update(scene(later, LEVEL))
        assert maps.at(5.0, 0.0, 3.0) < 0.01
        walk(maps, 20.0, lambda t: scene(t, LEVEL), start=later)
        assert maps.at(5.0, 0.0, 3.0) > 0.15


def test_it_is_needed_where_it_is_wet_or_rains(maps: Maps) -> None:
    wetness, here = maps.wetness, (0.0, 1.7, 0.0)
    dry = scene(0.0, LEVEL, rows=[area(0, (0, 0), (25, 20), 0.0)])
    assert not wetness.needs_map(maps.view(dry, here))
    assert not wetness.needs_update(maps.view(dry, here))
    wet = scene(0.0, LEVEL)
    assert wetness.needs_map(maps.view(wet, here))
    off = maps.view(wet, (200.0, 1.7, 0.0))
    assert not wetness.needs_map(off) and wetness.needs_update(off)
    nowhere = maps.view(wet, (3000.0, 1.7, 0.0))
    assert not wetness.needs_map(nowhere) and not wetness.needs_update(nowhere)
    maps.update(wet)
    later = scene(DRY_AFTER - 1.0, LEVEL, rows=[area(0, (0, 0), (25, 20), 0.0)])
    assert wetness.needs_map(maps.view(later, here))
    later = scene(DRY_AFTER + 1.0, LEVEL, rows=[area(0, (0, 0), (25, 20), 0.0)])
    assert not wetness.needs_map(maps.view(later, here))


def test_without_occluders_there_is_the_far_field(maps: Maps) -> None:
    ground = WetGround()
    rows = [area(0, (0, 0), (150, 150), 25.0)]
    for _ in range(30):
        ground.tick(frame(*rows).areas)
    maps.update(scene(30.0, rows=rows, wetness=ground.data()))
    assert maps.seen.place is None
    points = np.array([(0.0, 0.0), (100.0, 20.0)])
    expected = settle_one(0.0, 25.0 / 3600.0, FILM, 30.0)
    np.testing.assert_allclose(maps.far(points)[:, 0], expected, rtol=0.02)


def test_a_forgotten_observer_leaves_nothing(ctx: moderngl.Context, maps: Maps) -> None:
    maps.update(scene(0.0, LEVEL))
    maps.wetness.forget(0)
    maps.wetness.forget(0)
    assert not maps.wetness._observed


# As a game reads it


def test_the_block_in_the_public_include_is_the_declared_one() -> None:
    text = glsl("wetness.glsl")
    (found,) = re.findall(r"layout\(std140\) uniform WeatherWetness\s*\{(.*?)\};", text, re.S)
    members = [line.strip() for line in found.strip().splitlines()]
    assert members == [f"{field.glsl};" for field in WEATHER_WETNESS.fields]


VERTEX = "in vec3 in_at; in vec3 in_normal; in float in_relief; out vec4 got;"
BODY = """
    got = vec4(weather_wetness(in_at, in_normal), weather_puddle(in_at, in_normal, in_relief),
               weather_open_wetness(in_at), weather_damp(weather_water(in_at)));
"""


class Reader:
    """A game's own program that includes wetness.glsl."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        main = "void " + "main() {" + BODY + "}"  # the import rules look for GLSL in Python
        text = "#" + "version 330\n" + glsl("wetness.glsl") + VERTEX + main
        self.program = ctx.program(vertex_shader=text, varyings=["got"])

    def __call__(
        self, weather: Weather, points: Any, normal: Point = (0, 1, 0), relief: float = 2.0,
        observer: Observer | None = None,
    ) -> np.ndarray:  # fmt: skip
        rows = np.array([(*p, *normal, relief) for p in points], np.float32)
        source, out = self.ctx.buffer(rows.tobytes()), self.ctx.buffer(reserve=16 * len(rows))
        names = ("in_at", "in_normal", "in_relief")
        array = self.ctx.vertex_array(self.program, [(source, "3f 3f 1f", *names)])
        weather.wetness(observer=observer).use(self.program)
        array.transform(out, moderngl.POINTS)
        got = np.frombuffer(out.read(), np.float32).reshape(-1, 4)
        for thing in (array, out, source):
            thing.release()
        return got


@pytest.fixture
def reader(ctx: moderngl.Context) -> Iterator[Reader]:
    target = ctx.simple_framebuffer((8, 8))
    target.use()
    made = Reader(ctx)
    yield made
    made.program.release()
    target.color_attachments[0].release()  # type: ignore[union-attr]
    target.depth_attachment.release()  # type: ignore[union-attr]
    target.release()


def ground(y: float = 0.0, half: float = 90.0) -> Occluder:
    at = [(x, y, z) for x in (-half, half) for z in (-half, half)]
    return Occluder(at, [0, 1, 2, 1, 3, 2])


@pytest.mark.usefixtures("world")
@pytest.mark.parametrize("speed", [0.0, 6.0])
def test_a_games_shader_reads_what_samples_say(
    ctx: moderngl.Context, reader: Reader, speed: float
) -> None:
    with Weather(context=ctx, quality="low") as weather:
        points = [(4.0, 0.0, 3.0), (-6.0, 0.0, -8.0), (20.0, 3.1, 0.0), (150.0, 0.0, 0.0)]
        assert (reader(weather, points) == 0.0).all()  # before the first draw
        esper.create_entity(RainArea((0, 0), (70, 70), 25.0))
        esper.create_entity(Wind((1, 0), speed))
        esper.create_entity(ground())
        cover = Occluder([(x, 3, z) for x in (17, 23) for z in (-3, 3)], [0, 1, 2, 1, 3, 2])
        esper.create_entity(cover)
        for _ in range(60 * 5):
            esper.process(0.2)
            weather.draw(look_from((0, 1.7, 0), 0.0), perspective())
        got = reader(weather, points)
        for k in (0, 1):
            wet = weather.sample(points[k]).wetness
            assert got[k, 0] == pytest.approx(wet, rel=0.05)
            assert got[k, 2] == pytest.approx(wet, rel=0.05)
            assert got[k, 1] == pytest.approx(np.clip(6.0 * wet - 2.0, 0, 1), abs=0.15)
            assert got[k, 3] == pytest.approx(1.0 - np.exp(-wet / 0.12), abs=0.02)
        assert got[2, 0] == pytest.approx(weather.sample(points[0]).wetness, rel=0.05)
        assert (got[3] == 0.0).all()
        shift = 3.0 * speed / fall_speed_over(np.array([25.0]))
        below = [(20.0 + shift, 0.0, 0.0), (20.0 + shift + 1.5, 1.0, 1.0)]
        assert all(weather.sample(p).sheltered for p in below)
        assert (reader(weather, below)[:, :2] < 1e-3).all()
        walls = reader(weather, points[:1], normal=(1, 0, 0))[0, 0]
        roofs = reader(weather, points[:1], normal=(0, -1, 0))[0, 0]
        assert roofs == 0.0
        assert walls < 0.5 * got[0, 0]
        assert reader(weather, points[:1], normal=(0.7, 0.7, 0.1))[0, 1] == 0.0
        assert reader(weather, points[:1], relief=9.0)[0, 1] == 0.0


@pytest.mark.usefixtures("world")
def test_it_dries_when_the_rain_is_over(ctx: moderngl.Context, reader: Reader) -> None:
    with Weather(context=ctx, quality="low") as weather:
        rain = RainArea((0, 0), (70, 70), 60.0, onset=0.0)
        esper.create_entity(rain)
        esper.create_entity(Wind((1, 0), 4.0))
        esper.create_entity(ground())

        def run(seconds: float) -> float:
            for _ in range(round(seconds / 0.5)):
                esper.process(0.5)
                weather.draw(look_from((0, 1.7, 0), 0.0), perspective())
            return float(reader(weather, [(4.0, 0.0, 3.0)])[0, 0])

        wet = run(40.0)
        place = weather._renderer._wetness._observed[0].place
        rain.rain_rate = 0.0
        assert run(90.0) == pytest.approx(wet * np.exp(-90.0 / DRYING), rel=0.05)
        assert weather._renderer._wetness._observed[0].place == place


@pytest.mark.usefixtures("world")
def test_every_observer_has_a_map_of_its_own(ctx: moderngl.Context, reader: Reader) -> None:
    with Weather(context=ctx, quality="low") as weather:
        esper.create_entity(RainArea((0, 0), (70, 70), 25.0))
        esper.create_entity(ground())
        left, right = Observer((0, 1.7, 0)), Observer((60, 1.7, 0))
        for _ in range(20):
            esper.process(0.25)
            for it in (left, right):
                weather.draw(look_from(it.position, 0.0), perspective(), observer=it)
        assert weather.wetness(observer=left) is weather.wetness(observer=left)
        assert weather.wetness(observer=left) is not weather.wetness(observer=right)
        for it in (left, right):
            at = (it.position[0] + 3.0, 0.0, 1.0)
            expected = weather.sample(at).wetness
            assert reader(weather, [at], observer=it)[0, 0] == pytest.approx(expected, rel=0.2)


@pytest.mark.usefixtures("world")
def test_a_host_that_has_the_map_bound_may_close_the_weather(
    ctx: moderngl.Context, reader: Reader, gl: GL
) -> None:
    weather = Weather(context=ctx, quality="low")
    reader(weather, [(0.0, 0.0, 0.0)])
    weather.wetness().use(reader.program)
    weather.close()
    assert gl.error() == 0


@pytest.mark.usefixtures("world")
def test_a_server_has_no_map() -> None:
    with Weather() as weather, pytest.raises(ContextError):
        weather.wetness()


@pytest.mark.usefixtures("world")
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_host_in_any_state_gets_the_same_map_and_its_state_back(
    ctx: moderngl.Context, gl: GL, keep: Callable[[Any], Any], seed: int
) -> None:
    found, outer = [], StateGuard(ctx, gl)
    host = Host(ctx, gl, keep, seed)
    for scrambled in (False, True):
        esper.clear_database()
        with outer, Weather(context=ctx, quality="low", seed=seed) as weather:
            esper.create_entity(RainArea((0, 0), (70, 70), 25.0))
            esper.create_entity(ground())
            gauge = RainGauge((5, 0.5, 0), window=5.0)
            esper.create_entity(gauge)
            host.framebuffers[0].use()
            for k in range(12):
                esper.process(0.25)
                if scrambled:
                    host.scramble()
                    before = read_state(gl)
                weather.draw(look_from((0.8 * k, 1.7, 0), 0.0), perspective())
                if scrambled:
                    assert read_state(gl) == before
            outer.reset()
            gl.glDisable(0x8DB9)  # sRGB, which the guard leaves to the host
            seen = weather._renderer._wetness._observed[0]
            found.append((seen.textures[seen.current].read(), gauge.rate))
    outer.release()
    while gl.error() == 0x0506:  # the host has had the window's framebuffer bound; there is none
        pass
    assert found[0] == found[1]


@pytest.mark.usefixtures("world")
def test_drawing_gauges_and_maps_leave_no_trace_in_a_snapshot(ctx: moderngl.Context) -> None:
    def run(draws: bool) -> bytes:
        target = ctx.simple_framebuffer((32, 18)) if draws else None
        if target is not None:
            target.use()
        with fresh_world(), Weather(context=ctx if draws else None, seed=3) as weather:
            esper.create_entity(RainArea((0, 0), (70, 40), 25.0, velocity=(3, 0)))
            esper.create_entity(RainArea((90, 0), (40, 40), 5.0, drift=0.5))
            esper.create_entity(Wind((0, 1), 6.0))
            esper.create_entity(ground())
            esper.create_entity(RainGauge((4, 0, 0)))
            for _ in range(30):
                esper.process(0.37)
                if draws:
                    weather.draw(look_from((0, 1.7, 0), 0.0), perspective())
            data = weather.snapshot()
        if target is not None:
            for thing in (*target.color_attachments, target.depth_attachment, target):
                thing.release()  # type: ignore[union-attr]
        return data

    assert run(True) == run(False)


@pytest.mark.usefixtures("world")
@pytest.mark.parametrize(("resolution", "extent"), [(0.125, 1.05), (0.3, 8.0), (4.0, 2.0)])
def test_maps_of_any_size(
    ctx: moderngl.Context, reader: Reader, resolution: float, extent: float
) -> None:
    with Weather(context=ctx, quality="low") as weather:
        limits = CollisionHeightmap()
        esper.create_entity(limits)
        esper.create_entity(RainArea((0, 0), (400, 400), 60.0))
        esper.create_entity(ground(half=500.0))
        for k in range(60):
            if k == 20:
                limits.resolution, limits.extent = resolution, extent
            esper.process(0.5)
            weather.draw(look_from((0, 1.7, 0), 0.0), perspective())
        heightmap = weather._renderer.heightmap()
        assert heightmap.size == pytest.approx(256 * resolution, abs=4)
        assert heightmap.footprint.half == extent * 30.0
        assert weather._renderer._wetness._observed[0].place.size == heightmap.size // 2 - 2
        points = [(4.0, 0.0, 3.0), (-0.8 * extent * 30.0, 0.0, 20.0)]
        expected = weather.sample(points[0]).wetness
        assert reader(weather, points)[:, 0] == pytest.approx([expected] * 2, rel=0.05)
