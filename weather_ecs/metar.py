"""METAR reports, which airports publish, as whole weathers; needs the extra `metar`.

The groups are decoded by the `metar` library; what it does not know, or takes for something
else, is put in order before. See docs/metar.md for what each group becomes.
"""

from __future__ import annotations

import math
import re
import warnings
from typing import Any, NamedTuple

from weather_ecs.errors import MetarError, MissingExtraError, shorten
from weather_ecs.metar_falls import Falls, take
from weather_ecs.metar_sky import OKTAS, CloudGroup, bank_of
from weather_ecs.physics.optics import CONTRAST, falling_extinction
from weather_ecs.physics.phase import share_at
from weather_ecs.weathers import MOST_BANKS, WholeWeather

LONGEST = 2000  # characters of a report
FASTEST = 100.0  # m/s, more has never been measured at an airport
COLDEST, HOTTEST = -95.0, 62.0  # degrees Celsius, beyond what was ever measured at the ground
HIGHEST = 20_000.0  # m, of a cloud's base
FAR = 30_000.0  # m of visibility where a report says ten kilometres or more
FOOT = 0.3048
BLOWING = 8.0  # m/s at 10 m above which dry snow is blown (Li and Pomeroy 1997)
KNOT, KMH = 0.514444, 1.0 / 3.6

_TREND = ("NOSIG", "BECMG", "TEMPO", "FCST", "INTER")
_CLEAR = ("NSC", "NCD", "SKC", "CLR", "CAVOK")
_HEAD = re.compile(r"(?:(METAR|SPECI) )?(?:COR )?([A-Z][A-Z0-9]{3}) (\d{2})(\d{2})(\d{2})Z\b")
_PRECISE = re.compile(r"T([01])(\d{3})([01])(\d{3})")
_WIND = re.compile(r"(\d{3}|VRB|///)P?(\d{2,3}|//)(?:GP?(\d{2,3}|//))?(KT|MPS|KMH)")
_SKY = re.compile(r"(FEW|SCT|BKN|OVC|VV)(\d{3}|///)?(CB|TCU|///)?")


class Understood(NamedTuple):
    """One thing that a report says."""

    field: str
    value: Any
    unit: str
    note: str = ""


class Unused(NamedTuple):
    """A part of a report that changes nothing, and why."""

    text: str
    why: str


class MetarReport(NamedTuple):
    """A report that has been read: what was understood, what not, and the weather it makes."""

    text: str
    station: str
    time: str  # day of the month, hour and minute, UTC: "20 06:50"
    understood: tuple[Understood, ...]
    unused: tuple[Unused, ...]
    weather: WholeWeather

    def get(self, field: str) -> Any:
        """The first value of a field, or None."""
        return next((each.value for each in self.understood if each.field == field), None)

    def __str__(self) -> str:
        lines = [f"{self.station}, {self.time} UTC"]
        for field, value, unit, note in self.understood:
            shown = f"{value:g}" if isinstance(value, float) else str(value)
            lines.append(f"  {field:<16} {shown} {unit}".rstrip() + (f" ({note})" if note else ""))
        lines += [f"  not used         {text}: {why}" for text, why in self.unused]
        return "\n".join(lines)


def read_metar(text: Any) -> MetarReport:
    """Read a report. Raises MetarError for no sound one, MissingExtraError without the library."""
    body, unused, precise, station, time = _ordered(text)
    parsed, odd = _parsed(body)
    unused += [Unused(group, "not understood") for group in odd]
    reader = _Reader(parsed, body.split(), precise)
    reader.read()
    if not reader.understood:
        raise MetarError(f"the report of {station} says nothing of the weather: {shorten(text)}")
    unused += reader.unused
    weather = reader.weather(f"{station} {time} UTC")
    return MetarReport(
        " ".join(str(text).split()), station, time, tuple(reader.understood), tuple(unused), weather
    )


