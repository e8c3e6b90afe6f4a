"""One step of the drops of a container: the oracle of `shaders/drop_step.glsl`, in float32.

The same symbols and the same order of operations; see the shader for why the maps are as they
are. Arrays: p, v (n, 3); birth (n, 4) = forward, lateral, own reach, size quantile.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.container import Container
from weather_ecs.physics.rain_entry import come_in
from weather_ecs.physics.rain_place import (
    from_container,
    in_half_disc,
    resettle,
    ring,
    to_container,
    turn_to_container,
)
from weather_ecs.physics.shelter import ShelterMap
from weather_ecs.physics.snow_step import Flakes, flake_velocities
from weather_ecs.physics.turbulence import AirFlow, air_velocity
from weather_ecs.physics.words import hash_unit

# As in shaders/landed.glsl.
LANDED = 8192.0
NO_IMPACT = 1e9

F = np.float32
U = np.uint32


@dataclass(frozen=True, slots=True)
class Step:
    """What is the same for all drops of a step: the uniform block `RainStep`."""

    from_axis: tuple[float, float, float, float]  # centre x, centre z, cos heading, sin heading
    from_shape: tuple[float, float, float, float]  # forward, lateral, bottom, height
    to_axis: tuple[float, float, float, float]
    to_shape: tuple[float, float, float, float]
    wind: tuple[float, float, float, float]  # m/s, and dt in s
    law: tuple[float, float, float, float]
    seed: int
    fresh: int  # drops from here on begin anew
    flow: AirFlow | None = None  # of the air; None: `wind` everywhere
    flakes: Flakes | None = None  # of snow; None: drops


def axis_of(container: Container) -> tuple[float, float, float, float]:
    """(centre x, centre z, cos heading, sin heading)."""
    h = container.heading
    return (*container.center, math.cos(h), math.sin(h))


def shape_of(container: Container) -> tuple[float, float, float, float]:
    """(forward reach, lateral reach, bottom, height)."""
    return (*container.reach, container.bottom, container.height)


def law_of(rain_rate: float) -> tuple[float, float, float, float]:
    """(slope in 1/mm, 1 - exp(-5.5 slope), 0, 0) of Marshall and Palmer's distribution."""
    slope = 4.1 * max(rain_rate, 1e-3) ** -0.21
    return (slope, -math.expm1(-5.5 * slope), 0.0, 0.0)


def diameters(quantile: NDArray, law: tuple[float, ...]) -> NDArray:
    """Diameters in mm, (n,), of size quantiles."""
    left = np.maximum(F(1.0) - quantile * F(law[1]), F(1e-7))
    return np.minimum(F(0.5) - np.log(left) / F(law[0]), F(6.0)).astype(F)


def fall_speeds(diameter: NDArray) -> NDArray:
    """Terminal speeds in m/s (Atlas et al. 1973)."""
    return np.maximum(F(9.65) - F(10.3) * np.exp(F(-0.6) * diameter), F(0.0)).astype(F)


def _own_velocities(birth: NDArray, ids: NDArray[np.uint32], s: Step) -> NDArray[np.float32]:
    """Velocities in still air, (n, 3): drops fall, flakes sway as well."""
    if s.flakes is not None:
        return flake_velocities(ids, birth[:, 3], s.law, s.flakes)
    own = np.zeros((len(birth), 3), F)
    own[:, 1] = -fall_speeds(diameters(birth[:, 3], s.law))
    return own


def _drift(p: NDArray, own: NDArray, s: Step) -> NDArray[np.float32]:
    """Velocities in the air's motion at p, (n, 3)."""
    return air_velocity(p, s.flow or AirFlow(s.wind[:3])) + own


def _follow(at: NDArray, drift: NDArray, own: NDArray, s: Step) -> tuple[NDArray, NDArray]:
    """The container's move and turn as a map of the half disc before onto the one after."""
    axis = (*s.to_axis[:2], *s.from_axis[2:])
    q = to_container(at, axis, s.to_shape)
    out = ~in_half_disc(q, own)
    shift = np.asarray(s.to_axis[:2], F) - np.asarray(s.from_axis[:2], F)
    ringed, good = ring(q, turn_to_container(drift - shift, axis, s.to_shape), own)
    at = np.where(out[:, None], from_container(ringed, axis, s.to_shape), at)
    good = good | ~out
    if s.from_axis[2:] != s.to_axis[2:]:
        q = to_container(at, s.to_axis, s.to_shape)
        out = ~in_half_disc(q, own)
        good &= ~out | in_half_disc(-q, own)
        at = np.where(out[:, None], from_container(-q, s.to_axis, s.to_shape), at)
    return at, good


