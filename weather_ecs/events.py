"""Names of the events that a weather dispatches by `esper.dispatch_event`; see docs/weathers.md."""

from __future__ import annotations

from weather_ecs.systems.events import RAIN_BEGINS as RAIN_BEGINS
from weather_ecs.systems.events import RAIN_ENDS as RAIN_ENDS
from weather_ecs.systems.events import SNOW_BEGINS as SNOW_BEGINS
from weather_ecs.systems.events import SNOW_ENDS as SNOW_ENDS
from weather_ecs.systems.events import STATE_CHANGED as STATE_CHANGED
from weather_ecs.systems.strikes import STRIKE as STRIKE
from weather_ecs.systems.strikes import THUNDER as THUNDER
from weather_ecs.systems.transition import TRANSITION_FINISHED as TRANSITION_FINISHED

# What each hands to its handlers.
EVENTS: dict[str, str] = {
    RAIN_BEGINS: "entity of the observer, mm/h",
    RAIN_ENDS: "entity of the observer, mm/h that is left",
    SNOW_BEGINS: "entity of the observer, mm/h of water",
    SNOW_ENDS: "entity of the observer, mm/h of water that is left",
    STATE_CHANGED: "name of the state before, name of the state now",
    TRANSITION_FINISHED: "name of the weather that has been reached",
    STRIKE: "the strike, and for each observer where it is from it",
    THUNDER: "entity of the observer, the strike, metres",
}
