"""The editor's session: new, open, save and quit, without a window."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from weather_ecs import CloudFile, load_clouds, save_clouds
from weather_ecs.components import Fog
from weather_ecs.editor.files import Files
from weather_ecs.editor.recent import Recent
from weather_ecs.editor.session import Session
from weather_ecs.editor.shared import Shared


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
