"""What a game's own program reads of the weather: maps on texture units, and blocks."""

from __future__ import annotations

from typing import Any

import moderngl

from weather_ecs.gpu.blocks import BlockBuffer


def use_maps(program: Any, unit: int, **maps: moderngl.Texture) -> None:
    """Bind textures to units from `unit` on, and point the program's samplers at them by name.

    Names that the shader does not use are left out.
    """
    for number, (name, texture) in enumerate(maps.items(), unit):
        texture.use(number)
        uniform = program.get(name, None)  # `in` goes through all of them
        if uniform is not None:
            uniform.value = number


def use_block(program: Any, buffer: BlockBuffer) -> None:
    """Bind a block to the binding it has, and point the program's at it, if it has one."""
    block = program.get(buffer.block.name, None)
    if block is not None:
        block.binding = buffer.binding
        buffer.bind()
