"""`Weather`: the face of the package; wires the systems to esper and the renderer to a window."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING, Any

from weather_ecs.components import Observer, RippleSurface
from weather_ecs.contents import Contents
from weather_ecs.errors import ContextError, InvalidValueError
from weather_ecs.observer_keys import IMPLICIT, ObserverKeys, check_observer
from weather_ecs.physics.camera import Camera, camera_from
from weather_ecs.physics.rain_field import RainField
from weather_ecs.prepared_draw import PreparedDraw
from weather_ecs.quality import AutoQuality, FrameCost, QualitySettings, settings_for
from weather_ecs.simulation import check_position
from weather_ecs.systems.rain_view import RainView
from weather_ecs.window_context import can_be_drawn_to, check_window, current, matrices_of

if TYPE_CHECKING:
    from weather_ecs.gpu.cloud_shadow import CloudShadow
    from weather_ecs.gpu.renderer import Renderer
    from weather_ecs.gpu.ripple_map import RippleMap
    from weather_ecs.gpu.weather_air import WeatherAir
    from weather_ecs.gpu.weather_heightmap import WeatherHeightmap
    from weather_ecs.gpu.weather_sky import WeatherSky
    from weather_ecs.gpu.wetness_map import WetnessMap

BACKENDS = ("auto", "compute", "feedback")


class Weather(Contents):
    """The weather of esper's current world.

    With a pyglet window, or with a moderngl context that the game has made, it draws; with
    neither it only simulates, as a game server does. `seed`, 0 to 2^63 - 1, decides all chance,
    `quality` (see there) what drawing may cost, `backend` (auto, compute, feedback) how drops are
    moved. `esper.process(dt)`, dt in seconds, carries it on. It lives in the world that was current
    when it was made, whichever is current later; a world has one weather at most.

    Raises InvalidValueError for a bad seed, quality or backend, ContextError where OpenGL is
    missing or too old, WeatherError where the world has a weather already.
    """

    def __init__(
        self,
        window: Any = None,
        *,
        context: Any = None,
        seed: int = 0,
        quality: str | QualitySettings = "auto",
        backend: str = "auto",
    ) -> None:
        self._closed = True  # until everything stands, there is nothing to close
        if not isinstance(backend, str) or backend not in BACKENDS:
            raise InvalidValueError("backend", backend, ", ".join(BACKENDS))
        self._settings: QualitySettings = settings_for(quality)
        self._auto = AutoQuality()
        super().__init__(seed)
        self._window = window
        self._context = context
        self._asked_backend = backend
        self._renderer: Renderer | None = None
        self._view = RainView(self._state.seed)
        self._view_seed = self._state.seed
        if window is not None or context is not None:
            self._renderer = self._make_renderer()
        self._state.drawn = self._renderer is not None
        self._backend: str = "none" if self._renderer is None else self._renderer.backend
        self._stats.quality, self._stats.backend = self._settings.name, self._backend
        self._keys = ObserverKeys()
        self._cost = FrameCost()
        self._prepared: PreparedDraw | None = None
        self._begin()

    # What drawing may cost

    @property
    def quality(self) -> str:
        """What the weather may cost: low, medium, high, ultra, or auto, which adapts.

        It may be set to a game's own `QualitySettings` too, and is then their name.
        """
        return self._settings.name

    @quality.setter
    def quality(self, value: str | QualitySettings) -> None:
        self._check_open()
        self._settings = settings_for(value)
        self._auto = AutoQuality()
        self._stats.quality = self._settings.name

    @property
    def backend(self) -> str:
        """How the drops are moved: compute, feedback, or none without OpenGL."""
        return self._backend

    # Drawing

    def draw(
        self, view: Any = None, projection: Any = None, *, observer: Observer | None = None
    ) -> None:
        """Draw the weather over what the game has drawn; time does not move.

        The matrices are 16 floats column by column (a pyglet `Mat4`) or arrays of shape (4, 4)
        for column vectors; without them those of the window count. `observer` says whose rain it
        is where there are several. A window that is closed or has no size is left alone.

        Raises InvalidValueError for matrices that no camera has (a view that is transposed or the
        projection among them), ContextError without OpenGL, ClosedError after `close`.
        """
        camera = self._camera(view, projection, observer)
        if camera is not None:
            with current(self._window):
                self._draw(camera, observer, perf_counter())

    def prepare(
        self, view: Any = None, projection: Any = None, *, observer: Observer | None = None
    ) -> None:
        """Do ahead what `draw`, with the same arguments, needs not the game's picture for.

        Drops are moved and maps are drawn then while nothing else is under way; after the scene
        the driver would wait for the scene first. May be left out: `draw` then does it itself. The
        framebuffer that is drawn to should be bound, for its size.

        Raises what `draw` raises.
        """
        camera = self._camera(view, projection, observer)
        if camera is not None:
            with current(self._window):
                self._prepare(camera, observer, perf_counter())

    def _camera(self, view: Any, projection: Any, observer: Observer | None) -> Camera | None:
        """Of the matrices or of the window; None where there is nothing to draw to."""
        self._check_drawing(observer)
        if self._window is not None and not can_be_drawn_to(self._window):
            return None
        if self._window is not None:
            view, projection = matrices_of(self._window, view, projection)
        return camera_from(view, projection)

    def ripples(
        self, surface: RippleSurface, *, observer: Observer | None = None
    ) -> RippleMap | None:
        """The rings on a surface as the last draw left them, for a water shader of the game's own.

        None where nothing was drawn yet, and for a surface that is not in the weather's world.
        """
        self._check_open()
        check_observer(observer)
        data = self._extract.ripples.find(surface)
        if self._renderer is None or data is None:
            return None
        return self._renderer.ripples.map(self._keys.key(observer), data)

    def wetness(self, *, observer: Observer | None = None) -> WetnessMap:
        """The water on the ground, for a game's own shaders: see `wetness.glsl`.

        The same object for good, as the last draw left it. Raises ContextError without OpenGL.
        """
        self._check_drawing(observer)
        with current(self._window):
            return self._ready_renderer().wetness(self._keys.key(observer))

    def heightmap(self, *, observer: Observer | None = None) -> WeatherHeightmap:
        """What rain meets first, for a game's own shaders: see `heightmap.glsl`.

        The same object for good, as the last draw left it. Raises ContextError without OpenGL.
        """
        self._check_drawing(observer)
        with current(self._window):
            return self._ready_renderer().weather_heightmap(self._keys.key(observer))

    def cloud_shadow(self, *, observer: Observer | None = None) -> CloudShadow:
        """The clouds' shadows on the ground, for a game's own shaders: see `cloud_shadow.glsl`.

        The same object for good, as the last draw left it. Raises ContextError without OpenGL.
        """
        self._check_drawing(observer)
        with current(self._window):
            return self._ready_renderer().cloud_shadow(self._keys.key(observer))

    def sky(self, *, observer: Observer | None = None) -> WeatherSky:
        """The sky's light by direction, for a game's own shaders, now: see `sky.glsl`.

        The same object for good, whoever observes. Raises ContextError without OpenGL.
        """
        self._check_drawing(observer)
        frame = self._frame()
        with current(self._window):
            return self._ready_renderer().sky(frame)

    def air(self, *, observer: Observer | None = None, position: Any = None) -> WeatherAir:
        """Fog, light and wind for a game's own shaders, now: see `weather.glsl`.

        To be asked for once a frame, before the scene is drawn. The rain and snow in it are those
        at `position`, an (x, y, z) in metres; without one, where the observer is, or where the last
        draw was. Raises ContextError without OpenGL.
        """
        self._check_drawing(observer)
        if position is not None:
            x, y, z = check_position("position", position)
        elif observer is not None:
            x, y, z = observer.position
        else:
            x, y, z = self._observer or self._first_observer()
        frame = self._frame()
        rate = RainField(frame.areas, frame.fronts).rate(x, y, z) if len(frame.areas) else 0.0
        with current(self._window):
            return self._ready_renderer().air(self._keys.key(observer), frame, y, rate, (x, z))

    def _draw(self, camera: Camera, observer: Observer | None, started: float) -> None:
        ahead = self._prepared
        if ahead is None or not ahead.serves(self._frame(), camera, self._keys.key(observer)):
            ahead = self._begin_draw(camera, observer, started)
        self._prepared = None
        renderer, frame = self._ready_renderer(), ahead.view.frame
        renderer.draw(ahead.view, ahead.settings)
        if frame.gauges:
            self._gauges.take(frame.gauges, renderer.take_readings())
        self._observer = camera.position
        self._stats.count(renderer.stats)
        self._stats.ms = ahead.ms + (perf_counter() - started) * 1000.0
        gpu_ms = float(renderer.stats.get("gpu_ms", 0.0))
        self._cost.add(gpu_ms, self._stats.ms, self._stats.drops_drawn)

    def _prepare(self, camera: Camera, observer: Observer | None, started: float) -> None:
        ahead = self._begin_draw(camera, observer, started)
        self._ready_renderer().prepare(ahead.view, ahead.settings)
        ahead.ms = (perf_counter() - started) * 1000.0
        self._prepared = ahead

    def _begin_draw(
        self, camera: Camera, observer: Observer | None, started: float
    ) -> PreparedDraw:
        """What an observer's camera sees of the frame, at the quality that it is drawn with."""
        frame, key = self._frame(), self._keys.key(observer)
        finished = self._cost.begin(started)
        if finished is not None:
            self._auto.feed(*finished)
        settings = self._auto.settings() if self.quality == "auto" else self._settings
        self._ready_renderer()
        return PreparedDraw(self._view.view(frame, camera, key, settings), settings)

    def forget_drawn(self) -> None:
        """Let go of drops, splashes and maps, but not observers'; for tools that set it back."""
        self._prepared = None  # of what is forgotten now
        if self._renderer is not None and getattr(self._window, "context", self) is not None:
            with current(self._window):
                self._view.forget(IMPLICIT)
                self._renderer.forget(IMPLICIT)

    def _make_renderer(self) -> Renderer:
        from weather_ecs.gpu.context import obtain
        from weather_ecs.gpu.renderer import Renderer

        check_window(self._window)
        with current(self._window):
            context = obtain(self._context)
            return Renderer(context, backend=self._asked_backend, seed=self._state.seed)

    def _ready_renderer(self) -> Renderer:
        """The renderer; with other drops where a snapshot has brought another seed."""
        if self._renderer is None:
            self._renderer = self._make_renderer()
        if self._view_seed != self._state.seed:
            self._renderer.reseed(self._state.seed)
            self._view, self._view_seed = RainView(self._state.seed), self._state.seed
        for key in self._keys.retired():
            self._view.forget(key)
            self._renderer.forget(key)
        return self._renderer

    def close(self) -> None:
        """Give back every OpenGL object and leave esper's world; a second time does nothing.

        Raises ContextError where the `context` it was made with is not current: once it is, a
        second time gives back the rest.
        """
        super().close()
        if self._renderer is None:
            return
        # Of a closed window, its objects went with it.
        if self._window is None or self._window.context is not None:
            with current(self._window):
                self._renderer.release()
        self._renderer = None

    def _processed(self) -> None:
        self._cost.processed()
        super()._processed()

    def _check_drawing(self, observer: Observer | None) -> None:
        """Raises what is in the way of drawing for an observer."""
        self._check_open()
        check_observer(observer)
        if self._window is None and self._context is None:
            raise ContextError("made with neither window nor context: Weather(window) is to draw")
