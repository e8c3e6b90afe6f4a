"""The game itself, the same in a window and off screen: update, then draw."""

from __future__ import annotations

import itertools
import math
from collections import deque
from dataclasses import replace
from typing import Any

import esper
import moderngl

from demo_game.camera import Pose, projection_matrix, view_matrix
from demo_game.cloudscape import STEADY, Cloudscape, all_layers, light_layers, steady_layers
from demo_game.collision import Colliders
from demo_game.compass import compass
from demo_game.entities import Entities
from demo_game.errand import Errand
from demo_game.file_weather import FileWeather
from demo_game.letter import State
from demo_game.mood import AIRS, TURN_STEP, WIND_STEP, MoodChanger
from demo_game.place import Place
from demo_game.player import Intent, Player
from demo_game.render import SceneRenderer
from demo_game.settings import Settings
from demo_game.skies import TIMES, TOUR_TIMES, Light, SkyChanger, light_of
from demo_game.surroundings import SCENE_START, WIND_HEADING, Surroundings
from demo_game.tour_weather import TourWeather
from demo_game.tours import Tour
from demo_game.wholes import CENTER, KEY_TIME, Wholes, next_whole
from weather_ecs import Weather
from weather_ecs.components import Observer, RainArea, SkyLayer
from weather_ecs.errors import WeatherError
from weather_ecs.presets import PRESETS, SKIES

METAR = "metar"  # in place of a preset's name until the report is read
STRIKE_AHEAD, SPREAD = 900.0, 0.3  # m and rad, of a strike that the player calls
MARK, MARKS = 2.0, 60  # s, and how many of them are kept
HEARD_FROM = 1.0  # m that the player's ears move before the weather is told
OPENING = 0.25, 0.10  # state and cover of the sky that a game begins under, whatever it rains
COMPARED_TOURS = ("walk", "run", "crossing")
LIGHT = ("low", "medium", "auto")  # qualities at which a measured tour has but some cumulus
START = (0.0, 70.0)  # (x, z), m, where a player begins, looking north
AGAIN = (6.0, -60.7)  # (x, z), m, where one begins anew: inside the cabin's door

_numbers = itertools.count(1)
STILL = Intent()


