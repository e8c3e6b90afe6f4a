"""What clouds are drawn with: made with the first of them, all of it or nothing."""

from __future__ import annotations

from contextlib import ExitStack
from typing import NamedTuple, Protocol, TypeVar

import moderngl

from weather_ecs.gpu.cloud_canvas import CloudCanvases
from weather_ecs.gpu.cloud_inside import CloudInside
from weather_ecs.gpu.cloud_programs import UNITS, CloudPrograms
from weather_ecs.gpu.cloud_rays import CloudRays
from weather_ecs.gpu.cloud_store import CloudStore
from weather_ecs.gpu.cloud_stream import CloudStream
from weather_ecs.gpu.row_texture import RowTexture
from weather_ecs.gpu.shader_loader import ShaderLoader


class Releasable(Protocol):
    """What holds OpenGL objects."""

    def release(self) -> object: ...


Thing = TypeVar("Thing", bound=Releasable)


class CloudSettings(Protocol):
    """What the clouds need of the quality settings."""

    @property
    def cloud_billboards(self) -> int: ...
    @property
    def cloud_impostors(self) -> int: ...
    @property
    def cloud_tile(self) -> int: ...
    @property
    def cloud_atlas(self) -> int: ...


class CloudKit(NamedTuple):
    """The parts, in the order in which they are made."""

    store: CloudStore
    programs: CloudPrograms
    stream: CloudStream
    rows: RowTexture
    quads: RowTexture
    rays: CloudRays
    inside: CloudInside
    canvases: CloudCanvases

    def release(self) -> None:
        """Give everything back."""
        for part in self[::-1]:
            part.release()


def make_kit(ctx: moderngl.Context, shaders: ShaderLoader) -> CloudKit:
    """Make all parts; if one fails, the others are given back."""
    with ExitStack() as undo:

        def kept(thing: Thing) -> Thing:
            undo.callback(thing.release)
            return thing

        kit = CloudKit(
            kept(CloudStore(ctx)),
            kept(CloudPrograms(ctx, shaders)),
            kept(CloudStream(ctx)),
            kept(RowTexture(ctx, 6)),
            kept(RowTexture(ctx, 9)),
            kept(CloudRays(ctx, shaders, UNITS)),
            kept(CloudInside(ctx, shaders)),
            kept(CloudCanvases(ctx, shaders)),
        )
        undo.pop_all()
    return kit
