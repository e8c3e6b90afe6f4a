"""The game's entities: what it tells the weather about itself."""

from __future__ import annotations

import math
from typing import Any

import esper

from demo_game.mood import Mood
from demo_game.place import Place
from demo_game.skies import Light, under_cloud
from weather_ecs import Weather
from weather_ecs.components import (
    Air,
    Fog,
    Occluder,
    PointLight,
    RainArea,
    RainContainer,
    RippleSurface,
    SnowFlakes,
    SplashEmitter,
    Wind,
)

CENTER = (0.0, -70.0)  # (x, z), m, of the rain area that the walk leads through
RADII = (70.0, 45.0)  # m
SOFT_EDGE = 12.0  # m
CEILING = 62.0  # m, low enough that the cloud is in the picture with its rain
SHOWER_CEILING = 80.0  # m
ONSET = 0.5  # share of nature's time that a shower takes to begin and to end

SHOWER_RADII = (85.0, 48.0)  # m, of the small one that passes in the distance
SHOWER_EDGE = 46.0  # m
SHOWER_SHARE = 0.6  # of the rain rate of the large one
SHOWER_DISTANCE = 420.0  # m that its course keeps from the place, to the left of the wind
SHOWER_COURSE = 600.0  # m before and behind there, then it begins anew
SHOWER_BEFORE = -250.0  # m along its course, where it is when the game begins
DROPS_BRIGHT, FLAKES_BRIGHT = 1.6, 2.5  # in open air; darker under the cloud they fall from
SETTLING = 8.0  # snow covers the ground within a minute or two
POND_RIM = 1.1  # of its radii, as far as its wobbling shore reaches
# Open land on a gusty day; the ground of the place is about 0 m.
BREEZE: dict[str, Any] = {
    "gustiness": 0.5, "interval": 16.0, "veer": 0.22, "veer_period": 70.0,
    "exponent": 1.0 / 7.0, "turbulence": 0.18,
}  # fmt: skip
CLEAREST = 7000.0  # m, that one sees in the place's own air on the clearest day
FOG_DEPTH = 250.0  # m, overhead
PLACE_MIDDLE = (0.0, -40.0)  # (x, z), m


