"""The game's own renderer; it knows nothing of rain but what `Environment` says."""

from .environment import Environment
from .scene import SceneRenderer

__all__ = ["Environment", "SceneRenderer"]
