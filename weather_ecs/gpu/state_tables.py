"""The OpenGL state a guest has to put back, as tables.

A row of values: the function that sets it, its leading arguments, the state values that are its
other arguments (name, count), and the arguments that make the guest's baseline (None: as found).
"""

from __future__ import annotations

from typing import TypeAlias

from weather_ecs.gpu import gl_enums as e

Row: TypeAlias = tuple[str, tuple[int, ...], tuple[tuple[int, int], ...], tuple[float, ...] | None]

INTEGERS: tuple[Row, ...] = (
    ("glUseProgram", (), ((e.CURRENT_PROGRAM, 1),), None),
    ("glBindVertexArray", (), ((e.VERTEX_ARRAY_BINDING, 1),), (0,)),
    ("glBindBuffer", (e.ARRAY_BUFFER,), ((e.ARRAY_BUFFER_BINDING, 1),), None),
    ("glBindBuffer", (e.UNIFORM_BUFFER,), ((e.UNIFORM_BUFFER_BINDING, 1),), None),
    ("glBindBuffer", (e.COPY_READ_BUFFER,), ((e.COPY_READ_BUFFER, 1),), None),
    ("glBindBuffer", (e.COPY_WRITE_BUFFER,), ((e.COPY_WRITE_BUFFER, 1),), None),
    # A pixel buffer left bound would turn the addresses of uploads and reads into offsets.
    ("glBindBuffer", (e.PIXEL_PACK_BUFFER,), ((e.PIXEL_PACK_BUFFER_BINDING, 1),), (0,)),
    ("glBindBuffer", (e.PIXEL_UNPACK_BUFFER,), ((e.PIXEL_UNPACK_BUFFER_BINDING, 1),), (0,)),
    ("glBindBuffer", (e.TEXTURE_BUFFER,), ((e.TEXTURE_BUFFER, 1),), None),
    (
        "glBindBuffer",
        (e.TRANSFORM_FEEDBACK_BUFFER,),
        ((e.TRANSFORM_FEEDBACK_BUFFER_BINDING, 1),),
        None,
    ),
    ("glBindBuffer", (e.DRAW_INDIRECT_BUFFER,), ((e.DRAW_INDIRECT_BUFFER_BINDING, 1),), None),
    (
        "glBindBuffer",
        (e.DISPATCH_INDIRECT_BUFFER,),
        ((e.DISPATCH_INDIRECT_BUFFER_BINDING, 1),),
        None,
    ),
    ("glBindBuffer", (e.SHADER_STORAGE_BUFFER,), ((e.SHADER_STORAGE_BUFFER_BINDING, 1),), None),
    ("glBindBuffer", (e.QUERY_BUFFER,), ((e.QUERY_BUFFER_BINDING, 1),), (0,)),
    ("glBindRenderbuffer", (e.RENDERBUFFER,), ((e.RENDERBUFFER_BINDING, 1),), None),
    ("glBindFramebuffer", (e.READ_FRAMEBUFFER,), ((e.READ_FRAMEBUFFER_BINDING, 1),), None),
    ("glBindFramebuffer", (e.DRAW_FRAMEBUFFER,), ((e.DRAW_FRAMEBUFFER_BINDING, 1),), None),
    ("glViewport", (), ((e.VIEWPORT, 4),), None),
    ("glScissor", (), ((e.SCISSOR_BOX, 4),), None),
    (
        "glBlendFuncSeparate",
        (),
        (
            (e.BLEND_SRC_RGB, 1),
            (e.BLEND_DST_RGB, 1),
            (e.BLEND_SRC_ALPHA, 1),
            (e.BLEND_DST_ALPHA, 1),
        ),
        (e.SRC_ALPHA, e.ONE_MINUS_SRC_ALPHA, e.SRC_ALPHA, e.ONE_MINUS_SRC_ALPHA),
    ),
    (
        "glBlendEquationSeparate",
        (),
        ((e.BLEND_EQUATION_RGB, 1), (e.BLEND_EQUATION_ALPHA, 1)),
        (e.FUNC_ADD, e.FUNC_ADD),
    ),
    ("glColorMask", (), ((e.COLOR_WRITEMASK, 4),), (1, 1, 1, 1)),
    ("glDepthMask", (), ((e.DEPTH_WRITEMASK, 1),), (1,)),
    ("glDepthFunc", (), ((e.DEPTH_FUNC, 1),), (e.LEQUAL,)),
    ("glCullFace", (), ((e.CULL_FACE_MODE, 1),), (e.BACK,)),
    ("glFrontFace", (), ((e.FRONT_FACE, 1),), (e.CCW,)),
    ("glPolygonMode", (e.FRONT_AND_BACK,), ((e.POLYGON_MODE, 1),), (e.FILL,)),
    ("glLogicOp", (), ((e.LOGIC_OP_MODE, 1),), None),
    ("glProvokingVertex", (), ((e.PROVOKING_VERTEX, 1),), (e.LAST_VERTEX_CONVENTION,)),
    ("glPrimitiveRestartIndex", (), ((e.PRIMITIVE_RESTART_INDEX, 1),), (-1,)),
    ("glPixelStorei", (e.UNPACK_ALIGNMENT,), ((e.UNPACK_ALIGNMENT, 1),), (1,)),
    ("glPixelStorei", (e.UNPACK_ROW_LENGTH,), ((e.UNPACK_ROW_LENGTH, 1),), (0,)),
    ("glPixelStorei", (e.UNPACK_SKIP_ROWS,), ((e.UNPACK_SKIP_ROWS, 1),), (0,)),
    ("glPixelStorei", (e.UNPACK_SKIP_PIXELS,), ((e.UNPACK_SKIP_PIXELS, 1),), (0,)),
    ("glPixelStorei", (e.UNPACK_SKIP_IMAGES,), ((e.UNPACK_SKIP_IMAGES, 1),), (0,)),
    ("glPixelStorei", (e.UNPACK_IMAGE_HEIGHT,), ((e.UNPACK_IMAGE_HEIGHT, 1),), (0,)),
    ("glPixelStorei", (e.PACK_ALIGNMENT,), ((e.PACK_ALIGNMENT, 1),), (1,)),
    ("glPixelStorei", (e.PACK_ROW_LENGTH,), ((e.PACK_ROW_LENGTH, 1),), (0,)),
    ("glPixelStorei", (e.PACK_SKIP_ROWS,), ((e.PACK_SKIP_ROWS, 1),), (0,)),
    ("glPixelStorei", (e.PACK_SKIP_PIXELS,), ((e.PACK_SKIP_PIXELS, 1),), (0,)),
)

