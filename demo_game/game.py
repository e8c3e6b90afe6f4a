"""The game itself, the same in a window and off screen: update, then draw."""

from __future__ import annotations

import itertools
import math

import esper
import moderngl

from demo_game.camera import Pose, projection_matrix, view_matrix
from demo_game.cloudscape import Cloudscape
from demo_game.collision import Colliders
from demo_game.entities import Entities
from demo_game.errand import Errand
from demo_game.given_weather import GivenWeather
from demo_game.letter import State
from demo_game.place import Place
from demo_game.player import Intent, Player
from demo_game.render import SceneRenderer
from demo_game.settings import Settings
from demo_game.skies import TIMES, TOUR_TIMES, Light, SkyChanger, light_of
from demo_game.surroundings import SCENE_START, Surroundings
from demo_game.tour_weather import TourWeather
from demo_game.tours import Tour
from demo_game.weather_changer import WeatherChanger, first_mood
from demo_game.wholes import Wholes
from weather_ecs import Weather
from weather_ecs.components import Observer, RainArea
from weather_ecs.errors import WeatherError
from weather_ecs.presets import PRESETS, SKIES

HEARD_FROM = 1.0  # m that the player's ears move before the weather is told
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
        self.play = TourWeather(getattr(tour, "play", None))
        is_given = metar is not None or self.play.is_whole
        self.mood = first_mood(preset, is_given=is_given, is_tour=tour is not None)
        self.wholes = Wholes()
        self.given = GivenWeather()
        self.changer = WeatherChanger(self)
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
            self.surroundings.scenery(self).state,
            self.entities.areas(),
            self.surroundings.layers(self),
        )
        if is_given:
            self.scape.show(False)  # from the start, so that none of its clouds has to dissolve
        esper.set_handler("strike", self.surroundings.struck)
        self._observer = Observer(self.pose.eye)
        if not self.is_compared:
            esper.create_entity(self._observer)
        self.scape.let_rain(preset not in PRESETS)
        self.scene = SceneRenderer(context, self.place, settings.quality)
        try:
            self.weather = self._make_weather()
        except WeatherError:
            self._give_back()
            raise
        try:
            self._begin(preset, metar, watch)
        except WeatherError:
            self.close()
            raise

    def _begin(self, preset: str, metar: str | None, watch: bool) -> None:
        """Let the weather be as it is at first; a report or a file may be no good."""
        if self.play.hour is not None:
            self.sky.be(self.play.hour)
        self.surroundings.light_up(self)
        if metar is not None:
            self.given.take_report(self, metar)
        elif not (preset in PRESETS or preset in SKIES or self.play.is_whole):
            self.given.load(self, preset, watch)

    @property
    def state(self) -> str:
        """Name of the weather that is there or on its way."""
        return self.mood.preset

    @property
    def areas(self) -> list[RainArea]:
        """The rain areas, for the map: the game's own, then those that clouds carry."""
        own = self.entities.areas()
        is_current = esper.current_world == self._world
        carried = [area for _, area in esper.get_component(RainArea)] if is_current else []
        return own + [area for area in carried if not any(area is each for each in own)]

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
    def scene_time(self) -> float:
        """s into the rounds of figure and windmill."""
        return SCENE_START + self.time

    def update(self, dt: float, intent: Intent = STILL) -> None:
        """Let dt seconds pass."""
        esper.switch_world(self._world)
        self.time += dt
        self.changer.update(dt)
        self.sky.update(dt)
        share = self.errand.showers.share(self.time) if self.tour is None else 1.0
        scenery = self.surroundings.scenery(self)
        self.surroundings.cover(self)
        dark_for = scenery.rain_rate + scenery.carried
        self.entities.update(
            self.surroundings.mood(self), self.light, self.scene_time, share, dark_for
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
            framebuffer, view, projection, self.scene_time, self.surroundings.environment(self)
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
        self._give_back()

    def _give_back(self) -> None:
        self.scene.release()
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

    def _pose(self) -> Pose:
        return self.player.pose() if self.tour is None else self.tour.pose(self.time)
