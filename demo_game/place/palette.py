"""The place's colours: a late afternoon, nothing saturated; linear RGB albedo."""

from __future__ import annotations

from .mesh import rgb

GRASS = rgb(0x6B724B)
GRASS_DRY = rgb(0x86805A)
GRASS_LUSH = rgb(0x566443)
HEATH = rgb(0x6A6350)
HEATHER = rgb(0x8C7A93)
FOREST = rgb(0x414E40)
PATH_EARTH = rgb(0x8F7A62)
MUD = rgb(0x5E5243)
BED = rgb(0x3A3B30)

PLANK = rgb(0x7E6C5A)
PLANK_INSIDE = rgb(0x97836B)
BOARD = rgb(0x7C6B59)
BEAM = rgb(0x5C5047)
TRIM = rgb(0xA79C88)
SHINGLE = rgb(0x5C5751)
SHINGLE_MOSS = rgb(0x5E6048)
DOOR = rgb(0x55706E)
GLASS = rgb(0x4A5458)
STONE_WARM = rgb(0x8B857A)
STONE_COOL = rgb(0x74746F)
IRON = rgb(0x33373A)
CLOTH = rgb(0x8A5A4A)
LINEN = rgb(0xC3B79F)
FENCE = rgb(0x8A8072)
LIME = rgb(0xB9B1A1)
SAIL = rgb(0xC2B698)
MAILBOX_RED = rgb(0x93473A)
PAPER = rgb(0xE2D8C0)
GLOW_WARM = rgb(0xFFC27A)

CONIFER = (rgb(0x3F5042), rgb(0x46563F), rgb(0x384A41))
BROADLEAF = (rgb(0x66703F), rgb(0x7A7040), rgb(0x5A663F))
BIRCH = (rgb(0x8D8144), rgb(0x9A7F42), rgb(0x7F7F4A))
BUSH = (rgb(0x5C6642), rgb(0x6E6B45), rgb(0x556048))
BARK = rgb(0x5D5044)
BIRCH_BARK = rgb(0xB9B3A4)

COAT = rgb(0x7F5A48)
TROUSERS = rgb(0x45474C)
HAT = rgb(0x4B4037)
SKIN = rgb(0xC39A7C)
BOOT = rgb(0x38302A)
