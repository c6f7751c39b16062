"""Which scheme a comparison recommends: by what was measured of its curve on these keyframes.

A curve that wanders is not recommended over one that does not.  Where a body rests between keyframes,
or steps are uneven, the curve of least torque may be one that turns many times round on its way from
one keyframe to the next: nobody who draws or drives it means that, and no other column shows it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from quatspline.catalogue import found as schemes_found

if TYPE_CHECKING:
    import pandas as pd

MET = 1e-6
"""Largest angle at a keyframe, in rad, that counts as passing through it."""
FAIR = 1.05
"""Torque within this of the least is as good as the least: nobody sees five per cent."""
STOPS = 0.01
"""A least speed at keyframes below this share of the mean is a stop."""
ROUNDABOUT = 1.5
"""Curves within this of the shortest candidate's length are candidates; and a curve that turns this many times
as far as the keyframes need is said to.  On walks of 12 keyframes at even times, steps of 20 to 150 degrees,
this package's C2 schemes turn 1.01 to 1.22 times as far as the keyframes need, log-cubic up to 1.51 times."""
ASTRAY = 3.0
"""Where the shortest curve that is C2 and does not stop turns this many times as far as one that stops, or is C1,
those are candidates: a stop, or a jump of the acceleration, is the lesser evil."""
SAME = 1e-6
"""Share of torque, length and peak within which two curves are one."""


def usable(table: pd.DataFrame) -> pd.DataFrame:
    """The rows whose curves pass through the keyframes with a continuous velocity."""
    return table[table["failure"].isna() & (table["misses"] <= MET) & np.isfinite(table["torque"])]


def candidates(table: pd.DataFrame) -> pd.DataFrame:
    """The rows among which the recommendation chooses, best first: by torque, and those of equal torque by
    what they claim, jerk and support.  No clock decides."""
    works = usable(table)
    if works.empty:
        return works
    return ranked(_direct(next(level for level in _levels(works) if not _astray(level, works))))


def ranked(pool: pd.DataFrame) -> pd.DataFrame:
    """Rows, best first."""
    rows = pool.to_dict("records")
    return pool.iloc[sorted(range(len(pool)), key=lambda i: _rank(rows[i]))]


def _levels(rows: pd.DataFrame) -> Iterator[pd.DataFrame]:
    """Ever more of the usable rows: C2 as measured (C1 if none is) and not stopping at keyframes first."""
    smooth = rows[rows["continuity"] >= min(2, rows["continuity"].max())]
    for level in (smooth, rows):
        moving = level[~(level["key_speed"] < STOPS)]
        yield from (part for part in (moving, level) if len(part))


def lengths(rows: pd.DataFrame) -> pd.Series:
    """What curves turn, rad; what is left of rounding at rest is all one."""
    return rows["length"].clip(lower=MET)


def _astray(level: pd.DataFrame, rows: pd.DataFrame) -> bool:
    """Whether even the shortest curve of some turns ASTRAY times as far as another."""
    return bool(lengths(level).min() > ASTRAY * lengths(rows).min())


def _direct(rows: pd.DataFrame) -> pd.DataFrame:
    """Those that do not turn much further than the shortest."""
    return rows[lengths(rows) <= ROUNDABOUT * lengths(rows).min()]


def alike(table: pd.DataFrame, name: str) -> list[str]:
    """The schemes whose curves cannot be told from one's by torque, length and peak, itself among them."""
    rows = usable(table)
    own = rows[rows["scheme"] == name]
    same = np.ones(len(rows), dtype=bool)
    for column in (rows["torque"], rows["peak"], lengths(rows)):
        same &= np.isclose(column, column[own.index[0]], rtol=SAME, atol=0.0)
    return [str(scheme) for scheme in rows.loc[same, "scheme"]]


def _rank(row: Mapping[Any, Any]) -> tuple[Any, ...]:
    """The less, the better."""
    item = schemes_found().get(str(row["scheme"]))
    claims = (item.scheme.continuity, item.scheme.order) if item and item.scheme else (0, 0)
    torque, jerk = (float(f"{row[name]:.6g}") for name in ("torque", "jerk"))  # not by rounding
    reach = np.inf if row["support"] == "all" else int(row["support"])
    return torque, *(-claim for claim in claims), jerk, reach, str(row["scheme"])


def best_of(pool: pd.DataFrame) -> str:
    fair = pool[pool["torque"] <= FAIR * pool["torque"].min()]
    local = fair[fair["support"] != "all"]
    return str((local if len(local) else fair).iloc[0]["scheme"])