class Entities:
    """Creates the entities in esper's current world and keeps them up to date."""

    def __init__(self, place: Place, mood: Mood, light: Light, time: float) -> None:
        self._place = place
        self._share = 1.0
        self.area = RainArea(
            center=CENTER, radii=RADII, soft_edge=SOFT_EDGE, ceiling=CEILING, onset=ONSET
        )
        self.shower = RainArea(
            center=on_course(SHOWER_BEFORE, mood.wind_heading),
            radii=SHOWER_RADII,
            soft_edge=SHOWER_EDGE,
            ceiling=SHOWER_CEILING,
            onset=ONSET,
            heading=mood.wind_heading,
            drift=1.0,
        )
        self._wind = Wind(**BREEZE)
        self._air, self._fog = Air(), Fog()
        self._drops, self.flakes = RainContainer(), SnowFlakes(settling=SETTLING)
        looks = self._drops, self.flakes, SplashEmitter(), self._air, self._fog
        for component in (self.area, self.shower, *looks, self._wind):
            esper.create_entity(component)
        (x, z), (a, b), level = place.pond
        size = (2.0 * POND_RIM * a, 2.0 * POND_RIM * b)
        self.pond = RippleSurface((x, level, z), size, shape="ellipse", draw=False)
        esper.create_entity(self.pond)
        self._lamps = []
        for position, color, reach in place.lamps:
            lamp = PointLight(position=position, color=color, reach=reach)
            esper.create_entity(lamp)
            self._lamps.append((lamp, color))
        poses = place.poses(time)
        self._moving: dict[str, Occluder] = {}
        for name, vertices, indices, dynamic in place.occluders():
            occluder = Occluder(vertices, indices, poses.get(name), dynamic)
            esper.create_entity(occluder)
            if dynamic:
                self._moving[name] = occluder
        self.update(mood, light, time)

    def update(
        self,
        mood: Mood,
        light: Light,
        time: float,
        share: float = 1.0,
        dark_for: float | None = None,
    ) -> None:
        """Carry the game's state of this frame into the components.

        `share` of the mood's rain falls in the large area: less than 1 in a lull. What falls is
        as dark as under a cloud that rains `dark_for` mm/h; None: the mood's.
        """
        self._share = share
        for area, rate in self.rates(mood):
            _assign(area, rain_rate=rate)
        _assign(self._wind, speed=(1.0 - mood.lent) * mood.wind_speed)
        x, z = direction(mood.wind_heading)
        if x * self._wind.direction[0] + z * self._wind.direction[1] < 1.0 - 1e-9:
            self._wind.direction = (x, z)
        _assign(self._air, temperature=mood.temperature, humidity=mood.humidity)
        seen = clearest(mood.visibility)
        _assign(self._fog, visibility=seen, depth=fog_depth(seen), color=displayed(light))
        left = under_cloud(mood.rain_rate if dark_for is None else dark_for)
        _assign(self._drops, brightness=round(left * DROPS_BRIGHT, 3))
        _assign(self.flakes, brightness=round(left * FLAKES_BRIGHT, 3))
        for lamp, (r, g, b) in self._lamps:
            _assign(lamp, color=(r * light.lamps, g * light.lamps, b * light.lamps))
        for name, pose in self._place.poses(time).items():
            self._moving[name].transform = pose
        self._send_shower_on(mood.wind_heading)

    def snow_on_actors(self, weather: Weather) -> tuple[float, float]:
        """m of snow on the figure's shoulders and on the sails."""
        return weather.snow_on(self._moving["figure/torso"]), weather.snow_on(self._moving["sails"])

    def areas(self) -> list[RainArea]:
        """All rain areas."""
        return [self.area, self.shower]

    def rates(self, mood: Mood) -> list[tuple[RainArea, float]]:
        """Every area with the rain rate that a mood gives it now, mm/h."""
        rate = mood.rain_rate
        return [(self.area, self._share * rate), (self.shower, SHOWER_SHARE * rate)]

    def _send_shower_on(self, heading: float) -> None:
        # Whatever turned the wind, the shower is carried off at some time and comes from upwind.
        x, z = self.shower.center
        if math.hypot(x - PLACE_MIDDLE[0], z - PLACE_MIDDLE[1]) > SHOWER_COURSE + SHOWER_DISTANCE:
            self.shower.center = on_course(-SHOWER_COURSE, heading)
            self.shower.heading = heading


def direction(heading: float) -> tuple[float, float]:
    """Unit vector (x, z) of a heading."""
    return math.cos(heading), -math.sin(heading)


def on_course(along: float, heading: float) -> tuple[float, float]:
    """(x, z) on the shower's course past the place, so many metres before or behind its middle."""
    x, z = direction(heading)
    return (
        PLACE_MIDDLE[0] + x * along + z * SHOWER_DISTANCE,
        PLACE_MIDDLE[1] + z * along - x * SHOWER_DISTANCE,
    )


def clearest(visibility: float) -> float:
    """m that one sees at most: a valley's own haze is in its air."""
    return min(visibility, CLEAREST)


def fog_overhead(visibility: float) -> float:
    """Optical depth of the fog straight up, without the haze that is always there."""
    return 3.912 * (1.0 / clearest(visibility) - 1.0 / CLEAREST) * FOG_DEPTH


def fog_depth(visibility: float) -> float:
    """m of the weather's fog overhead: the haze that is always there takes nothing of the sky."""
    return FOG_DEPTH * max(1.0 - visibility / CLEAREST, 0.0)


def displayed(light: Light) -> tuple[float, float, float]:
    """The fog's colour for the weather, whose own curve then shows it as the scene's curve does."""
    r, g, b = (shown(value) ** 2.2 for value in light.fog_color)
    return r, g, b


def shown(value: float) -> float:
    """Scene light as it is displayed; tone.glsl in plain numbers."""
    c = max(value - 0.004, 0.0)
    return (c * (6.2 * c + 0.5)) / (c * (6.2 * c + 1.7) + 0.06)


def _assign(component: Any, **fields: Any) -> None:
    # An assignment tells the weather that its caches are stale, so only what changed is assigned.
    for name, value in fields.items():
        if getattr(component, name) != value:
            setattr(component, name, value)
