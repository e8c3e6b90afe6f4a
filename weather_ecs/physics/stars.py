"""Stars to draw: the brightest where they are, the faint ones by chance, as many as there are.

Places (J2000) and magnitudes of the bright ones after the Yale Bright Star Catalogue (Hoffleit and
Warren 1991). The others follow the counts of stars by magnitude, ten times as many for two
magnitudes less light, and crowd towards the Milky Way.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from weather_ecs.physics.checks import FloatArray

FAINTEST = 6.2
ALL = 2600  # brighter than that, without those of the list
GALACTIC_POLE = (192.86, 27.13)  # degrees

# Right ascension in hours, declination in degrees, magnitude, colour index B - V.
_BRIGHT = """
6.752 -16.72 -1.46 0.00; 6.399 -52.70 -0.74 0.15; 14.660 -60.83 -0.27 0.71
14.261 19.18 -0.05 1.23; 18.616 38.78 0.03 0.00; 5.278 46.00 0.08 0.80
5.242 -8.20 0.13 -0.03; 7.655 5.22 0.34 0.42; 1.629 -57.24 0.46 -0.16
5.920 7.41 0.50 1.85; 14.064 -60.37 0.61 -0.23; 19.846 8.87 0.76 0.22
12.443 -63.10 0.76 -0.24; 4.599 16.51 0.86 1.54; 16.490 -26.43 0.96 1.83
13.420 -11.16 0.97 -0.23; 7.755 28.03 1.14 1.00; 22.961 -29.62 1.16 0.09
12.795 -59.69 1.25 -0.23; 20.690 45.28 1.25 0.09; 10.139 11.97 1.39 -0.11
6.977 -28.97 1.50 -0.21; 7.577 31.89 1.58 0.03; 12.519 -57.11 1.64 1.59
17.560 -37.10 1.62 -0.22; 5.418 6.35 1.64 -0.22; 5.438 28.61 1.65 -0.13
9.220 -69.72 1.69 0.00; 5.604 -1.20 1.69 -0.18; 22.137 -46.96 1.74 -0.13
5.679 -1.94 1.77 -0.21; 12.900 55.96 1.77 -0.02; 3.405 49.86 1.79 0.48
11.062 61.75 1.79 1.07; 8.159 -47.34 1.83 -0.22; 7.140 -26.39 1.84 0.68
18.403 -34.38 1.85 -0.03; 13.792 49.31 1.86 -0.19; 8.375 -59.51 1.86 1.28
17.622 -43.00 1.87 0.40; 5.992 44.95 1.90 0.03; 16.811 -69.03 1.92 1.44
6.629 16.40 1.92 0.00; 20.427 -56.74 1.94 -0.20; 8.745 -54.71 1.96 0.04
6.378 -17.96 1.98 -0.23; 9.460 -8.66 1.98 1.44; 2.120 23.46 2.00 1.15
2.530 89.26 2.02 0.60; 18.921 -26.30 2.02 -0.22; 0.727 -17.99 2.02 1.02
1.162 35.62 2.05 1.58; 0.140 29.09 2.06 -0.11; 5.796 -9.67 2.06 -0.17
14.845 74.16 2.08 1.47; 22.711 -46.88 2.10 1.60; 17.582 12.56 2.07 0.15
3.136 40.96 2.12 -0.05; 11.818 14.57 2.13 0.09; 12.692 -48.96 2.17 -0.01
20.371 40.26 2.20 0.68; 9.133 -43.43 2.21 1.66; 0.675 56.54 2.23 1.17
5.533 -0.30 2.23 -0.22; 15.578 26.71 2.23 -0.02; 17.943 51.49 2.23 1.52
8.060 -40.00 2.25 -0.26; 9.285 -59.28 2.25 0.18; 2.065 42.33 2.26 1.37
0.153 59.15 2.27 0.34; 13.399 54.93 2.27 0.02; 16.836 -34.29 2.29 1.15
13.665 -53.47 2.30 -0.22; 14.699 -47.39 2.30 -0.20; 14.592 -42.16 2.31 -0.19
16.005 -22.62 2.32 -0.12; 11.031 56.38 2.37 -0.02; 14.750 27.07 2.37 0.97
21.736 9.88 2.39 1.53; 17.708 -39.03 2.41 -0.22; 0.438 -42.31 2.39 1.09
11.897 53.69 2.44 0.00; 17.173 -15.72 2.43 0.06; 21.310 62.59 2.44 0.22
23.063 28.08 2.42 1.67; 7.402 -29.30 2.45 -0.08; 20.770 33.97 2.46 1.03
23.079 15.21 2.49 -0.04; 0.945 60.72 2.47 -0.15; 9.368 -55.01 2.50 -0.18
3.038 4.09 2.53 1.64; 16.619 -10.57 2.56 0.02; 11.235 20.52 2.56 0.12
5.545 -17.82 2.58 0.21; 12.263 -17.54 2.59 -0.11; 10.333 19.84 2.28 1.14
12.139 -50.72 2.60 -0.12; 19.044 -29.88 2.59 0.08; 15.283 -9.38 2.61 -0.11
1.911 20.81 2.64 0.13; 15.738 6.43 2.65 1.17; 16.091 -19.81 2.62 -0.07
1.430 60.24 2.68 0.13; 5.995 37.21 2.62 -0.08; 13.911 18.40 2.68 0.58
14.976 -43.13 2.68 -0.22; 4.950 33.17 2.69 1.53; 17.512 -37.30 2.69 -0.22
18.350 -29.83 2.70 1.38; 7.285 -37.10 2.70 1.62; 19.771 10.61 2.72 1.52
16.399 61.51 2.74 0.91; 12.694 -1.45 2.74 0.36; 10.716 -64.39 2.76 -0.22
5.590 -5.91 2.77 -0.24; 13.343 -36.71 2.75 0.04; 5.131 -5.09 2.79 0.13
16.503 21.49 2.77 0.94; 17.507 52.30 2.79 0.98; 12.252 -58.75 2.80 -0.23
3.902 31.88 2.85 0.12; 3.964 40.01 2.89 -0.18; 3.791 24.11 2.87 -0.09
0.220 15.18 2.83 -0.23; 12.934 38.32 2.90 -0.12; 19.750 45.13 2.87 -0.03
19.512 27.96 3.08 1.13; 12.257 57.03 3.31 0.08; 1.907 63.67 3.38 -0.15
15.345 71.83 3.05 0.06; 16.688 38.92 3.50 0.92; 17.251 14.39 3.35 1.44
3.080 53.51 2.93 0.70; 3.715 47.79 3.01 -0.13; 2.845 55.90 3.76 1.68
18.982 32.69 3.24 -0.05; 18.835 33.36 3.45 0.00; 5.586 9.93 3.54 -0.18
20.660 15.91 3.77 -0.06; 20.626 14.60 3.63 0.44; 6.733 25.13 2.98 1.40
7.335 21.98 3.53 0.34; 6.383 22.51 2.88 1.64; 6.248 22.51 3.28 1.60
4.477 15.87 3.40 0.18; 4.330 15.63 3.65 0.99; 4.382 17.54 3.76 0.98
4.477 19.18 3.53 1.01; 5.627 21.14 3.00 -0.19; 9.764 23.77 2.98 0.80
10.278 23.42 3.44 0.31; 10.122 16.76 3.52 -0.03
"""


class Stars(NamedTuple):
    """Equatorial unit directions (n, 3), magnitudes (n,) and colours (n, 3), linear RGB."""

    directions: FloatArray
    magnitudes: FloatArray
    colors: FloatArray


@lru_cache(maxsize=1)
def stars() -> Stars:
    """All of them, the same every time, the bright ones first."""
    rows = _BRIGHT.replace("\n", ";").split(";")
    known = np.array([row.split() for row in rows if row.strip()], np.float64)
    bright = _directions(known[:, 0] * 15.0, known[:, 1])
    rng = np.random.Generator(np.random.PCG64(1991))
    # A share of the stars of each magnitude: counts go as 10^(0.51 m).
    faint = FAINTEST + np.log10(rng.uniform(1e-9, 1.0, ALL)) / 0.51
    faint = faint[faint > 2.6]
    places = rng.normal(size=(len(faint), 3))
    pole = _directions(np.array(GALACTIC_POLE[0]), np.array(GALACTIC_POLE[1]))
    crowded = rng.uniform(size=len(faint)) < 0.5
    places -= crowded[:, None] * 0.72 * (places @ pole)[:, None] * pole
    places /= np.linalg.norm(places, axis=1, keepdims=True)
    index = np.concatenate([known[:, 3], rng.normal(0.5, 0.55, len(faint)).clip(-0.25, 1.8)])
    return Stars(
        np.concatenate([bright, places]), np.concatenate([known[:, 2], faint]), _colors(index)
    )


def _directions(right_ascension: FloatArray, declination: FloatArray) -> FloatArray:
    a, d = np.radians(right_ascension), np.radians(declination)
    return np.stack([np.cos(d) * np.cos(a), np.cos(d) * np.sin(a), np.sin(d)], -1)


def _colors(index: FloatArray) -> FloatArray:
    """Linear RGB of a colour index B - V, half bleached as eyes have it."""
    # From blue-white over white at 0.3 to orange.
    warm, cold = np.clip((index - 0.3) / 1.5, 0.0, 1.0), np.clip((0.3 - index) / 0.6, 0.0, 1.0)
    rgb = np.stack([1.0 - 0.35 * cold, 1.0 - 0.22 * cold - 0.28 * warm, 1.0 - 0.55 * warm], -1)
    return np.asarray(rgb, np.float64)
