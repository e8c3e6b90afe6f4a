"""`Surroundings`: what sky, air and scenery make of the game's weather."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from demo_game.cloudscape import STEADY, all_layers, light_layers, steady_layers
from demo_game.entities import direction, fog_overhead
from demo_game.mood import AIRS, METAR, Mood, preset_mood
from demo_game.render import Air, Environment, RainPatch
from demo_game.skies import light_of, under_cloud
from weather_ecs.components import SkyLayer
from weather_ecs.presets import PRESETS, SKIES

if TYPE_CHECKING:
    from demo_game.game import Game

WIND_HEADING = math.radians(-22.5)  # to the east, a little south
GLOOM = 0.8  # times what a rain cloud takes, under a whole sky of it
FLASH_TIME = 2.5  # s of weather after a strike in which its flash may go on
TOUR_SKY = "heavy"  # preset whose sky a tour has, whatever it rains
SKY_LEAST, SKY_SHARE = 0.02, 0.80  # cover of the sky at large: the rain brings its own clouds
CLOUDS_FROM_TO = 700.0, 2900.0  # m, in which one comes out of them
WHOLE_SHARE = 0.85  # of a closed whole weather, as an Atmosphere has it
SHEET_SHARE = 0.55  # more where the cloud is one sheet
SCENE_START = 10.0  # s into the rounds of figure and windmill at which a game begins
SNOW_ASKED = 0.25  # s between two looks whether there may be any
SNOW_BELOW = 4.0  # degrees Celsius at which there may be some
SKY_HEIGHT = 60.0  # m, above whatever shelters


class Surroundings:
    """Looks at a game; knows by itself only when lightning struck and whether it may snow."""

    def __init__(self) -> None:
        self._struck = -math.inf  # s of weather
        self._snow = False, -math.inf  # whether there may be any, and when that was asked

    def scenery(self, game: Game) -> Mood:
        """What sky and air follow: on a tour not the rain, so that two differ by the rain alone."""
        name = game.mood.preset
        if game.tour is not None and name in PRESETS and name not in AIRS:
            return preset_mood(TOUR_SKY, WIND_HEADING)
        return game.mood.current

    def mood(self, game: Game) -> Mood:
        """What the weather follows."""
        return replace(game.mood.current, visibility=self.scenery(game).visibility)

    def layers(self, game: Game) -> list[SkyLayer]:
        """The sky: on the tours that are compared it drifts the same whatever the wind, and costs
        little if that is asked for.
        """
        if game.mood.preset not in (*PRESETS, *SKIES, METAR):
            return []  # a file has its own
        if not game.is_compared:
            return all_layers()
        shower = game.entities.shower
        shower.drift, shower.velocity = 0.0, STEADY
        return steady_layers() if game.has_shadows else light_layers()

    def _overcast(self, game: Game) -> float:
        mood = self.scenery(game)
        share = SKY_LEAST + (SKY_SHARE + SHEET_SHARE * mood.closed) * mood.overcast
        # A whole weather's clouds are all there; of a sky that they leave open little is covered.
        share = min(share, 1.0) + mood.lent * (WHOLE_SHARE * mood.overcast**3 - min(share, 1.0))
        # Who flies up through the clouds leaves them below.
        low, high = CLOUDS_FROM_TO
        left = min(max((high - game.pose.eye[1]) / (high - low), 0.0), 1.0)
        return share * left * left * (3.0 - 2.0 * left)

    def cover(self, game: Game) -> None:
        """Tell the sky what covers it."""
        mood = self.scenery(game)
        gloom = 1.0 - GLOOM * mood.closed * (1.0 - under_cloud(mood.carried))
        game.sky.cover(self._overcast(game), gloom, game.light)

    def light_up(self, game: Game) -> None:
        """Let the light be that of the weather as it is, and everything be lit by it."""
        for _ in range(2):  # how much of it is shown follows from how much there is
            self.cover(game)
            game.light = light_of(game.weather.light)
        game.entities.update(self.mood(game), game.light, SCENE_START)

    def _wind(self, game: Game, mood: Mood) -> tuple[float, float, float]:
        """What the scenery sways in, m/s at 10 m; where weathers are compared, always the same."""
        if not game.is_compared:
            x, _, z = game.pose.eye
            return game.weather.sample((x, 10.0, z)).wind
        x, z = direction(mood.wind_heading)
        return (mood.wind_speed * x, 0.0, mood.wind_speed * z)

    def environment(self, game: Game) -> Environment:
        """What the scenery is drawn with."""
        light, overcast = game.light, self._overcast(game)
        mood, snows, weather = self.scenery(game), self._snows(game), game.weather
        # The tours that are compared with their clear selves are painted wet instead, so that the
        # difference is the rain alone.
        is_wetted = not game.is_compared or snows
        return Environment(
            sun_direction=light.sun_direction,
            sun_color=light.sun_color,
            zenith_color=light.zenith_color,
            horizon_color=light.horizon_color,
            ground_color=light.ground_color,
            overcast=overcast,
            wetness=0.0,  # but in the rain areas, which the renderer wets itself
            fog_density=weather.air(position=game.pose.eye).extinction,
            fog_color=light.fog_color,
            fog_overhead=fog_overhead(mood.visibility),
            rain_areas=self._patches(game, mood),
            wind=self._wind(game, mood),
            ripples=weather.ripples(game.entities.pond),
            water=weather.wetness() if is_wetted else None,
            cloud_shadow=weather.cloud_shadow() if game.has_shadows else None,
            air=self._flash_air(game),
            snow=snows,
            actor_snow=game.entities.snow_on_actors(weather) if snows else (0.0, 0.0),
            lamps=light.lamps,
            sky=weather.sky(),
            draws_sky=not game.sky.atmosphere.draw,
        )

    def _flash_air(self, game: Game) -> Air | None:
        """The weather's air while lightning may be bright, so that nobody pays for it else."""
        if self._struck == -math.inf:
            return None
        passed = game.weather.stats.time - self._struck
        lit = 0.0 <= passed < FLASH_TIME
        return game.weather.air(position=game.pose.eye) if lit else None

    def struck(self, strike: Any, heard: Any = ()) -> None:
        """Lightning has struck; esper calls this."""
        self._struck = strike.time

    def _patches(self, game: Game, mood: Mood) -> list[RainPatch]:
        """Where it rains, as the renderer has it."""
        areas = game.entities.rates(mood)
        if game.given.file is not None:
            areas += [(area, area.rain_rate) for area in game.given.file.areas]
        whole = game.wholes.area(game.weather)
        if whole is not None:
            areas.append((whole, whole.rain_rate))
        return [(area.center, area.radii, area.heading, rate, area.ceiling) for area, rate in areas]

    def _snows(self, game: Game) -> bool:
        """Whether snow may fall or lie; looked at now and then."""
        known, asked = self._snow
        if not 0.0 <= game.time - asked < SNOW_ASKED:
            x, z = game.entities.area.center
            there = game.weather.sample((x, SKY_HEIGHT, z))
            known = there.temperature < SNOW_BELOW or there.snow_depth > 0.0
            self._snow = known, game.time
        return known
