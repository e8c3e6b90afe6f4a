"""Which cloud model a name means."""

from __future__ import annotations

import logging

import esper
import pytest

from tests.cloud_worlds import model
from weather_ecs.components import CloudModel, Sky
from weather_ecs.systems.cloud_models import ModelBook
from weather_ecs.systems.uids import Uids

pytestmark = pytest.mark.usefixtures("world")

OWN = model("cumulus", size=900.0)


def package(name: str) -> CloudModel | None:
    return OWN if name == "cumulus" else None


def test_a_model_means_itself() -> None:
    loose = model("never heard of")
    assert ModelBook().find(loose, Uids()) is loose


def test_the_world_comes_before_the_package() -> None:
    book, uids = ModelBook(package), Uids()
    assert book.find("cumulus", uids) is OWN
    mine = model("cumulus")
    entity = esper.create_entity(mine)
    assert book.find("cumulus", uids) is mine
    esper.delete_entity(entity, immediate=True)
    assert book.find("cumulus", uids) is OWN


def test_one_that_is_about_to_be_deleted_counts_no_more() -> None:
    book, uids = ModelBook(package), Uids()
    entity = esper.create_entity(model("cumulus"))
    esper.delete_entity(entity)
    assert book.find("cumulus", uids) is OWN


def test_of_two_of_a_name_the_older_is_meant() -> None:
    book, uids = ModelBook(), Uids()
    first, second = model("mine"), model("mine", size=500.0)
    entity = esper.create_entity(first)
    esper.create_entity(second)
    assert book.find("mine", uids) is first
    esper.delete_entity(entity, immediate=True)
    assert book.find("mine", uids) is second


def test_a_model_that_gets_another_name_is_found_by_it() -> None:
    book, uids = ModelBook(package), Uids()
    mine = model("mine")
    esper.create_entity(mine)
    assert book.find("mine", uids) is mine
    mine.name = "cumulus"
    assert book.find("cumulus", uids) is mine
    assert book.find("mine", uids) is None


def test_the_package_is_asked_once_for_each_name() -> None:
    asked: list[str] = []

    def counting(name: str) -> CloudModel | None:
        asked.append(name)
        return package(name)

    book, uids = ModelBook(counting), Uids()
    for name in ("cumulus", "fog", "cumulus", "fog"):
        book.find(name, uids)
    assert asked == ["cumulus", "fog"]


def test_an_unknown_name_is_said_once(caplog: pytest.LogCaptureFixture) -> None:
    book, uids = ModelBook(), Uids()
    with caplog.at_level(logging.WARNING, "weather_ecs"):
        for name in ("cumulas", "stratsu", "cumulas"):
            assert book.find(name, uids) is None
    assert [record.args for record in caplog.records] == [("cumulas",), ("stratsu",)]


def test_models_of_skies_are_by_state_and_name_and_unknown_ones_are_left_out() -> None:
    book, uids, nested = ModelBook(package), Uids(), model("mine")
    skies = (
        Sky(0.0, ("cumulus", nested), count=3),
        Sky(1.0, ("cumulus", "unheard of"), count=3),
    )
    found = book.of_skies(skies, uids)
    assert found == {(0.0, "cumulus"): OWN, (0.0, "mine"): nested, (1.0, "cumulus"): OWN}
