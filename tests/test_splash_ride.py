"""Splashes on what moves: they go on with it, and lie on its surface in every frame."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import esper
import moderngl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.boxes import CORNERS, TRIANGLES, box, placed
from tests.heightmap_stage import REACH, Maps
from tests.splash_capture import SplashCapture, impacts
from tests.splash_views import LOOK, view_at
from tests.test_splash_companions import AGE, FEW, MANY, crowns
from tests.weather_pictures import stage
from weather_ecs.components import Occluder, RainArea, SplashEmitter, Wind
from weather_ecs.frame import OccluderData
from weather_ecs.gpu.impact_source import ImpactReader
from weather_ecs.gpu.occluder_motion import OccluderMotion
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics import ride

SEEN = ("vs_at", "vs_normal", "vs_form", "vs_throw", "vs_ridden")
LOOKS = ProgramKey(vertex="splash.vert", varyings=SEEN)


@given(st.lists(st.floats(-15.9, 15.9), min_size=3, max_size=3))
def test_a_velocity_is_kept_in_one_float(velocity: list[float]) -> None:
    numbers = ride.motion_bytes(np.array([velocity]))
    kept = np.float32(ride.packed(numbers))
    assert (ride.unpacked(kept) == numbers).all()
    assert np.abs(ride.motion_velocity(numbers) - velocity).max() <= 8.0 / 127.0 + 1e-9


def test_what_stands_still_is_nothing_and_what_was_put_elsewhere_too() -> None:
    for velocity in ((0.0, 0.0, 0.0), (0.0, 17.0, 1.0)):
        numbers = ride.motion_bytes(np.array([velocity]))
        assert ride.packed(numbers) == 0.0 and not ride.motion_velocity(numbers).any()
    assert not ride.motion_velocity(ride.unpacked(np.array([0.0]))).any()


@pytest.fixture
def maps(ctx: moderngl.Context) -> Iterator[Maps]:
    made = Maps(ctx)
    yield made
    made.release()


def motion(maps: Maps) -> np.ndarray:
    """(rows along z, columns along x, 3), m/s."""
    size = maps.map.size
    raw = np.frombuffer(maps.map.motion.read(), np.uint8).reshape(size, size, 4)
    return ride.motion_velocity(raw[..., :3])


def capture(maps: Maps, time: float, *occluders: OccluderData) -> bool:
    with maps.guard:
        at = (0.0, 1.7, 0.0)
        return maps.map.capture(occluders, at, REACH, (0.0, 0.0, 0.0), 8.0, time=time)


def turned(angle: float, height: float = 2.0) -> np.ndarray:
    """A bar of 10 by 0.4 by 1 m that turns about the z axis."""
    spin = np.eye(4)
    spin[:2, :2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
    spin[1, 3] = height
    return spin @ placed((0.0, 0.0, 0.0), (5.0, 0.2, 0.5))


def test_the_map_knows_how_fast_every_part_of_what_moves_is(maps: Maps) -> None:
    floor, other = box(0, placed((0, -1, 0), (30, 1, 30))), box(1, placed((0, 1, 9), (1, 1, 1)))
    capture(maps, 0.0, floor, other, box(2, turned(0.1), True))
    assert not motion(maps).any()
    capture(maps, 0.05, floor, other, box(2, turned(0.1 + 0.05 * 0.8), True))
    found = motion(maps)
    place = maps.map.footprint
    assert place is not None
    steps = ((np.arange(maps.map.size) + 0.5) / maps.map.size * 2.0 - 1.0) * place.half
    x, z = np.meshgrid(place.center[0] + steps, place.center[1] + steps)
    on = (np.abs(x) < 4.7) & (np.abs(z) < 0.4)
    assert on.sum() > 30 and not found[(np.abs(x) > 5.3) | (np.abs(z) > 0.8)].any()
    # v = w r: upwards with x, and aside with the height above the axis.
    assert np.abs(found[on][:, 1] - 0.8 * x[on]).max() < 0.13
    rise = x[on] * math.tan(0.14) + 0.2 / math.cos(0.14)
    assert np.abs(found[on][:, 0] + 0.8 * rise).max() < 0.13
    assert not found[..., 2].any()


def test_what_has_come_to_rest_is_seen_to_rest(maps: Maps) -> None:
    first, last = box(2, turned(0.1), True), box(2, turned(0.14), True)
    capture(maps, 0.0, first)
    capture(maps, 0.05, last)
    # Between two moves of a game that makes few of them it has not stopped.
    assert not capture(maps, 0.10, last) and motion(maps).any()
    assert capture(maps, 0.16, last) and not motion(maps).any()
    assert not capture(maps, 1.0, last)
    # A pause, and a clock that was set back, are no speed.
    capture(maps, 1.0, box(2, turned(0.2), True))
    capture(maps, 0.5, box(2, turned(0.3), True))
    assert not motion(maps).any()
    # From there on it goes on.
    capture(maps, 0.55, box(2, turned(0.34), True))
    assert motion(maps).any()


def test_those_that_share_a_mesh_have_speeds_of_their_own(maps: Maps) -> None:
    def row(time: float) -> list[OccluderData]:
        speeds = enumerate((0.0, 1.0, -2.0, 40.0))
        return [box(k, placed((6 * k - 9, 2 + v * time, 0), (1, 1, 1)), True) for k, v in speeds]

    capture(maps, 0.0, *row(0.0))
    capture(maps, 0.1, *row(0.1))
    found, place = motion(maps), maps.map.footprint
    assert place is not None
    for k, expected in enumerate((0.0, 1.0, -2.0, 0.0)):  # the last was put elsewhere
        u, v, _ = (place.matrix() @ (6 * k - 9, 2.0, 0.0, 1.0))[:3]
        at = found[int(v * maps.map.size), int(u * maps.map.size)]
        assert at == pytest.approx((0.0, expected, 0.0), abs=0.064)


def seen_on_the_bar(ctx: moderngl.Context, backend: str, dt: float) -> list[tuple[np.ndarray, ...]]:
    """In each of the last frames: turn of the bar, and places and ages of the splashes on it."""
    frames = []
    with stage(ctx, backend=backend, quality="medium") as it:
        esper.create_entity(RainArea((0, 0), (60, 40), 120.0))
        esper.create_entity(Wind((1.0, 0.0), 0.0))
        esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((0, -1, 0), (50, 1, 50))))
        esper.create_entity(SplashEmitter())
        bar = Occluder(CORNERS, TRIANGLES, turned(-0.3), dynamic=True)
        esper.create_entity(bar)
        renderer = it.weather._renderer
        assert renderer is not None
        shaders = ShaderLoader(ctx)
        reader = ImpactReader(ctx, shaders, renderer._rain, "ride", LOOKS)
        layers, drawn = renderer._layers, renderer._layers._draw_splashes
        rows: list[np.ndarray] = []

        def transform(array: moderngl.VertexArray, count: int) -> None:
            out = ctx.buffer(np.zeros((count, 16), np.float32))
            array.transform(out, moderngl.POINTS, vertices=count)
            rows.append(np.frombuffer(out.read(), np.float32).reshape(-1, 16).copy())
            out.release()

        def and_read(view: Any, sheltered: bool) -> None:
            drawn(view, sheltered)
            reader.run(view, transform)

        layers._draw_splashes = and_read  # type: ignore[method-assign]
        for k in range(round(1.2 / dt)):
            angle = -0.3 + 0.6 * k * dt
            bar.transform = turned(angle)
            esper.process(dt)
            rows.clear()
            it.draw(position=(0.0, 3.0, 7.0), heading=math.pi / 2, pitch=-0.1)
            if k * dt > 0.8:
                found = np.concatenate(rows)
                at, form, throw = found[:, :3], found[:, 6:10], found[:, 10:13]
                shown = (form[:, 0] > 0.0) & (throw[:, 1] < 0.3)
                frames.append((np.array(angle), at[shown], throw[shown, 1], found[shown, 13:]))
        reader.release()
        shaders.release()
    return frames


@pytest.mark.parametrize("dt", [1 / 60, 1 / 20])
def test_splashes_lie_on_what_turns_in_the_frame_in_which_they_are_drawn(
    ctx: moderngl.Context, backend: str, dt: float
) -> None:
    count, off, far = 0, [], []
    for angle, at, age, _ in seen_on_the_bar(ctx, backend, dt):
        inverse = np.linalg.inv(turned(float(angle))[:3, :3] / (5.0, 0.2, 0.5))
        local = (at - (0.0, 2.0, 0.0)) @ inverse.T
        on = (np.abs(local[:, 0]) < 4.5) & (np.abs(local[:, 2]) < 0.4) & (at[:, 1] > 0.5)
        count += int(on.sum())
        off += np.abs(local[on, 1] - 0.2).tolist()
        far += np.abs(0.6 * local[on, 0] * age[on]).tolist()
    assert count > 60
    # The parts that were hit have gone on by so much since; the splashes are still on them.
    assert np.percentile(far, 90) > 0.2
    # With feedback the step of the hit is known, and not the moment.
    assert np.percentile(off, 90) < (0.04 if backend == "compute" else 0.1) and max(off) < 0.2


def test_what_rides_is_brought_onto_the_surface_and_what_stands_is_not(ctx: moderngl.Context):
    made = SplashCapture(ctx)
    try:
        speed = ride.packed(ride.motion_bytes(np.array([[3.0, 0.0, 0.0]])))
        gone = ride.motion_velocity(ride.motion_bytes(np.array([3.0, 0.0, 0.0])))[0] * AGE
        for lift, number, shown in ((0.13, speed, 1), (0.5, speed, 1), (0.25, 0.0, 0)):
            records = impacts(1, time=100.0 - AGE, weight=FEW, ride=number)
            records["position"] = (-gone if number else 0.0, lift, 0.0)
            found = crowns(made.quads(records, view_at(), LOOK))
            assert len(found) == shown
            if shown:
                level = impacts(1, time=100.0 - AGE, weight=FEW)
                level["position"] = (0.0, 0.0, 0.0)
                same = crowns(made.quads(level, view_at(), LOOK))
                # What the map has not seen rides on; it is brought onto what is near.
                assert (np.abs(found - same).max() < 1e-3) == (lift < 0.2)
    finally:
        made.release()


def test_the_smaller_ones_ride_on_what_is_at_their_place(ctx: moderngl.Context):
    made = SplashCapture(ctx)
    try:
        view, speed = view_at((0.0, 2.5, 3.0), -0.7), (2.0, 0.0, 0.0)
        numbers = ride.motion_bytes(np.array([speed]))
        velocity, records = ride.motion_velocity(numbers)[0], impacts(12, weight=MANY)
        records["time"] = 100.0 - AGE

        def places() -> np.ndarray:
            found = crowns(made.quads(records, view, LOOK))
            return 0.5 * (found.min(axis=1) + found.max(axis=1))[:, :2]

        still = places()
        made.move(speed)
        moved = places()
        assert len(still) == len(moved) > 40
        # To the right in the picture, by no more than they can have gone since they were there.
        way = moved[:, 0] - still[:, 0]
        limit = velocity[0] * AGE / 2.4 * view.projection[0, 0]
        assert (way > 1e-3).sum() > 30 and way.min() > -0.02 and way.max() < limit
        own = np.abs(way) < 1e-6  # the twelve that nothing is known to carry
        assert 12 <= own.sum() < 24
    finally:
        made.release()


def test_many_are_seen_as_one_is() -> None:
    rng = np.random.default_rng(3)
    speeds = np.where(rng.random((40, 1)) < 0.3, 0.0, rng.normal(0.0, 2.0, (40, 3)))

    def at(k: int, time: float) -> OccluderData:
        return box(k, turned(time * speeds[k, 1], speeds[k, 0] * time), True)

    together = OccluderMotion()
    for time in (0.0, 0.03, 0.03, 0.05):
        everything = [at(k, time) for k in range(40)]
        together.follow(everything, time)
    for k in range(40):
        alone = OccluderMotion()
        for time in (0.0, 0.03, 0.03, 0.05):
            one = at(k, time)
            alone.follow([one], time)
        assert together.of(everything[k]) == pytest.approx(alone.of(one), abs=1e-9)
        assert alone.moves == bool(speeds[k].any())
