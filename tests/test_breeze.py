"""The demo's wind: its past for the shaders, its phases, and the flag that shows it."""

from __future__ import annotations

import moderngl
import numpy as np
import pytest

from demo_game.place import flag, layout
from demo_game.place.solid import single_posts
from demo_game.place.terrain import Terrain
from demo_game.render.breeze import PAST, PERIOD, SLOWEST, STEP, Breeze
from demo_game.render.flag import COLUMNS, ROWS, grid
from demo_game.render.frame_block import FRAME_DTYPE
from demo_game.render.programs import compile_program, source


def blown(speeds: list[float], dt: float = 0.05) -> Breeze:
    breeze = Breeze()
    for k, speed in enumerate(speeds):
        breeze.advance(10.0 + k * dt, (0.6 * speed, 0.0, 0.8 * speed))
    return breeze


def test_the_past_is_what_the_wind_was():
    breeze = blown([2.0 + 0.1 * k for k in range(400)])
    past = breeze.past()
    assert past.shape == (PAST,)
    assert past == pytest.approx(41.9 - 0.1 * STEP / 0.05 * np.arange(PAST))
    assert breeze.way == pytest.approx((0.6, 0.8))
    assert len(breeze._past) <= PAST * STEP / 0.05 + 2


def test_before_the_first_frame_it_blew_as_then():
    assert blown([5.0, 6.0]).past() == pytest.approx([6.0] + [5.0] * (PAST - 1))
    assert Breeze().front == SLOWEST


def test_a_calm_keeps_the_direction_and_a_long_pause_forgets_the_past():
    breeze = blown([8.0] * 50)
    assert breeze.advance(12.5, (0.0, 0.0, 0.0)) == pytest.approx(0.05)
    assert breeze.way == pytest.approx((0.6, 0.8))
    before = breeze.sway
    assert breeze.advance(500.0, (3.0, 0.0, 0.0)) == 1.0
    assert breeze.past() == pytest.approx([3.0] * PAST)
    assert 0.0 < (breeze.sway - before) % PERIOD < 1.5
    assert breeze.advance(400.0, (3.0, 0.0, 0.0)) == 0.0


def test_phases_run_faster_in_a_stronger_wind_and_wrap():
    weak, strong = blown([2.0] * 20), blown([12.0] * 20)
    assert strong.sway > weak.sway and strong.wave > 4.0 * weak.wave
    long = blown([20.0] * 2000)
    assert 0.0 <= long.sway < PERIOD and 0.0 <= long.wave < PERIOD
    assert long.front == pytest.approx(20.0, rel=0.01)


def test_a_gust_comes_over_the_land_at_its_own_speed():
    """What stands some metres off, 12 m after the wind itself, feels it within 3 s."""
    breeze = blown([3.0] * 200 + [14.0] * 60)
    late = 20.0 / breeze.front
    assert np.interp(late, np.arange(PAST) * STEP, breeze.past()) > 13.0
    assert SLOWEST < breeze.front < 14.0


def test_the_flag_is_a_grid_on_a_pole_that_stops_walkers(ctx: moderngl.Context):
    cells = grid()
    assert cells.shape == (6 * COLUMNS * ROWS, 5)
    assert cells[:, :2].min() == 0.0 and cells[:, :2].max() == 1.0
    assert {tuple(c) for c in cells[:, 2:].tolist()} == {
        tuple(np.float32(band).tolist()) for band in flag.BANDS
    }
    terrain = Terrain(0)
    x, y, z = flag.hoist(terrain)
    assert (x, z) == layout.FLAG and 6.0 < y - terrain.height(x, z) < flag.TALL
    assert any(post.center == layout.FLAG for post in single_posts(terrain, []))
    program = compile_program(ctx, "flag.vert", "object.frag", "SOFT")
    names = set(program)
    program.release()
    assert {"hoist", "size", "in_grid", "in_color"} <= names


def test_shaders_and_block_agree():
    assert FRAME_DTYPE["gusts"].shape == (PAST // 4, 4)
    assert f"GUST_STEP = {STEP};" in source("flag.vert")
