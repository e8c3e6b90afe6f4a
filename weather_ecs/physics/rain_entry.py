"""Where drops come in in turbulent air: the oracle of `shaders/drop_entry.glsl`, in float32."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.rain_place import from_container, in_half_disc, to_container
from weather_ecs.physics.turbulence import AirFlow, eddies, felt_shares, mean_velocity
from weather_ecs.physics.words import hash_word

if TYPE_CHECKING:
    from weather_ecs.physics.rain_step import Step

# As in the shader.
ENTRIES = 12
EDDY_REACH = 2.5  # standard deviations
HALF_PI = 0.5 * math.pi

F = np.float32
U = np.uint32


def come_in(
    birth: NDArray, ids: NDArray[np.uint32], own: NDArray, elsewhere: NDArray, p: NDArray, s: Step
) -> NDArray[np.float32]:
    """Velocities of the drops that have come in; in turbulent air p, too, is theirs, in place."""
    flow = s.flow or AirFlow(s.wind[:3])
    if is_steady(flow):
        return np.asarray(mean_velocity(p, flow) + own, F)
    turns = s.from_axis[2:] != s.to_axis[2:] or s.from_shape != s.to_shape
    sought = elsewhere & (ids < s.fresh) & any(flow.gains) & (not turns)
    motion = _felt(p, own, flow)
    left = np.flatnonzero(sought)
    h = ids[left] ^ hash_word(np.full(1, s.seed, U))
    for _ in range(ENTRIES):
        if not len(left):
            break
        h = hash_word(h)
        at, once = _border_places(h, birth[left, 2], own[left], flow, s)
        v = _felt(at, own[left], flow)
        before = at - v * F(s.wind[3])
        rise = before[:, 1] - F(s.from_shape[2])
        q = to_container(before[:, [0, 2]], s.from_axis, s.to_shape)
        was_in = (rise >= 0.0) & (rise < F(s.from_shape[3])) & in_half_disc(q, birth[left, 2])
        found = once & ~was_in
        p[left[found]], motion[left[found]] = at[found], v[found]
        left, h = left[~found], h[~found]
    return motion


def is_steady(flow: AirFlow) -> bool:
    """Whether the air moves alike everywhere: no turbulence, and no wind that grows with height."""
    return not any(flow.gains) and (flow.exponent == 0.0 or not any(flow.wind))


def _felt(p: NDArray, own: NDArray, flow: AirFlow) -> NDArray[np.float32]:
    """Velocities of drops that have long been on their way, which lag behind the air."""
    fall = own[:, 1]
    at = p.astype(F)
    at[:, 1] += fall * fall / F(9.8)
    v = mean_velocity(at, flow) + own
    return v + eddies(at, flow, -fall) if any(flow.gains) else v


def _border_places(
    word: NDArray[np.uint32], reach: NDArray, own: NDArray, flow: AirFlow, s: Step
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """Places near the border, and which count; see the shader."""
    forward, lateral, bottom, height = map(F, s.to_shape)
    dt = F(s.wind[3])
    fall = -own[:, 1] * dt
    felt = np.asarray(flow.gains, F) * felt_shares(-own[:, 1], flow)
    eddy = F(EDDY_REACH) * np.sqrt((felt * felt).sum(axis=1)) * dt
    low = np.clip(eddy - fall, F(0.0), F(0.5) * height)
    high = np.clip(fall + eddy, F(0.0), F(0.5) * height)
    middle = height - low - high
    top = np.array([[0.0, bottom + height, 0.0]], F)
    shift = np.asarray(s.to_axis[:2], F) - np.asarray(s.from_axis[:2], F)
    moved = (mean_velocity(top, flow) + own)[:, [0, 2]] * dt - shift
    side = (np.sqrt((moved * moved).sum(axis=1)) + eddy) / min(forward, lateral)
    side = np.minimum(side, reach)
    level = F(HALF_PI) * reach * reach * (low + high)
    rim = F(HALF_PI) * side * (F(2.0) * reach - side) * middle
    back = F(2.0) * reach * side * middle
    u, v, w, pick = _units(word)
    pick = pick * (level + rim + back)
    on_level, on_back = pick < level, pick >= level + rim
    y = w * np.where(on_level, low + high, middle)
    y = y + np.where(on_level, np.where(y >= low, middle, F(0.0)), low)
    inner = np.where(on_level, F(0.0), reach - side)
    r = np.sqrt(inner * inner + (reach * reach - inner * inner) * u)
    angle = (v - F(0.5)) * F(math.pi)
    q = np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1)
    flat = np.stack([side * u, reach * (F(2.0) * v - F(1.0))], axis=1)
    q = np.where(on_back[:, None], flat, q).astype(F)
    p = np.empty((len(word), 3), F)
    p[:, [0, 2]] = from_container(q, s.to_axis, s.to_shape)
    p[:, 1] = bottom + y
    return p, ~on_back | (np.sqrt((q * q).sum(axis=1)) < inner)


def _units(word: NDArray[np.uint32]) -> NDArray[np.float32]:
    """Four numbers in [0, 1) of 16 bits, (4, n)."""
    other = hash_word(word ^ U(0x9E3779B9))
    parts = [half for h in (word, other) for half in (h >> U(16), h & U(0xFFFF))]
    return np.stack(parts).astype(F) * F(1.0 / 65536.0)
