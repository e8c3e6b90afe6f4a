"""The collision heightmap: what rain meets first, against rays; and what stays dry below it."""

from __future__ import annotations

import logging
import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, box, highest, placed
from tests.rain_frames import area, camera, frame, quality
from weather_ecs.components import Occluder
from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import DropLook, OccluderData
from weather_ecs.gpu.context import probe
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.heightmap import Heightmap, fall_speed_of
from weather_ecs.gpu.occluder_meshes import OccluderMeshes
from weather_ecs.gpu.renderer import Renderer
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.physics.drops import diameter_quantile, terminal_speed
from weather_ecs.physics.footprint import OFF, RESTED, SlopeFollower, fall_slope
from weather_ecs.systems.rain_view import RainView

SIZE = 128
REACH = 20.0  # so that a texel is 2 * 1.25 * 20 / 128 = 0.39 m
HERE = (3.0, 1.7, -5.0)


class Maps:
    """A heightmap with all it needs; captures as a renderer does, inside a guard."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.guard = StateGuard(ctx)
        self.shaders = ShaderLoader(ctx)
        self.meshes = OccluderMeshes(ctx, self.shaders)
        self.map = Heightmap(ctx, self.guard, self.meshes, SIZE)

    def capture(
        self,
        *occluders: OccluderData,
        position: tuple[float, float, float] = HERE,
        wind: tuple[float, float, float] = (0.0, 0.0, 0.0),
        fall_speed: float = 8.0,
    ) -> bool:
        with self.guard:
            return self.map.capture(occluders, position, REACH, wind, fall_speed)

    @property
    def counts(self) -> tuple[int, int]:
        """Captures of the static layer, and of all."""
        return self.map.static_captures, self.map.captures

    def depth(self) -> np.ndarray:
        """(rows along z, columns along x)."""
        return np.frombuffer(self.map.texture.read(), np.float32).reshape(SIZE, SIZE)

    def heights(self) -> np.ndarray:
        """World height of the surface, -inf where there is none."""
        place = self.map.footprint
        assert place is not None
        depth = self.depth().astype(np.float64)
        surface = place.top + depth * (place.bottom - place.top)
        return np.where(depth >= 1.0, -np.inf, surface)

    def texels(self) -> np.ndarray:
        """Where the lines of fall through the texels' middles pass height 0, (SIZE, SIZE, 2)."""
        place = self.map.footprint
        assert place is not None
        steps = ((np.arange(SIZE) + 0.5) / SIZE * 2.0 - 1.0) * place.half
        x, z = np.meshgrid(place.center[0] + steps, place.center[1] + steps)
        return np.stack([x, z], axis=-1)

    def at(self, x: float, z: float, y: float = 0.0) -> float:
        """World height of what keeps the rain off a place at height y."""
        place = self.map.footprint
        assert place is not None
        u, v, _ = (place.matrix() @ (x, y, z, 1.0))[:3]
        return round(float(self.heights()[int(v * SIZE), int(u * SIZE)]), 3)

    def release(self) -> None:
        for thing in (self.map, self.meshes, self.shaders, self.guard):
            thing.release()


@pytest.fixture
def maps(ctx: moderngl.Context) -> Iterator[Maps]:
    made = Maps(ctx)
    yield made
    made.release()


def village(seed: int, count: int) -> list[np.ndarray]:
    """Boxes of all sizes, heights and turns around the observer."""
    rng = np.random.default_rng(seed)
    return [
        placed(
            (HERE[0] + rng.uniform(-25, 25), rng.uniform(-2, 15), HERE[2] + rng.uniform(-25, 25)),
            tuple(rng.uniform(0.5, 5.0, 3).tolist()),
            rng.uniform(-3, 3),
            rng.uniform(-0.6, 0.6),
        )
        for _ in range(count)
    ]


def assert_as_rays(maps: Maps, transforms: list[np.ndarray]) -> None:
    """Every texel has the height that its line of fall meets; those on an edge may differ."""
    place = maps.map.footprint
    assert place is not None
    expected = highest(maps.texels().reshape(-1, 2), place.slope, transforms)
    expected = np.where(expected < place.bottom, -np.inf, np.minimum(expected, place.top))
    found = maps.heights().ravel()
    same = found == expected
    both = np.isfinite(found) & np.isfinite(expected)
    same[both] = np.abs(found[both] - expected[both]) < 0.01
    assert same.mean() > 0.995
    assert np.isfinite(expected).mean() > 0.005


# The capture


