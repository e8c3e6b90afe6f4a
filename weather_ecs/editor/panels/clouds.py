"""Single clouds that stand where they are put, besides those of the layers."""

from __future__ import annotations

from dataclasses import replace

from imgui_bundle import imgui

from weather_ecs import presets
from weather_ecs.components import Cloud, CloudModel
from weather_ecs.editor import items
from weather_ecs.editor.bound import Bound, line, row, rows, take
from weather_ecs.editor.content import with_item, with_new
from weather_ecs.editor.content import without as without_item
from weather_ecs.editor.document import Content, Document
from weather_ecs.editor.fields import info
from weather_ecs.editor.shared import Shared
from weather_ecs.editor.studio import studio_of

AHEAD = 2500.0  # m in front of the eye, where a new one stands


class CloudsPanel:
    """The document's single clouds."""

    title = "Clouds"

    def __init__(self, shared: Shared) -> None:
        self._shared = shared

    def draw(self, document: Document, shared: Shared) -> None:
        """The list, and the chosen cloud."""
        clouds, chosen = document.content.clouds, shared.selection.cloud
        with items.well("clouds", len(clouds)):
            for k, cloud in enumerate(clouds):
                if imgui.selectable(f"{name_of(cloud)} {cloud.number}##cloud{k}", k == chosen)[0]:
                    shared.selection.cloud, shared.focus = k, "cloud"
                imgui.same_line(imgui.get_window_width() * 0.56)
                imgui.text_disabled(f"{cloud.position[1]:,.0f} m".replace(",", " "))
        if not clouds:
            imgui.text_wrapped("Clouds that stand where you put them; those of layers need none.")
        pressed = items.edit_buttons("cloud", bool(clouds))
        if pressed == "New":
            camera = studio_of(shared).camera
            ahead = camera.forward()
            models = names_of(document)
            cloud = Cloud(
                models[0] if document.content.models else "cumulus",
                (round(camera.x + AHEAD * ahead[0]), 900.0, round(camera.z + AHEAD * ahead[2])),
            )
            if document.apply("New cloud", with_new(document.content, "clouds", cloud)):
                shared.selection.cloud, shared.focus = len(clouds), "cloud"
        elif pressed == "Copy":
            x, y, z = clouds[chosen].position
            number = clouds[chosen].number + 1
            copy = replace(clouds[chosen], position=(x + 1500.0, y, z), number=number)
            content = with_new(document.content, "clouds", copy, chosen + 1)
            if document.apply("Copy cloud", content):
                shared.selection.cloud = chosen + 1
        elif pressed == "Delete":
            document.apply("Delete cloud", without_item(document.content, "clouds", chosen))
        if shared.selection.cloud < len(document.content.clouds):
            _draw_cloud(document, shared.selection.cloud)


def name_of(cloud: Cloud) -> str:
    """The name of its model."""
    return cloud.model.name if isinstance(cloud.model, CloudModel) else cloud.model


def names_of(document: Document) -> list[str]:
    """Models that a cloud may be of: those of the file first."""
    own = [model.name for model in document.content.models]
    return list(dict.fromkeys((*own, *presets.CLOUD_MODELS)))


def _draw_cloud(document: Document, index: int) -> None:
    def put(cloud: Cloud) -> Content:
        return with_item(document.content, "clouds", index, cloud)

    cloud = document.content.clouds[index]
    bound = Bound(document, cloud, put, ("cloud", index), "Cloud")
    imgui.separator_text("Chosen cloud")
    names = names_of(document)
    with line(bound, "model", "Model", info(Cloud, "model")):
        now = name_of(cloud)
        at = names.index(now) if now in names else 0
        changed, at = imgui.combo("##value", at, names)
        take(bound, "model", "Model", changed, names[at])
    row(bound, "position")
    rows(bound, "number", "scale", "heading", "velocity", "drift", "shear")
    rows(bound, "growth", "hollow", "opacity")
