"""The cloud panel: models, and what the billboards of one are like."""

from __future__ import annotations

import random
from dataclasses import replace

from imgui_bundle import imgui

from weather_ecs import presets
from weather_ecs.components import CloudModel, CloudSeed
from weather_ecs.editor import items, rows
from weather_ecs.editor.content import (
    free_name,
    rename_model,
    users,
    with_item,
    with_new,
    without,
)
from weather_ecs.editor.document import Document
from weather_ecs.editor.image_picker import ImagePicker
from weather_ecs.editor.rows import Thing
from weather_ecs.editor.shared import Shared
from weather_ecs.editor.view_bar import tip_of_last

MOST_NUMBER = 2**31 - 1


class CloudPanel:
    """Models to choose from, generate again, billboards, light, textures, weather."""

    title = "Cloud"

    def __init__(self, shared: Shared) -> None:
        self._pictures = ImagePicker(shared.gl)

    def draw(self, document: Document, shared: Shared) -> None:
        """The whole panel."""
        imgui.separator_text("Models")
        if items.clicked_into():
            shared.focus = "model"
        self._choose(document, shared)
        models = document.content.models
        if not models:
            imgui.text_wrapped("New makes a model: a seed to begin with, or one of the package's.")
            return
        index = min(shared.selection.model, len(models) - 1)
        model = models[index]
        thing = Thing(
            document,
            model,
            ("model", index),
            lambda changed: with_item(document.content, "models", index, changed),
        )
        self._name(document, index, model)
        generate(shared)
        if rows.section("Billboards"):
            rows.drag_pair(thing, "Per seed", "billboards_min", "billboards_max", whole=True)
            rows.drag_pair(thing, "Size", "size_min", "size_max")
            rows.slide(thing, "Aspect", "aspect")
            rows.slide(thing, "Turn", "turn")
            rows.slide(thing, "Roundness", "roundness")
            rows.slide(thing, "Flat base", "flatness")
            rows.slide(thing, "Opacity", "opacity")
        if rows.section("Light"):
            rows.drag_open(thing, "Penetration", "light_penetration", 400.0)
            rows.slide(thing, "Dark base", "darkness")
            rows.slide(thing, "Halo", "halo")
        if rows.section("Textures"):
            self._pictures.draw(thing)
        if rows.section("In the world"):
            rows.drag_range(thing, "Base heights", "base")
            rows.drag(thing, "Rain rate", "rain_rate", speed=0.1)
            rows.drag(thing, "Lightning", "lightning", speed=0.05)

    def close(self) -> None:
        """Give everything back."""
        self._pictures.close()

    def _choose(self, document: Document, shared: Shared) -> None:
        content = document.content
        listed = []
        for model in content.models:
            used = users(content, model.name)
            listed.append((model.name, f"used {used}x" if used else ""))
        before = shared.selection.model
        chosen = items.choose("models", listed, before, 4.0)
        if chosen != before:
            shared.choose_model(chosen)
        some = bool(content.models)
        pressed = items.buttons(
            "model",
            ("New...", True, "A model of one seed, or a copy of one of the package's"),
            ("Copy", some, "Another model like this one"),
            ("Delete", some, "Take it out of the file, and out of the skies that use it"),
        )
        if pressed == "New...":
            imgui.open_popup("new model")
        elif pressed == "Copy":
            model = content.models[before]
            add_model(document, shared, model, f"Copy {model.name}")
        elif pressed == "Delete":
            name = content.models[before].name
            document.try_apply(f"Delete {name}", lambda: without(content, "models", before))
        if imgui.begin_popup("new model"):
            new_model_menu(document, shared)
            imgui.end_popup()

    def _name(self, document: Document, index: int, model: CloudModel) -> None:
        merge = ("name", index)
        imgui.align_text_to_frame_padding()
        imgui.text_disabled("Name")
        imgui.same_line(0.30 * imgui.get_content_region_avail().x)
        imgui.set_next_item_width(-1.0)
        flags = imgui.InputTextFlags_.enter_returns_true | imgui.InputTextFlags_.auto_select_all
        entered, name = imgui.input_text(f"##name{index}{model.name}", model.name, flags)
        left = imgui.is_item_deactivated_after_edit()
        tip_of_last("A letter, then up to 63 letters, digits, spaces, _ or -; Enter takes it")
        if (entered or left) and name != model.name:
            document.try_apply(
                f"Rename {model.name}", lambda: rename_model(document.content, index, name), merge
            )
            document.end_gesture()
        rows.show_problem(document, merge)


def generate(shared: Shared) -> None:
    """Which of the model's clouds the view shows, and another one."""
    wide = imgui.get_content_region_avail().x
    if imgui.button("Generate again", imgui.ImVec2(0.52 * wide, 0.0)):
        another_number(shared)
    tip_of_last("Another cloud of this model, by another random seed")
    imgui.same_line()
    imgui.set_next_item_width(-1.0)
    number = imgui.input_int("##number", shared.number, 1, 10)[1]
    shared.number = min(max(number, 0), MOST_NUMBER)
    tip_of_last("The random seed, 0 to 2147483647: the same one always gives the same cloud")


def another_number(shared: Shared) -> None:
    """A random seed that chance picks; short enough to be written down."""
    shared.number = random.SystemRandom().randrange(100_000)


def new_model_menu(document: Document, shared: Shared) -> None:
    """Items of a menu: what a new model can begin as."""
    if imgui.menu_item("One seed", "", False)[0]:
        model = CloudModel("cloud", (CloudSeed((0.0, 150.0, 0.0), 500.0, 300.0, 500.0),))
        model = replace(
            model, billboards_min=8, billboards_max=12, size_min=220.0, size_max=360.0, flatness=1.0
        )
        add_model(document, shared, model, "New model")
    imgui.separator_text("Like the package's")
    for name in presets.CLOUD_MODELS:
        if imgui.menu_item(name.capitalize(), "", False)[0]:
            add_model(document, shared, presets.cloud_model(name), f"New {name}")


def add_model(document: Document, shared: Shared, model: CloudModel, label: str) -> None:
    """Another model at the end of the list, under a name that is free, and chosen."""
    content = document.content
    named = replace(model, name=free_name(content, model.name))
    if document.try_apply(label, lambda: with_new(content, "models", named)):
        shared.choose_model(len(content.models))
