"""The command line as a player meets it: what it writes, what it refuses, and how it ends."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from demo_game import cli, headless
from demo_game.stats_writer import KEYS

ROOT = Path(__file__).parent.parent
SHORT = ("--headless", "--frames", 5, "--size", "160x90", "--every", 2, "--quality", "low")


def run_alone(*arguments: object, cwd: Path) -> subprocess.CompletedProcess[str]:
    """The game in a process of its own, on a machine without a display."""
    clean = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return subprocess.run(
        [sys.executable, "-m", "demo_game", *map(str, arguments)],
        cwd=cwd,
        env={**clean, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def run_here(*arguments: object) -> int:
    """The same in this process, which builds the place only once."""
    return cli.main([str(argument) for argument in arguments])


@pytest.fixture(scope="module", autouse=True)
def one_place() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(headless, "Place", lru_cache(headless.Place))
        yield


def picture(path: Path) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"), np.int16)


@pytest.fixture(scope="module")
def walked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two runs of one command, one of them in another process, and one without weather."""
    folder = tmp_path_factory.mktemp("walked")
    still = (*SHORT, "--tour", "still")
    done = run_alone(*still, "--out", "one", "--stats", "one.jsonl", cwd=folder)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("\n") == 1
    assert "5 frames of 160x90" in done.stdout
    assert run_here(*still, "--out", folder / "two") == 0
    clear = ("--preset", "clear", "--out", folder / "clear", "--stats", folder / "clear.jsonl")
    assert run_here(*still, *clear) == 0
    return folder


def test_pictures_every_so_many_frames(walked: Path) -> None:
    names = sorted(path.name for path in (walked / "one").iterdir())
    assert names == ["still_00000.png", "still_00002.png", "still_00004.png"]
    shades = picture(walked / "one" / names[0])
    assert shades.shape == (90, 160, 3)
    assert shades.std() > 10.0  # a picture, not a colour


def test_the_same_command_gives_the_same_pictures(walked: Path) -> None:
    for path in (walked / "one").iterdir():
        assert (picture(path) == picture(walked / "two" / path.name)).all()


def test_clear_differs_by_the_rain_alone(walked: Path) -> None:
    rain = picture(walked / "one" / "still_00004.png")
    clear = picture(walked / "clear" / "still_00004.png")
    assert (rain != clear).any()
    lines = [json.loads(line) for line in (walked / "clear.jsonl").read_text().splitlines()]
    assert all(line["mode"] == "none" and line["drops_drawn"] == 0 for line in lines)
    rainy = [json.loads(line) for line in (walked / "one.jsonl").read_text().splitlines()]
    assert [line["position"] for line in lines] == [line["position"] for line in rainy]


def test_every_frame_has_its_line(walked: Path) -> None:
    lines = [json.loads(line) for line in (walked / "one.jsonl").read_text().splitlines()]
    assert [line["frame"] for line in lines] == [0, 1, 2, 3, 4]
    assert all(tuple(line) == KEYS for line in lines)
    assert lines[2]["t"] == pytest.approx(2 / 60, abs=1e-6)
    assert all(line["ms"] > 0.0 and len(line["position"]) == 3 for line in lines)
    assert all(line["mode"] == "near" and line["state"] == "heavy" for line in lines)
    assert all(line["rain_rate_here"] > 1.0 for line in lines)
    assert lines[-1]["drops_drawn"] > 0


@pytest.mark.parametrize("backend", ["compute", "feedback"])
def test_both_backends_walk_the_whole_way(backend: str, tmp_path: Path) -> None:
    stats = tmp_path / "deep" / "s.jsonl"
    assert run_here(*SHORT, "--tour", "walk", "--backend", backend, "--stats", stats) == 0
    lines = [json.loads(line) for line in stats.read_text().splitlines()]
    assert {"far", "near"} <= {line["mode"] for line in lines}
    assert [path.name for path in tmp_path.iterdir()] == ["deep"]  # no pictures unasked