def _carry(
    at: NDArray, drift: NDArray, own: NDArray, fresh: NDArray, s: Step
) -> NDArray[np.float32]:
    """Drops left outside, carried on until they come to where the container has just arrived."""
    arrived = np.zeros(len(at), bool)
    going = np.ones(len(at), bool)
    for _ in range(4):
        moved, good = _follow(at, drift, own, s)
        going &= good
        at = np.where((going & ~arrived)[:, None], moved, at)
        before = to_container(at - drift, s.from_axis, s.to_shape)
        arrived |= going & ~in_half_disc(before, own)
    return np.where(arrived[:, None], at, fresh).astype(F)


def step(
    birth: NDArray[np.float32],
    p: NDArray[np.float32],
    v: NDArray[np.float32],
    s: Step,
    shelter: ShelterMap | None = None,
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Positions and velocities after one step, each (n, 3) float32.

    A drop that has met the surface of `shelter` has, for its velocity, the place of the hit, with
    LANDED added to the height; NO_IMPACT for its height where it came in under cover.
    """
    ids = np.arange(len(birth), dtype=U)
    own = _own_velocities(birth, ids, s)
    fall, drift = -own[:, 1], _drift(p, own, s)
    begins = ids >= s.fresh
    landed = ~begins & (v[:, 1] > 1024.0)
    motion = np.where((landed | begins)[:, None], drift, v)
    before, held = p, v
    p = p.copy()
    dt = F(s.wind[3])
    gain = F(1.0) - np.exp(-dt * F(9.8) / np.maximum(fall, F(0.1)))
    motion = motion + (drift - motion) * gain[:, None]
    p += motion * dt
    elsewhere = _keep_in_container(birth, ids, motion[:, [0, 2]] * dt, p, s)
    first = np.empty_like(p)
    first[:, [0, 2]] = from_container(birth[:, :2], s.to_axis, s.to_shape)
    first[:, 1] = F(s.to_shape[2]) + F(s.to_shape[3]) * hash_unit(ids * U(2) + U(1))
    p = np.where(begins[:, None], first, p)
    elsewhere |= begins
    landed &= ~elsewhere
    motion = np.where(elsewhere[:, None], come_in(birth, ids, own, elsewhere, p, s), motion)
    v = np.where(landed[:, None], held, motion)
    if shelter is not None:
        v = _land(shelter, before, p, v, landed, elsewhere, s.flakes is None)
    return p.astype(F), v.astype(F)


def _land(
    shelter: ShelterMap,
    before: NDArray,
    p: NDArray,
    v: NDArray,
    landed: NDArray,
    elsewhere: NDArray,
    kept_hits: bool,
) -> NDArray:
    """Velocities, with the place of the hit where a drop has met the surface; flakes keep none."""
    m, m0 = shelter.places(p), shelter.places(before)
    lands = ~landed & shelter.knows(m) & (shelter.below_texel(m) > 0.0)
    was_above = ~elsewhere & shelter.knows(m0) & (shelter.below_texel(m0) <= 0.0)
    hit, true = shelter.meets(before, p)
    hits = lands & was_above & true & kept_hits
    kept = np.stack([p[:, 0], np.full(len(p), NO_IMPACT, F), p[:, 2]], axis=1)
    kept = np.where(hits[:, None], hit + np.asarray([0.0, LANDED, 0.0], F), kept)
    return np.where(lands[:, None], kept, v)


def _keep_in_container(
    birth: NDArray, ids: NDArray[np.uint32], drift: NDArray, p: NDArray, s: Step
) -> NDArray[np.bool_]:
    """Keeps drops that have moved by `drift` to their container, in place; which are elsewhere."""
    own = birth[:, 2]
    elsewhere = np.zeros(len(p), bool)
    if s.from_shape[:2] != s.to_shape[:2]:
        q = to_container(p[:, [0, 2]], s.from_axis, s.from_shape)
        p[:, [0, 2]] = from_container(q, s.from_axis, s.to_shape)
    fresh = from_container(resettle(ids, own, s.seed), s.to_axis, s.to_shape)
    out = np.flatnonzero(~in_half_disc(to_container(p[:, [0, 2]], s.to_axis, s.to_shape), own))
    if len(out):
        places = _carry(p[out][:, [0, 2]], drift[out], own[out], fresh[out], s)
        p[out, 0], p[out, 2] = places[:, 0], places[:, 1]
        elsewhere[out] = True
    bottom, height = F(s.to_shape[2]), F(s.to_shape[3])
    if s.from_shape[3] != s.to_shape[3]:
        p[:, 1] = bottom + (p[:, 1] - F(s.from_shape[2])) * (height / F(s.from_shape[3]))
    turns = np.floor((p[:, 1] - bottom) / height)
    p[:, 1] -= turns * height
    again = (turns < 0.0)[:, None]
    p[:, [0, 2]] = np.where(again, fresh, p[:, [0, 2]])
    return elsewhere | (turns != 0.0)
