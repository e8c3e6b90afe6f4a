"""A host's OpenGL state for the guard's tests: read in full, and set at random to odd values.

Kept apart from the tables of the guard on purpose.
"""

from __future__ import annotations

import ctypes
import random
from collections.abc import Callable
from typing import Any

import moderngl

from weather_ecs.gpu.gl import GL

SWITCHES = {
    "blend": 0x0BE2, "cull": 0x0B44, "depth": 0x0B71, "stencil": 0x0B90, "scissor": 0x0C11,
    "logic op": 0x0BF2, "offset point": 0x2A01, "offset line": 0x2A02, "offset fill": 0x8037,
    "multisample": 0x809D, "alpha to coverage": 0x809E, "alpha to one": 0x809F,
    "sample coverage": 0x80A0, "sample mask": 0x8E51, "depth clamp": 0x864F,
    "point size": 0x8642, "seamless": 0x884F, "discard": 0x8C89, "restart": 0x8F9D,
    "srgb": 0x8DB9, **{f"clip {i}": 0x3000 + i for i in range(8)},
}  # fmt: skip
SWITCHES_43 = {"restart fixed": 0x8D69}
DITHER = 0x0BD0

INTEGERS = {
    "program": (0x8B8D, 1), "vertex array": (0x85B5, 1), "array buffer": (0x8894, 1),
    "element buffer": (0x8895, 1), "pack buffer": (0x88ED, 1), "unpack buffer": (0x88EF, 1),
    "uniform buffer": (0x8A28, 1), "texture buffer": (0x8C2A, 1),
    "feedback buffer": (0x8C8F, 1), "copy read": (0x8F36, 1), "copy write": (0x8F37, 1),
    "renderbuffer": (0x8CA7, 1), "draw framebuffer": (0x8CA6, 1),
    "read framebuffer": (0x8CAA, 1), "viewport": (0x0BA2, 4), "scissor box": (0x0C10, 4),
    "active texture": (0x84E0, 1), "source rgb": (0x80C9, 1), "target rgb": (0x80C8, 1),
    "source alpha": (0x80CB, 1), "target alpha": (0x80CA, 1), "equation rgb": (0x8009, 1),
    "equation alpha": (0x883D, 1), "depth function": (0x0B74, 1), "depth mask": (0x0B72, 1),
    "color mask": (0x0C23, 4), "cull mode": (0x0B45, 1), "front face": (0x0B46, 1),
    "polygon mode": (0x0B40, 1), "logic operation": (0x0BF0, 1), "provoking": (0x8E4F, 1),
    "restart index": (0x8F9E, 1), "stencil clear": (0x0B91, 1), "stencil function": (0x0B92, 1),
    "unpack alignment": (0x0CF5, 1), "unpack row": (0x0CF2, 1), "unpack rows": (0x0CF3, 1),
    "unpack pixels": (0x0CF4, 1), "unpack images": (0x806D, 1), "unpack height": (0x806E, 1),
    "pack alignment": (0x0D05, 1), "pack row": (0x0D02, 1), "pack rows": (0x0D03, 1),
    "pack pixels": (0x0D04, 1), **{f"draw buffer {i}": (0x8825 + i, 1) for i in range(8)},
}  # fmt: skip
INTEGERS_43 = {
    "draw indirect": (0x8F43, 1), "dispatch indirect": (0x90EF, 1),
    "storage buffer": (0x90D3, 1), "query buffer": (0x9193, 1), "feedback": (0x8E25, 1),
}  # fmt: skip
DOUBLES = {
    "depth range": (0x0B70, 2), "depth clear": (0x0B73, 1), "blend color": (0x8005, 4),
    "clear color": (0x0C22, 4), "offset factor": (0x8038, 1), "offset units": (0x2A00, 1),
    "line width": (0x0B21, 1), "point": (0x0B11, 1), "coverage": (0x80AA, 1),
}  # fmt: skip
TEXTURES = {
    0x0DE1: 0x8069, 0x806F: 0x806A, 0x8513: 0x8514, 0x8C1A: 0x8C1D,
    0x9100: 0x9104, 0x0DE0: 0x8068, 0x84F5: 0x84F6,
}  # fmt: skip
SAMPLER = 0x8919
BLENDING = (0x80C9, 0x80C8, 0x80CB, 0x80CA, 0x8009, 0x883D)
# (binding, start, size), for target
INDEXED = {0x8A11: (0x8A28, 0x8A29, 0x8A2A), 0x8C8E: (0x8C8F, 0x8C84, 0x8C85)}
INDEXED_43 = {0x90D2: (0x90D3, 0x90D4, 0x90D5)}


