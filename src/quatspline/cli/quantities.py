"""Words of the command line as quantities: numbers within bounds, angles and units of time."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from contextlib import suppress
from fractions import Fraction
from typing import Any


def _number(kind: type, accepts: Callable[[Any], bool], wanted: str) -> Callable[[str], Any]:
    def parsed(text: str) -> Any:
        with suppress(ValueError):
            if text.isascii() and "_" not in text and accepts(value := kind(text)):
                return value
        raise argparse.ArgumentTypeError(f"{text!r}: expected {wanted}")

    return parsed


def angle(text: str) -> float:
    """An angle in rad of a number with its unit."""
    number = text.strip().lower().removesuffix("°")
    unit = "deg" if number != text.strip().lower() else number[-3:]
    number = number.removesuffix(unit)
    with suppress(ValueError):
        value = float(number) * {"deg": math.pi / 180.0, "rad": 1.0}.get(unit, math.nan)
        if 0.0 < value < math.inf:
            return value
    raise argparse.ArgumentTypeError(
        f"{text!r}: expected a positive angle with its unit, such as 0.5deg"
    )


SECONDS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0}


def unit(text: str) -> float:
    """Seconds of a unit of time, of several or of a fraction of one."""
    number, _, name = text.strip().rpartition(" ")
    with suppress(ValueError, ZeroDivisionError):
        seconds = float(Fraction(number or 1)) * SECONDS.get(name, math.nan)
        if 0.0 < seconds < math.inf:
            return seconds
    units = ", ".join(SECONDS)
    raise argparse.ArgumentTypeError(
        f"{text!r}: expected one of {units}, or a multiple such as '1/30 s'"
    )


rate = _number(float, lambda value: 0.0 < value < math.inf, "a positive number")
least = _number(float, lambda value: 0.0 <= value < math.inf, "a number, at least 0")
MOST = 2**63 - 1
"""The largest count accepted: a larger number is a slip of the keyboard and fits no array."""

count = _number(int, lambda value: 1 <= value <= MOST, "a whole number, at least 1")
frames = _number(int, lambda value: 0 <= value <= MOST, "a whole number, at least 0")
seed = _number(int, lambda value: value >= 0, "a whole number, at least 0")
