"""The sky as it is drawn: against its oracle, by measured angles, and as a guest."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tests.gl_host import Host, read_state
from tests.sky_stage import SIZE, Stage, profile
from tests.views import look_from, perspective
from weather_ecs import Weather, glsl
from weather_ecs.components import Fog, Observer, RainArea
from weather_ecs.errors import ContextError, InvalidValueError
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.physics import sky_map
from weather_ecs.presets import WholeWeather

TIMES = ("12:00", "19:30", "20:15", "23:00")


pytestmark = pytest.mark.usefixtures("world")


@pytest.fixture
def stage(ctx: moderngl.Context) -> Iterator[Stage]:
    made = Stage(ctx)
    yield made
    made.release()


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
