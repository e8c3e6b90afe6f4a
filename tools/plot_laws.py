"""Draws the laws of rain and wind beside what was measured: `python -m tools.plot_laws FILE`.

Needs matplotlib (the development extra has it) and OpenGL, for the sizes that the GPU really holds.
The figure in docs/drops.md is made by it.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, NamedTuple

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import AREA_DTYPE, FrameData
from weather_ecs.gpu.rain_pass import RainPass
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.physics import drops, front, wind
from weather_ecs.physics.camera import camera_from
from weather_ecs.physics.rain_step import diameters
from weather_ecs.quality import LEVELS
from weather_ecs.systems.rain_view import RainView

# Gunn and Kinzer (1949): diameter in mm, terminal speed in m/s.
GUNN_KINZER = np.array(
    [(0.2, 0.72), (0.5, 2.06), (1.0, 4.03), (1.5, 5.41), (2.0, 6.49), (2.5, 7.41), (3.0, 8.06),
     (3.5, 8.53), (4.0, 8.83), (4.5, 9.00), (5.0, 9.09), (5.8, 9.17)]
)  # fmt: skip
RATES = (1.0, 5.0, 25.0, 100.0)  # mm/h
COLORS = ("#2a9d8f", "#457b9d", "#6d597a", "#d1495b")
BINS = np.linspace(0.5, 6.0, 23)  # mm
SCALE = 0.15  # of the axis ratios' panel: a length up over the same length across
CEILING = 120.0  # m, of the shower
TC, T_MID, T_MAX = 4.0, 20.0, 28.0  # s, of the winds


class Held(NamedTuple):
    """Drops in a container on the GPU: mm, and m/s downwards."""

    size: NDArray[np.float64]
    speed: NDArray[np.float64]


def held(ctx: moderngl.Context, rate: float, seconds: float = 2.0) -> Held:
    """What the GPU holds in rain of a rate after a while, read back from its buffers."""
    rows = np.zeros(1, AREA_DTYPE)
    rows[0] = (0, (0.0, 0.0), (400.0, 400.0), 0.0, rate, 10.0, 400.0)
    looking = np.eye(4)
    looking[1, 3] = -1.7
    lens = np.diag([1.0, 1.8, -1.0, 0.0])
    lens[2, 3], lens[3, 2] = -0.2, -1.0
    camera, shaders, views = camera_from(looking, lens), ShaderLoader(ctx), RainView(1)
    rain = RainPass(ctx, shaders, backend="feedback", seed=1)
    try:
        for k in range(round(seconds * 10) + 1):
            frame = FrameData(time=0.1 * k, areas=rows)
            rain.update(views.view(frame, camera, 0, LEVELS["high"]))
        (held_drops,) = rain.sets().values()
        state = np.frombuffer(held_drops.states[held_drops.current].read(), np.float32)
        births = np.frombuffer(held_drops.births.read(), np.float32).reshape(-1, 4)
        count, law = held_drops.alive, drops.slope(rate)
        whole = (float(law), -float(np.expm1(-5.5 * law)), 0.0, 0.0)
        speed = -state.reshape(-1, 6)[:count, 4].astype(np.float64)
        return Held(diameters(births[:count, 3], whole).astype(np.float64), speed)
    finally:
        rain.release()
        shaders.release()


def speeds(ax: Any, found: Held) -> None:
    size = np.linspace(0.1, 6.0, 400)
    some = [int(np.abs(found.size - d).argmin()) for d in np.linspace(0.5, 5.5, 26)]
    ax.plot(found.size[some], found.speed[some], "o", mfc="none", color="0.6", label="on the GPU")
    ax.plot(size, drops.terminal_speed(size), color=COLORS[1], label="atlas")
    for low, high in ((0.5, 1.5), (1.5001, 4.0), (4.0001, 6.0)):
        part = np.linspace(low, high, 100)
        label = "liu_tong" if low == 0.5 else None
        ax.plot(part, drops.terminal_speed(part, "liu_tong"), color=COLORS[3], label=label)
    ax.plot(*GUNN_KINZER.T, "k+", label="Gunn and Kinzer (1949)")
    name(ax, "Terminal speed", "diameter in mm", "m/s")


def sizes(ax: Any, found: dict[float, Held]) -> None:
    size = np.linspace(0.5, 6.0, 200)
    for rate, color in zip(RATES, COLORS, strict=True):
        ax.plot(size, drops.size_distribution(size, rate), color=color, label=f"{rate:g} mm/h")
        counts = np.histogram(found[rate].size, BINS)[0] / len(found[rate].size)
        per_mm = counts / np.diff(BINS) * float(drops.number_density(rate))
        ax.stairs(np.maximum(per_mm, 1e-3), BINS, color=color, alpha=0.45, lw=2.5)
    ax.set_yscale("log")
    ax.set_ylim(0.05, 6000.0)
    name(ax, "Sizes in the air: law, and what the GPU holds", "diameter in mm", "per m³ and mm")


def from_rest(ax: Any) -> None:
    time = np.linspace(0.0, 3.0, 151)
    for size, color in zip((0.5, 1.0, 2.0, 4.0), COLORS, strict=True):
        ax.plot(time, drops.fall_speed(size, time), color=color, label=f"{size:g} mm")
    ax.plot(time[:60], 9.8 * time[:60], "k:", label="free fall")
    ax.set_ylim(0.0, 11.0)
    name(ax, "Falling from rest", "s", "m/s")


def shower(ax: Any) -> None:
    time = np.linspace(0.01, 60.0, 300)
    for rate, color in zip(RATES, COLORS, strict=True):
        begun = [front.water_arrived(CEILING, (t, front.LONG, 0.0, 0.0), rate) for t in time]
        ended = [front.water_arrived(CEILING, (-1.0, t, 0.0, 0.0), rate) for t in time]
        ax.plot(time, begun, color=color, label=f"{rate:g} mm/h")
        ax.plot(time, ended, "--", color=color)
    name(ax, f"A shower from {CEILING:g} m begins, ends (dashed)", "s", "share of the rain rate")


def winds(ax: Any) -> None:
    time = np.linspace(0.0, T_MAX, 600)
    u, mid, most = time / TC, T_MID / TC, T_MAX / TC
    printed = np.where(u < 1.0, u, 1.0 - (1.0 - u))
    held_wind = np.where(u < mid, 1.0 + 0.3 * np.cos(u), 1.0 - (1.0 - u))
    ax.plot(time, wind.gust(time, TC, T_MAX), color=COLORS[1], label="gust")
    ax.plot(time, printed, "--", color=COLORS[1], label="gust as printed")
    ax.plot(time, wind.steady(time, TC, T_MID, T_MAX), color=COLORS[3], label="steady")
    ax.plot(time, np.where(u < 1.0, u, held_wind), "--", color=COLORS[3], label="steady as printed")
    ax.set_ylim(0.0, min(most, 3.0))
    name(ax, "Winds of Liu and Tong (2015)", "s", "strength")


def axis_ratios(ax: Any) -> None:
    size = np.linspace(0.1, 6.0, 200)
    ax.plot(size, drops.axis_ratio(size), color=COLORS[1], label="Beard and Chuang (1987)")
    for whole in range(1, 7):
        ratio = float(drops.axis_ratio(float(whole)))
        # Their outlines, to scale, flattened from below.
        angle = np.linspace(0.0, 2.0 * np.pi, 60)
        radius, up = 0.07 * whole, np.sin(angle)
        above = 0.5 * (1.0 + ratio)
        up = up * np.where(up > 0.0, above, 2.0 * ratio - above)
        ax.plot(whole + radius * np.cos(angle), 0.53 + SCALE * radius * up, color="0.5")
        ax.plot(whole, ratio, "o", color=COLORS[1], ms=4)
    ax.set_ylim(0.45, 1.03)
    name(ax, "Height over width", "diameter in mm", "")


def name(ax: Any, title: str, x: str, y: str) -> None:
    ax.set_title(title, fontsize=10)
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    ax.grid(alpha=0.25)
    ax.legend(fontsize=8)


def figure(ctx: moderngl.Context) -> Any:
    """The whole figure, of matplotlib."""
    from matplotlib.figure import Figure

    # Without a complete framebuffer some drivers write nothing in transform feedback.
    target = ctx.simple_framebuffer((8, 8))
    target.use()
    found = {rate: held(ctx, rate) for rate in RATES}
    ctx.detect_framebuffer(0).use()
    for thing in (*target.color_attachments, target.depth_attachment, target):
        thing.release()
    made = Figure(figsize=(12.0, 11.5), layout="constrained")
    (a, b), (c, d), (e, f) = made.subplots(3, 2)
    speeds(a, found[25.0])
    sizes(b, found)
    from_rest(c)
    shower(d)
    winds(e)
    axis_ratios(f)
    return made


def main(arguments: list[str]) -> int:
    if len(arguments) != 1:
        print("usage: python -m tools.plot_laws FILE", file=sys.stderr)
        return 2
    settings: dict[str, Any] = {"backend": "egl"} if sys.platform.startswith("linux") else {}
    ctx = moderngl.create_context(standalone=True, require=330, **settings)
    try:
        figure(ctx).savefig(Path(arguments[0]), dpi=100)
    finally:
        ctx.release()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
