"""METAR reports: what is understood, what it becomes, what is refused."""

from __future__ import annotations

import builtins
import sys
from dataclasses import replace

import esper
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.metars import REAL, find
from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import Fog
from weather_ecs.errors import InvalidValueError, MetarError, MissingExtraError
from weather_ecs.metar import read_metar
from weather_ecs.metar_falls import RATES
from weather_ecs.metar_weather import FAR, humidity
from weather_ecs.physics.haze import haze_visibility

pytestmark = pytest.mark.usefixtures("world")


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
