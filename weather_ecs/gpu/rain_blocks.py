"""The uniform blocks of the rain: declared here once, used by numpy and by GLSL."""

from __future__ import annotations

from weather_ecs.gpu.blocks import UniformBlock

MAX_LIGHTS = 8

# One step of a container's drops; physics/rain_step.Step field for field.
RAIN_STEP = UniformBlock(
    "RainStep",
    ("from_axis", "vec4"),  # centre x, centre z, cos heading, sin heading
    ("from_shape", "vec4"),  # forward reach, lateral reach, bottom, height
    ("to_axis", "vec4"),
    ("to_shape", "vec4"),
    ("rain_law", "vec4"),
    ("rain_dt", "float"),  # s, of the step
    ("rain_seed", "uint"),
    ("rain_count", "uint"),
    ("rain_fresh", "uint"),  # drops from here on begin anew
    ("rain_time", "float"),  # s, the weather's clock at the end of the step, in its epoch
    ("impact_capacity", "uint"),  # of the list of impacts; 0: there is none
)
STEP = RAIN_STEP.run(*[field.name for field in RAIN_STEP.fields])

# The camera and the light, the same for all that is drawn in one view.
RAIN_VIEW = UniformBlock(
    "RainView",
    ("view_projection", "mat4"),
    ("camera_position", "vec4"),  # m, and pixels per unit of width over depth
    ("camera_velocity", "vec4"),  # m/s, and the exposure in s
    ("camera_forward", "vec4"),  # unit
    ("view_size", "vec4"),  # pixels, width and height; depth of the near and far plane
    ("view_origin", "vec4"),  # pixels, lower left corner of the viewport
    ("view_depth", "vec4"),  # depth = y / (ndc + x)
    # s, the weather's clock in its epoch, see impact_times.py; of it since the last view; in the
    # time after which all flakes have turned as they had
    ("view_time", "vec4"),
    ("sun_direction", "vec4"),
    ("sun_color", "vec4"),
    ("drop_color", "vec4"),  # what a drop shows of the sky, linear
    ("veil_color", "vec4"),  # encoded
    ("fog_color", "vec4"),  # linear; 1/m times log2(e), of the air without rain and snow
    ("fog_shown", "vec4"),  # the same colour encoded; m of fog overhead
    ("light_position", "vec4", MAX_LIGHTS),  # m, and reach
    ("light_color", "vec4", MAX_LIGHTS),
    ("flash_direction", "vec4"),  # unit, from the camera to the lightning
    ("flash_color", "vec4"),  # linear, at the camera; 0 while there is none
    ("light_count", "int"),
)

# One container's drops as they are drawn.
RAIN_DRAW = UniformBlock(
    "RainDraw",
    ("container_axis", "vec4"),
    ("container_shape", "vec4"),
    ("area_axis", "vec4"),
    ("area_shape", "vec4"),  # a, b, soft edge, ceiling
    ("drop_law", "vec4"),
    ("drop_load", "vec4"),  # load, count, 1 / width of the count's fade, density (look)
    ("drop_look", "vec4"),  # Eq. 3's maximum, size scale, width, opacity
    ("drop_dry", "vec4"),  # s, fall times of the drops that are missing; see rain_front.glsl
)
DRAW = RAIN_DRAW.run(*[field.name for field in RAIN_DRAW.fields])

# The collision heightmap of one observer.
SHELTER = UniformBlock(
    "Shelter",
    ("shelter_matrix", "mat4"),  # world to (u, v, depth) in [0, 1]
    ("shelter_size", "vec4"),  # texels on a side, height span in m, a texel in m
    ("shelter_fall", "vec4"),  # horizontal m per m of fall, x and z
)
