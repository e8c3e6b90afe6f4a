"""The sound of the walk, made from noise: rain, roof, wind and thunder; no recordings."""

from .soundscape import Soundscape
from .walk_sound import WalkSound

__all__ = ["Soundscape", "WalkSound"]
