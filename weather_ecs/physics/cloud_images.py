"""Names of the images that billboards of clouds show; `gpu/cloud_images.py` makes them."""

from __future__ import annotations

# Their order is that of the texture array: an image's index here is its layer there.
CLOUD_IMAGES: tuple[str, ...] = (
    # Dense, round, with a crisp edge like a cauliflower's: cumulus and its kin.
    "puff_1",
    "puff_2",
    "puff_3",
    "puff_4",
    "puff_5",
    "puff_6",
    # Dense in the middle, torn at the edge: fractus, old cumulus, stratocumulus, nimbostratus.
    "ragged_1",
    "ragged_2",
    "ragged_3",
    "ragged_4",
    # Thin and curled: rims that evaporate, altocumulus, cirrocumulus.
    "wisp_1",
    "wisp_2",
    "wisp_3",
    "wisp_4",
    # Fibres along the image's width: cirrus, anvils, virga.
    "streak_1",
    "streak_2",
    "streak_3",
    # Even and without an outline of their own: stratus, altostratus, cirrostratus.
    "sheet_1",
    "sheet_2",
    "sheet_3",
)

# Of the picture's resolution, what an image of each family needs: without an outline, less.
DETAIL = {"puff": 1.0, "ragged": 0.8, "wisp": 0.7, "streak": 0.6, "sheet": 0.35}
IMAGE_DETAIL: tuple[float, ...] = tuple([DETAIL[name.split("_")[0]] for name in CLOUD_IMAGES])


def image_index(name: str) -> int:
    """Layer of the texture array. Raises ValueError for a name that is not in CLOUD_IMAGES."""
    return CLOUD_IMAGES.index(name)
