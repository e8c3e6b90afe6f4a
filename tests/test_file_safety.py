"""Files whatever happens: texts made to take long, full disks, files that are in the way."""

from __future__ import annotations

import os
import stat
import time
from pathlib import Path
from typing import Any

import pytest

from weather_ecs import CloudFile, WeatherFileError, load_clouds, presets, save_clouds
from weather_ecs.cloud_files import text_of
from weather_ecs.components import Fog
from weather_ecs.file_text import DEEPEST, LARGEST, write_text


def load(folder: Path, text: str) -> CloudFile:
    path = folder / "weather.toml"
    path.write_bytes(text.encode())
    return load_clouds(path)


def refused(folder: Path, text: str) -> WeatherFileError:
    with pytest.raises(WeatherFileError) as caught:
        load(folder, text)
    assert str(folder / "weather.toml") in str(caught.value)
    return caught.value


# Texts that take long, or take a parser's stack, if nothing is done about them.
HARD = {
    "tables in turn": "version = 2\n" + "[[models]]\n[[models.seeds]]\n" * 30_000,
    "tables": "".join(f"[{'.'.join(['a'] * k)}]\n" for k in range(1, 900, 2)),
    "many tables": "version = 2\n" + "".join(f"[x_a{k}.b.c.d]\n" for k in range(60_000)),
    "nested tables": "version = 2\n[x_a" + ".b" * 900 + "]\n" + "[x_a.c]\n" * 3,
    "dotted keys": "version = 2\n" + "".join(f"x{'.a' * 900}.b{k} = 1\n" for k in range(900)),
    "arrays": "version = 2\nx_a = " + "[\n" * 60_000 + "]\n" * 60_000,
    "inline tables": "version = 2\nx_a = " + "{a=" * 600 + "1" + "}" * 600,
    "arrays of tables": "".join(f"[[{'.'.join(['a'] * 40)}]]\n" for k in range(9000)),
    "layers": "version = 2\n" + "[[layers]]\n" * 100_000 + "base = 'x'\n",
    "open string": 'version = 2\nx = """' + '"' * 1900 + ("\n" + "'" * 1900) * 900,
    "quotes": "version = 2\n" + ("x = '" + '"' * 1900 + "\n") * 900,
    "brackets": ("[" * 1900 + "\n") * 1000,
}


@pytest.mark.parametrize("name", HARD)
def test_hard_texts_are_refused_soon(tmp_path, name):
    text = HARD[name][:LARGEST]
    began = time.process_time()
    refused(tmp_path, text)
    assert time.process_time() - began < 20.0  # by far: it is a second, not minutes


def test_the_depth_that_is_allowed_and_no_more(tmp_path):
    def nested(depth: int) -> tuple[str, str]:
        inline = "x_a = " + "[" * depth + "]" * depth
        return f"version = 2\n{inline}\n", f"version = 2\n[x_{'.a' * (depth - 1)}]\n".replace(
            "x_.", "x_a."
        )

    for text in nested(DEEPEST):
        load(tmp_path, text)
    for text in nested(DEEPEST + 1):
        assert "line 2: nested too deeply" in str(refused(tmp_path, text))
    brackets = "[" * 60
    load(tmp_path, f'version = 2\nx_a = "{brackets}" # {brackets}\n{"# [" * 50}\n')


def test_names_that_no_file_can_have(tmp_path):
    for name in ("a\0b", "x" * 5000):
        with pytest.raises(WeatherFileError):
            load_clouds(tmp_path / name)
        with pytest.raises(OSError):
            save_clouds(tmp_path / name, CloudFile())
    a, b = tmp_path / "a", tmp_path / "b"
    a.symlink_to(b)
    b.symlink_to(a)
    with pytest.raises(WeatherFileError):
        load_clouds(a)
    with pytest.raises(OSError):
        save_clouds(a, CloudFile())
    assert a.is_symlink() and b.is_symlink()


