"""Host games that a guest must not disturb: pyglet's own drawing, a state cache, moderngl."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any, Protocol

import moderngl
import numpy as np
import pyglet
from pyglet import gl, shapes
from pyglet.graphics.shader import Shader, ShaderProgram

Box = tuple[int, int, int, int]  # x, y, width, height in pixels


class Scene(Protocol):
    """A host: `before` and `after` draw around the weather; `opaque` is all `after`'s own."""

    opaque: Sequence[Box]

    def before(self, frame: int) -> None: ...

    def after(self, frame: int) -> None: ...


def picture(width: int, height: int, alpha: bool) -> pyglet.image.ImageData:
    """A sprite's image, made from sines."""
    y, x = np.mgrid[0:height, 0:width]
    bands = np.sin(x / 3.0) * np.cos(y / 4.0)
    pixels = np.empty((height, width, 4), np.uint8)
    pixels[..., 0] = 128 + 127 * bands
    pixels[..., 1] = 255 * x / width
    pixels[..., 2] = 255 * y / height
    pixels[..., 3] = (255 * np.abs(bands)).astype(np.uint8) if alpha else 255
    return pyglet.image.ImageData(width, height, "RGBA", pixels.tobytes())


class PygletScene:
    """Sprites, labels and shapes in batches, as pyglet's manual draws them."""

    def __init__(self, window: pyglet.window.Window) -> None:
        w, h = window.width, window.height
        self.back = pyglet.graphics.Batch()
        self.front = pyglet.graphics.Batch()
        clear, solid = picture(48, 32, alpha=True), picture(40, 40, alpha=False)
        self.moving = pyglet.sprite.Sprite(clear, 10, h // 2, batch=self.back)
        self.keep: list[Any] = [
            shapes.Circle(w // 3, h // 3, 30, color=(200, 90, 40, 160), batch=self.back),
            shapes.Line(0, 0, w, h, 3, color=(90, 200, 90, 255), batch=self.back),
            pyglet.text.Label("behind", x=20, y=h - 30, font_size=16, batch=self.back),
        ]
        box, badge = (w // 2, 20, w // 2 - 20, 60), (20, 20, 40, 40)
        below, above = pyglet.graphics.Group(0), pyglet.graphics.Group(1)
        text = dict(x=box[0] + 8, y=box[1] + 20, font_size=14, color=(20, 20, 20, 255))
        self.keep += [
            shapes.Rectangle(*box, color=(230, 230, 210, 255), batch=self.front, group=below),
            shapes.Star(
                box[0] + 115, box[1] + 30, 20, 9, 5, color=(160, 30, 90, 200), batch=self.front
            ),
            pyglet.sprite.Sprite(solid, badge[0], badge[1], batch=self.front, group=above),
            pyglet.sprite.Sprite(clear, box[0] + 80, box[1] + 5, batch=self.front, group=above),
            pyglet.text.Label("score 1200", batch=self.front, group=above, **text),
        ]
        self.opaque = [box, badge]

    def before(self, frame: int) -> None:
        self.moving.x = 10 + 7 * frame
        self.back.draw()

    def after(self, frame: int) -> None:
        self.front.draw()


CACHE_VERTEX = """#version 330 core
in vec2 place;
uniform WindowBlock { mat4 projection; mat4 view; } window;
out vec2 uv;
void main() {
    uv = place / vec2(320.0, 240.0);
    gl_Position = window.projection * window.view * vec4(place, 0.0, 1.0);
}
"""
CACHE_FRAGMENT = """#version 330 core
in vec2 uv;
uniform sampler2D first;
uniform sampler2D second;
out vec4 color;
void main() {
    color = vec4(texture(first, uv).rgb * 0.6 + texture(second, uv * 3.0).gbr * 0.4, 1.0);
}
"""


class CachingScene:
    """Binds everything once and never again, as engines that cache state do (arcade among them)."""

    def __init__(self, window: pyglet.window.Window) -> None:
        self.opaque = [(200, 40, 100, 120)]
        self.program = ShaderProgram(
            Shader(CACHE_VERTEX, "vertex"), Shader(CACHE_FRAGMENT, "fragment")
        )
        back = (ctypes.c_float * 12)(0, 0, 160, 0, 0, 120, 160, 120, 160, 0, 0, 120)
        x, y, w, h = self.opaque[0]
        right, top = x + w, y + h
        front = (ctypes.c_float * 12)(x, y, right, y, x, top, right, top, right, y, x, top)
        self.buffer, self.array = gl.GLuint(), gl.GLuint()
        gl.glGenVertexArrays(1, self.array)
        gl.glGenBuffers(1, self.buffer)
        gl.glBindVertexArray(self.array)
        gl.glBindBuffer(gl.GL_ARRAY_BUFFER, self.buffer)
        data = bytes(back) + bytes(front)
        gl.glBufferData(gl.GL_ARRAY_BUFFER, len(data), data, gl.GL_STATIC_DRAW)
        place = self.program.attributes["place"]["location"]
        gl.glEnableVertexAttribArray(place)
        gl.glVertexAttribPointer(place, 2, gl.GL_FLOAT, gl.GL_FALSE, 8, 0)
        self.textures = [picture(64, 64, False).get_texture() for _ in range(2)]
        self.sampler = gl.GLuint()
        gl.glGenSamplers(1, self.sampler)
        gl.glSamplerParameteri(self.sampler, gl.GL_TEXTURE_WRAP_S, gl.GL_MIRRORED_REPEAT)
        self.program.use()
        for unit, name in ((5, "first"), (1, "second")):
            self.program[name] = unit
            gl.glActiveTexture(gl.GL_TEXTURE0 + unit)
            gl.glBindTexture(gl.GL_TEXTURE_2D, self.textures[unit // 5].id)
        gl.glBindSampler(1, self.sampler)
        gl.glActiveTexture(gl.GL_TEXTURE3)
        gl.glDisable(gl.GL_BLEND)
        gl.glDisable(gl.GL_DEPTH_TEST)

    def before(self, frame: int) -> None:
        gl.glDrawArrays(gl.GL_TRIANGLES, 0, 6)

    def after(self, frame: int) -> None:
        gl.glDrawArrays(gl.GL_TRIANGLES, 6, 6)


MODERN_VERTEX = """#version 330 core
in vec2 place;
uniform Look { vec4 tint; vec4 offset; };
out vec2 uv;
void main() {
    uv = place * 0.5 + 0.5;
    gl_Position = vec4(place * 0.5 + offset.xy, offset.z, 1.0);
}
"""
MODERN_FRAGMENT = """#version 330 core
in vec2 uv;
uniform sampler2D image;
uniform Look { vec4 tint; vec4 offset; };
out vec4 color;
void main() { color = vec4(tint.rgb * texture(image, uv).rgb, tint.a); }
"""


class ModernGLScene:
    """A moderngl renderer with an off-screen target bound, scissor on and odd functions set."""

    def __init__(self, window: pyglet.window.Window) -> None:
        self.opaque = [(20, 20, 60, 40)]
        # Where, in even frames, its quad stands so near that no rain can be in front of it.
        self.nearer = (30, 115, 130, 100)
        self.ctx = ctx = moderngl.get_context()
        self.size = size = window.get_framebuffer_size()
        self.program = ctx.program(vertex_shader=MODERN_VERTEX, fragment_shader=MODERN_FRAGMENT)
        self.program["Look"].binding = 7  # type: ignore[union-attr]
        self.program["image"] = 4
        corners = np.array([-1, -1, 1, -1, -1, 1, 1, 1], "f4")
        self.corners = ctx.buffer(corners.tobytes())
        self.array = ctx.vertex_array(self.program, [(self.corners, "2f", "place")])
        looks = np.zeros((4, 64), "f4")  # 256 bytes apart
        looks[0, :8] = 0.8, 0.5, 0.3, 1.0, -0.4, 0.4, -0.999, 0
        looks[1, :8] = 0.2, 0.7, 0.9, 0.5, 0.3, 0.2, 0.4, 0
        self.looks = ctx.buffer(looks.tobytes())
        # Blocks wherever a guest might put its own.
        self.others = [ctx.buffer(reserve=64) for _ in range(3)]
        self.image = ctx.texture((16, 16), 4, picture(16, 16, False).get_data("RGBA", 64))
        self.color = ctx.texture(size, 4)
        self.target = ctx.framebuffer([self.color], ctx.depth_renderbuffer(size))
        self.screen = ctx.detect_framebuffer()

    def before(self, frame: int) -> None:
        ctx = self.ctx
        self.target.use()
        ctx.scissor = None
        ctx.clear(0.1, 0.12, 0.15, 1.0)
        ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND | moderngl.CULL_FACE)
        ctx.depth_func = "1"
        ctx.blend_func = moderngl.ONE_MINUS_DST_COLOR, moderngl.ONE, moderngl.ONE, moderngl.ZERO
        ctx.blend_equation = moderngl.FUNC_ADD, moderngl.MAX
        ctx.cull_face = "front"
        ctx.front_face = "cw"
        self.image.use(4)
        for i, buffer in enumerate(self.others):
            buffer.bind_to_uniform_block((1, 14, 30)[i])
        self.looks.bind_to_uniform_block(7, 256 * (frame % 2), 32)
        ctx.scissor = 5, 7, self.size[0] - 30, self.size[1] - 20
        self.array.render(moderngl.TRIANGLE_STRIP)

    def after(self, frame: int) -> None:
        ctx = self.ctx
        assert ctx.fbo is self.target, "moderngl believes another framebuffer is bound"
        self.array.render(moderngl.TRIANGLE_STRIP)  # the same blend, depth and block again
        x, y, w, h = self.opaque[0]
        ctx.scissor = x, y, w, h
        ctx.clear(0.9, 0.2, 0.1, 1.0)  # what moderngl holds for the bound framebuffer
        ctx.scissor = None
        self.screen.use()
        gl.glBindFramebuffer(gl.GL_READ_FRAMEBUFFER, self.target.glo)
        box = (0, 0, *self.size)
        gl.glBlitFramebuffer(*box, *box, gl.GL_COLOR_BUFFER_BIT, gl.GL_NEAREST)
        gl.glBindFramebuffer(gl.GL_READ_FRAMEBUFFER, 0)


SCENES: dict[str, type[Any]] = {
    "pyglet": PygletScene,
    "caching": CachingScene,
    "moderngl": ModernGLScene,
}
