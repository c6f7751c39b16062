"""What schemes are worth on recorded motion, against what they are worth on analytic motion, in sentences."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from quatspline.findings.quotes import Cell, Ledger, Part, said
from quatspline.instruments.summary import ALL
from quatspline.trajectories.clips import CONTROLS, OWN

TABLE, REDUCE = "reconstruct", "reduce"

KEPT, ERROR = 4, 0.5
"""Every so many-th frame, and an angle in degrees, which runs of both sizes have."""

RAW, SMOOTH, REDUCED = "none", "6 Hz", "10 Hz"
"""Filters, the last of the experiment `reduce`."""


def _over_slerp(cell: Ledger, scheme: str, clip: str = ALL, below: str = RAW) -> Cell:
    where: dict[str, Any] = {"clip": clip, "filter": below, "every": KEPT, "scheme": scheme}
    return cell(TABLE, "over_slerp", **where)


def _listed(names: Sequence[str], key: str, spec: str) -> str:
    return ", ".join(f"{name} {{{key}{i}:{spec}}}" for i, name in enumerate(names))


def _numbered(key: str, cells: Sequence[Cell]) -> dict[str, Cell]:
    return {f"{key}{i}": cell for i, cell in enumerate(cells)}


def _motion(cell: Ledger, table: str) -> str:
    """What was measured on: without recorded clips it is the project's own walk, which nobody recorded."""
    made = cell.values(table, "clip") == sorted([ALL, OWN, *(CONTROLS if table == TABLE else ())])
    return "the project's own walk" if made else "recorded motion"


def _ranking(cell: Ledger) -> tuple[Part, ...]:
    names = ("kim", "local-quintic", "squad", "quartic")
    raw = [_over_slerp(cell, name) for name in names]
    smooth = [_over_slerp(cell, name, below=SMOOTH) for name in names]
    analytic = [_over_slerp(cell, name, "tumble") for name in names]
    where = {"clip": ALL, "filter": SMOOTH, "every": KEPT, "scheme": "slerp"}
    return said(
        f"On {_motion(cell, TABLE)} ({{joints:.0f}} joints, every {{every}}th frame kept) the ranking by order "
        "survives and its gaps do not. The rms angle at the frames left out is, over slerp's: "
        f"{_listed(names, 'r', '.2g')}; below {{below}} {_listed(names, 's', '.2g')}; on analytic motion "
        f"{_listed(names, 't', '.2g')}.",
        joints=cell(TABLE, "compared_joints", **where),
        every=cell(TABLE, "every", **where),
        below=cell(TABLE, "filter", **where),
        **_numbered("r", raw),
        **_numbered("s", smooth),
        **_numbered("t", analytic),
    )


def _noise(cell: Ledger) -> tuple[Part, ...]:
    names = ("kim", "local-quintic", "squad", "quartic")
    ratios = [_over_slerp(cell, name, "white noise") for name in names]
    return said(
        "On white noise alone slerp is best: what follows keyframes more closely follows their noise "
        f"({_listed(names, 'v', '.2f')} times slerp's rms angle).",
        **_numbered("v", ratios),
    )


def _hinges(cell: Ledger) -> tuple[Part, ...]:
    return said(
        "Schemes through circles go the long way where a hinge reverses: biarc, {analytic:.2g} times slerp's rms "
        f"angle on analytic motion, is {{biarc:.2g}} times on {_motion(cell, TABLE)}, circular-blend {{circles:.2g}} "
        "times.",
        analytic=_over_slerp(cell, "biarc", "tumble"),
        biarc=_over_slerp(cell, "biarc"),
        circles=_over_slerp(cell, "circular-blend"),
    )


def _euler(cell: Ledger) -> tuple[Part, ...]:
    def worst(scheme: str) -> Cell:
        where: dict[str, Any] = {"clip": ALL, "filter": SMOOTH, "every": KEPT, "scheme": scheme}
        return cell(TABLE, "most_over_slerp", **where)

    return said(
        "Below {below}, linear Euler channels are about as good as slerp over all joints ({linear:.2f} times its rms "
        "angle) and not on each: the worst joint has {worst:.2g} times, with cubic channels {cubic:.2g} times.",
        below=cell(TABLE, "filter", clip=ALL, filter=SMOOTH, every=KEPT, scheme="euler-linear"),
        linear=_over_slerp(cell, "euler-linear", below=SMOOTH),
        worst=worst("euler-linear"),
        cubic=worst("euler-cubic"),
    )


def _keyframes(cell: Ledger) -> tuple[Part, ...]:
    names = ("squad", "quartic", "local-quintic", "kim")

    def row(scheme: str, below: str) -> dict[str, Any]:
        return {"clip": ALL, "filter": below, "scheme": scheme, "error_degrees": ERROR}

    raw, smooth = (
        [cell(REDUCE, "over_slerp", **row(name, below)) for name in names]
        for below in (RAW, REDUCED)
    )
    return said(
        f"To rebuild every frame of {_motion(cell, REDUCE)} within {{error}} degrees, keyframes over slerp's number "
        f"are: {_listed(names, 'r', '.2f')}; below {{below}} {_listed(names, 's', '.2f')}.",
        error=cell(REDUCE, "error_degrees", **row("slerp", RAW)),
        below=cell(REDUCE, "filter", **row("slerp", REDUCED)),
        **_numbered("r", raw),
        **_numbered("s", smooth),
    )


FINDINGS: tuple[tuple[str, Callable[[Ledger], tuple[Part, ...]]], ...] = (
    (TABLE, _ranking),
    (TABLE, _noise),
    (TABLE, _hinges),
    (TABLE, _euler),
    (REDUCE, _keyframes),
)