def test_a_byte_order_mark_is_no_harm(tmp_path):
    path = tmp_path / "notepad.toml"
    path.write_bytes(b"\xef\xbb\xbfversion = 2\r\n[fog]\r\nvisibility = 5\r\n")
    fog = load_clouds(path).fog
    assert fog is not None and fog.visibility == 5.0


def test_pipes_and_devices_are_not_read(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(WeatherFileError, match="no such file"):
        load_clouds(pipe)  # and does not wait
    with pytest.raises(OSError, match="not a plain file"):
        save_clouds(pipe, CloudFile())
    with pytest.raises(IsADirectoryError):
        save_clouds(tmp_path, CloudFile())
    assert stat.S_ISFIFO(pipe.stat().st_mode)


# What can fail while a file is written, in the order in which it happens.
FAULTS = ["open", "write", "fsync", "copymode", "replace"]


@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_a_save_that_fails_leaves_the_old_file(tmp_path, monkeypatch, fault, error):
    path = tmp_path / "mine.toml"
    path.write_text("version = 2  # mine\n")
    content = presets.sky("storm")

    def fail(*_: Any, **__: Any) -> None:
        raise error

    class Full:
        """A stream that takes a little before the disk is full."""

        def __init__(self, *args: Any, **kwargs: Any) -> None:
            self.stream = real_open(*args, **kwargs)

        def __enter__(self) -> Full:
            return self

        def __exit__(self, *_: object) -> None:
            self.stream.close()

        def write(self, data: bytes) -> None:
            self.stream.write(data[:10])
            raise error

    real_open = open
    if fault == "open":
        monkeypatch.setattr("weather_ecs.file_text.open", fail, raising=False)
    elif fault == "write":
        monkeypatch.setattr("weather_ecs.file_text.open", Full, raising=False)
    elif fault == "copymode":
        monkeypatch.setattr("shutil.copymode", fail)
    else:
        monkeypatch.setattr(os, fault, fail)
    with pytest.raises(type(error)):
        save_clouds(path, content)
    monkeypatch.undo()
    assert path.read_text() == "version = 2  # mine\n"
    assert os.listdir(tmp_path) == ["mine.toml"]


def test_a_crash_while_saving_leaves_the_old_file(tmp_path):
    """Another process dies at each system call in turn, without any of its clean-up."""
    path = tmp_path / "mine.toml"
    for at in ("fsync", "replace"):
        path.write_text("version = 2  # mine\n")
        child = os.fork()
        if child == 0:
            setattr(os, at, lambda *_: os._exit(7))
            write_text(str(path), text_of("a", CloudFile(fog=Fog())))
            os._exit(0)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
        assert path.read_text() == "version = 2  # mine\n"
        save_clouds(path, CloudFile(fog=Fog(5.0)))  # what was left over is in nobody's way
        got = load_clouds(path).fog
        assert got is not None and got.visibility == 5.0


def test_write_protected_files_are_left_alone(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("mine")
    path.chmod(0o444)
    with pytest.raises(PermissionError, match="write-protected"):
        save_clouds(path, CloudFile())
    assert path.read_text() == "mine" and os.listdir(tmp_path) == ["mine.toml"]


def test_links_modes_and_long_names_are_kept(tmp_path):
    folder = tmp_path / "far"
    folder.mkdir()
    path, link, second = folder / ("n" * 250 + ".toml"), tmp_path / "link", tmp_path / "second"
    path.write_text("mine")
    path.chmod(0o640)
    link.symlink_to(path)
    second.symlink_to(link)
    save_clouds(second, CloudFile(fog=Fog()))
    assert second.is_symlink() and link.is_symlink() and not path.is_symlink()
    assert path.stat().st_mode & 0o777 == 0o640
    assert load_clouds(path).fog is not None
    assert os.listdir(folder) == [path.name]
    dangling = tmp_path / "dangling"
    dangling.symlink_to(folder / "new.toml")
    save_clouds(dangling, CloudFile(fog=Fog()))
    assert load_clouds(folder / "new.toml").fog is not None and dangling.is_symlink()