def read_state(gl: GL) -> dict[str, Any]:
    """Every state value by a readable name."""
    modern = gl.version >= 430
    state: dict[str, Any] = {"dither": gl.glIsEnabled(DITHER)}
    for name, switch in {**SWITCHES, **(SWITCHES_43 if modern else {})}.items():
        state[name] = gl.glIsEnabled(switch)
    for name, (value, count) in {**INTEGERS, **(INTEGERS_43 if modern else {})}.items():
        state[name] = gl.get_ints(value, count)
    numbers = (ctypes.c_double * 4)()
    for name, (value, count) in DOUBLES.items():
        gl.glGetDoublev(value, ctypes.addressof(numbers))
        state[name] = tuple(numbers[:count])
    _read_draw_buffers(gl, state)
    _read_slots(gl, state, modern)
    _read_textures(gl, state)
    return state


def _read_draw_buffers(gl: GL, state: dict[str, Any]) -> None:
    four = (ctypes.c_int * 4)()
    for index in range(8):
        gl.glGetIntegeri_v(0x0C23, index, ctypes.addressof(four))
        state[f"mask of {index}"] = tuple(four)
        state[f"blend of {index}"] = gl.glIsEnabledi(0x0BE2, index)
        for value in BLENDING if gl.version >= 400 else ():
            gl.glGetIntegeri_v(value, index, ctypes.addressof(four))
            state[f"{value:#x} of {index}"] = four[0]


def _read_slots(gl: GL, state: dict[str, Any], modern: bool) -> None:
    one, long = ctypes.c_int(), ctypes.c_int64()
    limits = {0x8A11: gl.get_int(0x8A2F), 0x8C8E: 4, 0x90D2: 16}
    for target, (binding, *ends) in {**INDEXED, **(INDEXED_43 if modern else {})}.items():
        for index in range(limits[target]):
            gl.glGetIntegeri_v(binding, index, ctypes.addressof(one))
            values = [one.value]
            for end in ends:
                gl.glGetInteger64i_v(end, index, ctypes.addressof(long))
                values.append(long.value)
            state[f"buffer {target:#x} at {index}"] = tuple(values)


def _read_textures(gl: GL, state: dict[str, Any]) -> None:
    active = gl.get_int(0x84E0)
    for unit in range(gl.get_int(0x8872)):
        gl.glActiveTexture(0x84C0 + unit)
        for binding in (*TEXTURES.values(), SAMPLER):
            state[f"{binding:#x} of unit {unit}"] = gl.get_int(binding)
    gl.glActiveTexture(active)


