"""How an observer's drops are shared out among rain areas."""

from __future__ import annotations

from collections.abc import Mapping

RATE = 2.0  # 1/s, how fast an area's importance follows what it should be
_KEEPS = 1.1  # an area that is shown yields to one that matters more by this factor


def importances(
    before: Mapping[int, float] | None, wanted: Mapping[int, float], slots: int, dt: float
) -> dict[int, float]:
    """Importance, above 0, of the areas that are shown: `slots` at most.

    `before`: as at the last view, dt seconds ago; None for the first one, when nothing glides. An
    area that is no longer among those that matter most keeps its slot until it has faded out, and
    only then does another come in.
    """
    if before == wanted and len(wanted) <= slots and all(wanted.values()):
        return dict(wanted)  # as it mostly is
    shown = before if before is not None else {}

    def rank(k: int) -> tuple[float, int]:
        return (-wanted[k] * (_KEEPS if k in shown else 1.0), k)

    chosen = sorted((k for k in wanted if wanted[k] > 0.0), key=rank)[:slots]
    if before is None:
        return {k: wanted[k] for k in chosen}
    change = RATE * dt
    found: dict[int, float] = {}
    for k in sorted((k for k in before if k in wanted), key=rank)[:slots]:
        aim = wanted[k] if k in chosen else 0.0
        now = min(max(aim, before[k] - change), before[k] + change)
        if now > 0.0:
            found[k] = now
    for k in chosen:
        if k not in before and len(found) < slots and change > 0.0:
            found[k] = min(wanted[k], change)
    return found
