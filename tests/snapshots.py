"""A weather with something of everything, and documents of its snapshots changed."""

from __future__ import annotations

import copy
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import esper

from tests.worlds import fresh_world
from weather_ecs import Weather, snapshot
from weather_ecs.components import (
    SNAPSHOT_COMPONENTS,
    Observer,
    PointLight,
    RainArea,
    RainContainer,
    Sun,
    Wind,
)

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = """
import sys, esper
from weather_ecs import Weather
weather = Weather(seed=5)
weather.restore(bytes.fromhex(sys.stdin.read()))
for t in sys.argv[1].split(","):
    esper.process(float(t))
    weather.sample((1.0, 2.0, 3.0))
assert not {"moderngl", "pyglet"} & set(sys.modules), "a server needs no OpenGL"
print(weather.snapshot().hex())
"""


def in_another_process(start: bytes, times: Sequence[float]) -> bytes:
    """The snapshot to which a process of its own, without OpenGL, comes from one."""
    result = subprocess.run(
        [sys.executable, "-c", PROGRAM, ",".join(map(repr, times))],
        input=start.hex(),
        capture_output=True,
        text=True,
        cwd=ROOT,
        timeout=60,
        check=False,
    )
    assert result.returncode == 0, result.stderr
    return bytes.fromhex(result.stdout)


def build() -> None:
    """A world with some of everything, some of it moving."""
    esper.create_entity(Wind((3, 1), 7.3))
    esper.create_entity(Wind((-1, 0.3), 1.1), PointLight((1, 2, 3)))
    esper.create_entity(Wind((0.1, 0.9), 0.7))
    for number in range(5):
        esper.create_entity(
            RainArea((number / 3, 0.1), (9.7, 3.3), velocity=(0.1, -number / 7), drift=number / 9)
        )
    esper.create_entity(Sun((1, 2, 3)), RainContainer(veil=0.3))


def document() -> dict:
    """What a snapshot of such a world holds."""
    with fresh_world(), Weather(seed=3) as weather:
        build()
        esper.process(0.37)
        return snapshot.decode(weather.snapshot())


DOCUMENT = document()


def components() -> list[tuple[int, str, list]]:
    """All components of the current world, as plain values."""
    return sorted(
        (entity, name, [getattr(component, field) for field in component.__slots__])
        for name, kind in {**SNAPSHOT_COMPONENTS, "Observer": Observer}.items()
        for entity, component in esper.get_component(kind)
    )


def changed(*path: object, value: object) -> dict:
    result = copy.deepcopy(DOCUMENT)
    place = result
    for step in path[:-1]:
        place = place[step]
    place[path[-1]] = value
    return result