def _ordered(text: Any) -> tuple[str, list[Unused], str | None, str, str]:
    """The body as the library takes it, and what was left out of it."""
    if not isinstance(text, str):
        raise MetarError(f"a METAR report is text, not {type(text).__name__}")
    if len(text) > LONGEST:
        raise MetarError(f"a METAR report has at most {LONGEST} characters, not {len(text)}")
    plain = " ".join(text.upper().split()).rstrip("= ")
    head = _HEAD.match(plain)
    if head is None:
        raise MetarError(
            f"no METAR report, which begins with station and time, EHAM 020825Z: {shorten(text)}"
        )
    day, hour, minute = (int(head[k]) for k in (3, 4, 5))
    if not (1 <= day <= 31 and hour <= 23 and minute <= 59):
        raise MetarError(f"no such time: {head[3]}{head[4]}{head[5]}Z")
    unused: list[Unused] = []
    body, _, remarks = plain.partition(" RMK")
    precise = None
    if remarks.strip():
        found = _PRECISE.search(remarks)
        if found is not None:
            precise = found[0]
            remarks = remarks.replace(found[0], "")
        rest = " ".join(remarks.split())
        if rest:
            unused.append(Unused(rest, "remarks"))
    words = body.split()
    for k, word in enumerate(words):
        if word in _TREND:
            unused.append(Unused(" ".join(words[k:]), "a forecast"))
            words = words[:k]
            break
    if "NIL" in words:
        raise MetarError(f"a report without data (NIL): {shorten(text)}")
    if words[0] not in ("METAR", "SPECI"):
        words.insert(0, "METAR")
    words = ["00000KT" if word == "CALM" else word for word in words]
    return " ".join(words), unused, precise, head[2], f"{head[3]} {head[4]}:{head[5]}"


def _parsed(body: str) -> tuple[Any, list[str]]:
    """The library's reading, and groups that it could not read."""
    try:
        from metar import Metar
    except ImportError:
        raise MissingExtraError("metar", "metar") from None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            # A month of 31 days: a report has none, and which one it was does not matter here.
            parsed = Metar.Metar(body, month=1, year=2000, strict=False)
        except Exception as error:
            raise MetarError(f"the report cannot be read: {error}") from error
    return parsed, list(parsed._unparsed_groups)