@pytest.mark.parametrize("wind", [(0.0, 0.0, 0.0), (6.0, 0.0, 0.0), (-4.0, 0.0, 9.0)])
def test_the_map_is_what_falling_lines_meet(maps: Maps, wind: tuple[float, float, float]) -> None:
    transforms = village(1, 14)
    assert maps.capture(*[box(k, t) for k, t in enumerate(transforms)], wind=wind)
    place = maps.map.footprint
    assert place is not None
    assert place.slope == pytest.approx((wind[0] / 8.0, wind[2] / 8.0), abs=0.011)
    assert_as_rays(maps, transforms)


def test_it_covers_the_observers_rain_whatever_its_height(maps: Maps) -> None:
    for wind in ((0.0, 0.0, 0.0), (10.0, 0.0, -10.0)):
        for y in (1.7, 40.0, -30.0):
            position = (100.0, y, -70.0)
            maps.capture(box(0, placed(position, (1, 1, 1))), position=position, wind=wind)
            place = maps.map.footprint
            assert place is not None
            for dx, dz in ((REACH, 0.0), (0.0, -REACH), (-REACH, 0.0)):
                u, v, depth = (place.matrix() @ (100.0 + dx, y, -70.0 + dz, 1.0))[:3]
                assert 0.0 < u < 1.0 and 0.0 < v < 1.0 and 0.0 < depth < 1.0


def test_what_stands_above_the_map_keeps_the_rain_off(maps: Maps) -> None:
    """A bridge far overhead, and a cellar far below, which nothing needs."""
    maps.capture(
        box(0, placed((3.0, 400.0, -5.0), (4.0, 1.0, 4.0))),
        box(1, placed((15.0, -300.0, -5.0), (4.0, 1.0, 4.0))),
    )
    place = maps.map.footprint
    assert place is not None
    assert maps.at(3.0, -5.0) == pytest.approx(place.top)
    assert maps.at(15.0, -5.0) == -math.inf


def test_the_lee_side_lies_in_the_rain_shadow(maps: Maps) -> None:
    """A thin roof 8 m up, wind along +x as fast as the fall: 45 degrees."""
    roof = box(0, placed((3.0, 8.0, -5.0), (2.0, 0.01, 2.0)))
    maps.capture(roof, wind=(8.0, 0.0, 0.0), fall_speed=8.0)
    dry = [x for x in np.arange(-10.0, 20.0, 0.5) if maps.at(x, -5.0, 0.0) > 0.0]
    assert dry[0] == pytest.approx(3.0 + 8.0 - 2.0, abs=0.6)
    assert dry[-1] == pytest.approx(3.0 + 8.0 + 2.0, abs=0.6)
    # Half way up, the shadow is half as far off.
    half_way = [x for x in np.arange(-10.0, 20.0, 0.5) if maps.at(x, -5.0, 4.0) > 4.0]
    assert half_way[0] == pytest.approx(3.0 + 4.0 - 2.0, abs=0.6)


def test_the_fall_is_that_of_the_median_drop() -> None:
    for rate in (1.0, 25.0, 100.0):
        d = np.sort(diameter_quantile(np.linspace(0, 1, 20001)[:-1], rate))
        water = np.cumsum(d**3)
        median = d[np.searchsorted(water, 0.5 * water[-1])]
        assert fall_speed_of(rate) == pytest.approx(float(terminal_speed(median)), rel=0.12)
    assert fall_speed_of(0.0) > 0.0


# What is captured again, and what is not


def test_the_static_layer_is_kept(maps: Maps) -> None:
    house, tree = box(0, placed(HERE, (2, 2, 2))), box(1, placed((9.0, 1.0, 0.0), (1, 5, 1)))
    walker = box(2, placed((0.0, 1.0, 0.0), (0.4, 0.9, 0.4)), dynamic=True)
    assert maps.capture(house, tree, walker)
    assert maps.counts == (1, 1)
    assert not maps.capture(house, tree, walker)
    assert maps.counts == (1, 1)
    for k in range(1, 5):
        moved = replace(walker, transform=placed((0.5 * k, 1.0, 0.0), (0.4, 0.9, 0.4)))
        assert maps.capture(house, tree, moved)
        assert maps.counts == (1, 1 + k)
        assert maps.at(0.5 * k, 0.0) == pytest.approx(1.9)
        assert maps.at(0.5 * k - 1.0, 0.0) == -math.inf  # nothing stays where it was
        assert maps.at(9.0, 0.0) == pytest.approx(6.0)
    maps.capture(house, tree)
    assert maps.counts == (1, 6) and maps.at(2.0, 0.0) == -math.inf


