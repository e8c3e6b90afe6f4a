"""What the editor's sky and weather panels do to a document, without a window."""

from __future__ import annotations

import math
from dataclasses import replace

import esper
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from weather_ecs import CloudFile, Weather, presets
from weather_ecs.components import Climate, RainArea, Sky, SkyLayer, Sun, Wind
from weather_ecs.editor import whole, world_land
from weather_ecs.editor.inside import gust_speeds, in_world, law_speeds
from weather_ecs.editor.map_frame import MapFrame, along, covers, dragged
from weather_ecs.editor.panels.metar import EXAMPLE, MetarPanel
from weather_ecs.editor.panels.sky import added, free_state, name_of, removed
from weather_ecs.editor.panels.transport import clock, state_after
from weather_ecs.editor.panels.weather import with_radius
from weather_ecs.editor.panels.wind import bearing_of, curves, direction_of
from weather_ecs.editor.world_camera import EYE, WorldCamera
from weather_ecs.errors import InvalidValueError
from weather_ecs.file_content import check_content
from weather_ecs.physics import ellipse, wind
from weather_ecs.weathers import heading_of

AREA = RainArea((300.0, -200.0), (120.0, 50.0), 8.0, heading=0.7)


# The map


def a_frame() -> MapFrame:
    frame = MapFrame(100.0, -50.0, 4.0)
    frame.place(20.0, 40.0, 600.0, 400.0)
    return frame


def test_a_pixel_and_its_place_are_the_same_point() -> None:
    frame = a_frame()
    assert frame.pixel(100.0, -50.0) == (320.0, 240.0)  # the middle
    assert frame.pixel(104.0, -54.0) == (321.0, 239.0)  # east is right, north up
    for point in ((0.0, 0.0), (-900.0, 77.0)):
        assert frame.world(*frame.pixel(*point)) == pytest.approx(point)
    frame.pan(10.0, -5.0)
    assert (frame.x, frame.z) == (60.0, -30.0)


def test_zoom_leaves_what_is_under_the_mouse() -> None:
    frame = a_frame()
    before = frame.world(100.0, 90.0)
    frame.zoom(3.0, 100.0, 90.0)
    assert frame.scale < 4.0 and frame.world(100.0, 90.0) == pytest.approx(before)
    frame.zoom(-1e4, 0.0, 0.0)
    frame.zoom(1e4, 0.0, 0.0)
    assert math.isfinite(frame.x) and frame.scale > 0.0


def test_everything_that_is_to_be_shown_is_in_the_picture() -> None:
    frame = a_frame()
    frame.show((-5000.0, -200.0), (1000.0, 800.0))
    for corner in ((-5000.0, -200.0), (1000.0, 800.0)):
        x, y = frame.pixel(*corner)
        assert 20.0 < x < 620.0 and 40.0 < y < 440.0
    assert 50.0 < frame.spacing() / frame.scale < 250.0
    assert f"{frame.spacing():.0e}"[0] in "125"


def test_the_rim_on_the_map_is_the_ellipse_of_the_rain() -> None:
    for angle in (0.0, 0.4, 2.0, 5.0):
        x, z = along(AREA, angle)
        local = ellipse.local((x, z), AREA.center, AREA.heading) / np.array(AREA.radii)
        assert float((local**2).sum()) == pytest.approx(1.0)
        inside = (0.99 * (x - 300.0) + 300.0, 0.99 * (z + 200.0) - 200.0)
        assert covers(AREA, *inside) and not covers(AREA, 2 * x - 300.0, 2 * z + 200.0)


def test_the_mouse_takes_handles_first_then_the_smallest_area() -> None:
    frame = a_frame()
    small = RainArea((300.0, -200.0), (20.0, 20.0))
    areas = (AREA, small)
    handles = {each.part: each for each in frame.handles(0, AREA)}
    for part, handle in handles.items():
        taken = frame.grasp(areas, 0, *handle.at)
        assert taken is not None and (taken.area, taken.part) == (0, part)
    taken = frame.grasp(areas, -1, *frame.pixel(300.0, -200.0))
    assert taken is not None and taken.area == 1
    assert frame.grasp(areas, -1, 21.0, 41.0) is None
    assert frame.grasp((), 0, 21.0, 41.0) is None


def test_dragging_a_handle_brings_it_under_the_mouse() -> None:
    moved = dragged(AREA, "middle", (10.0, 20.0), grip=(4.0, -6.0))
    assert moved.center == (6.0, 26.0) and moved.radii == AREA.radii
    turned = dragged(AREA, "turn", (300.0, -900.0))  # to the north
    assert turned.heading == pytest.approx(math.pi / 2)
    assert along(turned, 0.0) == pytest.approx((300.0, -320.0))
    to = along(replace(AREA, radii=(200.0, 50.0)), 0.0)
    assert dragged(AREA, "long", to).radii == pytest.approx((200.0, 50.0))


