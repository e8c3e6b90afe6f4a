"""The weather apart from clouds: presets, rain areas, air, fog, sun and time, quality."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

from imgui_bundle import imgui

from weather_ecs import presets
from weather_ecs.components import Air, Atmosphere, Fog, Lightning, RainArea
from weather_ecs.editor import items, theme, whole
from weather_ecs.editor.bound import Bound, caption, line, row, rows, take, tidy
from weather_ecs.editor.content import with_item, with_new
from weather_ecs.editor.content import without as without_item
from weather_ecs.editor.document import Content, Document
from weather_ecs.editor.fields import info
from weather_ecs.editor.map_frame import dragged
from weather_ecs.editor.rows import section as heading
from weather_ecs.editor.shared import Shared
from weather_ecs.editor.studio import QUALITY, studio_of
from weather_ecs.editor.view_bar import tip_of_last
from weather_ecs.quality import QUALITIES

DAY = 86_400.0  # s
_NONE = "(default)"


class WeatherPanel:
    """Everything that a document has besides clouds and wind."""

    title = "Weather"

    def __init__(self, shared: Shared) -> None:
        self._to = 0  # of the skies: where a climate goes to; 0: it stands
        self._sky = 0
        self._duration = 600.0

    def draw(self, document: Document, shared: Shared) -> None:
        """One section under another."""
        if section("Presets", True):
            self._draw_presets(document, shared)
        if section("Rain areas", True):
            _draw_areas(document, shared)
        if section("Air", True):
            single(document, "air", "Air", Air, "temperature", "humidity")
        if section("Fog", False):
            single(document, "fog", "Fog", Fog, "visibility", "depth", "color")
        if section("Sun and time", True):
            _draw_sky(document)
        if section("Lightning", False):
            names = ("rate", "most", "ground_share", "brightness", "audible")
            single(document, "lightning", "Lightning", Lightning, *names)
        if section("Quality", False):
            _draw_quality(document, shared)

    def _draw_presets(self, document: Document, shared: Shared) -> None:
        caption("Whole weather", "Clouds, rain, wind, air, fog and lightning that go together")
        picked = choose("##whole", presets.WEATHERS, {k: w.description for k, w in _WHOLE})
        if picked:
            put_whole(document, shared, picked)
        caption("Rain", "Into the chosen rain area, with the wind, air and fog that go with it")
        picked = choose("##rain", presets.PRESETS, {k: p.description for k, p in _PLAIN})
        if picked:
            area = shared.selection.area
            document.try_apply(
                f"Preset {picked}", lambda: whole.with_preset(document.content, picked, area)
            )
        caption("Sky", "Four layers of clouds, and a climate from one sky to another")
        names = list(presets.SKIES)
        imgui.set_next_item_width(0.30 * imgui.get_window_width() - 10.0)
        self._sky = imgui.combo("##sky", self._sky, names)[1]
        imgui.same_line(0.0, 4.0)
        imgui.set_next_item_width(-1.0)
        self._to = imgui.combo("##to", self._to, ["stands", *[f"to {n}" for n in names]])[1]
        caption("", "")
        imgui.set_next_item_width(0.30 * imgui.get_window_width() - 10.0)
        changed, seconds = imgui.drag_float("##s", self._duration, 5.0, 1.0, 1e6, "%.0f s")
        self._duration = min(max(seconds, 1.0), 1e6) if changed else self._duration
        tip_of_last("Seconds from the one sky to the other")
        imgui.same_line(0.0, 4.0)
        if imgui.button("Use it", imgui.ImVec2(-1.0, 0.0)):
            to = names[self._to - 1] if self._to else None
            name, duration = names[self._sky], self._duration
            if document.try_apply(
                f"Sky {name}", lambda: whole.with_sky(document.content, name, to, duration)
            ):
                studio_of(shared).map_wanted = True
                shared.selection.layer = shared.selection.sky = 0


_WHOLE = presets.WEATHERS.items()
_PLAIN = presets.PRESETS.items()


def section(title: str, opened: bool) -> bool:
    """A part of the panel that can be folded."""
    return heading(title, opened=opened)


def choose(label: str, names: Any, tips: dict[str, str]) -> str:
    """A list to pick from; the name that was picked now, or nothing."""
    picked = ""
    if imgui.begin_combo(label, "choose", imgui.ComboFlags_.height_large):
        for name in names:
            if imgui.selectable(name.replace("_", " "), False)[0]:
                picked = name
            tip_of_last(tips[name])
        imgui.end_combo()
    return picked


def put_whole(document: Document, shared: Shared, weather: Any) -> bool:
    """Make a whole weather the document's; whether it was taken."""
    camera = studio_of(shared).camera
    center = (camera.x, camera.z)
    name = weather if isinstance(weather, str) else weather.name
    taken = document.try_apply(
        f"Weather {name}", lambda: whole.with_whole(document.content, weather, center)
    )
    if taken:
        studio_of(shared).map_wanted = True
        shared.selection.layer = shared.selection.sky = shared.selection.area = 0
    return taken


def single(
    document: Document, field: str, title: str, kind: Callable[[], Any], *names: str
) -> None:
    """A component of which a document has one or none."""
    part = getattr(document.content, field)

    def put(part: Any) -> Content:
        return replace(document.content, **{field: part})

    if part is None:
        imgui.align_text_to_frame_padding()
        imgui.text_disabled("As the package has it.")
        imgui.same_line()
        if imgui.button(f"Set##{field}"):
            document.apply(f"Set {title.lower()}", put(kind()))
        return
    rows(Bound(document, part, put, (field,), title), *names)
    if imgui.button(f"Remove##{field}"):
        document.apply(f"Remove {title.lower()}", put(None))


