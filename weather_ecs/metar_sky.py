"""Cloud groups of reports as banks of clouds: which genera, how high, how much."""

from __future__ import annotations

from typing import NamedTuple

from weather_ecs.weathers import CloudBank

# Oktas of each amount: the middle of 1 to 2, 3 to 4 and 5 to 7, and a closed sky (WMO No. 49).
OKTAS = {"FEW": 1.5, "SCT": 3.5, "BKN": 6.0, "OVC": 8.0, "VV": 8.0}
LOW, MIDDLE = 2000.0, 6000.0  # m, tops of the two lower floors, between temperate and tropical
UNKNOWN = {"FEW": 1200.0, "SCT": 1200.0, "BKN": 900.0, "OVC": 600.0, "VV": 60.0}  # m
LEAST = 60.0  # m, below which a base would lie on the ground's own relief


class CloudGroup(NamedTuple):
    """One cloud group: amount, base in m above ground, and CB or TCU where it is named."""

    amount: str
    base: float | None
    kind: str


def bank_of(group: CloudGroup, rain: str) -> CloudBank:
    """Clouds of a group; `rain` is "steady", "showers", "drizzle" or nothing."""
    base = group.base if group.base is not None else UNKNOWN[group.amount]
    base = max(base, LEAST)
    models, weights = _models(group, base, rain)
    return CloudBank(models, base, OKTAS[group.amount], weights)


def _models(group: CloudGroup, base: float, rain: str) -> tuple[tuple[str, ...], tuple[float, ...]]:
    """Genera by height and amount (WMO International Cloud Atlas), and their weights."""
    few, closed = group.amount in ("FEW", "SCT"), group.amount in ("OVC", "VV")
    if group.kind == "CB":
        return ("cumulonimbus",), ()
    if group.kind == "TCU":
        return ("cumulus",), ()
    if base > MIDDLE:
        if closed or group.amount == "BKN":
            return ("cirrostratus", "cirrus"), (3.0, 1.0)
        return ("cirrus",), ()
    if base > LOW:
        if closed:
            return ("nimbostratus" if rain == "steady" and base < 3000.0 else "altostratus",), ()
        return ("altocumulus",), ()
    if few:
        return ("cumulus" if base >= 300.0 and rain != "steady" else "fractostratus",), ()
    if closed and rain == "steady" and base >= 300.0:
        return ("nimbostratus",), ()
    if base < 500.0:
        return ("stratus",), ()
    return (("stratus", "stratocumulus"), ()) if closed else (("stratocumulus",), ())
