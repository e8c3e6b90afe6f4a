"""The seed panel: the boxes of a model that billboards are placed in."""

from __future__ import annotations

from dataclasses import replace

from imgui_bundle import imgui

from weather_ecs.components import CloudModel, CloudSeed
from weather_ecs.editor import items, rows
from weather_ecs.editor.content import with_item, with_seed
from weather_ecs.editor.document import Document
from weather_ecs.editor.image_picker import ImagePicker
from weather_ecs.editor.rows import Thing
from weather_ecs.editor.shared import Shared


class SeedPanel:
    """Seeds to choose from, and where and how large one is."""

    title = "Seeds"

    def __init__(self, shared: Shared) -> None:
        self._pictures = ImagePicker(shared.gl)

    def draw(self, document: Document, shared: Shared) -> None:
        """The whole panel."""
        where = shared.selection
        models = document.content.models
        if not models:
            imgui.text_disabled("No model yet.")
            return
        at = where.model
        model = models[at]
        listed = [
            (f"Seed {number}", f"{len(seed.roots)} roots" if len(seed.roots) != 1 else "1 root")
            for number, seed in enumerate(model.seeds, 1)
        ]
        chosen = items.choose("seeds", listed, where.seed, items.lines_for(9.0, 5.0))
        if chosen != where.seed:
            where.seed, where.root = chosen, 0
        if items.clicked_into():
            shared.focus = "seed"
        self._change(document, shared, model)
        model = document.content.models[at]
        index = min(where.seed, len(model.seeds) - 1)
        thing = Thing(
            document,
            model.seeds[index],
            ("seed", at, index),
            lambda changed: with_seed(document.content, at, index, changed),
        )
        rows.drag_place(thing, "Centre", "center")
        rows.drag(thing, "Width", "width")
        rows.drag(thing, "Height", "height")
        rows.drag(thing, "Depth", "depth")
        if imgui.tree_node("Billboards of its own"):
            rows.slide(thing, "Size", "size_factor", "%.2f x")
            rows.slide(thing, "Aspect", "aspect_factor", "%.2f x")
            rows.slide(thing, "Turn", "turn_factor", "%.2f x")
            self._pictures.draw(thing, of_model=model.images)
            imgui.tree_pop()

    def close(self) -> None:
        """Give everything back."""
        self._pictures.close()

    def _change(self, document: Document, shared: Shared, model: CloudModel) -> None:
        where = shared.selection
        pressed = items.buttons(
            "seed",
            ("New", True, "A seed beside the chosen one"),
            ("Copy", True, "One like the chosen seed, with its roots"),
            ("Delete", len(model.seeds) > 1, "Take it away; a model has one seed at least"),
        )
        if pressed == "New":
            add_seed(document, shared, new_seed(model.seeds[where.seed]), "New seed")
        elif pressed == "Copy":
            add_seed(document, shared, beside(model.seeds[where.seed]), "Copy seed")
        elif pressed == "Delete":
            delete_seed(document, shared)


def new_seed(like: CloudSeed) -> CloudSeed:
    """A seed of the same size without roots, beside the other one."""
    return replace(beside(like), roots=(), images=())


def beside(seed: CloudSeed) -> CloudSeed:
    """The same seed two thirds of its width away, so that both are seen."""
    x, y, z = seed.center
    x = x + 0.66 * seed.width
    return replace(seed, center=(x if abs(x) <= 1.0e6 else seed.center[0], y, z))


def add_seed(document: Document, shared: Shared, seed: CloudSeed, label: str) -> None:
    """Another seed after the chosen one, and chosen itself."""
    where = shared.selection
    content, at = document.content, where.model
    old = content.models[at]
    place = where.seed + 1

    def made() -> object:
        seeds = (*old.seeds[:place], seed, *old.seeds[place:])
        return with_item(content, "models", at, replace(old, seeds=seeds))

    if document.try_apply(label, made):  # type: ignore[arg-type]
        where.seed, where.root = place, 0
        shared.sight_wanted = True


def delete_seed(document: Document, shared: Shared) -> None:
    """Take the chosen seed away."""
    where = shared.selection
    content, at, gone = document.content, where.model, where.seed
    old = content.models[at]
    seeds = old.seeds[:gone] + old.seeds[gone + 1 :]
    if document.try_apply(
        "Delete seed", lambda: with_item(content, "models", at, replace(old, seeds=seeds))
    ):
        where.seed, where.root = max(gone - 1, 0), 0
