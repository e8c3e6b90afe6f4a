"""Nothing pops on a walk through the perimeter: rain-covered share and mean change smoothly.

What drops show flickers by nature, by chance: each walk is done with several seeds, and what a
frame adds, over all of them, is held against that grain. A pop is where the container, its drops
or the veil jump, and so is in all of them at the same place.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import moderngl
import numpy as np
import pytest

from tests.rain_frames import area, camera, frame, quality
from weather_ecs.gpu.renderer import Renderer
from weather_ecs.physics.ellipse import nearest_perimeter_point
from weather_ecs.systems.rain_view import RainView

SIZE = (128, 72)
NORTH = math.pi / 2  # the heading of -z
AREA = area(0, (0.0, -70.0), (70.0, 45.0), soft_edge=12.0)  # its rim is at z = -25
TURNED = area(0, (0.0, -70.0), (90.0, 30.0), heading=0.6, soft_edge=8.0)
EMPTY = np.array([77.0, 84.0, 77.0])
SEEDS = 5
NOTICED = 6.0  # times the grain
UNEVEN = 0.025
POP = {"share": 0.45, "mean": 0.45, "with the veil": 0.1}  # of the greatest value


class Walk(NamedTuple):
    """A straight way past which frames are drawn."""

    area: tuple
    start: tuple[float, float]  # (x, z), m
    end: tuple[float, float]
    heading: float
    speed: float  # m/s
    fps: float = 12.0

    def places(self) -> np.ndarray:
        way = math.dist(self.start, self.end)
        steps = int(way / self.speed * self.fps)
        return np.linspace(self.start, self.end, steps)


class Camera:
    """Draws one walk after another with the same renderer, each with an observer of its own."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.renderer = Renderer(ctx)
        self.color, self.depth = ctx.texture(SIZE, 4), ctx.depth_texture(SIZE)
        self.target = ctx.framebuffer([self.color], self.depth)

    def curves(self, walk: Walk, seed: int, veil: bool) -> np.ndarray:
        """(3, frames): share of pixels that drops cover, mean of that, mean with the veil."""
        views, choice, found = RainView(seed), quality(6000), []
        places = walk.places()
        warm_up = 15
        for k in range(-warm_up, len(places)):
            x, z = places[max(k, 0)]
            at = camera((x, 1.7, z), walk.heading, 0.05)
            seen = frame(walk.area, time=(k + warm_up) / walk.fps, wind=(3.0, 0.0, 0.0))
            view = views.view(seen, at, seed, choice)
            bare = self._cover(replace(view, veils=()), choice)
            whole = self._cover(view, choice).mean() if veil else 0.0
            if k >= 0:
                found.append(((bare > 3).mean(), bare.mean(), whole))
        self.renderer.forget(seed)
        return np.array(found).T

    def _cover(self, view: object, choice: object) -> np.ndarray:
        self.target.use()
        self.target.clear(*(EMPTY / 255.0), 1.0)
        self.renderer.draw(view, choice)  # type: ignore[arg-type]
        pixels = np.frombuffer(self.target.read(components=3), np.uint8)
        return np.abs(pixels.reshape(-1, 3) - EMPTY).max(axis=1)

    def release(self) -> None:
        self.renderer.release()
        for thing in (self.target, self.depth, self.color):
            thing.release()


@pytest.fixture
def walker(ctx: moderngl.Context) -> Iterator[Camera]:
    made = Camera(ctx)
    yield made
    made.release()


def jumps(curves: np.ndarray) -> np.ndarray:
    """What each frame adds in all of the curves (seeds, frames); 1 is what may just pass.

    That is NOTICED times the grain around it, and a share of the whole for the walk itself, whose
    own progress a frame is not quite even.
    """
    steps = np.diff(curves, axis=1)
    common, found = np.median(steps, axis=0), np.zeros(steps.shape[1])
    for k in range(len(found)):
        around = steps[:, max(k - 10, 0) : k + 11]
        trend = np.median(around)
        grain = 1.25 * 1.4826 * np.median(np.abs(around - trend)) / math.sqrt(len(curves))
        found[k] = abs(common[k] - trend) / (NOTICED * grain + UNEVEN * curves.max())
    return found


WALKS = {
    "in, running": Walk(AREA, (0.0, -3.0), (0.0, -45.0), NORTH, 6.0),
    "out, running": Walk(AREA, (0.0, -50.0), (0.0, -8.0), -NORTH, 6.0),
    "in, walking": Walk(AREA, (0.0, -20.5), (0.0, -30.0), NORTH, 1.4),
    "out, looking back, walking": Walk(AREA, (0.0, -30.0), (0.0, -20.5), NORTH, 1.4),
    "aslant into a turned one": Walk(TURNED, (-44.0, -16.0), (-10.0, -50.0), 0.9, 6.0),
}


@pytest.mark.parametrize("name", WALKS)
def test_a_walk_through_the_perimeter_has_no_pop(walker: Camera, name: str) -> None:
    walk = WALKS[name]
    found = np.array([walker.curves(walk, seed, veil=seed < 2) for seed in range(SEEDS)])
    share, mean, whole = found[:, 0], found[:, 1], found[:2, 2]
    assert share.max() > 0.05 and whole.max() > 5.0  # there is rain to be seen
    for what, curves in (("share", share), ("mean", mean), ("with the veil", whole)):
        seen = jumps(curves)
        worst = int(seen.argmax())
        assert seen[worst] < 1.0, (what, walk.places()[worst], seen[worst])
        # The measure would notice, wherever it were.
        for frame_of_pop in np.linspace(15, curves.shape[1] - 15, 5).astype(int):
            popped = curves.copy()
            popped[:, frame_of_pop:] += POP[what] * curves.max()
            assert jumps(popped)[frame_of_pop - 1] > 1.0, (what, frame_of_pop)


def test_the_share_grows_inward_and_shrinks_outward(walker: Camera) -> None:
    """Across the rim, looking at the rain, it becomes more and more until one is in its middle."""
    places = [(0.0, 200.0), (0.0, 40.0), (0.0, -10.0), (0.0, -24.0), (0.0, -40.0)]
    shares = [
        walker.curves(Walk(AREA, p, (p[0], p[1] - 1.0), NORTH, 1.0), 0, veil=False)[0].mean()
        for p in places
    ]
    assert all(after > 0.95 * before for before, after in itertools.pairwise(shares))
    assert shares[0] < 0.5 * shares[-1]


@pytest.mark.parametrize("shape", [AREA, TURNED])
def test_who_looks_out_from_the_edge_sees_no_rain(walker: Camera, shape: tuple) -> None:
    """Whatever the container covers, no drop is drawn outside its ellipse."""
    _, center, radii, heading, *_ = shape
    for azimuth in np.arange(0.0, 2.0 * math.pi, 1.3):
        out = (math.cos(azimuth), -math.sin(azimuth))
        beyond = (center[0] + 300.0 * out[0], center[1] + 300.0 * out[1])
        rim = nearest_perimeter_point(beyond, center, radii, heading)
        normal = np.array(beyond) - rim
        normal /= np.linalg.norm(normal)
        look = math.atan2(-normal[1], normal[0])
        for distance in (-0.2, 0.2, 3.0, 25.0):
            start = rim + normal * distance
            walk = Walk(shape, tuple(start), tuple(start + normal * 0.4), look, 1.4)
            share, mean, whole = walker.curves(walk, 1, veil=True)
            assert share.max() == 0.0
            assert mean.max() < 0.02 and whole.max() < 1.0
