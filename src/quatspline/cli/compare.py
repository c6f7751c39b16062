"""The command ``compare``: table, figures, a recommendation and a page on a user's own keyframes, in a folder."""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from quatspline import comparing
from quatspline.engines.engine import always_compiled
from quatspline.inputs.stamps import elapsed
from quatspline.system.sentence import printable
from quatspline.system.stdout import say

if TYPE_CHECKING:
    import pandas as pd

    from quatspline.curve import Curve
    from quatspline.findings.findings import Finding
    from quatspline.findings.needs import Needs
    from quatspline.keyframes import Keyframes
    from quatspline.motion import Motion
    from quatspline.runs.results import Results

FILES = [
    *(f"compare{end}" for end in (".csv", ".md", ".png", ".svg", ".caption.txt")),
    *(f"rates{end}" for end in (".png", ".svg", ".caption.txt")),
    *("recommendation.md", "compare.replay.json", "report.html"),
]
"""What the command writes."""
ERRORS = ("left_out_rms", "left_out_largest")
KEPT = (
    " left_out_rms and left_out_largest are the root mean square and the largest angle (rad) at the frames that "
    "--keep leaves out."
)
BARS = (
    "Torque energy over the least of all that pass through the keyframes, with the continuity as measured here; in "
    "colour the schemes whose rates are drawn; hollow: third-party schemes.\n"
)
RATES = "Norms of the angular velocity and acceleration over time; upright lines are keyframes, where they are few.\n"


def command(
    motion: Motion,
    *,
    schemes: Sequence[str] | None,
    closed: bool,
    results: Results,
    needs: Needs,
    told: bool = False,
    every: int | None = None,
    options: Mapping[str, Any] = MappingProxyType({}),
    call: Sequence[str] = (),
    name: str = "Your motion",
) -> int:
    """Serve ``quatspline compare``: tables, figures, the recommendation and the page in a folder.

    Raises
    ------
    ValueError
        On bad keyframes, an unknown scheme, or files in the folder that are not its own.
    """
    from quatspline.cli import ranking
    from quatspline.cli.played import played
    from quatspline.findings.recommendation import markdown
    from quatspline.page import own_scene, write_page
    from quatspline.page.own_sections import OWN

    began = time.perf_counter()
    source, motion = motion, _kept(motion, every)
    keyframes = comparing.prepared(motion.stamps, motion.quaternions[:, 0], closed)
    results.begin(call, schemes=list(schemes) if schemes is not None else None)
    with always_compiled():
        table, curves = comparing.compared(keyframes, schemes, options)
        if every is not None:
            table = _with_errors(table, curves, source, every)
            results.replays("compare", played(source, table, ERRORS[0], every, name))
    table = results.table(
        "compare",
        ranking.sort(table, needs),
        title=comparing.TITLE,
        note=comparing.NOTE + (KEPT if every is not None else "") + comparing.told(options),
        formats=comparing.FORMATS | dict.fromkeys(ERRORS, ".3e"),
        keys=[],
    )
    found = answer(keyframes, table, needs, told=told)
    say(spoken(found, table, needs))  # before a disk runs full
    results.text("recommendation.md", markdown(found))
    names = _drawn(results, table, curves, keyframes, needs)
    results.tidy("compare")  # without --keep there is no truth to play
    entry = {"title": comparing.TITLE, "size": f"{keyframes.count} keyframes", "seed": None}
    results.record("compare", entry | {"seconds": round(time.perf_counter() - began, 3)})
    results.finish()
    places = None if motion.positions is None else motion.positions[:, 0]
    scene = own_scene("own", "Your keyframes", keyframes, places, names, first=names[:1])
    page = write_page(results, title=comparing.TITLE, scenes=[scene], sections=OWN, findings=found)
    print(printable(str(page)), file=sys.stderr)
    return 0


def _kept(motion: Motion, every: int | None) -> Motion:
    """The frames that are keyframes."""
    from quatspline.motion.keeping import left_out

    if len(motion.edges) > 2:
        raise ValueError(f"the motion is in {len(motion.edges) - 1} pieces: compare one of them")
    if every is None:
        return motion
    if motion.closed:
        raise ValueError("--keep takes an open motion")
    return motion.frames(~left_out(motion, every))


def _with_errors(
    table: pd.DataFrame, curves: Mapping[str, Curve], source: Motion, every: int
) -> pd.DataFrame:
    """The table with the errors of curves, through kept frames, at those left out."""
    from quatspline import quaternion
    from quatspline.motion.keeping import left_out

    out = left_out(source, every)
    q = quaternion.normalise(source.quaternions[out, 0])
    # Curves are of stamps in the file's unit, as `comparing.prepared` has them.
    t = elapsed(source.stamps[out], source.stamps[0])
    angles = {name: quaternion.distance(curve(t), q) for name, curve in curves.items()}
    rms = {name: np.sqrt((angle**2).mean()) for name, angle in angles.items()}
    largest = {name: angle.max() for name, angle in angles.items()}
    place = list(table.columns).index("misses") + 1
    for name, column in zip(reversed(ERRORS), (largest, rms), strict=True):
        table.insert(place, name, table["scheme"].map(column))
    return table


def answer(
    keyframes: Keyframes, table: pd.DataFrame, needs: Needs, *, told: bool = False
) -> list[Finding]:
    """What is said of keyframes: warnings, then the recommendation."""
    from quatspline.findings.cautions import cautions
    from quatspline.findings.recommendation import recommendation

    warned = cautions(keyframes, table, second=needs.second, told=told)
    return [*warned, *recommendation(table, needs)]


def spoken(found: Sequence[Finding], table: pd.DataFrame, needs: Needs) -> list[str]:
    """What the terminal shows: the answer, and the best rows of the table."""
    from quatspline.cli import ranking

    rows = ranking.table(table, needs)
    return [*(finding.text for finding in found), *(["", *rows] if rows else [])]


def _drawn(
    results: Results,
    table: pd.DataFrame,
    curves: Mapping[str, Curve],
    keyframes: Keyframes,
    needs: Needs,
) -> list[str]:
    """Draw the figures; the schemes whose curves are shown."""
    import matplotlib as mpl

    from quatspline.figures import comparison, style
    from quatspline.findings.recommendation import shown

    mpl.use("Agg")  # nothing here may open a window
    names = shown(table, needs)[: comparison.CURVES]
    with style.applied():
        results.figure("compare", comparison.bars(table, names))
        results.figure("rates", comparison.rates({name: curves[name] for name in names}, keyframes))
    results.text("compare.caption.txt", BARS)
    results.text("rates.caption.txt", RATES)
    return names