class Game:
    """Place, player, weather and their drawing, in an esper world of its own."""

    def __init__(
        self,
        context: moderngl.Context,
        settings: Settings,
        *,
        place: Place | None = None,
        seed: int = 0,
        preset: str = "heavy",
        tour: Tour | None = None,
        start: tuple[float, float] = START,
        metar: str | None = None,
        watch: bool = False,
    ) -> None:
        self.settings = settings
        self.time = 0.0  # s of play
        self.tour = tour
        self.mood = MoodChanger(preset, WIND_HEADING)
        self.wholes = Wholes()
        self._play = TourWeather(getattr(tour, "play", None))
        # State of the skies and mm/h, every MARK s of play, for the readout's strip.
        self.history: deque[tuple[float, float]] = deque(maxlen=MARKS)
        self._next_mark = 0.0
        self.report: Any = None  # of METAR, if there is one
        self.file: FileWeather | None = None  # that gives the weather
        if metar is not None or self._play.is_whole:
            # Theirs is to count from the first frame on.
            self.mood.put(replace(self.mood.current, rain_rate=0.0), METAR)
        elif tour is None and preset not in AIRS and self.mood.current.rain_rate > 0.0:
            # A shower ahead to walk into, and sun here.
            state, overcast = OPENING
            self.mood.put(replace(self.mood.current, state=state, overcast=overcast), preset)
        compared = self.is_compared
        self.sky = SkyChanger(
            draw=not compared,
            runs=tour is None,
            rainbow=not compared,
            times=TIMES if tour is None else TOUR_TIMES,
        )
        self.light = Light()  # of the last update
        self._context, self._seed = context, seed
        self._before = esper.current_world
        self._world = f"demo_game {next(_numbers)}"
        esper.switch_world(self._world)
        self.place = place if place is not None else Place(seed)
        self.player = Player(self.place, Colliders.of(self.place.colliders))
        self.player.place_at(*start, yaw=0.0)
        self.pose = self._pose()
        self.surroundings = Surroundings()
        self.errand = Errand(self.place, seed)
        self.letter = self.errand.letter
        self.entities = Entities(self.place, self.surroundings.mood(self), self.light, SCENE_START)
        esper.create_entity(self.sky.atmosphere)
        self.scape = Cloudscape(
            self.surroundings.scenery(self).state, self.entities.areas(), self._layers()
        )
        if metar is not None or self._play.is_whole:
            self.scape.show(False)  # from the start, so that none of its clouds has to dissolve
        self._strikes = 0
        esper.set_handler("strike", self.surroundings.struck)
        self._observer = Observer(self.pose.eye)
        if not self.is_compared:
            esper.create_entity(self._observer)
        self.scape.let_rain(preset not in PRESETS)
        self.scene = SceneRenderer(context, self.place, settings.quality)
        try:
            self.weather = self._make_weather()
            if self._play.hour is not None:
                self.sky.be(self._play.hour)
            self.surroundings.light_up(self)
            if metar is not None:
                self._report(metar)
            elif not (preset in PRESETS or preset in SKIES or self._play.is_whole):
                self._load(preset, watch)
        except WeatherError:
            self.scene.release()
            self._leave_world()
            raise

    @property
    def state(self) -> str:
        """Name of the weather that is there or on its way."""
        return self.mood.preset

    @property
    def areas(self) -> list[RainArea]:
        """The rain areas, for the map: the game's own, then those that clouds carry."""
        own = self.entities.areas()
        carried = [area for _, area in esper.get_component(RainArea)] if self._is_current else []
        return own + [area for area in carried if not any(area is each for each in own)]

    @property
    def _is_current(self) -> bool:
        return esper.current_world == self._world

    def update(self, dt: float, intent: Intent = STILL) -> None:
        """Let dt seconds pass."""
        esper.switch_world(self._world)
        self.time += dt
        self.mood.update(dt)
        if self._play.is_there:
            self._play.follow(self)
        elif self.file is not None:
            self._follow_file(self.file, dt)
        elif self.scape.is_running:
            self.mood.follow_climate(self.scape.state)
        whole = self.wholes.mood(self.weather)
        if whole is not None:
            self.mood.follow(*whole)
        if self.time >= self._next_mark:
            self._next_mark = self.time + MARK
            now = self.mood.current
            self.history.append((now.state, now.rain_rate + now.carried))
        self.sky.update(dt)
        share = self.errand.showers.share(self.time) if self.tour is None else 1.0
        scenery = self.surroundings.scenery(self)
        self.surroundings.cover(self)
        dark_for = scenery.rain_rate + scenery.carried
        self.entities.update(
            self.surroundings.mood(self), self.light, self._scene_time, share, dark_for
        )
        rates = [rate for _, rate in self.entities.rates(scenery)]
        self.scape.update(dt * self.weather.speed, scenery.state, rates)
        if self.tour is None:
            self.player.update(dt, intent)
        self.pose = self._pose()
        if math.dist(self._observer.position, self.pose.eye) > HEARD_FROM:
            self._observer.position = self.pose.eye
        esper.process(dt)
        self.light = light_of(self.weather.light)
        if self.tour is None:
            lay = self.letter.state is State.LYING
            rains = self.mood.current.rain_rate > 0
            self.errand.update(dt, self.time, self.player, self.weather, rains)
            lies = self.letter.state is State.LYING
            if lies is not lay:
                self.scene.show("letter", lies)

    def draw(self, framebuffer: moderngl.Framebuffer) -> None:
        """Draw the picture into a framebuffer's viewport; into one without size nothing."""
        _, _, width, height = framebuffer.viewport
        if width < 1 or height < 1:
            return
        esper.switch_world(self._world)
        view = view_matrix(self.pose)
        projection = projection_matrix(self.settings.hfov, width / height)
        framebuffer.use()
        self.weather.prepare(view, projection)
        self.scene.draw(
            framebuffer, view, projection, self._scene_time, self.surroundings.environment(self)
        )
        framebuffer.use()
        self.weather.draw(view, projection)

    def again(self) -> None:
        """Another letter, and the player back in the cabin."""
        x, _, z = self.place.letter
        yaw = math.atan2(AGAIN[0] - x, AGAIN[1] - z)
        self.player.place_at(*AGAIN, yaw=yaw)
        self.errand.again()
        self.scene.show("letter", True)

    def take_news(self) -> str | None:
        """The latest that the player has not been told yet."""
        return self.errand.take_news()

    def choose_preset(self, name: str) -> str:
        """Change the weather; returns what to tell the player."""
        self._leave_file()
        self.scape.stop()
        self.mood.choose(name)
        self._leave_whole()
        return PRESETS[name].description

    def choose_whole(self, name: str, seconds: float = KEY_TIME) -> str:
        """Change to a whole weather; returns what to tell the player."""
        self._leave_file()
        self.scape.stop()
        self.scape.show(False)
        self.wholes.go(self.weather, name, seconds, self.mood.current)
        return f"{name.replace('_', ' ').capitalize()} within {seconds:.0f} s"

    def next_whole(self, step: int = 1) -> str:
        """Go on to the next whole weather, or back; returns what to tell the player."""
        return self.choose_whole(next_whole(self.mood.preset, step))

    def run_climate(self) -> str:
        """Let the climate run, or run back; returns what to tell the player."""
        self._leave_whole()
        onwards = self.scape.run()
        return "The weather turns to storm" if onwards else "The weather clears up"

    def blow(self, steps: int) -> str:
        """Strengthen or weaken the wind by keys; returns what to tell the player."""
        self.mood.blow(steps * WIND_STEP)
        return f"Wind {self.mood.target.wind_speed:.1f} m/s"

    def turn_wind(self, steps: int) -> str:
        """Turn the wind by keys; returns what to tell the player."""
        self.mood.turn_wind(steps * TURN_STEP)
        return f"Wind to {compass(self.mood.target.wind_heading)}"

    def settings_changed(self, field: str) -> None:
        """A setting has another value now."""
        if field == "quality":
            self.weather.quality = self.settings.quality
            self.scene.quality = self.settings.quality
        elif field == "backend":
            self._change_backend()

    def close(self) -> None:
        """Give everything back; a second call does nothing."""
        if self._world not in esper.list_worlds():
            return
        esper.switch_world(self._world)
        self.weather.close()
        self.scene.release()
        self._leave_world()

    def _load(self, path: str, watch: bool) -> None:
        """The weather of a file in place of the game's."""
        try:
            self.file = FileWeather(path, watch=watch)
        except WeatherError:
            self.weather.close()
            raise
        self._take_file(self.file)

    def _take_file(self, file: FileWeather) -> None:
        """The file says something new."""
        self.scape.follow(file.climate)
        file.set_sky(self.sky.atmosphere)
        mood = file.mood(self.scape.state, self.mood.target.wind_heading)
        self.mood.put(mood, file.path.stem)
        self.surroundings.light_up(self)

    def _follow_file(self, file: FileWeather, dt: float) -> None:
        before, news = file.readings, file.look(dt)
        if news:
            self.errand.tell(news)
        if file.readings != before:
            self._take_file(file)
        mood = file.mood(self.scape.state, self.mood.target.wind_heading)
        self.mood.follow(mood, file.path.stem)

    def _leave_file(self) -> None:
        if self.file is not None:
            self.file.leave()
        self.file = None

    def _report(self, text: str) -> None:
        """The weather of a METAR report, from the start."""
        try:
            self.report = self.weather.apply_metar(text, 0.0, center=CENTER)
        except WeatherError:
            self.weather.close()
            raise
        self.scape.show(False)
        self.wholes.is_on = True
        whole = self.wholes.mood(self.weather)
        if whole is not None:
            self.mood.put(*whole)
        self.surroundings.light_up(self)

    def _leave_whole(self) -> None:
        self.wholes.leave(self.weather, self.mood.target)
        self.scape.show(True)

    def _leave_world(self) -> None:
        before = self._before if self._before in esper.list_worlds() else "default"
        esper.switch_world(before)
        esper.delete_world(self._world)

    def _change_backend(self) -> None:
        # The weather goes on where it was: only who moves the drops changes.
        saved = self.weather.snapshot()
        esper.switch_world(self._world)
        self.weather.close()
        self.weather = self._make_weather()
        self.weather.restore(saved)

    def _make_weather(self) -> Weather:
        return Weather(
            context=self._context,
            seed=self._seed,
            quality=self.settings.quality,
            backend=self.settings.backend,
        )

    def _layers(self) -> list[SkyLayer]:
        """The sky: on the tours that are compared it drifts the same whatever the wind, and costs
        little if that is asked for.
        """
        if self.mood.preset not in (*PRESETS, *SKIES, METAR):
            return []  # a file has its own
        if not self.is_compared:
            return all_layers()
        shower = self.entities.shower
        shower.drift, shower.velocity = 0.0, STEADY
        return steady_layers() if self.has_shadows else light_layers()

    @property
    def has_shadows(self) -> bool:
        """Whether clouds cast shadows: not in the light sky of a measured tour."""
        return not (self.is_compared and self.settings.quality in LIGHT)

    @property
    def is_compared(self) -> bool:
        """Whether two runs of the tour may differ by what falls alone."""
        tour, preset = self.tour, self.mood.preset
        return tour is not None and tour.name in COMPARED_TOURS and preset in PRESETS

    @property
    def _scene_time(self) -> float:
        return SCENE_START + self.time

    def _pose(self) -> Pose:
        return self.player.pose() if self.tour is None else self.tour.pose(self.time)

    def strike(self) -> str:
        """Lightning ahead of the player; returns what to tell the player."""
        x, _, z = self.pose.eye
        self._strikes += 1
        turn = self.pose.yaw + SPREAD * math.sin(2.4 * self._strikes)
        target = x - STRIKE_AHEAD * math.sin(turn), 0.0, z - STRIKE_AHEAD * math.cos(turn)
        self.weather.strike(target)
        return ""
