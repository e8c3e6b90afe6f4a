"""The coarse sheet before the sky: the same picture as pixel for pixel, up to the silhouettes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import moderngl
import numpy as np
import pytest

from tests.rain_frames import area, camera, frame, quality
from weather_ecs.frame import VeilData, ViewData
from weather_ecs.gpu import veil_pass
from weather_ecs.gpu.renderer import Renderer
from weather_ecs.gpu.veil_list import MOST, important, nearest, rays, rectangle
from weather_ecs.gpu.veil_pass import halves
from weather_ecs.physics.camera import Camera
from weather_ecs.systems.rain_view import RainView

SIZE = (718, 401)  # no whole number of the sheet's texels
NORTH = math.pi / 2
CURTAIN = {"cloud": 1.0, "top": 200.0, "ragged": 0.8, "phase": 1.3, "drift": (0.4, -0.1)}
SHOWERS = [
    area(k, center, radii, rate, heading=0.4 * k, soft_edge=0.6 * radii[1], ceiling=1000.0)
    for k, (center, radii, rate) in enumerate(
        [
            ((1500.0, -6000.0), (1800.0, 1200.0), 12.0),
            ((-2500.0, -4500.0), (1500.0, 1400.0), 6.0),
            ((-800.0, -9000.0), (2500.0, 1500.0), 20.0),
            ((4000.0, -5000.0), (1600.0, 900.0), 3.0),
            ((0.0, 300.0), (2000.0, 1200.0), 2.0),
        ]
    )
]


def look(inside: bool) -> tuple[Camera, ViewData]:
    at = camera((0.0, 1.7, 0.0) if inside else (0.0, 1.7, 3000.0), NORTH, 0.12)
    view = RainView().view(frame(*SHOWERS), at, 0, quality(containers=0))
    assert len(view.veils) >= 4
    return at, replace(view, veils=tuple(replace(veil, **CURTAIN) for veil in view.veils))


class Picture:
    """A ground, a hill and thin posts with their depth, and what a renderer lays over them."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx, self.renderer = ctx, Renderer(ctx)
        self.color, self.depth = ctx.texture(SIZE, 4), ctx.depth_texture(SIZE)
        self.target = ctx.framebuffer([self.color], self.depth)

    def draw(self, at: Camera, view: ViewData) -> np.ndarray:
        width, height = SIZE
        x, y = np.meshgrid(np.arange(width), np.arange(height))
        t = np.where(y < 120, 1.7 / np.maximum((150 - y) * 0.003, 1e-3), np.inf)
        t[(y >= 120) & (y < 150 + 20 * np.sin(x / 40.0))] = 1500.0
        t[(x % 97 < 2) & (y < 300)] = 12.0
        p = at.projection
        with np.errstate(invalid="ignore"):
            stored = np.where(np.isinf(t), 1.0, ((-p[2, 2] * t + p[2, 3]) / t) * 0.5 + 0.5)
        sky = np.where(np.isinf(t)[..., None], (120, 130, 140, 255), (60, 70, 50, 255))
        self.color.write(sky.astype(np.uint8).tobytes())
        self.depth.write(stored.astype(np.float32).tobytes())
        self.target.use()
        self.renderer.draw(view, quality(containers=0))  # type: ignore[arg-type]
        pixels = np.frombuffer(self.target.read(components=3, alignment=1), np.uint8)
        return pixels.reshape(height, width, 3).astype(int)

    def release(self) -> None:
        self.renderer.release()
        for thing in (self.target, self.depth, self.color):
            thing.release()


@pytest.fixture
def picture(ctx: moderngl.Context) -> Iterator[Picture]:
    made = Picture(ctx)
    yield made
    made.release()


