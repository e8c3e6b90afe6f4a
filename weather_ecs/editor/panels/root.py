"""The root panel: directions in which a seed reproduces."""

from __future__ import annotations

from dataclasses import replace

from imgui_bundle import imgui

from weather_ecs.components import CloudRoot, CloudSeed
from weather_ecs.editor import items, rows
from weather_ecs.editor.content import with_seed
from weather_ecs.editor.document import Document
from weather_ecs.editor.rows import Thing
from weather_ecs.editor.shared import Shared


class RootPanel:
    """Roots of the chosen seed to choose from, and where and how far one goes."""

    title = "Roots of the seed"

    def __init__(self, shared: Shared) -> None:
        pass

    def draw(self, document: Document, shared: Shared) -> None:
        """The whole panel."""
        where = shared.selection
        models = document.content.models
        if not models:
            imgui.text_disabled("No model yet.")
            return
        at, of = where.model, min(where.seed, len(models[where.model].seeds) - 1)
        seed = models[at].seeds[of]
        listed = [
            (f"Root {number}", f"up to {root.descendants()} seeds")
            for number, root in enumerate(seed.roots, 1)
        ]
        where.root = items.choose("roots", listed, where.root, items.lines_for(8.6, 3.0))
        if items.clicked_into():
            shared.focus = "root"
        some = bool(seed.roots)
        pressed = items.buttons(
            "root",
            ("New", len(seed.roots) < 256, "A root that grows upwards"),
            ("Copy", some, "One like the chosen root"),
            ("Delete", some, "Take the chosen root away"),
        )
        if pressed == "New":
            add_root(document, shared, CloudRoot(pitch=60.0, open_pitch=60.0), "New root")
        elif pressed == "Copy":
            add_root(document, shared, replace(seed.roots[where.root]), "Copy root")
        elif pressed == "Delete":
            delete_root(document, shared)
        seed = document.content.models[at].seeds[of]
        if not seed.roots:
            imgui.text_wrapped("No roots: the seed stays as it is. New adds one.")
            return
        index = min(where.root, len(seed.roots) - 1)
        thing = Thing(
            document,
            seed.roots[index],
            ("root", at, of, index),
            lambda changed: with_seed(document.content, at, of, with_root(seed, index, changed)),
        )
        rows.slide(thing, "Pitch", "pitch")
        rows.slide(thing, "Yaw", "yaw")
        rows.slide(thing, "Open pitch", "open_pitch")
        rows.slide(thing, "Open yaw", "open_yaw")
        rows.drag_whole(thing, "Seeds, start", "seeds_start")
        rows.drag_whole(thing, "Seeds, end", "seeds_end")
        rows.drag_pair(thing, "Reproductions", "reproductions_min", "reproductions_max", whole=True)


def with_root(seed: CloudSeed, index: int, root: CloudRoot) -> CloudSeed:
    """The seed with another root in place of one of its."""
    return replace(seed, roots=(*seed.roots[:index], root, *seed.roots[index + 1 :]))


def add_root(document: Document, shared: Shared, root: CloudRoot, label: str) -> None:
    """Another root after the last, and chosen."""
    where = shared.selection
    content, at, of = document.content, where.model, where.seed
    seed = content.models[at].seeds[of]
    if document.try_apply(
        label,
        lambda: with_seed(content, at, of, replace(seed, roots=(*seed.roots, root))),
    ):
        where.root = len(seed.roots)
        shared.sight_wanted = True


def delete_root(document: Document, shared: Shared) -> None:
    """Take the chosen root away."""
    where = shared.selection
    content, at, of, gone = document.content, where.model, where.seed, where.root
    seed = content.models[at].seeds[of]
    roots = seed.roots[:gone] + seed.roots[gone + 1 :]
    if document.try_apply(
        "Delete root", lambda: with_seed(content, at, of, replace(seed, roots=roots))
    ):
        where.root = max(gone - 1, 0)
