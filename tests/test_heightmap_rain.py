"""Drops that meet the heightmap, and the slope along which it is captured."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
import pytest

from tests.boxes import box, placed
from tests.rain_frames import area, camera, frame, quality
from weather_ecs.frame import DropLook, OccluderData
from weather_ecs.gpu.context import probe
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.heightmap import fall_speed_of
from weather_ecs.gpu.occluder_meshes import OccluderMeshes
from weather_ecs.gpu.renderer import Renderer
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.physics.footprint import OFF, RESTED, SlopeFollower, fall_slope
from weather_ecs.systems.rain_view import RainView

# Drops that meet it


class Rain:
    """A renderer that draws one observer's rain into a small picture."""

    def __init__(self, ctx: moderngl.Context, backend: str = "auto") -> None:
        self.renderer = Renderer(ctx, backend=backend, seed=3)
        self.guard = StateGuard(ctx)  # reading binds; the renderer's own may not stay bound
        self.target = ctx.simple_framebuffer((160, 90))
        self.views = RainView(3)

    def play(self, occluders: tuple[OccluderData, ...], **rest: Any) -> np.ndarray:
        """The picture after some seconds of rain: share of each pixel that is covered."""
        at = rest.pop("at", camera((0.0, 1.7, 0.0)))
        look = DropLook(veil=0.0, **rest.pop("look", {}))
        seen = frame(area(radii=(300.0, 300.0)), look=look, occluders=occluders, **rest)
        settings = quality(12_000, map_size=256)
        for k in range(26):
            self.target.use()
            self.target.clear()
            view = self.views.view(replace(seen, time=k / 10), at, 0, settings)
            self.renderer.draw(view, settings)
        picture = np.frombuffer(self.target.read(components=4), np.uint8).reshape(90, 160, 4)
        return picture[..., 3] / 255.0

    def falling(self) -> np.ndarray:
        """Places of the drops that still fall, (n, 3)."""
        found = []
        for drops in self.renderer.rain.sets().values():
            with self.guard:
                data = drops.states[drops.current].read()
            state = np.frombuffer(data, np.float32).reshape(-1, 6)[: drops.alive]
            found.append(state[state[:, 4] < 1024.0, :3])
        return np.concatenate(found)

    def release(self) -> None:
        self.renderer.release()
        self.guard.release()
        for attachment in (*self.target.color_attachments, self.target.depth_attachment):
            attachment.release()
        self.target.release()


@pytest.fixture(params=["compute", "feedback"])
def rain(ctx: moderngl.Context, request: pytest.FixtureRequest) -> Iterator[Rain]:
    if request.param == "compute" and not probe(ctx).compute:
        pytest.skip("no compute shaders here")
    made = Rain(ctx, request.param)
    yield made
    made.release()


ROOF = placed((0.0, 5.0, 0.0), (8.0, 0.1, 8.0))
GROUND = placed((0.0, -1.0, 0.0), (500.0, 1.0, 500.0))


def test_it_is_dry_under_a_roof_and_rains_outside(rain: Rain) -> None:
    open_air = rain.play((box(0, GROUND),))
    assert (open_air > 0.0).mean() > 0.02
    under = rain.play((box(0, GROUND), box(1, ROOF)))
    p = rain.falling()
    indoors = (np.abs(p[:, [0, 2]]) < 7.7).all(axis=1)
    assert len(p) > 1000 and indoors.any()
    assert (p[indoors, 1] > 5.0).all()  # on the roof's upper side only
    outdoors = (np.abs(p[:, [0, 2]]) > 8.3).any(axis=1)
    assert (p[outdoors, 1] < 5.0).mean() > 0.2
    assert p[:, 1].min() > -0.5  # and none under the ground
    # What is left in the picture is the rain beyond the roof, farther off and so fainter.
    assert 0.0 < under.sum() < 0.6 * open_air.sum()


def test_under_a_roof_as_large_as_the_container_there_is_no_rain(rain: Rain) -> None:
    hall = placed((0.0, 5.0, 0.0), (60.0, 0.1, 60.0))
    downwards = camera((0.0, 1.7, 0.0), pitch=-0.6)  # or one would see the rain above the roof
    assert rain.play((box(0, hall),), at=downwards).max() == 0.0
    assert (rain.play((), at=downwards) > 0.0).mean() > 0.02


