"""`Gallery`: small pictures of the clouds that one model gives, to choose from."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
from imgui_bundle import imgui

from weather_ecs.components import CloudModel
from weather_ecs.editor import theme, view
from weather_ecs.editor.camera import OrbitCamera
from weather_ecs.editor.cloud_stage import HEIGHT, CloudStage
from weather_ecs.editor.cloud_view import chosen_model
from weather_ecs.editor.document import Document
from weather_ecs.editor.shared import Shared
from weather_ecs.editor.target import Target
from weather_ecs.editor.view_bar import tip_of_last

MOST = 12  # pictures in a row at most
PAUSE = 0.2  # s after a change of the model before pictures are taken
_ORIGIN = np.array([0.0, HEIGHT, 0.0])


class Gallery:
    """Clouds of the numbers from a first one on, one picture a frame while nothing else moves."""

    title = "Gallery"

    def __init__(self, shared: Shared) -> None:
        self._gl = shared.gl
        self._stage: CloudStage | None = None  # made when the first picture is taken
        self._targets: list[Target] = []
        self._taken: list[tuple[Any, ...] | None] = []
        self._first = 0
        self._waited = 0.0  # s since the model has changed
        self._model: CloudModel | None = None

    def draw(self, document: Document, shared: Shared) -> None:
        """The heading and a row of pictures."""
        model = chosen_model(document, shared)
        imgui.align_text_to_frame_padding()
        imgui.text_disabled("Clouds of this model")
        if model is None:
            return
        imgui.same_line(0.0, 12.0)
        if imgui.small_button("<"):
            self._first = max(self._first - self._columns(), 0)
        imgui.same_line(0.0, 4.0)
        if imgui.small_button(">"):
            self._first += self._columns()
        tip_of_last("The next ones; a click on one shows it large")
        room = view.space_left()
        if room.height < 24.0:
            return
        if model is not self._model:
            self._model, self._waited = model, 0.0
        elif not imgui.is_any_item_active():
            self._waited += shared.dt
        columns = self._columns()
        wide = (room.width - 6.0 * (columns - 1)) / columns
        for column in range(columns):
            box = view.Rect(room.x + column * (wide + 6.0), room.y, wide, room.height)
            self._cell(shared, model, column, box)
        self._take_one(shared, model, columns, view.Rect(room.x, room.y, wide, room.height))

    def close(self) -> None:
        """Give everything back."""
        for target in self._targets:
            target.release()
        if self._stage is not None:
            self._stage.close()

    def _columns(self) -> int:
        room = view.space_left()
        return min(max(round(room.width / max(1.25 * room.height, 60.0)), 1), MOST)

    def _cell(self, shared: Shared, model: CloudModel, column: int, box: view.Rect) -> None:
        number = self._first + column
        lines = imgui.get_window_draw_list()
        near, far = imgui.ImVec2(box.x, box.y), imgui.ImVec2(box.x + box.width, box.y + box.height)
        known = self._taken[column] if column < len(self._taken) else None
        stale = known is None or known[:2] != (model, number)
        if known is None:
            lines.add_rect_filled(near, far, theme.packed(theme.WELL), 5.0)
        else:
            image = self._targets[column].image()
            tint = 0x90FFFFFF if stale else 0xFFFFFFFF
            lines.add_image_rounded(image, near, far, *view.UPRIGHT, tint, 5.0)
        imgui.set_cursor_screen_pos(near)
        if imgui.invisible_button(f"number {number}", imgui.ImVec2(box.width, box.height)):
            shared.number = number
        if number == shared.number or imgui.is_item_hovered():
            color = theme.ACCENT if number == shared.number else theme.DIM
            lines.add_rect(near, far, theme.packed(color), 5.0, 2.0)
        tip_of_last(f"The cloud of random seed {number}")
        lines.add_text(
            imgui.ImVec2(box.x + 7.0, box.y + 4.0), theme.packed((1.0, 1.0, 1.0, 0.85)), f"{number}"
        )

    def _take_one(self, shared: Shared, model: CloudModel, columns: int, box: view.Rect) -> None:
        """A picture of the first cloud whose is not as it should be."""
        sun, plain = shared.sunlight, shared.modes.plain
        look = (box.pixels, sun.azimuth, sun.elevation, plain)
        for column in range(columns):
            wanted = (model, self._first + column, *look)
            if column < len(self._taken) and self._taken[column] == wanted:
                continue
            shared.moves = True
            if self._waited < PAUSE:
                return
            while len(self._targets) <= column:
                self._targets.append(Target(self._gl))
                self._taken.append(None)
            self._take(shared, wanted, self._targets[column], box)
            self._taken[column] = wanted
            return

    def _take(
        self, shared: Shared, wanted: tuple[Any, ...], target: Target, box: view.Rect
    ) -> None:
        if self._stage is None:
            self._stage = CloudStage(self._gl)
        stage = self._stage
        stage.light(shared.sunlight, plain=shared.modes.plain)
        stage.show(*wanted[:2])
        stage.step(0.0)
        posed = stage.posed
        camera = OrbitCamera(pitch=0.2)  # from below: sky all round
        if posed is not None:
            camera.frame(*posed.bounds(), box.aspect)
        target.use(box.pixels).clear(*theme.BACK, depth=1.0)
        self._gl.enable_only(moderngl.NOTHING)
        stage.draw(camera.view(_ORIGIN), camera.projection(box.aspect))
