"""Stills, films and sheets: what is on disk afterwards, and that nothing is when it went wrong."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest
from PIL import Image

from weather_ecs import CloudFile
from weather_ecs.components import CloudModel, CloudSeed
from weather_ecs.editor import export, pictures
from weather_ecs.editor.document import Document
from weather_ecs.editor.exporting import FILM, SHEET, STILL, Exports
from weather_ecs.editor.shared import Shared

BALL = CloudModel(
    "ball", (CloudSeed(width=200.0, height=200.0, depth=200.0),), 12, 12, 120.0, 150.0
)


@pytest.fixture(scope="module")
def gl() -> Iterator[moderngl.Context]:
    context = moderngl.create_context(standalone=True, backend="egl")
    yield context
    context.release()


@pytest.mark.parametrize("channels", [3, 4])
def test_a_png_holds_the_picture(tmp_path: Path, channels: int) -> None:
    picture = np.random.default_rng(1).integers(0, 256, (7, 11, channels), np.uint8)
    pictures.write_png(tmp_path / "a.png", picture)
    with Image.open(tmp_path / "a.png") as image:
        assert image.mode == ("RGB" if channels == 3 else "RGBA")
        assert np.array_equal(np.array(image), picture)
    assert os.listdir(tmp_path) == ["a.png"]


def test_a_picture_that_cannot_be_written_leaves_the_old_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.png"
    path.write_bytes(b"old")

    def full(self: Path, data: bytes) -> int:
        with open(self, "wb") as stream:
            stream.write(data[:10])
        raise OSError(28, "No space left on device", str(self))

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OSError, match="No space left"):
        pictures.write_png(path, np.zeros((2, 2, 3), np.uint8))
    assert path.read_bytes() == b"old" and os.listdir(tmp_path) == ["a.png"]


def test_a_sheet_has_the_cloud_from_all_sides_and_nothing_round_it(
    gl: moderngl.Context, tmp_path: Path
) -> None:
    path = tmp_path / "sheet.png"
    shares = list(export.impostor_sheet(gl, path, export.Subject(BALL), 48, 3, pitches=(-0.4, 0.0)))
    assert len(shares) == 7 and shares == sorted(shares) and shares[-1] == 1.0
    with Image.open(path) as image:
        sheet = np.array(image).reshape(2, 48, 3, 96, 4).swapaxes(1, 2)
    for tile in sheet.reshape(-1, 48, 96, 4):
        alpha = tile[..., 3].astype(int)
        assert alpha[:, :4].max() == 0 and alpha[:, -4:].max() == 0  # clear at the sides
        assert alpha[16:32, 36:60].mean() > 150  # there is a cloud in the middle
        assert tile[24, 48, :3].min() > 60  # which is no black hole
    rows = [sheet[row].reshape(3, -1).astype(int) for row in range(2)]
    assert abs(rows[0][0] - rows[0][1]).mean() > 0.5  # another side is another picture


def test_a_cutout_over_a_colour_is_the_cloud_over_it(gl: moderngl.Context) -> None:
    shooter = export.Shooter(gl, export.Subject(BALL))
    try:
        camera = shooter.way_round(1, (0.0,), 2.0)[0][0]
        cut = shooter.cutout(camera, (96, 48)).astype(float) / 255.0
        shooter.stage.sky(False)
        with export._canvas(gl, (96, 48), 0.5) as canvas:
            shooter.stage.draw(camera.view(export._ORIGIN), camera.projection(2.0))
            seen = export._read(canvas).astype(float) / 255.0
    finally:
        shooter.close()
    alpha = cut[..., 3:]
    assert 0.1 < alpha.mean() < 0.9
    mixed = cut[..., :3] * alpha + 0.5 * (1.0 - alpha)
    assert abs(mixed - seen).max() < 0.04


def test_a_film_goes_once_round_and_is_whole_or_not_there(
    gl: moderngl.Context, tmp_path: Path
) -> None:
    path = tmp_path / "round.mp4"
    subject = export.Subject(BALL)
    job = export.turntable(gl, path, subject, (64, 48), frames=5)
    next(job)
    job.close()  # type: ignore[attr-defined]
    assert os.listdir(tmp_path) == []
    assert list(export.turntable(gl, path, subject, (64, 48), frames=5))[-1] == 1.0
    assert os.listdir(tmp_path) == ["round.mp4"]
    import imageio_ffmpeg

    frames = imageio_ffmpeg.read_frames(str(path))
    about: Any = next(frames)
    assert tuple(about["size"]) == (64, 48) and sum(1 for _ in frames) == 5


def test_what_is_asked_for_is_made_a_piece_a_frame(gl: moderngl.Context, tmp_path: Path) -> None:
    document = Document(CloudFile(models=(BALL,)), tmp_path / "mine.toml")
    shared, exports = Shared(gl), Exports()
    exports.ask(STILL, document, shared)
    assert exports.choice.path == str(tmp_path / "ball_still.png")
    exports.choice.size = 0
    assert exports.begin(document, shared) and not exports.busy
    with Image.open(tmp_path / "ball_still.png") as image:
        assert image.size == (640, 360)
        assert np.array(image).std() > 5.0
    exports.ask(SHEET, document, shared)
    exports.choice.tile, exports.choice.columns = 0, 0
    exports.choice.path = str(tmp_path / "sheet")  # an ending is added
    assert exports.begin(document, shared) and exports.busy
    assert exports._job is not None
    for _ in exports._job:
        pass
    assert (tmp_path / "sheet.png").is_file()


def test_what_cannot_be_exported_is_said_and_leaves_nothing(
    gl: moderngl.Context, tmp_path: Path
) -> None:
    shared, exports = Shared(gl), Exports()
    empty = Document()
    exports.ask(FILM, empty, shared)
    assert not exports.begin(empty, shared) and "no cloud model" in exports.error
    document = Document(CloudFile(models=(BALL,)))
    exports.ask(STILL, document, shared)
    exports.choice.size = 0
    exports.choice.path = str(tmp_path / "nowhere" / "a.png")
    assert not exports.begin(document, shared) and "no folder" in exports.error
    exports.ask(FILM, document, shared)
    exports.choice.path = str(tmp_path / "a.mp4")
    assert exports.begin(document, shared) and exports.busy
    exports.cancel()
    assert not exports.busy and os.listdir(tmp_path) == []
