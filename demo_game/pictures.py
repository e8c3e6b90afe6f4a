"""Pictures on disk."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

SCREENSHOTS = Path("screenshots")


def save_png(path: Path, picture: NDArray[np.uint8]) -> None:
    """Write a picture of shape (height, width, 3), top row first."""
    Image.fromarray(np.ascontiguousarray(picture)).save(path, compress_level=4)


def save_screenshot(picture: NDArray[np.uint8], folder: Path = SCREENSHOTS) -> Path:
    """Write a picture under the first free number; returns its path."""
    folder.mkdir(parents=True, exist_ok=True)
    number = 1
    while (path := folder / f"walk_{number:03d}.png").exists():
        number += 1
    save_png(path, picture)
    return path
