"""METAR reports: what is understood, what it becomes, what is refused."""

from __future__ import annotations

import builtins
import math
import sys
from dataclasses import replace
from pathlib import Path

import esper
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import Fog, SkyLayer
from weather_ecs.errors import InvalidValueError, MetarError, MissingExtraError
from weather_ecs.metar import read_metar
from weather_ecs.metar_falls import RATES
from weather_ecs.metar_weather import FAR, humidity
from weather_ecs.physics.haze import haze_visibility

pytestmark = pytest.mark.usefixtures("world")

FILE = Path(__file__).parent / "data" / "metars.txt"
REAL = [line for line in FILE.read_text().splitlines() if line and line[0] != "#"]
KNOT, MILE, FOOT = 0.514444, 1609.344, 0.3048


def find(station: str) -> str:
    return next(line for line in REAL if station in line)


def said(text: str) -> dict[str, list]:
    """Values by field, in order."""
    found: dict[str, list] = {}
    for each in read_metar(text).understood:
        found.setdefault(each.field, []).append(each.value)
    return found


# Field by field, written by hand from the reports and the code's own tables

EXPECTED = [
    (
        find("KEWR"),
        {
            "wind_speed": [3 * KNOT], "wind_from": ["variable"], "gusts": [19 * KNOT],
            "visibility": [2 * MILE], "weather": ["thunderstorm with rain", "mist"],
            "clouds": ["FEW", "BKN CB", "BKN", "OVC"], "temperature": [22.7], "dew_point": [21.5],
        },
        {"bases": [1500, 4000, 6500, 20000], "lightning": 1.0, "state": 1.0, "falls": "rain"},
    ),
    (
        find("LOWS"),
        {
            "wind_speed": [2 * KNOT], "wind_from": ["variable"], "visibility": [8000.0],
            "weather": ["light rain"], "clouds": ["FEW", "SCT", "BKN"], "temperature": [14.0],
            "dew_point": [13.0],
        },
        {"bases": [400, 2000, 3000], "rate": 1.5, "falls": "rain"},
    ),
    (
        find("LBBG"),
        {
            "wind_speed": [12.0], "wind_from": [120.0], "wind_varies": ["90 to 150"],
            "visibility": [1400.0], "weather": ["heavy snow"], "clouds": ["BKN", "OVC"],
            "temperature": [-4.0], "dew_point": [-7.0],
        },
        {"bases": [2200, 5000], "falls": "snow", "models": ["stratocumulus", "nimbostratus"]},
    ),
    (
        find("EHAM"),
        {
            "wind_speed": [22 * KNOT], "wind_from": [210.0], "wind_varies": ["190 to 250"],
            "visibility": [10_000.0], "clouds": ["FEW", "SCT", "BKN"], "temperature": [17.0],
            "dew_point": [15.0],
        },
        {"bases": [800, 1800, 2200], "rate": 0.0, "sight": FAR},
    ),
    (
        find("LPPT"),
        {
            "wind_speed": [3 * KNOT], "wind_from": [240.0], "visibility": [10_000.0],
            "clouds": ["FEW"], "temperature": [10.0], "dew_point": [7.0],
        },
        {"bases": [1500], "models": ["cumulus"], "rate": 0.0},
    ),
    (
        find("ZYAS"),
        {
            "wind_speed": [9.0], "wind_from": [210.0], "gusts": [14.0], "visibility": [6000.0],
            "clouds": ["none"], "temperature": [18.0], "dew_point": [8.0],
        },
        {"bases": [], "state": 0.0, "gustiness": 14.0 / 9.0 - 1.0, "sight": 6000.0},
    ),
    (
        "KJFK 111851Z 00000KT P6SM CLR 15/M02 A3012",
        {"wind_speed": [0.0], "visibility": [6 * MILE], "clouds": ["none"], "dew_point": [-2.0]},
        {"bases": [], "sight": FAR},
    ),
    (
        "KORD 111851Z 18015G28KT 1 1/2SM -SN BLSN OVC009 M05/M07 A2987",
        {"visibility": [1.5 * MILE], "weather": ["light snow", "blowing snow"], "clouds": ["OVC"]},
        {"bases": [900], "falls": "snow", "models": ["stratus"]},
    ),
    (
        "SPECI PANC 111853Z AUTO CALM M1/4SM FZFG VV001 M12/M13 A3001",
        {"wind_speed": [0.0], "visibility": [MILE / 4], "weather": ["freezing fog"],
         "clouds": ["VV"], "temperature": [-12.0]},
        {"sight": MILE / 4, "oktas": [8.0], "rate": 0.0},
    ),
    (
        "UUEE 111830Z 27010MPS CAVOK M20/M25 Q1030 R06L/290050 NOSIG",
        {"wind_speed": [10.0], "visibility": [10_000.0], "clouds": ["none"],
         "temperature": [-20.0]},
        {"bases": [], "sight": FAR},
    ),
    (
        "LFPG 111830Z 24040G65KMH 4000 2000NE SHRA SCT030TCU 12/10 Q1000",
        {"wind_speed": [40 / 3.6], "gusts": [65 / 3.6], "visibility": [2000.0],
         "weather": ["showers of rain"], "clouds": ["SCT TCU"]},
        {"bases": [3000], "models": ["cumulus"], "falls": "rain", "rate": 5.0, "radius": 4000.0},
    ),
    (
        "KDEN 111853Z 35012KT 1/2SM +TSRAGR SQ BKN025CB OVC080 14/12 A2990 RMK AO2",
        {"weather": ["heavy thunderstorm with rain and hail", "squalls"],
         "clouds": ["BKN CB", "OVC"]},
        {"rate": 20.0, "lightning": 1.0, "models": ["cumulonimbus", "altostratus"]},
    ),
    (
        "SAEZ 111800Z 36004KT 1500 DZ BR OVC003 10/10 Q1011",
        {"weather": ["drizzle", "mist"], "visibility": [1500.0], "humidity": [1.0]},
        {"rate": 0.4, "models": ["stratus"], "falls": "rain"},
    ),
    (
        "EGLL 111820Z AUTO 24012KT 9999 NCD 18/12 Q1015",
        {"wind_from": [240.0], "clouds": ["none"]},
        {"bases": [], "rate": 0.0},
    ),
    (
        "RJTT 111830Z 34008KT 310V010 9999 FEW030 SCT180 //////CB 26/22 Q1007 TEMPO 3000 TSRA",
        {"wind_varies": ["310 to 10"], "clouds": ["FEW", "SCT", "CB"], "temperature": [26.0]},
        {"rate": 0.0, "lightning": 0.0, "veer": math.radians(30.0)},
    ),
    (
        "VABB 111830Z 25010KT 3500 HZ NSC 30/26 Q1006 NOSIG=",
        {"weather": ["haze"], "visibility": [3500.0], "clouds": ["none"]},
        {"sight": 3500.0, "haze": 0.7},
    ),
    (
        "CYYZ 111800Z 09025G35KT 3/4SM R05/4000FT/N -FZRA BR OVC008 M02/M03 A2951 RMK ST8",
        {"weather": ["light freezing rain", "mist"], "visibility": [0.75 * MILE],
         "temperature": [-2.0]},
        {"falls": "rain", "models": ["stratus"]},
    ),
    (
        "LOWW 111820Z 30018G32KT 9999 VCTS FEW045TCU 20/10 Q1009",
        {"weather": ["thunderstorm in the vicinity"], "clouds": ["FEW TCU"]},
        {"rate": 0.0, "lightning": 0.4},
    ),
]  # fmt: skip


