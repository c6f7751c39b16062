"""What comments say of columns: their names in whatever punctuation, or a quaternion's order."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

from quatspline.motion.files.columns import is_readable
from quatspline.motion.files.lines import COMMENT, parts, separator
from quatspline.motion.files.names import (
    COMPONENTS,
    LETTERS,
    PLAIN,
    POSITIONS,
    QUATERNIONS,
    VECTOR,
    components,
    is_numbered,
    is_time,
    names_quaternion,
    quaternion_order,
    recognised,
    without_units,
    words,
)

LEAST_NAMES = 4
"""Names in a row without which a comment is prose: no fewer could be contradicted by columns."""

LETTER = re.compile(r"[^\W\d_eE]")
"""A letter that numbers do not have: rows that are commented out say nothing."""

BETWEEN_NAMES = frozenset({"and", "then", "&", "-", "–", "—", "→"})
"""Words that do not interrupt an enumeration."""

BRACKETS = re.compile(r"[\[({](?P<inner>[^\[({\])}]*)[\])}]")
BETWEEN = re.compile(r"[\s,;|:=<>]+|\.\.+|…")
"""What stands between words that may be names."""

PLACE = re.compile(
    r"\b(?:scalar|real|q?w|(vector|imaginary))"
    r"(?:[\s-]+(?:part|component|is|comes|stands)s?)*[\s-]+(first|last)\b",
    re.I,
)
OTHER = {"first": "last", "last": "first"}

ITEM = re.compile(r"[\W\d]*(?:(?:column|col|field)s?\b[\W\d]*)?([^\W\d][\w.]*(?:\[\w+\])?)", re.I)
"""The first word of a line in a list of columns: ``1. qx``, ``column 2: qy [-]``."""


def statements(comment: str) -> Iterator[str]:
    """What a comment says, without its marks; one within the line begins another comment."""
    for text in re.split(rf"#+|(?:^|(?<=\s))(?:{COMMENT})+", comment.strip("\ufeff\"' \t\r\n")):
        if LETTER.search(text):
            yield re.sub(r"^[^:,;\t]*:\s+", "", text.strip())  # "columns: t, qw"


def columns_in(text: str, width: int) -> list[str] | None:
    """The names of columns that a statement lists for rows of ``width`` fields, or None.

    They may be too many, too few or unreadable: what lists columns and cannot be them is to be refused.
    """
    told = _list(text)
    fields = _cut(told.fields, width)
    named = [fields] if len(fields) == width and told.names_enough else []
    if told.mark == " " or not _single_words(fields):
        named += [run for run in told.runs if len(run) == width and told.may_be(run)]
    for names in named:
        if is_readable(names):
            return names
    if named and not (told.opened and order_in(text)):
        return named[0]
    return fields if told.is_bare and len(fields) != width else None


def order_in(text: str) -> str:
    """The components of a quaternion as a statement enumerates them, w among them, or nothing."""
    orders = map(quaternion_order, _list(text).runs)
    return next(filter(None, orders), "")


def scalar_place(text: str) -> str:
    """Where a statement says in words that the scalar is, ``first`` or ``last``, or nothing."""
    found = PLACE.search(text)
    if not found:
        return ""
    place = found[2].lower()
    return OTHER[place] if found[1] else place


def order_below(comments: Sequence[tuple[int, str]]) -> tuple[int, str]:
    """The order of a quaternion whose components begin comments one below another, and where it ends.

    The number of the last line and the order, or 0 and nothing; a line that repeats one begins anew.
    """
    order, before = "", 0
    for number, comment in comments:
        found = ITEM.match(comment)
        part = next(filter(None, components([found[1]])), None) if found else None
        follows = number == before + 1 and part is not None and part[1] not in order
        order = (order if follows else "") + (part[1] if part else "")
        before = number
        if len(order) == len(COMPONENTS):
            return number, order
    return 0, ""


# -- lists ----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _List:
    """The fields of a statement; ``opened`` where names come from brackets or letters in a word."""

    fields: list[str]
    mark: str
    opened: bool

    @property
    def runs(self) -> list[list[str]]:
        """Names in a row, whatever stands between them, the longest first."""
        within = (_separate(field) for field in self.fields)
        told = [word for word in itertools.chain(*within) if word.lower() not in BETWEEN_NAMES]
        return sorted(_runs(told), key=len, reverse=True)

    @property
    def names_enough(self) -> bool:
        """Whether fields as many as those of rows are names: words of a sentence must be so mostly."""
        known = sum(part is not None for part in components(self.fields))
        several = max(known, sum(map(is_numbered, self.fields))) > 1
        if self.mark != " ":
            return several or any(map(recognised, self.fields))
        return several and 2 * sum(map(_is_name, self.fields)) >= len(self.fields)

    def may_be(self, run: Sequence[str]) -> bool:
        """Whether names among other words are the columns: "quaternions (w, x, y, z), t in s" are not."""
        return len(run) >= LEAST_NAMES and (not self.opened or is_time(run[0]))

    @property
    def is_bare(self) -> bool:
        """Whether it is nothing but names, so that their number counts; an order alone is no list."""
        if self.opened or len(quaternion_order(self.fields)) == len(self.fields):
            return False
        whole = len(self.fields) >= LEAST_NAMES and all(map(_is_name, self.fields))
        return whole or (self.mark != " " and names_quaternion(self.fields))


@lru_cache(maxsize=16)
def _list(text: str) -> _List:
    mark = separator(BRACKETS.sub("", text))
    of_stem = r"[^\s\[({]" if mark == " " else rf"[^{re.escape(mark)}\[({{]"
    # Begun behind another character only, so that long texts take no quadratic time.
    bracketed = re.compile(rf"(?<!{of_stem})(?P<stem>{of_stem}*)\s*{BRACKETS.pattern}")
    opened = bracketed.sub(lambda found: _opened(found, mark), text)
    plain = without_units(opened) if mark == " " else opened
    told = [field.strip().strip("\"'").strip() for field in parts(plain, mark)]
    fields = [name for field in told for name in _spread(field) or [field]]
    return _List(fields, mark, opened != text or len(fields) > len(told))


def _opened(found: re.Match[str], mark: str) -> str:
    """Names that stand in brackets, each with the word before them; other brackets as they are."""
    inner = [name for word in _separate(found["inner"]) for name in _spread(word) or [word]]
    names = max(_runs(inner), key=len, default=[])
    alone = not found["stem"].strip() and any(map(is_time, names))  # "(timestamp) (x y z)"
    if len(names) < len(VECTOR) and not alone:
        return found[0]
    kind = _kind(words(found["stem"]))
    told = (f"{kind}.{name}" if kind and name.lower() in LETTERS else name for name in names)
    return f" {f' {mark} '.join(told)} "


def _spread(field: str) -> list[str]:
    """Names written as one word: ``qxyzw``, ``orientation wxyz``, ``qx/qy/qz/qw``; else nothing."""
    told = words(field)
    if len(told) >= len(VECTOR) and None not in components(told):
        return list(told)
    found = re.fullmatch(r"(.*?)([wxyz]{4}|xyz)", told[-1]) if told else None
    if not found or len(set(found[2])) < len(found[2]):
        return []
    before = [word for word in (*told[:-1], found[1]) if word]
    kind = _kind(before)
    if len(found[2]) == len(COMPONENTS):
        kind = kind if kind in QUATERNIONS else "q"
    elif before and kind not in PLAIN | POSITIONS:
        return []  # Euler angles, perhaps
    return [f"{kind or 'p'}.{part}" for part in found[2]]


def _kind(before: Sequence[str]) -> str:
    """The word that says of what components those are that follow, or nothing."""
    return next((word for word in reversed(before) if word in QUATERNIONS | POSITIONS), "")


def _cut(fields: list[str], width: int) -> list[str]:
    """Fields without the empty ones that separators leave behind the last."""
    count = len(fields)
    while count > width and not fields[count - 1]:
        count -= 1
    return fields[:count]


def _separate(text: str) -> list[str]:
    return [word.strip("\"'`") for word in BETWEEN.split(without_units(text)) if word]


def _runs(names: Sequence[str]) -> Iterator[list[str]]:
    for known, run in itertools.groupby(names, _is_name):
        if known:
            yield list(run)


def _is_name(word: str) -> bool:
    return recognised(word) or is_numbered(word) or word.lower() in LETTERS


def _single_words(fields: Sequence[str]) -> bool:
    return all(len(field.split()) == 1 for field in fields)
