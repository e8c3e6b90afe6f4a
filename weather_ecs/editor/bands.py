"""Heights of the bases of clouds: the low, middle and high bands of the three regions.

Table 1 of R. P. Torchelsen, "Modelo para simulação em tempo-real de nuvens usando billboards"
(UNISINOS, 2005), after the World Meteorological Organization: km above the ground.
"""

from __future__ import annotations

REGIONS = ("tropical", "temperate", "polar")
LEVELS = ("low", "middle", "high")
HIGHEST = 18_000.0  # m, top of the highest band

# (lowest, highest) base in m.
BANDS: dict[str, dict[str, tuple[float, float]]] = {
    "tropical": {"low": (0.0, 2000.0), "middle": (2000.0, 8000.0), "high": (6000.0, 18_000.0)},
    "temperate": {"low": (0.0, 2000.0), "middle": (2000.0, 7000.0), "high": (5000.0, 13_000.0)},
    "polar": {"low": (0.0, 2000.0), "middle": (2000.0, 4000.0), "high": (3000.0, 8000.0)},
}


def levels_at(base: float, region: str) -> tuple[str, ...]:
    """The bands in which a base lies, from low to high; none above and below all of them.

    Middle and high overlap, as in the table. A base on a border is in the upper band.
    """
    bands = BANDS[region]
    found = [name for name in LEVELS if bands[name][0] <= base < bands[name][1]]
    if not found and base == bands["high"][1]:
        found = ["high"]
    return tuple(found)


def describe(base: float, region: str) -> str:
    """What a base is called in a region, in a few words."""
    found = levels_at(base, region)
    if found:
        return " or ".join(found)
    return "below the ground" if base < 0.0 else "above the clouds"