@pytest.mark.parametrize(("text", "fields", "made"), EXPECTED, ids=[e[0][:14] for e in EXPECTED])
def test_reports_field_by_field(text, fields, made):
    found = said(text)
    for name, values in fields.items():
        if isinstance(values[0], float):
            assert found[name] == pytest.approx(values, abs=0.06), name
        else:
            assert found[name] == values, name
    whole = read_metar(text).weather
    if "bases" in made:
        heights = [max(feet * FOOT, 60.0) for feet in made["bases"]]
        assert [b.base for b in whole.banks][: len(heights)] == pytest.approx(heights)
    if "models" in made:
        assert [b.models[0] for b in whole.banks][: len(made["models"])] == made["models"]
    if "oktas" in made:
        assert [b.oktas for b in whole.banks] == made["oktas"]
    if "rate" in made:
        assert whole.rain_rate == pytest.approx(made["rate"], rel=0.2)
    if "sight" in made:
        assert whole.visibility == pytest.approx(made["sight"], rel=1e-6)
    for name, value in made.items():
        if name in ("lightning", "state", "gustiness", "veer", "haze"):
            assert getattr(whole, name) == pytest.approx(value), name
    if "radius" in made:
        assert whole.rain_radius == made["radius"]
    with fresh_world(), Weather() as weather:
        assert weather.apply_metar(text).weather == whole
        here = weather.sample((0, 0, 0))
        if "falls" in made:
            rain, snow = here.rain_rate, here.snow_rate
            assert (snow > 5 * rain) if made["falls"] == "snow" else (rain > 5 * snow)
        assert len(esper.get_component(SkyLayer)) == len(whole.banks)


