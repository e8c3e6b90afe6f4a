"""The sound of the walk, made from noise: rain, roof, wind and thunder; no recordings."""

from .soundscape import Soundscape

__all__ = ["Soundscape"]
