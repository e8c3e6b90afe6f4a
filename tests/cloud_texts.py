"""A file of clouds as text, and how what it holds is compared."""

from __future__ import annotations

from dataclasses import fields

from hypothesis import HealthCheck, settings

from weather_ecs.components._base import Component

GOOD = """version = 1  # the format's

[[models]]
name = "puffy"
size_max = 200
light_penetration = inf

[[models.seeds]]
center = [0, 50.5, 0]

[[models.seeds.roots]]
pitch = 90
open_pitch = 20.25

[[models.seeds]]
width = 250

[[models]]
name = "flat"
images = ["sheet", "wisp_1"]
[[models.seeds]]
height = 5e-1

[[clouds]]
model = "puffy"
position = [1, 2, 3]

[[layers]]
base = 1500

[[layers.skies]]
state = 0.0

[[layers.skies]]
state = 1.0
models = ["flat", "cumulus"]
count = 30

[climate]
duration = 120.5
"""


def plain(value: object) -> object:
    if isinstance(value, Component):
        return {f.name: plain(getattr(value, f.name)) for f in fields(value)}
    return [plain(item) for item in value] if isinstance(value, tuple) else value


QUICK = settings(
    deadline=None,
    max_examples=40,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
