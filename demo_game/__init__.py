"""The walk: a first-person game in and out of the rain, built on weather_ecs's public face."""
