"""The loudspeaker, where there is one: pyglet plays what a `Synth` makes."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any, Protocol

from .overlap import CHANNELS, HOP, RATE
from .synth import Synth, to_bytes

BUFFERED = 0.3  # s that are made ahead of what is heard; a slow frame must not be heard
FRAME_BYTES = 2 * CHANNELS


class Device(Protocol):
    """What plays a synth."""

    @property
    def lead(self) -> float:
        """Seconds between what is made now and when it is heard."""

    def close(self) -> None:
        """Stop; a second call does nothing."""


def is_likely(platform: str = sys.platform, root: str = "/") -> bool:
    """Whether it is worth to load audio libraries: they complain aloud where there is no device.

    On Linux a sound card or a sound server shows in the file system; elsewhere pyglet finds out.
    """
    if not platform.startswith("linux"):
        return True
    if os.environ.get("PULSE_SERVER"):
        return True
    runtime = os.environ.get("XDG_RUNTIME_DIR", f"{root}run/user/{os.getuid()}")
    sockets = (Path(runtime, "pulse/native"), Path(runtime, "pipewire-0"))
    cards = Path(root, "dev/snd").glob("pcm*p")
    return any(socket.exists() for socket in sockets) or any(cards)


def open_device(synth: Synth) -> Device | None:
    """Play a synth; None where nothing can be heard."""
    if not is_likely():
        return None
    try:
        import pyglet

        driver: Any = pyglet.media.get_audio_driver()
        if type(driver).__module__.startswith("pyglet.media.drivers.silent"):
            driver.delete()  # its thread; it is not used
            return None
        return PygletDevice(synth)
    except Exception:  # whatever a driver has to complain of: the game goes on without sound
        return None


class PygletDevice:
    """A pyglet player whose source is a synth."""

    def __init__(self, synth: Synth) -> None:
        from pyglet.media import Player
        from pyglet.media.drivers.base import AbstractAudioPlayer

        self._synth = synth
        self._player: Any = Player()
        usual = AbstractAudioPlayer.audio_buffer_length
        AbstractAudioPlayer.audio_buffer_length = BUFFERED
        try:
            self._player.queue(_source(synth))
            self._player.play()
        except BaseException:
            self.close()
            raise
        finally:
            AbstractAudioPlayer.audio_buffer_length = usual

    @property
    def lead(self) -> float:
        """Seconds between what is made now and when it is heard."""
        if self._player is None:
            return 0.0
        ahead = self._synth.samples / RATE - self._player.time
        return min(max(ahead, 0.0), 2.0 * BUFFERED)

    def close(self) -> None:
        """Stop; a second call does nothing."""
        player, self._player = self._player, None
        if player is not None:
            with suppress(Exception):  # the device may be gone already
                player.pause()
                player.delete()


def _source(synth: Synth) -> Any:
    from pyglet.media.codecs import AudioData, AudioFormat, StreamingSource

    class Endless(StreamingSource):
        """The synth as a source that never ends."""

        def __init__(self) -> None:
            self.audio_format = AudioFormat(channels=CHANNELS, sample_size=16, sample_rate=RATE)
            self._left = b""

        def is_precise(self) -> bool:
            """Exactly as many bytes come as are asked for."""
            return True

        def get_audio_data(self, num_bytes: int, compensation_time: float = 0.0) -> Any:
            """The next bytes."""
            wanted = max(int(num_bytes) // FRAME_BYTES, 1) * FRAME_BYTES
            parts, have = [self._left], len(self._left)
            while have < wanted:
                parts.append(to_bytes(synth.block()))
                have += HOP * FRAME_BYTES
            data = b"".join(parts)
            self._left = data[wanted:]
            return AudioData(data[:wanted], wanted)

    return Endless()
