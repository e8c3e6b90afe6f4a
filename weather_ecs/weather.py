"""`Weather`: the face of the package; wires the systems to esper and the renderer to a window."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter
from typing import TYPE_CHECKING, Any

import esper

from weather_ecs import cloud_world, snapshot, weathers
from weather_ecs.cloud_files import CloudFile, check_content, load_clouds, save_clouds
from weather_ecs.cloud_presets import find_model
from weather_ecs.components import Cloud, Observer, Occluder, RainGauge, RippleSurface
from weather_ecs.components._base import FAR, integer, number, vector
from weather_ecs.errors import ClosedError, ContextError, InvalidValueError, WeatherError
from weather_ecs.frame import FrameData, SkyLight
from weather_ecs.observer_keys import ObserverKeys
from weather_ecs.physics.camera import Camera, camera_from
from weather_ecs.physics.footprint import SlopeFollower, fall_slope, fall_speed_over, landing_wind
from weather_ecs.physics.lightning import GREATEST_CURRENT, LEAST_CURRENT
from weather_ecs.physics.rain_field import RainField
from weather_ecs.prepared_draw import PreparedDraw
from weather_ecs.quality import AutoQuality, FrameCost, QualitySettings, settings_for
from weather_ecs.sampling import Sample, SampleField
from weather_ecs.stats import Stats
from weather_ecs.systems import ExtractSystem, WeatherProcessor, WeatherState, scheduled
from weather_ecs.systems.climate import oldest_state
from weather_ecs.systems.cloud_models import ModelBook
from weather_ecs.systems.cloud_rain import remove_all
from weather_ecs.systems.course import LONGEST
from weather_ecs.systems.gauge import GaugeBoard
from weather_ecs.systems.lightning import called as call_strike
from weather_ecs.systems.queries import in_world, living
from weather_ecs.systems.rain_view import RainView
from weather_ecs.systems.shelter import ShelterIndex
from weather_ecs.systems.thing_snow import ThingSnow
from weather_ecs.weathers import WeatherNow, WholeWeather

if TYPE_CHECKING:
    from types import TracebackType

    from weather_ecs.gpu.cloud_shadow import CloudShadow
    from weather_ecs.gpu.renderer import Renderer
    from weather_ecs.gpu.ripple_map import RippleMap
    from weather_ecs.gpu.weather_air import WeatherAir
    from weather_ecs.gpu.weather_sky import WeatherSky
    from weather_ecs.gpu.wetness_map import WetnessMap
    from weather_ecs.metar import MetarReport

BACKENDS = ("auto", "compute", "feedback")

_check_seed = integer(0, 2**63 - 1)
_check_position = vector(3, -FAR, FAR)
_check_center = vector(2, -FAR, FAR)
_check_transition = number(0.0, LONGEST)
_check_current = number(LEAST_CURRENT, GREATEST_CURRENT)


class Weather:
    """The weather of esper's current world.

    With a pyglet window, or with a moderngl context that the game has made, it draws; with
    neither it only simulates, as a game server does. It lives in the world that was current when
    it was made, whichever is current later; a world has one weather at most.

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
        self._state = WeatherState(_check_seed("seed", seed), ModelBook(find_model))
        self._settings: QualitySettings = settings_for(quality)
        self._auto = AutoQuality()
        if esper.get_processor(WeatherProcessor) is not None:
            raise WeatherError(f"the esper world {esper.current_world!r} has a weather already")
        self._world = esper.current_world
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
        self._stats = Stats(quality=self._settings.name, backend=self._backend)
        self._observer: tuple[float, float, float] | None = None  # m, of the last draw
        self._keys = ObserverKeys()
        self._shelter, self._slope = ShelterIndex(), SlopeFollower()
        self._things = ThingSnow()
        self._gauges = GaugeBoard()
        self._field: SampleField | None = None
        self._field_frame: FrameData | None = None
        self._cost = FrameCost()
        self._prepared: PreparedDraw | None = None
        step, frame = scheduled("step"), scheduled("frame")
        self._extract = next(system for system in frame if isinstance(system, ExtractSystem))
        self._processor = WeatherProcessor(self._state, step, frame, self._processed)
        esper.add_processor(self._processor)
        self._closed = False

    # What the game asks and sets

    def sample(self, position: Any) -> Sample:
        """The weather at a point (x, y, z) in metres. Raises InvalidValueError for no point."""
        x, y, z = _check_position("position", position)
        return self._sample_field().at(x, y, z)

    @property
    def light(self) -> SkyLight:
        """Light of sun, sky and ground now, linear RGB: of the `Atmosphere`, or else the `Sun`."""
        self._check_open()
        return self._frame().sky

    @property
    def stats(self) -> Stats:
        """Figures of the last frame, brought up to date."""
        if not self._closed:
            self._refresh_stats()
        return self._stats

    @property
    def paused(self) -> bool:
        """While it is paused, the weather stands still: drops hang in the air."""
        return self._state.clock.paused

    @paused.setter
    def paused(self, value: bool) -> None:
        self._check_open()
        self._state.clock.paused = value

    @property
    def speed(self) -> float:
        """Seconds of weather in a second of the game, 0 to 1000."""
        return self._state.clock.speed

    @speed.setter
    def speed(self, value: float) -> None:
        self._check_open()
        self._state.clock.speed = value

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

    def snapshot(self) -> bytes:
        """The whole weather as bytes: same snapshot and same steps, same weather, anywhere.

        What belongs to the game (observers, occluders) is not in it.
        """
        self._check_open()
        with in_world(self._world):
            return snapshot.encode(snapshot.capture(self._state))

    def restore(self, data: bytes) -> None:
        """Make the weather what it was when `data` was taken.

        Entities it knows get their weather components back, missing ones are created, weather
        components it does not know are removed. Raises SnapshotError, and changes nothing, for
        bytes that are not a sound snapshot.
        """
        self._check_open()
        loaded = snapshot.load(snapshot.decode(data))
        with in_world(self._world):
            snapshot.apply(self._state, loaded)
        self._extract.run(self._state)
        self._stats.time = self._state.clock.time

    def change_to(
        self, weather: str | WholeWeather, transition: float = 30.0, *, center: Any = (0.0, 0.0)
    ) -> None:
        """Let one of `presets.WEATHERS`, or a weather of the game's own, come in so many seconds.

        Everything glides there from where it is, also out of the midst of another transition; the
        first weather stands at once. New clouds and rain lie round `center`, (x, z) in metres. See
        docs/weathers.md. Raises InvalidValueError, and changes nothing, for a bad value.
        """
        self._check_open()
        whole = weathers.find(weather)
        seconds = _check_transition("transition", transition)
        x, z = _check_center("center", center)
        with in_world(self._world):
            weathers.begin(self._state, whole, seconds, (x, z))

    def apply_metar(
        self, text: str, transition: float = 30.0, *, center: Any = (0.0, 0.0)
    ) -> MetarReport:
        """Let the weather of a METAR report come; returns what was understood of it and what not.

        Needs the extra `metar`. Raises MissingExtraError without it, MetarError, and changes
        nothing, for a text that is no sound report, InvalidValueError for other bad values.
        """
        self._check_open()
        from weather_ecs.metar import read_metar

        report = read_metar(text)
        self.change_to(report.weather, transition, center=center)
        return report

    @property
    def whole(self) -> WeatherNow | None:
        """The whole weather as it is now; None before `change_to` and `apply_metar`."""
        with in_world(self._world):
            return weathers.now(self._state)

    def load(self, path: str | os.PathLike[str]) -> tuple[int, ...]:
        """Add the clouds and the weather of a file to the world; returns the entities.

        A model takes the place of one of the same name; of what counts once the oldest entity's
        counts, as everywhere. Raises WeatherFileError, and changes nothing, for a file that is not
        good from end to end.
        """
        self._check_open()
        return self.add(load_clouds(path))

    def add(self, content: CloudFile) -> tuple[int, ...]:
        """Add what a file would hold, such as `presets.sky("storm")`; returns the entities.

        A model takes the place of one of the same name. Raises InvalidValueError, and changes
        nothing, for anything else and for what no file can hold.
        """
        self._check_open()
        if not isinstance(content, CloudFile):
            raise InvalidValueError("content", content, "a CloudFile, as of presets.sky")
        check_content(content)
        with in_world(self._world):
            return cloud_world.add(content)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the clouds and the weather of the world to a file, from which `load` makes them.

        See docs/cloud-files.md for what is in it. Raises WeatherFileError and OSError; the file is
        then what it was.
        """
        self._check_open()
        with in_world(self._world):
            content = cloud_world.gather(self._state)
        save_clouds(path, content)

    def strike(
        self, target: Any = None, *, origin: Any = None, current: float | None = None
    ) -> None:
        """Let lightning strike in the next fixed step; places are (x, y, z) in metres.

        It ends at `target`; without one on the ground below `origin`, or on what stands near. It
        begins at `origin`, or some 1500 m over the target. `current` is that of its first stroke in
        kA, 3 to 300; chance draws one otherwise. Raises InvalidValueError for neither place.
        """
        self._check_open()
        if target is None and origin is None:
            raise InvalidValueError("target", target, "a place, or an origin to strike from")
        end = None if target is None else _check_position("target", target)
        begin = None if origin is None else _check_position("origin", origin)
        amount = None if current is None else _check_current("current", current)
        call_strike(self._state, end, begin, amount)

    # Drawing

    def draw(
        self, view: Any = None, projection: Any = None, *, observer: Observer | None = None
    ) -> None:
        """Draw the weather over what the game has drawn; time does not move.

        The matrices are 16 floats column by column (a pyglet `Mat4`) or arrays of shape (4, 4)
        for column vectors; without them those of the window count. `observer` says whose rain it
        is where there are several. A window that is closed or has no size is left alone.

        Raises InvalidValueError for a matrix that is none, ContextError without OpenGL.
        """
        camera = self._camera(view, projection, observer)
        if camera is not None:
            with _current(self._window):
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
            with _current(self._window):
                self._prepare(camera, observer, perf_counter())

    def _camera(self, view: Any, projection: Any, observer: Observer | None) -> Camera | None:
        """Of the matrices or of the window; None where there is nothing to draw to."""
        self._check_drawing(observer)
        if self._window is not None and not _can_be_drawn_to(self._window):
            return None
        if self._window is not None:
            view = self._window.view if view is None else view
            projection = self._window.projection if projection is None else projection
        return camera_from(view, projection)

    def ripples(
        self, surface: RippleSurface, *, observer: Observer | None = None
    ) -> RippleMap | None:
        """The rings on a surface as the last draw left them, for a water shader of the game's own.

        None where nothing was drawn yet, and for a surface that is not in the weather's world.
        """
        self._check_open()
        _check_observer(observer)
        data = self._extract.ripples.find(surface)
        if self._renderer is None or data is None:
            return None
        return self._renderer.ripples.map(self._keys.key(observer), data)

    def wetness(self, *, observer: Observer | None = None) -> WetnessMap:
        """The water on the ground, for a game's own shaders: see `wetness.glsl`.

        The same object for good; what it binds is what the last draw left. Raises ContextError
        without OpenGL.
        """
        self._check_drawing(observer)
        with _current(self._window):
            return self._ready_renderer().wetness(self._keys.key(observer))

    def cloud_shadow(self, *, observer: Observer | None = None) -> CloudShadow:
        """The clouds' shadows on the ground, for a game's own shaders: see `cloud_shadow.glsl`.

        The same object for good; what it binds is what the last draw left. Raises ContextError
        without OpenGL.
        """
        self._check_drawing(observer)
        with _current(self._window):
            return self._ready_renderer().cloud_shadow(self._keys.key(observer))

    def sky(self, *, observer: Observer | None = None) -> WeatherSky:
        """The sky's light by direction, for a game's own shaders, now: see `sky.glsl`.

        The same object for good, whoever observes. Raises ContextError without OpenGL.
        """
        self._check_drawing(observer)
        frame = self._frame()
        with _current(self._window):
            return self._ready_renderer().sky(frame)

    def snow_on(self, thing: Occluder) -> float:
        """Depth in m of the snow on something that moves, since it was first asked about.

        Ask every frame: what has fallen since the last question is added, while the thing stands
        upright. What stands still is in the map that `wetness.glsl` reads.

        Raises InvalidValueError for anything but an Occluder.
        """
        if not isinstance(thing, Occluder):
            raise InvalidValueError("thing", thing, "an Occluder component")
        field, frame = self._sample_field(), self._frame()
        return self._things.depth(thing, field, frame)

    def air(self, *, observer: Observer | None = None, position: Any = None) -> WeatherAir:
        """Fog, light and wind for a game's own shaders, now: see `weather.glsl`.

        To be asked for once a frame, before the scene is drawn. The rain and snow in it are those
        at `position`, an (x, y, z) in metres; without one, where the observer is, or where the last
        draw was. Raises ContextError without OpenGL.
        """
        self._check_drawing(observer)
        if position is not None:
            x, y, z = _check_position("position", position)
        elif observer is not None:
            x, y, z = observer.position
        else:
            x, y, z = self._observer or self._first_observer()
        frame = self._frame()
        rate = RainField(frame.areas, frame.fronts).rate(x, y, z) if len(frame.areas) else 0.0
        with _current(self._window):
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

    def _make_renderer(self) -> Renderer:
        from weather_ecs.gpu.context import obtain
        from weather_ecs.gpu.renderer import Renderer

        if self._window is not None:
            if not hasattr(self._window, "switch_to"):
                raise InvalidValueError("window", self._window, "a pyglet window or None")
            if self._window.context is None:
                raise ContextError("the window is closed")
        with _current(self._window):
            context = obtain(self._context)
            return Renderer(context, backend=self._asked_backend, seed=self._state.seed)

    def _ready_renderer(self) -> Renderer:
        """The renderer; made anew, with the view, where a snapshot has brought another seed."""
        if self._renderer is not None and self._view_seed != self._state.seed:
            self._renderer.release()
            self._renderer = None
        if self._renderer is None:
            self._renderer = self._make_renderer()
            self._view = RainView(self._state.seed)
            self._view_seed = self._state.seed
        for key in self._keys.retired():
            self._view.forget(key)
            self._renderer.forget(key)
        return self._renderer

    # The end

    def close(self) -> None:
        """Give back every OpenGL object and leave esper's world; a second time does nothing."""
        if self._closed:
            return
        self._closed = True
        if self._world in esper.list_worlds():
            with in_world(self._world):
                if esper.get_processor(WeatherProcessor) is self._processor:
                    esper.remove_processor(WeatherProcessor)
                    remove_all(self._state)
                    weathers.remove_all(self._state)
        renderer, self._renderer = self._renderer, None
        if renderer is None:
            return
        if self._window is not None and self._window.context is None:
            return  # its objects went with the window
        with _current(self._window):
            renderer.release()

    def __enter__(self) -> Weather:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _check_open(self) -> None:
        if self._closed:
            raise ClosedError("this weather is closed")

    def _check_drawing(self, observer: Observer | None) -> None:
        """Raises what is in the way of drawing for an observer."""
        self._check_open()
        _check_observer(observer)
        if self._window is None and self._context is None:
            raise ContextError("this weather was made with neither window nor context to draw to")

    # Between the systems and the above

    def _processed(self) -> None:
        self._stats.frame += 1
        self._stats.time = self._state.clock.time
        self._cost.processed()
        if esper.get_component(RainGauge):
            field = self._sample_field()
            frame = self._frame()
            self._gauges.process(frame.gauges, self._extract.gauges, field, frame.time)

    def _frame(self) -> FrameData:
        if esper.current_world == self._world:
            return self._extract.frame(self._state)
        with in_world(self._world):
            return self._extract.frame(self._state)

    def _sample_field(self) -> SampleField:
        self._check_open()
        frame = self._frame()
        if self._field is None or frame is not self._field_frame:
            wind = landing_wind(frame.wind, frame.profile)
            speed = fall_speed_over(frame.areas["rain_rate"], frame.air.snow_share)
            wanted = fall_slope(wind, speed)
            slope = self._slope.follow(wanted)
            self._shelter.update(frame.occluders, slope, frame.time)
            state = self._state
            self._field = SampleField(frame, self._shelter, state.wet_ground, state.snow_ground)
            self._field_frame = frame
        return self._field

    def _refresh_stats(self) -> None:
        x, y, z = self._observer or self._first_observer()
        field = self._sample_field()
        self._stats.mode = field.mode(x, z)
        self._stats.rain_rate_here = field.rain_rate(x, y, z)
        with in_world(self._world):
            climate = oldest_state(self._state)
            self._stats.clouds = self._state.clouds.standing + len(living(Cloud))
        self._stats.state = 0.0 if climate is None else climate
        self._stats.cfa_computed = self._state.cloud_shapes.computed

    def _first_observer(self) -> tuple[float, float, float]:
        """Where nothing has been drawn yet: the oldest observer, or the origin."""
        with in_world(self._world):
            pairs = living(Observer)
            return pairs[0][1].position if pairs else (0.0, 0.0, 0.0)


def _check_observer(observer: Any) -> None:
    if observer is not None and not isinstance(observer, Observer):
        raise InvalidValueError("observer", observer, "an Observer component or None")


def _can_be_drawn_to(window: Any) -> bool:
    if window.context is None or window.has_exit:
        return False
    width, height = window.get_size()
    return width > 0 and height > 0


@contextmanager
def _current(window: Any) -> Iterator[None]:
    """Make a window's context current, and afterwards the one that was before."""
    gl = sys.modules.get("pyglet.gl")  # where there is a window, pyglet has loaded it
    before = None if gl is None else gl.current_context
    if window is None or before is window.context:
        yield
        return
    window.switch_to()
    try:
        yield
    finally:
        if before is not None:
            before.set_current()
