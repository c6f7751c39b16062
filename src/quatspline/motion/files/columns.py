"""Layouts of columns that names describe; what contradicts itself is refused."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from quatspline.motion.files.names import (
    COMPONENTS,
    PLAIN,
    POSITIONS,
    QUATERNIONS,
    SURE,
    UNKNOWN,
    VECTOR,
    components,
    is_numbered,
    rank,
    time_rank,
)

CSV_COLUMNS = ("t", "qw", "qx", "qy", "qz")
POSITION_COLUMNS = ("tx", "ty", "tz")
TUM_COLUMNS = ("t", *POSITION_COLUMNS, "qx", "qy", "qz", "qw")


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
        return rank(self.words, known)

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


def is_readable(names: Sequence[str]) -> bool:
    """Whether names describe a layout."""
    try:
        layout(names)
    except ValueError:
        return False
    return True


# -- times ----------------------------------------------------------------------------------------


def _time(names: Sequence[str]) -> int:
    ranks = [time_rank(name) for name in names]
    best = min(ranks, default=UNKNOWN)
    if best == UNKNOWN:
        raise ValueError(f"no column of times, such as 't', in the header: {_quoted(names)}")
    found = [i for i, rank in enumerate(ranks) if rank == best]
    if len(found) > 1:
        raise ValueError(f"{_quoted(names[i] for i in found)}: more than one column of times")
    return found[0]


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
        numbered = [name for name in names if is_numbered(name)]
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
        if group.words and group.rank(POSITIONS) == SURE and not group.has(VECTOR):
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
    for i, component in enumerate(components(names)):
        if component:
            before, part = component
            columns = groups.setdefault(before, _Group(before, {})).columns
            if part in columns:
                pair = _quoted([names[columns[part]], names[i]])
                raise ValueError(f"{pair}: two columns of one name in the header")
            columns[part] = i
    return list(groups.values())


def _quoted(names: Iterable[str]) -> str:
    return ", ".join(repr(name.strip()) for name in names)
