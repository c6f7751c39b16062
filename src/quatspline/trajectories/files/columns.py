"""Columns by their names, in the spellings that tools write; what contradicts itself is refused."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

CSV_COLUMNS = ("t", "qw", "qx", "qy", "qz")
POSITION_COLUMNS = ("tx", "ty", "tz")
TUM_COLUMNS = ("t", *POSITION_COLUMNS, "qx", "qy", "qz", "qw")

TIMES = frozenset({"t", "time", "times", "timestamp", "timestamps", "stamp", "stamps"})
TIME_UNIT = re.compile(r"(n|nano|u|micro|m|milli)?(s|secs?|seconds?)|nanos|micros|millis")
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

EXACT, FRAMED, ELSEWHERE, UNKNOWN = range(4)
"""How surely a name means what it says: ``q``, ``q_RS``, ``gt_q``, ``head``; surer names win."""


@dataclass(frozen=True)
class Layout:
    """Where a file has what it holds.

    Attributes
    ----------
    time : the column of times
    quaternion : those of w, x, y, z
    position : those of x, y, z, or None
    unread : names of all other columns
    """

    time: int
    quaternion: tuple[int, ...]
    position: tuple[int, ...] | None
    unread: tuple[str, ...]

    @property
    def picked(self) -> tuple[int, ...]:
        """Columns in the order t, qw, qx, qy, qz and, where there are some, tx, ty, tz."""
        return (self.time, *self.quaternion, *(self.position or ()))

    @property
    def order(self) -> str:
        """The components of the quaternion from left to right."""
        return "".join(sorted(COMPONENTS, key=lambda part: self.quaternion[COMPONENTS.index(part)]))


@dataclass(frozen=True)
class _Group:
    """Columns that share all of their names but the last letter."""

    words: tuple[str, ...]
    columns: dict[str, int]

    def rank(self, known: frozenset[str]) -> int:
        words = tuple(word for word in self.words if word not in PATHS)
        if not words or (words[0] in known and len(words) == 1):
            return EXACT
        if words[0] in known:
            return FRAMED
        return UNKNOWN if known.isdisjoint(words) else ELSEWHERE

    def has(self, components: str) -> bool:
        return all(part in self.columns for part in components)


def layout(names: Sequence[str]) -> Layout:
    """The layout that names of columns describe.

    Raises
    ------
    ValueError
        Where they lack something, or name something twice.
    """
    groups = _groups(names)
    time = _time(names)
    quaternion = _quaternion(names, groups)
    position = _position(names, [group for group in groups if group is not quaternion])
    q = tuple(quaternion.columns[part] for part in COMPONENTS)
    x = tuple(position.columns[part] for part in VECTOR) if position else None
    read = {time, *q, *(x or ())}
    unread = tuple(name.strip() for i, name in enumerate(names) if i not in read and name.strip())
    return Layout(time, q, x, unread)


def recognised(name: str) -> bool:
    """Whether a name is one of a column of times, of a quaternion or of a position."""
    component = _component(name)
    if component is None:
        return _time_rank(name) < UNKNOWN
    group = _Group(component[0], {})
    return min(group.rank(QUATERNIONS), group.rank(POSITIONS)) < UNKNOWN


def names_quaternion(names: Iterable[str]) -> bool:
    """Whether all four components of some quaternion are among the names."""
    found = {component for name in names if (component := _component(name))}
    return any({(words, part) for part in COMPONENTS} <= found for words, _ in found)


def quaternion_order(names: Iterable[str]) -> str:
    """The components that names end in, from left to right, as xyzw; other names count for nothing."""
    return "".join(component[1] for name in names if (component := _component(name)))


# -- times ----------------------------------------------------------------------------------------


def _time(names: Sequence[str]) -> int:
    ranks = [_time_rank(name) for name in names]
    best = min(ranks, default=UNKNOWN)
    if best == UNKNOWN:
        raise ValueError(f"no column of times, such as 't', in the header: {_quoted(names)}")
    found = [i for i, rank in enumerate(ranks) if rank == best]
    if len(found) > 1:
        raise ValueError(f"{_quoted(names[i] for i in found)}: more than one column of times")
    return found[0]


def _time_rank(name: str) -> int:
    words = [word for word in _words(name) if word not in PATHS]
    named = [word for word in words if word in TIMES]
    units = [word for word in words if TIME_UNIT.fullmatch(word)]
    if not words or len(named) + len(units) < len(words):
        return UNKNOWN
    if named:
        return EXACT if PATHS.isdisjoint(_words(name)) else FRAMED
    return UNKNOWN if units == ["s"] else FRAMED  # "secs" beside "nsecs" is half a time


# -- components -----------------------------------------------------------------------------------


def _quaternion(names: Sequence[str], groups: list[_Group]) -> _Group:
    whole = [group for group in groups if group.has(COMPONENTS)]
    best = min((group.rank(QUATERNIONS) for group in whole), default=UNKNOWN)
    found = [group for group in whole if group.rank(QUATERNIONS) == best]
    if not found:
        raise ValueError(_lacking(names, groups))
    chosen = found[0]
    rivals = [g for g in groups if g is not chosen and (g in found or _contends(g, best))]
    if rivals:
        part = next(part for part in COMPONENTS if part in rivals[0].columns)
        pair = [names[group.columns[part]] for group in (chosen, rivals[0])]
        raise ValueError(f"{_quoted(pair)}: more than one column may be the quaternion's {part}")
    return chosen


def _contends(group: _Group, best: int) -> bool:
    """Whether a group, though not whole, claims a part of the quaternion as surely as one that is."""
    named = not PLAIN.isdisjoint(group.words) or "w" in group.columns
    return named and group.rank(QUATERNIONS) <= best


def _lacking(names: Sequence[str], groups: list[_Group]) -> str:
    part = [g for g in groups if "w" in g.columns or not PLAIN.isdisjoint(g.words)]
    if not part:
        numbered = [
            name for name in names if re.fullmatch(r"(q|quat|quaternion)_?\d", _spelled(name))
        ]
        if numbered:
            return f"{_quoted(numbered)}: numbers do not say which of them is w; name w, x, y and z"
        return f"no quaternion, such as 'qw', 'qx', 'qy', 'qz', in the header: {_quoted(names)}"
    most = max(part, key=lambda group: (len(group.columns), -group.rank(QUATERNIONS)))
    missing = next(c for c in COMPONENTS if c not in most.columns)
    found = _quoted(names[i] for i in most.columns.values())
    return f"no column of the quaternion's {missing} in the header, beside {found}"


def _position(names: Sequence[str], groups: list[_Group]) -> _Group | None:
    named = [g for g in groups if g.rank(POSITIONS) < UNKNOWN and "w" not in g.columns]
    best = min((group.rank(POSITIONS) for group in named if group.has(VECTOR)), default=UNKNOWN)
    found = [group for group in named if group.has(VECTOR) and group.rank(POSITIONS) == best]
    for group in named:
        if group.words and group.rank(POSITIONS) == EXACT and not group.has(VECTOR):
            missing = next(part for part in VECTOR if part not in group.columns)
            beside = _quoted(names[i] for i in group.columns.values())
            raise ValueError(
                f"no column of the position's {missing} in the header, beside {beside}"
            )
    if len(found) > 1:
        pair = [names[group.columns["x"]] for group in found[:2]]
        raise ValueError(f"{_quoted(pair)}: more than one column may be the position's x")
    return found[0] if found else None


def _groups(names: Sequence[str]) -> list[_Group]:
    groups: dict[tuple[str, ...], _Group] = {}
    for i, name in enumerate(names):
        if component := _component(name):
            words, part = component
            columns = groups.setdefault(words, _Group(words, {})).columns
            if part in columns:
                pair = _quoted([names[columns[part]], name])
                raise ValueError(f"{pair}: two columns of one name in the header")
            columns[part] = i
    return list(groups.values())


def _component(name: str) -> tuple[tuple[str, ...], str] | None:
    """The words before the component and the component, as q, RS and x of ``q_RS_x []``."""
    words = _words(name)
    while len(words) > 1 and words[-1] in LENGTHS:
        words = words[:-1]
    if not words:
        return None
    *before, last = words
    if last in COMPONENTS and len(last) == 1:
        return tuple(before), last
    stem, part = last[:-1], last[-1]
    if part in COMPONENTS and stem in QUATERNIONS | POSITIONS:
        return (*before, stem), part
    return None


# -- spelling -------------------------------------------------------------------------------------


def without_units(text: str) -> str:
    """Text without what stands in brackets, as the unit in ``p_RS_R_x [m]``."""
    text = re.sub(r"[\[(]([wxyz\d])[\])]", r"_\1", text)  # q[x] is an index, not a unit
    return re.sub(r"\[[^\]]*\]|\([^)]*\)", "", text)


def _words(name: str) -> tuple[str, ...]:
    text = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", without_units(name))  # orientationX, qW
    return tuple(word for word in re.split(r"[\W_]+", text.lower()) if word)


def _spelled(name: str) -> str:
    return "_".join(_words(name))


def _quoted(names: Iterable[str]) -> str:
    return ", ".join(repr(name.strip()) for name in names)
