"""Layouts of columns that names describe; what contradicts itself is refused."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from quatspline.motion.files.forms import QUATERNION, Form, other_form
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
    per_second,
    rank,
    time_rank,
    words,
)

POSITION_COLUMNS = ("tx", "ty", "tz")
CSV_COLUMNS = ("t", *QUATERNION.names)
TUM_COLUMNS = ("t", *POSITION_COLUMNS, "qx", "qy", "qz", "qw")
EUROC_COLUMNS = (
    "timestamp",
    *(f"p_RS_R_{part} [m]" for part in VECTOR),
    *(f"q_RS_{part} []" for part in COMPONENTS),
)
KITTI_COLUMNS = ("r00", "r01", "r02", "tx", "r10", "r11", "r12", "ty", "r20", "r21", "r22", "tz")

EUROC = (("q", "rs"), 10**9)
"""By which EuRoC's files are known, whose stamps are nanoseconds without saying so."""

MOST = 10_000
"""Columns of a file: what one more may mean is asked of every name."""

TRACKS = frozenset({"joint", "track"})
"""What the column is called that says of which track a row is."""


@dataclass(frozen=True)
class Layout:
    """Where a file has what it holds.

    Attributes
    ----------
    time : the column of times, None where a file has none
    orientation : those of w, x, y, z, or of what another form has
    form : what these are
    position : those of x, y, z, or None
    unread : names of all other columns
    per_second : units of times in a second
    track : the column that names the track of a row, or None
    """

    time: int | None
    orientation: tuple[int, ...]
    form: Form
    position: tuple[int, ...] | None
    unread: tuple[str, ...]
    per_second: int = 1
    track: int | None = None

    @property
    def picked(self) -> tuple[int, ...]:
        """Columns of numbers in the order of `names`."""
        time = () if self.time is None else (self.time,)
        return (*time, *self.orientation, *(self.position or ()))

    @property
    def names(self) -> tuple[str, ...]:
        """What columns of numbers are called in messages."""
        time = () if self.time is None else ("t",)
        return (*time, *self.form.names, *(POSITION_COLUMNS if self.position else ()))

    @property
    def order(self) -> str:
        """The components of the quaternion from left to right; "" where it is told in another form."""
        if self.form is not QUATERNION:
            return ""
        places = dict(zip(COMPONENTS, self.orientation, strict=True))
        return "".join(sorted(COMPONENTS, key=places.__getitem__))


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
    if len(names) > MOST:
        raise ValueError(f"{len(names):,} columns: {MOST:,} at most are read")
    groups = _groups(names)
    time = _time(names)
    form, orientation, quaternion = _orientation(names, groups)
    position = _position(names, [group for group in groups if group is not quaternion])
    x = tuple(position.columns[part] for part in VECTOR) if position else None
    track = next((i for i, name in enumerate(names) if "_".join(words(name)) in TRACKS), None)
    read = {time, track, *orientation, *(x or ())}
    unread = tuple(name.strip() for i, name in enumerate(names) if i not in read and name.strip())
    return Layout(time, orientation, form, x, unread, _per_second(names, time, quaternion), track)


def _per_second(names: Sequence[str], time: int | None, quaternion: _Group | None) -> int:
    of_euroc, nanoseconds = EUROC
    named = 1 if time is None else per_second(names[time])
    return nanoseconds if quaternion and quaternion.words == of_euroc else named


def _orientation(
    names: Sequence[str], groups: list[_Group]
) -> tuple[Form, tuple[int, ...], _Group | None]:
    """The form, the columns and, of a quaternion, the group of columns."""
    if not any(group.has(COMPONENTS) for group in groups):
        other = other_form(names)
        if other:
            return *other, None
    found = _quaternion(names, groups)
    return QUATERNION, tuple(found.columns[part] for part in COMPONENTS), found


def is_readable(names: Sequence[str]) -> bool:
    """Whether names describe a layout."""
    try:
        layout(names)
    except ValueError:
        return False
    return True


# -- times ----------------------------------------------------------------------------------------


def _time(names: Sequence[str]) -> int | None:
    if tuple(names) == KITTI_COLUMNS:
        return None
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
