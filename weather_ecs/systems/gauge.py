"""`GaugeList` and `GaugeBoard`: the rain gauges as the GPU is told of them, and their readings.

What the GPU has counted comes back some frames late and is entered where it belongs in time. Where
it has counted nothing (no OpenGL, no drops there) the areas' rates stand in. Readings are the
game's: they are no part of the weather, nor of its snapshots.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Protocol
from weakref import WeakKeyDictionary

import esper

from weather_ecs.components import RainGauge
from weather_ecs.components.rain_gauge import set_rate
from weather_ecs.frame import GaugeData, GaugeReading
from weather_ecs.systems.queries import living

PARTS = 30  # of a window
WATCHED = 0.1  # share of a catch below which the drops of an area say nothing


class Rain(Protocol):
    """What knows the rain in the open and what is under cover."""

    def rain_rates(self, x: float, y: float, z: float) -> dict[int, float]: ...

    def sheltered(self, x: float, y: float, z: float) -> bool: ...


class GaugeList:
    """One `GaugeData` for each gauge, made again only when that gauge has changed."""

    def __init__(self) -> None:
        self._known: WeakKeyDictionary[RainGauge, GaugeData] = WeakKeyDictionary()
        self._next_key = 0
        self._list: object = None
        self._revision = -1
        self._entities: list[int] = []
        self._data: tuple[GaugeData, ...] = ()
        self.gauges: dict[int, RainGauge] = {}  # by key

    def collect(self) -> tuple[GaugeData, ...]:
        """The living gauges; the same tuple as before where nothing has changed."""
        pairs, revision = esper.get_component(RainGauge), RainGauge.revision()
        same = pairs is self._list and revision == self._revision
        if same and all(map(esper.entity_exists, self._entities)):
            return self._data
        self._list, self._revision = pairs, revision
        found = living(RainGauge)
        self._entities = [entity for entity, _ in found]
        self._data = tuple([self._of(gauge) for _, gauge in found])
        self.gauges = {data.key: gauge for data, (_, gauge) in zip(self._data, found, strict=True)}
        return self._data

    def _of(self, gauge: RainGauge) -> GaugeData:
        known = self._known.get(gauge)
        values = (gauge.position, gauge.area, gauge.window)
        if known is not None and (known.position, known.area, known.window) == values:
            return known
        # A gauge that was moved begins anew.
        data = self._known[gauge] = GaugeData(self._next_key, *values)
        self._next_key += 1
        return data


@dataclass(slots=True)
class _Part:
    """A part of a gauge's window; sums over its seconds."""

    seconds: float = 0.0
    open_rates: dict[int, float] = field(default_factory=dict)  # mm/h s by area
    covered: float = 0.0  # s under cover
    counted: float = 0.0  # s for which the GPU has counted
    exposure: float = 0.0
    areas: dict[int, list[float]] = field(default_factory=dict)  # caught, watched, possible

    def rate(self) -> float:
        """mm/h."""
        rates = {key: total / self.seconds for key, total in self.open_rates.items()}
        if not self.counted:
            return math.fsum(rates.values()) * (1.0 - self.covered / self.seconds)
        for key, (caught, watched, possible) in self.areas.items():
            if key in rates and watched > WATCHED * possible:
                rates[key] = caught / watched
        return math.fsum(rates.values()) * self.exposure / self.counted


class GaugeBoard:
    """Keeps every gauge's window and sets its `rate`."""

    def __init__(self) -> None:
        self._time: float | None = None
        self._parts: dict[int, dict[int, _Part]] = {}  # by gauge and by number of the part

    def process(
        self, data: tuple[GaugeData, ...], gauges: dict[int, RainGauge], rain: Rain, time: float
    ) -> None:
        """The time since the last call has passed; set every gauge's reading."""
        before, self._time = self._time, time
        keys = {each.key for each in data}
        self._parts = {key: parts for key, parts in self._parts.items() if key in keys}
        if before is None or time < before:
            self._parts.clear()
            return
        for each in data:
            parts = self._parts.setdefault(each.key, {})
            if time > before:
                self._enter(parts, each, rain, time, time - before)
            seconds = math.fsum(part.seconds for part in parts.values())
            if seconds > 0.0:
                total = math.fsum(part.rate() * part.seconds for part in parts.values())
                set_rate(gauges[each.key], total / seconds)

    def _enter(
        self,
        parts: dict[int, _Part],
        gauge: GaugeData,
        rain: Rain,
        time: float,
        seconds: float,
    ) -> None:
        number = _number(time, gauge)
        for old in [n for n in parts if n <= number - PARTS]:
            del parts[old]
        part = parts.setdefault(number, _Part())
        seconds = min(seconds, gauge.window)
        part.seconds += seconds
        for key, rate in rain.rain_rates(*gauge.position).items():
            part.open_rates[key] = part.open_rates.get(key, 0.0) + rate * seconds
        if rain.sheltered(*gauge.position):
            part.covered += seconds

    def take(self, data: tuple[GaugeData, ...], readings: Iterable[GaugeReading]) -> None:
        """Enter what has come back from the GPU."""
        gauges = {each.key: each for each in data}
        for reading in readings:
            gauge = gauges.get(reading.key)
            parts = self._parts.get(reading.key)
            if gauge is None or parts is None or reading.seconds <= 0.0:
                continue
            part = parts.get(_number(reading.time, gauge))
            if part is None:
                continue
            part.counted += reading.seconds
            part.exposure += reading.exposure * reading.seconds
            for key, *sums in reading.areas:
                totals = part.areas.setdefault(key, [0.0, 0.0, 0.0])
                for k, amount in enumerate(sums):
                    totals[k] += amount * reading.seconds


def _number(time: float, gauge: GaugeData) -> int:
    return math.ceil(time * PARTS / gauge.window)
