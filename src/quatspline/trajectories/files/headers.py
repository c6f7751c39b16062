"""Headers, commented out or not: which columns a text file has, and where."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence

from quatspline.trajectories.files.columns import (
    COMPONENTS,
    Layout,
    layout,
    names_quaternion,
    quaternion_order,
    recognised,
    without_units,
)
from quatspline.trajectories.files.lines import Lines, is_number, parts, separator

LEAST_NAMES = 4
"""Names in a row without which a comment is prose: no fewer could be contradicted by columns."""


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
    for number, comment in lines.comments:
        names = _names_in(comment, width)
        if names is None or _agrees(names, width, known):
            continue
        if len(names) != width:
            what = f"the comment names {len(names)} columns, but the rows have {width} fields"
            raise lines.error(what, number)
        named = laid_out(lines, names, number)
        if found and named.picked != found.picked:
            raise lines.error("the comment and another header name the columns differently", number)
        found = named
    return None if header else found


def _agrees(names: Sequence[str], width: int, with_: Layout) -> bool:
    """Whether a comment only says in which order quaternions are, and that is so."""
    return len(names) == len(COMPONENTS) < width and quaternion_order(names) == with_.order


def _names_in(comment: str, width: int) -> list[str] | None:
    """The names of columns in a comment, or None where it is prose."""
    text = re.sub(r"^[^:,;\t]*:\s+", "", comment.strip().lstrip("#").strip())  # "columns: t, qw"
    mark = separator(text)
    text = without_units(text) if mark == " " else text
    fields = [part.strip().strip("\"'") for part in parts(text, mark)]
    if names_quaternion(fields) and (len(fields) == width or mark != " "):
        return fields
    runs = [list(run) for known, run in itertools.groupby(fields, recognised) if known]
    run = max(runs, key=len, default=[])
    if len(run) < LEAST_NAMES:
        return None
    return run if len(run) in (width, len(fields)) or names_quaternion(run) else None
