"""A panel that fails inside does not take the editor with it: what is edited can be saved."""

from __future__ import annotations

import logging
import weakref

from imgui_bundle import imgui

from weather_ecs.editor import theme
from weather_ecs.editor.document import Document
from weather_ecs.editor.shared import Panel, Shared

_log = logging.getLogger("weather_ecs")
_failed: weakref.WeakKeyDictionary[Panel, str] = weakref.WeakKeyDictionary()


def draw_panel(panel: Panel, document: Document, shared: Shared) -> None:
    """Draw it; one that raises shows what it was in its place, until it is told to try again."""
    trouble = _failed.get(panel)
    if trouble is not None:
        imgui.push_style_color(imgui.Col_.text, theme.vec4(theme.BAD))
        imgui.text_wrapped(f"{panel.title} has failed: {trouble}")
        imgui.pop_style_color()
        imgui.text_wrapped("The file is as it was, and can be saved.")
        if imgui.button(f"Try again##{panel.title}"):
            del _failed[panel]
        return
    state = imgui.internal.ErrorRecoveryState()
    imgui.internal.error_recovery_store_state(state)
    try:
        panel.draw(document, shared)
    except Exception as error:
        _log.exception("the panel %r has failed", panel.title)
        imgui.internal.error_recovery_try_to_recover_state(state)
        _failed[panel] = f"{type(error).__name__}: {error}"