@pytest.mark.parametrize("text", REAL)
def test_every_real_report_is_understood_from_end_to_end(text):
    report = read_metar(text)
    assert not [each for each in report.unused if each.why == "not understood"]
    shown = str(report)
    assert report.station in shown and all(each.field in shown for each in report.understood)
    assert {each.field for each in report.understood} >= {"wind_speed", "visibility", "temperature"}
    # With "METAR" or without, in small letters, with blanks and an end sign.
    again = read_metar("  " + text.removeprefix("METAR ").lower().replace(" ", "  ") + " =\n")
    assert again.weather == report.weather


def test_a_sample_sees_as_far_as_the_report_says():
    for text in REAL:
        with fresh_world(), Weather() as weather:
            report = weather.apply_metar(text)
            seen, told = weather.sample((0, 0, 0)).visibility, report.get("visibility")
            if told < 9999.0:
                assert seen == pytest.approx(told, rel=0.35), text
            else:
                assert seen > told


@pytest.mark.parametrize(
    ("code", "kind", "strength"),
    [("-RA", "RA", 0), ("RA", "RA", 1), ("+RA", "RA", 2), ("-DZ", "DZ", 0), ("DZ", "DZ", 1),
     ("+DZ", "DZ", 2), ("-SN", "SN", 0), ("SN", "SN", 1), ("+SN", "SN", 2), ("SG", "SG", 1),
     ("PL", "PL", 1), ("GR", "GR", 1), ("GS", "GS", 1), ("UP", "UP", 1), ("-RADZ", "RA", 0),
     ("SHSN", "SN", 1), ("FZDZ", "DZ", 1), ("RASN", "RA", 1), ("+SHRA", "RA", 2)],
)  # fmt: skip
def test_intensities(code, kind, strength):
    t = "M03/M04" if kind in ("SN", "SG") else "08/07"
    whole = read_metar(f"EHAM 020825Z 21012KT {code} OVC020 {t} Q1002").weather
    assert whole.rain_rate == RATES[kind][strength]


@pytest.mark.parametrize("code", ["VCSH", "VCFG", "DRSN", "BLSN", "BR", "FU", "MIFG", "SQ", "PO"])
def test_what_does_not_fall_here(code):
    assert read_metar(f"EHAM 020825Z 21022KT 9999 {code} M05/M07").weather.rain_rate == 0.0


def test_sight_where_a_report_has_none():
    for code, least, most in (("FG", 100, 999), ("BR", 1000, 5000), ("HZ", 1000, 10_000)):
        seen = read_metar(f"EHAM 020825Z 21002KT {code} 10/10").weather.visibility
        assert least <= seen <= most
    far = [
        read_metar(f"EHAM 020825Z 210{speed}MPS BLSN M10/M12").weather.visibility
        for speed in ("05", "12", "20", "30")
    ]
    assert far == sorted(far, reverse=True) and far[0] == FAR and far[-1] < 200.0


def test_rates_follow_the_classes_of_the_ams():
    light, moderate, heavy = RATES["RA"]
    assert 0.25 < light < 2.5 < moderate < 7.6 < heavy
    assert RATES["DZ"][0] < 0.3 < RATES["DZ"][1] < 0.5 < RATES["DZ"][2]
    assert RATES["GR"][1] > 7.6


def test_humidity_of_two_temperatures():
    # Saturation vapour pressures over water in hPa, of the Smithsonian tables.
    assert humidity(20.0, 10.0) == pytest.approx(12.27 / 23.37, abs=2e-3)
    assert humidity(0.0, -10.0) == pytest.approx(2.863 / 6.108, abs=3e-3)
    assert humidity(5.0, 5.0) == 1.0


def test_the_wind_blows_from_where_it_says():
    with Weather() as weather:
        weather.apply_metar("EHAM 020825Z 27010MPS CAVOK 15/10 Q1015")
        blown = [0.0, 0.0]
        for _ in range(600):
            esper.process(1.0)
            x, _, z = weather.sample((0, 0, 0)).wind
            blown = [blown[0] + x / 600, blown[1] + z / 600]
        assert blown[0] == pytest.approx(10.0, rel=0.1)  # to the east, +x
        assert abs(blown[1]) < 1.0


