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
from demo_game.entities import Entities, direction, fog_overhead
from demo_game.file_weather import FileWeather
from demo_game.letter import Letter, State
from demo_game.mood import (
    AIRS,
    TURN_STEP,
    WIND_STEP,
    Mood,
    MoodChanger,
    preset_mood,
)
from demo_game.place import Place
from demo_game.player import Intent, Player
from demo_game.plays import Play, Turn
from demo_game.render import Air, Environment, RainPatch, SceneRenderer
from demo_game.settings import Settings
from demo_game.showers import Showers
from demo_game.skies import TIMES, TOUR_TIMES, Light, SkyChanger, light_of, under_cloud
from demo_game.tours import Tour
from demo_game.wholes import CENTER, KEY_TIME, Wholes, next_whole
from weather_ecs import Weather
from weather_ecs.components import Observer, RainArea, SkyLayer
from weather_ecs.errors import WeatherError
from weather_ecs.presets import PRESETS, SKIES

WIND_HEADING = math.radians(-22.5)  # to the east, a little south
METAR = "metar"  # in place of a preset's name until the report is read
GLOOM = 0.8  # times what a rain cloud takes, under a whole sky of it
FLASH_TIME = 2.5  # s of weather after a strike in which its flash may go on
STRIKE_AHEAD, SPREAD = 900.0, 0.3  # m and rad, of a strike that the player calls
MARK, MARKS = 2.0, 60  # s, and how many of them are kept
HEARD_FROM = 1.0  # m that the player's ears move before the weather is told
OPENING = 0.25, 0.10  # state and cover of the sky that a game begins under, whatever it rains
TOUR_SKY = "heavy"  # preset whose sky a tour has, whatever it rains
SKY_LEAST, SKY_SHARE = 0.02, 0.80  # cover of the sky at large: the rain brings its own clouds
CLOUDS_FROM_TO = 700.0, 2900.0  # m, in which one comes out of them
WHOLE_SHARE = 0.85  # of a closed whole weather, as an Atmosphere has it
SHEET_SHARE = 0.55  # more where the cloud is one sheet
SCENE_START = 10.0  # s into the rounds of figure and windmill at which a game begins
COMPARED_TOURS = ("walk", "run", "crossing")
LIGHT = ("low", "medium", "auto")  # qualities at which a measured tour has but some cumulus
SNOW_ASKED = 0.25  # s between two looks whether there may be any
SNOW_BELOW = 4.0  # degrees Celsius at which there may be some
SKY_HEIGHT = 60.0  # m, above whatever shelters
START = (0.0, 70.0)  # (x, z), m, where a player begins, looking north
AGAIN = (6.0, -60.7)  # (x, z), m, where one begins anew: inside the cabin's door
HAND = (1.1, 0.35)  # m above the feet and before the body, where the letter is held

