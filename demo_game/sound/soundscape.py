"""`Soundscape`: what the game tells its sound."""

from __future__ import annotations

from .device import Device, open_device
from .laws import SOUND_SPEED
from .synth import Heard, Synth


class Soundscape:
    """Rain, roof, wind and thunder about a listener; without a device it does nothing.

    volume: 0 to 1; the ear takes its square for loudness. muted: nothing is heard.
    """

    def __init__(self, seed: int = 0, *, device: bool = True, volume: float = 1.0) -> None:
        self.volume, self.muted = volume, False
        self._synth = Synth(seed)
        self._heard = Heard(volume=0.0)
        self._device: Device | None = open_device(self._synth) if device else None

    @property
    def is_heard(self) -> bool:
        """Whether there is a device."""
        return self._device is not None

    @property
    def synth(self) -> Synth:
        """What makes the samples."""
        return self._synth

    def update(
        self,
        dt: float,
        rain_rate: float,
        *,
        leaves: float = 0.0,
        roof: float = 0.0,
        wind_speed: float = 0.0,
        snow_depth: float = 0.0,
    ) -> None:
        """Say what the listener is in; it is glided to.

        rain_rate: mm/h of the open sky there, above the roof if there is one. leaves, roof: 0 to
        1. wind_speed: m/s. snow_depth: m on the ground.
        """
        self._heard = Heard(rain_rate, leaves, roof, wind_speed, snow_depth, self._volume())
        self._synth.hear(self._heard)

    def hush(self) -> None:
        """Fade out until the next `update`: the game stands still."""
        was = self._heard
        self._synth.hear(
            Heard(was.rain_rate, was.leaves, was.roof, was.wind_speed, was.snow_depth, 0.0)
        )

    def thunder(self, distance: float, delay: float | None = None) -> None:
        """Thunder of a strike at a distance in m, heard `delay` s from now.

        Without a delay the sound takes its way at 340 m/s.
        """
        wait = distance / SOUND_SPEED if delay is None else delay
        if self._device is not None:
            wait -= self._device.lead
        self._synth.thunder(distance, max(wait, 0.0))

    def close(self) -> None:
        """Stop the sound; a second call does nothing."""
        device, self._device = self._device, None
        if device is not None:
            device.close()

    def _volume(self) -> float:
        return 0.0 if self.muted else min(max(self.volume, 0.0), 1.0)
