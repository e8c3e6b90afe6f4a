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

from weather_ecs.frame import ViewData
from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.heightmap import Heightmap
from weather_ecs.gpu.rain_pass import SHELTER_UNIT
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.wetness_block import AGES, COUNTS, PLACES, STEP, fill_areas
from weather_ecs.gpu.wetness_far import HALF, WATCHED, FarField, rains_within, wet_within
from weather_ecs.gpu.wetness_map import WetnessMap
from weather_ecs.physics.footprint import Footprint
from weather_ecs.physics.snow_cover import melt_rate
from weather_ecs.physics.wet_map import BANDS, RINGS, MapPlace, place_over

ROUND = 1.2  # s in which every band has its turn
LONGEST = 5.0  # s without an update, after which the map begins anew
DRY_AFTER = 1800.0  # s without rain after which nothing is left to dry
STATIC_UNIT, BEFORE_UNIT, FAR_UNIT = 2, 3, 4

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
    over: Footprint | None = None  # that `place` lies over
    times: list[float] = field(default_factory=lambda: [0.0] * BANDS)
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
        place = seen.place
        if place is None or heightmap.footprint is not seen.over:
            place = place_over(heightmap.footprint, heightmap.size)
            seen.over = heightmap.footprint
        number = frame.wetness.number if frame.wetness is not None else 0
        fresh = seen.place is None or seen.place.size != place.size or number != seen.number
        if fresh or not 0.0 <= frame.time - seen.time <= LONGEST:
            self._resize(seen, place.size)
            seen.place, seen.number = None, number
        moves = place is not seen.place and place != seen.place
        if not moves and frame.time == seen.time:
            return
        if self._program is None:
            self._make_program()
        self._fill(seen, view, heightmap, place)
        heightmap.static_texture.use(STATIC_UNIT)
        heightmap.texture.use(SHELTER_UNIT)
        seen.far.texture.use(FAR_UNIT)
        self._ctx.enable_only(moderngl.NOTHING)
        if moves:
            self._render(seen, 1 - seen.current, 0, place.size)
            seen.current = 1 - seen.current
            seen.times = [frame.time] * BANDS
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
        old, texel, now = seen.place, 2.0 * footprint.half / heightmap.size, frame.time
        share, melt = frame.air.snow_share, _melt_rate(frame.air.wet_bulb)
        x, z = footprint.center
        block.put(
            PLACES,
            *(*place.center, place.texel, place.size),
            *((*old.center, old.texel, old.size) if old else (0.0, 0.0, 1.0, 0.0)),
            *(*(old.slope if old else place.slope), 0.0, 0.0),
            *(x - footprint.half, z - footprint.half, 1.0 / texel, 0.0),
            *(footprint.top, 0.0, 0.0, 0.0),
            *(share, melt, share * frame.flakes.settling, 0.0),
            *(*seen.far.middle, 0.5 / HALF, 0.0),
        )
        block.put(AGES, *[now - time for time in seen.times])
        rings = [max(round(radius / texel), 1) for radius in RINGS]
        block.put(COUNTS, fill_areas(block, view), place.rows, *rings)
        block.upload()
        block.bind()

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
