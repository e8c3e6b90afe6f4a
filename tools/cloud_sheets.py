"""Sheets of clouds: `python -m tools.cloud_sheets OUT types|sun|climate|shafts|flight|impostors`.

Each is a plain with nothing on it under the weather's own sky. The sheets in docs/clouds.md,
docs/cloud-drawing.md and docs/skies.md are made by it. Needs Pillow.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import esper
import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.camera import Pose, projection_matrix, view_matrix
from demo_game.headless import make_context
from tools.stills import run, save_sheet
from weather_ecs import Weather, presets
from weather_ecs.components import Atmosphere, Cloud, Sky, SkyLayer
from weather_ecs.physics.sky_map import shown

USAGE = "usage: python -m tools.cloud_sheets OUT.jpg types|sun|climate|shafts|flight|impostors"
SIZE = (800, 450)  # px
NOON, LOW = "2025-06-21T12:00:00Z", "2025-06-21T18:10:00Z"  # at 45 degrees north, 0 east
NORTH = 0.0  # yaw, degrees
FIELD = math.radians(86.0)

# What the appendix of the dissertation says of each, in short; clouds in the sky, and the pitch.
KINDS: dict[str, tuple[str, int, float]] = {
    "cirrus": ("delicate, silky or fibrous, bright white", 60, 22.0),
    "cirrostratus": ("a misty transparent veil that does not hide the sun", 90, 22.0),
    "cirrocumulus": ("a sheet of white grains, a scaly sky, rippled", 70, 24.0),
    "altostratus": ("white, grey or bluish sheets, a fibrous veil", 90, 20.0),
    "altocumulus": ("white or grey blades and rolls in parallel bands", 110, 22.0),
    "nimbostratus": ("grey, of great extent, its base diffuse, hides the sun", 110, 14.0),
    "stratus": ("an even smooth layer with the lowest base, grey", 130, 14.0),
    "stratocumulus": ("layers with dark parts, slabs or rolls in groups", 120, 16.0),
    "cumulus": ("cotton wool, dark base, bright top, sharp edges", 170, 12.0),
    "cumulonimbus": ("great, dark and dense, its top spread like an anvil", 2, 15.0),
    "fractostratus": ("shreds of stratus", 260, 14.0),
}
GROUND = """#version 330 core
uniform mat4 matrix; uniform vec3 eye; out vec2 place;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    place = eye.xz + corner * 60000.0;
    gl_Position = matrix * vec4(place.x, 0.0, place.y, 1.0);
}"""
COLOR = """#version 330 core
uniform vec3 lit; uniform vec3 far; uniform vec3 eye; in vec2 place; out vec4 color;
void main() {
    float away = distance(place, eye.xz);
    vec3 linear = mix(lit, far, 1.0 - exp(-away / 9000.0));
    color = vec4(pow(linear, vec3(1.0 / 2.2)), 1.0);
}"""


class Plain:
    """A world with a weather and a plain, and the picture of it."""

    def __init__(self, size: tuple[int, int] = SIZE) -> None:
        self.ctx, self.size = make_context(), size
        self._target = self.ctx.framebuffer(
            [self.ctx.texture(size, 4)], self.ctx.depth_texture(size)
        )
        self._program: Any = self.ctx.program(vertex_shader=GROUND, fragment_shader=COLOR)
        self._ground = self.ctx.vertex_array(self._program, [])
        self.pose = Pose((0.0, 2.0, 0.0), 0.0, 0.0)

    @contextmanager
    def weather(self, time: str = NOON, **air: Any) -> Iterator[Weather]:
        """A fresh world; `now` is its sky's time."""
        esper.switch_world("sheet")
        esper.clear_database()
        weather = Weather(context=self.ctx, seed=4, quality="high")
        self.air = Atmosphere(time=time, speed=0.0, draw=True, **air)
        esper.create_entity(self.air)
        try:
            yield weather
        finally:
            weather.close()

    def look(self, yaw: float, pitch: float, at: tuple[float, float, float] = (0, 2, 0)) -> None:
        """Stand at a place in m, and look along angles in degrees."""
        self.pose = Pose(at, math.radians(yaw), math.radians(pitch))

    def still(self, weather: Weather, frames: int = 30, dt: float = 0.05) -> NDArray[np.uint8]:
        """The picture after so many frames, of which the last are drawn."""
        for k in range(frames):
            esper.process(dt)
            if k >= frames - 12:
                self._draw(weather)
        raw = np.frombuffer(self._target.read(components=3), np.uint8)
        return raw.reshape(self.size[1], self.size[0], 3)[::-1]

    def _draw(self, weather: Weather) -> None:
        view = view_matrix(self.pose)
        projection = projection_matrix(FIELD, self.size[0] / self.size[1], 0.5, 90_000.0)
        self._target.use()
        self._target.clear(0.0, 0.0, 0.0, 1.0, depth=1.0)
        self.ctx.enable_only(moderngl.DEPTH_TEST)
        light = weather.light
        sun = 0.30 * max(light.sun_direction[1], 0.0) * np.array(light.sun_color)
        lit = np.array((0.32, 0.36, 0.20)) * (0.6 * np.array(light.zenith_color) + sun)
        self._program["matrix"].write((projection @ view).astype("f4").T.tobytes())
        self._program["eye"] = self.pose.eye
        self._program["lit"] = tuple(lit.tolist())
        # As the sky over it is drawn.
        self._program["far"] = tuple((shown(np.array(light.horizon_color)) ** 2.2).tolist())
        self._ground.render(moderngl.TRIANGLE_STRIP, vertices=4)
        weather.draw(view, projection)


