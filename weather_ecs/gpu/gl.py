"""OpenGL entry points that moderngl does not offer, taken from the context that is current.

Functions keep the names, argument order and units of the OpenGL specification. Arguments that are
pointers there are addresses (int) here; `ctypes.addressof` gives one.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Annotated, Any, TypeAlias, get_args, get_type_hints

from weather_ecs.errors import ContextError
from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.gl_platform import FUNCTION, QUICK, current_source

U: TypeAlias = Annotated[int, ctypes.c_uint]
I: TypeAlias = Annotated[int, ctypes.c_int]  # noqa: E741
B: TypeAlias = Annotated[int, ctypes.c_ubyte]
F: TypeAlias = Annotated[float, ctypes.c_float]
D: TypeAlias = Annotated[float, ctypes.c_double]
Z: TypeAlias = Annotated[int, ctypes.c_ssize_t]  # GLintptr, GLsizeiptr
P: TypeAlias = Annotated[int | None, ctypes.c_void_p]  # an address
S: TypeAlias = Annotated[bytes | None, ctypes.c_char_p]

# The version each optional function came with. Asking the platform is not enough: libglvnd hands
# out an entry point for any name.
SINCE = {
    "glEnablei": 300,
    "glBlendFuncSeparatei": 400,
    "glBlendEquationSeparatei": 400,
    "glBindTransformFeedback": 400,
    "glMemoryBarrier": 420,
    "glDispatchCompute": 430,
    "glBindBuffersBase": 440,
    "glBindSamplers": 440,
    "glTextureBarrier": 450,
    "glTextureParameteri": 450,
    "glGetTextureParameteriv": 450,
    "glGetTextureLevelParameteriv": 450,
}


# What only sets a state, or asks for one: quickly done, whatever the GPU is at.
STATE = ("glIs", "glEnable", "glDisable", "glBind", "glActive", "glBlend", "glDepth", "glColor",
         "glCull", "glFront", "glPolygon", "glLogic", "glProvoking", "glPrimitive", "glViewport",
         "glScissor", "glPixelStore", "glQueryCounter", "glBeginQuery", "glEndQuery")  # fmt: skip


class GL:
    """Bound functions of the current context; optional ones are None where it is too old.

    Raises ContextError when no context is current or a function of OpenGL 3.3 is missing.
    """

    # state
    glGetError: Callable[[], U]
    glGetString: Callable[[U], S]
    glGetIntegerv: Callable[[U, P], None]
    glGetFloatv: Callable[[U, P], None]
    glGetDoublev: Callable[[U, P], None]
    glGetIntegeri_v: Callable[[U, U, P], None]
    glGetInteger64i_v: Callable[[U, U, P], None]
    glIsEnabled: Callable[[U], B]
    glIsEnabledi: Callable[[U, U], B]
    glEnable: Callable[[U], None]
    glDisable: Callable[[U], None]
    glEnablei: Callable[[U, U], None]
    glDisablei: Callable[[U, U], None]
    glBlendFuncSeparate: Callable[[U, U, U, U], None]
    glBlendEquationSeparate: Callable[[U, U], None]
    glBlendFuncSeparatei: Callable[[U, U, U, U, U], None] | None
    glBlendEquationSeparatei: Callable[[U, U, U], None] | None
    glBlendColor: Callable[[F, F, F, F], None]
    glDepthFunc: Callable[[U], None]
    glDepthMask: Callable[[B], None]
    glDepthRange: Callable[[D, D], None]
    glColorMask: Callable[[B, B, B, B], None]
    glColorMaski: Callable[[U, B, B, B, B], None]
    glCullFace: Callable[[U], None]
    glFrontFace: Callable[[U], None]
    glPolygonMode: Callable[[U, U], None]
    glPolygonOffset: Callable[[F, F], None]
    glLineWidth: Callable[[F], None]
    glPointSize: Callable[[F], None]
    glLogicOp: Callable[[U], None]
    glProvokingVertex: Callable[[U], None]
    glPrimitiveRestartIndex: Callable[[U], None]
    glViewport: Callable[[I, I, I, I], None]
    glScissor: Callable[[I, I, I, I], None]
    glPixelStorei: Callable[[U, I], None]
    glClearColor: Callable[[F, F, F, F], None]
    glClearDepth: Callable[[D], None]
    glClearStencil: Callable[[I], None]
    glClear: Callable[[U], None]
    # programs, vertex arrays, buffers
    glUseProgram: Callable[[U], None]
    glIsProgram: Callable[[U], B]
    glCreateProgram: Callable[[], U]
    glDeleteProgram: Callable[[U], None]
    glGetAttachedShaders: Callable[[U, I, P, P], None]
    glIsShader: Callable[[U], B]
    glDeleteShader: Callable[[U], None]
    glGetProgramiv: Callable[[U, U, P], None]
    glGetShaderiv: Callable[[U, U, P], None]
    glGetUniformBlockIndex: Callable[[U, S], U]
    glUniformBlockBinding: Callable[[U, U, U], None]
    glGetUniformLocation: Callable[[U, S], I]
    glUniform1i: Callable[[I, I], None]
    glUniform4f: Callable[[I, F, F, F, F], None]
    glGetUniformIndices: Callable[[U, I, P, P], None]
    glGetActiveUniformsiv: Callable[[U, I, P, U, P], None]
    glGetActiveUniformBlockiv: Callable[[U, U, U, P], None]
    glBindVertexArray: Callable[[U], None]
    glIsVertexArray: Callable[[U], B]
    glBindBuffer: Callable[[U, U], None]
    glBindBufferBase: Callable[[U, U, U], None]
    glBindBufferRange: Callable[[U, U, U, Z, Z], None]
    glBindBuffersBase: Callable[[U, U, I, P], None] | None
    glBufferData: Callable[[U, Z, P, U], None]
    glGetBufferSubData: Callable[[U, Z, Z, P], None]
    glIsBuffer: Callable[[U], B]
    glBindTransformFeedback: Callable[[U, U], None] | None
    # textures
    glActiveTexture: Callable[[U], None]
    glGenTextures: Callable[[I, P], None]
    glDeleteTextures: Callable[[I, P], None]
    glIsTexture: Callable[[U], B]
    glBindTexture: Callable[[U, U], None]
    glBindSampler: Callable[[U, U], None]
    glBindSamplers: Callable[[U, I, P], None] | None
    glTexParameteri: Callable[[U, U, I], None]
    glTexImage2D: Callable[[U, I, I, I, I, I, U, U, P], None]
    glTexImage3D: Callable[[U, I, I, I, I, I, I, U, U, P], None]
    glCopyTexSubImage2D: Callable[[U, I, I, I, I, I, I, I], None]
    glTextureBarrier: Callable[[], None] | None
    glTextureParameteri: Callable[[U, U, I], None] | None
    glGetTextureParameteriv: Callable[[U, U, P], None] | None
    glGetTextureLevelParameteriv: Callable[[U, I, U, P], None] | None
    # framebuffers
    glBindFramebuffer: Callable[[U, U], None]
    glGenFramebuffers: Callable[[I, P], None]
    glDeleteFramebuffers: Callable[[I, P], None]
    glIsFramebuffer: Callable[[U], B]
    glIsRenderbuffer: Callable[[U], B]
    glCheckFramebufferStatus: Callable[[U], U]
    glFramebufferTexture2D: Callable[[U, U, U, U, I], None]
    glGetFramebufferAttachmentParameteriv: Callable[[U, U, U, P], None]
    glBindRenderbuffer: Callable[[U, U], None]
    glBlitFramebuffer: Callable[[I, I, I, I, I, I, I, I, U, U], None]
    glDrawBuffer: Callable[[U], None]
    glDrawBuffers: Callable[[I, P], None]
    glReadPixels: Callable[[I, I, I, I, U, U, P], None]
    # drawing, computing
    glDrawArrays: Callable[[U, I, I], None]
    glBeginTransformFeedback: Callable[[U], None]
    glEndTransformFeedback: Callable[[], None]
    glDispatchCompute: Callable[[U, U, U], None] | None
    glMemoryBarrier: Callable[[U], None] | None
    glFlush: Callable[[], None]
    glFinish: Callable[[], None]
    # queries
    glGenQueries: Callable[[I, P], None]
    glDeleteQueries: Callable[[I, P], None]
    glIsQuery: Callable[[U], B]
    glBeginQuery: Callable[[U, U], None]
    glEndQuery: Callable[[U], None]
    glQueryCounter: Callable[[U, U], None]
    glGetQueryiv: Callable[[U, U, P], None]
    glGetQueryObjectiv: Callable[[U, U, P], None]
    glGetQueryObjectui64v: Callable[[U, U, P], None]
    glIsSampler: Callable[[U], B]

    def __init__(self) -> None:
        self.handle, self._current, lookup = current_source()
        self._lookup = lookup
        self._scratch = (ctypes.c_int * 16)()
        self._place = ctypes.byref(self._scratch)
        self.glGetIntegerv = bind(lookup(b"glGetIntegerv"), "glGetIntegerv")
        self.glGetString = bind(lookup(b"glGetString"), "glGetString")
        self.glGetError = bind(lookup(b"glGetError"), "glGetError")
        self.version: int = self._read_version()
        missing = []
        for name, optional in SIGNATURES.items():
            known = self.version >= SINCE.get(name, 0)
            address = lookup(name.encode()) if known else None
            if address is None and not optional and self.version >= 330:
                missing.append(name)
            setattr(self, name, bind(address, name) if address else None)
        if missing:
            raise ContextError(f"OpenGL {self.version_text()} lacks {', '.join(missing)}")
        self._get_integer = self.reader("glGetIntegerv")
        if self.version >= 330:
            self._get_query = self.reader("glGetQueryiv")
            self._get_attachment = self.reader("glGetFramebufferAttachmentParameteriv")

    def reader(self, name: str) -> Callable[..., None]:
        """The function `name`, which takes `ctypes.byref` where OpenGL has a pointer.

        Its arguments are not checked, which saves more than half of what a call costs. For what
        only reads what the driver knows without asking the GPU.
        """
        address = self._lookup(name.encode())
        if not address:
            raise ContextError(f"the OpenGL library offers no {name}")
        return QUICK(None)(address)  # type: ignore[no-any-return]

    def _read_version(self) -> int:
        """Version as moderngl counts it: 330 for OpenGL 3.3."""
        text = (self.glGetString(e.VERSION) or b"").decode("ascii", "replace")
        number = text.removeprefix("OpenGL ES ").split(" ")[0].split(".")
        try:
            return int(number[0]) * 100 + int(number[1]) * 10
        except (IndexError, ValueError):
            raise ContextError(f"the OpenGL context reports no version, but {text!r}") from None

    def version_text(self) -> str:
        return f"{self.version // 100}.{self.version // 10 % 10}"

    def is_current(self) -> bool:
        """Whether the context these functions came from is the calling thread's current one."""
        return self._current() == self.handle

    def get_int(self, name: int) -> int:
        self._get_integer(name, self._place)
        return self._scratch[0]

    def get_ints(self, name: int, count: int) -> tuple[int, ...]:
        """`count` integers of one state value, at most 16."""
        self._get_integer(name, self._place)
        return tuple(self._scratch[:count])

    def get_query(self, target: int, name: int) -> int:
        """A value of a query target, such as CURRENT_QUERY."""
        self._get_query(target, name, self._place)
        return self._scratch[0]

    def get_attachment(self, target: int, attachment: int, name: int) -> int:
        """A value of one attachment of the framebuffer bound to `target`."""
        self._get_attachment(target, attachment, name, self._place)
        return self._scratch[0]

    def get_string(self, name: int) -> str:
        return (self.glGetString(name) or b"").decode("utf-8", "replace")

    def error(self) -> int:
        """The oldest pending error code, which is thereby cleared; 0 for none."""
        return self.glGetError()


