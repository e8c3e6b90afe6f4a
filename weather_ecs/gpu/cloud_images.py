"""The images that billboards of clouds show: made by the package, a texture array with mipmaps.

Texels are (relief x, relief y, shade, coverage). Relief is the slope of the surface that the image
shows, 0.5 where it faces the viewer; shade is how open to light a place is, 1 on knobs, less in
the hollows between them.
"""

from __future__ import annotations

from functools import cache

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.gpu.mip_array import mip_array, mip_levels
from weather_ecs.physics.cloud_images import CLOUD_IMAGES

SIZE = 256  # texels on a side
SOFTWARE = ("llvmpipe", "softpipe", "SwiftShader", "WARP")  # in the renderer's name
_STEEPEST = 2.0  # slope that relief 0 and 1 stand for

Image = NDArray[np.float32]

_AXIS = ((np.arange(SIZE, dtype=np.float32) + 0.5) / SIZE) * 2.0 - 1.0
_X, _Y = np.meshgrid(_AXIS, _AXIS)
_R2 = _X * _X + _Y * _Y


@cache
def images() -> NDArray[np.uint8]:
    """All images, (layers, SIZE, SIZE, 4); always the same bytes."""
    layers = np.empty((len(CLOUD_IMAGES), SIZE, SIZE, 4), np.uint8)
    for index, name in enumerate(CLOUD_IMAGES):
        kind, number = name.split("_")
        rng = np.random.default_rng((2005, index))
        layers[index] = _KINDS[kind](rng, int(number))
    layers.setflags(write=False)
    return layers


@cache
def hulls() -> NDArray[np.float32]:
    """(layers, 8, 2): an octagon round what each image shows, x and y in -1 to 1.

    Sides are parallel to the axes and the diagonals; corners go round counter-clockwise. What is
    drawn of an image is inside it: texels that are empty cost as much as others.
    """
    turns = np.arange(8) * (0.25 * np.pi)
    ways = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    found = np.empty((len(CLOUD_IMAGES), 8, 2), np.float32)
    for layer, cover in enumerate(images()[..., 3]):
        seen = cover > 0
        rows = np.flatnonzero(seen.any(axis=1))
        # The ends of each row are enough.
        ends = seen[rows].argmax(axis=1), SIZE - 1 - seen[rows, ::-1].argmax(axis=1)
        places = np.concatenate([np.stack([_AXIS[x], _AXIS[rows]], axis=1) for x in ends])
        reach = (places @ ways.T).max(axis=0) + 2.0 / SIZE
        after = np.roll(reach, -1)
        # Where two neighbouring sides meet, at the sine of the 45 degrees between them.
        across = (after - reach * np.sqrt(0.5)) / np.sqrt(0.5)
        normals = np.stack([-ways[:, 1], ways[:, 0]], axis=1)
        found[layer] = ways * reach[:, None] + normals * across[:, None]
    found.setflags(write=False)
    return found


@cache
def _levels() -> list[bytes]:
    return [level.tobytes() for level in mip_levels(images())]


def image_array(ctx: moderngl.Context) -> moderngl.TextureArray:
    """The images on the GPU; the caller releases it.

    Filtered trilinearly, but on a rasteriser in software, where that costs half as much again.
    """
    texture = mip_array(ctx, SIZE, 4, _levels())
    if not any(name in ctx.info["GL_RENDERER"] for name in SOFTWARE):
        texture.filter = moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR
    return texture


def _noise(
    rng: np.random.Generator, fall: float, stretch: tuple[float, float] = (1.0, 1.0)
) -> Image:
    """Noise of mean 0 and deviation 1 whose amplitude falls as frequency to the power -fall.

    stretch: factors on the frequencies along x and y; less of one makes features longer there.
    """
    white = rng.standard_normal((SIZE, SIZE)).astype(np.float32)
    fx = np.fft.rfftfreq(SIZE, 1.0 / SIZE).astype(np.float32) / stretch[0]
    fy = np.fft.fftfreq(SIZE, 1.0 / SIZE).astype(np.float32) / stretch[1]
    f2 = fx[None, :] ** 2 + fy[:, None] ** 2
    f2[0, 0] = np.inf
    made = np.fft.irfft2(np.fft.rfft2(white) * (f2 + 2.0) ** (-0.5 * fall), s=(SIZE, SIZE))
    made = made.astype(np.float32)
    return (made - made.mean()) / made.std()


