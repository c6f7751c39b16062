"""The command ``compare``: table, figures, a recommendation and a page on somebody's own keyframes, in a folder."""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from quatspline import comparing
from quatspline.kernels.engine import always_compiled
from quatspline.system.stdout import say

if TYPE_CHECKING:
    import pandas as pd

    from quatspline.curve import Curve
    from quatspline.findings.findings import Finding
    from quatspline.keyframes import Keyframes
    from quatspline.motion.files import Motion
    from quatspline.runs.results import Results

FILES = [
    *(f"compare{end}" for end in (".csv", ".md", ".png", ".svg", ".caption.txt")),
    *(f"rates{end}" for end in (".png", ".svg", ".caption.txt")),
    *("recommendation.md", "report.html"),
]
"""What the command writes."""
BARS = "Torque energy over the least of all schemes compared; hollow: not C2 as measured here.\n"
RATES = "Norms of the angular velocity and acceleration over time; grey lines are keyframes.\n"


def command(
    motion: Motion,
    *,
    schemes: Sequence[str] | None,
    closed: bool,
    results: Results,
    call: Sequence[str] = (),
) -> int:
    """Serve ``quatspline compare``: tables, figures, the recommendation and the page in a folder.

    Raises
    ------
    ValueError
        On bad keyframes, an unknown scheme, or files in the folder that are not its own.
    """
    from quatspline.page import own_scene, write_page
    from quatspline.page.sections import OWN

    began = time.perf_counter()
    keyframes = comparing.prepared(motion.times, motion.quaternions, closed)
    results.begin(call, schemes=list(schemes) if schemes is not None else None)
    with always_compiled():
        table, curves = comparing.compared(keyframes, schemes)
    table = results.table(
        "compare",
        table,
        title=comparing.TITLE,
        note=comparing.NOTE,
        formats=comparing.FORMATS,
        keys=[],
    )
    found = _recommended(results, table)
    names = _drawn(results, table, curves, keyframes)
    entry = {"title": comparing.TITLE, "size": f"{keyframes.count} keyframes", "seed": None}
    results.record("compare", entry | {"seconds": round(time.perf_counter() - began, 3)})
    results.finish()
    scene = own_scene("own", "Your keyframes", keyframes, motion.positions, names)
    page = write_page(results, title=comparing.TITLE, scenes=[scene], sections=OWN, findings=found)
    print(page, file=sys.stderr)
    return 0


def _recommended(results: Results, table: pd.DataFrame) -> list[Finding]:
    """Say and write the recommendation."""
    from quatspline.findings.recommendation import markdown, recommendation

    found = recommendation(table)
    say(finding.text for finding in found)  # before a disk runs full
    results.text("recommendation.md", markdown(found))
    return found


def _drawn(
    results: Results, table: pd.DataFrame, curves: Mapping[str, Curve], keyframes: Keyframes
) -> list[str]:
    """Draw the figures; the schemes whose curves are shown."""
    import matplotlib as mpl

    from quatspline.figures import comparison, style
    from quatspline.findings.recommendation import shown

    mpl.use("Agg")  # nothing here may open a window
    names = shown(table)[: comparison.CURVES]
    with style.house():
        results.figure("compare", comparison.bars(table))
        results.figure("rates", comparison.rates({name: curves[name] for name in names}, keyframes))
    results.text("compare.caption.txt", BARS)
    results.text("rates.caption.txt", RATES)
    return names
