"""`Contents`: what a game puts into its weather as a whole, and takes out of it."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from weather_ecs import cloud_world, weathers
from weather_ecs.cloud_files import CloudFile, check_content, load_clouds, save_clouds
from weather_ecs.components._base import FAR, number, vector
from weather_ecs.errors import InvalidValueError
from weather_ecs.simulation import Simulation
from weather_ecs.systems.course import LONGEST
from weather_ecs.systems.queries import in_world
from weather_ecs.weathers import WeatherNow, WholeWeather

if TYPE_CHECKING:
    from weather_ecs.metar import MetarReport

_check_center = vector(2, -FAR, FAR)
_check_transition = number(0.0, LONGEST)


class Contents(Simulation):
    """Whole weathers, reports and files."""

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
