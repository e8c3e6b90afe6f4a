"""When the editor's window is drawn."""

from __future__ import annotations

from weather_ecs.editor.pace import AWAKE, DOZE, Pace
from weather_ecs.editor.sharpness import REST, Sharpness

TICK = 1.0 / 120.0


def frames(pace: Pace, start: float, seconds: float, *, moves: bool = False) -> int:
    """How many of the ticks of a stretch of time are drawn."""
    count = round(seconds / TICK)
    return sum(pace.due(start + k * TICK, moves=moves) for k in range(count))


def test_at_rest_a_few_frames_a_second_are_drawn() -> None:
    pace = Pace()
    pace.wake(100.0)
    assert frames(pace, 100.0, AWAKE - TICK) == round((AWAKE - TICK) / TICK)  # every tick
    assert frames(pace, 100.0 + AWAKE + DOZE, 10.0) in (39, 40, 41)


def test_an_event_wakes_it_at_once_and_what_moves_keeps_it_awake() -> None:
    pace = Pace()
    assert frames(pace, 50.0, 1.0) < 6
    pace.wake(51.0)
    assert pace.due(51.0, moves=False)
    assert frames(pace, 60.0, 1.0, moves=True) == 120


def test_a_picture_at_rest_asks_for_no_other() -> None:
    sharpness = Sharpness()
    assert sharpness.wants(TICK, moves=True) and not sharpness.rests
    drawn, waited = 0, 0.0
    while not sharpness.rests:
        drawn += sharpness.wants(TICK, moves=False)
        waited += TICK
        assert waited < 2.0 * REST
    assert drawn == 0  # it had all of its pixels
    sharpness.share = 0.5
    assert sharpness.wants(TICK, moves=True)
    for _ in range(40):
        drawn += sharpness.wants(TICK, moves=False)
    assert drawn == 1 and sharpness.rests  # once more, with all of them
