"""Clouds' shadows on the ground: where the sun puts them, in a game's own shader."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tests.cloud_stage import CloudStage, cloud_stage, clouds, shape, sky_frame
from tests.worlds import fresh_world
from weather_ecs import Weather, glsl
from weather_ecs.errors import ContextError
from weather_ecs.frame import CloudLook, FrameData, SkyLight

HEIGHT = 800.0
VERTEX = "in vec3 place; out float share; void main() { share = weather_sunlight(place); }"


@pytest.fixture
def stage(ctx: moderngl.Context) -> Iterator[CloudStage]:
    with cloud_stage(ctx) as made:
        yield made


def sunlight(stage: CloudStage, places: Any) -> NDArray[np.float32]:
    """What a game's own shader reads at places (n, 3)."""
    ctx = stage.ctx
    stage.target.use()  # where there is no window, nothing runs without a framebuffer
    text = "#version 330\n" + glsl("cloud_shadow.glsl") + VERTEX
    program = ctx.program(vertex_shader=text, varyings=["share"])
    points = np.array(places, np.float32).reshape(-1, 3)
    source, found = ctx.buffer(points.tobytes()), ctx.buffer(reserve=4 * len(points))
    array = ctx.vertex_array(program, [(source, "3f", "place")])
    stage.renderer.cloud_shadow().use(program)
    array.transform(found, moderngl.POINTS, vertices=len(points))
    result = np.frombuffer(found.read(), np.float32).copy()
    for thing in (array, found, source, program):
        thing.release()
    return result


def one_cloud(direction: tuple[float, float, float], time: float = 0.0, **fields: Any) -> FrameData:
    sun = np.array(direction) / np.linalg.norm(direction)
    sky = SkyLight(sun_direction=tuple(sun.tolist()))
    row = {"position": (100.0 + 10.0 * time, HEIGHT, -300.0), "velocity": (10.0, 0.0, 0.0)}
    data = shape(size=(400.0, 150.0, 400.0), billboards=25, width=260.0)
    return sky_frame(clouds({**row, **fields}), data, sky=sky, time=time)


@pytest.mark.parametrize("direction", [(0.0, 1.0, 0.0), (0.5, 0.8, -0.3), (-0.7, 0.4, 0.2)])
def test_the_shadow_lies_where_the_sun_s_ray_through_the_cloud_meets_the_ground(
    stage: CloudStage, direction: tuple[float, float, float]
) -> None:
    stage.renderer.cloud_shadow()
    stage.draw(one_cloud(direction))
    slope = np.array(direction)[[0, 2]] / direction[1]
    middle = np.array([100.0, -300.0]) - slope * HEIGHT
    uphill = middle + slope * 60.0  # as the ray is 60 m higher
    places = [
        (middle[0], 0.0, middle[1]),
        (uphill[0], 60.0, uphill[1]),
        (middle[0] + 900.0, 0.0, middle[1] + 900.0),
        (middle[0] - 900.0, 0.0, middle[1] - 900.0),
    ]
    shade, higher, beside, other = sunlight(stage, places)
    assert shade < 0.4
    assert higher == pytest.approx(shade, abs=0.15)
    assert beside == other == 1.0


def test_it_moves_with_its_cloud_between_two_maps_and_with_new_ones(stage: CloudStage) -> None:
    stage.renderer.cloud_shadow()
    stage.draw(one_cloud((0.0, 1.0, 0.0)))
    for time in (0.5, 20.0, 60.0, 120.0):
        for _ in range(3):
            stage.draw(one_cloud((0.0, 1.0, 0.0), time=time))
        here = (100.0 + 10.0 * time, 0.0, -300.0)
        assert sunlight(stage, [here])[0] < 0.4
    assert sunlight(stage, [(100.0, 0.0, -300.0)])[0] == 1.0


def test_without_clouds_sun_or_the_wish_there_is_none(stage: CloudStage) -> None:
    here = [(100.0, 0.0, -300.0)]
    stage.renderer.cloud_shadow()
    assert sunlight(stage, here)[0] == 1.0
    stage.draw(one_cloud((0.0, 1.0, 0.0)))
    assert sunlight(stage, here)[0] < 0.4
    look = CloudLook(shadows=False)
    bare = one_cloud((0.0, 1.0, 0.0))
    stage.draw(sky_frame(bare.clouds, *bare.cloud_shapes, cloud_look=look))
    assert sunlight(stage, here)[0] == 1.0
    stage.draw(bare)
    assert sunlight(stage, here)[0] < 0.4
    stage.draw(FrameData())
    assert sunlight(stage, here)[0] == 1.0
    stage.draw(one_cloud((0.9, 0.0, 0.1)))  # the sun is at the horizon
    assert (sunlight(stage, [(x, 0.0, -300.0) for x in range(-3000, 3000, 100)]) == 1.0).all()


def test_a_map_rests_for_a_while_unless_sun_camera_or_someone_at_work_needs_a_new_one(
    stage: CloudStage,
) -> None:
    stage.renderer.cloud_shadow()
    up = (0.0, 1.0, 0.0)

    def new_maps(times: Any, sun: Any = lambda time: up, **camera: Any) -> int:
        """Among draws at these times, how many show another map than the draw before."""
        known, count = stage.passes.shadows.known(0), 0
        for time in times:
            before = known.texture
            stage.draw(one_cloud(sun(time), time=float(time)), **camera)
            count += known.texture is not before
        return count

    second = np.arange(0.0, 1.0, 0.05)
    new_maps([0.0], dt=0.05)
    often = len(second)
    assert new_maps(second, dt=0.05) in (2, 3, 4)
    assert new_maps(second, dt=0.0) == often  # while time stands still
    lower = [(float(np.sin(a)), float(np.cos(a)), 0.0) for a in 0.2 + 0.01 * np.arange(often)]
    assert new_maps(second, lambda time: lower[round(time / 0.05)], dt=0.05) == often
    assert new_maps([1.0, 1.05], lambda time: lower[-1], dt=0.05, position=(900.0, 2.0, 0.0)) == 1


def test_a_thin_or_small_cloud_takes_less(stage: CloudStage) -> None:
    stage.renderer.cloud_shadow()
    found = []
    for fields in ({}, {"opacity": 0.3}, {"growth": 0.4}):
        stage.draw(FrameData())
        stage.draw(one_cloud((0.0, 1.0, 0.0), **fields))
        grid = [
            (100.0 + x, 0.0, -300.0 + z) for x in range(-300, 301, 50) for z in range(-300, 301, 50)
        ]
        found.append(float(sunlight(stage, grid).mean()))
    assert found[0] < found[1] < 1.0
    assert found[0] < found[2] < 1.0


def test_nobody_asked_nothing_is_painted(stage: CloudStage) -> None:
    stage.draw(one_cloud((0.0, 1.0, 0.0)))
    assert stage.passes.shadows.known(0) is None


def test_the_weather_has_it_for_good(ctx: moderngl.Context) -> None:
    with fresh_world(), Weather(context=ctx, quality="low") as weather:
        assert weather.cloud_shadow() is weather.cloud_shadow()
    with fresh_world(), Weather() as blind, pytest.raises(ContextError):
        blind.cloud_shadow()
