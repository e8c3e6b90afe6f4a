"""The moderngl context to work in, and what its OpenGL can do."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl

from weather_ecs.errors import ContextError, InvalidValueError
from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.saved_state import SavedState

REQUIRED = 330
COMPUTE = 430
# Invocations in a work group that the kernels ask for.
GROUP_SIZE = 128
RELEASED = "the moderngl context was released"


@dataclass(frozen=True, slots=True)
class Capabilities:
    """What the current OpenGL offers."""

    version: int  # 330 for OpenGL 3.3
    compute: bool  # compute shaders and storage buffers, OpenGL 4.3


def probe(ctx: moderngl.Context, gl: GL | None = None) -> Capabilities:
    """Ask the current context; `gl` saves loading the entry points again."""
    gl = gl if gl is not None else GL()
    compute = min(gl.version, ctx.version_code) >= COMPUTE
    return Capabilities(
        version=gl.version,
        compute=compute and gl.get_int(e.MAX_COMPUTE_WORK_GROUP_INVOCATIONS) >= GROUP_SIZE,
    )


def is_released(ctx: moderngl.Context) -> bool:
    """Whether a context is no more, and with it all that was made in it."""
    return isinstance(ctx.mglo, moderngl.InvalidObject)


def obtain(context: moderngl.Context | None = None) -> moderngl.Context:
    """`context` if it can be used, else moderngl's context for what is current.

    The host's OpenGL state is left as it was. Raises ContextError when no context is current, when
    it is older than OpenGL 3.3, or when `context` was released.
    """
    if context is not None:
        if not isinstance(context, moderngl.Context):
            raise InvalidValueError("context", context, "a moderngl.Context or None")
        if is_released(context):
            raise ContextError(RELEASED)
    gl = GL()
    require(gl.version, gl.get_string(e.VERSION))
    if context is not None:
        return context
    # moderngl chooses blending, primitive restart and more when it first meets a context.
    own = gl.get_int(e.MAX_TEXTURE_IMAGE_UNITS) - 1
    state = SavedState(gl, texture_units=0, own_unit=own, uniform_slots=0, storage_slots=0)
    state.save()
    try:
        return moderngl.get_context()
    except Exception as error:
        raise ContextError(f"moderngl cannot use the current OpenGL context: {error}") from error
    finally:
        state.restore()


def require(version: int, text: str) -> None:
    """Raises ContextError, naming both versions, for what is older than OpenGL 3.3."""
    if version < REQUIRED or "OpenGL ES" in text:
        raise ContextError(f"OpenGL 3.3 is needed, the current context has {text}")
