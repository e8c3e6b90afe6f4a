"""The place of the walk, made from code."""

from .place import Lamp, Place, Pond

__all__ = ["Lamp", "Place", "Pond"]
