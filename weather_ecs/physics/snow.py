"""Snow in the air: what it hides, and the sizes, kinds and speeds of its flakes.

Melted diameters in mm, snowfall rates in mm/h of water, speeds in m/s.
"""

from __future__ import annotations

import math

from numpy.typing import ArrayLike

from .checks import FloatArray, floats

ATTENUATION = 11.0  # dB per km and mm/h, Warner and Gunn (1969)


def snow_extinction(rate: ArrayLike) -> FloatArray:
    """Light lost per metre, 1/m, to snow that falls at `rate` mm/h of water.

    Proportional to the rate (Warner and Gunn 1969, from 20 storms): 11 dB/km for 1 mm/h, by
    Koschmieder a visibility of 1.5 km, and of 600 m in heavy snow, 2.5 mm/h.
    """
    return ATTENUATION * math.log(10.0) / 10.0 * 1e-3 * floats("rate", rate, 0.0)
