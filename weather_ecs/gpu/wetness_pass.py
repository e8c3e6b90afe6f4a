"""The wetness map: water and snow on what rain meets first, around every observer.

Bands of rows are brought up to date in turn, all of them within 1.2 s; all at once where the
map moves with its observer, the wind turns or the map begins. The law has a closed form, so that
bands may wait.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.heightmap import Heightmap
from weather_ecs.gpu.rain_pass import SHELTER_UNIT
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.wetness_far import HALF, WATCHED, FarField, rains_within, wet_within
from weather_ecs.gpu.wetness_map import WetnessMap
from weather_ecs.physics.front import SETTLED, steepness
from weather_ecs.physics.snow_cover import melt_rate
from weather_ecs.physics.wet_map import BANDS, RINGS, MapPlace, place_over

MAX_AREAS = 16
ROUND = 1.2  # s in which every band has its turn
LONGEST = 5.0  # s without an update, after which the map begins anew
DRY_AFTER = 1800.0  # s without rain after which nothing is left to dry
STATIC_UNIT, BEFORE_UNIT, FAR_UNIT = 2, 3, 4

STEP = UniformBlock(
    "WetStep",
    ("wet_frame", "vec4"),  # middle, x and z at height 0, a texel, m; texels on a side
    ("wet_old_frame", "vec4"),  # of the map before; 0 texels: there is none
    ("wet_old_fall", "vec4"),
    ("wet_shelter", "vec4"),  # the heightmap's low corner, m; 1 / its texel
    ("wet_heights", "vec4"),  # m, of the heightmap's top
    # Share of what falls that is snow, mm/s of it that melt, times that share that collects.
    ("wet_snow", "vec4"),
    ("wet_far_place", "vec4"),  # middle of the far field, m; 1 / its side
    ("wet_ages", "vec4", BANDS // 4),  # s since each band's last update
    ("wet_area_axis", "vec4", MAX_AREAS),
    ("wet_area_shape", "vec4", MAX_AREAS),
    ("wet_area_rate", "vec4", MAX_AREAS),  # mm/h; slope of the diameters in 1/mm
    ("wet_area_dry", "vec4", MAX_AREAS),  # s, fall times of the drops that are missing
    ("wet_areas", "int"),
    ("wet_bands", "int"),  # rows in a band
    ("wet_rings", "ivec2"),  # texels, radii in which a hollow is looked for
)
KEY = ProgramKey(vertex="fullscreen.vert", fragment="wetness_step.frag")


@dataclass(slots=True)
class _Observed:
    """What belongs to one observer."""

    map: WetnessMap
    far: FarField
    textures: list[moderngl.Texture] = field(default_factory=list)
    targets: list[moderngl.Framebuffer] = field(default_factory=list)
    current: int = 0
    place: MapPlace | None = None
    times: NDArray[np.float64] = field(default_factory=lambda: np.zeros(BANDS))
    band: int = 0
    time: float = -math.inf  # s, of the last update
    number: int = 0  # of the ground the map began with
    wet_until: float = -math.inf


class WetnessPass:
    """Keeps a `WetnessMap` for every observer that asks for one or that it rains on."""

    def __init__(self, ctx: moderngl.Context, gl: GL, shaders: ShaderLoader) -> None:
        self._ctx = ctx
        self._gl = gl
        self._shaders = shaders
        self._observed: dict[int, _Observed] = {}
        self._program: moderngl.Program | None = None

    def map(self, observer: int) -> WetnessMap:
        """What a game's shaders read for an observer."""
        return self._seen(observer).map

    def known(self, observer: int) -> WetnessMap | None:
        """The same, if it is there already."""
        seen = self._observed.get(observer)
        return seen.map if seen is not None else None

    def needs_map(self, view: ViewData) -> bool:
        """Whether there is water on the ground around an observer, or some to come."""
        seen = self._observed.get(view.key)
        if seen is not None and view.frame.time < seen.wet_until:
            return True
        reach = 1.5 * view.frame.heightmap.extent * view.frame.look.reach
        return rains_within(view, reach) or wet_within(view, reach)

    def needs_update(self, view: ViewData) -> bool:
        """Whether there is anything to do for a view; with `needs_map` there is more."""
        seen = self._observed.get(view.key)
        if seen is not None:
            return seen.far.is_due(view)
        return rains_within(view, WATCHED) or wet_within(view, WATCHED)

    def update(self, view: ViewData, heightmap: Heightmap | None) -> None:
        """Bring a part of the map up to date; `heightmap` is captured, its block bound.

        Changes framebuffer, viewport and capabilities: the caller restores them.
        """
        seen, frame = self._seen(view.key), view.frame
        reach = 1.5 * frame.heightmap.extent * frame.look.reach
        if rains_within(view, reach) or wet_within(view, reach):
            seen.wet_until = frame.time + DRY_AFTER
        seen.far.update(view)
        if heightmap is None or heightmap.footprint is None:
            seen.place = None
        else:
            self._update_map(seen, view, heightmap)
        self._publish(seen)

    def _update_map(self, seen: _Observed, view: ViewData, heightmap: Heightmap) -> None:
        frame = view.frame
        assert heightmap.footprint is not None
        place = place_over(heightmap.footprint, heightmap.size)
        number = frame.wetness.number if frame.wetness is not None else 0
        fresh = seen.place is None or seen.place.size != place.size or number != seen.number
        if fresh or not 0.0 <= frame.time - seen.time <= LONGEST:
            self._resize(seen, place.size)
            seen.place, seen.number = None, number
        elif place == seen.place and frame.time == seen.time:
            return
        if self._program is None:
            self._make_program()
        moves = place != seen.place
        self._fill(seen, view, heightmap, place)
        heightmap.static_texture.use(STATIC_UNIT)
        heightmap.texture.use(SHELTER_UNIT)
        seen.far.texture.use(FAR_UNIT)
        self._ctx.enable_only(moderngl.NOTHING)
        if moves:
            self._render(seen, 1 - seen.current, 0, place.size)
            seen.current = 1 - seen.current
            seen.times[:] = frame.time
        else:
            bands = -(-place.size // place.rows)
            due = math.ceil(bands * min((frame.time - seen.time) / ROUND, 1.0))
            for _ in range(due):
                first = seen.band * place.rows
                rows = min(place.rows, place.size - first)
                self._copy(seen, first, rows)
                self._render(seen, seen.current, first, rows)
                seen.times[seen.band] = frame.time
                seen.band = (seen.band + 1) % bands
        heightmap.texture.use(SHELTER_UNIT)
        seen.place, seen.time = place, frame.time

    def _render(self, seen: _Observed, into: int, first: int, rows: int) -> None:
        target = seen.targets[into]
        seen.textures[1 - into].use(BEFORE_UNIT)
        target.use()
        target.viewport = (0, first, target.width, rows)
        self._array.render(moderngl.TRIANGLES, 3)

    def _copy(self, seen: _Observed, first: int, rows: int) -> None:
        """A band of the current texture into the other, from which it is then read."""
        gl, width = self._gl, seen.targets[0].width
        gl.glBindFramebuffer(e.READ_FRAMEBUFFER, seen.targets[seen.current].glo)
        gl.glBindFramebuffer(e.DRAW_FRAMEBUFFER, seen.targets[1 - seen.current].glo)
        box = (0, first, width, first + rows)
        gl.glBlitFramebuffer(*box, *box, e.COLOR_BUFFER_BIT, e.NEAREST)

    def _fill(self, seen: _Observed, view: ViewData, heightmap: Heightmap, place: MapPlace) -> None:
        block, frame, footprint = self._block, view.frame, heightmap.footprint
        assert footprint is not None
        data, old, texel = block.data, seen.place, 2.0 * footprint.half / heightmap.size
        data["wet_frame"] = (*place.center, place.texel, place.size)
        data["wet_old_frame"] = (*old.center, old.texel, old.size) if old else (0.0, 0.0, 1.0, 0.0)
        data["wet_old_fall"] = (*(old.slope if old else place.slope), 0.0, 0.0)
        low = [c - footprint.half for c in footprint.center]
        data["wet_shelter"] = (*low, 1.0 / texel, 0.0)
        data["wet_heights"] = (footprint.top, 0.0, 0.0, 0.0)
        share, melt = frame.air.snow_share, _melt_rate(frame.air.wet_bulb)
        data["wet_snow"] = (share, melt, share * frame.flakes.settling, 0.0)
        data["wet_far_place"] = (*seen.far.middle, 0.5 / HALF, 0.0)
        block["wet_ages"].reshape(-1)[:] = np.maximum(frame.time - seen.times, 0.0)
        data["wet_bands"] = place.rows
        data["wet_rings"] = [max(round(radius / texel), 1) for radius in RINGS]
        data["wet_areas"] = self._fill_areas(view)
        block.upload()
        block.bind()

    def _fill_areas(self, view: ViewData) -> int:
        """The areas that rain, at most MAX_AREAS, the nearest; returns how many they are."""
        frame, data = view.frame, self._block.data
        areas = frame.areas[frame.areas["rain_rate"] > 0.0]
        if len(areas) > MAX_AREAS:
            away = np.linalg.norm(areas["center"] - np.array(view.position)[[0, 2]], axis=1)
            areas = areas[np.argsort(away - areas["radii"][:, 0], kind="stable")[:MAX_AREAS]]
        for k, row in enumerate(areas.tolist()):
            key, (x, z), (a, b), heading, rate, soft, ceiling = row
            data["wet_area_axis"][k] = (x, z, math.cos(heading), math.sin(heading))
            data["wet_area_shape"][k] = (a, b, min(soft, b), ceiling)
            data["wet_area_rate"][k, :2] = (rate, steepness(rate))
            data["wet_area_dry"][k] = frame.fronts.get(key, SETTLED)
        return len(areas)

    def _publish(self, seen: _Observed) -> None:
        far, place = (*seen.far.middle, 2.0 * HALF), seen.place
        if place is None:
            seen.map.set((0.0, 0.0, 1.0), None, far)
        else:
            seen.map.set((*place.center, place.texel * place.size), place.slope, far)
            seen.map.texture = seen.textures[seen.current]
        seen.map.far = seen.far.texture

    def _seen(self, observer: int) -> _Observed:
        seen = self._observed.get(observer)
        if seen is None:
            seen = _Observed(WetnessMap(self._ctx), FarField(self._ctx))
            self._observed[observer] = seen
        return seen

    def _make_program(self) -> None:
        self._program = program = self._shaders.program(KEY)
        units = {
            "shelter_map": STATIC_UNIT,
            "wet_cover": SHELTER_UNIT,
            "wet_before": BEFORE_UNIT,
            "wet_far": FAR_UNIT,
        }
        for name, unit in units.items():
            program[name] = unit
        self._array = self._ctx.vertex_array(program, [])
        self._block = BlockBuffer(self._ctx, STEP)

    def _resize(self, seen: _Observed, size: int) -> None:
        if seen.textures and seen.textures[0].width == size:
            return
        _drop_map(seen)
        for _ in range(2):
            texture = self._ctx.texture((size, size), 4, dtype="f4")
            texture.filter = moderngl.LINEAR, moderngl.LINEAR
            texture.repeat_x = texture.repeat_y = False
            seen.textures.append(texture)
            seen.targets.append(self._ctx.framebuffer([texture]))

    def forget(self, observer: int) -> None:
        """Give back what belongs to an observer who is gone."""
        seen = self._observed.pop(observer, None)
        if seen is not None:
            _drop_map(seen)
            seen.far.release()
            seen.map.release()

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for observer in list(self._observed):
            self.forget(observer)
        if self._program is not None:
            self._array.release()
            self._block.release()
            self._program = None


@lru_cache(maxsize=8)
def _melt_rate(wet_bulb: float) -> float:
    return float(melt_rate(wet_bulb))


def _drop_map(seen: _Observed) -> None:
    for target in seen.targets:
        target.release()
    for texture in seen.textures:
        texture.release()
    seen.targets.clear()
    seen.textures.clear()
    seen.place = None