class Host:
    """Objects a host would have, and a way to leave OpenGL in any state with them."""

    def __init__(
        self, ctx: moderngl.Context, gl: GL, keep: Callable[[Any], Any], seed: int
    ) -> None:
        self.ctx, self.gl, self.random = ctx, gl, random.Random(seed)
        self.buffers = [keep(ctx.buffer(reserve=1024)) for _ in range(3)]
        self.textures = {
            0x0DE1: [keep(ctx.texture((4, 4), 4)) for _ in range(2)],
            0x806F: [keep(ctx.texture3d((4, 4, 4), 4))],
            0x8513: [keep(ctx.texture_cube((4, 4), 4))],
            0x8C1A: [keep(ctx.texture_array((4, 4, 2), 4))],
            0x9100: [keep(ctx.texture((4, 4), 4, samples=4))],
        }
        self.samplers = [self._name(keep(ctx.sampler())) for _ in range(2)]
        self.programs = [
            keep(
                ctx.program(
                    vertex_shader=f"#version 330\nvoid main() {{ gl_Position = vec4({i}.0); }}"
                )
            )
            for i in range(2)
        ]
        self.arrays = [
            keep(ctx.vertex_array(program, [], index_buffer=buffer))
            for program, buffer in zip(self.programs, self.buffers, strict=False)
        ]
        self.framebuffers = []
        for size in ((16, 8), (32, 32)):
            colors = [keep(ctx.texture(size, 4)) for _ in range(3)]
            depth = keep(ctx.depth_renderbuffer(size))
            self.framebuffers.append(keep(ctx.framebuffer(colors, depth)))
        self.renderbuffer = keep(ctx.renderbuffer((4, 4)))

    def _name(self, sampler: moderngl.Sampler) -> int:
        sampler.use(0)  # moderngl keeps the name to itself
        self.gl.glActiveTexture(0x84C0)
        return self.gl.get_int(SAMPLER)

    def scramble(self) -> None:
        """Every state value at random, through raw OpenGL, as a host without moderngl does."""
        gl, pick, chance = self.gl, self.random.choice, self.random.random
        self._bind()
        for switch in (*SWITCHES.values(), *(SWITCHES_43.values() if gl.version >= 430 else ())):
            (gl.glEnable if chance() < 0.5 else gl.glDisable)(switch)
        factors = (0, 1, 0x0302, 0x0303, 0x0306, 0x8001, 0x8003)
        equations = (0x8006, 0x800A, 0x800B, 0x8007, 0x8008)
        gl.glBlendFuncSeparate(*(pick(factors) for _ in range(4)))
        gl.glBlendEquationSeparate(pick(equations), pick(equations))
        gl.glColorMask(*(pick((0, 1)) for _ in range(4)))
        if chance() < 0.5:  # targets blended and masked each in its own way
            for index in range(8):
                (gl.glEnablei if (index + (chance() < 0.5)) % 2 else gl.glDisablei)(0x0BE2, index)
                gl.glColorMaski(index, index % 2, *(pick((0, 1)) for _ in range(3)))
                if gl.glBlendFuncSeparatei and gl.glBlendEquationSeparatei:
                    gl.glBlendFuncSeparatei(index, *(pick(factors) for _ in range(4)))
                    gl.glBlendEquationSeparatei(index, pick(equations), pick(equations))
        gl.glBlendColor(*(chance() for _ in range(4)))
        gl.glClearColor(*(chance() for _ in range(4)))
        gl.glClearDepth(chance())
        gl.glClearStencil(pick((0, 3)))
        gl.glDepthFunc(0x0200 + pick(range(8)))
        gl.glDepthMask(pick((0, 1)))
        gl.glDepthRange(chance() * 0.5, 1.0 - chance() * 0.5)
        gl.glCullFace(pick((0x0404, 0x0405, 0x0408)))
        gl.glFrontFace(pick((0x0900, 0x0901)))
        gl.glPolygonMode(0x0408, pick((0x1B00, 0x1B01, 0x1B02)))
        gl.glPolygonOffset(chance(), chance())
        gl.glLineWidth(1.0)
        gl.glPointSize(1.0 + chance())
        gl.glLogicOp(0x1500 + pick(range(16)))
        gl.glProvokingVertex(pick((0x8E4D, 0x8E4E)))
        gl.glPrimitiveRestartIndex(pick((5, 0xFFFFFFFF)))
        gl.glViewport(*(pick(range(1, 30)) for _ in range(4)))
        gl.glScissor(*(pick(range(1, 30)) for _ in range(4)))
        for store in (0x0CF5, 0x0D05):
            gl.glPixelStorei(store, pick((1, 2, 4, 8)))
        for store in (0x0CF2, 0x0CF3, 0x0CF4, 0x806D, 0x806E, 0x0D02, 0x0D03, 0x0D04):
            gl.glPixelStorei(store, pick((0, 0, 3)))

    def _bind(self) -> None:
        gl, pick = self.gl, self.random.choice
        names = [0, *(buffer.glo for buffer in self.buffers)]
        slots = {0x8A11: gl.get_int(0x8A2F), 0x8C8E: 4}
        plain = [0x8892, 0x88EB, 0x88EC, 0x8A11, 0x8C2A, 0x8C8E, 0x8F36, 0x8F37]
        if gl.version >= 430:
            slots[0x90D2] = 16
            plain += [0x8F3F, 0x90EE, 0x90D2, 0x9192]
        for target, count in slots.items():
            for index in range(count):
                name = pick(names)
                if name and pick((0, 1)):
                    gl.glBindBufferRange(target, index, name, 256, 512)
                else:
                    gl.glBindBufferBase(target, index, name)
        for target in plain:
            gl.glBindBuffer(target, pick(names))
        for unit in range(gl.get_int(0x8872)):
            gl.glActiveTexture(0x84C0 + unit)
            for target, textures in self.textures.items():
                gl.glBindTexture(target, pick([0, *(texture.glo for texture in textures)]))
            gl.glBindSampler(unit, pick([0, *self.samplers]))
        gl.glActiveTexture(0x84C0 + pick(range(gl.get_int(0x8872))))
        gl.glUseProgram(pick([0, *(program.glo for program in self.programs)]))
        gl.glBindVertexArray(pick([0, *(array.glo for array in self.arrays)]))
        gl.glBindRenderbuffer(0x8D41, pick((0, self.renderbuffer.glo)))
        framebuffers = [0, *(framebuffer.glo for framebuffer in self.framebuffers)]
        gl.glBindFramebuffer(0x8CA8, pick(framebuffers))
        bound = pick(framebuffers)
        gl.glBindFramebuffer(0x8CA9, bound)
        if bound:
            chosen = (ctypes.c_uint * 3)(*(pick((0, 0x8CE0 + i)) for i in range(3)))
            gl.glDrawBuffers(3, ctypes.addressof(chosen))