class _Reader:
    """Turns a parsed report into what is understood, and into a weather."""

    def __init__(self, parsed: Any, words: list[str], precise: str | None) -> None:
        self._parsed, self._words, self._precise = parsed, words, precise
        self.understood: list[Understood] = []
        self.unused: list[Unused] = []
        self._fields: dict[str, Any] = {}
        self._falls = Falls()
        self._clouds: list[CloudGroup] = []
        self._visibility: float | None = None
        self._temperature: float | None = None
        self._dew_point: float | None = None

    def read(self) -> None:
        """Read all groups."""
        self._wind()
        self._sight()
        for intensity, desc, falling, sight, other in self._parsed.weather:
            parts = [part or "" for part in (intensity, desc, falling, sight, other)]
            if any(part.strip("/") for part in parts[1:]):
                words = take(self._falls, *parts)
                self.understood.append(Understood("weather", words, "", "".join(parts)))
        self._sky()
        self._air()
        for attribute, what in (("runway", "runway visual range"), ("windshear", "wind shear")):
            for each in getattr(self._parsed, attribute):
                name = each[0] if isinstance(each, list) else each
                self.unused.append(Unused(f"R{name}", what))
        for each in self._parsed.recent:
            self.unused.append(Unused("RE" + "".join(p or "" for p in each), "weather of before"))

    def _add(self, field: str, value: Any, unit: str, note: str = "") -> None:
        self.understood.append(Understood(field, value, unit, note))

    def _wind(self) -> None:
        word = next((w for w in self._words[3:] if _WIND.fullmatch(w)), None)
        match = None if word is None else _WIND.fullmatch(word)
        if match is None or match[2] == "//":
            return
        unit = {"KT": KNOT, "MPS": 1.0, "KMH": KMH}[match[4]]
        speed = int(match[2]) * unit
        gust = int(match[3]) * unit if match[3] and match[3] != "//" else None
        if max(speed, gust or 0.0) > FASTEST:
            raise MetarError(f"no wind of this planet: {word}, allowed: up to {FASTEST:g} m/s")
        fields: dict[str, Any] = {"wind_speed": speed, "veer": 0.15, "gustiness": 0.15}
        self._add("wind_speed", round(speed, 2), "m/s", "calm" if not speed else "")
        if match[1].isdigit():
            bearing = int(match[1])
            if bearing > 360:
                raise MetarError(f"no direction: {word}, allowed: 000 to 360")
            if speed:
                fields["wind_from"] = float(bearing)
                self._add("wind_from", float(bearing), "degrees")
        elif match[1] == "VRB":
            fields["veer"] = 0.5 * math.pi
            self._add("wind_from", "variable", "")
        if gust is not None:
            self._add("gusts", round(gust, 2), "m/s")
            fields["gustiness"] = min(max(gust / max(speed, 0.5) - 1.0, 0.0), 1.0)
            if gust > 2.0 * speed:  # a wind's strongest gusts are up to twice its mean
                fields["wind_speed"] = 0.5 * gust
                why = f"{0.5 * gust:.1f}, so that its gusts are as strong as reported"
                self.unused.append(Unused(f"{speed:.1f} m/s", why))
        first, last = self._parsed.wind_dir_from, self._parsed.wind_dir_to
        if first is not None and last is not None:
            a, b = first.value(), last.value()
            self._add("wind_varies", f"{a:.0f} to {b:.0f}", "degrees")
            fields["veer"] = min(math.radians((b - a) % 360.0) * 0.5, math.pi)
        self._fields |= fields

    def _sight(self) -> None:
        if "CAVOK" in self._words:
            self._visibility = FAR
            self._add("visibility", 10_000.0, "m", "or more: CAVOK")
            return
        found = [v for v in (self._parsed.vis, self._parsed.max_vis) if v is not None]
        if not found or "////" in self._words:  # the library takes that for ten kilometres
            return
        value = min(each.value("M") for each in found)
        known = any(word.endswith("SM") for word in self._words)
        most = value >= 9999.0 or (known and value >= 9600.0)
        self._visibility = FAR if most else value
        note = "or more" if most else "the least of its directions" if len(found) > 1 else ""
        self._add("visibility", round(value, 1), "m", note)

    def _sky(self) -> None:
        for amount, height, kind in self._parsed.sky:
            if amount == "CLR":
                self._add("clouds", "none", "", "clear")
                continue
            if amount in ("NSC", "NCD"):
                self._add("clouds", "none", "", "of significance")
                continue
            if amount not in OKTAS:
                if kind in ("CB", "TCU"):
                    self._clouds.append(CloudGroup("FEW", None, kind))
                    self._add("clouds", kind, "", "amount and base not reported")
                continue
            base = None if height is None else height.value("FT") * FOOT
            if base is not None and base > HIGHEST:
                raise MetarError(f"no base of a cloud: {base:.0f} m, allowed: to {HIGHEST:g} m")
            self._clouds.append(CloudGroup(amount, base, kind or ""))
            feet = "base not reported" if height is None else f"{height.value('FT'):.0f} ft"
            self._add("clouds", f"{amount} {kind or ''}".strip(), f"at {feet}")
        if "CAVOK" in self._words:
            self._add("clouds", "none", "", "below 5000 ft")

    def _air(self) -> None:
        parsed = self._parsed
        t = None if parsed.temp is None else parsed.temp.value("C")
        dew = None if parsed.dewpt is None else parsed.dewpt.value("C")
        if self._precise is not None:
            a, b, c, d = _PRECISE.fullmatch(self._precise).groups()  # type: ignore[union-attr]
            t, dew = (int(v) * (-0.1 if s == "1" else 0.1) for s, v in ((a, b), (c, d)))
        for name, value in (("temperature", t), ("dew point", dew)):
            if value is not None and not COLDEST <= value <= HOTTEST:
                raise MetarError(
                    f"no {name} of this planet: {value:g}, allowed: {COLDEST:g} to {HOTTEST:g}"
                )
        if t is not None:
            self._add("temperature", round(t, 1), "degrees Celsius")
            self._temperature = t
        if t is not None and dew is not None:
            self._dew_point = min(dew, t)
            self._add("dew_point", round(dew, 1), "degrees Celsius")
            self._add("humidity", round(humidity(t, self._dew_point), 3), "", "of the two")
        if parsed.press is not None:
            self.unused.append(Unused(f"{parsed.press.value('HPA'):.0f} hPa", "pressure"))

    def weather(self, name: str) -> WholeWeather:
        """The weather that the report describes."""
        falls = self._falls
        wet = falls.rate > 0.0
        t = self._temperature
        if t is None:
            t = -2.0 if falls.frozen else 15.0
        damp = 0.95 if wet else 0.7
        if self._dew_point is not None:
            damp = humidity(t, self._dew_point)
        rate = falls.rate if not (falls.thunder and wet) else max(falls.rate, 8.0)
        adjusted = _to_fall(t, damp, falls.frozen) if falls.frozen or falls.liquid else t
        if adjusted != t:
            what = "snow" if falls.frozen else "rain"
            self.unused.append(Unused(f"{t:g} degrees", f"{adjusted:.1f}, at which {what} falls"))
        frozen = share_at(adjusted, damp)
        sight = self._visibility
        if sight is None:
            sight = falls.sight if falls.sight is not None else FAR
        if falls.blowing_snow and self._fields.get("wind_speed", 0.0) > BLOWING:
            # The flux of blown snow rises with the cube of the wind and more (Pomeroy and Gray).
            sight = min(sight, 5000.0 * (BLOWING / self._fields["wind_speed"]) ** 3)
        most = CONTRAST / max(sight, 1.0)
        known = rate
        while (
            rate > 0.2 * known and falling_extinction(rate * (1.0 - frozen), rate * frozen) > most
        ):
            rate *= 0.95  # so much would hide more than is reported
        rain, snow = rate * (1.0 - frozen), rate * frozen
        lost = max(CONTRAST / max(sight, 1.0) - falling_extinction(rain, snow), CONTRAST / 50_000.0)
        groups = sorted(self._clouds, key=lambda g: g.base or 0.0)[:MOST_BANKS]
        banks = tuple([bank_of(group, falls.kind) for group in groups])
        open_sky = math.prod([1.0 - OKTAS[group.amount] / 8.0 for group in groups])
        if falls.thunder and not any(group.kind == "CB" for group in groups):
            groups_left = banks[: MOST_BANKS - 1]
            banks = (*groups_left, bank_of(CloudGroup("SCT", 900.0, "CB"), falls.kind))
        overcast = 1.0 - open_sky
        state = 0.7 * overcast + (0.15 if wet else 0.0)
        if falls.thunder:
            state = max(state, 0.6 + 0.4 * falls.thunder)
        return WholeWeather(
            name,
            min(state, 1.0),
            rain_rate=rate,
            rain_radius=4000.0 if falls.showers else 8000.0,
            temperature=adjusted,
            humidity=damp,
            visibility=CONTRAST / lost,
            lightning=falls.thunder,
            overcast=overcast,
            haze=0.7 if falls.haze else min(max(1.0 - math.log10(sight / 500.0) / 2.0, 0.1), 0.9),
            banks=banks,
            **{"wind_speed": 0.0, **self._fields},
        )


def humidity(temperature: float, dew_point: float) -> float:
    """Relative humidity, 0 to 1, of two temperatures in degrees Celsius.

    Magnus's formula with the constants of Alduchov and Eskridge (1996).
    """
    over = 17.625 * dew_point / (243.04 + dew_point) - 17.625 * temperature / (243.04 + temperature)
    return min(max(math.exp(over), 0.0), 1.0)


def _to_fall(temperature: float, damp: float, frozen: bool) -> float:
    """The nearest temperature at which what was reported falls so, in tenths of a degree."""
    step = -0.1 if frozen else 0.1
    for k in range(400):
        t = round(temperature + k * step, 1) if k else temperature
        share = share_at(t, damp)
        if (share > 0.9) if frozen else (share < 0.1):
            return t
    return temperature
