"""Files of the editor: opening, saving, changes on disk, recent ones."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest

from tests.editor_texts import WRITTEN, opened, with_fog
from weather_ecs import CloudFile, WeatherFileError, load_clouds, save_clouds
from weather_ecs.components import CloudModel, CloudSeed, Wind
from weather_ecs.editor import content as changes
from weather_ecs.editor import files as files_module
from weather_ecs.editor.files import ChangedOnDiskError, Files, OnDisk
from weather_ecs.editor.recent import MOST, Recent


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Files:
    monkeypatch.setattr(files_module, "LOOK_EVERY", 0.0)
    return Files(Recent(tmp_path / "settings" / "recent.json"))


@pytest.fixture
def path(tmp_path: Path) -> Path:
    place = tmp_path / "evening.toml"
    place.write_text(WRITTEN, encoding="utf-8")
    return place


def test_open_save_and_save_as(files, path, tmp_path):
    document = opened(files, path)
    assert not document.dirty and document.name == "evening.toml"
    with_fog(document)
    files.save(document)
    assert not document.dirty
    assert path.read_text().startswith(WRITTEN.partition("\n# the end")[0])
    other = tmp_path / "other.toml"
    with_fog(document, 60.0)
    files.save_as(document, other)
    assert document.path == other and load_clouds(other).fog.visibility == 60.0  # type: ignore[union-attr]
    assert load_clouds(path).fog.visibility == 500.0  # type: ignore[union-attr]
    assert "# made by hand" in other.read_text()
    generation = document.generation
    files.new(document)
    assert document.path is None and document.content == CloudFile() and not document.can_undo
    assert document.generation != generation
    with pytest.raises(FileNotFoundError):
        files.save(document)


def test_an_older_version_is_written_as_the_present_one(tmp_path, files):
    path = tmp_path / "old.toml"
    path.write_bytes(b"version = 1 # old\r\n[[layers]] # mine\r\nbase = 5 # m\r\n")
    document = opened(files, path)
    assert not document.dirty
    with_fog(document)
    files.save(document)
    text = path.read_bytes()
    assert text.startswith(b"version = 2 # old\r\n[[layers]] # mine\r\nbase = 5 # m\r\n")
    assert text.count(b"\n") == text.count(b"\r\n")  # lines end as they did
    assert load_clouds(path).fog is not None


def test_a_bad_file_leaves_the_document_as_it_was(files, path, tmp_path):
    document = opened(files, path)
    with_fog(document)
    content = document.content
    bad = tmp_path / "bad.toml"
    bad.write_text("version = 2\n[fog]\nvisibility = -1\n")
    for name in (bad, tmp_path / "none.toml", tmp_path):
        with pytest.raises(WeatherFileError):
            files.open(document, name)
    assert document.content is content and document.path == path and document.can_undo


def test_a_full_disk_leaves_file_and_document(files, path, monkeypatch):
    document = opened(files, path)
    with_fog(document)
    content = document.content

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(OSError, match="No space"):
        files.save(document)
    assert path.read_text() == WRITTEN and document.content is content and document.dirty
    monkeypatch.undo()
    files.save(document)
    assert not document.dirty


def test_a_file_made_read_only_is_refused(files, path):
    document = opened(files, path)
    with_fog(document)
    path.chmod(0o400)
    with pytest.raises(PermissionError):
        files.save(document)
    assert document.dirty and path.read_text() == WRITTEN


def test_a_file_that_is_gone_is_written_again(files, path):
    document = opened(files, path)
    path.unlink()
    news = files.follow(document)
    assert news is not None and news.bad and "gone" in news.text
    assert files.follow(document) is None  # told once
    assert document.dirty and not document.edited
    files.save(document)
    assert path.read_text() == WRITTEN and not document.dirty
    path.unlink()
    files.follow(document)
    path.write_text(WRITTEN)
    files.follow(document)
    assert not document.dirty  # it is back as it was


def test_a_change_on_disk_is_taken_and_can_be_undone(files, path):
    document = opened(files, path)
    before = document.content
    assert files.follow(document) is None
    path.write_text(WRITTEN.replace("120.5", "7"))
    news = files.follow(document)
    assert news is not None and not news.bad
    assert document.content.climate is not None and document.content.climate.duration == 7.0
    assert not document.dirty and document.undo_label == "reload of evening.toml"
    document.undo()
    assert document.content is before and document.dirty
    files.save(document)
    assert path.read_text() == WRITTEN.replace("120.5", "120.5")


def test_a_file_that_is_touched_alone_is_no_news(files, path):
    document = opened(files, path)
    os.utime(path, ns=(1, 1))
    assert files.follow(document) is None
    path.write_text(WRITTEN)
    assert files.follow(document) is None and not document.dirty


def test_a_broken_state_on_disk_keeps_what_there_was(files, path):
    document = opened(files, path)
    content = document.content
    path.write_text(WRITTEN.replace("duration = 120.5", "duration = "))
    news = files.follow(document)
    assert news is not None and news.bad
    assert "evening.toml" in news.text and "line" in news.text
    assert document.content is content and document.dirty
    assert files.follow(document) is None
    with pytest.raises(ChangedOnDiskError):
        files.save(document)
    path.write_text(WRITTEN.replace("120.5", "8"))
    news = files.follow(document)  # it is good again, and nothing was edited here
    assert news is not None and not news.bad and not document.dirty
    assert document.content.climate is not None and document.content.climate.duration == 8.0


def test_two_changes_at_once_are_for_the_user_to_decide(files, path):
    document = opened(files, path)
    with_fog(document)
    mine = document.content
    theirs = WRITTEN.replace("120.5", "7")
    path.write_text(theirs)
    news = files.follow(document)
    assert news is not None and news.bad and document.content is mine
    assert files.on_disk(document) is OnDisk.SAME
    with pytest.raises(ChangedOnDiskError, match="changed on disk"):
        files.save(document)
    assert path.read_text() == theirs
    files.save(document, anyway=True)
    assert load_clouds(path).fog is not None and not document.dirty
    files.save(document)


def test_recent_files_are_kept_from_run_to_run(tmp_path):
    place = tmp_path / "deep" / "recent.json"
    recent = Recent(place)
    for number in range(MOST + 3):
        recent.add(tmp_path / f"{number}.toml")
    recent.add(tmp_path / "7.toml")
    again = Recent(place)
    assert again.paths == recent.paths and len(again.paths) == MOST
    assert again.paths[:2] == (tmp_path / "7.toml", tmp_path / f"{MOST + 2}.toml")
    again.remove(tmp_path / "7.toml")
    assert tmp_path / "7.toml" not in Recent(place).paths
    for bad in (b"", b"[", b"{}", b'[1, null, ""]', b"\xff", b"[" * 60_000):
        place.write_bytes(bad)
        assert Recent(place).paths == ()
    blocked = tmp_path / "file"
    blocked.write_text("")
    Recent(blocked / "recent.json").add(tmp_path)  # nowhere to write: no error


def test_without_a_home_there_are_no_recent_files(tmp_path, monkeypatch):
    def nobody() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("XDG_CONFIG_HOME", raising=False)
    monkeypatch.delenv("APPDATA", raising=False)
    monkeypatch.setattr(Path, "home", nobody)
    recent = Recent()
    recent.add(tmp_path)
    assert recent.paths == (tmp_path,)
    assert Recent().paths == ()


def test_a_file_that_cannot_be_opened_any_more_is_no_recent_one(files, path):
    document = opened(files, path)
    assert files.recent.paths == (path,)
    path.unlink()
    with pytest.raises(WeatherFileError):
        files.open(document, path)
    assert files.recent.paths == ()


def test_links_are_kept_by_the_editor(files, path, tmp_path):
    link = tmp_path / "link.toml"
    link.symlink_to(path)
    document = opened(files, link)
    document.apply("Wind", replace(document.content, winds=(Wind(),)))
    files.save(document)
    assert link.is_symlink() and len(load_clouds(path).winds) == 1


def test_a_large_file_is_opened_and_saved(files, tmp_path):
    seeds = tuple(CloudSeed((k, 0, 0)) for k in range(40))
    models = tuple(CloudModel(f"m{k}", seeds) for k in range(50))
    path = tmp_path / "large.toml"
    save_clouds(path, CloudFile(models))
    document = opened(files, path)
    seed = replace(document.content.models[30].seeds[20], width=7.0)
    document.apply("Width", changes.with_seed(document.content, 30, 20, seed))
    before = path.read_text()
    files.save(document)
    changed = [a for a, b in zip(before.splitlines(), path.read_text().splitlines(), strict=True)
               if a != b]  # fmt: skip
    assert changed == ["width = 100.0"]
