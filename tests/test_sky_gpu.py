"""The sky as it is drawn: against its oracle, by measured angles, and as a guest."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import esper
import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tests.gl_host import Host, read_state
from tests.views import look_from, perspective
from weather_ecs import Weather, glsl
from weather_ecs.components import Atmosphere, Fog, Observer, RainArea, RainContainer
from weather_ecs.errors import ContextError, InvalidValueError
from weather_ecs.gpu import sky_ring
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.sky_ring import thinned
from weather_ecs.physics import bows, sky_map
from weather_ecs.presets import WholeWeather

SIZE = (480, 270)
TIMES = ("12:00", "19:30", "20:15", "23:00")


class Stage:
    """A host's framebuffer and a weather with an atmosphere that stands still."""

    def __init__(self, ctx: moderngl.Context, **fields: object) -> None:
        self.ctx = ctx
        self.color, self.depth = ctx.texture(SIZE, 4), ctx.depth_texture(SIZE)
        self.target = ctx.framebuffer([self.color], self.depth)
        self.weather = Weather(context=ctx, quality="low")
        self.air = Atmosphere(**{"speed": 0.0, "draw": True, **fields})  # type: ignore[arg-type]
        self.entity = esper.create_entity(self.air)

    def picture(
        self, heading: float, pitch: float, field: float = 60.0, depth: float = 1.0
    ) -> NDArray[np.float64]:
        """(height, width, 3), 0 to 1, lowest row first."""
        esper.process(0.0)
        self.target.use()
        self.target.clear(0.25, 0.5, 0.75, 1.0, depth=depth)
        self.camera = look_from((0, 2, 0), heading, pitch), perspective(field)
        self.weather.draw(*self.camera)
        assert self.ctx.error == "GL_NO_ERROR"
        raw = np.frombuffer(self.target.read(components=3), np.uint8)
        return raw.reshape(SIZE[1], SIZE[0], 3) / 255.0

    def directions(self) -> NDArray[np.float64]:
        """Through the middles of the pixels, unit, world axes."""
        view, p = self.camera
        x = (np.arange(SIZE[0]) + 0.5) / SIZE[0] * 2.0 - 1.0
        y = (np.arange(SIZE[1]) + 0.5) / SIZE[1] * 2.0 - 1.0
        ex, ey = np.meshgrid(x / p[0, 0], y / p[1, 1])
        rays = np.stack([ex, ey, -np.ones_like(ex)], -1) @ view[:3, :3]
        return np.asarray(rays / np.linalg.norm(rays, axis=-1, keepdims=True))

    def toward(self, direction: tuple[float, ...], field: float) -> NDArray[np.float64]:
        """A picture with a direction in its middle."""
        x, y, z = direction
        return self.picture(math.atan2(-z, x), math.asin(y), field)

    def release(self) -> None:
        self.weather.close()
        for thing in (self.target, self.color, self.depth):
            thing.release()


@pytest.fixture(autouse=True)
def world() -> Iterator[None]:
    """Every test has a world of its own."""
    esper.switch_world("sky")
    yield
    esper.switch_world("default")
    esper.delete_world("sky")


@pytest.fixture
def stage(ctx: moderngl.Context) -> Iterator[Stage]:
    made = Stage(ctx)
    yield made
    made.release()


def profile(picture: NDArray, apart: NDArray, angles: NDArray) -> NDArray:
    """Mean light on rings round a direction, (n, 3)."""
    step = angles[1] - angles[0]
    rings = [picture[np.abs(apart - angle) < 0.5 * step] for angle in angles]
    return np.array([ring.mean(0) for ring in rings])


def test_map_places_and_directions_are_each_others_inverse() -> None:
    rng = np.random.default_rng(3)
    ways = rng.normal(size=(400, 3))
    ways[:, 1] = np.abs(ways[:, 1])
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    places = sky_map.map_place(ways)
    assert np.abs(places).max() <= 1.0 + 1e-9
    assert np.allclose(sky_map.map_direction(places), ways, atol=1e-6)


