"""The editor's session: new, open, save and quit, without a window."""

from __future__ import annotations

import os
import sys
import time
from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import Any

import pytest

from weather_ecs import CloudFile, load_clouds, save_clouds
from weather_ecs.components import CloudModel, CloudSeed, Fog
from weather_ecs.editor import files
from weather_ecs.editor.files import Files
from weather_ecs.editor.recent import Recent
from weather_ecs.editor.saving import LARGE
from weather_ecs.editor.session import Session
from weather_ecs.editor.shared import Shared
from weather_ecs.file_text import write_text


@pytest.fixture
def session(tmp_path: Path) -> Session:
    """A file with thin fog, open, with dense fog here and not yet saved."""
    path = tmp_path / "fog.toml"
    save_clouds(path, CloudFile(fog=Fog(9000.0)))
    gl: Any = None
    made = Session(Shared(gl), Files(Recent(tmp_path / "recent")))
    assert made.load(path)
    made.document.apply("fog", replace(made.document.content, fog=Fog(300.0)))
    return made


def seen(session: Session) -> float:
    """Metres that the file on disk lets one see."""
    assert session.document.path is not None
    fog = load_clouds(session.document.path).fog
    assert fog is not None
    return fog.visibility


def somebody_writes(session: Session) -> None:
    path = session.document.path
    assert path is not None
    save_clouds(path, CloudFile(fog=Fog(2000.0)))
    os.utime(path, ns=(1, 1))  # another time of change, however quick it went


def test_a_save_writes_the_file(session: Session) -> None:
    done: list[str] = []
    session.save(then=lambda: done.append("then"))
    assert (seen(session), done, session.document.dirty) == (300.0, ["then"], False)


def test_what_another_program_has_written_is_not_lost_without_a_question(session: Session) -> None:
    somebody_writes(session)
    done: list[str] = []
    session.save(then=lambda: done.append("then"))
    assert session.changed_outside and seen(session) == 2000.0
    assert done == [] and session.document.dirty and not session.trouble


def test_who_keeps_what_is_here_writes_it_with_the_next_save(session: Session) -> None:
    somebody_writes(session)
    session.save()
    session.keep_mine()
    assert not session.changed_outside
    session.save()
    assert seen(session) == 300.0 and not session.document.dirty
    # Only that once.
    session.document.apply("fog", replace(session.document.content, fog=Fog(400.0)))
    somebody_writes(session)
    session.save()
    assert session.changed_outside and seen(session) == 2000.0


def test_who_reads_it_again_has_theirs_and_can_undo_it(session: Session) -> None:
    somebody_writes(session)
    session.save()
    session.reload()
    fog = session.document.content.fog
    assert fog is not None and fog.visibility == 2000.0
    session.document.undo()
    fog = session.document.content.fog
    assert fog is not None and fog.visibility == 300.0


def test_what_cannot_be_written_is_told_and_nothing_is_lost(session: Session) -> None:
    path = session.document.path
    assert path is not None
    path.unlink()
    path.mkdir()
    session.save()
    assert session.document.dirty and session.trouble and not session.changed_outside


def many_seeds() -> CloudFile:
    """A file that takes longer to save than a frame."""
    seeds = tuple(CloudSeed((float(k), 100.0, 0.0), 50.0, 40.0, 50.0) for k in range(LARGE))
    return CloudFile(models=(CloudModel("large", seeds),), fog=Fog(9000.0))


def until_saved(session: Session) -> None:
    """Frames pass until the save has ended."""
    end = time.monotonic() + 60.0
    while session.saving:
        assert time.monotonic() < end
        session.look_at_disk()
        time.sleep(0.001)


def test_a_large_document_is_saved_beside_the_frames(
    session: Session, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    go, interval = Event(), sys.getswitchinterval()
    monkeypatch.setattr(files, "write_text", lambda *what: (go.wait(60.0), write_text(*what)))
    document, done = session.document, []
    document.apply("large", many_seeds())
    session.save(then=lambda: done.append(document.dirty))
    for _ in range(5):
        session.look_at_disk()
    assert session.saving and document.dirty and not done  # it is still being written
    # What is changed meanwhile is not what is written, and remains to be saved.
    document.apply("fog", replace(document.content, fog=Fog(123.0)))
    go.set()
    until_saved(session)
    assert done == [True] and document.dirty and document.edited and seen(session) == 9000.0
    assert sys.getswitchinterval() == interval and not session.trouble
    document.undo()
    assert not document.dirty
    document.redo()
    session.save()
    until_saved(session)
    assert not document.dirty and seen(session) == 123.0
    assert len(load_clouds(document.path or "").models[0].seeds) == LARGE


def test_who_leaves_waits_for_the_save_and_reads_what_went_wrong(session: Session) -> None:
    document = session.document
    document.apply("large", many_seeds())
    session.save()
    session.quit()
    assert session.closing and not document.dirty and seen(session) == 9000.0
    session.closing = False
    assert document.path is not None
    document.path.unlink()
    document.path.mkdir()
    document.apply("fog", replace(document.content, fog=Fog(123.0)))
    session.save()
    session.quit()
    assert session.trouble and document.dirty and not session.closing and session.question is None
    session.trouble = ""
    session.quit()
    assert session.question is not None
