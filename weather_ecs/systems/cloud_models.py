"""`ModelBook`: which `CloudModel` a name means."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable
from typing import Any

import esper

from weather_ecs.components import CloudModel, Sky
from weather_ecs.systems.queries import alive
from weather_ecs.systems.uids import Uids

Package = Callable[[str], CloudModel | None]

_log = logging.getLogger("weather_ecs")


def no_package(name: str) -> None:
    """A package that has no models."""


class ModelBook:
    """Models by name: the oldest entity's one of that name, or else the package's own."""

    __slots__ = ("_known", "_list", "_package", "_packaged", "_revision", "_warned")

    def __init__(self, package: Package = no_package) -> None:
        self._package = package
        self._packaged: dict[str, CloudModel | None] = {}
        self._known: dict[str, CloudModel] = {}
        self._list: list[Any] | None = None
        self._revision = -1
        self._warned: set[str] = set()

    def find(self, model: CloudModel | str, uids: Uids) -> CloudModel | None:
        """The model of a name; None, and one line in the log, if there is none."""
        if isinstance(model, CloudModel):
            return model
        self._update(uids)
        found = self._known.get(model)
        if found is None:
            if model not in self._packaged:
                self._packaged[model] = self._package(model)
            found = self._packaged[model]
        if found is None and model not in self._warned:
            self._warned.add(model)
            _log.warning("no cloud model is called %r; its clouds are not shown", model)
        return found

    def of_skies(self, skies: Iterable[Sky], uids: Uids) -> dict[tuple[float, str], CloudModel]:
        """The models of skies, by state and name."""
        models: dict[tuple[float, str], CloudModel] = {}
        for sky in skies:
            for model in sky.models:
                found = self.find(model, uids)
                if found is not None:
                    name = model if isinstance(model, str) else model.name
                    models.setdefault((sky.state, name), found)
        return models

    def _update(self, uids: Uids) -> None:
        pairs, revision = esper.get_component(CloudModel), CloudModel.revision()
        if pairs is not self._list or revision != self._revision:
            self._list, self._revision = pairs, revision
            self._known = {}
            for _, model in alive(CloudModel, uids):
                self._known.setdefault(model.name, model)
