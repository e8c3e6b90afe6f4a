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
from weather_ecs.metar_falls import take
from weather_ecs.metar_sky import OKTAS, CloudGroup
from weather_ecs.metar_weather import FAR, Observed, humidity, weather_of
from weather_ecs.weathers import WholeWeather

LONGEST = 2000  # characters of a report
FASTEST = 100.0  # m/s, more has never been measured at an airport
COLDEST, HOTTEST = -95.0, 62.0  # degrees Celsius, beyond what was ever measured at the ground
HIGHEST = 20_000.0  # m, of a cloud's base
FOOT = 0.3048
KNOT, KMH = 0.514444, 1.0 / 3.6

_TREND = ("NOSIG", "BECMG", "TEMPO", "FCST", "INTER")
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
    weather, changed = weather_of(f"{station} {time} UTC", reader.observed)
    unused += [*reader.unused, *[Unused(*each) for each in changed]]
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
    return parsed, list(parsed._unparsed_groups)  # noqa: SLF001, no other name


class _Reader:
    """Turns a parsed report into what is understood, and into a weather."""

    def __init__(self, parsed: Any, words: list[str], precise: str | None) -> None:
        self._parsed, self._words, self._precise = parsed, words, precise
        self.understood: list[Understood] = []
        self.unused: list[Unused] = []
        self.observed = Observed()

    def read(self) -> None:
        """Read all groups."""
        self._wind()
        self._sight()
        for intensity, desc, falling, sight, other in self._parsed.weather:
            parts = [part or "" for part in (intensity, desc, falling, sight, other)]
            if any(part.strip("/") for part in parts[1:]):
                words = take(self.observed.falls, *parts)
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
        self.observed.fields |= fields

    def _sight(self) -> None:
        if "CAVOK" in self._words:
            self.observed.visibility = FAR
            self._add("visibility", 10_000.0, "m", "or more: CAVOK")
            return
        found = [v for v in (self._parsed.vis, self._parsed.max_vis) if v is not None]
        if not found or "////" in self._words:  # the library takes that for ten kilometres
            return
        value = min(each.value("M") for each in found)
        known = any(word.endswith("SM") for word in self._words)
        most = value >= 9999.0 or (known and value >= 9600.0)
        self.observed.visibility = FAR if most else value
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
                    self.observed.clouds.append(CloudGroup("FEW", None, kind))
                    self._add("clouds", kind, "", "amount and base not reported")
                continue
            base = None if height is None else height.value("FT") * FOOT
            if base is not None and base > HIGHEST:
                raise MetarError(f"no base of a cloud: {base:.0f} m, allowed: to {HIGHEST:g} m")
            self.observed.clouds.append(CloudGroup(amount, base, kind or ""))
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
            self.observed.temperature = t
        if t is not None and dew is not None:
            self.observed.dew_point = min(dew, t)
            self._add("dew_point", round(dew, 1), "degrees Celsius")
            self._add("humidity", round(humidity(t, self.observed.dew_point), 3), "", "of the two")
        if parsed.press is not None:
            self.unused.append(Unused(f"{parsed.press.value('HPA'):.0f} hPa", "pressure"))
