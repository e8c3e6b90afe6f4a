"""Fog as a full-screen pass: against the laws of `physics.optics`, in every kind of framebuffer."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import moderngl
import numpy as np
import pytest

from tests.rain_frames import area, camera, frame, quality
from tests.veil_stage import rays_of
from weather_ecs.frame import FogData, FrameData, ViewData
from weather_ecs.gpu.renderer import Renderer
from weather_ecs.gpu.view_block import encode
from weather_ecs.physics.camera import Camera
from weather_ecs.physics.optics import (
    CLEAR,
    air_extinction,
    falling_extinction,
    fog_factor,
    layer_path,
    overlay_opacity,
)
from weather_ecs.systems.rain_view import RainView

SIZE = (96, 54)
COLOR = (0.6, 0.65, 0.7)
NEAR, FAR = 0.1, 2000.0
STEP = 1.0 / 255.0


def stored(t: np.ndarray | float, at: Camera) -> np.ndarray:
    """Window depth of points t m deep along the forward axis."""
    p = at.projection
    depth = np.asarray(t, np.float64)
    return ((-p[2, 2] * depth + p[2, 3]) / depth) * 0.5 + 0.5


class Host:
    """A game's framebuffer with a scene in it: one colour, and depths of a test's choosing."""

    def __init__(self, ctx: moderngl.Context, samples: int = 0) -> None:
        self.ctx, self.samples = ctx, samples
        self.renderer = Renderer(ctx)
        self.color = ctx.renderbuffer(SIZE, 4, samples=samples)
        self.depth = ctx.depth_renderbuffer(SIZE, samples=samples)
        self.target = ctx.framebuffer([self.color], self.depth)
        self.flat = ctx.renderbuffer(SIZE, 4)
        self.plain = ctx.framebuffer([self.flat])
        self.program = ctx.program(
            vertex_shader="""#version 330
                void main() {
                    vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
                    gl_Position = vec4(p, 0.0, 1.0);
                }""",
            fragment_shader="""#version 330
                uniform sampler2D depths; uniform vec3 shade; out vec4 color;
                void main() {
                    gl_FragDepth = texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r;
                    color = vec4(shade, 1.0);
                }""",
        )
        self.array = ctx.vertex_array(self.program, [])

    def draw(self, seen: ViewData, depth: np.ndarray | float, shade: float = 0.0) -> np.ndarray:
        """The picture, (height, width, 3), 0 to 1, rows from below."""
        whole = np.broadcast_to(np.float32(depth), SIZE[::-1]).astype(np.float32)
        texture = self.ctx.texture(SIZE, 1, np.ascontiguousarray(whole).tobytes(), dtype="f4")
        texture.use(0)
        self.program["depths"], self.program["shade"] = 0, (shade,) * 3
        self.target.use()
        self.target.clear()
        self.ctx.enable_only(moderngl.DEPTH_TEST)
        self.ctx.depth_func = "1"
        self.array.render(moderngl.TRIANGLES, vertices=3)
        self.ctx.depth_func = "<"
        self.renderer.draw(seen, quality())
        if self.samples:
            self.ctx.copy_framebuffer(self.plain, self.target)
        read = self.plain if self.samples else self.target
        pixels = np.frombuffer(read.read(components=3), np.uint8)
        texture.release()
        return pixels.reshape(SIZE[1], SIZE[0], 3) / 255.0

    def release(self) -> None:
        self.renderer.release()
        for thing in (
            self.array, self.program, self.plain, self.flat, self.target, self.depth, self.color,
        ):  # fmt: skip
            thing.release()


@pytest.fixture(params=[0, 4], ids=["plain", "multisampled"])
def host(ctx: moderngl.Context, request: pytest.FixtureRequest) -> Iterator[Host]:
    if request.param > ctx.max_samples:
        pytest.skip("no multisampling")
    made = Host(ctx, request.param)
    yield made
    made.release()


@pytest.fixture
def single(ctx: moderngl.Context) -> Iterator[Host]:
    made = Host(ctx)
    yield made
    made.release()


def fog(visibility: float = 100.0, **rest: object) -> FogData:
    return FogData(air_extinction(visibility), COLOR, **{"draw": True, **rest})  # type: ignore[arg-type]


def view(data: FrameData, at: Camera, veils: bool = True) -> ViewData:
    return RainView().view(data, at, 0, quality(veil=veils, drops=10))


def expected(covered: np.ndarray, shade: float) -> np.ndarray:
    """The picture where fog takes this share of the light."""
    opacity = overlay_opacity(1.0 - covered)[..., None]
    return shade * (1.0 - opacity) + encode(np.array(COLOR)) * opacity


def reached(at: Camera, t: np.ndarray | float) -> np.ndarray:
    return np.linalg.norm(rays_of(at), axis=-1) * t


@pytest.mark.parametrize("vertical", [20.0, 60.0, 110.0])
def test_the_scene_fades_with_its_distance_to_the_observer(host: Host, vertical: float) -> None:
    at = camera(vertical=vertical, pitch=0.3)
    t = np.geomspace(0.5, 400.0, SIZE[0])[None, :].repeat(SIZE[1], 0)
    found = host.draw(view(frame(fog=fog()), at), stored(t, at), shade=0.25)
    covered = 1.0 - fog_factor(reached(at, t), air_extinction(100.0))
    assert np.abs(found - expected(covered, 0.25)).max() < 2.0 * STEP
    assert covered.max() > 0.99 > 0.1 > covered.min()


def test_the_corners_are_farther_than_the_middle(single: Host) -> None:
    """By the distance and not by the depth: turning the head changes nothing in the fog."""
    at = camera(vertical=90.0)
    found = single.draw(view(frame(fog=fog()), at), stored(30.0, at))[..., 0]
    assert found[0, 0] > found[SIZE[1] // 2, SIZE[0] // 2] + 0.1


def test_at_the_visibility_a_black_thing_keeps_two_per_cent(single: Host) -> None:
    at = camera(vertical=2.0)
    for visibility in (50.0, 300.0, 1000.0):
        found = single.draw(view(frame(fog=fog(visibility)), at), stored(visibility, at))
        contrast = 1.0 - (found / encode(np.array(COLOR))) ** 2.2
        assert 0.01 < contrast.mean() < 0.035


@pytest.mark.parametrize("visibility", [0.0, 100.0, 1000.0, 10_000.0, 1e7])
@pytest.mark.parametrize("pitch", [0.0, 0.6, 1.5])
def test_the_sky_is_hidden_as_far_as_a_layer_hides_it(
    single: Host, visibility: float, pitch: float
) -> None:
    at = camera(pitch=pitch)
    found = single.draw(view(frame(fog=fog(visibility)), at), 1.0, shade=0.9)
    ray = rays_of(at)
    sine = ray[..., 1] / np.linalg.norm(ray, axis=-1)
    thick = max(air_extinction(visibility) - CLEAR, 0.0)
    covered = 1.0 - fog_factor(layer_path(sine, 250.0), thick)
    assert np.abs(found - expected(covered, 0.9)).max() < 2.0 * STEP


def test_dense_fog_hides_the_sky_and_haze_leaves_the_zenith(single: Host) -> None:
    up, level = camera(pitch=1.5), camera(pitch=0.0)
    shown = encode(np.array(COLOR))
    dense = single.draw(view(frame(fog=fog(80.0)), up), 1.0)
    assert np.abs(dense - shown).max() < 0.02
    haze = single.draw(view(frame(fog=fog(8000.0)), up), 1.0, shade=0.3)
    assert np.abs(haze - 0.3).max() < 0.18
    rim = single.draw(view(frame(fog=fog(8000.0)), level), 1.0, shade=0.3)
    assert np.abs(rim[SIZE[1] // 2 - 1] - shown).max() < 0.02
    shallow = single.draw(view(frame(fog=fog(80.0, depth=0.0)), up), 1.0, shade=0.3)
    assert np.abs(shallow - 0.3).max() < STEP


def test_nothing_is_drawn_where_it_is_not_asked_for(single: Host) -> None:
    at = camera()
    found = single.draw(view(frame(fog=fog(draw=False)), at), stored(50.0, at), shade=0.2)
    assert np.abs(found - 0.2).max() < STEP
    clear = single.draw(view(frame(fog=fog(1e7)), at), stored(10.0, at), shade=0.2)
    assert np.abs(clear - 0.2).max() < STEP


def test_rain_is_counted_once(single: Host) -> None:
    """The veils show the rain; without them the fog takes what falls where the observer stands."""
    data = frame(area(radii=(500.0, 500.0), rain_rate=50.0), fog=fog(1000.0))
    at = camera(vertical=10.0)
    seen = view(data, at, veils=False)
    found = single.draw(replace(seen, containers=()), stored(150.0, at))
    extinction = air_extinction(1000.0) + falling_extinction(50.0, 0.0)
    covered = 1.0 - fog_factor(reached(at, 150.0), extinction)
    assert np.abs(found - expected(covered, 0.0)).max() < 2.0 * STEP

    veiled = view(data, at)
    assert veiled.veils
    none = replace(veiled, containers=(), veils=tuple(
        replace(veil, extinction=0.0) for veil in veiled.veils
    ))  # fmt: skip
    found = single.draw(none, stored(150.0, at))
    covered = 1.0 - fog_factor(reached(at, 150.0), air_extinction(1000.0))
    assert np.abs(found - expected(covered, 0.0)).max() < 2.0 * STEP


def test_far_rain_in_dense_fog_is_not_brighter_than_the_fog(single: Host) -> None:
    """Veil and streaks fade with the fog: a shaft 300 m off, seen through 100 m of visibility."""
    shaft = area(center=(0.0, -300.0), radii=(70.0, 60.0), rain_rate=100.0)
    at = camera(heading=math.pi / 2)
    data = frame(shaft, fog=fog(100.0))
    seen = RainView().view(data, at, 0, quality(drops=4000))
    assert seen.veils
    found = single.draw(seen, stored(1500.0, at))
    assert np.abs(found - encode(np.array(COLOR))).max() < 3.0 * STEP


def test_a_lopsided_frustum_and_a_picture_without_perspective(single: Host) -> None:
    at = camera()
    at.projection[0, 2], at.projection[1, 2] = 0.4, -0.3
    found = single.draw(view(frame(fog=fog()), at), stored(40.0, at))
    covered = 1.0 - fog_factor(reached(at, 40.0), air_extinction(100.0))
    assert np.abs(found - expected(covered, 0.0)).max() < 1.5 * STEP
    flat = camera()
    seen = view(frame(fog=fog()), flat)
    level = replace(seen, projection=np.diag([0.01, 0.01, -0.001, 1.0]))
    assert single.draw(level, 0.5, shade=0.4) == pytest.approx(0.4, abs=STEP)
