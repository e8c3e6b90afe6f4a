"""The sound of the game: what reaches it, the device, the figure."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from demo_game.settings import VOLUMES, Settings
from demo_game.sound import Soundscape, WalkSound, device
from demo_game.sound.impacts import BOARD, GROUND, LEAF, bank
from demo_game.sound.listener import listen
from demo_game.sound.overlap import RATE
from demo_game.sound.rain import near_rate
from demo_game.sound.synth import Heard
from tests.sound_levels import SETTLING, onset
from tools import plot_sound

ROOT = Path(__file__).parent.parent


# The game


class Sky:
    """A weather that knows one roof."""

    def __init__(self, sheltered: bool) -> None:
        self.sheltered = sheltered

    def sample(self, position: Any) -> Any:
        here = self.sheltered and position[1] < 10.0
        return SimpleNamespace(
            rain_rate=0.0 if here else 12.0, sheltered=here, wind=(3.0, 0.0, -4.0), snow_depth=0.0
        )


def game(sheltered: bool, x: float = 0.0) -> Any:
    block = SimpleNamespace(walkable=True, center=np.zeros(3), size=np.array((6.0, 1.0, 4.0)))
    place = SimpleNamespace(blocks=[block], cabin_origin=np.array((0.0, 2.0, 0.0)))
    return SimpleNamespace(
        weather=Sky(sheltered), place=place, pose=SimpleNamespace(eye=(x, 3.7, 0.0))
    )


def test_what_is_heard_is_the_rain_above_the_roof() -> None:
    assert listen(game(False)) == (12.0, 0.0, 0.0, 5.0, 0.0)
    assert listen(game(True)) == (12.0, 0.0, 1.0, 5.0, 0.0)
    assert listen(game(True, x=40.0)) == (12.0, 1.0, 0.0, 5.0, 0.0)  # a tree's


def test_strikes_and_settings_reach_the_sound() -> None:
    sound = Soundscape(1, device=False)
    sound._device = SimpleNamespace(lead=0.3, close=lambda: None)
    settings = Settings(volume=50)
    assert settings.volume in VOLUMES
    walk = WalkSound(game(False), settings, sound=sound)
    walk.update(0.1)
    for _ in range(SETTLING):
        sound.synth.block()
    struck = SimpleNamespace(distance=lambda eye: 1020.0)
    settings.muted = True
    walk.update(0.1)
    assert sound.muted and sound.volume == 0.5
    settings.muted, settings.volume = False, 100
    walk.update(0.1, paused=True)
    sound.synth.hear(Heard())
    for _ in range(SETTLING):
        sound.synth.block()
    walk.on_strike(struck)
    made = np.concatenate([sound.synth.block() for _ in range(200)], axis=1)
    # 3 s on its way, less what the device has been given already
    assert onset(made, 0.02) == pytest.approx(2.7, abs=0.05)
    walk.close()
    walk.update(0.1)


def test_where_a_device_is_looked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("PULSE_SERVER", "XDG_RUNTIME_DIR"):
        monkeypatch.delenv(name, raising=False)
    root = f"{tmp_path}/"
    assert not device.is_likely("linux", root)
    assert device.is_likely("win32", root)
    (tmp_path / "dev" / "snd").mkdir(parents=True)
    (tmp_path / "dev" / "snd" / "pcmC0D0c").touch()  # a microphone
    assert not device.is_likely("linux", root)
    (tmp_path / "dev" / "snd" / "pcmC0D0p").touch()
    assert device.is_likely("linux", root)
    monkeypatch.setenv("PULSE_SERVER", "unix:/nowhere")
    assert device.is_likely("linux", f"{tmp_path}/none/")


# pyglet.media opens an invisible window, for its films, unless it is told not to.
ALONE = """
import threading
import pyglet
pyglet.options["shadow_window"] = False
pyglet.options["audio"] = {drivers}
from demo_game.sound import Soundscape, device
device.is_likely = lambda: True
sound = Soundscape(1)
assert not sound.is_heard
sound.update(0.1, 20.0, wind_speed=5.0)
sound.thunder(300.0)
sound.hush()
sound.close()
assert threading.active_count() == 1, threading.enumerate()
"""


@pytest.mark.parametrize("drivers", [("silent",), ("pulse", "openal")])
def test_nothing_is_said_and_left_without_a_device(drivers: tuple[str, ...]) -> None:
    if drivers != ("silent",) and device.is_likely():
        pytest.skip("there is a device")
    done = subprocess.run(
        [sys.executable, "-c", ALONE.format(drivers=drivers)],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


PLAYED = """
import threading, time
from types import SimpleNamespace
import pyglet
pyglet.options["shadow_window"] = False
pyglet.options["audio"] = ("silent",)
from demo_game.sound import device
from demo_game.sound.overlap import RATE
from demo_game.sound.synth import Heard, Synth, to_bytes
synth = Synth(1)
synth.hear(Heard(rain_rate=20.0))
played = device.PygletDevice(synth)
first = synth.samples
assert first > 0
end = time.monotonic() + 120.0  # however slow the machine
while synth.samples == first and time.monotonic() < end:
    time.sleep(0.02)
assert synth.samples > first
played.close()
played.close()
assert played.lead == 0.0
pyglet.media.get_audio_driver().delete()

# What is made and not yet heard, by a player whose clock does not run.
made = synth.samples / RATE
for ahead, lead in ((0.2, 0.2), (-1.0, 0.0), (0.0, 0.0), (5.0, 2.0 * device.BUFFERED)):
    played._player = SimpleNamespace(time=made - ahead)
    assert abs(played.lead - lead) < 1e-9, (ahead, played.lead)
played._player = None
assert threading.active_count() == 1

synth, other = Synth(6), Synth(6)
for each in (synth, other):
    each.hear(Heard(rain_rate=30.0))
source = device._source(synth)
got = b"".join(source.get_audio_data(size).data for size in (4, 6000, 1, 4096, 9001))
assert len(got) == 4 + 6000 + 4 + 4096 + 9000  # whole frames
assert b"".join(to_bytes(other.block()) for _ in range(6)).startswith(got)
"""


def test_a_driver_is_fed_as_it_plays_and_gets_what_it_asks_for() -> None:
    done = subprocess.run(
        [sys.executable, "-c", PLAYED], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")


def test_the_script_of_the_figure(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert plot_sound.main([]) == 2
    assert "FILE" in capsys.readouterr().err
    tone = 0.5 * np.sin(2.0 * np.pi * 1000.0 * np.arange(RATE) / RATE)
    f, level = plot_sound.thirds(tone)
    assert f[level.argmax()] == pytest.approx(1000.0, rel=0.13)
    assert level.max() == pytest.approx(20.0 * np.log10(tone.std()), abs=0.01)
    far, told, heard = plot_sound.delay(680.0)
    assert far == pytest.approx(680.0, abs=1.0)
    assert 2.0 <= told <= 2.1 and heard == pytest.approx(2.0, abs=0.01)
    kept = ROOT / "docs" / "images" / "sound.png"
    assert kept.stat().st_size < 300_000


def test_a_drop_has_the_energy_that_the_levels_count_on() -> None:
    for surface in (GROUND, LEAF, BOARD):
        for sound in bank(surface, 1, 6):
            assert (sound**2).sum() == pytest.approx(1.0, rel=1e-3)
            assert np.abs(sound[[0, -1]]).max() < 1e-3  # no edge that clicks
    assert near_rate(0.0) == 0.0
    rates = [near_rate(rate) for rate in (0.5, 2.0, 10.0, 200.0)]
    assert rates == sorted(rates) and 5.0 < rates[1] < 60.0