def test_a_roof_in_wind_is_dry_on_its_lee_side(rain: Rain) -> None:
    """Wind along +x: the dry strip goes past the roof's edge at x = 8, and begins past x = -8."""
    sideways = camera((0.0, 1.7, 0.0), math.pi / 2)
    slope = 5.0 / fall_speed_of(25.0)

    def low_drops(*occluders: OccluderData) -> tuple[int, int, int]:
        """Falling below 1.5 m: on the windward side, in the shadow, and beyond it."""
        rain.play(occluders, wind=(5.0, 0.0, 0.0), at=sideways)
        p = rain.falling()
        x = p[(p[:, 1] < 1.5) & (np.abs(p[:, 2]) < 7.0), 0]
        first, last = -8.0 + 5.0 * slope + 0.5, 8.0 + 3.5 * slope - 0.5
        windward = (x > -16.0) & (x < -8.0 + 3.5 * slope)
        lee = (x > 8.0 + 5.0 * slope + 0.5) & (x < 18.0)
        return int(windward.sum()), int(((x > first) & (x < last)).sum()), int(lee.sum())

    windward, shadow, lee = low_drops(box(0, GROUND))
    assert min(windward, shadow, lee) > 4
    roofed = low_drops(box(0, GROUND), box(1, ROOF))
    assert roofed[1] == 0 and shadow > 50
    assert roofed[0] > 0.5 * windward
    assert roofed[2] > 0.2 * lee  # small drops, which slant more, meet the roof from farther off


def test_occluders_that_share_a_mesh_are_one_draw_and_those_outside_are_left_out(
    ctx: moderngl.Context,
) -> None:
    """A field of a thousand posts: one mesh on the GPU, only those in the map drawn."""
    shaders = ShaderLoader(ctx)
    meshes = OccluderMeshes(ctx, shaders)
    target = ctx.simple_framebuffer((64, 64))
    target.use()
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1]], np.float32)
    faces = np.array([0, 1, 2], np.uint32)
    field = []
    for k in range(1000):
        place = np.eye(4)
        place[:3, 3] = (k % 100 - 50.0) * 4.0, 0.0, (k // 100 - 5.0) * 4.0
        field.append(OccluderData(k, place, False, points, faces))
    # A map of 100 m about the origin.
    to_map = np.array([[0.02, 0, 0, 0], [0, 0, 0.02, 0], [0, 0.01, 0, 0], [0, 0, 0, 1.0]])
    within = [o for o in field if abs(o.transform[0, 3]) < 50]
    drawn = meshes.draw(field, to_map)
    assert len(meshes) == 1
    assert len(within) <= drawn <= len(within) + 20
    # One by one they are the same, in number and in place.
    seen = []
    ctx.enable_only(moderngl.DEPTH_TEST)
    for parts in ([field], [[post] for post in field]):
        target.clear(depth=1.0)
        assert sum(meshes.draw(part, to_map) for part in parts) == drawn
        seen.append(target.read(attachment=-1, components=1, dtype="f4"))
    assert seen[0] == seen[1] and len(set(np.frombuffer(seen[0], np.float32))) > 1
    ctx.enable_only(moderngl.NOTHING)
    meshes.release()
    shaders.release()
    for thing in (*target.color_attachments, target.depth_attachment, target):
        thing.release()


# The slope in gusts


def test_the_maps_slope_follows_gusts_in_few_steps_and_comes_to_rest():
    follower, used = SlopeFollower(), []
    for k in range(600):
        wind = 3.0 + 3.0 * min(max(math.sin(k / 60.0), 0.0), 1.0)
        wanted = fall_slope((wind, 0.0, 0.0), 6.5)
        used.append(follower.follow(wanted)[0])
        assert abs(used[-1] - wanted[0]) <= OFF + 1e-9
    steps = np.count_nonzero(np.diff(used))
    assert 4 <= steps <= 24  # and not some 90
    last = fall_slope((3.3, 0.0, 0.0), 6.5)
    follower.follow(last)
    assert [follower.follow(last) for _ in range(RESTED)][-1] == last


def test_a_sudden_change_of_the_wind_counts_at_once_and_steep_slopes_are_followed_less_closely():
    follower = SlopeFollower()
    assert follower.follow((0.3, 0.0)) == (0.3, 0.0)
    assert follower.follow((0.3, 0.2)) == (0.3, 0.2)
    assert follower.follow((0.38, 0.2)) == (0.3, 0.2)
    assert follower.follow((3.0, 0.0)) == (3.0, 0.0)
    assert follower.follow((3.2, 0.0)) == (3.0, 0.0)


def test_what_falls_slowly_comes_in_behind_things() -> None:
    wind = (8.0, 0.0, -6.0)
    rain, snow = fall_slope(wind, 6.0), fall_slope(wind, 1.2)
    assert rain == pytest.approx((8 / 6, -1.0), abs=0.011)
    assert snow == pytest.approx((0.6, -0.6))
    assert fall_slope((0.3, 0.0, 0.0), 1.2) == pytest.approx((0.24, 0.0), abs=0.011)
