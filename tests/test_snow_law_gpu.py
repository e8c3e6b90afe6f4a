"""The flakes' own velocities as the shaders have them, against the oracle, flake by flake."""

from __future__ import annotations

import shutil
from importlib import resources
from pathlib import Path

import moderngl
import numpy as np
import pytest

from tests.targets import bound_target
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.flake_blocks import SNOW
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics.snow import aggregate_speed, snow_law
from weather_ecs.physics.snow_step import PERIOD, flake_velocities, flakes_of

N = 4000
PROBE = """#include "snow_law.glsl"
in float in_quantile;
uniform vec4 law;
out vec3 out_velocity;
out float out_clump;
void main()
{
    out_velocity = flake_velocity(uint(gl_VertexID), in_quantile, law);
    out_clump = aggregate_speed(0.2 + 3.8 * in_quantile);
    gl_Position = vec4(0.0);
}
"""


@pytest.mark.parametrize(
    ("model", "wet", "temperature", "time"),
    [
        ("physical", 0.0, -12.0, 0.0),
        ("physical", 0.0, -1.0, 37.2),
        ("physical", 0.4, 1.0, 63.99),
        ("physical", 1.0, 2.0, 7.5),
        ("liu_tong", 0.0, -3.0, 11.0),
    ],
)
def test_velocities_are_the_oracles(
    ctx: moderngl.Context, tmp_path: Path, model: str, wet: float, temperature: float, time: float
) -> None:
    law = snow_law(1.5, wet, temperature, model)
    flakes = flakes_of(law, time)
    quantiles = ((np.arange(N) * 0.61803398875) % 1.0).astype("f4")
    with resources.as_file(resources.files("weather_ecs").joinpath("shaders")) as shaders:
        shutil.copytree(shaders, tmp_path, dirs_exist_ok=True)
    (tmp_path / "probe.vert").write_text(PROBE, encoding="utf-8")
    loader, block = ShaderLoader(ctx, tmp_path), BlockBuffer(ctx, SNOW)
    block.data["snow_motion"] = (flakes.flutter, flakes.time, flakes.onset, float(flakes.paper))
    block.upload()
    block.bind()
    with bound_target(ctx, (4, 4)):
        program = loader.program(
            ProgramKey(vertex="probe.vert", varyings=("out_velocity", "out_clump"))
        )
        program["law"] = law[:4]
        source, got = ctx.buffer(quantiles.tobytes()), ctx.buffer(reserve=16 * N)
        array = ctx.vertex_array(program, [(source, "1f4", "in_quantile")])
        array.transform(got, moderngl.POINTS)
        found = np.frombuffer(got.read(), "f4").reshape(N, 4)
        for thing in (array, source, got, block, loader):
            thing.release()
    assert 0.0 <= time < PERIOD
    expected = flake_velocities(np.arange(N, dtype=np.uint32), quantiles, law[:4], flakes)
    # A metre a second is known to a millimetre a second.
    np.testing.assert_allclose(found[:, :3], expected, rtol=1e-3, atol=2e-4)
    sizes = 4.0 * (0.2 + 3.8 * quantiles.astype("f8"))
    np.testing.assert_allclose(found[:, 3], aggregate_speed(sizes), rtol=1.3e-4)