def _step(low: float, high: float, value: Image) -> Image:
    t = np.clip((value - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def _texels(
    height: NDArray[np.floating], shade: NDArray[np.floating], cover: NDArray[np.floating]
) -> NDArray[np.uint8]:
    """Relief from a height in units of the image's half-width, and the rest, as bytes."""
    slope_y, slope_x = np.gradient(height, 2.0 / SIZE)
    # No billboard may show its own square: nothing is left at the image's rim.
    rim = 1.0 - _step(0.90, 0.985, np.sqrt(_R2))
    parts = (
        0.5 - slope_x / (2.0 * _STEEPEST),
        0.5 - slope_y / (2.0 * _STEEPEST),
        shade,
        cover * rim,
    )
    texels = np.rint(np.clip(np.stack(parts, -1), 0.0, 1.0) * 255.0).astype(np.uint8)
    texels[texels[..., 3] < 4, 3] = 0
    return texels


def _knobs(rng: np.random.Generator, elongation: float) -> tuple[Image, Image]:
    """Height of a heap of spheres on spheres on spheres, and the same without the smallest."""
    height = np.full((SIZE, SIZE), -1.0, np.float32)
    coarse = height
    parents = [(0.0, 0.0, 0.0, 0.56)]
    _raise(height, *parents[0])
    for level, (count, share) in enumerate(((12, 0.44), (6, 0.40), (3, 0.46))):
        children = []
        for x, y, z, radius in parents:
            for _ in range(count):
                turn = rng.uniform(0.0, 2.0 * np.pi)
                up = rng.uniform(0.0, 0.95)
                out = np.sqrt(1.0 - up * up) * radius * (0.92 if level else 0.84)
                child = radius * share * rng.uniform(0.65, 1.15)
                cx = x + out * np.cos(turn) * (elongation if level == 0 else 1.0)
                cy = y + out * np.sin(turn) / (elongation if level == 0 else 1.0)
                children.append((cx, cy, z + up * radius * 0.9, child))
                _raise(height, *children[-1])
        parents = children
        if level == 1:
            coarse = height.copy()
    return height, coarse


def _raise(height: Image, x: float, y: float, z: float, radius: float) -> None:
    """Put a sphere into the height."""
    low = [max(int((c - radius + 1.0) * 0.5 * SIZE), 0) for c in (y, x)]
    high = [min(int((c + radius + 1.0) * 0.5 * SIZE) + 1, SIZE) for c in (y, x)]
    part = (slice(low[0], high[0]), slice(low[1], high[1]))
    inside = radius * radius - (_X[part] - x) ** 2 - (_Y[part] - y) ** 2
    np.maximum(
        height[part], np.where(inside > 0.0, z + np.sqrt(np.maximum(inside, 0.0)), -1.0),
        out=height[part],
    )  # fmt: skip


def _puff(rng: np.random.Generator, number: int) -> NDArray[np.uint8]:
    height, coarse = _knobs(rng, 1.0 + 0.10 * (number % 3))
    fine, frayed = _noise(rng, 1.5), _noise(rng, 1.9)
    body = np.maximum(height, -0.13)
    smooth = _blur(body, 1.5)
    # The rim is crisp in some places and frays in others, as where dry air is drawn in.
    cover = 0.96 * _step(-0.04, 0.46, smooth + 0.045 * fine + 0.07 * frayed)
    # Light that has been scattered many times leaves only the broadest hollows dark.
    hollow = _blur(body, 10.0) - _blur(body, 3.0)
    shade = 0.955 - 0.75 * np.clip(hollow, -0.06, 0.2) + 0.012 * fine
    rounded = _blur(np.maximum(coarse, 0.0), 6.0)
    knobs = _blur(np.maximum(body, 0.0), 2.5)
    dome = _blur(np.maximum(body, 0.0), 14.0)
    relief = 0.40 * dome + 0.30 * (rounded - dome) + 0.42 * (knobs - dome)
    return _texels(relief, shade, cover)


def _ragged(rng: np.random.Generator, number: int) -> NDArray[np.uint8]:
    broad, fine = _noise(rng, 2.1), _noise(rng, 1.6)
    body = 0.66 - np.sqrt(_R2) * 0.85 + 0.15 * broad + 0.045 * fine
    cover = _step(0.0, 0.40, body)
    height = 0.30 * np.minimum(body, 0.6) + 0.08 * broad + 0.004 * fine
    shade = 0.86 + 0.06 * broad + 0.025 * fine
    return _texels(_blur(height, 2.5), shade, cover * (0.97 - 0.04 * number))


def _wisp(rng: np.random.Generator, number: int) -> NDArray[np.uint8]:
    bend_x, bend_y = _noise(rng, 2.6), _noise(rng, 2.6)
    source = _noise(rng, 1.7, (1.0, 2.2))
    # The noise, pulled along another one: curls.
    rows = np.clip((_Y + 0.10 * bend_y + 1.0) * 0.5 * SIZE, 0, SIZE - 1).astype(np.intp)
    columns = np.clip((_X + 0.16 * bend_x + 1.0) * 0.5 * SIZE, 0, SIZE - 1).astype(np.intp)
    curled = _blur(source[rows, columns], 1.0)
    body = 0.56 - np.sqrt(_R2) * 0.72 + 0.13 * curled + 0.07 * bend_x
    cover = _step(0.0, 0.72, body) * (0.88 - 0.05 * number)
    return _texels(0.16 * np.minimum(_blur(body, 5.0), 0.5), 0.94 + 0.03 * curled, cover)


def _streak(rng: np.random.Generator, number: int) -> NDArray[np.uint8]:
    fibres = _noise(rng, 1.6, (0.05, 1.0))
    tufts = _noise(rng, 2.2, (0.35, 0.8))
    # Fibres bend as falling ice does in sheared wind.
    bend = np.clip((_Y + (0.10 + 0.06 * number) * (_X * _X) + 1.0) * 0.5 * SIZE, 0, SIZE - 1)
    fibres = np.take_along_axis(fibres, bend.astype(np.intp), axis=0)
    ends = 1.0 - _step(0.35, 0.95, np.abs(_X) + 0.10 * tufts)
    sides = 1.0 - _step(0.20, 0.88, np.abs(_Y) + 0.08 * tufts)
    body = (0.50 + 0.26 * fibres + 0.16 * tufts) * ends * sides
    cover = _step(0.06, 0.95, body) * 0.85
    return _texels(0.05 * tufts, 0.96 + 0.02 * fibres, cover)


def _sheet(rng: np.random.Generator, number: int) -> NDArray[np.uint8]:
    broad, fine = _noise(rng, 2.3), _noise(rng, 1.8)
    edge = 1.0 - _step(0.25, 0.92, np.sqrt(_R2) + 0.05 * broad)
    cover = edge * np.clip(0.90 + (0.04 * number) * broad, 0.0, 1.0)
    height = 0.030 * number * _blur(broad, 4.0) + 0.001 * fine
    return _texels(height, 0.93 + 0.025 * number * broad, cover)


def _blur(image: NDArray[np.floating], sigma: float) -> Image:
    """Gaussian of sigma texels, by the spectrum."""
    fx = np.fft.rfftfreq(SIZE).astype(np.float32)
    fy = np.fft.fftfreq(SIZE).astype(np.float32)
    low = np.exp(-2.0 * (np.pi * sigma) ** 2 * (fx[None, :] ** 2 + fy[:, None] ** 2))
    blurred: Image = np.fft.irfft2(np.fft.rfft2(image) * low, s=(SIZE, SIZE)).astype(np.float32)
    return blurred


_KINDS = {"puff": _puff, "ragged": _ragged, "wisp": _wisp, "streak": _streak, "sheet": _sheet}
