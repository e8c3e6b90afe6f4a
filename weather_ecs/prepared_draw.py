"""`PreparedDraw`: what one draw shows, made out before it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from weather_ecs.frame import FrameData, ViewData
from weather_ecs.physics.camera import Camera
from weather_ecs.quality import QualitySettings


@dataclass(slots=True)
class PreparedDraw:
    """A frame as one observer's camera sees it, at the quality that it is drawn with."""

    view: ViewData
    settings: QualitySettings
    ms: float = 0.0  # that its preparing took

    def serves(self, frame: FrameData, camera: Camera, observer: int) -> bool:
        """Whether a draw of this frame, camera and observer is the one that was prepared."""
        view = self.view
        if view.frame is not frame or view.key != observer:
            return False
        same = view.view is camera.view or np.array_equal(view.view, camera.view)
        return same and np.array_equal(view.projection, camera.projection)
