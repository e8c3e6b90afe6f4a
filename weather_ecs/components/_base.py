"""What all components share: fields that are checked whenever they are set."""

from __future__ import annotations

import math
import numbers
from collections.abc import Callable, Sequence
from itertools import count
from typing import Any, ClassVar, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from weather_ecs.errors import InvalidValueError

FAR = 1.0e7  # m, the greatest coordinate: about the size of the Earth

Check = Callable[[str, Any], Any]


class Limits(NamedTuple):
    """What a check lets pass, for those who make values: see `limits_of`."""

    kind: str  # number, integer, flag, choice; vector, direction for several numbers
    low: float = -math.inf
    high: float = math.inf
    above: bool = False  # the lowest itself is not allowed
    size: int = 1  # of a vector
    choices: tuple[str, ...] = ()  # texts
    optional: bool = False  # None is allowed too


_LIMITS: WeakKeyDictionary[Check, Limits] = WeakKeyDictionary()


def limited(check: Check, limits: Limits) -> Check:
    """Let `limits_of` know what a check lets pass; returns the check."""
    _LIMITS[check] = limits
    return check


def limits_of(check: Check) -> Limits | None:
    """What a check lets pass; None for one that takes other things than numbers and texts."""
    return _LIMITS.get(check)


set_raw = object.__setattr__  # past every check
changed = [0]  # another number after an assignment to any component
_counts = count(1)  # two threads that make components at once never come to the same number


class Component:
    """Base of the components: every assignment is checked, a refused one changes nothing.

    Components compare and hash by identity, so that two areas that happen to be equal stay two.
    """

    __slots__ = ("__weakref__",)

    checks: ClassVar[dict[str, Check]] = {}
    revisions: ClassVar[list[int]] = [0]  # its one number is `revision()`

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if Component in cls.__bases__:  # a game's subclass counts with the class it extends
            cls.revisions = [0]

    def __setattr__(self, name: str, value: Any) -> None:
        check = self.checks.get(name)
        if check is None:
            raise AttributeError(f"{type(self).__name__} has no field {name!r}")
        try:
            value = check(name, value)
        except InvalidValueError as error:
            field = f"{type(self).__name__}.{name}"
            raise InvalidValueError(field, error.value, error.allowed) from None
        set_raw(self, name, value)
        self.revisions[0] = changed[0] = next(_counts)

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"the fields of {type(self).__name__} cannot be deleted")

    @classmethod
    def revision(cls) -> int:
        """Counts the assignments to any component of this class; says when a cache is stale."""
        return cls.revisions[0]


def count_assignment(component: Component) -> None:
    """Something of a component is another now; every assignment counts by itself."""
    component.revisions[0] = changed[0] = next(_counts)


def set_unchecked(component: Component, name: str, value: Any) -> None:
    """Set a field whose value is known to be good (a system's own result)."""
    set_raw(component, name, value)
    component.revisions[0] = changed[0] = next(_counts)


def to_float(field: str, value: Any, allowed: str) -> float:
    """A number of any real type as a float; bools, text and arrays are none."""
    kind = type(value)
    if kind is float:
        return value
    if kind is bool or not isinstance(value, numbers.Real):
        raise InvalidValueError(field, value, allowed)
    try:
        return float(value)
    except (OverflowError, ValueError, TypeError):
        raise InvalidValueError(field, value, allowed) from None


def to_floats(field: str, value: Any, size: int, allowed: str) -> tuple[float, ...]:
    """`size` numbers out of a tuple, list, vector type or array of shape (size,)."""
    if isinstance(value, np.ndarray):
        if value.shape != (size,) or value.dtype.kind not in "iuf":
            raise InvalidValueError(field, value, allowed)
        return tuple(value.astype(np.float64).tolist())
    if isinstance(value, (str, bytes, bytearray)) or not isinstance(value, Sequence):
        raise InvalidValueError(field, value, allowed)
    if len(value) != size:
        raise InvalidValueError(field, value, allowed)
    return tuple([to_float(field, item, allowed) for item in value])


def number(low: float, high: float, *, above: bool = False) -> Check:
    """A check for one number in [low, high], or (low, high] with `above`."""
    allowed = f"a number {'>' if above else '>='} {low:g} and <= {high:g}"

    def check(field: str, value: Any) -> float:
        given = value
        if type(value) is not float:
            value = to_float(field, value, allowed)
        if not low <= value <= high or (above and value == low):  # NaN fails the comparison
            raise InvalidValueError(field, given, allowed)
        return value

    return limited(check, Limits("number", low, high, above))


def finite() -> Check:
    """A check for one finite number."""
    allowed = "a finite number"

    def check(field: str, value: Any) -> float:
        result = to_float(field, value, allowed)
        if not math.isfinite(result):
            raise InvalidValueError(field, value, allowed)
        return result

    return limited(check, Limits("number"))


def vector(size: int, low: float, high: float) -> Check:
    """A check for `size` numbers, each in [low, high]."""
    allowed = f"{size} numbers >= {low:g} and <= {high:g}"

    def check(field: str, value: Any) -> tuple[float, ...]:
        result = to_floats(field, value, size, allowed)
        for item in result:
            if not low <= item <= high:
                raise InvalidValueError(field, value, allowed)
        return result

    return limited(check, Limits("vector", low, high, size=size))


def unit_vector(size: int) -> Check:
    """A check for a direction: any vector but zero, brought to length 1."""
    allowed = f"{size} finite numbers, not all zero"

    def check(field: str, value: Any) -> tuple[float, ...]:
        result = to_floats(field, value, size, allowed)
        if not all(map(math.isfinite, result)) or not any(result):
            raise InvalidValueError(field, value, allowed)
        if abs(math.fsum(item * item for item in result) - 1.0) < 1e-12:
            return result  # already of length 1: a second pass must not change a bit
        greatest = max(map(abs, result))
        scaled = [item / greatest for item in result]  # no overflow, whatever the length
        length = math.hypot(*scaled)
        return tuple([item / length for item in scaled])

    return limited(check, Limits("direction", size=size))


def flag() -> Check:
    """A check for True or False."""

    def check(field: str, value: Any) -> bool:
        if not isinstance(value, (bool, np.bool_)):
            raise InvalidValueError(field, value, "True or False")
        return bool(value)

    return limited(check, Limits("flag"))


def integer(low: int, high: int) -> Check:
    """A check for a whole number in [low, high]."""
    allowed = f"a whole number >= {low} and <= {high}"

    def check(field: str, value: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, numbers.Integral):
            raise InvalidValueError(field, value, allowed)
        result = int(value)
        if not low <= result <= high:
            raise InvalidValueError(field, value, allowed)
        return result

    return limited(check, Limits("integer", low, high))
