"""What is said of the letter, in play and at its end."""

from __future__ import annotations

from enum import Enum

from demo_game.letter import Letter, State

STAGES = ((0.03, "dry"), (0.25, "moist"), (0.50, "damp"), (0.75, "wet"), (2.0, "soaking"))
NO_RAIN = 0.05  # mm/h, less than that is not worth a word
GRADES = (
    (0.03, "It is in the mailbox, without a drop on it."),
    (0.45, "It is in the mailbox, a little damp, and every word can be read."),
    (2.0, "It is in the mailbox, wet, but the words can still be read."),
)
LOST = "Nobody can read it now. Wait under the porch until the rain eases."


class Tone(Enum):
    """How a word is meant; the view has a colour for each."""

    PLAIN = 0
    DIM = 1
    GOOD = 2
    WARNING = 3
    BAD = 4


def words(letter: Letter) -> tuple[str, Tone]:
    """How the letter fares now."""
    if letter.state is State.LYING:
        return "in the cabin", Tone.DIM
    if letter.state is State.DELIVERED:
        return "delivered", Tone.GOOD
    if letter.state is State.RUINED:
        return "ruined", Tone.BAD
    word = next(name for limit, name in STAGES if letter.wetness < limit)
    if letter.rain_rate > NO_RAIN:
        return f"{word}, in the rain", Tone.WARNING
    if letter.sheltered:
        return f"{word}, sheltered", Tone.PLAIN
    return word, Tone.PLAIN


def end_texts(letter: Letter) -> tuple[str, str]:
    """Title and line for a letter that is delivered or ruined."""
    if letter.state is State.RUINED:
        return "The ink has run", LOST
    line = next(text for limit, text in GRADES if letter.wetness < limit)
    return "Delivered", f"{line} It took {duration(letter.time)}."


def duration(seconds: float) -> str:
    """Minutes and seconds in words."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"
