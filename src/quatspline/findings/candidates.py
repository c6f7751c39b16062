"""Which schemes of a comparison a recommendation chooses among, by what was measured of their curves.

A curve that wanders is not recommended over one that does not.  Where a body rests between keyframes,
or steps are uneven, the curve of least torque may be one that turns many times round on its way from
one keyframe to the next: nobody who draws or drives it means that, and no other column shows it.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from quatspline.catalogue import found
from quatspline.comparing import MET
from quatspline.findings.needs import Needs, reach
from quatspline.findings.questions import Filter
from quatspline.instruments.trials import Row, records
from quatspline.options import declared_by

STILL = 0.01
"""Degrees within which a body that holds stands still."""
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
QUICKER = 50.0
"""Times quicker that a candidate must be for a word about it: on a busy machine a timing was seen to be off
ten-fold, and what is said must not differ from run to run."""


def rank(row: Row) -> tuple[Any, ...]:
    """By torque, and those of equal torque by what they claim, jerk and support.  No clock decides."""
    item = found().get(str(row["scheme"]))
    claims = (item.scheme.continuity, item.scheme.order) if item and item.scheme else (0, 0)
    torque, jerk = (float(f"{row[name]:.6g}") for name in ("torque", "jerk"))  # not by rounding
    return torque, *(-claim for claim in claims), jerk, reach(row["support"]), str(row["scheme"])


def candidates(needs: Needs) -> tuple[Filter, ...]:
    """Those among which a recommendation chooses, one after the other."""
    level = 2 if needs.smooth is None else needs.smooth
    passing = usable if level > 0 else through
    return passing, needs.met, still, partial(smooth, level=level), direct


def through(rows: pd.DataFrame, _: Row) -> pd.Series:
    """Those whose curves pass through the keyframes without a leap."""
    return rows["failure"].isna() & (rows["misses"] <= MET) & (rows["continuity"] >= 0)


def near(rows: pd.DataFrame, _: Row) -> pd.Series:
    """Those that smooth keyframes which are told to be noisy: not interpolating, and told its size."""
    noisy = rows["failure"].isna() & (rows["noise"] > 0.0) & (rows["continuity"] >= 2)
    return noisy & rows["scheme"].map(_smooths)


def _smooths(name: str) -> bool:
    item = found().get(name)
    if item is None or item.scheme is None or item.scheme.interpolates:
        return False
    return "noise" in declared_by(item.scheme)  # fewer knots lessen noise too, whatever its size


def still(rows: pd.DataFrame, _: Row) -> Any:
    """Those that stand still while the keyframes do, if any do."""
    stands = rows["hold_rotation"] <= STILL
    return stands if stands.any() else True


def lengths(rows: pd.DataFrame) -> pd.Series:
    """What curves turn, rad; what is left of rounding at rest is all one."""
    return rows["length"].clip(lower=MET)


def measured(rows: pd.DataFrame, _: Row) -> pd.Series:
    """Those that did not fail."""
    return rows["failure"].isna()


def usable(rows: pd.DataFrame, _: Row) -> pd.Series:
    """Those whose curves pass through the keyframes with a continuous velocity."""
    return rows["failure"].isna() & (rows["misses"] <= MET) & np.isfinite(rows["torque"])


def smooth(rows: pd.DataFrame, _: Row, level: int = 2) -> Any:
    """C2 as measured (C1 if none is) and not stopping at keyframes, or where those go astray the next best."""
    far = ASTRAY * lengths(rows).min()
    near = (some for some in _levels(rows, level) if lengths(some).min() <= far)
    return rows.index.isin(next(near, rows).index)


def direct(rows: pd.DataFrame, _: Row) -> pd.Series:
    """Those that do not turn much further than the shortest."""
    return lengths(rows) <= ROUNDABOUT * lengths(rows).min()


def fairest(rows: pd.DataFrame, _: Row) -> list[bool]:
    """The first by `rank`, of which no two are the same."""
    ranks = list(map(rank, records(rows)))
    return [own == min(ranks) for own in ranks]


def wandering(rows: pd.DataFrame, taken: Row) -> pd.Series:
    """Those that turn much further than the shortest candidate, of which the one taken is one."""
    pool = rows[smooth(rows, taken)]
    return lengths(rows) > ROUNDABOUT * lengths(pool).min()


def itself(rows: pd.DataFrame, taken: Row) -> pd.Series:
    """The one taken."""
    return rows["scheme"] == taken["scheme"]


def quicker(rows: pd.DataFrame, taken: Row) -> pd.Series:
    """Those that are evaluated so much faster that no noise of a clock makes it so."""
    return rows["seconds_per_sample"] * QUICKER <= taken["seconds_per_sample"]


def alike(rows: pd.DataFrame, taken: Row) -> pd.Series:
    """Usable ones whose curves cannot be told from the one taken by torque, length and peak, itself among them."""
    same = usable(rows, taken) & np.isclose(lengths(rows), max(taken["length"], MET), SAME, 0.0)
    for name in ("torque", "peak"):
        same &= np.isclose(rows[name], taken[name], SAME, 0.0)
    return same


def stops(rows: pd.DataFrame) -> pd.Series:
    """Those that stop at a keyframe, where keyframes do not hold: there a body that stands still has to."""
    return (rows["key_speed"] < STOPS) & rows["hold_rotation"].isna()


def _levels(rows: pd.DataFrame, level: int) -> Iterator[pd.DataFrame]:
    """Ever more of the usable rows: C2 as measured (C1 if none is) and not stopping at keyframes first."""
    for least in (min(level, rows["continuity"].max()), -np.inf):
        some = rows[rows["continuity"] >= least]
        yield from (some[~stops(some)], some)


CANDIDATES = candidates(Needs())
"""Those of a user who asks for nothing."""
