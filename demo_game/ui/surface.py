"""The window's framebuffer between the game's own drawing and pyglet's."""

from __future__ import annotations

import numpy as np
import pyglet
from numpy.typing import NDArray
from pyglet.gl import (
    GL_CULL_FACE,
    GL_DEPTH_TEST,
    GL_PACK_ALIGNMENT,
    GL_READ_FRAMEBUFFER,
    GL_RGB,
    GL_SCISSOR_TEST,
    GL_UNSIGNED_BYTE,
    glBindFramebuffer,
    glBindVertexArray,
    glDepthMask,
    glDisable,
    glPixelStorei,
    glReadPixels,
    glViewport,
)


def prepare_for_pyglet(window: pyglet.window.Window) -> None:
    """Set the state that pyglet's labels and shapes take for granted."""
    for state in (GL_DEPTH_TEST, GL_CULL_FACE, GL_SCISSOR_TEST):
        glDisable(state)
    glDepthMask(True)
    glBindVertexArray(0)
    glViewport(0, 0, *window.get_framebuffer_size())
    window.ubo.bind()


def read_pixels(width: int, height: int) -> NDArray[np.uint8]:
    """What was drawn to the window, shape (height, width, 3), top row first."""
    pixels = np.zeros((height, width, 3), np.uint8)
    # moderngl's read asks for a colour attachment, which a window's framebuffer has not.
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0)
    glPixelStorei(GL_PACK_ALIGNMENT, 1)
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.ctypes.data)
    return pixels[::-1]
