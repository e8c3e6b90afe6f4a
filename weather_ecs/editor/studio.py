"""`Studio`: the simulation of the document and its views, which the panels of the sky share."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from weather_ecs import Weather
from weather_ecs.editor import world_land
from weather_ecs.editor.map_frame import MapFrame
from weather_ecs.editor.simulation import BUDGET, Simulation
from weather_ecs.editor.target import Target
from weather_ecs.editor.world_camera import WorldCamera
from weather_ecs.editor.world_scene import WorldScene

if TYPE_CHECKING:
    import moderngl

    from weather_ecs.editor.document import Document
    from weather_ecs.editor.shared import Shared

QUALITY = "medium"  # where the document says nothing
SETTLING = 1.5  # s after a change in which the light still comes in
SETTLED = 64  # draws without a new picture of a cloud, after which all of them have faded in
SEEKING = 0.06  # s of a frame, on the way to another moment
GLIMPSE = 0.5  # s between pictures on that way
SCALES = (1.0, 0.75, 0.5)  # of the resolution, while the picture moves
SLOW, QUICK = 0.055, 0.022  # s of a picture from which the next scale is used, or the one before


class Studio:
    """One simulation, the eye in it, and its picture."""

    def __init__(self, gl: moderngl.Context) -> None:
        self.simulation = Simulation(lambda seed: Weather(context=gl, seed=seed, quality=QUALITY))
        self.scene = WorldScene(gl, self.simulation)
        self.camera = WorldCamera(ground=world_land.height)
        self.map = MapFrame()
        self.map_wanted = True  # the map is to show everything
        self.region = "temperate"  # whose bands of heights are shown
        self.target = Target(gl)
        self.drawn = 0  # pictures that were taken
        self.gl = gl
        self._generation = -1
        self._seen: tuple[object, ...] = ()
        self._unsettled = SETTLING
        self._alike = 0  # draws since one that was not as the one before it
        self._scale = 0
        self._took = 0.0  # s of the last picture
        self._since = 0.0  # s since then
        self._closed = False

    def update(self, document: Document, shared: Shared) -> None:
        """Once a frame: the document as it is now, and the time that has passed."""
        content = document.content
        fresh = document.generation != self._generation
        self._generation = document.generation
        weather = self.simulation.weather
        wanted = content.quality or QUALITY
        if weather.quality != wanted:
            weather.quality = wanted
        self.simulation.show(content, fresh=fresh)
        if fresh:
            # What was bound of the weather's that is gone could not be put back: no error is left.
            _ = self.gl.error
            self.simulation.running = False
            self.map_wanted = True
        # On the way to another moment nothing is drawn, so that there is more time to get there.
        budget = SEEKING if self.simulation.seeking else BUDGET
        self.simulation.update(shared.dt, budget)

    def picture(self, size: tuple[int, int], dt: float, revision: int) -> bool:
        """Take the picture anew, unless it would come out as the last one did; whether it was."""
        simulation, camera = self.simulation, self.camera
        eye = (*camera.eye().tolist(), camera.yaw, camera.pitch, camera.fov)
        weather = simulation.weather
        seen = (eye, size, revision, simulation.time, simulation.seed, weather.quality)
        self._since += dt
        if simulation.seeking and self._since < GLIMPSE and self.target.size != (0, 0):
            return False
        moving = seen != self._seen
        self._unsettled = SETTLING if moving else self._unsettled - dt
        at_full = self.target.size == size
        self._alike = 0 if moving else self._alike
        if self._unsettled < 0.0 and self._alike >= SETTLED and at_full:
            return False
        self._seen, self._since = seen, 0.0
        scale = SCALES[self._scale] if moving else 1.0
        pixels = tuple(max(round(side * scale), 1) for side in size)
        begin = time.perf_counter()
        self.target.use((pixels[0], pixels[1]))
        self.scene.draw(camera, size[0] / max(size[1], 1))
        self.gl.finish()
        self._took = time.perf_counter() - begin
        self.drawn += 1
        # Few pictures of far clouds are taken in one draw, and a slow machine draws seldom.
        self._alike = 0 if weather.stats.impostors_refreshed else self._alike + 1
        if moving and self._took > SLOW:
            self._scale = min(self._scale + 1, len(SCALES) - 1)
        elif moving and self._took < QUICK:
            self._scale = max(self._scale - 1, 0)
        return True

    def close(self) -> None:
        """Give everything back; a second time does nothing."""
        if self._closed:
            return
        self._closed = True
        # First the weather: it puts back what was bound, which the others may be.
        self.simulation.close()
        self.scene.release()
        self.target.release()


def studio_of(shared: Shared) -> Studio:
    """The window's studio; made when a panel first asks, which takes a moment."""
    if shared.studio is None:
        shared.studio = Studio(shared.gl)
    return shared.studio
