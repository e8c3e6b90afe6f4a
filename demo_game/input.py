"""From keys and sticks to what the player wants; keys by name, so that no window is needed."""

from __future__ import annotations

from dataclasses import dataclass, field

from demo_game.player import Intent
from weather_ecs.presets import PRESETS

DEAD_ZONE = 0.18  # of a stick's travel
STICK_LOOK = 2.6  # rad/s of turn at a stick's full travel

WALK_KEYS: dict[str, tuple[float, float]] = {
    "W": (1.0, 0.0),
    "UP": (1.0, 0.0),
    "S": (-1.0, 0.0),
    "DOWN": (-1.0, 0.0),
    "A": (0.0, -1.0),
    "LEFT": (0.0, -1.0),
    "D": (0.0, 1.0),
    "RIGHT": (0.0, 1.0),
}
RUN_KEYS = frozenset(("LSHIFT", "RSHIFT"))
JUMP_KEY = "SPACE"

# By the presets' order: the top row, and the number pad for the first ten.
_KEYS = ("_1", "_2", "_3", "_4", "_5", "_6", "_7", "_8", "_9", "_0", "MINUS")
PRESET_KEYS = dict(zip(_KEYS, PRESETS, strict=True))
PRESET_KEYS |= {f"NUM{key}": name for key, name in PRESET_KEYS.items() if key != "MINUS"}

# What pyglet calls keys while Shift is held down, as it is by somebody who runs.
SHIFTED = {
    "EXCLAMATION": "_1",
    "AT": "_2",
    "HASH": "_3",
    "DOLLAR": "_4",
    "PERCENT": "_5",
    "ASCIICIRCUM": "_6",
    "AMPERSAND": "_7",
    "ASTERISK": "_8",
    "PARENLEFT": "_9",
    "PARENRIGHT": "_0",
    "UNDERSCORE": "MINUS",
    "BRACELEFT": "BRACKETLEFT",
    "BRACERIGHT": "BRACKETRIGHT",
    "LESS": "COMMA",
    "GREATER": "PERIOD",
}


@dataclass
class Stick:
    """A gamepad's sticks and buttons; right and up are positive."""

    left: tuple[float, float] = (0.0, 0.0)
    right: tuple[float, float] = (0.0, 0.0)
    jump: bool = False
    run: bool = False


@dataclass
class Controls:
    """What is held down now."""

    held: set[str] = field(default_factory=set)
    stick: Stick = field(default_factory=Stick)
    _jump: bool = False

    def press(self, name: str) -> None:
        """A key went down."""
        self.held.add(name)
        if name == JUMP_KEY:
            self._jump = True

    def release(self, name: str) -> None:
        """A key came up."""
        self.held.discard(name)

    def clear(self) -> None:
        """Let go of everything: the window lost its focus or a menu opened."""
        self.held.clear()
        self.stick = Stick()
        self._jump = False

    def intent(self) -> Intent:
        """What the player wants in this frame; a short press of the jump key is not lost."""
        forward = right = 0.0
        for name in self.held & WALK_KEYS.keys():
            forward += WALK_KEYS[name][0]
            right += WALK_KEYS[name][1]
        sideways, ahead = (dead_zone(value) for value in self.stick.left)
        jump = self._jump or JUMP_KEY in self.held or self.stick.jump
        self._jump = False
        return Intent(
            _unit(_unit(forward) + ahead),
            _unit(_unit(right) + sideways),
            bool(self.held & RUN_KEYS) or self.stick.run,
            jump,
        )

    def turn(self, dt: float) -> tuple[float, float]:
        """Turn to the left and rise of the look by the right stick in dt seconds, rad."""
        x, y = (dead_zone(value) for value in self.stick.right)
        return -x * abs(x) * STICK_LOOK * dt, y * abs(y) * STICK_LOOK * 0.7 * dt


def dead_zone(value: float) -> float:
    """A stick's axis without the play around its middle."""
    if abs(value) <= DEAD_ZONE:
        return 0.0
    rest = (min(abs(value), 1.0) - DEAD_ZONE) / (1.0 - DEAD_ZONE)
    return rest if value > 0.0 else -rest


def _unit(value: float) -> float:
    return min(max(value, -1.0), 1.0)
