"""Names of columns one by one: the words of each, and of what component or time it is."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from functools import lru_cache

TIMES = frozenset({"t", "time", "times", "timestamp", "timestamps", "stamp", "stamps"})
TIME_UNIT = re.compile(r"(n|nano|u|micro|m|milli)?(s|secs?|seconds?)|nanos|micros|millis")
FRACTION = re.compile(r"(nano|n|micro|u|µ|μ|milli|m)(?:s|secs?|seconds?)")
FRACTIONS = {"nano": 10**9, "n": 10**9, "milli": 1000, "m": 1000}
"""How many of a unit of times make a second, by its prefix; of all other prefixes a million."""
LENGTHS = frozenset({"m", "mm", "cm", "km", "meter", "meters", "metre", "metres"})
PLAIN = frozenset({"q", "quat", "quaternion"})
QUATERNIONS = PLAIN | {"orientation", "orient", "ori", "rotation", "rot", "attitude", "att"}
POSITIONS = frozenset(
    {"t", "p", "pos", "position", "positions", "trans", "translation", "loc", "location"}
)
PATHS = frozenset({"field", "header", "pose", "msg", "data", "transform"})
"""Words of the paths by which ROS names the fields of a message."""

VECTOR = "xyz"
COMPONENTS = "wxyz"
HAMILTON = {"i": "x", "j": "y", "k": "z", "real": "w", "scalar": "w"}
SCALARS = {"r": "w", "s": "w"}
LETTERS = frozenset({*COMPONENTS, *HAMILTON, *SCALARS})
"""Names of components, those of the other notation too; r and s are so beside ``q`` only: ``rot_r`` is a roll."""

Component = tuple[tuple[str, ...], str]
"""The words before a component, and the component."""

SURE, FRAMED, ELSEWHERE, UNKNOWN = range(4)
"""How surely a name means what it says: ``q``, ``q_RS``, ``gt_q``, ``head``; surer names win."""


@lru_cache(maxsize=1024)
def recognised(name: str) -> bool:
    """Whether a name is one of a column of times, of a quaternion or of a position."""
    component = _component(name)
    if component is None:
        return is_time(name)
    return min(rank(component[0], QUATERNIONS), rank(component[0], POSITIONS)) < UNKNOWN


def is_time(name: str) -> bool:
    """Whether a name is one of a column of times."""
    return time_rank(name) < UNKNOWN


def names_quaternion(names: Iterable[str]) -> bool:
    """Whether all four components of some quaternion are among the names."""
    found = {component for component in components(list(names)) if component}
    return any({(before, part) for part in COMPONENTS} <= found for before, _ in found)


def quaternion_order(names: Iterable[str]) -> str:
    """The components of the quaternion among the names, w and others, from left to right, as xyzw.

    Nothing where there is none, where bare letters are too few to be one, and where some come twice.
    """
    orders: dict[tuple[str, ...], str] = {}
    for before, part in filter(None, components(list(names))):
        orders[before] = orders.get(before, "") + part
    told = [
        order
        for before, order in orders.items()
        if "w" in order and len(order) > (1 if PLAIN & set(before) else 2)
    ]
    order = max(told, key=len, default="")
    return order if len(set(order)) == len(order) else ""


def is_numbered(name: str) -> bool:
    """Whether a name numbers the components of a quaternion, as ``q0`` and ``q[0]``."""
    return re.fullmatch(r"(q|quat|quaternion)_?\d", "_".join(words(name))) is not None


def rank(before: tuple[str, ...], known: frozenset[str]) -> int:
    """How surely the words before a component mean what ``known`` words do."""
    told = tuple(word for word in before if word not in PATHS)
    if not told or (told[0] in known and len(told) == 1):
        return SURE
    if told[0] in known:
        return FRAMED
    return UNKNOWN if known.isdisjoint(told) else ELSEWHERE


def time_rank(name: str) -> int:
    """How surely a name is one of a column of times."""
    told = [word for word in words(name) if word not in PATHS]
    named = [word for word in told if word in TIMES]
    units = [word for word in told if TIME_UNIT.fullmatch(word)]
    if not told or len(named) + len(units) < len(told):
        return UNKNOWN
    if named:
        return SURE if PATHS.isdisjoint(words(name)) else FRAMED
    return UNKNOWN if units == ["s"] else FRAMED  # "secs" beside "nsecs" is half a time


def per_second(name: str) -> int:
    """Units of a column of times in a second: 10**9 of ``timestamp_ns``; 1 where it names none."""
    bracketed = re.findall(r"[\[(]([^\[\]()]*)[\])]", name)
    for word in (*words(name), *(text.strip().lower() for text in bracketed)):
        found = FRACTION.fullmatch(word)
        if found:
            return FRACTIONS.get(found[1], 10**6)
    return 1


def components(names: Sequence[str]) -> list[Component | None]:
    """What component each name is of, if of any; bare i, j, k beside one scalar are a quaternion's."""
    found = [_component(name) for name in names]
    bare = {told[0]: i for i, name in enumerate(names) if len(told := words(name)) == 1}
    scalars = bare.keys() & {"w", "real", "scalar", *SCALARS}
    if bare.keys() >= {"i", "j", "k"} and len(scalars) == 1:
        for name in ("i", "j", "k", *scalars):
            found[bare[name]] = ("q",), (HAMILTON | SCALARS).get(name, name)
    return found


def _component(name: str) -> Component | None:
    """The words before the component and the component, as q, RS and x of ``q_RS_x []``."""
    told = words(name)
    while len(told) > 1 and told[-1] in LENGTHS:
        told = told[:-1]
    if not told:
        return None
    *before, last = told
    if last in COMPONENTS and len(last) == 1:
        return tuple(before), last
    if part := _hamilton(last, frozenset(before)):
        return tuple(before), part
    stem, part = last[:-1], last[-1]
    if part in COMPONENTS and stem in QUATERNIONS | POSITIONS:
        return (*before, stem), part
    if found := re.fullmatch(r"q(r|s|real|scalar)|(?:.+)([ijk])", last):
        stem = "q" if found[1] else last[:-1]
        part = _hamilton(found[1] or found[2], frozenset({stem}))
        return ((*before, stem), part) if part else None
    return None


def _hamilton(letter: str, before: frozenset[str]) -> str:
    """The component that i, j, k, r, s is behind words of a quaternion, or nothing."""
    if before & QUATERNIONS and letter in HAMILTON:
        return HAMILTON[letter]
    return SCALARS.get(letter, "") if before & PLAIN else ""


# -- spelling -------------------------------------------------------------------------------------


def without_units(text: str) -> str:
    """Text without what stands in brackets, as the unit in ``p_RS_R_x [m]``."""
    text = re.sub(
        r"[\[(]([wxyzijk\d]|real|scalar)[\])]", r"_\1", text
    )  # q[x] is an index, not a unit
    return re.sub(r"\[[^\[\]]*\]|\([^()]*\)", "", text)


@lru_cache(maxsize=1024)
def words(name: str) -> tuple[str, ...]:
    """The words of a name in small letters, without units: orientation and x of ``orientationX []``."""
    text = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", without_units(name))
    return tuple(word for word in re.split(r"[\W_]+", text.lower()) if word)
