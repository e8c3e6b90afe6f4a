"""`ImagePicker`: the cloud images as pictures to choose from."""

from __future__ import annotations

from functools import cache

import moderngl
import numpy as np
from imgui_bundle import imgui
from numpy.typing import NDArray

from weather_ecs.components import CloudModel, CloudSeed
from weather_ecs.editor import rows, theme
from weather_ecs.editor.rows import Thing
from weather_ecs.editor.view_bar import tip_of_last
from weather_ecs.tools import CLOUD_IMAGES, cloud_images

SIDE = 64  # texels of a small picture
SHOWN = 38.0  # pixels on screen
_SKY = np.array([0.28, 0.45, 0.68])
FAMILIES = {
    "puff": "dense and round: cumulus",
    "ragged": "torn at the edge: fractus, stratocumulus",
    "wisp": "thin and curled: altocumulus",
    "streak": "fibres: cirrus, anvils",
    "sheet": "even: stratus, altostratus",
}


class ImagePicker:
    """All images, those marked that a model or a seed uses."""

    def __init__(self, gl: moderngl.Context) -> None:
        self._gl = gl
        self._texture: moderngl.Texture | None = None

    def draw(self, thing: Thing, of_model: tuple[str, ...] = ()) -> None:
        """The pictures by family; `of_model` are those that count where there are none."""
        if self._texture is None:
            data = small_pictures()
            self._texture = self._gl.texture((data.shape[1], data.shape[0]), 3, data.tobytes())
            self._texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        part: CloudModel | CloudSeed = thing.part
        used = chosen(part.images)
        if not part.images and of_model:
            imgui.text_disabled("The model's; a click gives it its own:")
        for family, remark in FAMILIES.items():
            members = [name for name in CLOUD_IMAGES if name.rpartition("_")[0] == family]
            imgui.push_id(family)
            every = used.issuperset(members)
            clicked, wanted = imgui.checkbox(family, every)
            tip_of_last(f"All images of the family {family}: {remark}")
            if clicked:
                self._take(thing, used | set(members) if wanted else used - set(members))
            self._row(thing, members, used)
            imgui.pop_id()
        if part.images and of_model and imgui.button("The model's own again"):
            thing.change("Textures", ("images",), images=())
        rows.show_problem(thing.document, (*thing.key, "images"))

    def close(self) -> None:
        """Give everything back."""
        if self._texture is not None:
            self._texture.release()
            self._texture = None

    def _row(self, thing: Thing, members: list[str], used: set[str]) -> None:
        assert self._texture is not None
        room = imgui.get_content_region_avail().x
        side = min(SHOWN, (room - 3.0 * 5.0) / 6.0)
        reference, count = imgui.ImTextureRef(self._texture.glo), len(CLOUD_IMAGES)
        for place, name in enumerate(members):
            if place:
                imgui.same_line(0.0, 3.0)
            at = imgui.get_cursor_screen_pos()
            far = imgui.ImVec2(at.x + side, at.y + side)
            if imgui.invisible_button(name, imgui.ImVec2(side, side)):
                self._take(thing, used ^ {name})
            tip_of_last(name)
            lines = imgui.get_window_draw_list()
            layer, on = CLOUD_IMAGES.index(name), name in used
            first, last = imgui.ImVec2(0.0, layer / count), imgui.ImVec2(1.0, (layer + 1) / count)
            tint = 0xFFFFFFFF if on or imgui.is_item_hovered() else 0x58FFFFFF
            lines.add_image_rounded(reference, at, far, first, last, tint, 4.0)
            if on:
                lines.add_rect(at, far, theme.packed(theme.ACCENT), 4.0, 2.0)

    def _take(self, thing: Thing, names: set[str]) -> None:
        thing.change("Textures", ("images",), images=listed(names))
        thing.document.end_gesture()


def chosen(names: tuple[str, ...]) -> set[str]:
    """The single images that names of images and families mean."""
    return {image for image in CLOUD_IMAGES if {image, image.rpartition("_")[0]} & set(names)}


def listed(names: set[str]) -> tuple[str, ...]:
    """Images as a file has them: a family by its name where all of it is there."""
    found: list[str] = []
    for family in FAMILIES:
        members = [name for name in CLOUD_IMAGES if name.rpartition("_")[0] == family]
        here = [name for name in members if name in names]
        found += [family] if here == members else here
    return tuple(found)


@cache
def small_pictures() -> NDArray[np.uint8]:
    """(n * SIDE, SIDE, 3): each image over blue, lit from the upper left, one below the other."""
    texels = cloud_images().astype(np.float64) / 255.0
    n, size = len(texels), texels.shape[1]
    step = size // SIDE
    small = texels.reshape(n, SIDE, step, SIDE, step, 4).mean(axis=(2, 4))[:, ::-1]
    relief = small[..., :2] - 0.5
    light = np.clip(small[..., 2] + 0.55 * relief[..., 1] - 0.40 * relief[..., 0], 0.0, 1.1)
    cover = np.clip(1.25 * small[..., 3:], 0.0, 1.0)
    white = light[..., None] * np.array([1.0, 0.99, 0.97])
    shown = np.clip(cover * white + (1.0 - cover) * _SKY, 0.0, 1.0)
    return np.rint(shown * 255.0).astype(np.uint8).reshape(n * SIDE, SIDE, 3)
