"""Quantities that glide from one value to another without a jump in value or rate."""

from __future__ import annotations


def glide(start: float, rate: float, end: float, seconds: float, passed: float) -> float:
    """The value after `passed` of `seconds`; it begins at a rate, per second, and ends at rest.

    The cubic of Hermite; from rest it is the smoothstep.
    """
    if passed >= seconds:
        return end
    u = passed / seconds
    rest = u * u * (3.0 - 2.0 * u)
    return start + (end - start) * rest + rate * seconds * u * (1.0 - u) * (1.0 - u)


def glide_rate(start: float, rate: float, end: float, seconds: float, passed: float) -> float:
    """How fast that value changes, per second."""
    if passed >= seconds:
        return 0.0
    u = passed / seconds
    return (end - start) / seconds * 6.0 * u * (1.0 - u) + rate * (1.0 - u) * (1.0 - 3.0 * u)
