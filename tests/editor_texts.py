"""A file with comments of its own, and documents opened from it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from weather_ecs.components import Fog
from weather_ecs.editor.document import Document
from weather_ecs.editor.files import Files

WRITTEN = """# An evening by the sea
# made by hand

version = 2  # the format's
x_author = "me"

# The tall one.
[[models]]   # first
name = "tower"  # its name
size_max = 200
light_penetration = inf
x_note = "keep"

  # its lower box
[[models.seeds]]
center = [0, 50.5, 0]  # m
# below the centre

[[models.seeds.roots]]
pitch = 90

[[models.seeds]]
width = 250

[models.x_own]
a = 1

# ==== the flat one ====

[[models]]
name = "flat"
images = [
  "sheet",  # grey
  "wisp_1",
]
seeds = [ {height = 5e-1, x_q = 3, roots = [{pitch = 5}]} ]

[[layers]]
base = 1500
climate.duration = 5
[[layers.skies]]
state = 0.0
[[layers.skies]]
state = 1.0 # storm
models = ["flat", "cumulus"]
count = 30

[climate]
duration = 120.5 # s

# the end
"""


def opened(files: Files, path: Path) -> Document:
    document = Document()
    files.open(document, path)
    return document


def with_fog(document: Document, visibility: float = 500.0) -> None:
    document.apply("Fog", replace(document.content, fog=Fog(visibility)))
