"""The weather of a file in the game, and of the same file while somebody edits it."""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import esper

from demo_game.mood import Mood, climate_mood
from weather_ecs import CloudFile, load_clouds
from weather_ecs.components import Atmosphere, Climate, CloudModel, RainArea
from weather_ecs.errors import WeatherError

LOOK_EVERY = 0.5  # s between two looks at the file
WIDEST = 34  # characters of a line of the readout
OWN = ("air", "fog", "rain_container", "snow_flakes", "splash_emitter")  # the game has these
SKY = ("latitude", "longitude", "turbidity", "stars", "disc", "halo", "rainbow", "adaptation")

Bundle = tuple[Any, ...]  # components of one entity


class FileWeather:
    """Entities of what a file holds. Raises WeatherError for one that is not good.

    With `watch` the file is looked at twice a second. What has changed in it takes the place of
    what it was, and all else goes on as it is; a file that is not good changes nothing but
    `problem`.
    """

    def __init__(self, path: str, *, watch: bool = False) -> None:
        self.path = Path(path)
        self.problem = ""
        self.readings = 0  # how often it was taken
        self._watched, self._wait = watch, 0.0
        self._stamp = _stamp(self.path)
        self.content = load_clouds(self.path)
        self._entities: dict[str, list[tuple[Any, int]]] = {}  # what is in them, by field
        self._replaced: dict[int, CloudModel] = {}  # models of the game's of the same name
        self._sky: Any = None  # that was set last
        self._put(self.content)

    @property
    def areas(self) -> list[RainArea]:
        """Its rain areas, as they are now."""
        found = [entity for _, entity in self._entities.get("rain_areas", [])]
        return [esper.component_for_entity(entity, RainArea) for entity in found]

    @property
    def climate(self) -> Climate | None:
        """Its climate, as it is now."""
        for _, entity in self._entities.get("climate", []):
            return esper.component_for_entity(entity, Climate)
        return None

    def look(self, dt: float) -> str:
        """Let dt seconds pass; what to tell the player, if the file is another."""
        self._wait += dt
        if not self._watched or self._wait < LOOK_EVERY:
            return ""
        self._wait = 0.0
        stamp = _stamp(self.path)
        if stamp == self._stamp:
            return ""
        self._stamp = stamp
        try:
            content = load_clouds(self.path)
        except WeatherError as error:
            self.problem = _short(str(error), self.path)
            return f"{_cut(self.path.name)} is not good; the last good state is kept (F3)"
        self.problem = ""
        self._put(content)
        return f"{_cut(self.path.name)} read again"

    def mood(self, state: float, heading: float) -> Mood:
        """What the game follows: the climate's state, and what the file says of air and wind."""
        content = self.content
        mood = climate_mood(state, heading)
        if content.winds:
            speed = sum(wind.speed for wind in content.winds)
            mood = replace(mood, wind_speed=speed, lent=1.0)
        if content.air is not None:
            air = content.air
            mood = replace(mood, temperature=air.temperature, humidity=air.humidity)
        if content.fog is not None:
            mood = replace(mood, visibility=max(content.fog.visibility, 1.0))
        return mood

    def set_sky(self, atmosphere: Atmosphere) -> None:
        """Let the game's sky be the file's, but for what covers it."""
        given = self.content.atmosphere
        if given is None or _plain(given) == self._sky:
            return
        self._sky = _plain(given)
        for name in SKY:
            setattr(atmosphere, name, getattr(given, name))
        atmosphere.time, atmosphere.speed = given.time, given.speed

    def lines(self) -> list[str]:
        """For the readout: what is wrong, or how often the file was read again."""
        if not self._watched:
            return []
        if not self.problem:
            again = f", read again {self.readings - 1} x" if self.readings > 1 else ""
            return [_cut(f"watching {self.path.name}{again}")]
        lines = [""]
        for word in ["not good:", *self.problem.split()]:
            if lines[-1] and len(lines[-1]) + 1 + len(word) > WIDEST:
                lines.append("")
            lines[-1] = f"{lines[-1]} {word}".strip()
        if len(lines) > 3:
            lines[2] = f"{lines[2]:.{WIDEST - 2}} …"
        return [_cut(line) for line in lines[:3]]

    def leave(self) -> None:
        """The game has other wind and rain now; clouds and climate stay."""
        for key in ("rain_areas", "winds"):
            for _, entity in self._entities.pop(key, []):
                self._remove(entity)

    def _put(self, content: CloudFile) -> None:
        """Let the entities be those of a content; what says the same stays as it is."""
        placed: dict[str, list[tuple[Any, int]]] = {}
        spare = {key: list(row) for key, row in self._entities.items()}
        for key, bundles in _bundles(content).items():
            known, row = spare.get(key, []), []
            for bundle in bundles:
                value = _plain(bundle)
                same = next((each for each in known if each[0] == value), None)
                if same is not None and esper.entity_exists(same[1]):
                    known.remove(same)
                else:
                    same = value, self._made(bundle)
                row.append(same)
            placed[key] = row
        kept = {entity for row in placed.values() for _, entity in row}
        for rest in spare.values():
            for _, entity in rest:
                if entity not in kept:
                    self._remove(entity)
        self._entities, self.content = placed, content
        self.readings += 1

    def _made(self, bundle: Bundle) -> int:
        """An entity of these components; a model takes the place of one of the same name."""
        [first, *_] = bundle
        if isinstance(first, CloudModel):
            own = {entity for _, entity in self._entities.get("models", [])}
            for entity, model in esper.get_component(CloudModel):
                if model.name == first.name:
                    if entity not in own:
                        self._replaced.setdefault(entity, model)
                    esper.add_component(entity, first)
                    return entity
        return esper.create_entity(*bundle)

    def _remove(self, entity: int) -> None:
        before = self._replaced.pop(entity, None)
        if before is not None and esper.entity_exists(entity):
            esper.add_component(entity, before)
        elif esper.entity_exists(entity):
            esper.delete_entity(entity, immediate=True)


def _bundles(content: CloudFile) -> dict[str, list[Bundle]]:
    """The components of the entities, by field; what the game has of its own is left out."""
    found: dict[str, list[Bundle]] = {}
    for entry in fields(content):
        value = getattr(content, entry.name)
        if entry.name in (*OWN, "atmosphere", "layer_climates", "extra", "quality"):
            continue
        parts = value if isinstance(value, tuple) else () if value is None else (value,)
        found[entry.name] = [(part,) for part in parts]
    for index, climate in enumerate(content.layer_climates):
        if climate is not None:
            found["layers"][index] += (climate,)
    return found


def _plain(value: Any) -> Any:
    """What can be compared: components are the same when their values are."""
    if is_dataclass(value) and not isinstance(value, type):
        return type(value), tuple(_plain(getattr(value, entry.name)) for entry in fields(value))
    return tuple(map(_plain, value)) if isinstance(value, tuple) else value


def _short(text: str, path: Path) -> str:
    return " ".join(text.replace(str(path), path.name).split())


def _cut(text: str) -> str:
    return text if len(text) <= WIDEST else f"{text[: WIDEST - 1]}…"


def _stamp(path: Path) -> tuple[int, ...] | None:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