@pytest.mark.parametrize(("hour", "haze"), [*((hour, 0.0) for hour in TIMES), ("17:00", 0.6)])
def test_the_drawn_sky_is_the_oracles(stage: Stage, hour: str, haze: float) -> None:
    """Map, grid and encoding against NumPy, away from the discs; without haze and with."""
    stage.air.time = f"2025-06-21T{hour}:00Z"
    if haze:
        stage.weather.change_to(WholeWeather("hazy", 0.0, haze=haze))
        whole = stage.weather.whole
        assert whole is not None
        esper.component_for_entity(whole.entities["fog"], Fog).depth = 0.0
    stage.air.stars = 0.0
    picture = stage.picture(0.4, 0.5, 70.0)
    ways = stage.directions()
    data = stage.weather._frame().atmosphere
    assert data is not None
    wanted = np.clip(sky_map.shown(sky_map.with_ground(data, ways)), 0.0, 1.0)
    far = ways[..., 1] > 0.02
    for source in (data.sun_direction, data.moon_direction):
        far &= ways @ np.array(source) < math.cos(math.radians(14.0))
    assert far.mean() > 0.4
    error = np.abs(picture - wanted)[far]
    assert error.mean() < 0.004
    assert np.quantile(error, 0.99) < 0.02
    assert wanted[far].std() > 0.02  # there is something to compare


