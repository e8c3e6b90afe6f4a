"""`Simulation`: the weather of a world as it goes on, whether anybody draws it or not."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import esper

from weather_ecs import snapshot, weathers
from weather_ecs.cloud_presets import find_model
from weather_ecs.components import Cloud, Observer, Occluder, RainGauge
from weather_ecs.components._base import FAR, integer, number, vector
from weather_ecs.errors import ClosedError, InvalidValueError, WeatherError
from weather_ecs.frame import FrameData, SkyLight
from weather_ecs.physics.footprint import SlopeFollower, fall_slope, fall_speed_over, landing_wind
from weather_ecs.physics.lightning import GREATEST_CURRENT, LEAST_CURRENT
from weather_ecs.sampling import Sample, SampleField, Samples, check_points
from weather_ecs.stats import Stats
from weather_ecs.systems import ExtractSystem, WeatherProcessor, WeatherState, scheduled
from weather_ecs.systems.climate import oldest_state
from weather_ecs.systems.cloud_models import ModelBook
from weather_ecs.systems.cloud_rain import remove_all
from weather_ecs.systems.gauge import GaugeBoard
from weather_ecs.systems.lightning import called as call_strike
from weather_ecs.systems.queries import in_world, living
from weather_ecs.systems.shelter import ShelterIndex
from weather_ecs.systems.thing_snow import ThingSnow

if TYPE_CHECKING:
    from types import TracebackType

check_position = vector(3, -FAR, FAR)
_check_seed = integer(0, 2**63 - 1)
_check_current = number(LEAST_CURRENT, GREATEST_CURRENT)


class Simulation:
    """Time, samples, snapshots and the end of the weather of esper's current world.

    Raises InvalidValueError for a bad seed, WeatherError where the world has a weather already.
    """

    def __init__(self, seed: int) -> None:
        self._closed = True  # until `_begin`, there is nothing to close
        self._state = WeatherState(_check_seed("seed", seed), ModelBook(find_model))
        if esper.get_processor(WeatherProcessor) is not None:
            here = f"the esper world {esper.current_world!r} has a weather already"
            raise WeatherError(f"{here}: close() that one first, or switch to another world")
        self._world = esper.current_world
        self._stats = Stats()
        self._observer: tuple[float, float, float] | None = None  # m, of the last draw
        self._shelter, self._slope = ShelterIndex(), SlopeFollower()
        self._things = ThingSnow()
        self._gauges = GaugeBoard()
        self._field: SampleField | None = None
        self._field_frame: FrameData | None = None
        step, frame = scheduled("step"), scheduled("frame")
        self._extract = next(system for system in frame if isinstance(system, ExtractSystem))
        self._processor = WeatherProcessor(self._state, step, frame, self._processed)

    def _begin(self) -> None:
        """From now on the weather is part of its world."""
        esper.add_processor(self._processor)
        self._closed = False

    # What the game asks and sets

    def sample(self, position: Any) -> Sample:
        """The weather at a point (x, y, z) in metres. Raises InvalidValueError for no point."""
        if type(position) is tuple and len(position) == 3:  # as most are
            x, y, z = position
            plain = type(x) is type(y) is type(z) is float
            if plain and -FAR <= x <= FAR and -FAR <= y <= FAR and -FAR <= z <= FAR:
                return self._sample_field().at(x, y, z)
        x, y, z = check_position("position", position)
        return self._sample_field().at(x, y, z)

    def samples(self, positions: Any) -> Samples:
        """The weather at many points (n, 3) in metres, in arrays; n may be 0.

        As `sample` has it at each of them, at a tenth of its cost where there are thousands.
        Raises InvalidValueError for another shape, and for numbers that are not finite.
        """
        points = check_points("positions", positions)
        return self._sample_field().many(points)

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
        end = None if target is None else check_position("target", target)
        begin = None if origin is None else check_position("origin", origin)
        amount = None if current is None else _check_current("current", current)
        call_strike(self._state, end, begin, amount)

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

    # What tools and the editor ask

    def frame(self) -> FrameData:
        """What the weather draws, as it is now: see `weather_ecs.tools.frame_of`."""
        self._check_open()
        return self._frame()

    @property
    def inner_state(self) -> WeatherState:
        """What the systems share; it is theirs, and may be another in the next version."""
        return self._state

    # The end

    def close(self) -> None:
        """Leave esper's world; a second time does nothing."""
        if self._closed:
            return
        self._closed = True
        if self._world in esper.list_worlds():
            with in_world(self._world):
                if esper.get_processor(WeatherProcessor) is self._processor:
                    esper.remove_processor(WeatherProcessor)
                    remove_all(self._state)
                    weathers.remove_all(self._state)

    def __enter__(self) -> Self:
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

    # Between the systems and the above

    def _processed(self) -> None:
        self._stats.frame += 1
        self._stats.time = self._state.clock.time
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
        if self._closed:
            self._check_open()
        frame = self._frame()
        if self._field is None or frame is not self._field_frame:
            wind = landing_wind(frame.wind, frame.profile)
            speed = fall_speed_over(frame.areas["rain_rate"], frame.air.snow_share)
            wanted = fall_slope(wind, speed)
            slope = self._slope.follow(wanted)
            self._shelter.update(frame.occluders, slope, frame.time)
            state = self._state
            grounds = state.wet_ground, state.snow_ground
            self._field = SampleField(frame, self._shelter, *grounds, before=self._field)
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
