"""Lightning in the picture: its light in clouds and in a game's shader, its channel, its state."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import esper
import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tests.cloud_captures import CENTERS, captured, expected_places
from tests.cloud_stage import cloud_stage, clouds, shape, sky_frame
from tests.gl_host import read_state
from tests.views import look_from, perspective
from tests.worlds import fresh_world
from weather_ecs import Weather, glsl
from weather_ecs.components import Lightning, RainArea
from weather_ecs.frame import STRIKE_DTYPE, FrameData, LightningLook
from weather_ecs.gpu.bolt_pass import channels
from weather_ecs.gpu.flash import HAZE, cloud_lights, flash_of
from weather_ecs.gpu.gl import GL
from weather_ecs.physics import cloud_light, lightning

SIZE = (320, 180)
EYE = (0.0, 2.0, 0.0)
VIEW, PROJECTION = look_from(EYE, 0.5 * math.pi, 0.2), perspective(60.0)  # towards -z
WORD = 1234


def strikes(*rows: dict[str, Any]) -> NDArray:
    """Rows of FrameData.strikes."""
    found = np.zeros(len(rows), STRIKE_DTYPE)
    for k, row in enumerate(rows):
        given = {
            "number": k, "word": WORD + k, "origin": (0, 1000, -3000), "target": (0, 0, -3000),
            "place": (0, 400, -3000), "cloud_place": (0, 850, -3000), "age": 0.04, "light": 4.0,
            "leader": 1.0, "ground": True, "again": False, **row,
        }  # fmt: skip
        for name, value in given.items():
            found[name][k] = value
    return found


# Light


def test_clouds_are_lit_as_the_oracle_says(ctx: moderngl.Context) -> None:
    row = {
        "position": (40.0, 300.0, -700.0), "scale": 1.3, "mirror": -1.0, "heading": 0.7,
        "shear": (0.3, -0.2), "growth": 1.0, "mode": 0.0, "opacity": 0.8, "darkness": 0.4,
    }  # fmt: skip
    data = shape(centers=CENTERS, billboards=8, absorbed=(0.1, 0.45, 0.9))
    dark = sky_frame(clouds(row), data, lightning=LightningLook(color=(0.5, 0.8, 1.0)))
    rows = strikes(
        {"cloud_place": (100.0, 400.0, -800.0), "light": 0.3},
        {"cloud_place": (-900.0, 800.0, -1200.0), "light": 0.9},
    )
    lit = replace(dark, strikes=rows)
    with cloud_stage(ctx) as stage:
        before, after = captured(stage, dark), captured(stage, lit)
    _, corners, _ = expected_places(data, row)
    wanted = cloud_light.near_flash(corners, *cloud_lights(lit, EYE))
    assert wanted.max() > 0.2
    for name, share in (("vs_lit", 1.0), ("vs_shade", cloud_light.FLASH_SHADE)):
        more = after[name] ** 2.2 - before[name] ** 2.2
        np.testing.assert_allclose(more, share * wanted, atol=2e-3)


def test_a_near_flash_falls_off_and_adds_up() -> None:
    rows = strikes({"light": 1.0}, {"light": 1.0})
    frame = FrameData(strikes=rows, lightning=LightningLook(color=(1.0, 1.0, 1.0)))
    places, colors = cloud_lights(frame, EYE)
    at = places[:1, :3].astype(float) + np.array([[0, 0, 0], [0, 500, 0], [0, 0, 9000.0]])
    one = cloud_light.near_flash(at, places[:1], colors[:1])
    np.testing.assert_allclose(cloud_light.near_flash(at, places, colors), 2.0 * one)
    assert one[0, 0] > 2.0 * one[2, 0]
    assert one[0, 0] > one[1, 0] > one[2, 0] > 0.0
    many = FrameData(strikes=strikes(*[{"light": 0.1 * k} for k in range(1, 9)]))
    assert cloud_lights(many, EYE)[0].shape == (4, 4)
    assert cloud_lights(many, EYE)[1][:, 2].min() > 0.5 * cloud_lights(many, EYE)[1][:, 2].max()


def test_a_game_s_shader_gets_the_light_that_samples_have(ctx: moderngl.Context) -> None:
    points = [(0.0, 0.0, 0.0), (300.0, 20.0, -2800.0), (-4000.0, 0.0, 900.0)]
    normals = [(0.0, 1.0, 0.0), (0.6, 0.8, 0.0), (0.0, 0.0, -1.0)]
    text = "#" + "version 330\n" + glsl("weather.glsl")
    text += "uniform vec3 p;\nuniform vec3 n;\nout vec3 light;\n"
    text += "void main() { light = weather_flash(p, n); }"
    with fresh_world(), Weather(context=ctx, quality="low", seed=2) as weather:
        air = weather.air(position=EYE)
        fog = np.array(air._block.data["weather_fog_color"][:3])
        weather.strike((0.0, 0.0, -900.0), origin=(0.0, 1000.0, -1000.0), current=30.0)
        esper.process(0.05)
        esper.process(0.04)
        frame = weather._frame()
        air = weather.air(position=EYE)
        program = ctx.program(vertex_shader=text, varyings=["light"])
        array, out = ctx.vertex_array(program, []), ctx.buffer(reserve=12)
        target = ctx.framebuffer([ctx.renderbuffer((4, 4))])
        target.use()
        air.use(program)
        (row,) = frame.strikes
        color = np.array(frame.lightning.color) * row["light"]
        assert color.max() > 1.0
        for point, normal in zip(points, normals, strict=True):
            program["p"], program["n"] = point, normal
            array.transform(out, moderngl.POINTS, vertices=1)
            share = lightning.on_surface(tuple(row["place"].tolist()), point, normal)
            found = np.frombuffer(out.read(), np.float32)
            np.testing.assert_allclose(found, color * share, rtol=1e-4)
        lit = np.array(air._block.data["weather_fog_color"][:3])
        flash = flash_of(frame, EYE)
        assert flash is not None
        np.testing.assert_allclose(lit - fog, HAZE * flash.here, atol=1e-5)
        for thing in (array, out, program, *target.color_attachments, target):
            thing.release()


# The channel


class Screen:
    """A weather and a framebuffer that it is drawn to."""

    def __init__(self, ctx: moderngl.Context, **given: Any) -> None:
        self.ctx = ctx
        self.color, self.depth = ctx.texture(SIZE, 4), ctx.depth_texture(SIZE)
        self.target = ctx.framebuffer([self.color], self.depth)
        self.weather = Weather(context=ctx, quality="low", seed=4, **given)

    def draw(self, depth: float = 1.0, sky: float = 0.2) -> NDArray[np.float64]:
        """(h, w, 3), bottom row first, 0 to 1."""
        self.target.use()
        self.target.clear(sky, sky, sky, 1.0, depth=depth)
        self.weather.draw(VIEW, PROJECTION)
        data = np.frombuffer(self.target.read(components=3, alignment=1), np.uint8)
        return data.reshape(SIZE[1], SIZE[0], 3).astype(float) / 255.0

    def strike(self, seconds: float = 0.04) -> None:
        self.weather.strike((0.0, 0.0, -3000.0), origin=(0.0, 1000.0, -3000.0), current=60.0)
        esper.process(0.05)
        esper.process(seconds)

    def release(self) -> None:
        self.weather.close()
        for thing in (self.target, self.color, self.depth):
            thing.release()


@pytest.fixture(params=["compute", "feedback"])
def screen(ctx: moderngl.Context, request: pytest.FixtureRequest) -> Iterator[Screen]:
    with fresh_world():
        it = Screen(ctx, backend=request.param)
        yield it
        it.release()


def pixel(point: NDArray) -> tuple[int, int]:
    """Row and column of a place."""
    clip = PROJECTION @ VIEW @ np.append(point, 1.0)
    x, y = (clip[:2] / clip[3] * 0.5 + 0.5) * SIZE
    return int(y), int(x)


def test_the_channel_is_where_its_pieces_are(screen: Screen) -> None:
    esper.create_entity(Lightning(glow=0.0))
    dark = screen.draw()
    np.testing.assert_allclose(dark, 51 / 255)
    screen.strike()
    lit = screen.draw()
    view = screen.weather._view.view(
        screen.weather._frame(), _camera(), 0, screen.weather._settings
    )
    hot, _ = channels(view)
    trunk = hot[:256, :3].astype(float) + EYE
    white = 0
    for point in trunk[8:-8]:
        row, column = pixel(point)
        around = lit[row - 1 : row + 2, column - 1 : column + 2]
        white += around.max() > 0.95
    assert white > 0.97 * len(trunk[8:-8])
    # And nowhere else: no pixel is brighter that is not next to a piece.
    near = np.zeros(SIZE[::-1], bool)
    for share in np.linspace(0.0, 1.0, 9):
        for point in hot[:, :3] * (1.0 - share) + hot[:, 4:7] * share + np.array(EYE):
            row, column = pixel(point)
            near[max(row - 3, 0) : row + 4, max(column - 3, 0) : column + 4] = True
    np.testing.assert_allclose(lit[~near], 51 / 255)


def _camera() -> Any:
    from weather_ecs.physics.camera import camera_from

    return camera_from(VIEW, PROJECTION)


def test_nothing_is_drawn_before_and_after(screen: Screen) -> None:
    dark = screen.draw()
    screen.strike()
    assert np.abs(screen.draw() - dark).max() > 0.5
    esper.process(3.0)
    np.testing.assert_array_equal(screen.draw(), dark)
    assert not screen.weather._renderer._layers._bolts.draws(
        screen.weather._view.view(screen.weather._frame(), _camera(), 0, screen.weather._settings)
    )


def test_the_scene_hides_it_and_the_air_glows_round_it(screen: Screen) -> None:
    esper.create_entity(Lightning(glow=1.0))
    screen.strike()
    hidden = screen.draw(depth=0.9)
    np.testing.assert_allclose(hidden, 51 / 255)
    shown = screen.draw()
    row, column = pixel(np.array([0.0, 500.0, -3000.0]))
    halo = shown[row, column + 6 : column + 40 : 4].mean(axis=1)
    assert halo.max() > 0.3
    assert shown[row, -2].mean() < 0.25


def test_the_leader_comes_down_before_the_stroke(screen: Screen) -> None:
    esper.create_entity(Lightning(glow=0.0))
    screen.strike(0.017)
    seen = screen.draw() > 0.25
    rows = np.flatnonzero(seen.any(axis=(1, 2)))
    top, ground = pixel(np.array([0.0, 1000.0, -3000.0]))[0], pixel(np.array([0, 0, -3000.0]))[0]
    assert abs(rows.max() - top) < 12
    assert rows.min() > ground + 10


def test_the_host_s_state_comes_back(screen: Screen) -> None:
    screen.strike()
    screen.draw()
    gl = GL()
    screen.target.use()
    before = read_state(gl)
    screen.weather.draw(VIEW, PROJECTION)
    assert read_state(gl) == before


@pytest.mark.parametrize("place", [EYE, (0.0, 0.0, -0.5), (0.0, 1.0, 3.0)])
def test_a_strike_on_the_camera_is_drawn_and_harmless(
    screen: Screen, place: tuple[float, ...]
) -> None:
    screen.weather.strike(place, current=300.0)
    esper.process(0.05)
    esper.process(0.04)
    assert np.isfinite(screen.draw()).all()
    screen.weather.strike(origin=place)
    esper.process(0.1)
    assert np.isfinite(screen.draw()).all()


def test_rain_shows_the_flash_and_a_bright_channel(screen: Screen) -> None:
    esper.create_entity(RainArea((0.0, -800.0), (1500.0, 1500.0), 10.0, ceiling=900.0))
    esper.process(0.05)
    dark = screen.draw()
    screen.weather.strike((0.0, 0.0, -900.0), origin=(0.0, 1000.0, -900.0), current=60.0)
    esper.process(0.05)
    esper.process(0.036)
    lit = screen.draw()
    assert np.median(lit) > np.median(dark) + 0.1
    assert (lit > 0.97).all(axis=2).sum() > 20