@pytest.mark.parametrize("inside", [False, True])
def test_the_sheet_is_not_seen(
    picture: Picture, inside: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nor are its texels at posts and hills: there is no halo."""
    at, view = look(inside)
    coarse = picture.draw(at, view)
    monkeypatch.setattr(veil_pass, "LARGE", 10_000)
    exact = picture.draw(at, view)
    bare = picture.draw(at, replace(view, veils=()))
    assert np.abs(exact - bare).max() > 20
    assert not np.array_equal(coarse, exact)  # the sheet was in use
    off = np.abs(coarse - exact).max(axis=2)
    assert np.percentile(off, 99.5) <= 2
    assert off.max() <= 16  # a pixel here and there, where something near meets what is far off


@pytest.mark.parametrize("away", [0.0, 25.0, 160.0])
@pytest.mark.parametrize("far", [False, True])
def test_a_small_area_is_drawn_where_the_scene_is_behind_it(
    picture: Picture, away: float, far: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same picture as over all of it."""
    at = camera((0.0, 1.7, 60.0 + away), NORTH, 0.12)
    shower = (
        area(1, (40.0, -400.0), (85.0, 48.0), 9.0, heading=1.3, soft_edge=30.0, ceiling=80.0)
        if far
        else area(0, (0.0, 0.0), (70.0, 45.0), 20.0, heading=0.3, soft_edge=12.0, ceiling=62.0)
    )
    view = RainView().view(frame(shower), at, 0, quality(containers=0))
    assert len(view.veils) == 1
    alone = picture.draw(at, view)
    monkeypatch.setattr(veil_pass, "LARGE", 10_000)
    whole = picture.draw(at, view)
    assert np.abs(whole - picture.draw(at, replace(view, veils=()))).max() > 10
    assert np.abs(alone - whole).max() <= 1


@pytest.mark.parametrize("inside", [False, True])
def test_one_wide_area_is_drawn_pixel_for_pixel(
    picture: Picture, inside: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two take the sheets, and so does one that begins."""
    at, view = look(inside)
    first, second = view.veils[:2]
    one = replace(view, veils=(first,))
    alone = picture.draw(at, one)
    monkeypatch.setattr(veil_pass, "LARGE", 10_000)
    whole = picture.draw(at, one)
    assert np.abs(whole - picture.draw(at, replace(view, veils=()))).max() > 10
    assert np.abs(alone - whole).max() <= 1
    changing = replace(first, dry=(20.0, 1e9, 0.0, 0.0))
    for veils, sheets in (((first,), 0), ((first, second), 2), ((changing,), 1)):
        assert len(halves(important(view, veils))[1]) == sheets


def test_without_veils_that_matter_nothing_is_drawn(picture: Picture) -> None:
    at, view = look(False)
    faint = tuple(replace(veil, extinction=1e-7) for veil in view.veils)
    bare = picture.draw(at, replace(view, veils=()))
    assert np.array_equal(picture.draw(at, replace(view, veils=faint)), bare)
    assert important(view, faint) == []


def test_the_most_important_are_drawn(picture: Picture) -> None:
    """Large, near and thick ones; of all that there may be, no more than MOST."""
    _, view = look(False)
    near = VeilData((0.0, 1500.0, 1.0, 0.0), (900.0, 800.0, 0.3), (-300.0, 900.0), 1e-3, 0.0)
    far = replace(near, axis=(0.0, -30_000.0, 1.0, 0.0))
    thin = replace(near, extinction=1e-5)
    many = [far] * 20 + [thin] * 20 + [near] * 3
    seen = important(view, many)
    assert len(seen) == MOST
    assert [each.veil is near for each in seen[:4]] == [True, True, True, False]
    assert seen[0].distance == pytest.approx(600.0)


def test_rays_and_rectangle_hold_every_pixel_with_rain(ctx: moderngl.Context) -> None:
    """A way from the camera to any place of a veil lies in the rectangle."""
    rng = np.random.default_rng(8)
    cut = behind = 0
    for _ in range(200):
        x, z = rng.uniform(-3000.0, 3000.0, 2)
        at = camera(
            (x, rng.uniform(0.0, 1500.0), z), rng.uniform(-3.0, 3.0), rng.uniform(-1.4, 1.4)
        )
        view = ViewData(
            frame(), 0, at.view, at.projection, at.position, (0.0, 0.0, 0.0), 0.0, (), ()
        )  # fmt: skip
        turn, (b, a) = rng.uniform(-3.0, 3.0), np.sort(rng.uniform(50.0, 1500.0, 2))
        axis = (0.0, 0.0, math.cos(turn), math.sin(turn))
        veil = VeilData(axis, (a, b, 0.4), (-300.0, 900.0), 0.01, 0.0)
        left, bottom, right, top = rectangle(view, important(view, [veil]))
        cut += (left, bottom, right, top) != (-1.0, -1.0, 1.0, 1.0)
        r, way = np.sqrt(rng.uniform(0.0, 1.0, 400)), rng.uniform(0.0, 2.0 * math.pi, 400)
        u, w = a * r * np.cos(way), b * r * np.sin(way)
        height = 900.0 - rng.exponential(500.0, 400)
        c, s = axis[2:]
        places = np.stack([u * c + w * s, height, w * c - u * s, np.ones(400)])
        px, py, _, depth = at.projection @ at.view @ places
        ahead = depth > 0.1
        px, py = px[ahead] / depth[ahead], py[ahead] / depth[ahead]
        shown = (np.abs(px) < 1.0) & (np.abs(py) < 1.0)
        px, py = px[shown], py[shown]
        assert ((px >= left) & (px <= right) & (py >= bottom) & (py <= top)).all()
        base, gain_x, gain_y = rays(view)
        found = base + px[:, None] * gain_x + py[:, None] * gain_y
        wanted = (places[:3].T - np.array(at.position))[ahead][shown] / depth[ahead][shown][:, None]
        assert found == pytest.approx(wanted, abs=1e-6)
        for each in important(view, [veil]):
            p = at.projection
            stored = (-p[2, 2] * depth[ahead][shown] + p[2, 3]) / depth[ahead][shown]
            first = nearest(view, each, (left, bottom, right, top))
            assert (stored >= first - 1e-9).all()
            behind += first > -1.0
    assert cut > 20
    assert behind > 20


def test_from_inside_nothing_is_left_out_that_is_seen() -> None:
    rng = np.random.default_rng(12)
    left_out = 0
    for _ in range(40):
        at = camera((0.0, 1.7, 0.0), rng.uniform(-3.0, 3.0), rng.uniform(-1.2, 1.2))
        view = ViewData(
            frame(), 0, at.view, at.projection, at.position, (0.0, 0.0, 0.0), 0.0, (), ()
        )  # fmt: skip
        shown = rng.choice([0.0, rng.uniform(1.0, 40.0)])
        axis, shape = (0.0, 0.0, 1.0, 0.0), (90.0, 60.0, 0.4)
        veil = VeilData(axis, shape, (-300.0, 900.0), rng.uniform(0.002, 0.2), shown)
        (each,) = important(view, [veil])
        first = nearest(view, each, (-1.0, -1.0, 1.0, 1.0))
        assert first < 1.0
        p = at.projection
        depth = p[2, 3] / (first + p[2, 2])  # of what is just left out
        left_out += first > -1.0  # beyond the near plane
        # In a corner of the picture it is farthest.
        base, gain_x, gain_y = np.array(rays(view))
        way = depth * np.linalg.norm(base + gain_x + gain_y)
        left = np.linspace(0.0, way, 2001)
        share = np.minimum(left / shown, 1.0) if shown else np.ones_like(left)
        if first > -1.0:
            assert veil.extinction * np.trapezoid(share, left) < 1.01 / 255.0
    assert left_out > 20