# Values no pass changes: set to the baseline, and put back, only where the host has another.
UNCHANGED = frozenset(
    {
        e.UNPACK_ROW_LENGTH,
        e.UNPACK_SKIP_ROWS,
        e.UNPACK_SKIP_PIXELS,
        e.UNPACK_SKIP_IMAGES,
        e.UNPACK_IMAGE_HEIGHT,
        e.PACK_ROW_LENGTH,
        e.PACK_SKIP_ROWS,
        e.PACK_SKIP_PIXELS,
        e.QUERY_BUFFER_BINDING,
    }
)

FLOATS: tuple[Row, ...] = (
    ("glBlendColor", (), ((e.BLEND_COLOR, 4),), None),
    ("glClearColor", (), ((e.COLOR_CLEAR_VALUE, 4),), None),
    ("glPolygonOffset", (), ((e.POLYGON_OFFSET_FACTOR, 1), (e.POLYGON_OFFSET_UNITS, 1)), None),
    ("glLineWidth", (), ((e.LINE_WIDTH, 1),), None),
    ("glPointSize", (), ((e.POINT_SIZE, 1),), None),
)

DOUBLES: tuple[Row, ...] = (
    ("glDepthRange", (), ((e.DEPTH_RANGE, 2),), (0.0, 1.0)),
    ("glClearDepth", (), ((e.DEPTH_CLEAR_VALUE, 1),), None),
)

# Capabilities the passes may switch, with their baseline (None: as found).
SWITCHES: tuple[tuple[int, bool | None], ...] = (
    (e.BLEND, False),
    (e.DEPTH_TEST, False),
    (e.CULL_FACE, False),
    (e.STENCIL_TEST, False),
    (e.SCISSOR_TEST, False),
    (e.RASTERIZER_DISCARD, False),
    (e.PROGRAM_POINT_SIZE, False),
    (e.POLYGON_OFFSET_FILL, False),
    (e.DEPTH_CLAMP, False),
    (e.PRIMITIVE_RESTART, False),
    (e.MULTISAMPLE, True),
    (e.FRAMEBUFFER_SRGB, None),  # the host's choice of what its colours mean
    (e.TEXTURE_CUBE_MAP_SEAMLESS, True),
)

# Capabilities no pass switches on: off while the guest draws, put back where they were on.
FOREIGN: tuple[int, ...] = (
    e.COLOR_LOGIC_OP,
    e.POLYGON_OFFSET_POINT,
    e.POLYGON_OFFSET_LINE,
    e.SAMPLE_ALPHA_TO_COVERAGE,
    e.SAMPLE_ALPHA_TO_ONE,
    e.SAMPLE_COVERAGE,
    e.SAMPLE_MASK,
    e.PRIMITIVE_RESTART_FIXED_INDEX,
    *(e.CLIP_DISTANCE0 + index for index in range(8)),
)

# Targets of textures that passes sample, each with the name of its binding.
TEXTURES: tuple[tuple[int, int], ...] = (
    (e.TEXTURE_2D, e.TEXTURE_BINDING_2D),
    (e.TEXTURE_2D_ARRAY, e.TEXTURE_BINDING_2D_ARRAY),
)
# More that moderngl may make, on its own unit only.
MADE: tuple[tuple[int, int], ...] = (
    (e.TEXTURE_3D, e.TEXTURE_BINDING_3D),
    (e.TEXTURE_CUBE_MAP, e.TEXTURE_BINDING_CUBE_MAP),
    (e.TEXTURE_2D_MULTISAMPLE, e.TEXTURE_BINDING_2D_MULTISAMPLE),
)
