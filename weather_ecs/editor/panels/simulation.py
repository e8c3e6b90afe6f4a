"""The simulation: its layers, their heights, worlds and winds, and the climate over all of them."""

from __future__ import annotations

from dataclasses import replace

from imgui_bundle import imgui

from weather_ecs.components import Climate, Sky, SkyLayer
from weather_ecs.editor import items, theme
from weather_ecs.editor.bands import REGIONS, describe
from weather_ecs.editor.bound import Bound, caption, row, rows
from weather_ecs.editor.content import layer_climate, with_item, with_layer_climate, with_new
from weather_ecs.editor.content import without as without_item
from weather_ecs.editor.document import Content, Document
from weather_ecs.editor.map_view import LAYERS
from weather_ecs.editor.shared import Shared
from weather_ecs.editor.studio import Studio, studio_of
from weather_ecs.editor.view_bar import tip_of_last


class SimulationPanel:
    """Layers and climate."""

    title = "Simulation"

    def __init__(self, shared: Shared) -> None:
        self._shared = shared

    def draw(self, document: Document, shared: Shared) -> None:
        """The list of layers, the chosen layer, the climate."""
        studio = studio_of(shared)
        self._draw_list(document, shared, studio)
        if document.content.layers:
            self._draw_layer(document, shared, studio)
        imgui.separator_text("Climate")
        _draw_climate(document)
        _draw_seed(studio)

    def _draw_list(self, document: Document, shared: Shared, studio: Studio) -> None:
        layers = document.content.layers
        chosen = shared.selection.layer
        with items.well("layers", len(layers)):
            for k, layer in enumerate(layers):
                imgui.push_style_color(imgui.Col_.text, theme.vec4(LAYERS[k % len(LAYERS)]))
                label = f"{layer.base:,.0f} m".replace(",", " ")
                if imgui.selectable(f"{label}##layer{k}", k == chosen)[0]:
                    shared.selection.layer, shared.selection.sky = k, 0
                    shared.focus = "layer"
                imgui.pop_style_color()
                imgui.same_line(imgui.get_window_width() * 0.34)
                count = len(layer.skies)
                skies = f"{count} {'sky' if count == 1 else 'skies'}"
                imgui.text_disabled(f"{describe(layer.base, studio.region)}, {skies}")
            if not layers:
                imgui.text_disabled("No layers: no clouds that drift.")
        pressed = items.edit_buttons("layer", bool(layers))
        if pressed == "New":
            layer = SkyLayer(1000.0, skies=(Sky(0.0),))
            if document.apply("New layer", with_new(document.content, "layers", layer)):
                shared.selection.layer, shared.selection.sky = len(layers), 0
                shared.focus = "layer"
        elif pressed == "Copy":
            copy = with_new(document.content, "layers", replace(layers[chosen]), chosen + 1)
            if document.apply("Copy layer", copy):
                shared.selection.layer = chosen + 1
        elif pressed == "Delete":
            document.apply("Delete layer", without_item(document.content, "layers", chosen))

    def _draw_layer(self, document: Document, shared: Shared, studio: Studio) -> None:
        index = shared.selection.layer
        if index >= len(document.content.layers):
            return

        def put(layer: SkyLayer) -> Content:
            return with_item(document.content, "layers", index, layer)

        layer = document.content.layers[index]
        bound = Bound(document, layer, put, ("layer", index), "Layer")
        imgui.separator_text("Layer")
        row(bound, "base")
        caption("", "")
        imgui.set_next_item_width(86.0)
        changed, k = imgui.combo("##region", REGIONS.index(studio.region), list(REGIONS))
        studio.region = REGIONS[k] if changed else studio.region
        tip_of_last("The region whose bands of heights count; see the Heights tab")
        imgui.same_line(0.0, 6.0)
        imgui.text_disabled(describe(layer.base, studio.region))
        rows(bound, "variation", "size", "center", "velocity", "drift", "shear", "turnover")
        _draw_own_climate(document, index)


def _draw_climate(document: Document) -> None:
    climate = document.content.climate

    def put(climate: Climate | None) -> Content:
        return replace(document.content, climate=climate)

    if climate is None:
        imgui.text_disabled("None: the state stands at 0.")
        if imgui.button("New climate"):
            document.apply("New climate", put(Climate()))
        return
    bound = Bound(document, climate, put, ("climate",), "Climate")
    rows(bound, "initial", "final", "duration", "elapsed", "speed", "running")
    imgui.same_line(0.0, 10.0)
    if imgui.button("Remove climate"):
        document.apply("Remove climate", put(None))


def _draw_own_climate(document: Document, index: int) -> None:
    own = layer_climate(document.content, index)
    changed, there = imgui.checkbox("A climate of its own", own is not None)
    tip_of_last("Without one the layer follows the climate below")
    if changed:
        start = document.content.climate
        made = (replace(start) if start else Climate()) if there else None
        label = "Layer's own climate" if there else "Remove layer's own climate"
        document.apply(label, with_layer_climate(document.content, index, made))
    elif own is not None:

        def put(climate: Climate) -> Content:
            return with_layer_climate(document.content, index, climate)

        bound = Bound(document, own, put, ("layer climate", index), "Layer's climate")
        rows(bound, "initial", "final", "duration", "running")


def _draw_seed(studio: Studio) -> None:
    simulation = studio.simulation
    caption("Random seed", "Of all chance: where clouds stand, when gusts come. Not in the file.")
    imgui.set_next_item_width(-58.0)
    changed, seed = imgui.input_int("##seed", simulation.seed, 0)
    imgui.same_line(0.0, 4.0)
    if imgui.button("Other", imgui.ImVec2(-1.0, 0.0)):
        changed, seed = True, simulation.seed + 1
    if changed:
        simulation.reseed(min(max(seed, 0), 2**31 - 1))