@given(
    st.sampled_from(["long", "short", "middle", "turn"]),
    st.tuples(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6)),
)
@settings(max_examples=60, deadline=None)
def test_no_drag_makes_an_area_that_is_none(part: str, to: tuple[float, float]) -> None:
    area = dragged(AREA, part, to)
    assert area.radii[0] >= area.radii[1] > 0.0


def test_of_two_radii_the_other_one_gives_way() -> None:
    assert with_radius(AREA, "long", 30.0) == (30.0, 30.0)
    assert with_radius(AREA, "short", 500.0) == (500.0, 500.0)
    assert with_radius(AREA, "short", 40.0) == (120.0, 40.0)


# The eye


def test_the_eye_walks_where_it_looks_and_stays_on_the_land() -> None:
    camera = WorldCamera(0.0, 0.0, ground=lambda x, z: 0.1 * x)
    camera.move(1.0, 0.0, 0.0, 2.0)  # north
    assert (camera.x, camera.z) == pytest.approx((0.0, -8.0))
    camera.yaw = -math.pi / 2  # east
    assert camera.bearing == pytest.approx(90.0)
    camera.move(1.0, 0.0, 0.0, 2.0)
    assert (camera.x, camera.z) == pytest.approx((8.0, -8.0))
    assert camera.eye()[1] == pytest.approx(0.8 + EYE)
    ahead = camera.view() @ np.array([*(camera.eye() + 5.0 * camera.forward()), 1.0])
    assert ahead[:3] == pytest.approx((0.0, 0.0, -5.0))


def test_going_up_is_flying_and_landing_ends_it() -> None:
    camera = WorldCamera()
    camera.move(0.0, 0.0, 1.0, 1.0)
    assert camera.flying and camera.height > 50.0
    camera.move(0.0, 0.0, -1.0, 1e9)
    assert camera.height == 1.0  # not into the ground
    camera.land()
    assert (camera.flying, camera.height) == (False, EYE)
    camera.look(0.0, 1e9)
    assert abs(camera.pitch) < math.pi / 2


def test_the_land_is_level_at_the_village_and_one_piece() -> None:
    assert world_land.height(30.0, -100.0) == 0.0
    mesh = world_land.ground(40.0, 10.0)
    places = mesh.vertices["place"].reshape(-1, 3)
    assert mesh.indices.max() < len(places) and np.isfinite(places).all()
    near = places[: 20 * world_land.SECTORS]
    assert abs(near[:, 1]).max() < 1.0
    patch = world_land.patch_of(mesh)
    reach = np.hypot(*(patch.vertices["place"][:, [0, 2]] - (40.0, 10.0)).T)
    assert world_land.PATCH <= reach.max() < 2.0 * world_land.PATCH
    a, b, c = places[mesh.indices[:3]]
    assert np.cross(b - a, c - a)[1] >= 0.0 or np.allclose(a, c)  # faces the sky
    things = world_land.things().vertices
    assert np.linalg.norm(things["normal"], axis=1) == pytest.approx(1.0, abs=1e-4)


# Ready weathers


def test_every_whole_weather_becomes_a_document_that_can_be_saved() -> None:
    for name, weather in presets.WEATHERS.items():
        content = whole.with_whole(CloudFile(), name)
        check_content(content)
        assert content.climate is not None and content.climate.initial == weather.state, name
        assert len(content.layers) == len(weather.banks)
        rates = [area.rain_rate for area in content.rain_areas]
        assert rates == ([weather.rain_rate] if weather.rain_rate else [])
        assert content.air is not None and content.air.temperature == weather.temperature
        assert content.atmosphere is not None
        assert content.atmosphere.overcast == pytest.approx(0.85 * weather.overcast**3, abs=1e-3)


def test_a_whole_weather_rains_as_much_as_it_says() -> None:
    """Clouds of a file bring rain of their own; those of a whole weather do not."""
    content = whole.with_whole(CloudFile(), "thunderstorm")
    with in_world("a storm's"), Weather(seed=3) as weather:
        weather.add(content)
        for _ in range(8):
            esper.process(1.0)
        sample = weather.sample((0.0, 1.7, 0.0))
        areas = len(esper.get_component(RainArea))
    esper.delete_world("a storm's")
    assert areas == 1 and sample.rain_rate == pytest.approx(40.0)


def test_what_a_whole_weather_says_nothing_of_stays() -> None:
    mine = CloudFile(models=(presets.cloud_model("cumulus"),), quality="low", extra={"a": 1})
    content = whole.with_whole(mine, "fair_cumulus", (500.0, 40.0))
    assert content.models == mine.models and content.quality == "low" and content.extra == {"a": 1}
    assert all(layer.center == (500.0, 40.0) for layer in content.layers)
    with pytest.raises(InvalidValueError):
        whole.with_whole(mine, "nice")
    assert not [name for name in esper.list_worlds() if "whole" in name]