def test_games_read_the_same_sky(stage: Stage) -> None:
    stage.air.time = "2025-06-21T17:00:00Z"
    stage.picture(0.0, 0.2)
    ctx, sky = stage.ctx, stage.weather.sky()
    assert sky is stage.weather.sky(observer=Observer())
    body = "void main() { v_light = weather_sky(in_way); }"
    head = "#version 330\nin vec3 in_way;\nout vec3 v_light;\n"
    program = ctx.program(vertex_shader=head + glsl("sky.glsl") + body, varyings=("v_light",))
    rng = np.random.default_rng(5)
    ways = rng.normal(size=(300, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    rows, out = ctx.buffer(ways.astype("f4").tobytes()), ctx.buffer(reserve=300 * 12)
    array = ctx.vertex_array(program, [(rows, "3f4", "in_way")])
    stage.target.use()
    sky.use(program)
    array.transform(out, moderngl.POINTS)
    got = np.frombuffer(out.read(), "f4").reshape(-1, 3)
    data = stage.weather._frame().atmosphere
    assert data is not None
    wanted = sky_map.with_ground(data, ways)
    clear = ways @ np.array(data.sun_direction) < math.cos(math.radians(6.0))
    assert np.allclose(got[clear], wanted[clear], rtol=0.06, atol=0.01)
    for thing in (array, rows, out, program):
        thing.release()


def test_halo_is_at_22_degrees(stage: Stage) -> None:
    stage.air.time = "2025-06-21T15:30:00Z"
    data = stage.weather._frame().atmosphere
    assert data is not None
    without = stage.toward(data.sun_direction, 80.0)
    stage.air.halo = 1.0
    ring = stage.toward(data.sun_direction, 80.0) - without
    apart = np.degrees(np.arccos(np.clip(stage.directions() @ np.array(data.sun_direction), -1, 1)))
    angles = np.arange(18.0, 34.0, 0.5)
    light = profile(ring, apart, angles)
    assert angles[light.sum(1).argmax()] == pytest.approx(22.0, abs=0.6)
    assert light[angles < 20.5].max() < 0.1 * light.max()
    assert angles[light[:, 0].argmax()] <= angles[light[:, 2].argmax()]  # red inside


def bow(stage: Stage, rate: float) -> tuple[NDArray, NDArray]:
    """(picture, degrees from the point opposite the sun) with rain there."""
    stage.air.time = "2025-06-21T18:00:00Z"
    esper.process(0.0)
    data = stage.weather._frame().atmosphere
    assert data is not None
    x, _, z = np.negative(data.sun_direction)
    if rate > 0.0:
        esper.create_entity(RainArea((900 * x, 900 * z), (800, 700), rain_rate=rate))
        esper.create_entity(RainContainer(veil=0.0, opacity=0.0))
    picture = stage.picture(math.atan2(-z, x), 0.35, 90.0)
    cosine = np.clip(stage.directions() @ np.array((x, -data.sun_direction[1], z)), -1, 1)
    return picture, np.degrees(np.arccos(cosine))


def test_rainbow_is_at_42_degrees_and_the_secondary_at_51(stage: Stage) -> None:
    without, _ = bow(stage, 0.0)
    with_rain, apart = bow(stage, 10.0)
    light = with_rain - without
    light[stage.directions()[..., 1] < 0.06] = 0.0
    seen = np.where(stage.directions()[..., 1] > 0.06, apart, -1.0)
    angles = np.arange(34.0, 58.0, 0.5)
    rings = profile(light, seen, angles)
    total = rings.sum(1)
    primary, secondary = angles < 46.0, angles > 48.0
    assert angles[primary][total[primary].argmax()] == pytest.approx(42.0, abs=1.0)
    assert angles[secondary][total[secondary].argmax()] == pytest.approx(51.0, abs=1.2)
    red, blue = (angles[primary][rings[primary, c].argmax()] for c in (0, 2))
    assert red > blue
    red, blue = (angles[secondary][rings[secondary, c].argmax()] for c in (0, 2))
    assert red < blue
    band = total[(angles > 44.5) & (angles < 48.5)]  # Alexander's
    assert band.max() < 0.15 * total.max()
    assert total[angles < 39.0].min() > band.max()


def test_rings_have_as_many_angles_as_their_colours_ask_for() -> None:
    angles = np.linspace(10.0, 30.0, 81)
    colors = np.stack([np.maximum(angles - 25.0, 0.0), 0.0 * angles, angles], 1)
    kept = thinned(angles, colors, 1e-9)
    assert [angles[k] for k in kept] == [10.0, 25.0, 30.0]  # straight on both sides of a corner
    for table in (bows.rainbow(), bows.halo()):
        kept = thinned(np.arange(len(table)), table, 0.005)
        line = [np.interp(np.arange(len(table)), kept, table[kept][:, c]) for c in range(3)]
        assert np.abs(np.stack(line, 1) - table).max() <= 0.005
        assert len(kept) < len(table) / 4


@pytest.mark.parametrize("halo", [0.0, 1.0])
def test_what_of_a_ring_is_left_out_is_not_to_be_seen(
    stage: Stage, monkeypatch: pytest.MonkeyPatch, halo: float
) -> None:
    """Segments below the horizon, and those where no rain is."""
    stage.air.time, stage.air.halo = "2025-06-21T18:00:00Z", halo
    stage.air.rainbow = 1.0 - halo
    if halo == 0.0:
        bow(stage, 10.0)
    x, _, z = stage.weather.light.sun_direction
    heading = math.atan2(-z, x) + (0.0 if halo else math.pi)
    drawn = stage.picture(heading, 0.2, 100.0)
    monkeypatch.setattr(sky_ring, "LEVEL", -2.0)
    monkeypatch.setattr(sky_ring, "FAINTEST", -1.0)
    whole = stage.picture(heading, 0.2, 100.0)
    assert np.abs(whole - drawn).max() <= 1.5 / 255.0
    stage.air.halo = stage.air.rainbow = 0.0
    assert np.abs(stage.picture(heading, 0.2, 100.0) - drawn).max() > 0.05  # there is a ring


def test_no_rainbow_without_rain_or_under_a_high_sun(stage: Stage) -> None:
    stage.air.time = "2025-06-21T12:00:00Z"
    esper.create_entity(RainArea((0, -900), (800, 700), rain_rate=10.0))
    esper.process(0.0)
    stage.picture(math.pi / 2, 0.2)
    sky = stage.weather._renderer._layers._sky  # type: ignore[union-attr]
    assert sky is not None
    assert not sky.has_bow


def test_a_rainbow_too_faint_for_any_pixel_is_not_drawn(stage: Stage) -> None:
    bow(stage, 10.0)
    sky = stage.weather._renderer._layers._sky  # type: ignore[union-attr]
    assert sky is not None and sky.has_bow
    stage.air.rainbow = 0.004
    bow(stage, 0.0)
    assert not sky.has_bow


def test_the_scene_stays_in_front(stage: Stage) -> None:
    near = stage.picture(0.0, 0.3, depth=0.5)
    assert np.allclose(near, (64 / 255, 128 / 255, 191 / 255), atol=2 / 255)


def test_games_with_a_sky_of_their_own_are_left_alone(stage: Stage) -> None:
    stage.air.draw = False
    picture = stage.picture(0.0, 0.3)
    assert np.allclose(picture, (64 / 255, 128 / 255, 191 / 255), atol=2 / 255)


def test_a_framebuffer_without_depth_is_left_alone(stage: Stage) -> None:
    target = stage.ctx.framebuffer([stage.color])
    target.use()
    target.clear(0.25, 0.5, 0.75, 1.0)
    stage.weather.draw(look_from((0, 2, 0), 0.0), perspective())
    assert target.read(components=3)[:3] == bytes((64, 128, 191))
    target.release()


def test_sun_moon_and_stars_are_where_they_stand(stage: Stage) -> None:
    stage.air.time = "2025-06-21T15:30:00Z"
    data = stage.weather._frame().atmosphere
    assert data is not None
    sun = stage.toward(data.sun_direction, 20.0)
    middle = sun[SIZE[1] // 2, SIZE[0] // 2]
    assert middle.min() > 0.97
    assert sun[5, 5].min() < 0.9
    stage.air.time = "2025-01-13T22:00:00Z"  # a full moon
    data = stage.weather._frame().atmosphere
    assert data is not None
    moon = stage.toward(data.moon_direction, 4.0)
    assert moon[SIZE[1] // 2 + 3, SIZE[0] // 2].min() > 0.5
    assert moon[5, 5].max() < 0.4
    stage.air.time = "2025-02-03T18:30:00Z"  # a third of it is lit, on the side of the sun
    data = stage.weather._frame().atmosphere
    assert data is not None
    crescent = stage.toward(data.moon_direction, 1.5).sum(-1)
    bright = crescent > 0.5 * crescent.max()
    way = (stage.directions()[bright].mean(0) - np.array(data.moon_direction)) @ np.array(
        data.sun_direction
    )
    assert way > 0.0
    stage.air.time = "2025-01-29T21:00:00Z"
    dark = stage.picture(-math.pi / 2, 0.7)
    stage.air.stars = 0.0
    assert (dark - stage.picture(-math.pi / 2, 0.7)).max() > 0.3


def test_the_hosts_state_comes_back(ctx: moderngl.Context, gl: GL) -> None:
    kept: list[Any] = []

    def keep(thing: Any) -> Any:
        kept.append(thing)
        return thing

    outer = StateGuard(ctx, gl)
    with outer:
        stage = Stage(ctx, halo=1.0)
        host = Host(ctx, gl, keep, 11)
        for time in ("2025-06-21T18:00:00Z", "2025-01-13T22:00:00Z"):
            stage.air.time = time
            esper.process(0.0)
            stage.weather.draw(look_from((0, 2, 0), 0.0, 0.3), perspective())
            for _ in range(3):
                host.scramble()
                stage.air.time += 60.0
                esper.process(0.0)
                before = read_state(gl)
                stage.weather.draw(look_from((0, 2, 0), 0.0, 0.3), perspective())
                after = read_state(gl)
                assert {k: (v, after[k]) for k, v in before.items() if after[k] != v} == {}
        outer.reset()
        stage.release()
    outer.release()
    for thing in reversed(kept):
        thing.release()
    while gl.error() == 0x0506:  # the window's framebuffer was bound; there is none
        pass


def test_fog_covers_the_sky(stage: Stage) -> None:
    fog = Fog(30.0)
    esper.create_entity(fog)
    picture = stage.picture(0.0, 0.2)
    color = sky_map.shown(np.array(stage.weather._frame().fog.color))
    assert np.abs(picture - color).max() < 0.03


def test_without_an_atmosphere_the_map_is_a_gradient(stage: Stage) -> None:
    esper.delete_entity(stage.entity, immediate=True)
    sky = stage.weather.sky()
    stage.picture(0.0, 0.2)
    assert sky._block.data["weather_sky_ground"][3] == 0.0


def test_bad_input(ctx: moderngl.Context) -> None:
    with Weather() as weather, pytest.raises(ContextError):
        weather.sky()
    with Weather(context=ctx) as weather, pytest.raises(InvalidValueError, match="observer"):
        weather.sky(observer=3)  # type: ignore[arg-type]


def test_closed_clouds_leave_no_sun_for_a_rainbow(stage: Stage) -> None:
    stage.air.overcast = 0.0
    strengths = []
    for overcast in (0.0, 0.6, 1.0):
        stage.weather.change_to(WholeWeather("so", 0.0, overcast=overcast), 0.0)
        data = stage.weather._frame().atmosphere
        assert data is not None
        strengths.append(data.rainbow)
    assert strengths[0] == 1.0 > strengths[1] > 0.7 and strengths[2] == 0.0


@pytest.mark.parametrize("latitude", [23.44, -23.44])
def test_a_sun_straight_above_and_straight_below(stage: Stage, latitude: float) -> None:
    """There is no azimuth to go by; halo, bow, disc and map are asked for all the same."""
    stage.air.time, stage.air.latitude = "2025-06-21T12:02:00Z", latitude
    stage.air.halo = stage.air.rainbow = 1.0
    if latitude < 0.0:
        stage.air.time = "2025-06-21T00:02:00Z"
    esper.create_entity(RainArea((0.0, -4000.0), (1500.0, 1500.0), 20.0))
    up = stage.picture(0.0, math.radians(89.9), 70.0)
    light = stage.weather.light
    assert all(math.isfinite(c) for c in (*light.sun_color, *light.zenith_color))
    assert math.isfinite(stage.weather.sample((0.0, 0.0, 0.0)).light)
    sun = stage.weather._frame().atmosphere.sun_direction
    assert math.copysign(1.0, latitude) * sun[1] > 0.99999
    if latitude > 0.0:
        rows, columns = SIZE[1] // 2, SIZE[0] // 2
        assert up[rows - 2 : rows + 2, columns - 2 : columns + 2].min() > 0.9  # the disc
        angles = np.degrees(np.arccos(np.clip(stage.directions() @ np.array(sun), -1.0, 1.0)))
        rings = profile(up, angles, np.array([15.0, 17.0, 19.0]))
        assert np.ptp(rings, axis=0).max() < 0.2  # even round the zenith
    else:
        assert np.median(up) < 0.3  # but for stars
    for heading in (0.0, math.pi / 2.0):
        assert np.isfinite(stage.picture(heading, 0.2)).all()


def test_lightning_lights_the_sky_and_most_of_all_above_the_horizon(stage: Stage) -> None:
    stage.air.time = "2025-06-21T22:30:00Z"
    stage.air.stars = 0.0
    dark = stage.picture(math.pi / 2, 0.3)
    stage.weather.strike((0.0, 0.0, 3000.0), origin=(0.0, 1000.0, 3000.0), current=60.0)
    esper.process(0.05)
    esper.process(0.04)
    lit = stage.picture(math.pi / 2, 0.3)
    up = stage.directions()[..., 1]
    gain = (lit - dark).mean(axis=2)
    assert gain[(up > 0.02) & (up < 0.08)].mean() > 0.02
    assert gain[(up > 0.02) & (up < 0.08)].mean() > 1.5 * gain[up > 0.4].mean() > 0.0
    esper.process(5.0)
    assert np.abs(stage.picture(math.pi / 2, 0.3) - dark).max() < 3.0 / 255.0
