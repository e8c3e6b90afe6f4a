"""The game's own renderer; it knows nothing of rain but what `Environment` says."""

from .environment import Air, Environment, RainPatch
from .scene import SceneRenderer

__all__ = ["Air", "Environment", "RainPatch", "SceneRenderer"]