@pytest.mark.parametrize("tour", ["run", "crossing"])
def test_every_tour_runs(tour: str, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    stats = tmp_path / "s.jsonl"
    assert run_here(*SHORT, "--tour", tour, "--walk-speed", 6, "--stats", stats) == 0
    assert capsys.readouterr().out.startswith(f"{tour}: 5 frames")
    lines = [json.loads(line) for line in stats.read_text().splitlines()]
    steps = [a["position"][2] - b["position"][2] for a, b in zip(lines, lines[1:], strict=False)]
    assert np.array(steps) == pytest.approx(0.1, rel=0.05)


def test_a_film(tmp_path: Path) -> None:
    pytest.importorskip("imageio_ffmpeg")
    assert run_here(*SHORT, "--video", tmp_path / "films" / "walk.mp4") == 0
    film = tmp_path / "films" / "walk.mp4"
    assert film.stat().st_size > 500
    import imageio_ffmpeg

    assert imageio_ffmpeg.count_frames_and_secs(str(film)) == (3, pytest.approx(0.1))  # of five


@pytest.mark.parametrize(("dt", "step"), [(1 / 60, 2), (1 / 30, 1), (0.1, 1), (1 / 240, 8)])
def test_a_film_has_thirty_pictures_a_second_at_most(dt: float, step: int) -> None:
    assert headless.film_step(dt) == step


BAD = [
    (("--tour", "moon"), "walk, run, crossing, still, clouds, snow"),
    (("--frames", "0"), "1 to"),
    (("--frames", "many"), "1 to"),
    (("--size", "1280"), "1280x720"),
    (("--size", "0x0"), "16 to"),
    (("--size", "99999999999x720"), "16 to"),
    (("--dt", "nan"), "step"),
    (("--dt", "-1"), "step"),
    (("--dt", "inf"), "step"),
    (("--seed", "-1"), "0 to"),
    (("--quality", "best"), "low, medium, high, ultra, auto"),
    (("--backend", "vulkan"), "auto, compute, feedback"),
    (("--preset", "hail"), "clear, drizzle, light, moderate, heavy, cloudburst"),
    (("--preset", "hail"), "fair, cloudy, overcast, storm, or a file, NAME.toml"),
    (("--every", "0"), "1 to"),
    (("--walk-speed", "0"), "0.1 to 20"),
    (("--metar", "EDDF"), "--metar"),
    (("--start", "6"), "X,Z"),
    (("--start", "6,-55,1"), "X,Z"),
    (("--start", "nan,0"), "X -200 to 200"),
    (("--start=0,-900",), "Z -240 to 160"),
    (("--fram", "3"), "--fram"),
    (("--video", "walk.txt"), ".mp4, .mkv, .mov, .avi"),
    (("--video", "walk"), "--video"),
]


@pytest.mark.parametrize(("arguments", "said"), BAD, ids=[" ".join(bad[0]) for bad in BAD])
def test_bad_arguments_get_one_line(
    arguments: tuple[str, ...], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main(["--headless", *arguments])
    assert ended.value.code == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.count("\n") == 1
    assert said in printed.err


def test_a_bad_argument_ends_the_program_with_two(tmp_path: Path) -> None:
    done = run_alone("--headless", "--tour", "moon", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1


def test_without_its_library_the_game_says_what_to_install() -> None:
    code = "import sys; sys.modules['PIL'] = None; from demo_game.__main__ import main; "
    run = [sys.executable, "-c", code + "sys.exit(main())"]
    done = subprocess.run(run, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and not done.stdout
    (line,) = done.stderr.splitlines()
    assert line.startswith("demo_game: ") and "pip install 'weather_ecs[demo]'" in line


def test_an_unwritable_folder_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("here")
    assert cli.main(["--headless", "--frames", "1", "--out", str(tmp_path / "file")]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_without_a_display_the_tour_is_written(tmp_path: Path) -> None:
    done = run_alone("--frames", 3, "--size", "160x90", "--quality", "low", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "no window" in done.stdout
    assert (tmp_path / "out" / "demo" / "walk_00000.png").exists()
