"""`CloudField`: the clouds of all layers and the rain they carry; part of the weather's state."""

from __future__ import annotations

from typing import Any

from weather_ecs.components._base import FAR, integer, number, vector
from weather_ecs.errors import InvalidValueError
from weather_ecs.systems.cloud_layer import Box, LayerClouds
from weather_ecs.systems.cloud_mix import Chooser, rows, text
from weather_ecs.systems.cloud_pack import GREATEST, pack, unpack

Key = tuple[int, int]  # uid of the layer and serial, or uid of the cloud and -1

_check_whole = integer(0, GREATEST)
_check_serial = integer(-1, GREATEST)
_check_offset = vector(2, -1.0e15, 1.0e15)
_check_speed = vector(2, -1.0e6, 1.0e6)
_check_center = number(-FAR, FAR)
_check_side = number(1.0, FAR)
_check_credit = number(0.0, 1.0e9)
_check_sky = number(0.0, 1.0)
_FIELDS = {
    "box",
    "change",
    "chooser",
    "clouds",
    "due",
    "known",
    "least",
    "offset",
    "serial",
    "ticks",
    "uid",
    "velocity",
    "wind",
}


class CloudField:
    """What a snapshot has to hold of the clouds."""

    __slots__ = ("layers", "rain")

    def __init__(self) -> None:
        self.layers: dict[int, LayerClouds] = {}  # by uid
        self.rain: dict[Key, int] = {}  # uids of the rain areas that clouds carry

    @property
    def standing(self) -> int:
        """Clouds of the layers that are not dissolving."""
        return sum(layer.array.standing for layer in self.layers.values())

    # For snapshots

    def state(self) -> dict[str, Any]:
        """All there is to it, as plain values."""
        return {
            "layers": [_layer_state(layer) for _, layer in sorted(self.layers.items())],
            "rain": [[*key, uid] for key, uid in sorted(self.rain.items())],
        }

    @classmethod
    def from_state(cls, state: Any, seed: int) -> CloudField:
        """The field that `state` was taken of. Raises InvalidValueError for anything else."""
        if not isinstance(state, dict) or set(state) != {"layers", "rain"}:
            raise InvalidValueError("clouds", state, "layers and rain")
        field = cls()
        if not isinstance(state["layers"], list):
            raise InvalidValueError("clouds.layers", state["layers"], "a list")
        for each in state["layers"]:
            layer = _layer_from(each, seed)
            if field.layers and layer.uid <= max(field.layers):
                raise InvalidValueError("clouds.uid", layer.uid, "layers in order, each once")
            field.layers[layer.uid] = layer
        for uid, serial, area in rows("clouds.rain", state["rain"], 3):
            key = _check_whole("rain.uid", uid), _check_serial("rain.serial", serial)
            if field.rain and key <= max(field.rain):
                raise InvalidValueError("clouds.rain", key, "clouds in order, each once")
            field.rain[key] = _check_whole("rain.area", area)
        if len(set(field.rain.values())) < len(field.rain):
            raise InvalidValueError("clouds.rain", state["rain"], "an area for each cloud")
        return field


def _layer_state(layer: LayerClouds) -> dict[str, Any]:
    array = layer.array
    least = int(array.serial[0]) if len(array) else layer.serial
    return {
        "box": list(layer.box),
        "change": layer.change,
        "chooser": layer.chooser.state(),
        "clouds": pack(array, layer.ticks, least),
        "due": layer.due,
        "known": [list(pair) for pair in sorted(layer.known)],
        "least": least,
        "offset": list(layer.offset),
        "serial": layer.serial,
        "ticks": layer.ticks,
        "uid": layer.uid,
        "velocity": list(layer.velocity),
        "wind": list(layer.wind),
    }


def _layer_from(state: Any, seed: int) -> LayerClouds:
    if not isinstance(state, dict) or set(state) != _FIELDS:
        raise InvalidValueError("clouds.layer", state, f"the fields {sorted(_FIELDS)}")
    box = state["box"]
    if not isinstance(box, list) or len(box) != 4:
        raise InvalidValueError("clouds.box", box, "four numbers")
    place = Box(
        *[_check_center("clouds.box", value) for value in box[:2]],
        *[_check_side("clouds.box", value) for value in box[2:]],
    )
    uid, ticks, serial, least = (
        _check_whole(f"clouds.{name}", state[name]) for name in ("uid", "ticks", "serial", "least")
    )
    layer = LayerClouds(seed, uid, place, _pair(_check_speed("velocity", state["velocity"])))
    layer.wind = _pair(_check_speed("wind", state["wind"]))
    layer.offset = _pair(_check_offset("offset", state["offset"]))
    layer.ticks, layer.serial = ticks, serial
    layer.due = _check_credit("due", state["due"])
    layer.change = _check_credit("change", state["change"])
    layer.chooser = Chooser.from_state(state["chooser"])
    layer.known = frozenset(
        (_check_sky("sky", sky), text("model", name))
        for sky, name in rows("clouds.known", state["known"], 2)
    )
    layer.array = unpack(state["clouds"], ticks, least, serial)
    return layer


def _pair(values: tuple[float, ...]) -> tuple[float, float]:
    return values[0], values[1]
