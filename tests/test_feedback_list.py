"""The lists of what is in view that transform feedback writes, against NumPy, and their objects."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager

import esper
import moderngl
import numpy as np
import pytest

from tests.views import look_from, perspective
from tests.weather_pictures import SIZE, Stage, stage
from weather_ecs import QualitySettings
from weather_ecs.components import Air, Observer, PointLight, RainArea
from weather_ecs.frame import DropLook
from weather_ecs.gpu import feedback_list, kind_programs
from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.context import probe
from weather_ecs.gpu.drop_set import DropSet
from weather_ecs.gpu.feedback_list import FeedbackList, has_streams
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.gl_platform import FUNCTION
from weather_ecs.physics.snow_step import flake_diameters, flake_habits, flake_words

DROPS = 6003  # no multiple of what is looked at together
AT, HEADING, PITCH = (3.0, 1.7, -2.0), 0.6, 0.1
NONE = 0xFFFFFFFF
KINDS = pytest.mark.parametrize("snows", [False, True], ids=["rain", "snow"])


@contextmanager
def falling(
    ctx: moderngl.Context,
    snows: bool,
    drops: int = DROPS,
    backend: str = "feedback",
    size: tuple[int, int] = SIZE,
) -> Iterator[Stage]:
    """A stage of so many drops or flakes, a few frames on."""
    quality = QualitySettings("test", drops, 1, 256, True)
    with stage(ctx, size, backend=backend, quality=quality) as made:
        esper.create_entity(RainArea((0, 0), (200, 200), 4.0 if snows else 50.0))
        if snows:
            esper.create_entity(Air(temperature=-6.0, humidity=0.9))
        look(made, 5)
        yield made


def look(made: Stage, frames: int = 1) -> np.ndarray:
    return made.play(frames, position=AT, heading=HEADING, pitch=PITCH)


def drops_of(made: Stage, observer: int = 0) -> DropSet:
    renderer = made.weather._renderer
    assert renderer is not None
    (drops,) = renderer._rain.sets(observer).values()
    return drops


def listed(drops: DropSet) -> list[np.ndarray]:
    """Numbers in each list; what stands behind them starts primitives anew."""
    assert isinstance(drops.streaks, FeedbackList)
    found, whole = [], np.frombuffer(drops.streaks.ids.read(), np.uint32)
    for first in drops.streaks.firsts:
        ids = whole[first : first + drops.alive]
        some = ids[ids != NONE]
        assert (ids[len(some) :] == NONE).all()
        assert (np.diff(some.astype(np.int64)) > 0).all()  # in their own order
        found.append(some.astype(np.int64))
    return found


def state(drops: DropSet) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places and velocities, (n, 3), and quantiles of those that fall."""
    data = np.frombuffer(drops.states[drops.current].read(), np.float32).reshape(-1, 6)
    births = np.frombuffer(drops.births.read(), np.float32).reshape(-1, 4)
    n = drops.alive
    return data[:n, :3].astype(float), data[:n, 3:].astype(float), births[:n, 3]


def in_view(
    p: np.ndarray, v: np.ndarray, snows: bool, at: tuple[float, float, float], heading: float
) -> np.ndarray:
    """By how much each is within what is looked at, of the picture's size; (n,)."""
    matrix = perspective(aspect=16 / 9) @ look_from(at, heading, PITCH)
    head = np.c_[p, np.ones(len(p))] @ matrix.T
    if snows:
        inside = np.min(head[:, 3:] * 1.05 + 0.05 - np.abs(head[:, :2]), axis=1)
        within = np.minimum(inside, head[:, 3] - 0.15)
    else:
        tail = head - np.c_[v, np.zeros(len(v))] @ matrix.T * DropLook().exposure
        before = np.minimum(head[:, 3], tail[:, 3]) - 0.1
        with np.errstate(divide="ignore", invalid="ignore"):
            h, t = head[:, :2] / head[:, 3:], tail[:, :2] / tail[:, 3:]
        inside = np.min(1.03 - np.maximum(np.minimum(h, t), -np.maximum(h, t)), axis=1)
        within = np.where(before > 0.0, np.minimum(inside, before), before)
    return np.where(v[:, 1] > 1024.0, -1.0, within)