_numbers = itertools.count(1)
STILL = Intent()
FETCH = "A letter lies on the table in the cabin."
EASES, PICKS_UP = "The rain eases.", "The rain picks up again."


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
        self._play = getattr(tour, "play", None)
        self._asked, self._called = "", 0
        # State of the skies and mm/h, every MARK s of play, for the readout's strip.
        self.history: deque[tuple[float, float]] = deque(maxlen=MARKS)
        self._next_mark = 0.0
        self.report: Any = None  # of METAR, if there is one
        self.file: FileWeather | None = None  # that gives the weather
        if metar is not None or self._has_whole_play:
            # Theirs is to count from the first frame on.
            self.mood.put(replace(self.mood.current, rain_rate=0.0), METAR)
        elif tour is None and preset not in AIRS and self.mood.current.rain_rate > 0.0:
            # A shower ahead to walk into, and sun here.
            state, overcast = OPENING
            self.mood.put(replace(self.mood.current, state=state, overcast=overcast), preset)
        compared = self._is_compared
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
        self.letter = Letter(self.place.letter, self.place.mailbox)
        self._showers, self._lull, self._news = Showers(seed), False, [FETCH]
        self._entities = Entities(self.place, self._mood(), self.light, SCENE_START)
        esper.create_entity(self.sky.atmosphere)
        self._scape = Cloudscape(self._scenery().state, self._entities.areas(), self._layers())
        if metar is not None or self._has_whole_play:
            self._scape.show(False)  # from the start, so that none of its clouds has to dissolve
        self._struck, self._strikes = -math.inf, 0
        self._snow = False, -math.inf  # whether there may be any, and when that was asked
        esper.set_handler("strike", self._on_strike)
        self._observer = Observer(self.pose.eye)
        if not self._is_compared:
            esper.create_entity(self._observer)
        self._scape.let_rain(preset not in PRESETS)
        self.scene = SceneRenderer(context, self.place, settings.quality)
        try:
            self.weather = self._make_weather()
            hour = getattr(self._play, "hour", None)
            if hour is not None:
                self.sky.be(hour)
            self._light_up()
            if metar is not None:
                self._report(metar)
            elif not (preset in PRESETS or preset in SKIES or self._has_whole_play):
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
        own = self._entities.areas()
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
        if self._play is not None:
            self._follow_play(self._play)
        elif self.file is not None:
            self._follow_file(self.file, dt)
        elif self._scape.is_running:
            self.mood.follow_climate(self._scape.state)
        whole = self.wholes.mood(self.weather)
        if whole is not None:
            self.mood.follow(*whole)
        if self.time >= self._next_mark:
            self._next_mark = self.time + MARK
            now = self.mood.current
            self.history.append((now.state, now.rain_rate + now.carried))
        self.sky.update(dt)
        share = self._showers.share(self.time) if self.tour is None else 1.0
        scenery = self._scenery()
        self._cover()
        dark_for = scenery.rain_rate + scenery.carried
        self._entities.update(self._mood(), self.light, self._scene_time, share, dark_for)
        rates = [rate for _, rate in self._entities.rates(scenery)]
        self._scape.update(dt * self.weather.speed, scenery.state, rates)
        if self.tour is None:
            self.player.update(dt, intent)
        self.pose = self._pose()
        if math.dist(self._observer.position, self.pose.eye) > HEARD_FROM:
            self._observer.position = self.pose.eye
        esper.process(dt)
        self.light = light_of(self.weather.light)
        if self.tour is None:
            self._carry_letter(dt)

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
        self.scene.draw(framebuffer, view, projection, self._scene_time, self._environment())
        framebuffer.use()
        self.weather.draw(view, projection)

    def again(self) -> None:
        """Another letter, and the player back in the cabin."""
        x, _, z = self.place.letter
        yaw = math.atan2(AGAIN[0] - x, AGAIN[1] - z)
        self.player.place_at(*AGAIN, yaw=yaw)
        self.letter.again()
        self.scene.show("letter", True)
        self._news = [FETCH]

    def take_news(self) -> str | None:
        """The latest that the player has not been told yet."""
        news = self._news[-1] if self._news else None
        self._news.clear()
        return news

    def choose_preset(self, name: str) -> str:
        """Change the weather; returns what to tell the player."""
        self._leave_file()
        self._scape.stop()
        self.mood.choose(name)
        self._leave_whole()
        return PRESETS[name].description

    def choose_whole(self, name: str, seconds: float = KEY_TIME) -> str:
        """Change to a whole weather; returns what to tell the player."""
        self._leave_file()
        self._scape.stop()
        self._scape.show(False)
        self.wholes.go(self.weather, name, seconds, self.mood.current)
        return f"{name.replace('_', ' ').capitalize()} within {seconds:.0f} s"

    def next_whole(self, step: int = 1) -> str:
        """Go on to the next whole weather, or back; returns what to tell the player."""
        return self.choose_whole(next_whole(self.mood.preset, step))

    def run_climate(self) -> str:
        """Let the climate run, or run back; returns what to tell the player."""
        self._leave_whole()
        onwards = self._scape.run()
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
        self._scape.follow(file.climate)
        file.set_sky(self.sky.atmosphere)
        mood = file.mood(self._scape.state, self.mood.target.wind_heading)
        self.mood.put(mood, file.path.stem)
        self._light_up()

    def _follow_file(self, file: FileWeather, dt: float) -> None:
        before, news = file.readings, file.look(dt)
        if news:
            self._news.append(news)
        if file.readings != before:
            self._take_file(file)
        mood = file.mood(self._scape.state, self.mood.target.wind_heading)
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
        self._scape.show(False)
        self.wholes.is_on = True
        whole = self.wholes.mood(self.weather)
        if whole is not None:
            self.mood.put(*whole)
        self._light_up()

    def _leave_whole(self) -> None:
        self.wholes.leave(self.weather, self.mood.target)
        self._scape.show(True)

    def _follow_play(self, play: Play) -> None:
        turn = play.at(self.time, self.mood.target.wind_heading)
        if turn.whole is not None:
            self._follow_whole(turn, turn.whole)
            return
        self.mood.put(turn.mood, turn.name)
        self._scape.let_rain(turn.rains)
        self.weather.speed = turn.speed
        if turn.settling is not None:
            self._entities.flakes.settling = turn.settling

    def _follow_whole(self, turn: Turn, name: str) -> None:
        """A tour whose weather is a whole one."""
        self.weather.speed = turn.speed
        begins = not self._asked
        if name != self._asked:
            self._asked = name
            self._scape.show(False)
            mood = self.mood.current
            self.wholes.go(self.weather, name, turn.seconds, mood, turn.center)
        whole = self.wholes.mood(self.weather)
        if begins and whole is not None:
            self.mood.put(*whole)
        area = self.wholes.area(self.weather)
        if area is not None and area.center != turn.center:
            area.center = turn.center
        for place in turn.strikes[self._called :]:
            self.weather.strike(place)
        self._called = len(turn.strikes)

    @property
    def _has_whole_play(self) -> bool:
        return getattr(self._play, "has_whole", False)

    def _carry_letter(self, dt: float) -> None:
        player, letter = self.player, self.letter
        before, (x, y, z) = letter.state, player.position.tolist()
        up, ahead = HAND
        hand = (x - ahead * math.sin(player.yaw), y + up, z - ahead * math.cos(player.yaw))
        here = self.weather.sample(hand)
        news = letter.update(
            dt,
            (x, y, z),
            speed=math.hypot(player.velocity[0], player.velocity[2]),
            rain_rate=here.rain_rate,
            sheltered=here.sheltered,
        )
        if letter.state is not before:
            self.scene.show("letter", letter.state is State.LYING)
        lull = self._showers.is_lull(self.time)
        if lull is not self._lull and before is State.CARRIED and self.mood.current.rain_rate > 0:
            self._news.append(EASES if lull else PICKS_UP)
        self._lull = lull
        if news:
            self._news.append(news)

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
        if not self._is_compared:
            return all_layers()
        shower = self._entities.shower
        shower.drift, shower.velocity = 0.0, STEADY
        return steady_layers() if self._has_shadows else light_layers()

    @property
    def _has_shadows(self) -> bool:
        """Whether clouds cast shadows: not in the light sky of a measured tour."""
        return not (self._is_compared and self.settings.quality in LIGHT)

    @property
    def _is_compared(self) -> bool:
        """Whether two runs of the tour may differ by what falls alone."""
        tour, preset = self.tour, self.mood.preset
        return tour is not None and tour.name in COMPARED_TOURS and preset in PRESETS

    @property
    def _scene_time(self) -> float:
        return SCENE_START + self.time

    def _pose(self) -> Pose:
        return self.player.pose() if self.tour is None else self.tour.pose(self.time)

    def _scenery(self) -> Mood:
        """What sky and air follow: on a tour not the rain, so that two differ by the rain alone."""
        name = self.mood.preset
        if self.tour is not None and name in PRESETS and name not in AIRS:
            return preset_mood(TOUR_SKY, WIND_HEADING)
        return self.mood.current

    def _mood(self) -> Mood:
        """What the weather follows."""
        return replace(self.mood.current, visibility=self._scenery().visibility)

    def _overcast(self) -> float:
        mood = self._scenery()
        share = SKY_LEAST + (SKY_SHARE + SHEET_SHARE * mood.closed) * mood.overcast
        # A whole weather's clouds are all there; of a sky that they leave open little is covered.
        share = min(share, 1.0) + mood.lent * (WHOLE_SHARE * mood.overcast**3 - min(share, 1.0))
        # Who flies up through the clouds leaves them below.
        low, high = CLOUDS_FROM_TO
        left = min(max((high - self.pose.eye[1]) / (high - low), 0.0), 1.0)
        return share * left * left * (3.0 - 2.0 * left)

    def _cover(self) -> None:
        """Tell the sky what covers it."""
        mood = self._scenery()
        gloom = 1.0 - GLOOM * mood.closed * (1.0 - under_cloud(mood.carried))
        self.sky.cover(self._overcast(), gloom, self.light)

    def _light_up(self) -> None:
        """Let the light be that of the weather as it is, and everything be lit by it."""
        for _ in range(2):  # how much of it is shown follows from how much there is
            self._cover()
            self.light = light_of(self.weather.light)
        self._entities.update(self._mood(), self.light, SCENE_START)

    def _wind(self, mood: Mood) -> tuple[float, float, float]:
        """What the scenery sways in, m/s at 10 m; on a tour the same whatever the weather."""
        if self.tour is None:
            x, _, z = self.pose.eye
            return self.weather.sample((x, 10.0, z)).wind
        x, z = direction(mood.wind_heading)
        return (mood.wind_speed * x, 0.0, mood.wind_speed * z)

    def _environment(self) -> Environment:
        light, overcast = self.light, self._overcast()
        mood = self._scenery()
        return Environment(
            sun_direction=light.sun_direction,
            sun_color=light.sun_color,
            zenith_color=light.zenith_color,
            horizon_color=light.horizon_color,
            ground_color=light.ground_color,
            overcast=overcast,
            wetness=0.0,  # but in the rain areas, which the renderer wets itself
            fog_density=self.weather.air(position=self.pose.eye).extinction,
            fog_color=light.fog_color,
            fog_overhead=fog_overhead(mood.visibility),
            rain_areas=self._patches(mood),
            wind=self._wind(mood),
            ripples=self.weather.ripples(self._entities.pond),
            water=self.weather.wetness() if self._is_wetted else None,
            cloud_shadow=self.weather.cloud_shadow() if self._has_shadows else None,
            air=self._flash_air(),
            snow=self._snows,
            actor_snow=self._entities.snow_on_actors(self.weather) if self._snows else (0.0, 0.0),
            lamps=light.lamps,
            sky=self.weather.sky(),
            draws_sky=not self.sky.atmosphere.draw,
        )

    def _flash_air(self) -> Air | None:
        """The weather's air while lightning may be bright, so that nobody pays for it else."""
        if self._struck == -math.inf:
            return None
        passed = self.weather.stats.time - self._struck
        lit = 0.0 <= passed < FLASH_TIME
        return self.weather.air(position=self.pose.eye) if lit else None

    def _on_strike(self, strike: Any, heard: Any = ()) -> None:
        self._struck = strike.time

    def strike(self) -> str:
        """Lightning ahead of the player; returns what to tell the player."""
        x, _, z = self.pose.eye
        self._strikes += 1
        turn = self.pose.yaw + SPREAD * math.sin(2.4 * self._strikes)
        target = x - STRIKE_AHEAD * math.sin(turn), 0.0, z - STRIKE_AHEAD * math.cos(turn)
        self.weather.strike(target)
        return ""

    def _patches(self, mood: Mood) -> list[RainPatch]:
        """Where it rains, as the renderer has it."""
        areas = self._entities.rates(mood)
        if self.file is not None:
            areas += [(area, area.rain_rate) for area in self.file.areas]
        whole = self.wholes.area(self.weather)
        if whole is not None:
            areas.append((whole, whole.rain_rate))
        return [(area.center, area.radii, area.heading, rate, area.ceiling) for area, rate in areas]

    @property
    def _is_wetted(self) -> bool:
        """Whether ground and walls show the weather's own water and snow.

        On the tours that are compared with their clear selves they are painted wet instead, so
        that the difference is the rain alone.
        """
        return not self._is_compared or self._snows

    @property
    def _snows(self) -> bool:
        """Whether snow may fall or lie; looked at now and then."""
        known, asked = self._snow
        if not 0.0 <= self.time - asked < SNOW_ASKED:
            x, z = self._entities.area.center
            there = self.weather.sample((x, SKY_HEIGHT, z))
            known = there.temperature < SNOW_BELOW or there.snow_depth > 0.0
            self._snow = known, self.time
        return known
