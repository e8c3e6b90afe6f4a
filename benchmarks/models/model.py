"""What a rain model is to the benchmark."""

from __future__ import annotations

from typing import Protocol


class Model(Protocol):
    """Rain around the stage's camera; one frame is `move`, then `draw` over the background."""

    name: str
    drops: int

    def move(self, dt: float) -> None: ...

    def draw(self) -> None: ...

    def release(self) -> None: ...


class Rival(Model, Protocol):
    """A model whose looks can be turned to those of another."""

    size: float  # factor on the streaks' width and length
    opacity: float  # of the streaks at their middle

    def rewind(self) -> None: ...
