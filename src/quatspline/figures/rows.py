"""Schemes as the rows of a figure: marks of each, and libraries that come out as a scheme of this package beside it."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from quatspline.catalogue import called
from quatspline.figures.heat import scheme_rows
from quatspline.figures.looks import FAMILIES, third_party
from quatspline.figures.named import NAMED, coloured, looks
from quatspline.inputs.arrays import FloatArray

if TYPE_CHECKING:
    import pandas as pd

ALIKE = 0.02
"""Of a column's extent: about half a mark, less than which one does not see."""
FINE = 3
"""Decimals of such a share: of schemes that are as near to these, the first of its family is nearest."""
BEHIND = "#6b6b6b"
"""Of the names of schemes in grey: still legible."""

Shared = Mapping[str, Sequence[str]]
"""Libraries that share a scheme's row, by its name."""


def shared(drawn: pd.DataFrame) -> dict[str, list[str]]:
    """Libraries whose row would be that of a scheme of this package of the same family, by the nearest of those.

    Parameters
    ----------
    drawn : one row per scheme, by name: the numbers that a figure shows, as it shows them (logarithms on a
        logarithmic axis, clipped where that ends); those that are missing or infinite are alike

    Returns
    -------
    The schemes that have a row, in the order of ``drawn``, each with the libraries that share it.  Those that
    figures draw in colour have one.
    """
    values = drawn.to_numpy(dtype=float)
    values = np.where(np.isfinite(values), values, np.nan)
    values /= _extents(values)
    rows = {str(name): row for name, row in zip(drawn.index, values, strict=True)}
    found: dict[str, list[str]] = {name: [] for name in rows}
    for name in rows:
        if not third_party(name) or name in NAMED:
            continue
        kin = [own for own in _kin(name) if own in rows and not third_party(own)]
        apart = {own: round(_apart(rows[name], rows[own]), FINE) for own in kin}
        nearest = min(apart, key=apart.__getitem__, default=None)
        if nearest is not None and apart[nearest] <= ALIKE:
            found[nearest].append(name)
            del found[name]
    return found


def _kin(name: str) -> tuple[str, ...]:
    return next((family.members for family in FAMILIES if name in family.members), ())


def _extents(values: FloatArray) -> FloatArray:
    """Of each column; 1 where nothing differs."""
    largest = np.nanmax(values, axis=0, initial=-np.inf)
    extents = largest - np.nanmin(values, axis=0, initial=np.inf)
    return np.where(extents > 0.0, extents, 1.0)


def _apart(a: FloatArray, b: FloatArray) -> float:
    """How far two rows are apart where they are farthest; infinitely where one alone has a number."""
    gaps = np.where(np.isnan(a) & np.isnan(b), 0.0, np.abs(a - b))
    return float(np.nan_to_num(gaps, nan=np.inf).max(initial=0.0))


def named(name: str, sharing: Shared) -> str:
    """What stands at a row."""
    count = len(sharing.get(name, ()))
    more = f" + {count} librar{'y' if count == 1 else 'ies'}" if count else ""
    return f"{called(name)}{more}"


def label(
    ax: Any, names: Sequence[str], sharing: Shared, chosen: Sequence[str] | None = NAMED
) -> None:
    """A row per name, the first on top; black are names of schemes in colour, all where none is grey."""
    lit = names if chosen is None else coloured(names, chosen)
    scheme_rows(ax, [named(name, sharing) for name in names])
    for text, name in zip(ax.get_yticklabels(), names, strict=True):
        text.set_color("black" if name in lit else BEHIND)


def mark(ax: Any, x: pd.Series, names: Sequence[str], chosen: Sequence[str] | None = NAMED) -> None:
    """A mark per row at numbers by name, as `look` has it."""
    lit = None if chosen is None else coloured(names, chosen)
    for height, name in enumerate(names):
        ax.plot(x.get(name, np.nan), height, **look(name, lit))


def look(name: str, lit: Collection[str] | None) -> dict[str, Any]:
    """A scheme's mark, which the edge of an axes does not cut; hollow for libraries.

    Those that are lit are in their colours and all others grey; without any (None) all are black, since colours
    stand for something else.
    """
    own = looks(name, lit or ())
    own |= {} if lit and name in lit else {"marker": "o"}
    own |= {"color": "black"} if lit is None else {}
    return own | {"linestyle": "", "ms": 4.2, "clip_on": False}


def said(sharing: Shared) -> str:
    """Whose row libraries share, for captions; nothing where none do."""
    told = [f"{', '.join(names)} with {own}" for own, names in sharing.items() if names]
    if not told:
        return ""
    return (
        f"A library that comes out as a scheme of this package shares its row: {'; '.join(told)}."
    )