def test_dynamic_and_static_the_higher_one_counts(maps: Maps) -> None:
    roof = box(0, placed((0.0, 6.0, 0.0), (2, 0.5, 2)))
    for y, expected in ((3.0, 6.5), (9.0, 10.0)):
        maps.capture(roof, box(1, placed((0.0, y, 0.0), (1, 1, 1)), dynamic=True))
        assert maps.at(0.0, 0.0) == pytest.approx(expected)


def test_whatever_changes_is_seen(maps: Maps) -> None:
    house = box(0, placed((0.0, 2.0, 0.0), (2, 2, 2)))
    maps.capture(house)
    moved = replace(house, transform=placed((5.0, 2.0, 0.0), (2, 2, 2)))
    assert maps.capture(moved) and maps.at(5.0, 0.0) == pytest.approx(4.0)
    lower = replace(moved, vertices=(CORNERS * np.float32(0.5)).copy())
    assert maps.capture(lower) and maps.at(5.0, 0.0) == pytest.approx(3.0)
    floor = replace(lower, indices=TRIANGLES[12:18].copy())  # one face alone
    assert maps.capture(floor) and maps.at(5.0, 0.0) == pytest.approx(1.0)
    assert maps.capture(floor, house) and maps.at(0.0, 0.0) == pytest.approx(4.0)
    assert maps.capture(floor) and maps.at(0.0, 0.0) == -math.inf
    swapped = replace(floor, dynamic=True)
    assert maps.capture(swapped) and maps.at(5.0, 0.0) == pytest.approx(1.0)


def test_moves_inside_the_margin_capture_nothing(maps: Maps) -> None:
    still = [box(k, t) for k, t in enumerate(village(2, 6))]
    maps.capture(*still)
    for dx, dy, dz in ((0.19, 0.0, 0.0), (0.0, 0.0, -0.19), (-0.1, 0.9, 0.1), (0.0, -0.9, 0.0)):
        position = (HERE[0] + dx * REACH, HERE[1] + dy * REACH, HERE[2] + dz * REACH)
        assert not maps.capture(*still, position=position)
    # Nor does a breath of wind.
    assert not maps.capture(*still, wind=(0.05, 0.0, -0.05))
    assert maps.counts == (1, 1)
    assert maps.capture(*still, wind=(2.0, 0.0, 0.0)) and maps.counts == (2, 2)


@pytest.mark.parametrize("wind", [(0.0, 0.0, 0.0), (5.0, 0.0, -3.0)])
def test_a_map_that_moves_shows_every_place_as_before(maps: Maps, wind: Any) -> None:
    """It moves by whole texels, so that no edge of a shadow crawls."""
    still = [box(k, t) for k, t in enumerate(village(3, 14))]
    maps.capture(*still, wind=wind)
    before, first = maps.depth().copy(), maps.map.footprint
    position = (HERE[0] + 7.3, HERE[1], HERE[2] - 5.1)
    assert maps.capture(*still, position=position, wind=wind)
    after, second = maps.depth(), maps.map.footprint
    assert first is not None and second is not None
    texel = 2.0 * first.half / SIZE
    shift = (np.array(second.center) - first.center) / texel
    columns, rows = np.rint(shift).astype(int).tolist()
    assert np.allclose(shift, (columns, rows), atol=1e-6)
    assert (columns, rows) != (0, 0)
    old = before[max(rows, 0) : SIZE + min(rows, 0), max(columns, 0) : SIZE + min(columns, 0)]
    new = after[max(-rows, 0) : SIZE + min(-rows, 0), max(-columns, 0) : SIZE + min(-columns, 0)]
    assert old.shape == new.shape and (old < 1.0).mean() > 0.05
    # But for rounding, which may put a texel's middle to either side of an edge.
    assert (np.abs(old - new) < 1e-5).mean() > 0.999


# Callbacks of the game


def drawing(maps: Maps, transform: np.ndarray, calls: list[np.ndarray]) -> Any:
    """A callback that draws a box by itself, with the matrix it is given."""
    mesh = box(77, transform)

    def draw(matrix: np.ndarray) -> None:
        calls.append(matrix)
        maps.meshes.draw([mesh], matrix)

    return draw


def test_a_callback_draws_with_the_matrix_it_gets(maps: Maps) -> None:
    calls: list[np.ndarray] = []
    transform = placed((0.0, 2.0, 0.0), (2, 2, 2), 0.7)
    it = OccluderData(0, np.eye(4), False, draw=drawing(maps, transform, calls))
    maps.capture(it, wind=(3.0, 0.0, 0.0))
    assert_as_rays(maps, [transform])
    assert calls[0].shape == (4, 4)
    # Static: once. Dynamic: at every frame, since nobody knows whether it has moved.
    assert not maps.capture(it, wind=(3.0, 0.0, 0.0)) and len(calls) == 1
    moving = replace(it, dynamic=True)
    for _ in range(3):
        assert maps.capture(moving, wind=(3.0, 0.0, 0.0))
    assert len(calls) == 4


