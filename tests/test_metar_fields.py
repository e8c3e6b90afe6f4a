"""METAR reports field by field, by hand from the reports and the code's own tables."""

from __future__ import annotations

import math

import esper
import pytest

from tests.metars import find
from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import SkyLayer
from weather_ecs.metar import read_metar
from weather_ecs.metar_weather import FAR

pytestmark = pytest.mark.usefixtures("world")

KNOT, MILE, FOOT = 0.514444, 1609.344, 0.3048


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