def test_presets_of_rain_and_of_skies() -> None:
    content = whole.with_preset(CloudFile(), "heavy")
    assert content.rain_areas[0].rain_rate == 25.0 and content.winds[0].speed == 4.0
    two = replace(content, rain_areas=(AREA, AREA))
    dry = whole.with_preset(two, "clear", area=1)
    assert [area.rain_rate for area in dry.rain_areas] == [8.0, 0.0]
    assert dry.rain_areas[0] is AREA
    assert whole.with_preset(CloudFile(), "clear").rain_areas == ()
    sky = whole.with_sky(CloudFile(rain_areas=(AREA,)), "fair", "storm", 90.0)
    assert sky.climate is not None and (sky.climate.final, sky.climate.duration) == (1.0, 90.0)
    assert len(sky.layers) == 4 and sky.rain_areas == (AREA,)
    foggy = whole.with_whole(CloudFile(), "fog")
    cleared = whole.with_sky(foggy, "clear", None, 90.0).atmosphere
    assert cleared is not None and cleared.overcast is None  # by the climate again
    assert whole.with_whole(CloudFile(sun=Sun()), "fog").atmosphere is None


def test_the_metar_box_says_what_it_understood_and_why_not() -> None:
    panel = MetarPanel(None)  # type: ignore[arg-type]
    panel.understand(EXAMPLE)
    assert panel.report is not None and panel.error == ""
    assert panel.report.get("temperature") == 17.0
    content = whole.with_whole(CloudFile(), panel.report.weather)
    check_content(content)
    assert content.winds[0].speed == pytest.approx(22 * 0.514444)
    assert bearing_of(content.winds[0].direction) == pytest.approx(210.0)
    panel.understand("EHAM 990825Z 21022KT")
    assert panel.report is None and "no such time" in panel.error
    panel.understand("x" * 5000)
    assert "2000" in panel.error
    panel.understand("   ")
    assert panel.report is None and panel.error == ""


# Skies, time, wind


def test_a_first_model_brings_clouds_and_the_last_takes_them_away() -> None:
    sky = Sky(0.5)
    one = replace(sky, **added(sky, "cumulus"))
    assert one.models == ("cumulus",) and one.count == 20
    weighed = replace(one, weights=(3.0,))
    two = replace(weighed, **added(weighed, "stratus"))
    assert two.weights == (3.0, 1.0) and two.count == 20
    back = replace(two, **removed(two, 1))
    assert back.weights == (3.0,)
    assert replace(back, **removed(back, 0)).count == 0


def test_a_new_sky_has_a_state_of_its_own() -> None:
    states: list[float] = []
    for _ in range(12):
        states.append(free_state(states))
    assert len(set(states)) == 12 and states[:3] == [0.0, 1.0, 0.5]
    SkyLayer(skies=tuple(Sky(state) for state in states))
    assert name_of(0.3) == "fair" and name_of(1.0) == "storm"


def test_the_strip_shows_the_state_that_the_weather_will_have() -> None:
    climate = Climate(0.2, 0.8, 30.0, elapsed=6.0, speed=2.0)
    with in_world("a climate's"), Weather() as weather:
        esper.create_entity(replace(climate))
        for second in range(16):
            assert state_after(climate, second) == pytest.approx(weather.stats.state), second
            esper.process(1.0)
    esper.delete_world("a climate's")
    assert state_after(replace(climate, running=False), 99.0) == pytest.approx(0.32)
    assert (
        clock(75.5) == "01:15.50" and clock(3661.0) == "1:01:01.00" and clock(59.999) == "01:00.00"
    )


def test_where_a_wind_comes_from() -> None:
    for bearing in (0.0, 90.0, 210.0, 359.0):
        x, z = direction_of(bearing)
        heading = heading_of(bearing)
        assert (x, z) == pytest.approx((math.cos(heading), math.sin(heading)))
        assert bearing_of((x, z)) == pytest.approx(bearing)


@pytest.mark.parametrize("law", ["gust", "steady"])
def test_the_plot_is_the_law_of_the_wind(law: str) -> None:
    blowing = Wind(speed=7.0, law=law, start=10.0, times=(4.0, 20.0, 30.0))
    times, speeds, gusts = curves(blowing)
    if law == "gust":
        wanted = wind.gust(times - 10.0, 4.0, 30.0, d=0.3)
    else:
        wanted = wind.steady(times - 10.0, 4.0, 20.0, 30.0)
    assert speeds == pytest.approx(7.0 * wanted)
    assert gusts == pytest.approx(speeds)  # no gusts by chance
    assert times[-1] >= 40.0
    rough = replace(blowing, gustiness=0.8)
    assert np.ptp(gust_speeds(rough, times) - law_speeds(rough, times)) > 0.5
    again = replace(blowing, period=50.0)
    assert curves(again)[1][-1] == pytest.approx(
        law_speeds(again, np.array([curves(again)[0][-1]]))[0]
    )