def add_kind(name: str, count: int) -> None:
    """A sky of one kind of cloud."""
    model = presets.cloud_model(name)
    model.rain_rate = 0.0  # it would hide what it falls from
    base = 0.4 * model.base[0] + 0.6 * model.base[1]
    if name == "cumulonimbus":
        for number, x, z in ((3, 3000.0, -19_000.0), (5, -24_000.0, -44_000.0)):
            esper.create_entity(Cloud(model, (x, base, z), drift=0.0, number=number))
        return
    high = base > 4000.0
    side = 60_000.0 if high else 30_000.0
    skies = (Sky(0.0, (model,), generated=6, count=3 * count if high else count),)
    esper.create_entity(SkyLayer(base, (0.0, -0.3 * side), (side, side), skies, drift=0.0))


def types(plain: Plain, out: Path) -> None:
    """The eleven models at noon, and under a low sun, looking past it."""
    pictures, texts = [], []
    for name, (says, count, pitch) in KINDS.items():
        for time, yaw, when in ((NOON, NORTH, "noon"), (LOW, 40.0, "low sun")):
            with plain.weather(time, overcast=0.0) as weather:
                add_kind(name, count)
                plain.look(yaw if name != "cumulonimbus" else 0.0, pitch)
                pictures.append(plain.still(weather, 24))
            texts.append(f"{name}, {when}" if when == "noon" else f"“{says}”")
    save_sheet(out, pictures, texts, columns=4, width=400, quality=74)


def sun(plain: Plain, out: Path) -> None:
    """One cumulus as the sun goes round it."""
    pictures, texts = [], []
    for hour in (5.0, 7.5, 10.0, 12.0, 14.5, 17.0, 18.3, 19.2):
        minute = round(60.0 * (hour % 1.0))
        with plain.weather(f"2025-06-21T{int(hour):02}:{minute:02}:00Z", overcast=0.0) as weather:
            esper.create_entity(Cloud("cumulus", (0.0, 900.0, -1500.0), drift=0.0, number=2))
            plain.look(NORTH, 33.0)
            pictures.append(plain.still(weather, 40))
            x, y, z = weather.light.sun_direction
            way = math.degrees(math.atan2(x, -z)) % 360.0
            texts.append(f"sun {math.degrees(math.asin(y)):.0f}° high, from {way:.0f}°")
    save_sheet(out, pictures, texts, columns=4, width=400)


def climate(plain: Plain, out: Path) -> None:
    """From clear to storm in twelve stills."""
    pictures, texts = [], []
    with plain.weather("2025-06-21T15:00:00Z") as weather:
        content = presets.sky("clear", to="storm", duration=600.0)
        for layer in content.layers:
            layer.turnover = 40.0
        weather.add(content)
        plain.look(NORTH, 17.0)
        for k in range(12):
            for _ in range(100 if k else 4):
                esper.process(0.5)
            pictures.append(plain.still(weather, 40))
            texts.append(f"after {round(k * 600 / 11)} s, state {min(k / 11.0, 1.0):.2f}")
    save_sheet(out, pictures, texts, columns=4, width=400, quality=76)


def shafts(plain: Plain, out: Path) -> None:
    """Rain under a cumulonimbus far off, nearer, and round the observer."""
    pictures, texts = [], []
    for away in (18_000.0, 9000.0, 5000.0, 900.0):
        with plain.weather("2025-06-21T15:00:00Z", overcast=0.3) as weather:
            cloud = Cloud("cumulonimbus", (0.0, 1100.0, -away), drift=0.0, number=3)
            esper.create_entity(cloud)
            plain.look(NORTH, 14.0)
            pictures.append(plain.still(weather, 80))
            texts.append(f"a cumulonimbus {away / 1000.0:.1f} km off")
    save_sheet(out, pictures, texts, columns=2, width=640)


def flight(plain: Plain, out: Path) -> None:
    """Through a cumulus."""
    pictures, texts = [], []
    with plain.weather("2025-06-21T15:00:00Z", overcast=0.0) as weather:
        esper.create_entity(Cloud("cumulus", (0.0, 900.0, -2300.0), drift=0.0, number=2))
        add_kind("cumulus", 60)
        for z in (-600.0, -1400.0, -1800.0, -2150.0, -2700.0, -3300.0):
            plain.look(NORTH, 0.0, (0.0, 1180.0, z))
            pictures.append(plain.still(weather, 30))
            texts.append(
                f"{abs(-2300.0 - z):.0f} m {'before' if z > -2300 else 'beyond'} its middle"
            )
    save_sheet(out, pictures, texts, columns=3, width=480)


def impostors(plain: Plain, out: Path) -> None:
    """A fair sky with impostors, with billboards alone, and ten times what differs."""
    with plain.weather("2025-06-21T15:00:00Z") as weather:
        weather.add(presets.sky("fair"))
        plain.look(NORTH, 14.0)
        with_them = plain.still(weather, 90, dt=0.02)
        renderer: Any = weather._renderer  # noqa: SLF001, no setting is for this
        clouds = renderer.clouds
        clouds.impostors_on = False
        without = plain.still(weather, 12, dt=1.0e-4)
    apart = np.abs(with_them.astype(int) - without.astype(int))
    mean = float(apart.max(axis=2).mean())
    shown = np.clip(10 * apart, 0, 255).astype(np.uint8)
    texts = ["impostors", "billboards alone", f"ten times the difference, mean {mean:.1f} of 255"]
    save_sheet(out, [with_them, without, shown], texts, columns=3, width=640)


SHEETS = {
    "types": types, "sun": sun, "climate": climate,
    "shafts": shafts, "flight": flight, "impostors": impostors,
}  # fmt: skip


def draw(out: Path, names: list[str]) -> None:
    """Draw the sheet of a name."""
    SHEETS[names[0]](Plain(), out)


if __name__ == "__main__":
    sys.exit(run(sys.argv[1:], USAGE, draw, least=2))
