"""The uniform blocks of the ripples: declared here once, used by numpy and by GLSL."""

from __future__ import annotations

from weather_ecs.gpu.blocks import UniformBlock

MAX_AREAS = 4

# The grid of one surface for one step; also its source pass.
RIPPLE_GRID = UniformBlock(
    "RippleGrid",
    ("ripple_frame", "vec4"),  # centre x, z, m; cos, sin of the heading
    ("ripple_cells", "vec4"),  # cells along and across, a cell in m, height of the water in m
    ("ripple_hold", "vec4"),  # 1 where the border is held at 0, along, across; 1: ellipse is held
    ("ripple_body", "vec4"),  # half sizes of the water, along and across, m; 1 for an ellipse
    ("ripple_window", "vec4"),  # middle and half sizes of what is computed, own axes, m
    ("ripple_law", "vec4"),  # kept share, threshold in mm; ages in s from which, up to which
)

# How one surface is drawn.
RIPPLE_SHEET = UniformBlock(
    "RippleSheet",
    ("sheet_frame", "vec4"),  # centre x, z, m; cos, sin of the heading
    ("sheet_body", "vec4"),  # half sizes, m; height in m; 1 for an ellipse
    ("sheet_color", "vec4"),  # linear RGB of deep water, lit; 1 / clarity in 1/m
    ("sheet_zenith", "vec4"),  # linear RGB
    ("sheet_horizon", "vec4"),  # linear RGB
    ("sheet_window", "vec4"),  # middle and half sizes of what is computed, own axes, m
    ("sheet_area_axis", "vec4", MAX_AREAS),  # of the rain areas
    ("sheet_area_shape", "vec4", MAX_AREAS),
    ("sheet_area_rough", "vec4", MAX_AREAS),  # x: slope of the water under the area's full rain
    ("sheet_areas", "int"),
)
