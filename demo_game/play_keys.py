"""Keys that change the weather or what is shown while one plays."""

from __future__ import annotations

from typing import Protocol

from demo_game.game import Game
from demo_game.input import PRESET_KEYS, SHIFTED


class Shown(Protocol):
    """What can be switched on and off."""

    show_map: bool


def play_key(name: str, game: Game, shown: Shown) -> str | None:
    """Do what a key means; returns a line for the player, or None where it means nothing here."""
    name = SHIFTED.get(name, name)
    if name in PRESET_KEYS:
        return game.changer.choose_preset(PRESET_KEYS[name])
    if name in ("BRACKETLEFT", "BRACKETRIGHT"):
        return game.changer.blow(1 if name == "BRACKETRIGHT" else -1)
    if name in ("COMMA", "PERIOD"):
        return game.changer.turn_wind(1 if name == "COMMA" else -1)
    if name == "F":
        game.player.switch_flight()
        return "You fly: Space is up, Shift is fast" if game.player.flying else "You walk"
    if name == "L":
        return game.changer.strike()
    if name == "V":
        return game.changer.next_whole()
    if name == "B":
        return game.changer.next_whole(-1)
    if name == "C":
        return game.changer.run_climate()
    if name == "T":
        game.sky.next()
        return game.sky.name.capitalize()
    if name == "N":
        game.settings.muted = not game.settings.muted
        return "Sound off" if game.settings.muted else "Sound on"
    if name == "M":
        shown.show_map = not shown.show_map
        return ""
    return None
