"""The skies of a layer: a state, its models and how many clouds of them."""

from __future__ import annotations

from dataclasses import replace

from imgui_bundle import imgui

from weather_ecs import presets
from weather_ecs.components import CloudModel, Sky, SkyLayer
from weather_ecs.editor import items, theme
from weather_ecs.editor.bound import Bound, row, take
from weather_ecs.editor.content import swapped, with_item
from weather_ecs.editor.document import Content, Document
from weather_ecs.editor.shared import Shared
from weather_ecs.editor.studio import studio_of
from weather_ecs.editor.view_bar import tip_of_last
from weather_ecs.tools import sky_shares


class SkyPanel:
    """The chosen layer's skies."""

    title = "Sky"

    def __init__(self, shared: Shared) -> None:
        self._shared = shared

    def draw(self, document: Document, shared: Shared) -> None:
        """The list of skies, and the chosen sky."""
        layers = document.content.layers
        if shared.selection.layer >= len(layers):
            imgui.text_wrapped("Skies belong to a layer. New, in the Simulation panel, makes one.")
            return
        layer = layers[shared.selection.layer]
        self._draw_list(document, shared, layer)
        if shared.selection.sky < len(layer.skies):
            self._draw_sky(document, shared, layer)

    def _draw_list(self, document: Document, shared: Shared, layer: SkyLayer) -> None:
        chosen = shared.selection.sky
        state = studio_of(shared).simulation.weather.stats.state
        states = [sky.state for sky in layer.skies]
        parts = sky_shares(states, state).tolist() if states else []
        with items.well("skies", len(layer.skies)):
            for k, sky in sorted(enumerate(layer.skies), key=lambda each: each[1].state):
                label = f"{sky.state:.2f} {name_of(sky.state)}##sky{k}"
                if imgui.selectable(label, k == chosen)[0]:
                    shared.selection.sky = chosen = k
                    shared.focus = "sky"
                imgui.same_line(imgui.get_window_width() * 0.44)
                imgui.text_disabled(f"{sky.count} clouds")
                if parts[k] > 0.0:
                    text = f"{100.0 * parts[k]:.0f} %"
                    imgui.same_line(imgui.get_window_width() - imgui.calc_text_size(text).x - 14.0)
                    imgui.text_colored(theme.vec4(theme.GOOD), text)
                    tip_of_last("Its share of the clouds that come in now")
        pressed = items.edit_buttons("sky", bool(layer.skies))
        if pressed in ("New", "Copy"):
            free = free_state([sky.state for sky in layer.skies])
            source = layer.skies[chosen] if pressed == "Copy" else Sky(0.0)
            skies = (*layer.skies, replace(source, state=free))
            if self._put(document, shared, f"{pressed} sky", layer, skies):
                shared.selection.sky = len(layer.skies)
        elif pressed == "Delete":
            skies = layer.skies[:chosen] + layer.skies[chosen + 1 :]
            self._put(document, shared, "Delete sky", layer, skies)

    def _put(
        self,
        document: Document,
        shared: Shared,
        label: str,
        layer: SkyLayer,
        skies: tuple[Sky, ...],
    ) -> bool:
        index = shared.selection.layer
        return document.try_apply(
            label,
            lambda: with_item(document.content, "layers", index, replace(layer, skies=skies)),
        )

    def _draw_sky(self, document: Document, shared: Shared, layer: SkyLayer) -> None:
        at, index = shared.selection.layer, min(shared.selection.sky, len(layer.skies) - 1)

        def put(sky: Sky) -> Content:
            owner = document.content.layers[at]
            changed = replace(owner, skies=swapped(owner.skies, index, sky))
            return with_item(document.content, "layers", at, changed)

        sky = layer.skies[index]
        bound = Bound(document, sky, put, ("sky", at, index), "Sky")
        imgui.separator_text("Chosen sky")
        row(bound, "state")
        row(bound, "count")
        row(bound, "generated")
        _draw_models(bound, sky, document)


def _draw_models(bound: Bound, sky: Sky, document: Document) -> None:
    """A line of each model with its weight and share, and a list to add from."""
    imgui.separator_text("Models")
    weights = sky.weights or (1.0,) * len(sky.models)
    whole = sum(weights)
    for k, model in enumerate(sky.models):
        name = model.name if isinstance(model, CloudModel) else model
        imgui.push_id(f"model {k}")
        if imgui.button("x"):
            bound.set("models", "remove model", **removed(sky, k))
            bound.document.end_gesture()
        tip_of_last("Take the model out of this sky")
        imgui.same_line(0.0, 6.0)
        imgui.align_text_to_frame_padding()
        imgui.text(name if len(name) < 20 else name[:18] + "…")
        imgui.same_line(imgui.get_window_width() * 0.56)
        imgui.set_next_item_width(-46.0)
        changed, now = imgui.slider_float("##weight", weights[k], 0.0, 10.0, "%.1f")
        weighed = swapped(weights, k, round(now, 3))
        take(bound, "weights", f"weight of {name}", changed and any(weighed), weighed)
        tip_of_last("Weight when a cloud is drawn, 0 or more; with its share behind it")
        imgui.same_line(0.0, 6.0)
        imgui.text_disabled(f"{100.0 * weights[k] / whole:.0f} %")
        imgui.pop_id()
    problem = bound.document.problem_at((*bound.key, "models"))
    if problem:
        imgui.push_style_color(imgui.Col_.text, theme.vec4(theme.BAD))
        imgui.text_wrapped(problem)
        imgui.pop_style_color()
    used = {model.name if isinstance(model, CloudModel) else model for model in sky.models}
    own = [model.name for model in document.content.models]
    free = [name for name in (*own, *presets.CLOUD_MODELS) if name not in used]
    imgui.set_next_item_width(-1.0)
    if imgui.begin_combo("##add", "Add a model", imgui.ComboFlags_.height_large):
        for name in dict.fromkeys(free):
            if imgui.selectable(name, False)[0]:
                bound.set("models", "add model", **added(sky, name))
                bound.document.end_gesture()
        imgui.end_combo()
    tip_of_last("Models of this file first, then those of the package")


def added(sky: Sky, name: str) -> dict[str, object]:
    """The fields of a sky that has one more model; a first one brings some clouds with it."""
    weights = (*sky.weights, 1.0) if sky.weights else ()
    return {
        "models": (*sky.models, name),
        "weights": weights,
        "count": sky.count if sky.models else max(sky.count, 20),
    }


def removed(sky: Sky, index: int) -> dict[str, object]:
    """The fields of a sky without one of its models."""
    models = sky.models[:index] + sky.models[index + 1 :]
    weights = sky.weights[:index] + sky.weights[index + 1 :]
    return {
        "models": models,
        "weights": weights if any(weights) else (),
        "count": sky.count if models else 0,
    }


def free_state(states: list[float]) -> float:
    """A state that no sky has: in the middle of the widest gap, or an end that is free."""
    for end in (0.0, 1.0):
        if end not in states:
            return end
    ordered = sorted(states)
    gap, low = max((b - a, a) for a, b in zip(ordered, ordered[1:], strict=False))
    return round(low + 0.5 * gap, 6)


def name_of(state: float) -> str:
    """The nearest of the states that have names."""
    return min(presets.SKIES, key=lambda name: abs(presets.SKIES[name] - state))
