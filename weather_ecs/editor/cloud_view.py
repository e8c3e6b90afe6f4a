"""`CloudView`: the chosen model's cloud in the sky, and the marks and gizmo over it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from imgui_bundle import imgui

from weather_ecs.components import CloudModel
from weather_ecs.editor import gizmo, theme, view
from weather_ecs.editor.camera import OrbitCamera
from weather_ecs.editor.cloud_marks import sketch
from weather_ecs.editor.cloud_stage import HEIGHT, SETTLING, CloudStage
from weather_ecs.editor.content import with_seed
from weather_ecs.editor.document import Document
from weather_ecs.editor.ground import Ground
from weather_ecs.editor.marks import Marks
from weather_ecs.editor.shared import Shared
from weather_ecs.editor.sharpness import Sharpness
from weather_ecs.editor.target import Target
from weather_ecs.editor.view_bar import draw_bar

_ORIGIN = np.array([0.0, HEIGHT, 0.0])


class CloudView:
    """The panel in the middle of the cloud workspace."""

    title = "Cloud"

    def __init__(self, shared: Shared) -> None:
        gl = shared.gl
        self.stage = CloudStage(gl)
        self.camera = OrbitCamera()
        self.target = Target(gl)
        self.drawn = 0  # pictures that were taken, for statistics
        self._marks = Marks(gl)
        self._ground = Ground(gl)
        self._marked: tuple[Any, ...] = ()
        self._seen: tuple[Any, ...] = ()
        self._unsettled = SETTLING  # s in which the light of the picture still changes
        self.sharpness = Sharpness()
        self._generation = -1
        self._gesture = False

    def draw(self, document: Document, shared: Shared) -> None:
        """The bar of modes, the picture, the gizmo."""
        model = chosen_model(document, shared)
        self.stage.show(model, shared.number)
        draw_bar(shared, self.stage.posed)
        rect = view.space_left()
        if rect.width < 2.0 or rect.height < 2.0:
            return
        if self.stage.light(shared.sunlight, plain=shared.modes.plain):
            self._unsettled = SETTLING
        self._begin_anew(document, shared, rect)
        self._take_picture(model, shared, rect)
        busy = self._edit_by_gizmo(document, shared, rect) if model is not None else False
        hovered = view.show("cloud picture", self.target, rect, takes_mouse=not busy)
        if model is None:
            _hint(rect)
        view.steer(self.camera, rect.height, min(shared.dt, 0.1))
        if hovered and imgui.is_mouse_double_clicked(0):
            shared.frame_wanted = True

    def close(self) -> None:
        """Give everything back."""
        for part in (self._marks, self._ground, self.target):
            part.release()
        self.stage.close()

    def _begin_anew(self, document: Document, shared: Shared, rect: view.Rect) -> None:
        """Bring the whole cloud into the picture where it is another one or somebody asks."""
        posed = self.stage.posed
        if document.generation != self._generation:
            self._generation = document.generation
            shared.frame_wanted = True
        if posed is None:
            return
        wanted = shared.frame_wanted
        if shared.sight_wanted and not wanted:
            wanted = not self.camera.sees(*posed.bounds(), rect.aspect)
        shared.frame_wanted = shared.sight_wanted = False
        if wanted:
            self.camera.frame(*posed.bounds(), rect.aspect)

    def _take_picture(self, model: CloudModel | None, shared: Shared, rect: view.Rect) -> None:
        """Draw anew, unless it would come out as the last one did."""
        self._unsettled -= shared.dt
        camera, modes = self.camera, replace(shared.modes)
        where = (*camera.target.tolist(), camera.distance, camera.yaw, camera.pitch, camera.fov)
        choice = (shared.selection.seed, shared.selection.root)
        seen = (model, shared.number, where, rect.pixels, modes, choice)
        moves = seen != self._seen or self._unsettled > 0.0
        wanted = self.sharpness.wants(shared.dt, moves=moves)
        shared.moves |= moves or not self.sharpness.rests
        if not wanted:
            return
        pixels = self.sharpness.pixels(rect.pixels)
        self._seen = seen
        self.drawn += 1
        self.stage.step(min(shared.dt, 0.1))
        aspect = rect.aspect
        sight, depth = camera.view(_ORIGIN), camera.projection(aspect)
        target = self.target.use(pixels)
        target.clear(*theme.BACK, depth=1.0)
        world = depth @ sight
        self._ground.draw(self.stage.weather, world, camera.eye() + _ORIGIN, grid=modes.grid)
        self.stage.draw(sight, depth, clouds=modes.billboards)
        posed = self.stage.posed
        if posed is not None and model is not None:
            marked = (posed.shape, modes, choice, posed.middle)
            if marked[0] is not (self._marked or (None,))[0] or marked[1:3] != self._marked[1:3]:
                self._marked = marked
                self._marks.take(sketch(posed, model, modes, *choice))
            self.target.use(pixels)
            self._marks.draw(depth @ camera.view(), pixels)
        self.target.begin_drawing()

    def _edit_by_gizmo(self, document: Document, shared: Shared, rect: view.Rect) -> bool:
        """Let the mouse move or size the chosen seed; whether it does."""
        where = shared.selection
        model = document.content.models[where.model]
        if shared.gizmo == "none":
            return False
        seed = model.seeds[where.seed]
        sight, depth = self.camera.view(), self.camera.projection(rect.aspect)
        changed = gizmo.edit_seed(seed, shared.gizmo, sight, depth, rect)
        if changed is not None:
            label = "Move seed" if shared.gizmo == "move" else "Size seed"
            document.try_apply(
                label,
                lambda: with_seed(document.content, where.model, where.seed, changed),
                merge=("gizmo", shared.gizmo, where.model, where.seed),
            )
        if self._gesture and not gizmo.dragging():
            document.end_gesture()
        self._gesture = gizmo.dragging()
        return gizmo.busy()


def chosen_model(document: Document, shared: Shared) -> CloudModel | None:
    """The model that is being edited."""
    models = document.content.models
    return models[shared.selection.model] if models else None


def _hint(rect: view.Rect) -> None:
    """What to do where there is no cloud yet."""
    text = "An empty file.  New..., to the left, begins a cloud."
    size = imgui.calc_text_size(text)
    x, y = rect.x + 0.5 * (rect.width - size.x), rect.y + 0.46 * rect.height
    lines = imgui.get_window_draw_list()
    lines.add_rect_filled(
        imgui.ImVec2(x - 16, y - 10),
        imgui.ImVec2(x + size.x + 16, y + size.y + 10),
        theme.packed((0.06, 0.07, 0.09, 0.78)),
        6.0,
    )
    lines.add_text(imgui.ImVec2(x, y), theme.packed(theme.TEXT), text)