def _signature(hint: Any) -> tuple[Any, list[Any], bool]:
    """C result type, C argument types, and whether the function is optional."""
    optional = type(None) in get_args(hint)
    if optional:
        hint = next(part for part in get_args(hint) if part is not type(None))
    arguments, result = get_args(hint)
    c_result = None if result in (None, type(None)) else result.__metadata__[0]
    return c_result, [argument.__metadata__[0] for argument in arguments], optional


_HINTS = {
    name: _signature(hint)
    for name, hint in get_type_hints(GL, include_extras=True).items()
    if name.startswith("gl")
}
INTEGERS = (ctypes.c_uint, ctypes.c_int, ctypes.c_ubyte)
SIGNATURES: dict[str, bool] = {name: optional for name, (_, _, optional) in _HINTS.items()}


def bind(address: int | None, name: str) -> Any:
    """A callable for the function `name` of this module at `address`."""
    if not address:
        raise ContextError(f"the OpenGL library offers no {name}")
    result, arguments, _ = _HINTS[name]
    if all(argument in INTEGERS for argument in arguments):
        # Without declared arguments ctypes passes an int as one of 32 bits, in half the time.
        return (QUICK if name.startswith(STATE) else FUNCTION)(result)(address)
    return FUNCTION(result, *arguments)(address)
