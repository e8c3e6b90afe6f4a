"""What is made for a picture's size: kept for the sizes in use, given back for others."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import moderngl
import numpy as np
import pytest

from tests.gl_names import living
from tests.test_depth import fetched
from tests.test_veil_sheet import Picture, look
from weather_ecs.gpu.by_size import KEPT, SIZES, BySize
from weather_ecs.gpu.depth import DepthCopy
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.veil_sheet import VeilSheet


class Made:
    """A thing that remembers whether it was given back."""

    def __init__(self) -> None:
        self.released = 0

    def release(self) -> None:
        self.released += 1


@pytest.fixture
def sizes() -> Iterator[BySize[Made]]:
    made: BySize[Made] = BySize()
    yield made
    made.release()


def test_sizes_in_turns_are_made_once(sizes: BySize[Made]) -> None:
    made: list[Made] = []

    def make() -> Made:
        made.append(Made())
        return made[-1]

    for _ in range(3 * KEPT):
        for size in range(SIZES):
            assert sizes.get(size, make) is made[size]
    assert len(made) == SIZES
    assert not any(thing.released for thing in made)
    sizes.release()
    sizes.release()
    assert [thing.released for thing in made] == [1] * SIZES


def test_a_size_that_nobody_has_any_more_is_given_back(sizes: BySize[Made]) -> None:
    first = sizes.get("first", Made)
    second = sizes.get("second", Made)
    for _ in range(KEPT - 1):
        sizes.get("second", Made)
    assert first.released == 0
    for _ in range(2):
        sizes.get("second", Made)
    assert (first.released, second.released, len(sizes)) == (1, 0, 1)
    assert sizes.get("first", Made) is not first


def test_a_window_that_is_dragged_larger_leaves_few(sizes: BySize[Made]) -> None:
    made = [sizes.get(width, Made) for width in range(100)]
    assert len(sizes) == SIZES
    assert [thing.released for thing in made] == [1] * (100 - SIZES) + [0] * SIZES


def test_one_that_cannot_be_made_leaves_the_others(sizes: BySize[Made]) -> None:
    def fail() -> Made:
        raise MemoryError

    first = sizes.get("first", Made)
    with pytest.raises(MemoryError):
        sizes.get("second", fail)
    assert sizes.get("first", Made) is first
    assert len(sizes) == 1


@pytest.mark.parametrize("lent", [False, True])
def test_two_pictures_in_turns_make_nothing_more(
    ctx: moderngl.Context, gl: GL, lent: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Sheets of veils and copies of depth of both sizes are there; the pictures stay the same."""
    if not lent:
        monkeypatch.setattr("weather_ecs.gpu.depth_lent.LentDepth.take", lambda *_: None)
    at, view = look(False)
    picture = Picture(ctx)

    def drawn() -> list[np.ndarray]:
        found = []
        for size in ((718, 401), (640, 400)):
            picture.target.viewport = (0, 0, *size)
            again = replace(view)  # another view, as every frame has one
            found.append(picture.draw(at, again))
        return found

    first = drawn()
    before = living(gl)
    for _ in range(3):
        for one, other in zip(first, drawn(), strict=True):
            assert np.array_equal(one, other)
    assert living(gl) == before
    assert not np.array_equal(first[0], first[1])
    picture.release()


def test_copies_of_depth_are_those_of_their_own_size(
    ctx: moderngl.Context, gl: GL, keep: Callable
) -> None:
    guard, copier = keep(StateGuard(ctx, gl)), keep(DepthCopy(ctx, gl))
    targets = []
    for size in ((8, 8), (12, 4)):
        depth = keep(ctx.depth_renderbuffer(size))
        targets.append(keep(ctx.framebuffer([keep(ctx.texture(size, 4))], depth)))
    names: dict[tuple[int, int], set[int]] = {}
    for k in range(6):
        target = targets[k % 2]
        target.use()
        target.clear(depth=0.1 * k)
        with guard:
            texture = copier.copy(guard)
            assert texture is not None and texture.size == target.size
            assert fetched(ctx, texture) == pytest.approx(0.1 * k, abs=1e-4)
        names.setdefault(target.size, set()).add(texture.glo)
    assert [len(found) for found in names.values()] == [1, 1]


def test_a_sheet_is_cleared_for_every_picture(ctx: moderngl.Context) -> None:
    sheet = VeilSheet(ctx, "f1")
    for _ in range(2):
        for size in ((8, 8), (6, 4)):
            sheet.begin(size)
            bound = ctx.fbo
            assert bound.size == size
            assert not any(bound.read(components=4))
            bound.clear(1.0, 1.0, 1.0, 1.0)
    sheet.release()
    sheet.release()
