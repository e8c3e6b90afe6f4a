"""Components whose fields must agree with each other, and values that hold other components."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any, TypeVar

from weather_ecs.components._base import Check, Component, set_raw
from weather_ecs.errors import InvalidValueError

C = TypeVar("C", bound=Component)

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_ -]{0,63}")
NAME = "a name: a letter, then up to 63 letters, digits, spaces, '_' or '-'"


class Agreeing(Component):
    """A component with rules between its fields: an assignment that breaks one changes nothing.

    Its kinds share one revision, so that a model's also counts what is set in its seeds and roots.
    """

    __slots__ = ()

    def agree(self) -> None:
        """Raises InvalidValueError if the fields, each good alone, do not fit together."""

    def __post_init__(self) -> None:
        self.agree()

    def __setattr__(self, name: str, value: Any) -> None:
        complete = hasattr(self, next(reversed(self.checks)))  # set last when it is made
        before = getattr(self, name) if complete and name in self.checks else None
        Component.__setattr__(self, name, value)
        if complete:
            try:
                self.agree()
            except InvalidValueError:
                set_raw(self, name, before)
                raise

    def change(self, **values: Any) -> None:
        """Set several fields together; only then do they have to agree. Raises InvalidValueError,
        and then none of them is changed.
        """
        before = {name: getattr(self, name) for name in values}
        try:
            for name, value in values.items():
                Component.__setattr__(self, name, value)
            self.agree()
        except InvalidValueError:
            for name, value in before.items():
                set_raw(self, name, value)
            raise


def a_name() -> Check:
    """A check for a name."""

    def check(field: str, value: Any) -> str:
        if not isinstance(value, str) or not _NAME.fullmatch(value):
            raise InvalidValueError(field, value, NAME)
        return str(value)

    return check


def some_names(least: int, most: int) -> Check:
    """A check for `least` to `most` names."""
    allowed = f"{least} to {most} names, in a tuple or list"
    one = a_name()

    def check(field: str, value: Any) -> tuple[str, ...]:
        items = _items(field, value, most, allowed)
        if len(items) < least:
            raise InvalidValueError(field, value, allowed)
        return tuple([one(field, item) for item in items])

    return check


def parts(kind: type[C], most: int) -> Check:
    """A check for up to `most` of a component, each itself or a mapping of its fields."""
    allowed = f"up to {most} {kind.__name__}, in a tuple or list"

    def check(field: str, value: Any) -> tuple[C, ...]:
        return tuple(
            [part(kind, field, item, allowed) for item in _items(field, value, most, allowed)]
        )

    return check


def part(kind: type[C], field: str, value: Any, allowed: str) -> C:
    """`value` as a component of a kind: itself, or made from a mapping of its fields."""
    if isinstance(value, kind):
        return value
    if not isinstance(value, Mapping):
        raise InvalidValueError(field, value, allowed)
    known = [entry.name for entry in fields(kind)]  # type: ignore[arg-type]
    unknown = [key for key in value if key not in known]
    if unknown:
        raise InvalidValueError(field, unknown[0], f"fields of {kind.__name__}: {', '.join(known)}")
    try:
        return kind(**value)
    except InvalidValueError as error:
        raise InvalidValueError(field, error.value, f"{error.field}: {error.allowed}") from None
    except TypeError:
        raise InvalidValueError(field, value, f"a {kind.__name__} with all its fields") from None


def _items(field: str, value: Any, most: int, allowed: str) -> Sequence[Any]:
    if isinstance(value, (str, bytes, bytearray)) or not isinstance(value, Sequence):
        raise InvalidValueError(field, value, allowed)
    if len(value) > most:
        raise InvalidValueError(field, f"{len(value)} of them", allowed)
    return value
