"""Good and bad values of every field of the components of clouds, skies and climate."""

from __future__ import annotations

import math

import numpy as np

from weather_ecs.components import (
    Climate,
    Cloud,
    CloudModel,
    CloudRoot,
    CloudSeed,
    Sky,
    SkyLayer,
)

NAN, INF = math.nan, math.inf

MAKE = {
    CloudRoot: {},
    CloudSeed: {},
    CloudModel: {"name": "test", "seeds": (CloudSeed(),)},
    Cloud: {"model": "cumulus", "position": (0.0, 1000.0, 0.0)},
    Sky: {"state": 0.5, "models": ("cumulus",)},
    SkyLayer: {},
    Climate: {},
}
# For each field: good values and bad ones.
FIELDS = {
    CloudRoot: {
        "pitch": ([-90, 360, 12.5], [361, -361]),
        "yaw": ([-360, 360.0], [400]),
        "open_pitch": ([0, 360, np.float32(4)], [-1, 360.001, 720]),
        "open_yaw": ([0, 360], [-0.1, 361]),
        "reproductions_min": ([0, 2], [-1, 3, 1.0]),
        "reproductions_max": ([1, 1000], [0, -1, 10**6 + 1, 2.0]),
        "seeds_start": ([0, 5], [-1, 10**9]),
        "seeds_end": ([0, np.int64(7)], [-1, 10**9]),
    },
    CloudSeed: {
        "center": ([(1, 2, 3), np.arange(3)], [(1, 2), (1e7, 0, 0), 3]),
        "width": ([0.001, 1e6], [0, -1, 2e6]),
        "height": ([5], [0, -0.5]),
        "depth": ([7.0], [0]),
        "roots": ([(), [CloudRoot()], ({"pitch": 90},)], [(1,), ({"pich": 90},), "x", CloudRoot()]),
        "images": ([(), ["puff"]], ["puff", ("",), (1,), ("puff",) * 65]),
        "size_factor": ([0.01, 100], [0, -1, 101]),
        "aspect_factor": ([0.01, 100], [0, -1, 101]),
        "turn_factor": ([0, 1], [-0.1, 1.1]),
    },
    CloudModel: {
        "name": (["a", "Fair day 2", "x" * 64], ["", "2nd", "x" * 65, "a/b", b"a"]),
        "seeds": ([[CloudSeed()], ({},)], [(), (None,), ({"size": 1},), ({"width": -1},), {}]),
        "billboards_min": ([0, 5], [-1, 6, 1.5]),
        "billboards_max": ([3, 1000], [0, 2, 10_001]),
        "size_min": ([0.001, 120], [0, -1, 121]),
        "size_max": ([60, 1e6], [0, 59, -1]),
        "images": ([("wisp_1", "puff")], [(), ("",), "puff", (1,), ("puff",) * 65]),
        "light_penetration": ([1e-9, 50, INF], [0, -1]),
        "roundness": ([0, 1], [-0.1, 1.1]),
        "flatness": ([0, 1], [-0.1, 1.1]),
        "aspect": ([0.05, 20], [0, 21]),
        "turn": ([0, 180], [-1, 181]),
        "opacity": ([0, 1], [-0.1, 1.1]),
        "darkness": ([0, 1], [-0.1, 1.1]),
        "base": ([(0, 0), (500, 6000)], [(2, 1), (1,), (0, 1e6)]),
        "rain_rate": ([0, 100], [-1, 10_001]),
        "lightning": ([0, 6], [-1, 601]),
        "halo": ([0, 1], [-0.1, 1.1]),
    },
    Cloud: {
        "model": (["mine", CloudModel("a", (CloudSeed(),))], ["", "5", 5, CloudSeed()]),
        "position": ([(1, 2, 3)], [(1, 2), (1e8, 0, 0)]),
        "number": ([0, 2**31 - 1], [-1, 2**31, 1.0]),
        "scale": ([0.001, 1000], [0, -1]),
        "heading": ([-7, 1e6], []),
        "velocity": ([(150, -150)], [(151, 0), (0,)]),
        "drift": ([0, 1], [-0.1, 1.1]),
        "shear": ([(-10, 10)], [(11, 0), (0, 0, 0)]),
        "growth": ([0, 1], [-0.1, 1.1]),
        "hollow": ([0, 1], [-0.1, 1.1]),
        "opacity": ([0, 1], [-0.1, 1.1]),
    },
    Sky: {
        "state": ([0, 1], [-0.1, 1.1]),
        "models": ([("a", "b"), ["a"]], [("",), "cumulus", (3,), ("a",) * 65]),
        "generated": ([1, 10_000], [0, -1, 10_001, 1.0]),
        "count": ([0, 100_000], [-1, 100_001, 1.0]),
        "weights": ([(), (2,)], [(0,), (-1,), (1, 2), (NAN,), "x"]),
    },
    SkyLayer: {
        "base": ([-1000, 1e5], [-1001, 2e5]),
        "center": ([(1, 2)], [(1, 2, 3), (1e8, 0)]),
        "size": ([(1, 1e7)], [(0, 1), (-1, 5), (5,)]),
        "skies": ([(Sky(0), Sky(1)), [{"state": 0.5}]], [(Sky(0.5), Sky(0.5)), (0.5,), ({},)]),
        "variation": ([0, 1e4], [-1]),
        "velocity": ([(150, -150)], [(151, 0)]),
        "drift": ([0, 1], [-0.1, 1.1]),
        "shear": ([(-10, 10)], [(11, 0)]),
        "turnover": ([0.0, 1e6], [-1, 1e7, math.nan]),
    },
    Climate: {
        "initial": ([0, 1], [-0.1, 1.1]),
        "final": ([0, 1], [-0.1, 1.1]),
        "duration": ([1e-9, 1e9], [0, -1, 2e9]),
        "running": ([True, np.bool_(False)], [0, 1, "yes"]),
        "speed": ([-60, 0, 1e6], [2e6]),
        "elapsed": ([0, 1e9], [-1]),
    },
}  # fmt: skip
