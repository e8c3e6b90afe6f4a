"""Waters: asleep and awake, many at once, drawn by the weather or by the game, given back."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.gl_names import living
from tests.ripple_stage import ONTO, data_of, only_grid, rain, read, renderer_of
from tests.views import perspective
from tests.weather_pictures import Stage, stage
from tests.worlds import fresh_world
from weather_ecs import InvalidValueError, Weather, glsl
from weather_ecs.components import Observer, Occluder, PointLight, RippleSurface
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.ripple_pass import BUDGET
from weather_ecs.physics import ripple, ripple_place


@pytest.fixture
def made(ctx: moderngl.Context, backend: str) -> Iterator[Stage]:
    with stage(ctx, backend=backend, quality="medium") as it:
        yield it


# Sleep


def test_what_is_out_of_view_or_far_off_sleeps(made: Stage, monkeypatch: Any) -> None:
    near = RippleSurface((3.0, 0.0, 0.0), (2.0, 2.0), cell=0.02)
    behind = RippleSurface((-6.0, 0.0, 0.0), (2.0, 2.0), cell=0.02)
    far = RippleSurface((55.0, 0.0, 0.0), (2.0, 2.0), cell=0.02)
    for surface in (near, behind, far):
        esper.create_entity(surface)
    esper.create_entity(rain())
    ripples = renderer_of(made).ripples
    solver: Any = ripples._solver
    moved: list[int] = []
    advance = solver.advance
    monkeypatch.setattr(
        solver, "advance", lambda *args: moved.append(args[2].key) or advance(*args)
    )
    keys = [data_of(made, surface).key for surface in (near, behind, far)]
    made.play(12, position=(0.0, 1.7, 0.0), heading=0.0, pitch=-0.2)
    assert set(moved) == {keys[0]} and set(ripples.grids()) == {keys[0]}
    assert ripples.map(0, data_of(made, behind)).scale[3] == 0.0  # level
    state = read(only_grid(made)).copy()
    moved.clear()
    made.play(12, position=(0.0, 1.7, 0.0), heading=math.pi, pitch=-0.2)
    assert set(moved) == {keys[1]}
    assert np.array_equal(read(ripples.grids()[keys[0]]), state)  # not a texel was touched
    assert made.weather.ripples(near) == ripples.map(0, data_of(made, near))
    moved.clear()
    # Back again: it goes on from where it stopped.
    made.play(1, position=(0.0, 1.7, 0.0), heading=0.0, pitch=-0.2)
    grid = ripples.grids()[keys[0]]
    assert set(moved) == {keys[0]}
    dt = ripple.time_step(0.02, 0.3)
    assert grid.steps == math.floor(made.weather.stats.time / dt)


def test_many_waters_take_no_more_cells_than_the_budget(made: Stage) -> None:
    count = 60
    for k in range(count):
        place = (2.0 + 0.4 * k, 0.0, 0.0)
        esper.create_entity(RippleSurface(place, (2.5, 2.5), cell=0.01, catches_rain=False))
    esper.create_entity(rain())
    made.play(2, **ONTO)
    grids = renderer_of(made).ripples.grids()
    cells = sum(grid.cells[0] * grid.cells[1] for grid in grids.values())
    assert 0 < cells <= BUDGET * 256**2
    assert len(grids) == BUDGET
    assert max(grids) == BUDGET - 1  # the nearest


def test_grids_are_given_back(made: Stage, monkeypatch: Any) -> None:
    surface = RippleSurface((3.0, 0.0, 0.0), (2.0, 2.0), cell=0.05)
    entity = esper.create_entity(surface)
    esper.create_entity(rain())
    made.play(2, **ONTO)
    ripples = renderer_of(made).ripples
    assert len(ripples.grids()) == 1 and made.weather.ripples(surface) is not None
    # Out of view for long: the grid goes, and comes again when it is looked at.
    monkeypatch.setattr("weather_ecs.gpu.ripple_pass._KEPT_DRAWS", 30)
    away = {**ONTO, "heading": math.pi}
    made.play(1, **away)
    assert len(ripples.grids()) == 1
    ripples._draws = 239  # so many later
    made.play(1, **away)
    assert not ripples.grids()
    made.play(1, **ONTO)
    assert len(ripples.grids()) == 1
    # Deleted: at once.
    esper.delete_entity(entity)
    made.play(1, **ONTO)
    assert not ripples.grids() and made.weather.ripples(surface) is None


def test_many_lives_leave_nothing_behind(made: Stage, gl: GL) -> None:
    esper.create_entity(rain())
    counts = []
    for number in range(30):
        entity = esper.create_entity(RippleSurface((3.0, 0.0, 0.0), (2.0, 2.0 + number / 10)))
        made.play(1, **ONTO)
        counts.append(len(living(gl)["texture"]))
        esper.delete_entity(entity)
    assert max(counts) <= counts[0]


def test_every_observer_has_rings_of_its_own(made: Stage) -> None:
    esper.create_entity(RippleSurface((3.0, 0.0, 0.0), (2.0, 2.0), cell=0.05))
    esper.create_entity(rain())
    one, other = Observer(), Observer()
    for _ in range(3):
        esper.process(1 / 30)
        made.draw(**ONTO, observer=one)
        made.draw(**ONTO, observer=other)
    ripples = renderer_of(made).ripples
    assert [len(ripples.grids(key)) for key in (1, 2)] == [1, 1]
    renderer_of(made).forget(1)
    assert [len(ripples.grids(key)) for key in (1, 2)] == [0, 1]


def test_quality_sets_the_cells(made: Stage) -> None:
    esper.create_entity(RippleSurface((3.0, 0.0, 0.0), (30.0, 30.0)))
    esper.create_entity(rain())
    for name, cells in (("low", 128), ("high", 512), ("medium", 256)):
        made.weather.quality = name
        made.play(2, **ONTO)
        assert only_grid(made).cells == (cells, cells)


# Pictures


def test_the_sheet_shows_sky_depth_and_rings(made: Stage) -> None:
    surface = RippleSurface((4.0, 0.0, 0.0), (6.0, 5.0), amplitude=2.0)
    esper.create_entity(surface)
    still = made.play(2, **ONTO)
    water_pixels = made.rain(still) > 4.0
    assert 0.1 < water_pixels.mean() < 0.9
    esper.create_entity(rain(100.0))
    made.play(40, **ONTO)
    renderer: Any = renderer_of(made)
    layers = renderer._layers
    layers._draw_drops = layers._draw_veils = lambda *_, **__: None
    rings = made.play(1, **ONTO).astype(float)
    # Rings: the still water is smooth from pixel to pixel, the rippled is not.
    rough = [abs(np.diff(p.astype(float).mean(axis=2), axis=1))[:40].mean() for p in (still, rings)]
    assert rough[1] > 3.0 * rough[0]
    surface.draw = False
    assert not (made.rain(made.play(1, **ONTO)) > 1.0).any()


def test_far_water_is_calm_under_a_roof(made: Stage) -> None:
    """Beyond what is computed too, where the pattern of the near water is shown again."""
    esper.create_entity(RippleSurface((15.0, 0.0, 0.0), (29.0, 29.0), amplitude=3.0))
    esper.create_entity(rain(100.0))
    roof = placed((11.0, 6.0, -5.0), (5.0, 0.1, 4.0))
    esper.create_entity(Occluder(CORNERS, TRIANGLES, roof))
    made.play(30, **ONTO)
    renderer: Any = renderer_of(made)
    layers = renderer._layers
    layers._draw_drops = layers._draw_veils = lambda *_, **__: None
    picture = made.play(1, position=(0.0, 1.7, 0.0), heading=0.0, pitch=-0.15).astype(float)
    rough = abs(np.diff(picture.mean(axis=2), axis=1))[40:47]  # 8 to 14 m off
    # North, where z is below 0, is on the left.
    covered, open_water = rough[:, 35:65].mean(), rough[:, 95:125].mean()
    assert open_water > 2.0 * covered


def test_clear_shallow_water_lets_the_bottom_show(ctx: moderngl.Context) -> None:
    red = []
    for clarity, bottom in ((0.01, 3.9), (1000.0, 3.9), (1000.0, None)):
        with stage(ctx, quality="low") as made:
            made.background = (0.9, 0.2, 0.2, 1.0)
            if bottom is not None:  # m along the view, a little beyond the water
                p = perspective()
                depth = 0.5 + 0.5 * (p[2, 3] / bottom - p[2, 2])
                colors = made.background
                made.clear = lambda d=depth, made=made, c=colors: (  # type: ignore[method-assign]
                    made.target.use(), made.target.clear(*c, depth=d),
                )  # fmt: skip
            esper.create_entity(RippleSurface((4.0, 0.0, 0.0), (6.0, 5.0), clarity=clarity))
            red.append(int(made.play(1, **ONTO)[45, 80, 0]))
    muddy, clear, bottomless = red
    assert clear > 150 and muddy < 0.7 * clear and bottomless < 0.7 * clear


def test_lamps_are_mirrored(ctx: moderngl.Context) -> None:
    pictures = []
    for lamps in (False, True):
        with stage(ctx, quality="low") as made:
            esper.create_entity(RippleSurface((4.0, 0.0, 0.0), (6.0, 5.0)))
            if lamps:
                esper.create_entity(PointLight((7.0, 1.7, 0.0), (30.0, 20.0, 10.0), 20.0))
            pictures.append(made.play(1, **ONTO).astype(int))
    brighter = (pictures[1] - pictures[0]).max(axis=2) > 20
    assert 0 < brighter.sum() < 0.3 * brighter.size


def test_a_game_samples_the_slopes_itself(made: Stage, ctx: moderngl.Context) -> None:
    surface = RippleSurface((3.0, 0.0, 0.0), (4.0, 3.0), heading=0.6, cell=0.02, draw=False)
    esper.create_entity(surface)
    assert made.weather.ripples(surface) is None  # before the first draw
    esper.create_entity(rain())
    made.play(40, **ONTO)
    ripples = made.weather.ripples(surface)
    assert ripples is not None
    head = "#version 330\n"
    program = ctx.program(
        vertex_shader=head
        + "void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0,"
        " 0.0, 1.0); }",
        fragment_shader=head
        + glsl("ripple_sample.glsl")
        + "uniform vec4 part; out vec2 slope; void main() {"
        " slope = ripple_slope(part.xy + gl_FragCoord.xy * part.z, 0.0); }",
    )
    texture = ctx.texture((40, 30), 2, dtype="f4")
    target = ctx.framebuffer([texture])
    array = ctx.vertex_array(program, [])
    program["part"] = (2.0, -0.5, 0.03, 0.0)
    ripples.use(program, 3)
    target.use()
    array.render(moderngl.TRIANGLES, vertices=3)
    found = np.frombuffer(texture.read(), np.float32).reshape(30, 40, 2)
    # The same from the amplitudes: heights between the two steps at points a little apart.
    grid = only_grid(made)
    share = ripples.scale[2] if grid._newest else 1.0 - ripples.scale[2]
    heights = (read(grid) * share + read(grid, 1) * (1.0 - share)).astype(float) * 1e-3
    columns, rows = np.meshgrid(np.arange(40) + 0.5, np.arange(30) + 0.5)
    x, z = 2.0 + columns * 0.03, -0.5 + rows * 0.03

    def height(x: np.ndarray, z: np.ndarray) -> np.ndarray:
        own = np.array([
            ripple_place.to_own(surface.center, surface.heading, a, b)
            for a, b in zip(x.ravel(), z.ravel(), strict=True)
        ])  # fmt: skip
        at = own / 0.02 + np.array([100.0, 75.0]) - 0.5
        low = np.floor(at).astype(int)
        part = at - low
        a, b = low[:, 1], low[:, 0]
        u, w = part.T
        lower = heights[a, b] * (1 - u) + heights[a, b + 1] * u
        upper = heights[a + 1, b] * (1 - u) + heights[a + 1, b + 1] * u
        return (lower * (1 - w) + upper * w).reshape(x.shape)

    e = 0.02
    expected = np.stack(
        [height(x + e, z) - height(x - e, z), height(x, z + e) - height(x, z - e)], axis=2
    ) / (2 * e)
    for k in (0, 1):
        assert expected[..., k].std() > 0.005
        assert np.corrcoef(found[..., k].ravel(), expected[..., k].ravel())[0, 1] > 0.88
        assert found[..., k].std() == pytest.approx(expected[..., k].std(), rel=0.3)
    for thing in (array, target, texture, program):
        thing.release()


def test_a_map_that_the_game_has_bound_may_go(made: Stage, ctx: moderngl.Context, gl: GL) -> None:
    surface = RippleSurface((3.0, 0.0, 0.0), (4.0, 3.0), draw=False)
    esper.create_entity(surface)
    esper.create_entity(rain())
    made.play(3, **ONTO)
    ripples = made.weather.ripples(surface)
    assert ripples is not None
    ripples.texture.use(5)
    made.weather.quality = "low"  # another grid
    made.play(2, **ONTO)
    assert gl.error() == 0
    ripples = made.weather.ripples(surface)
    assert ripples is not None
    ripples.texture.use(5)
    made.weather.close()
    assert gl.error() == 0


def test_who_has_no_ripples() -> None:
    with fresh_world(), Weather() as weather:
        surface = RippleSurface((0, 0, 0), (1, 1))
        assert weather.ripples(surface) is None
        esper.create_entity(surface)
        assert weather.ripples(surface) is None  # a server
    with pytest.raises(InvalidValueError, match=r"ripple_sample\.glsl"):
        glsl("ripple_grid.glsl")
