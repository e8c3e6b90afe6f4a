"""Present weather of reports: how much falls, of what kind, and what takes the sight."""

from __future__ import annotations

from dataclasses import dataclass

# mm/h of water for light, moderate and heavy. Rain: the American Meteorological Society's glossary
# has light up to 2.5, moderate to 7.6 and heavy above; drizzle light below 0.3, moderate to 0.5.
# Snow as in `presets`; hail as heavy rain; small hail, ice pellets and snow grains by their water.
RATES = {
    "RA": (1.5, 5.0, 20.0),
    "DZ": (0.2, 0.4, 0.8),
    "SN": (0.7, 1.5, 3.5),
    "SG": (0.2, 0.4, 0.8),
    "PL": (1.0, 2.5, 6.0),
    "GR": (20.0, 25.0, 40.0),
    "GS": (4.0, 8.0, 20.0),
    "UP": (0.8, 2.5, 8.0),
    "IC": (0.05, 0.1, 0.2),
}
FROZEN = ("SN", "SG", "IC")
LIQUID = ("RA", "DZ", "GR", "GS", "PL")
# m of visibility, where a report names these and no visibility.
SIGHT = {
    "BR": 3000.0, "FG": 500.0, "HZ": 4000.0, "FU": 4000.0, "DU": 4000.0, "SA": 4000.0,
    "VA": 4000.0, "PY": 4000.0, "SS": 800.0, "DS": 800.0,
}  # fmt: skip
WORDS = {
    "RA": "rain", "DZ": "drizzle", "SN": "snow", "SG": "snow grains", "PL": "ice pellets",
    "GR": "hail", "GS": "small hail", "UP": "unknown precipitation", "IC": "ice crystals",
    "BR": "mist", "FG": "fog", "HZ": "haze", "FU": "smoke", "DU": "dust", "SA": "sand",
    "VA": "volcanic ash", "PY": "spray", "SS": "sandstorm", "DS": "dust storm", "SQ": "squalls",
    "FC": "funnel cloud", "PO": "dust whirls",
    "SH": "showers of", "TS": "thunderstorm with", "FZ": "freezing", "BL": "blowing",
    "DR": "low drifting", "MI": "shallow", "BC": "patches of", "PR": "partial",
}  # fmt: skip


@dataclass(slots=True)
class Falls:
    """What the present weather groups of a report come to."""

    rate: float = 0.0  # mm/h of water
    frozen: bool = False  # most of it is snow
    liquid: bool = False  # most of it is not
    showers: bool = False
    drizzle: bool = False
    thunder: float = 0.0  # 0 to 1
    blowing_snow: bool = False
    sight: float | None = None  # m
    haze: bool = False

    @property
    def kind(self) -> str:
        """ "steady", "showers", "drizzle" or nothing."""
        if self.rate <= 0.0:
            return ""
        return "showers" if self.showers else "drizzle" if self.drizzle else "steady"


def take(falls: Falls, intensity: str, desc: str, falling: str, sight: str, other: str) -> str:
    """Enter one group; returns it in words."""
    near = "VC" in intensity
    strength = 0 if "-" in intensity else 2 if "+" in intensity else 1
    pairs = [falling[k : k + 2] for k in range(0, len(falling), 2)]
    kinds = [kind for kind in pairs if kind in RATES]
    blowing, drifting = "BL" in desc, "DR" in desc
    if "TS" in desc:
        falls.thunder = max(falls.thunder, 0.4 if near else 1.0)
    if blowing and "SN" in kinds:
        falls.blowing_snow = True
    elif kinds and not near and not drifting:
        # Of mixtures the first is most; its rate is that of all.
        rate = max(RATES[kind][strength if k == 0 else 0] for k, kind in enumerate(kinds))
        if rate > falls.rate:
            falls.frozen = kinds[0] in FROZEN
            falls.liquid = kinds[0] in LIQUID
        falls.rate = max(falls.rate, rate)
        falls.showers = falls.showers or "SH" in desc or "TS" in desc
        falls.drizzle = kinds == ["DZ"] and falls.rate <= RATES["DZ"][2]
    for word in (sight, other):
        if word in SIGHT and not near and not any(d in desc for d in ("MI", "BC", "PR", "DR")):
            falls.sight = min(falls.sight or 1e9, SIGHT[word])
            falls.haze = falls.haze or word not in ("BR", "FG")
    return _words(intensity, desc, pairs, sight, other)


def _words(intensity: str, desc: str, falling: list[str], sight: str, other: str) -> str:
    words = [{"-": "light", "+": "heavy"}.get(intensity.replace("VC", ""), "")]
    words += [WORDS.get(desc[k : k + 2], "") for k in range(0, len(desc), 2)]
    words.append(" and ".join(WORDS[kind] for kind in falling if kind in WORDS))
    words += [WORDS.get(sight, ""), WORDS.get(other, "")]
    if "VC" in intensity:
        words.append("in the vicinity")
    text = " ".join(word for word in words if word)
    for head in ("with", "of"):
        text = text.removesuffix(f" {head}").replace(f" {head} in the", " in the")
    return text
