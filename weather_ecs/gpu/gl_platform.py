"""Where OpenGL's entry points come from: EGL, GLX, WGL or the macOS framework."""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Callable
from ctypes.util import find_library
from typing import Any

from weather_ecs.errors import ContextError

ADDRESS = ctypes.c_void_p
FUNCTION: Any = getattr(ctypes, "WINFUNCTYPE", ctypes.CFUNCTYPE)
# Calls that neither wait nor take long keep Python's lock: to give it up and take it back is a
# fifth of what such a call costs. Windows of 32 bits calls by another convention. A host's debug
# callback in Python must be synchronous (GL_DEBUG_OUTPUT_SYNCHRONOUS): one that a driver's thread
# calls would wait for the lock, and the driver for it.
QUICK: Any = ctypes.PYFUNCTYPE if ctypes.sizeof(ADDRESS) == 8 else FUNCTION

Current = Callable[[], int | None]
Lookup = Callable[[bytes], int | None]


def open_library(*names: str) -> ctypes.CDLL | None:
    for name in names:
        try:
            return ctypes.CDLL(name)
        except OSError:
            continue
    return None


def exports(library: ctypes.CDLL | None) -> Lookup:
    """The library's own table of symbols."""

    def lookup(name: bytes) -> int | None:
        function = getattr(library, name.decode(), None) if library is not None else None
        return ctypes.cast(function, ADDRESS).value if function is not None else None

    return lookup


def first_of(*lookups: Lookup) -> Lookup:
    def lookup(name: bytes) -> int | None:
        for look in lookups:
            address = look(name)
            # wglGetProcAddress fails with any of these
            if address and address not in (1, 2, 3, (1 << 64) - 1, (1 << 32) - 1):
                return address
        return None

    return lookup


def prototype(library: ctypes.CDLL, name: str, *arguments: type) -> Callable[..., int | None]:
    """A function of `library` that returns a pointer."""
    address = ctypes.cast(getattr(library, name), ADDRESS).value
    return QUICK(ADDRESS, *arguments)(address)  # type: ignore[no-any-return]


def linux_sources() -> list[tuple[Current, Lookup]]:
    sources: list[tuple[Current, Lookup]] = []
    core = open_library("libGL.so.1", "libOpenGL.so.0", find_library("GL") or "libGL.so")
    egl = open_library("libEGL.so.1", find_library("EGL") or "libEGL.so")
    if egl is not None:
        look = prototype(egl, "eglGetProcAddress", ctypes.c_char_p)
        sources.append((prototype(egl, "eglGetCurrentContext"), first_of(look, exports(core))))
    glx = open_library("libGL.so.1", "libGLX.so.0", find_library("GL") or "libGL.so")
    if glx is not None and hasattr(glx, "glXGetCurrentContext"):
        look = prototype(glx, "glXGetProcAddressARB", ctypes.c_char_p)
        sources.append((prototype(glx, "glXGetCurrentContext"), first_of(look, exports(core))))
    return sources


def windows_sources() -> list[tuple[Current, Lookup]]:
    library = open_library("opengl32.dll")
    if library is None:
        return []
    look = prototype(library, "wglGetProcAddress", ctypes.c_char_p)
    return [(prototype(library, "wglGetCurrentContext"), first_of(look, exports(library)))]


def macos_sources() -> list[tuple[Current, Lookup]]:
    library = open_library("/System/Library/Frameworks/OpenGL.framework/OpenGL")
    if library is None:
        return []
    return [(prototype(library, "CGLGetCurrentContext"), exports(library))]


def sources() -> list[tuple[Current, Lookup]]:
    if sys.platform.startswith("win"):
        return windows_sources()
    if sys.platform == "darwin":
        return macos_sources()
    return linux_sources()


def current_source() -> tuple[int, Current, Lookup]:
    """The current context's handle, how to ask for it again, and its entry points.

    Raises ContextError when the calling thread has no current OpenGL context.
    """
    for current, lookup in sources():
        handle = current()
        if handle:
            return handle, current, lookup
    raise ContextError("no OpenGL context is current in this thread")
