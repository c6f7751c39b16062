"""What the page of a comparison plays: the user's own motion, and what the best schemes make of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd

    from quatspline.motion import Motion

REFERENCE = "slerp"
"""The scheme that others are seen beside."""

SCHEMES = 6
"""Schemes that are played at most: each adds its figure to the page."""


def played(motion: Motion, table: pd.DataFrame, by: str, every: int, title: str) -> list[Any]:
    """The motion for the player; nothing where no scheme was measured on all joints.

    Parameters
    ----------
    motion : the truth
    table : a row per scheme, with its error in the column ``by``
    every : which frames are kept
    title : what a reader calls the motion
    """
    from quatspline.motion.replay import replay

    schemes = chosen(table, by)
    return [replay(motion, schemes, every, title=title)] if schemes else []


def chosen(table: pd.DataFrame, by: str) -> list[str]:
    """Slerp, plug-ins, and the schemes with the least errors, libraries' last; the first two are shown first."""
    from quatspline import catalogue

    whole = table[by].notna()
    if "failed_joints" in table:
        whole &= table["failed_joints"].isna()
    best = [str(name) for name in table[whole].sort_values([by, "scheme"])["scheme"]]
    added = catalogue.plug_ins()
    rest = {n: catalogue.scheme(n).peer is not None for n in best}
    best.sort(key=lambda name: (name != REFERENCE, name not in added, rest[name]))
    return best[:SCHEMES]