def pixels(made: Stage, drops: DropSet) -> np.ndarray:
    """How large flakes are drawn, (n,)."""
    renderer = made.weather._renderer
    assert renderer is not None
    block = renderer._rain._draw_block.data
    axis, shape, law, shown = (
        np.array(block[name], float).ravel()
        for name in ("container_axis", "container_shape", "drop_law", "drop_look")
    )
    snow = next(kind for kind in renderer._rain._kinds.values() if kind.far is not None)
    assert snow._block is not None
    motion, aperture = (
        np.array(snow._block.data[name], float).ravel() for name in ("snow_motion", "snow_look")
    )
    p, _, quantile = state(drops)
    x, z = p[:, 0] - axis[0], p[:, 2] - axis[1]
    along = (x * axis[2] - z * axis[3]) / shape[0]
    across = (x * axis[3] + z * axis[2]) / shape[1]
    d = np.minimum(np.hypot(along, across), 1.0)
    diameter = flake_diameters(quantile, tuple(law)).astype(float)
    habit = flake_habits(flake_words(np.arange(len(p), dtype=np.uint32)), tuple(law))
    share = np.clip((diameter - motion[2]) / 0.4, 0.0, 1.0)
    share = share * share * (3.0 - 2.0 * share)
    crystal = np.array([2.7, 3.0, 7.5])[habit]
    size = diameter * (crystal + (4.0 - crystal) * share)
    size += (1.3 * diameter - size) * law[2]
    size *= 1e-3 * shown[2] * shown[1] * (1.0 + (shown[0] - 1.0) * d * d)
    deep = (np.c_[p, np.ones(len(p))] @ look_from(AT, HEADING, PITCH).T)[:, 2] * -1.0
    size += aperture[0] * np.maximum(1.0 - deep / 6.0, 0.0)
    scale = 0.5 * made.size[1] * perspective()[1, 1]
    return np.where(deep > 0.0, size * scale / np.where(deep > 0.0, deep, 1.0), 0.0)


@KINDS
def test_lists_are_the_oracles(ctx: moderngl.Context, snows: bool) -> None:
    with falling(ctx, snows, size=(960, 540)) as made:
        for _ in range(3):
            look(made)
            drops = drops_of(made)
            assert drops.alive % 4 and drops.births.size // 16 % 4 == 0
            p, v, _ = state(drops)
            within = in_view(p, v, snows, AT, HEADING)
            lists = listed(drops)
            seen = np.sort(np.concatenate(lists))
            assert len(np.unique(seen)) == len(seen)
            shown = np.zeros(drops.alive, bool)
            shown[seen] = True
            sure = np.abs(within) > 1e-3
            assert sure.mean() > 0.98
            assert (shown == (within > 0.0))[sure].all()
            assert 0.05 < shown.mean() < 0.5
        if snows and has_streams(ctx):
            large, small = lists
            size = pixels(made, drops)
            assert (size[large] > 7.0 * 0.999).all() and (size[small] < 7.0 * 1.001).all()
            assert min(len(large), len(small)) > 5