def _draw_areas(document: Document, shared: Shared) -> None:
    areas, chosen = document.content.rain_areas, shared.selection.area
    with items.well("areas", len(areas)):
        for k, area in enumerate(areas):
            a, b = area.radii
            text = f"{area.rain_rate:g} mm/h"
            if imgui.selectable(f"{text}##area{k}", k == chosen)[0]:
                shared.selection.area, shared.focus = k, "area"
            imgui.same_line(imgui.get_window_width() * 0.36)
            imgui.text_disabled(f"{a:,.0f} x {b:,.0f} m".replace(",", " "))
    pressed = items.edit_buttons("area", bool(areas))
    if pressed == "New":
        camera = studio_of(shared).camera
        area = RainArea((round(camera.x), round(camera.z - 150.0)), (120.0, 80.0), 10.0)
        if document.apply("New rain area", with_new(document.content, "rain_areas", area)):
            shared.selection.area, shared.focus = len(areas), "area"
    elif pressed == "Copy":
        x, z = areas[chosen].center
        copy = replace(areas[chosen], center=(x + 2.0 * areas[chosen].radii[0], z))
        content = with_new(document.content, "rain_areas", copy, chosen + 1)
        if document.apply("Copy rain area", content):
            shared.selection.area = chosen + 1
    elif pressed == "Delete":
        document.apply("Delete rain area", without_item(document.content, "rain_areas", chosen))
    areas, chosen = document.content.rain_areas, shared.selection.area
    if chosen < len(areas):
        _draw_area(document, chosen)


def _draw_area(document: Document, index: int) -> None:
    def put(area: RainArea) -> Content:
        return with_item(document.content, "rain_areas", index, area)

    area = document.content.rain_areas[index]
    bound = Bound(document, area, put, ("area", index), "Rain area")
    row(bound, "rain_rate")
    row(bound, "center")
    known = info(RainArea, "radii")
    for k, (part, label) in enumerate((("long", "Radius along"), ("short", "Radius across"))):
        with line(bound, part, label, known):
            low, high = known.soft
            flags = imgui.SliderFlags_.logarithmic
            value = area.radii[k]
            changed, now = imgui.slider_float("##value", value, low, high, "%.0f m", flags)
            radii = with_radius(area, part, tidy(now))
            if changed:
                bound.set(part, label, radii=radii)
            if imgui.is_item_deactivated():
                document.end_gesture()
    rows(bound, "heading", "soft_edge", "ceiling", "velocity", "drift", "onset")


def with_radius(area: RainArea, part: str, value: float) -> tuple[float, float]:
    """Radii of an area one of whose radii is another; the other one gives way."""
    level = replace(area, center=(0.0, 0.0), heading=0.0)
    to = (value, 0.0) if part == "long" else (0.0, value)
    return dragged(level, part, to).radii


def _draw_sky(document: Document) -> None:
    sky = document.content.atmosphere

    def put(sky: Atmosphere | None) -> Content:
        return replace(document.content, atmosphere=sky)

    if sky is None:
        text = "The light of a sun." if document.content.sun else "A day in June, at noon."
        imgui.align_text_to_frame_padding()
        imgui.text_disabled(text)
        imgui.same_line()
        if imgui.button("Set##sky"):
            document.apply("Set sun and time", put(Atmosphere()))
        return
    bound = Bound(document, sky, put, ("atmosphere",), "Sky")
    seconds = float(sky.time)
    known = info(Atmosphere, "time")
    day, hour = divmod(seconds, DAY)
    with line(bound, "time", "Time of day", known):
        text = datetime.fromtimestamp(seconds, UTC).strftime("%H:%M UTC")
        changed, now = imgui.slider_float("##value", hour / 3600.0, 0.0, 23.999, text)
        take(bound, "time", "Time of day", changed, day * DAY + round(now * 60.0) * 60.0)
    with line(bound, "day", "Day", known):
        date = datetime.fromtimestamp(seconds, UTC)
        first = datetime(date.year, 1, 1, tzinfo=UTC).timestamp()
        number = int((seconds - first) // DAY)
        text = date.strftime("%d %b %Y")
        changed, now = imgui.slider_int("##value", number, 0, 364, text)
        take(bound, "time", "Day", changed, first + now * DAY + hour)
    rows(bound, "latitude", "longitude", "speed", "turbidity", "overcast", "exposure")
    rows(bound, "stars", "rainbow", "halo")
    if imgui.button("Remove##sky"):
        document.apply("Remove sun and time", put(None))


def _draw_quality(document: Document, shared: Shared) -> None:
    caption("Quality", "What drawing may cost; a word to whoever shows the file")
    names = [_NONE, *QUALITIES]
    value = document.content.quality or _NONE
    changed, index = imgui.combo("##quality", names.index(value), names)
    if changed:
        quality = None if index == 0 else names[index]
        document.apply("Quality", replace(document.content, quality=quality))
    stats = studio_of(shared).simulation.weather.stats
    text = f"{stats.drops_drawn:,} drops, {stats.clouds_drawn} clouds drawn".replace(",", " ")
    imgui.text_colored(theme.vec4(theme.DIM), text)
    if document.content.quality is None:
        imgui.text_disabled(f"The views here use {QUALITY}.")
