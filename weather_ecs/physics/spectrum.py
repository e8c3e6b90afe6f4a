"""What an eye and a screen make of light that is known at three wavelengths: linear RGB.

Light of the air is reckoned at WAVELENGTHS. Taken for red, green and blue as it is, it makes the
sky too red, the more so in twilight: sRGB's red takes away what lies between blue and green, of
which the sky has much. SEEN comes nearest to the colours that whole spectra have, of the sky and of
the sun through it, for any height of the sun from -6 degrees: within 0.02 of the luminance on
average. CIE 1931 in the form of Wyman, Sloan and Shirley, "Simple Analytic Approximations to the
CIE XYZ Color Matching Functions", 2013; a sun of 5778 K, whose own light is white.
"""

from __future__ import annotations

import numpy as np

from weather_ecs.physics.checks import FloatArray

WAVELENGTHS = (613.0, 540.0, 450.0)  # nm
SEEN = np.array(
    [
        [1.434, -0.456, 0.022],
        [-0.021, 1.064, -0.043],
        [-0.041, -0.042, 1.083],
    ]
)


def seen(light: FloatArray) -> FloatArray:
    """Linear sRGB (..., 3) of light at WAVELENGTHS; what no screen can show is cut off at 0."""
    shape = light.shape
    return np.maximum(light.reshape(-1, 3) @ SEEN.T, 0.0).reshape(shape)
