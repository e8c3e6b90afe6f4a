"""Streaks: the vertex shader against its oracle, and both against what rain hides of the world."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import moderngl
import numpy as np
import pytest

from tests.rain_frames import area, camera, frame, lights, quality
from tests.streak_capture import Captured, StreakCapture, law_of, view_of
from weather_ecs.frame import ContainerData, DropLook, FogData, FrameData, SkyLight, ViewData
from weather_ecs.physics import rain_step, streak
from weather_ecs.physics.camera import Camera
from weather_ecs.physics.drops import drop_density, mean_cross_section
from weather_ecs.systems.rain_view import RainView

NORTH = math.pi / 2
SIZE = (320, 180)


class Scene(NamedTuple):
    """Drops that fall, and who sees them."""

    view: ViewData
    container: ContainerData
    p: np.ndarray
    v: np.ndarray


def scene(
    seen: FrameData, at: Camera, drops: int = 6000, velocity: tuple[float, float, float] = (0, 0, 0)
) -> Scene:
    """Drops where they begin, at their final speeds."""
    view = replace(RainView(3).view(seen, at, 0, quality(drops)), velocity=velocity)
    c = view.containers[0]
    zero = np.zeros((drops, 3), np.float32)
    first = rain_step.Step(
        c.axis, c.shape, c.axis, c.shape, (*seen.wind, 0.0), c.law, seed=1, fresh=0
    )
    p, v = rain_step.step(c.births, zero, zero, first)
    return Scene(view, c, p, v)


def expected(s: Scene, size: tuple[int, int] = SIZE) -> streak.Streaks:
    view, law = view_of(s.view, size[1]), law_of(s.container, s.view)
    return streak.streaks(s.p, s.v, s.container.births, view, law)


@pytest.fixture
def capture(ctx: moderngl.Context) -> Iterator[StreakCapture]:
    made = StreakCapture(ctx)
    yield made
    made.release()


def run(capture: StreakCapture, s: Scene, size: tuple[int, int] = SIZE) -> Captured:
    return capture.run(s.p, s.v, s.container.births, s.view, s.container, size)


LAMPS = lights(
    ((3.0, 3.0, 0.0), (6.0, 5.0, 3.0), 12.0),
    ((8.0, 1.0, -4.0), (0.0, 2.0, 9.0), 5.0),
    ((500.0, 1.0, 0.0), (9.0, 9.0, 9.0), 20.0),
)
SUN = SkyLight(sun_direction=(0.98, 0.198, 0.0), sun_color=(3.0, 2.0, 1.0))
INSIDE = area(soft_edge=25.0)
FAR = area(0, (0.0, -120.0), (70.0, 45.0), heading=0.4)
SCENES = {
    "near": scene(frame(INSIDE), camera()),
    "wind": scene(frame(INSIDE, wind=(9.0, 0.0, -4.0)), camera(heading=1.0)),
    "running": scene(frame(INSIDE), camera(), velocity=(4.0, 0.3, 2.0)),
    "lamps": scene(frame(INSIDE, lights=LAMPS), camera()),
    "towards the sun": scene(frame(INSIDE, sky=SUN), camera()),
    "away from the sun": scene(frame(INSIDE, sky=SUN), camera(heading=3.0)),
    "looking up": scene(frame(INSIDE), camera(pitch=1.2)),
    "looking down": scene(frame(INSIDE), camera((0.0, 9.0, 0.0), pitch=-0.9)),
    "at the edge, in": scene(frame(FAR), camera((0.0, 1.7, -80.0), NORTH)),
    "far": scene(frame(FAR), camera((0.0, 1.7, 60.0), NORTH)),
    "low ceiling": scene(frame(area(ceiling=9.0)), camera(pitch=0.2)),
    "hard edge": scene(frame(area(radii=(12.0, 7.0), soft_edge=0.0)), camera(heading=0.3)),
    "cloudburst": scene(frame(area(rain_rate=150.0)), camera()),
    "drizzle": scene(frame(area(rain_rate=0.3)), camera()),
    "begins": scene(frame(INSIDE, fronts={0: (70.0, 1e9, 0.0, 0.0)}), camera()),
    "has ended": scene(frame(INSIDE, fronts={0: (-1.0, 90.0, 0.0, 0.0)}), camera()),
    "a short one": scene(frame(INSIDE, fronts={0: (85.0, 1e9, -1.0, 60.0)}), camera()),
    "narrow angle": scene(frame(FAR), camera((0.0, 1.7, 60.0), NORTH, vertical=6.0)),
    "fog": scene(frame(INSIDE, lights=LAMPS, fog=FogData(0.1, (0.2, 0.3, 0.9))), camera()),
    "far, in haze": scene(frame(FAR, fog=FogData(0.01)), camera((0.0, 1.7, 60.0), NORTH)),
    "dark": scene(frame(INSIDE, sky=SkyLight(zenith_color=(0, 0, 0), horizon_color=(0, 0, 0),
                                             ground_color=(0, 0, 0))), camera()),
    "other looks": scene(
        frame(INSIDE, look=DropLook(reach=15.0, height=12.0, size_maximum=3.0, exposure=0.01,
                                    width=1.0, density=1.5, opacity=0.9)), camera()),
}  # fmt: skip


@pytest.mark.parametrize("name", SCENES)
def test_outputs_are_those_of_the_oracle(capture: StreakCapture, name: str) -> None:
    s = SCENES[name]
    found, wanted = run(capture, s), expected(s)
    assert np.isfinite(np.hstack([found.tail, found.head, found.color])).all()
    drawn, should = found.width > 0, wanted.width > 0
    assert should.sum() > 60, "the scene is one with streaks in it"
    assert (drawn != should).mean() < 2e-3  # those on a threshold, by rounding
    both = drawn & should
    for part in ("tail", "head"):
        clip = getattr(wanted, part)[both]
        off = np.abs(getattr(found, part)[both] - clip)
        assert (off <= 2e-5 * np.abs(clip[:, 3:]) + 2e-4).all(), part
    assert np.allclose(found.width[both], wanted.width[both], rtol=1e-4)
    assert np.allclose(found.color[both], wanted.color[both], rtol=2e-3, atol=2e-4)
    for outputs in (found.tail, found.head, found.color):
        assert not outputs[~drawn].any()


def test_what_has_landed_is_not_drawn(capture: StreakCapture) -> None:
    s = SCENES["near"]
    v = s.v.copy()
    v[::2] = (1.0, 8192.0 + 1.7, 2.0)  # where it hit, marked by the height
    found = capture.run(s.p, v, s.container.births, s.view, s.container)
    assert not found.width[::2].any()
    assert np.array_equal(found.width[1::2], run(capture, s).width[1::2])


def test_nothing_is_drawn_outside_its_area(capture: StreakCapture) -> None:
    """Whatever the container covers: from the edge, looking out, there is no rain ahead."""
    s = SCENES["hard edge"]
    found = run(capture, s)
    u = s.p[:, [0, 2]] / (12.0, 7.0)
    inside = (u * u).sum(axis=1) < 1.0
    assert found.width[inside].any() and not found.width[~inside].any()
    rim = area(0, (0.0, -120.0), (70.0, 45.0))
    out = scene(frame(rim), camera((0.0, 1.7, -75.4), -NORTH, 0.1))
    assert run(capture, out).width.max() == 0.0


# Ends, width, opacity, colour, each as a plain statement


def one(capture: StreakCapture, place: Any, velocity: Any, **rest: Any) -> tuple[Any, ...]:
    """One drop of 1.5 mm: (tail in pixels, head in pixels, width, colour)."""
    look = rest.pop("look", DropLook(width=4.0, opacity=1.0, size_maximum=1.0, density=1.0))
    observer = rest.pop("observer", (0.0, 0.0, 0.0))
    seen = frame(area(radii=(500.0, 500.0)), look=look, **rest)
    s = scene(seen, camera(), 8, observer)
    births = np.tile(s.container.births[:1], (8, 1))
    law = s.container.law
    births[:, 2] = 1.0
    births[:, 3] = (1.0 - math.exp(-(1.5 - 0.5) * law[0])) / law[1]
    p, v = np.tile(place, (8, 1)), np.tile(velocity, (8, 1))
    found = capture.run(p, v, births, s.view, s.container)
    ends = [c[0, :2] / c[0, 3] * (0.5 * SIZE[0], 0.5 * SIZE[1]) for c in (found.tail, found.head)]
    return (*ends, float(found.width[0]), found.color[0])


FOCAL = 90.0 / math.tan(math.radians(30.0))  # pixels, of the camera at 320 x 180


def test_a_streak_is_the_path_of_the_exposure(capture: StreakCapture) -> None:
    look = DropLook(exposure=0.05, width=4.0, opacity=1.0, size_maximum=1.0)
    tail, head, width, _ = one(capture, (10.0, 1.7, 0.0), (0.0, -6.0, 2.0), look=look)
    assert head == pytest.approx([0.0, 0.0], abs=1e-3)
    assert tail == pytest.approx(np.array([-2.0, 6.0]) * 0.05 * FOCAL / 10.0, abs=1e-3)
    assert width == pytest.approx(max(1.5e-3 * 4.0 * FOCAL / 10.0, 1.0))


def test_streaks_slant_towards_a_running_observer(capture: StreakCapture) -> None:
    """To who runs across, rain that falls straight comes from ahead."""
    still, _, _, _ = one(capture, (10.0, 1.7, 0.0), (0.0, -6.0, 0.0))
    tail, head, _, _ = one(capture, (10.0, 1.7, 0.0), (0.0, -6.0, 0.0), observer=(0.0, 0.0, 6.0))
    assert still[0] == pytest.approx(0.0, abs=1e-4)
    assert tail[0] - head[0] == pytest.approx(tail[1] - head[1])  # 45 degrees
    assert tail[0] > 0.0  # +z is to the right of +x


def test_lamps_light_the_drops_around_them(capture: StreakCapture) -> None:
    place, down = (6.0, 1.7, 0.0), (0.0, -6.0, 0.0)

    def light(*lamps: Any) -> np.ndarray:
        return one(capture, place, down, lights=lights(*lamps))[3][:3] ** 2.2

    dark = light()
    behind = light(((8.0, 1.7, 0.0), (2.0, 1.0, 0.0), 12.0)) - dark
    before = light(((4.0, 1.7, 0.0), (2.0, 1.0, 0.0), 12.0)) - dark
    farther = light(((10.0, 1.7, 0.0), (2.0, 1.0, 0.0), 12.0)) - dark
    gone = light(((20.0, 1.7, 0.0), (2.0, 1.0, 0.0), 12.0)) - dark
    assert behind[0] == pytest.approx(2.0 * behind[1], rel=1e-3) and abs(behind[2]) < 1e-5
    assert behind[0] > before[0] > 0.0  # drops throw light forward
    assert behind[0] > farther[0] > 0.0
    assert np.abs(gone).max() < 1e-5  # beyond its reach
    both = light(((8.0, 1.7, 0.0), (2.0, 1.0, 0.0), 12.0), ((8.0, 1.7, 0.0), (0, 0, 1.0), 12.0))
    assert both[2] - dark[2] == pytest.approx(behind[0] / 2.0, rel=1e-2)


def test_many_lamps_and_the_nearest_count(capture: StreakCapture) -> None:
    """More than the block holds: those that reach the observer go first."""
    place, down = (6.0, 1.7, 0.0), (0.0, -6.0, 0.0)
    near = ((6.0, 1.7, 1.0), (1.0, 1.0, 1.0), 12.0)
    crowd = [((900.0 + k, 1.7, 0.0), (1.0, 1.0, 1.0), 12.0) for k in range(40)]
    alone = one(capture, place, down, lights=lights(near))[3]
    found = one(capture, place, down, lights=lights(*crowd, near))[3]
    assert np.allclose(found, alone)


# What rain hides


def level_scene(rate: float, width: float, drops: int = 120_000) -> Scene:
    """Rain that falls straight past an observer who looks level, all of it drawn."""
    look = DropLook(reach=30.0, height=40.0, width=width, opacity=1.0, density=1.0)
    at = camera(vertical=40.0)
    return scene(frame(area(radii=(500.0, 500.0), rain_rate=rate), look=look), at, drops)


@pytest.mark.parametrize(("rate", "width"), [(3.0, 20.0), (6.0, 9.0), (25.0, 16.0)])
def test_area_times_opacity_is_the_rains_cross_section(rate: float, width: float) -> None:
    """Between two depths the streaks hide, per pixel, the cross-section per cubic metre times
    the depth: the optical depth of the rain, in any slice of the container, whatever the look."""
    s = level_scene(rate, width)
    o = expected(s, (1280, 720))
    depth, law = o.head[:, 3], law_of(s.container, s.view)
    share = 0.25 * math.pi * (rain_step.diameters(s.container.births[:, 3], law.law) * 1e-3) ** 2
    clipped = o.weight * share > o.area * o.solid * 1.0001
    middle = 0.5 * (o.head + o.tail)[:, :2] / np.maximum(depth, 1e-9)[:, None]
    inside = (np.abs(middle) < 1.0).all(axis=1) & (depth > 0.0)
    focal = 0.5 * 720 * float(s.view.projection[1, 1])
    for near, far in ((2.0, 8.0), (8.0, 14.0), (14.0, 19.0), (19.0, 24.0)):
        here = inside & (depth > near) & (depth < far)
        assert clipped[here].mean() < 2e-3
        hidden = (o.area * o.solid)[here] * (focal / depth[here]) ** 2 / (1280 * 720)
        deep = float(drop_density(rate) * mean_cross_section(rate)) * (far - near)
        scatter = math.sqrt((hidden**2).sum())
        assert hidden.sum() == pytest.approx(deep, rel=0.03, abs=3.0 * scatter), (near, far)
        assert scatter < 0.08 * deep


def test_opacity_is_clipped_at_the_looks_greatest() -> None:
    s = scene(frame(area(rain_rate=100.0), look=DropLook(opacity=0.3, width=9.0)), camera(), 500)
    o = expected(s)
    assert 0.25 < o.solid.max() <= 0.3
    assert (o.color[:, 3] <= 0.3 + 1e-9).all()
    # Small drops are fainter than that: of 0.5 mm the third power.
    size = rain_step.diameters(s.container.births[:, 3], s.container.law)
    greatest = 0.3 ** np.maximum(1.5 / size, 1.0)
    assert (o.solid <= greatest + 1e-6).all()
    fine = expected(s, (12_800, 7200))  # where nothing is thinner than a pixel
    full = (fine.width > 1.0) & (fine.solid > 0.999 * greatest)
    assert full.sum() > 50 and fine.solid[full].min() < 0.05


def test_what_is_drawn_is_what_the_vertex_shader_says(capture: StreakCapture) -> None:
    """The quads' pixels sum up to width times length times opacity times the profile's mean."""
    s = level_scene(25.0, 8.0, 30_000)
    found = run(capture, s)
    drawn = found.width > 0
    ends = [
        c[drawn, :2] / c[drawn, 3:] * (0.5 * SIZE[0], 0.5 * SIZE[1])
        for c in (found.tail, found.head)
    ]
    span, width = np.linalg.norm(ends[1] - ends[0], axis=1), found.width[drawn]
    length = np.maximum(span, width)
    middle = 0.5 * (ends[0] + ends[1])
    kept = (np.abs(middle) < (0.5 * SIZE[0], 0.5 * SIZE[1])).all(axis=1)
    ink = (length * width * found.color[drawn, 3])[kept].sum() * streak.PROFILE
    pixels = capture.opacity(s.p, s.v, s.container.births, s.view, s.container)
    assert pixels.sum() == pytest.approx(ink, rel=0.03)


@pytest.mark.parametrize("pitch", [-1.1, 0.0, 1.5])
@pytest.mark.parametrize("width", [5.0, 16.0])
def test_the_picture_hides_the_drops_cross_section_from_any_side(
    capture: StreakCapture, pitch: float, width: float
) -> None:
    """Pixels times opacity, as they are drawn, are what the real drops hide at their depths."""
    look = DropLook(reach=30.0, height=40.0, width=width, opacity=1.0, density=1.0)
    at, size = camera((0.0, 20.0, 0.0), pitch=pitch), (640, 360)
    s = scene(frame(area(radii=(500.0, 500.0), rain_rate=5.0), look=look), at, 60_000)
    o, law = expected(s, size), law_of(s.container, s.view)
    depth = np.maximum(o.head[:, 3], 1e-9)
    diameter = rain_step.diameters(s.container.births[:, 3], law.law) * 1e-3
    real = 0.25 * math.pi * diameter**2 * o.weight
    inside = (depth > 1.7) & (o.area * o.solid > 0.999 * real)  # and not cut at the greatest
    for end in (o.head, o.tail):
        ndc = end[:, :2] / np.maximum(end[:, 3:], 1e-9)
        inside &= (np.abs(ndc) < 0.9).all(axis=1) & (end[:, 3] > 0.1)
    focal = 0.5 * size[1] * float(s.view.projection[1, 1])
    # The others are still there, as drops of their own numbers, but nothing is to be seen of them.
    v = np.where(inside[:, None], s.v, [0.0, 9000.0, 0.0]).astype(np.float32)
    pixels = capture.opacity(s.p, v, s.container.births, s.view, s.container, size)
    assert inside.sum() > 1000
    hidden = (real * (focal / depth) ** 2)[inside].sum()
    assert pixels.sum() == pytest.approx(hidden, rel=0.03)


@pytest.mark.parametrize("width", [5.0, 1.5])
def test_a_coarser_picture_is_as_bright(capture: StreakCapture, width: float) -> None:
    """Streaks thinner than a pixel go into opacity, so that pixels of any size hold as much."""
    s = level_scene(60.0, width, 30_000)
    means, thin = [], []
    for size in ((640, 360), (320, 180), (160, 90)):
        births = s.container.births
        means.append(capture.opacity(s.p, s.v, births, s.view, s.container, size).mean())
        drawn = run(capture, s, size).width
        thin.append((drawn == 1.0).sum() / (drawn > 0.0).sum())
    assert means[0] > 0.003
    assert thin[-1] > 0.9 and thin[-1] > thin[0]  # most are thinner than a pixel in the end
    assert means[1:] == pytest.approx([means[0]] * 2, rel=0.05)
