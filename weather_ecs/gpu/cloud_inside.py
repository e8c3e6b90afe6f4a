"""The inside of a cloud: the white that its droplets put before a camera that flies through it."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu.cloud_scene import CloudScene
from weather_ecs.gpu.cloud_store import CloudStore
from weather_ecs.gpu.cloud_stream import eyes_in_shapes
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.view_block import encode
from weather_ecs.physics.cloud_light import Surround, depth_inside, inside_light

VEIL = ProgramKey(vertex="cloud_inside.vert", fragment="cloud_inside.frag")
FREE = 12.0  # m, to which one sees one's own wings
DENSEST = 0.94  # opacity of it


class CloudInside:
    """One triangle over the picture, where the camera is in a cloud."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._program = shaders.program(VEIL)
        self._array = ctx.vertex_array(self._program, [])
        self._color = np.zeros(4)

    def update(self, view: ViewData, scene: CloudScene, store: CloudStore, light: Surround) -> bool:
        """Find out how deep the camera is in which cloud; whether it is in any."""
        self._color[:] = 0.0
        near = np.flatnonzero(scene.visible & (scene.away < scene.reach))
        if view.frame.cloud_look.plain:
            near = near[:0]
        height = view.position[1] - view.frame.profile.ground
        eyes = eyes_in_shapes(scene.center[near], scene.clouds[near])
        shapes = scene.shapes[near]
        within = ((eyes > store.low[shapes]) & (eyes < store.high[shapes])).all(axis=1)
        for index, eye in zip(near[within].tolist(), eyes[within], strict=True):
            cloud = scene.clouds[index]
            shape = store.shapes[int(scene.shapes[index])]
            deep, seed = depth_inside(eye, shape.data.centers, shape.data.sizes)
            share = deep * float(cloud["growth"]) ** 2 * float(cloud["opacity"])
            share *= DENSEST * float(shape.data.billboards["opacity"][:64].mean())
            if share > self._color[3]:
                lost = float(shape.data.absorbed[seed])
                look = view.frame.cloud_look.ambient
                color = inside_light(light, lost, look, float(cloud["darkness"]), height)
                flash = float(cloud["flash"]) * np.array([0.86, 0.90, 1.0])
                self._color[:3], self._color[3] = encode(color + flash), share
        return bool(self._color[3] > 0.002)

    def draw(self, projection: NDArray) -> None:
        """Premultiplied blending and the depth test are the caller's; what is close stays free."""
        clip = projection @ np.array([0.0, 0.0, -FREE, 1.0])
        self._program["inside_depth"] = float(np.clip(clip[2] / clip[3], -1.0, 0.999999))
        red, green, blue, alpha = self._color.tolist()
        self._program["inside_color"] = (red * alpha, green * alpha, blue * alpha, alpha)
        self._array.render(moderngl.TRIANGLES, vertices=3)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self._array.release()
