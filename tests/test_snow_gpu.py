"""Snow on the GPU: flakes against the oracle, gauges, silence where they land, and pictures."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from types import SimpleNamespace

import esper
import moderngl
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.drop_oracle import SEED, N, oracle, slab_map, states
from tests.rain_frames import area, frame
from tests.targets import bound_target
from tests.views import look_from, perspective
from weather_ecs import Weather
from weather_ecs.components import (
    Occluder,
    PointLight,
    RainArea,
    RainGauge,
    SnowFlakes,
    SplashEmitter,
    Wind,
)
from weather_ecs.frame import SNOW, AirData, SnowLook, ViewData, WindProfile
from weather_ecs.gpu import kind_programs
from weather_ecs.gpu.context import probe
from weather_ecs.gpu.rain_pass import RainPass
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.physics.camera import camera_from
from weather_ecs.systems.extract import ExtractSystem
from weather_ecs.systems.rain_view import RainView

SETTINGS = SimpleNamespace(drops=N, containers=4, budget=1.0, veil=True, heightmap_size=64)
COLD = AirData(temperature=-3.0, humidity=0.9, wet_bulb=-3.5, snow_share=1.0)
SLEET = AirData(temperature=1.0, humidity=0.9, wet_bulb=0.4, snow_share=0.5)
LOOKS = {"physical": SnowLook(), "liu_tong": SnowLook(model="liu_tong")}


@pytest.fixture
def target(ctx: moderngl.Context) -> Iterator[moderngl.Framebuffer]:
    with bound_target(ctx, (160, 90)) as made:
        yield made


def views_of(frames: int, air: AirData, look: SnowLook, wind=(3.0, 0.0, 1.0)) -> list[ViewData]:
    """A walk through snow, turning, in turbulent air."""
    view_of, profile, views = RainView(SEED), WindProfile(turbulence=0.8), []
    rows = (area(0, (0.0, 0.0), (60.0, 40.0), 2.0), area(1, (50.0, -30.0), (30.0, 20.0), 4.0))
    for k in range(frames):
        t = 100.0 + k / 30
        place = look_from((-60 + 20 * k / 30, 1.7, 5 * math.sin(t)), 1.2 * math.sin(t))
        it = frame(*rows, time=t, wind=wind, air=air, flakes=look, profile=profile)
        views.append(view_of.view(it, camera_from(place, perspective()), 0, SETTINGS))
    return views


def compare(found: dict[int, np.ndarray], expected: dict[int, np.ndarray]) -> None:
    assert set(found) == set(expected)
    for key, flakes in expected.items():
        got = found[key]
        assert got.shape == flakes.shape and np.isfinite(got).all()
        # At a rim or an edge rounding may send one elsewhere: few do.
        away = np.abs(got - flakes).max(axis=1)
        assert np.mean(away > 2e-2) < 0.03 and np.median(away) < 2e-3, key


@pytest.mark.usefixtures("target")
@pytest.mark.parametrize("model", LOOKS)
@pytest.mark.parametrize("air", [COLD, SLEET], ids=["snow", "sleet"])
def test_flakes_are_where_the_oracle_has_them(
    ctx: moderngl.Context, backend: str, air: AirData, model: str
) -> None:
    views = views_of(25, air, LOOKS[model])
    kinds = {c.kind for view in views for c in view.containers}
    assert kinds == ({SNOW} if air is COLD else {0, SNOW})
    shaders = ShaderLoader(ctx)
    rain = RainPass(ctx, shaders, backend=backend, seed=SEED)
    try:
        for view in views:
            rain.update(view)
        compare(states(rain), oracle(views))
    finally:
        rain.release()
        shaders.release()


@pytest.mark.usefixtures("target")
def test_flakes_of_a_far_shaft_grow_less_than_drops(ctx: moderngl.Context, backend: str) -> None:
    shaders = ShaderLoader(ctx)
    rain = RainPass(ctx, shaders, backend=backend, seed=SEED)
    try:
        view = views_of(1, SLEET, SnowLook())[0]
        for kind in {c.kind for c in view.containers}:
            near = next(c for c in view.containers if c.kind == kind)
            shown = {}
            for scale in (1.0, 2.25, 9.0):
                rain.fill_container(dataclasses.replace(near, size_scale=scale), view)
                data = rain._draw_block.data
                shown[scale] = float(data["drop_look"][1]), float(data["drop_load"][3])
            sizes = [size for size, _ in shown.values()]
            assert sizes == pytest.approx([1.0, 1.5, 3.0] if kind == SNOW else [1.0, 2.25, 9.0])
            # What it covers grows with its area, up to a limit.
            assert shown[2.25][1] == pytest.approx(shown[1.0][1] * sizes[1] ** 2)
            assert shown[9.0][1] == pytest.approx(shown[1.0][1] * min(sizes[2] ** 2, 16.0))
    finally:
        rain.release()
        shaders.release()


@pytest.mark.usefixtures("target")
def test_flakes_land_silently(ctx: moderngl.Context, backend: str) -> None:
    views = views_of(50, COLD, SnowLook())
    textures, block, shelter = slab_map(ctx)
    shaders = ShaderLoader(ctx)
    rain = RainPass(ctx, shaders, backend=backend, seed=SEED, impact_capacity=4096)
    try:
        for view in views:
            rain.update(view, sheltered=True)
        found = states(rain)
        compare(found, oracle(views, shelter))
        landed = np.concatenate([state[:, 4] for state in found.values()])
        landed = landed[landed > 1024.0]
        assert len(landed) > 100 and (landed > 1e8).all()  # gone, and with no place of a hit
        impacts = rain.impacts()
        if impacts is not None:
            assert impacts.read()[1] == 0
    finally:
        rain.release()
        shaders.release()
        block.release()
        textures.release()


# In a weather


@pytest.fixture
def air(monkeypatch: pytest.MonkeyPatch) -> dict[str, AirData]:
    """The air of every frame, for tests to set."""
    now, plain = {"air": COLD}, ExtractSystem.frame

    def frame_in(self, state):
        return dataclasses.replace(plain(self, state), air=now["air"])

    monkeypatch.setattr(ExtractSystem, "frame", frame_in)
    return now


def watch(weather: Weather, seconds: float, step: float = 0.1) -> None:
    for _ in range(round(seconds / step)):
        esper.process(step)
        weather.draw(look_from((0, 1.7, 0), 0.0), perspective())


@pytest.mark.usefixtures("target", "world")
@pytest.mark.parametrize("share", [1.0, 0.4])
def test_a_gauge_reads_rain_and_snow_together(
    ctx: moderngl.Context, backend: str, air: dict[str, AirData], share: float
) -> None:
    rate = 4.0
    air["air"] = COLD if share == 1.0 else dataclasses.replace(SLEET, snow_share=share)
    with Weather(context=ctx, backend=backend, quality="medium", seed=2) as weather:
        esper.create_entity(RainArea((0, 0), (200, 200), rate))
        esper.create_entity(Wind((0.6, 0.8), 1.5))
        gauges = [RainGauge((x, 0.5, z), window=20.0) for x, z in ((2, 0), (8, 0), (14, -6))]
        for gauge in gauges:
            esper.create_entity(gauge)
        watch(weather, 22.0)
        got = [gauge.rate for gauge in gauges]
        assert got == pytest.approx([rate] * len(gauges), rel=0.05)
        assert got != [rate] * len(gauges)  # counted, and not looked up


@pytest.mark.usefixtures("target", "world")
def test_snow_makes_no_splashes_and_sleet_few(
    ctx: moderngl.Context, backend: str, air: dict[str, AirData]
) -> None:
    with Weather(context=ctx, backend=backend, quality="low", seed=2) as weather:
        esper.create_entity(RainArea((0, 0), (200, 200), 10.0))
        esper.create_entity(SplashEmitter())
        esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((0, -1, 0), (100, 1, 100))))
        watch(weather, 2.5)
        assert weather.stats.impacts == 0 and weather.stats.splashes == 0
        air["air"] = SLEET
        watch(weather, 2.5)
        assert weather.stats.impacts > 0


def picture(weather: Weather, target: moderngl.Framebuffer, grey: float) -> np.ndarray:
    target.clear(grey, grey, grey, 1.0)
    weather.draw(look_from((0, 1.7, 0), 0.0), perspective())
    raw = np.frombuffer(target.read(components=3), np.uint8)
    return raw.reshape(90, 160, 3).astype(float).mean(axis=2) / 255.0


@pytest.mark.usefixtures("world", "air")
def test_flakes_are_light_before_the_dark_and_dark_before_the_light(
    ctx: moderngl.Context, backend: str, target: moderngl.Framebuffer
) -> None:
    with Weather(context=ctx, backend=backend, quality="low", seed=3) as weather:
        esper.create_entity(RainArea((0, 0), (200, 200), 4.0))
        esper.create_entity(SnowFlakes(veil=0.0, brightness=1.0))
        watch(weather, 0.5)
        dark, light = picture(weather, target, 0.05), picture(weather, target, 1.0)
        assert (dark - 0.05 > 0.15).mean() > 0.01 and (1.0 - light > 0.02).mean() > 0.01
        # Flakes hide what is behind them: the two pictures are closest where they are.
        hidden = 1.0 - (light - dark) / 0.95
        assert hidden.max() > 0.5 and np.median(hidden) < 0.2


@pytest.mark.usefixtures("world", "air")
def test_flakes_of_a_few_pixels_show_as_much_without_their_pictures(
    ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They are discs where they can be listed apart; without, all are drawn with their pictures."""
    if not probe(ctx).compute:
        pytest.skip("no compute shaders here")
    target = ctx.simple_framebuffer((960, 540))
    target.use()
    added = {}
    for backend in ("compute", "feedback", "pictures"):
        named = backend if backend != "pictures" else "feedback"
        if backend == "pictures":
            monkeypatch.setattr(kind_programs, "has_streams", lambda _: False)
        with Weather(context=ctx, backend=named, quality="medium", seed=3) as weather:
            area = esper.create_entity(RainArea((0, 0), (200, 200), 4.0))
            look = esper.create_entity(SnowFlakes(veil=0.0, brightness=1.0))
            watch(weather, 0.5)
            found = []
            for _ in range(3):
                watch(weather, 0.1)
                target.clear(0.05, 0.05, 0.05, 1.0)
                weather.draw(look_from((0, 1.7, 0), 0.0), perspective())
                found.append(np.frombuffer(target.read(components=3), np.uint8).mean() / 255.0)
            added[backend] = np.mean(found) - 0.05
            if backend == "compute":
                (drops,) = weather._renderer.rain.sets(0).values()
                assert drops.streaks is not None
                commands = np.frombuffer(drops.streaks._commands.read(), np.uint32).reshape(
                    2, -1, 5
                )
                near, far = commands[..., 0].sum(axis=1).tolist()
                assert 0 < near < far < near + far < drops.alive
                for (n, _, first, *_), (m, _, start, *_) in commands.transpose(1, 0, 2).tolist():
                    assert first + n <= start and start + m <= drops.capacity
            esper.delete_entity(area, immediate=True)
            esper.delete_entity(look, immediate=True)
    assert added["compute"] == pytest.approx(added["feedback"], rel=0.01)
    assert added["compute"] == pytest.approx(added["pictures"], rel=0.05)
    assert added["compute"] > 0.005
    for thing in (*target.color_attachments, target.depth_attachment, target):
        thing.release()


@pytest.mark.usefixtures("world")
@pytest.mark.parametrize("falls", [COLD, AirData()], ids=["snow", "rain"])
def test_what_draws_without_lamps_draws_the_same(
    ctx: moderngl.Context,
    backend: str,
    target: moderngl.Framebuffer,
    air: dict[str, AirData],
    falls: AirData,
) -> None:
    air["air"] = falls
    with Weather(context=ctx, backend=backend, quality="low", seed=3) as weather:
        esper.create_entity(RainArea((0, 0), (200, 200), 8.0))
        watch(weather, 0.5)
        none = picture(weather, target, 0.1)
        lamp = PointLight((0.0, 500.0, 0.0), reach=1.0)
        esper.create_entity(lamp)
        esper.process(0.0)
        assert (picture(weather, target, 0.1) == none).all()
        lamp.position, lamp.color, lamp.reach = (2.0, 2.0, 0.0), (20.0, 20.0, 20.0), 20.0
        esper.process(0.0)
        change = picture(weather, target, 0.1) - none
        assert change.min() > -0.004 and change.max() > 0.015