def test_it_takes_the_time_it_is_given_and_says_what_it_did():
    with Weather() as weather:
        weather.change_to("clear")
        report = weather.apply_metar(find("LBBG"), 20.0)
        assert report.station == "LBBG" and report.time == "04 16:00"
        assert report.unused[0].text == "NOSIG"
        for _ in range(20):
            assert weather.whole.progress < 1.0
            esper.process(1.0)
        assert weather.whole.progress == 1.0 and weather.whole.name == "LBBG 04 16:00 UTC"
        fog = esper.component_for_entity(weather.whole.entities["fog"], Fog)
        assert fog.visibility == pytest.approx(report.weather.visibility)


@pytest.mark.parametrize(
    "seen", ["9999", "8000", "4000 HZ", "9999 HZ", "3000 BR", "0300 FG", "1200"]
)
def test_haze_never_hides_what_the_report_lets_one_see(seen):
    report = read_metar(f"EHAM 020825Z 21008KT {seen} SCT030 17/10 Q1002")
    assert haze_visibility(report.weather.haze) >= 0.999 * report.weather.visibility


BAD = [
    "", "   ", "METAR", "METAR EHAM", "METAR EHAM 020825Z", "EHAM 020825", "hello world",
    "x" * 100_000, "EHAM 020825Z " + "FEW010 " * 20_000, "\x00" * 50, "EHAM 020825Z garbage junk",
    "EHAM 020825Z NIL", "EHAM 020825Z 99999KT", "EHAM 020825Z 18099G999MPS 9999",
    "EHAM 020825Z 180250KT", "EHAM 020825Z 40010KT", "EHAM 320825Z 18010KT", "EHAM 022599Z 18010KT",
    "EHAM 020825Z 18010KT 9999 OVC999", "EHAM 020825Z 99/99", "EHAM 020825Z M99/M99",
    "EGLL 111820Z AUTO ///// //// // ////// ///// Q////", b"METAR EHAM 020825Z 21022KT 9999",
    None, 5, ["EHAM 020825Z 21022KT"],
]  # fmt: skip


@pytest.mark.parametrize("text", BAD, ids=lambda text: repr(text)[:30])
def test_bad_reports_are_refused_and_change_nothing(text):
    with Weather() as weather:
        weather.change_to("fair_cumulus")
        esper.process(2.0)
        before = weather.snapshot()
        with pytest.raises(MetarError) as caught:
            weather.apply_metar(text)
        assert 10 < len(str(caught.value)) < 400
        assert weather.snapshot() == before
        with pytest.raises(InvalidValueError):
            weather.apply_metar(REAL[0], -1.0)
        assert weather.snapshot() == before


@pytest.mark.parametrize("text", REAL)
def test_cut_off_anywhere_it_is_an_error_or_a_weather(text):
    for length in range(0, len(text), 3):
        try:
            report = read_metar(text[:length])
        except MetarError:
            continue
        assert report.understood and report.weather.conditions(0.0)


@settings(deadline=None, max_examples=150)
@given(
    st.lists(
        st.one_of(
            st.sampled_from(" ".join(REAL).split()),
            st.from_regex(r"[A-Z0-9/]{1,9}", fullmatch=True),
            st.text(max_size=6),
        ),
        max_size=14,
    )
)
def test_any_words_are_an_error_or_a_weather(words):
    try:
        report = read_metar("EHAM 020825Z " + " ".join(words))
    except MetarError:
        return
    assert str(report)
    with fresh_world(), Weather() as weather:
        weather.change_to(report.weather)
        assert weather.sample((0, 0, 0)).visibility > 0.0


def test_without_the_library_the_error_names_the_extra(monkeypatch):
    real = builtins.__import__

    def refuse(name, *args, **kwargs):
        if name.split(".")[0] == "metar":
            raise ImportError(name)
        return real(name, *args, **kwargs)

    for name in [name for name in sys.modules if name.split(".")[0] == "metar"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(builtins, "__import__", refuse)
    with Weather() as weather:
        with pytest.raises(MissingExtraError, match=r"weather_ecs\[metar\]"):
            weather.apply_metar(REAL[0])
        assert weather.whole is None


def test_there_is_no_report_from_the_future():
    """A report says the day of a month and no more: any day gives the same weather, at any time."""
    rest = "0825Z 21022KT 9999 BKN022 17/15 Q1002"
    made = [read_metar(f"EHAM {day:02}{rest}") for day in (1, 2, 28, 29, 30, 31)]
    assert len({replace(report.weather, name="any") for report in made}) == 1
    assert len({str(report).splitlines()[0] for report in made}) == 6  # and it is shown
