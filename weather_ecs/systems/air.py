"""Air and fog as a frame has them: from the components, and from the light of the sky."""

from __future__ import annotations

from weather_ecs.components import Air, Fog
from weather_ecs.frame import AirData, FogData, SkyLight
from weather_ecs.physics.optics import CLEAR, air_extinction
from weather_ecs.physics.phase import share_at, wet_bulb
from weather_ecs.systems.queries import alive
from weather_ecs.systems.state import WeatherState

# Shares of the light that fog sends on towards the eye: it is lit from all round, and one looks at
# it level. The sun's is of its light on level ground.
HORIZON, ZENITH, SUN = 0.75, 0.25, 0.05


def air_data(state: WeatherState) -> AirData:
    """The oldest `Air`, and what falls in it."""
    for _, air in alive(Air, state.uids):
        t, humidity = air.temperature, air.humidity
        return AirData(t, humidity, float(wet_bulb(t, humidity)), share_at(t, humidity))
    return AirData()


def fog_data(state: WeatherState, sky: SkyLight) -> FogData:
    """The oldest `Fog`, or clean air, in the light of `sky`."""
    for _, fog in alive(Fog, state.uids):
        color = fog_color(sky) if fog.color is None else fog.color
        return FogData(air_extinction(fog.visibility), color, fog.depth, fog.draw)
    return FogData(CLEAR, fog_color(sky))


def fog_color(sky: SkyLight) -> tuple[float, float, float]:
    """Light of fog so thick that nothing is seen through it, linear RGB."""
    high = SUN * max(sky.sun_direction[1], 0.0)
    r, g, b = (
        HORIZON * horizon + ZENITH * zenith + high * sun
        for horizon, zenith, sun in zip(
            sky.horizon_color, sky.zenith_color, sky.sun_color, strict=True
        )
    )
    return r, g, b
