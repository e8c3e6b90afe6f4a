"""Turbulence of the air: its statistics and its ground, and the shader against its oracle."""

from __future__ import annotations

import math
from importlib import resources
from pathlib import Path

import moderngl
import numpy as np
import pytest

from weather_ecs.gpu.air_block import AIR_FLOW, fill_air
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics import turbulence
from weather_ecs.physics.turbulence import FRAMES, AirFlow, air_flow, air_velocity, eddies
from weather_ecs.physics.wind import height_share, power_law

F64 = np.float64


def flow(**changes: object) -> AirFlow:
    given = {"turbulence": 1.5, "scale": 6.0, "run": (3.0, -5.0, 2.0), **changes}
    return air_flow((8.0, 0.0, 3.0), **given)  # type: ignore[arg-type]


def places(n: int, low: float, high: float, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    wide = rng.uniform(-150.0, 150.0, (n, 3))
    wide[:, 1] = rng.uniform(low, high, n)
    return wide


def test_axes_are_right_handed():
    for frame in FRAMES:
        assert np.allclose(frame.T @ frame, np.eye(3), atol=1e-15)
        assert np.linalg.det(frame) == pytest.approx(1.0)


@pytest.mark.parametrize(("low", "high"), [(10.0, 60.0), (1.0, 1.0001)])
@pytest.mark.parametrize("scale", [2.0, 6.0])
def test_the_mean_is_zero_and_the_deviation_as_asked(scale, low, high):
    v = eddies(places(60_000, low, high), flow(scale=scale, ground=-5.0)).astype(F64)
    assert np.abs(v.mean(axis=0)).max() < 0.03
    assert v.std(axis=0) == pytest.approx([1.5] * 3, rel=0.03)


def divergence(of: AirFlow, p: np.ndarray, monkeypatch: pytest.MonkeyPatch) -> np.ndarray:
    monkeypatch.setattr(turbulence, "F", np.float64)
    h, total = 1e-4, np.zeros(len(p))
    for axis in range(3):
        step = np.zeros(3)
        step[axis] = h
        total += (eddies(p + step, of) - eddies(p - step, of))[:, axis] / (2.0 * h)
    return total


@pytest.mark.parametrize(("low", "high"), [(0.001, 0.6), (0.6, 3.0), (20.0, 40.0)])
def test_nothing_is_made_or_lost(low, high, monkeypatch):
    p = places(4000, low, high)
    lost = divergence(flow(), p, monkeypatch)
    gradient = 1.5 * 2.0 * math.pi / 6.0
    assert np.sqrt((lost**2).mean()) < 1e-5 * gradient
    assert np.abs(lost).max() < 2e-2 * gradient  # where an octave reaches its height, a kink


def test_near_the_ground_only_the_up_and_down_dies_out():
    spread = {}
    for height in (0.0, 0.1, 0.5, 2.0, 20.0):
        p = places(40_000, height, height)
        spread[height] = eddies(p, flow()).astype(F64).std(axis=0)
        assert spread[height][[0, 2]] == pytest.approx([1.5, 1.5], rel=0.04)
    up = [spread[height][1] for height in sorted(spread)]
    assert up[0] == 0.0
    assert (np.diff(up[:4]) > 0.0).all()
    assert up[1] < 0.4 * up[-1] and up[3] > 0.9 * up[-1]
    assert np.abs(eddies(places(100, -9.0, 0.0), flow())[:, 1]).max() == 0.0


def test_eddies_go_with_the_wind_and_change_on_the_way():
    p = places(500, 5.0, 20.0)
    carried = flow(run=(13.0, 2.0, 2.0))
    moved = p + (10.0, 0.0, 7.0)
    assert np.allclose(eddies(p, flow()), eddies(moved, carried), atol=2e-4)
    turned = eddies(moved, flow(run=(13.0, 2.0, 30.0)))
    assert np.corrcoef(turned.ravel(), eddies(p, flow()).ravel())[0, 1] < 0.3
    soon = eddies(p, flow(run=(3.0, -5.0, 2.2)))
    assert np.corrcoef(soon.ravel(), eddies(p, flow()).ravel())[0, 1] > 0.95


def test_neighbours_feel_the_same_eddy_and_those_afar_another():
    p = places(20_000, 20.0, 40.0)
    here = eddies(p, flow())[:, 0]

    def alike(metres: float) -> float:
        return float(np.corrcoef(here, eddies(p + (metres, 0, 0), flow())[:, 0])[0, 1])

    assert alike(0.2) > 0.9
    assert abs(alike(3.0)) < 0.6


def test_the_mean_grows_with_height_and_without_exponent_it_does_not():
    p = places(50, 0.1, 250.0)
    grown = air_velocity(p, flow(turbulence=0.0, exponent=1.0 / 7.0))
    assert grown[:, 0] == pytest.approx(8.0 * power_law(p[:, 1], exponent=1.0 / 7.0), rel=1e-5)
    p[:, 1] -= 260.0
    assert np.array_equal(
        air_velocity(p, flow(turbulence=0.0)), np.tile(np.array([8, 0, 3], "f4"), (50, 1))
    )
    assert height_share(-5.0, 10.0, 0.2) == height_share(0.03, 10.0, 0.2)
    assert height_share(1e6, 10.0, 0.2) == pytest.approx(30.0**0.2)


# The shader

PROBE = """#include "turbulence.glsl"
in vec3 in_place;
out vec3 out_air;
void main()
{
    out_air = air_velocity(in_place);
    gl_Position = vec4(0.0);
}
"""


@pytest.mark.parametrize("strength", [0.0, 1.5])
@pytest.mark.parametrize("exponent", [0.0, 1.0 / 7.0])
def test_the_shader_is_the_oracle(
    ctx: moderngl.Context, tmp_path: Path, strength: float, exponent: float
) -> None:
    shaders = resources.files("weather_ecs").joinpath("shaders")
    for name in ("turbulence.glsl", "wave.glsl"):
        text = shaders.joinpath(name).read_text(encoding="utf-8")
        (tmp_path / name).write_text(text, encoding="utf-8")
    (tmp_path / "probe.vert").write_text(PROBE, encoding="utf-8")
    of = flow(turbulence=strength, exponent=exponent, ground=1.0)
    p = np.concatenate([places(2000, -3.0, 20.0), places(500, 250.0, 400.0)]).astype("f4")
    target = ctx.simple_framebuffer((4, 4))
    target.use()
    loader = ShaderLoader(ctx, tmp_path)
    program = loader.program(ProgramKey(vertex="probe.vert", varyings=("out_air",)))
    block = BlockBuffer(ctx, AIR_FLOW)
    fill_air(block, of)
    block.upload()
    block.bind()
    source, got = ctx.buffer(p.tobytes()), ctx.buffer(reserve=p.nbytes)
    array = ctx.vertex_array(program, [(source, "3f4", "in_place")])
    array.transform(got, moderngl.POINTS)
    air = np.frombuffer(got.read(), "f4").reshape(-1, 3)
    assert np.abs(air - air_velocity(p, of)).max() < 2e-3
    things = (array, source, got, block, loader, *target.color_attachments)
    for thing in (*things, target.depth_attachment, target):
        thing.release()
