"""Headers, commented out or not: which columns a text file has, and where."""

from __future__ import annotations

from collections.abc import Sequence

from quatspline.motion.files.columns import Layout, is_readable, layout
from quatspline.motion.files.comments import (
    columns_in,
    order_below,
    order_in,
    scalar_place,
    statements,
)
from quatspline.motion.files.lines import Lines, is_number
from quatspline.motion.files.names import recognised


def is_header(fields: Sequence[str]) -> bool:
    """Whether a first line names more columns than it has numbers, or has nothing of either."""
    numbers = sum(map(is_number, fields))
    named = sum(map(recognised, fields))
    return named > numbers or (not numbers and any(map(str.strip, fields)))


def laid_out(lines: Lines, names: Sequence[str], number: int) -> Layout:
    """The layout that the names of a line describe, or the sentence that refuses them."""
    try:
        return layout(names)
    except ValueError as error:
        raise lines.error(error, number) from None


def commented(lines: Lines, width: int, known: Layout, header: bool) -> Layout | None:
    """The layout that comments before the data name, or None where none does or a header did.

    ``known`` is that of the header or, without one, of the format; all that is named must agree.
    """
    found = known if header else None
    notes = []
    for number, text in _statements(lines):
        names = columns_in(text, width)
        if names is None or (header and len(names) == width and not is_readable(names)):
            notes.append((number, text))
            continue
        named = _named(lines, names, width, number)
        if found and named.picked != found.picked:
            raise lines.error("the comment and another header name the columns differently", number)
        found = named
    read = (found or known).order
    for number, text in notes:
        _check_order(lines, number, order_in(text), read)
        if not found:  # where the scalar is, in words, is a hint that names of columns overrule
            _check_place(lines, number, scalar_place(text), read)
    _check_order(lines, *order_below(lines.comments), read)
    return None if header else found


def _statements(lines: Lines) -> list[tuple[int, str]]:
    return [(number, text) for number, line in lines.comments for text in statements(line)]


def _named(lines: Lines, names: Sequence[str], width: int, number: int) -> Layout:
    if len(names) != width:
        what = f"the comment names {len(names)} columns, but the rows have {width} fields"
        raise lines.error(what, number)
    return laid_out(lines, names, number)


def _check_order(lines: Lines, number: int, told: str, read: str) -> None:
    """Refuse a comment that enumerates a quaternion in another order than it is read in."""
    if told and read and told != "".join(part for part in read if part in told):
        what = f"the comment has the quaternion in the order {', '.join(told)}"
        raise lines.error(f"{what}, but the columns are read as {', '.join(read)}", number)


def _check_place(lines: Lines, number: int, place: str, read: str) -> None:
    """Refuse a comment that says that the scalar is where it is not read."""
    if place and read and read.index("w") != {"first": 0, "last": len(read) - 1}[place]:
        what = f"the comment says that the scalar is {place}"
        raise lines.error(f"{what}, but the columns are read as {', '.join(read)}", number)