@KINDS
def test_long_lists_are_emptied_piece_by_piece(
    ctx: moderngl.Context, snows: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(feedback_list, "AT_ONCE", 500)
    with falling(ctx, snows) as made:
        drops = drops_of(made)
        p, v, _ = state(drops)
        within = in_view(p, v, snows, AT, HEADING)
        seen = np.concatenate(listed(drops))
        assert np.isin(np.flatnonzero(within > 1e-3), seen).all()
        assert len(seen) == len(np.unique(seen)) <= (within > -1e-3).sum()


@KINDS
def test_pictures_are_those_of_compute(ctx: moderngl.Context, snows: bool) -> None:
    if not probe(ctx).compute:
        pytest.skip("no compute shaders here")
    pictures = []
    for backend in ("compute", "feedback"):
        with falling(ctx, snows, backend=backend) as made:
            pictures.append(look(made).astype(int))
            assert made.rain(pictures[-1]).max() > 20
    # Both step by the same laws; a drop at the container's rim may fall to either side of it.
    off = np.abs(pictures[0] - pictures[1]).max(axis=2)
    assert (off > 8).mean() < 0.01


@KINDS
def test_the_same_number_is_drawn_as_with_compute(ctx: moderngl.Context, snows: bool) -> None:
    if not probe(ctx).compute:
        pytest.skip("no compute shaders here")
    drawn = []
    for backend in ("compute", "feedback"):
        with falling(ctx, snows, backend=backend) as made:
            look(made, 5)
            ctx.finish()
            look(made)
            drawn.append(made.weather.stats.drops_drawn)
    assert drawn[0] > 300 and drawn[1] == pytest.approx(drawn[0], rel=0.02)


def test_without_streams_there_is_one_list_of_snow(
    ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    found, pictures = [], []
    for streams in (True, False):
        if not streams:
            monkeypatch.setattr(kind_programs, "has_streams", lambda _: False)
        with falling(ctx, snows=True) as made:
            pictures.append(made.rain(look(made)).mean())
            lists = listed(drops_of(made))
            assert len(lists) == (2 if streams and has_streams(ctx) else 1)
            found.append(np.sort(np.concatenate(lists)))
    assert np.array_equal(found[0], found[1])
    # Small flakes are discs by the one way, pictures by the other.
    assert pictures[0] == pytest.approx(pictures[1], rel=0.05)


def test_every_number_of_drops_is_listed_to_the_last(ctx: moderngl.Context) -> None:
    for drops in (1, 2, 3, 4, 5, 6, 7, 9):
        with falling(ctx, snows=False, drops=drops) as made:
            for heading in np.arange(0.0, 6.3, 0.7):
                made.play(1, position=AT, heading=float(heading), pitch=PITCH)
                found = drops_of(made)
                p, v, _ = state(found)
                within = in_view(p, v, False, AT, float(heading))
                assert listed(found)[0].tolist() == np.flatnonzero(within > 0.0).tolist()


@KINDS
def test_observers_have_lists_of_their_own(ctx: moderngl.Context, snows: bool) -> None:
    with falling(ctx, snows) as made:
        other = Observer()
        for _ in range(3):
            esper.process(1 / 30)
            first = made.draw(AT, HEADING, PITCH)
            made.draw((40.0, 1.7, 9.0), 3.0, PITCH, observer=other)
        renderer = made.weather._renderer
        assert renderer is not None
        keys = list(renderer._rain._observed)
        assert len(keys) == 2
        for key, at, heading in zip(keys, (AT, (40.0, 1.7, 9.0)), (HEADING, 3.0), strict=True):
            drops = drops_of(made, key)
            p, v, _ = state(drops)
            within = in_view(p, v, snows, at, heading)
            shown = np.zeros(drops.alive, bool)
            shown[np.concatenate(listed(drops))] = True
            assert (shown == (within > 0.0))[np.abs(within) > 1e-3].all()
        # Whoever looks in between, the same is seen from the same place.
        assert np.array_equal(first, made.draw(AT, HEADING, PITCH))


@KINDS
def test_a_larger_set_has_longer_lists(ctx: moderngl.Context, snows: bool) -> None:
    """That nothing of the shorter ones is left alive is the fixture's to find."""
    with falling(ctx, snows, drops=500) as made:
        before = drops_of(made)
        assert before.bytes_per_drop == 64 and len(listed(before)) == (2 if snows else 1)
        esper.create_entity(PointLight((0.0, 3.0, 0.0), (9.0, 8.0, 6.0), 20.0))
        look(made)
        made.weather.quality = QualitySettings("more", 3001, 1, 256, True)
        look(made, 3)
        drops = drops_of(made)
        assert drops is not before and drops.capacity > before.capacity
        assert before.streaks is None
        assert np.concatenate(listed(drops)).max() > 500


def test_the_hosts_restart_index_skips_no_drop(ctx: moderngl.Context, gl: GL) -> None:
    with falling(ctx, snows=False, drops=100) as made:
        expected = look(made)
        assert made.rain(expected).max() > 20
        (seen,) = listed(drops_of(made))
        gl.glEnable(e.PRIMITIVE_RESTART)
        try:
            for index in (0, *seen.tolist()):
                gl.glPrimitiveRestartIndex(index)
                assert np.array_equal(made.draw(AT, HEADING, PITCH), expected)
                assert gl.get_int(e.PRIMITIVE_RESTART_INDEX) == index
                assert gl.glIsEnabled(e.PRIMITIVE_RESTART)
        finally:
            gl.glPrimitiveRestartIndex(NONE)
            gl.glDisable(e.PRIMITIVE_RESTART)


def test_the_hosts_transform_feedback_is_its_own(ctx: moderngl.Context, gl: GL) -> None:
    if gl.glBindTransformFeedback is None:
        pytest.skip("no such objects here")
    with falling(ctx, snows=True) as made:
        expected = look(made)
        lists = listed(drops_of(made))
        name, own = ctypes.c_uint(), ctx.buffer(b"\x11" * 64)
        make, give = (
            FUNCTION(None, ctypes.c_int, ctypes.c_void_p)(gl._lookup(function))
            for function in (b"glGenTransformFeedbacks", b"glDeleteTransformFeedbacks")
        )
        make(1, ctypes.addressof(name))
        gl.glBindTransformFeedback(e.TRANSFORM_FEEDBACK, name.value)
        gl.glBindBufferBase(e.TRANSFORM_FEEDBACK_BUFFER, 0, own.glo)
        try:
            assert np.array_equal(made.draw(AT, HEADING, PITCH), expected)
            for before, now in zip(lists, listed(drops_of(made)), strict=True):
                assert np.array_equal(before, now)
            assert gl.get_int(e.TRANSFORM_FEEDBACK_BINDING) == name.value
            bound = ctypes.c_int()
            gl.glGetIntegeri_v(e.TRANSFORM_FEEDBACK_BUFFER_BINDING, 0, ctypes.addressof(bound))
            assert bound.value == own.glo
            assert own.read() == b"\x11" * 64
        finally:
            gl.glBindTransformFeedback(e.TRANSFORM_FEEDBACK, 0)
            give(1, ctypes.addressof(name))
            own.release()
