"""Uniform blocks of the clouds: declared here once, used by numpy and by GLSL."""

from __future__ import annotations

from weather_ecs.gpu.blocks import UniformBlock
from weather_ecs.gpu.flash import CLOUD_LIGHTS
from weather_ecs.physics.high_sun import LEVELS

CLOUD_VIEW = UniformBlock(
    "CloudView",
    ("cloud_sun", "vec4"),  # unit, towards the sun; m over the ground, of the camera
    ("cloud_suns", "vec4", LEVELS),  # of the sun by height, physics/high_sun.py
    ("cloud_sun_color", "vec4"),  # linear, as all here
    ("cloud_above", "vec4"),  # light of the sky from above
    ("cloud_below", "vec4"),  # light from the ground and the air below
    ("cloud_ambient", "vec4"),  # of the plain model
    ("cloud_look", "vec4"),  # lining, bases, ambient; 1 for the plain model
    ("cloud_depth", "vec4"),  # depth = y / (ndc + x)
    ("cloud_flash_at", "vec4", CLOUD_LIGHTS),  # m from the camera; 1/m2, of the core
    ("cloud_flash_color", "vec4", CLOUD_LIGHTS),
    ("cloud_flashes", "int"),
    ("cloud_softness", "float"),
)
