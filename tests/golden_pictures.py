"""Golden pictures: kept ones, what differs from them, and how much may."""

from __future__ import annotations

from pathlib import Path

import moderngl
import numpy as np
from PIL import Image

GOLDEN = Path(__file__).parent / "golden"
CHANGED = 12  # of 255, in any channel: a pixel that is another one


def kept(name: str) -> np.ndarray:
    return np.asarray(Image.open(GOLDEN / f"{name}.png").convert("RGB"))


def difference(found: np.ndarray, expected: np.ndarray) -> tuple[float, float]:
    """(mean of the difference in 0 to 255, share of pixels that are others)."""
    off = np.abs(found.astype(int) - expected.astype(int))
    return float(off.mean()), float((off.max(axis=2) > CHANGED).mean())


def coarse(image: np.ndarray) -> np.ndarray:
    """Means of blocks of 20 pixels, in which single drops do not count."""
    height, width, _ = image.shape
    return image.reshape(height // 20, 20, width // 20, 20, 3).mean(axis=(1, 3))


def check(ctx: moderngl.Context, found: np.ndarray, name: str, folder: Path) -> None:
    expected = kept(name)
    mean, others = difference(found, expected)
    blocks = float(np.abs(coarse(found) - coarse(expected)).max())
    if "llvmpipe" in ctx.info["GL_RENDERER"]:
        good = mean < 0.5 and others < 0.01 and blocks < 4.0
    else:
        good = mean < 4.0 and blocks < 16.0
    if not good:
        Image.fromarray(found).save(folder / f"{name}.png")
    assert good, (
        f"{name}: mean {mean:.2f}, {others:.1%} other pixels, blocks up to {blocks:.1f}; "
        f"the picture is {folder / name}.png"
    )
