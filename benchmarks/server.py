"""A game server's weather, without OpenGL: how many times faster than real time it runs.

One world holds 1000 clouds of a layer with the climate running from clear to storm, a gusty wind
and 20 rain areas that move over the ground, which gets wet and dries. A frame is a second of
weather by one `esper.process(1.0)`. Beside it the same without areas, with areas that stand, and
100 such worlds that are stepped in turn.

Rows: `worlds`, `clouds` and `areas` of each, `times_real_time` of one world, and the bytes of its
snapshot at the end. For the 100 worlds `times_real_time` is that of all of them together: above 1
the machine keeps up with all.
Ratios: `times_real_time` of the one whole world; `times_real_time_100` of the 100 together;
`moving_over_still`; `snapshot_bytes`.
"""

from __future__ import annotations

import math
from typing import Any

import esper
import numpy as np

from benchmarks.harness import Case, Result, measure
from weather_ecs import Weather
from weather_ecs.components import Climate, RainArea, Sky, SkyLayer, Wind

SIDE = 36_000.0  # m of the layer's rectangle
SPREAD = 4000.0  # m from the middle within which areas begin
FASTEST = 10.0  # m/s of an area
SETTLE = 60  # s of weather before the measurement: the ground has got wet


class Server:
    """One or more worlds of the same kind, without OpenGL."""

    def __init__(self, name: str, clouds: int, areas: int, speed: float, worlds: int = 1) -> None:
        self.name, self.clouds, self.areas = name, clouds, areas
        self._worlds = [f"server {name} {k}" for k in range(worlds)]
        self.weathers = [self._start(world, speed, k) for k, world in enumerate(self._worlds)]

    def _start(self, world: str, speed: float, seed: int) -> Weather:
        esper.switch_world(world)
        weather = Weather(seed=seed)
        skies = (
            Sky(0.0, ("cumulus",), count=self.clouds),
            Sky(1.0, ("cumulus", "stratocumulus"), count=self.clouds),
        )
        esper.create_entity(SkyLayer(base=1200.0, size=(SIDE, SIDE), skies=skies))
        esper.create_entity(Climate())
        esper.create_entity(Wind((1.0, 0.3), 8.0, gustiness=0.4, veer=0.2))
        rng = np.random.default_rng(seed)
        for _ in range(self.areas):
            a = float(rng.uniform(60.0, 600.0))
            b = a * float(rng.uniform(0.5, 1.0))
            pace, course = speed * float(rng.uniform(0.3, 1.0)), float(rng.uniform(0.0, math.tau))
            area = RainArea(
                tuple(rng.uniform(-SPREAD, SPREAD, 2).tolist()),
                (a, b),
                float(rng.uniform(1.0, 40.0)),
                heading=float(rng.uniform(0.0, math.tau)),
                soft_edge=0.3 * b,
                velocity=(pace * math.cos(course), pace * math.sin(course)),
            )
            esper.create_entity(area)
        return weather

    def second(self) -> None:
        """A second of weather in every world."""
        for world in self._worlds:
            esper.switch_world(world)
            esper.process(1.0)

    def snapshot_bytes(self) -> int:
        return len(self.weathers[0].snapshot())

    def facts(self) -> dict[str, Any]:
        return {"worlds": len(self._worlds), "clouds": self.clouds, "areas": self.areas}

    def release(self) -> None:
        for weather in self.weathers:
            weather.close()
        esper.switch_world("default")
        for world in self._worlds:
            esper.delete_world(world)


def run(quick: bool) -> Result:
    before = esper.current_world
    many = 3 if quick else 100
    servers: list[Server] = []
    try:
        for name, areas, speed, worlds in (
            ("whole", 20, FASTEST, 1),
            ("areas_still", 20, 0.0, 1),
            ("clouds_alone", 0, 0.0, 1),
            (f"worlds_{many}", 20, FASTEST, many),
        ):
            servers.append(Server(name, 1000, areas, speed, worlds))
        for server in servers:
            for _ in range(3 if quick else SETTLE // len(server.weathers) + 1):
                server.second()
        cases = [Case(server.name, server.second, server.facts()) for server in servers]
        timings = measure(cases, rounds=3 if quick else 15, sample_seconds=0.02 if quick else 0.3)
        rows = []
        for server, case in zip(servers, cases, strict=True):
            row = timings.row(case)
            row["times_real_time"] = 1e3 / row["ms"]
            row["snapshot_bytes"] = server.snapshot_bytes()
            rows.append(row)
    finally:
        for server in servers:
            server.release()
        if before in esper.list_worlds():
            esper.switch_world(before)
    found = {row["name"]: row["times_real_time"] for row in rows}
    ratios = {
        "times_real_time": found["whole"],
        f"times_real_time_{many}": found[f"worlds_{many}"],
        "moving_over_still": timings.ratio("whole", "areas_still"),
        "snapshot_bytes": rows[0]["snapshot_bytes"],
    }
    return Result("server", "none", rows, ratios)
