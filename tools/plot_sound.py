"""Draws the spectra of the walk's sound: `python -m tools.plot_sound FILE [FOLDER]`.

Prints what was measured in the sound; into a folder go the sounds themselves, as WAV. Needs
matplotlib (the development extra has it). Figure and tables in docs/sound.md are made by it.
"""

from __future__ import annotations

import sys
import wave
from pathlib import Path
from typing import Any

import esper
import numpy as np
from numpy.typing import NDArray

from demo_game.sound import Soundscape, laws
from demo_game.sound.overlap import HOP, RATE
from demo_game.sound.synth import Heard, Synth, to_bytes
from weather_ecs import Weather
from weather_ecs.components import Observer

RATES = (2.0, 10.0, 50.0)  # mm/h
SPEEDS = (5.0, 10.0, 20.0)  # m/s
DISTANCES = (100.0, 1000.0, 5000.0)  # m
STRIKES = (0.0, 340.0, 1000.0, 3400.0, 10_000.0)  # m, whose delay is measured
QUIET = 1.0e-5  # of full scale, below which nothing is heard yet
HIGH = 2000.0  # Hz
COLORS = ("#2a9d8f", "#457b9d", "#d1495b")
SETTLING, BLOCKS = 40, 400
EDGES = 40.0 * 2.0 ** (np.arange(28) / 3.0)  # Hz, of third octaves


def rendered(blocks: int = BLOCKS, strike: float | None = None, **told: float) -> NDArray:
    """(n,) samples of one ear in a steady weather, or of a strike's thunder."""
    synth = Synth(1)
    synth.hear(Heard(**told))
    for _ in range(SETTLING):
        synth.block()
    if strike is not None:
        synth.thunder(strike, 1.0)
    return np.concatenate([synth.block()[0] for _ in range(blocks)])


def thirds(signal: NDArray) -> tuple[NDArray, NDArray]:
    """Middles of third octaves in Hz, and the level in each in dB under full scale."""
    power = np.abs(np.fft.rfft(signal)) ** 2 * 2.0 / signal.size**2
    f = np.fft.rfftfreq(signal.size, 1.0 / RATE)
    summed = np.array(
        [power[(f >= a) & (f < b)].sum() for a, b in zip(EDGES[:-1], EDGES[1:], strict=True)]
    )
    return np.sqrt(EDGES[:-1] * EDGES[1:]), 10.0 * np.log10(np.maximum(summed, 1e-12))


