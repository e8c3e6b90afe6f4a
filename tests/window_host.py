"""A host game in a real window, with the plug-in or without it: `window_host.py SCENE MODE OUT`.

MODE is none (the plug-in is not even imported), hidden (it runs and draws no drop) or visible, then
a backend after a colon. Writes the frames as they were shown, and every OpenGL state that making,
drawing or closing the weather changed, to OUT (.npz).
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pyglet
from pyglet.math import Mat4, Vec3

import gl_state

SIZE = 320, 240
FRAMES = 5


def camera(size: tuple[int, int] = SIZE) -> tuple[Mat4, Mat4]:
    """Eye height, level, towards -z."""
    view = Mat4.look_at(Vec3(0, 1.7, 0), Vec3(0, 1.7, -10), Vec3(0, 1, 0))
    aspect = size[0] / max(size[1], 1)
    return view, Mat4.perspective_projection(aspect, z_near=0.1, z_far=500.0, fov=60)


def make_weather(window: pyglet.window.Window, mode: str, **settings: Any) -> Any:
    """The plug-in on the window, with one rain area that is seen or not, as `mode` says."""
    import esper

    from weather_ecs import Weather
    from weather_ecs.components import RainArea, Wind

    weather = Weather(window, **settings)
    if mode == "visible":
        esper.create_entity(RainArea(center=(0, 0), radii=(60, 40), rain_rate=50.0))
    else:
        esper.create_entity(RainArea(center=(0, 0), radii=(60, 40), rain_rate=0.0))
        esper.create_entity(RainArea(center=(0, 9000), radii=(60, 40), rain_rate=50.0))
    esper.create_entity(Wind(direction=(1, 0), speed=4.0))
    return weather


def screenshot() -> np.ndarray:
    """The colours of the window's buffer, (height, width, 4), lowest row first."""
    data = pyglet.image.get_buffer_manager().get_color_buffer().get_image_data()
    raw = data.get_data("RGBA", data.width * 4)
    return np.frombuffer(raw, np.uint8).reshape(data.height, data.width, 4).copy()


@contextmanager
def watched(moment: str, problems: list[str], state: bool = True) -> Iterator[None]:
    """Note what changes of the state, and any OpenGL error, in between."""
    before = gl_state.read_state() if state else {}
    yield
    after = gl_state.read_state() if state else {}
    problems += [f"{moment}: {line}" for line in gl_state.differences(before, after)]
    code = gl_state.error()
    if code:
        problems.append(f"{moment}: OpenGL error {code:#x}")


def main(scene_name: str, mode: str, out: str) -> None:
    mode, _, backend = mode.partition(":")
    window = pyglet.window.Window(*SIZE, vsync=False, caption="host")

    from window_scenes import SCENES

    scene = SCENES[scene_name](window)
    view, projection = camera()
    shown: list[np.ndarray] = []
    problems: list[str] = []
    weather = None
    if mode != "none":
        with watched("making", problems):
            weather = make_weather(window, mode, backend=backend)
    for frame in range(FRAMES):
        window.switch_to()
        window.dispatch_events()
        window.clear()
        scene.before(frame)
        with watched(f"frame {frame}", problems):
            if weather is not None:
                import esper

                esper.process(1 / 60)
                weather.draw(view, projection)
        with watched(f"host's frame {frame}", problems, state=False):
            scene.after(frame)
        shown.append(screenshot())
        window.flip()
    stats: dict[str, Any] = {}
    if weather is not None:
        stats = {"drops_drawn": weather.stats.drops_drawn, "backend": weather.backend}
        with watched("closing", problems):
            weather.close()
    untouched = [*scene.opaque, *([scene.nearer] if hasattr(scene, "nearer") else [])]
    notes = json.dumps({"problems": problems, "untouched": untouched, "stats": stats})
    np.savez(out, frames=np.array(shown), notes=notes)
    window.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
