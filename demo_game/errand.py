"""`Errand`: the letter on its way in the weather, and what the player is told of it."""

from __future__ import annotations

import math

from demo_game.letter import Letter, State
from demo_game.place import Place
from demo_game.player import Player
from demo_game.showers import Showers
from weather_ecs import Weather

HAND = (1.1, 0.35)  # m above the feet and before the body, where the letter is held
FETCH = "A letter lies on the table in the cabin."
EASES, PICKS_UP = "The rain eases.", "The rain picks up again."


class Errand:
    """Carries a letter through the showers, again and again."""

    def __init__(self, place: Place, seed: int) -> None:
        self.letter = Letter(place.letter, place.mailbox)
        self.showers = Showers(seed)
        self._lull = False
        self._news = [FETCH]

    def update(self, dt: float, time: float, player: Player, weather: Weather, rains: bool) -> None:
        """Let dt seconds pass, up to `time` s of play; the letter gets wet where the hand is."""
        before, (x, y, z) = self.letter.state, player.position.tolist()
        up, ahead = HAND
        hand = (x - ahead * math.sin(player.yaw), y + up, z - ahead * math.cos(player.yaw))
        here = weather.sample(hand)
        news = self.letter.update(
            dt,
            (x, y, z),
            speed=math.hypot(player.velocity[0], player.velocity[2]),
            rain_rate=here.rain_rate,
            sheltered=here.sheltered,
        )
        lull = self.showers.is_lull(time)
        if lull is not self._lull and before is State.CARRIED and rains:
            self.tell(EASES if lull else PICKS_UP)
        self._lull = lull
        if news:
            self.tell(news)

    def again(self) -> None:
        """Another letter."""
        self.letter.again()
        self._news = [FETCH]

    def tell(self, news: str) -> None:
        """Something else that the player is to know."""
        self._news.append(news)

    def take_news(self) -> str | None:
        """The latest that the player has not been told yet."""
        news = self._news[-1] if self._news else None
        self._news.clear()
        return news