def figure() -> Any:
    """Rain in the open and under the roof, wind, and thunder over time."""
    from matplotlib.figure import Figure

    made = Figure(figsize=(12.0, 7.6), layout="constrained")
    (rain, filtered), (wind, thunder) = made.subplots(2, 2)
    for rate, color in zip(RATES, COLORS, strict=True):
        for roof, style in ((0.0, "-"), (1.0, "--")):
            f, level = thirds(rendered(rain_rate=rate, roof=roof))
            label = f"{rate:g} mm/h{', under the roof' if roof else ''}"
            rain.plot(f, level, style, color=color, label=label)
    rain.set_title("Rain")
    f, open_ = thirds(rendered(wind_speed=14.0))
    _, under = thirds(rendered(wind_speed=14.0, roof=1.0))
    filtered.plot(f, under - open_, "o", ms=4, color=COLORS[2], label="measured in the sound")
    law = 20.0 * np.log10(laws.shelter_gain(f, 0.0, 1.0) / laws.shelter_gain(f, 0.0, 0.0))
    filtered.plot(f, law, color=COLORS[1], label=f"low-pass at {laws.ROOF_CORNER:g} Hz")
    filtered.set_title("What the roof leaves of the sound from outside")
    for speed, color in zip(SPEEDS, COLORS, strict=True):
        f, level = thirds(rendered(wind_speed=speed))
        wind.plot(f, level, color=color, label=f"{speed:g} m/s")
    wind.set_title("Wind")
    for ax in (rain, filtered, wind):
        ax.set_xscale("log")
        ax.set_xlabel("Hz")
        ax.set_ylabel("dB in third octaves")
    for ax in (rain, wind):
        ax.set_ylim(-90.0, -15.0)
    for distance, color in zip(DISTANCES, COLORS, strict=True):
        signal = rendered(round(16.0 * RATE / HOP), distance)
        fine = signal[: signal.size // 2205 * 2205].reshape(-1, 2205)
        level = 20.0 * np.log10(np.maximum(np.sqrt((fine**2).mean(axis=1)), 1e-5))
        thunder.plot((np.arange(level.size) + 0.5) * 0.05, level, color=color,
                     label=f"{distance / 1000.0:g} km")  # fmt: skip
    thunder.set_title("Thunder that is due after 1 s")
    thunder.set_xlabel("s")
    thunder.set_ylabel("dB")
    thunder.set_ylim(-80.0, 0.0)
    for ax in made.axes:
        ax.grid(True, alpha=0.3)
        ax.legend(fontsize=8)
    return made


def rain_table() -> list[str]:
    """Rows of levels in dB under full scale, in all and above HIGH, and of the middle in Hz."""
    names = ["mm/h", "in the open", "under the roof", "above 2 kHz", "under the roof"]
    names += ["middle, Hz", "under the roof"]
    rows = ["| " + " | ".join(names) + " |", "| --- " * len(names) + "|"]
    for rate in RATES:
        cells: list[tuple[str, str]] = []
        both = [thirds(rendered(rain_rate=rate, roof=roof)) for roof in (0.0, 1.0)]
        for kept in (0.0, HIGH):
            sums = [10.0 * np.log10((10.0 ** (0.1 * level[f > kept])).sum()) for f, level in both]
            cells.append((f"{sums[0]:.1f}", f"{sums[1]:.1f}"))
        middles = [
            np.exp((10.0 ** (0.1 * level) * np.log(f)).sum() / (10.0 ** (0.1 * level)).sum())
            for f, level in both
        ]
        cells.append((f"{middles[0]:.0f}", f"{middles[1]:.0f}"))
        rows.append(f"| {rate:g} | " + " | ".join(" | ".join(pair) for pair in cells) + " |")
    return [row.replace("-", "−") if row[2].isdigit() else row for row in rows]


def delay(distance: float) -> tuple[float, float, float]:
    """Of a strike on the ground: m to its channel, s to the event, and s to its sound.

    The sound is that of a `Soundscape` without a device, told by the weather's own events.
    """
    before, world = esper.current_world, f"thunder at {distance:g} m"
    esper.switch_world(world)
    sound, found = Soundscape(1, device=False), {}

    def struck(strike: Any, heard: Any) -> None:
        found["m"], found["from"] = heard[0].distance, strike.time
        sound.thunder(heard[0].distance)

    def thunder(observer: int, strike: Any, far: float) -> None:
        found["event"] = weather.stats.time - strike.time

    with Weather(seed=1) as weather:
        esper.create_entity(Observer((0.0, 1.7, 0.0)))
        esper.set_handler("strike", struck)
        esper.set_handler("thunder", thunder)
        weather.strike((distance, 0.0, 0.0))
        for _ in range(round((distance / laws.SOUND_SPEED + 1.0) / 0.05)):
            esper.process(0.05)
    esper.switch_world(before if before in esper.list_worlds() else "default")
    esper.delete_world(world)
    blocks = round((distance / laws.SOUND_SPEED + 1.0) * RATE / HOP)
    made = np.abs(np.concatenate([sound.synth.block()[0] for _ in range(blocks)]))
    return found["m"], found["event"], float((made > QUIET).argmax()) / RATE


def thunder_table() -> list[str]:
    """Rows of strikes: how far, when thunder is due by 340 m/s, told, and heard."""
    rows = ["| Strike | due | event | in the sound |", "| --- | --- | --- | --- |"]
    for each in STRIKES:
        far, told, heard = delay(each)
        due = far / laws.SOUND_SPEED
        rows.append(f"| {far:.0f} m | {due:.3f} s | {told:.2f} s | {heard:.3f} s |")
    return rows


def write_sounds(folder: Path) -> None:
    """Eight seconds of each rain and wind, and thunder, as WAV files."""
    folder.mkdir(parents=True, exist_ok=True)
    sounds = {f"rain_{rate:g}": rendered(rain_rate=rate) for rate in RATES}
    sounds |= {f"rain_{rate:g}_roof": rendered(rain_rate=rate, roof=1.0) for rate in RATES}
    sounds |= {f"wind_{speed:g}": rendered(wind_speed=speed) for speed in SPEEDS}
    blocks = round(16.0 * RATE / HOP)
    sounds |= {f"thunder_{far:g}": rendered(blocks, far) for far in DISTANCES}
    for name, signal in sounds.items():
        with wave.open(str(folder / f"{name}.wav"), "wb") as file:
            file.setnchannels(1)
            file.setsampwidth(2)
            file.setframerate(RATE)
            file.writeframes(to_bytes(signal[None]))


def main(arguments: list[str]) -> int:
    """Draw into the file that is named; returns the exit code."""
    if len(arguments) not in (1, 2):
        print("plot_sound: needs FILE, such as docs/images/sound.png", file=sys.stderr)
        return 2
    figure().savefig(arguments[0], dpi=100)
    print("\n".join([*rain_table(), "", *thunder_table()]))
    if len(arguments) == 2:
        write_sounds(Path(arguments[1]))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