def test_another_callback_is_seen(maps: Maps) -> None:
    first = OccluderData(0, np.eye(4), False, draw=drawing(maps, placed(HERE, (1, 1, 1)), []))
    maps.capture(first)
    second = replace(first, draw=drawing(maps, placed((9.0, 4.0, 0.0), (1, 1, 1)), []))
    assert maps.capture(second)
    assert maps.at(9.0, 0.0) == pytest.approx(5.0) and maps.at(3.0, -5.0) == -math.inf


def test_what_a_callback_does_to_the_matrix_stays_its_own_affair(maps: Maps) -> None:
    def spoil(matrix: np.ndarray) -> None:
        matrix[:] = np.nan

    transform = placed((0.0, 2.0, 0.0), (2, 2, 2))
    maps.capture(OccluderData(0, np.eye(4), False, draw=spoil), box(1, transform))
    assert_as_rays(maps, [transform])


@pytest.mark.parametrize("dynamic", [False, True])
def test_a_callback_that_raises_is_named_and_left_out(
    maps: Maps, caplog: pytest.LogCaptureFixture, dynamic: bool
) -> None:
    calls = []

    def draw_broken_windmill(matrix: np.ndarray) -> None:
        calls.append(matrix)
        raise RuntimeError("a blade came off")

    transform = placed((0.0, 2.0, 0.0), (2, 2, 2))
    broken = OccluderData(0, np.eye(4), dynamic, draw=draw_broken_windmill)
    with caplog.at_level(logging.ERROR, "weather_ecs"):
        for _ in range(4):
            maps.capture(broken, box(1, transform))
    assert len(calls) == 1 and len(caplog.records) == 1
    assert "draw_broken_windmill" in caplog.text and "a blade came off" in caplog.text
    assert_as_rays(maps, [transform])


def test_a_callback_that_draws_nothing(maps: Maps) -> None:
    maps.capture(OccluderData(0, np.eye(4), True, draw=lambda matrix: None))
    assert (maps.depth() == 1.0).all()


@pytest.mark.parametrize("dynamic", [False, True])
def test_a_callback_that_changes_state_does_no_harm(
    maps: Maps, ctx: moderngl.Context, dynamic: bool
) -> None:
    elsewhere = ctx.simple_framebuffer((16, 16))

    def leave_a_mess(matrix: np.ndarray) -> None:
        elsewhere.use()
        elsewhere.viewport = (1, 2, 3, 4)
        elsewhere.scissor = (0, 0, 2, 2)
        ctx.enable_only(moderngl.CULL_FACE | moderngl.BLEND)
        ctx.cull_face, ctx.depth_func = "front_and_back", ">"
        maps.guard.gl.glDepthMask(0)
        maps.guard.gl.glUseProgram(0)

    house, walker = placed((0.0, 2.0, 0.0), (2, 2, 2)), placed((9.0, 1.0, 0.0), (1, 1, 1))
    mess = OccluderData(1, np.eye(4), dynamic, draw=leave_a_mess)
    for _ in range(2):
        maps.capture(mess, box(0, house), mess, box(2, walker, dynamic=True))
    assert_as_rays(maps, [house, walker])
    for thing in (*elsewhere.color_attachments, elsewhere.depth_attachment, elsewhere):
        thing.release()


# Bad meshes never come so far


@pytest.mark.parametrize(
    "fields",
    [
        {"vertices": np.full((3, 3), np.nan), "indices": [0, 1, 2]},
        {"vertices": np.eye(3), "indices": [0, 1, 3]},
        {"vertices": np.eye(3), "indices": []},
        {"vertices": np.eye(3), "indices": [0, 1, 2], "transform": np.zeros((4, 4))},
        {"vertices": np.eye(3), "indices": [0, 1, 2], "transform": np.diag([1.0, 0.0, 1.0, 1.0])},
        {"vertices": np.eye(3), "indices": [0, 1, 2], "transform": np.full((4, 4), np.inf)},
    ],
)
def test_singular_and_broken_meshes_are_refused(fields: dict[str, Any]) -> None:
    with pytest.raises(InvalidValueError):
        Occluder(**fields)
    sound = Occluder(np.eye(3), [0, 1, 2])
    changes = [*fields.items()]
    with pytest.raises(InvalidValueError):
        [setattr(sound, name, value) for name, value in changes]
    assert np.isfinite(sound.vertices).all() and np.linalg.det(sound.transform) != 0.0


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
