"""Splashes in the picture: both backends, shelter, figures, looks at their ends."""

from __future__ import annotations

import esper
import moderngl
import numpy as np
import pytest

from tests.splash_scenes import play, scene
from tests.weather_pictures import stage
from weather_ecs.components import RainArea, SplashEmitter
from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.context import probe
from weather_ecs.gpu.gl import GL


def difference(
    ctx: moderngl.Context, backend: str, frames: int = 45, **scenery: object
) -> tuple[np.ndarray, dict[str, int]]:
    """What splashes change in the last picture, (height, width), and the figures of that frame."""
    pictures = []
    for splashes in (True, False):
        with stage(ctx, (320, 180), backend=backend, quality="medium") as it:
            scene(splashes, **scenery)
            pictures.append(play(it, frames).astype(int))
            if splashes:
                figures = {n: getattr(it.weather.stats, n) for n in ("splashes", "impacts")}
    return np.abs(pictures[0] - pictures[1]).max(axis=2), figures


def test_every_impact_splashes_and_both_backends_show_the_same(ctx: moderngl.Context):
    found = []
    for backend in ("compute", "feedback") if probe(ctx).compute else ("feedback",):
        changed, figures = difference(ctx, backend)
        assert figures["splashes"] > 60 and figures["impacts"] > 10
        assert (changed > 4).sum() > 400
        assert (changed[120:] > 4).sum() < 20  # none in the air, but droplets and crowns near by
        found.append((changed, figures))
    if len(found) == 2:
        (a, first), (b, second) = found
        assert np.mean(np.abs(a - b) > 12) < 0.004
        assert first["splashes"] == pytest.approx(second["splashes"], rel=0.1)


def test_there_are_none_under_a_roof(ctx: moderngl.Context, backend: str):
    open_air, _ = difference(ctx, backend)
    sheltered, _ = difference(ctx, backend, roof=True)
    # The floor from 2.6 m to 8 m before the camera; the roof is from 2 m to 14 m.
    floor = np.s_[36:100, 100:220]
    assert (open_air[floor] > 8).sum() > 60
    assert (sheltered[floor] > 2).sum() == 0


def test_without_an_emitter_there_are_none(ctx: moderngl.Context, backend: str):
    with stage(ctx, (160, 90), backend=backend, quality="low") as it:
        scene(splashes=False)
        play(it, 30)
        assert it.weather.stats.splashes == 0
        assert it.weather.stats.impacts > 0
        emitter = esper.create_entity(SplashEmitter())
        play(it, 20)
        assert it.weather.stats.splashes > 0
        esper.delete_entity(emitter, immediate=True)
        play(it, 2)
        assert it.weather.stats.splashes == 0


def test_nothing_is_hit_where_there_is_nothing(ctx: moderngl.Context, backend: str):
    with stage(ctx, (160, 90), backend=backend, quality="low") as it:
        esper.create_entity(RainArea((0, 0), (60, 40), 60.0))
        esper.create_entity(SplashEmitter())
        play(it, 20)
        assert (it.weather.stats.splashes, it.weather.stats.impacts) == (0, 0)


def test_impacts_are_counted_as_the_list_has_them(ctx: moderngl.Context, gl: GL):
    if not probe(ctx).compute:
        pytest.skip("no compute shaders here")
    with stage(ctx, (160, 90), backend="compute", quality="low") as it:
        scene()
        play(it, 30)
        renderer = it.weather._renderer
        assert renderer is not None
        impacts_list = renderer.rain.impacts()
        assert impacts_list is not None
        totals, counted = [], []
        for _ in range(12):
            play(it, 1)
            totals.append(impacts_list.read()[1])
            counted.append(it.weather.stats.impacts)
        gl.glBindBuffer(e.ARRAY_BUFFER, 0)  # reading has bound it, and it will be gone
        by_frame = np.diff(totals).tolist()
        # The figure is that of the frame before, which the GPU has done by then.
        assert counted[2:] == by_frame[:-1] and min(by_frame) > 0


def test_a_pause_keeps_every_splash_where_it_is(ctx: moderngl.Context, backend: str):
    with stage(ctx, (160, 90), backend=backend, quality="low") as it:
        scene()
        play(it, 30)
        it.weather.paused = True
        first = play(it, 1).copy()
        assert np.array_equal(play(it, 3), first)


@pytest.mark.parametrize(
    "looks", [{"size": 0.0}, {"opacity": 0.0}, {"detail": 0.0, "droplets": 0.0}, {"share": 0.0}]
)
def test_looks_at_the_ends_of_their_ranges(ctx: moderngl.Context, looks: dict[str, float]):
    with stage(ctx, (160, 90), quality="low") as it:
        scene(**looks)
        picture = play(it, 20)
        assert np.isfinite(picture).all()
        if "size" in looks or "opacity" in looks:
            assert it.weather.stats.splashes == 0
        else:
            assert it.weather.stats.splashes > 0
