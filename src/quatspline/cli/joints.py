"""The command ``compare`` on many tracks: what schemes make of every K-th frame, over all joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from quatspline.system.stdout import say

if TYPE_CHECKING:
    import pandas as pd

    from quatspline.motion import Motion
    from quatspline.runs.results import Results

NAME = "kept"
FILES = [f"{NAME}.csv", f"{NAME}.md"]
"""What the command writes."""

TITLE = "Every {every}-th frame kept, measured at the {count} left out"
NOTE = (
    "Angles in rad between the motion and its rebuilding, over the joints that turn by more than a degree: the "
    "median of their root mean squares, the worst and the largest with their joints; end_rms is that of the end "
    "effectors in the motion's unit of length, on the root's true path; seconds are of one set-up. Sorted by "
    "rms_median."
)
FORMATS = {"rms_median": ".3e", "rms_worst": ".3e", "largest": ".3e", "seconds": ".2e"}
COLUMNS = [
    *("scheme", "joints", "rms_median", "rms_worst", "worst_joint", "largest", "largest_joint"),
    *("end_rms", "seconds", "failed_joints", "failure"),
]


def command(
    motion: Motion,
    *,
    schemes: Sequence[str] | None,
    every: int,
    results: Results,
    options: Mapping[str, Any],
    call: Sequence[str],
) -> int:
    """Serve ``quatspline compare --keep`` on a motion of several tracks: a table in a folder."""
    import pandas as pd

    from quatspline import catalogue
    from quatspline.comparing import told
    from quatspline.instruments.trials import attempted
    from quatspline.motion import keeping
    from quatspline.options import among
    from quatspline.runs.experiment import Run
    from quatspline.timing.own_keyframes import left_out

    out = keeping.left_out(motion, every)
    work = int((~out).sum()) * len(motion.tracks)
    results.begin(call, schemes=list(schemes) if schemes is not None else None)
    rows = []
    for name in Run(quick=True).progress(list(schemes or catalogue.schemes()), label="compare"):
        reason = left_out(name, work) if schemes is None else None
        given = among(catalogue.scheme(name), options)
        measure = partial(_row, motion, name, every, given)
        row = attempted(measure)[0] if reason is None else {"failure": reason}
        rows.append({"scheme": name} | row)
    table = pd.DataFrame(rows).reindex(columns=COLUMNS)
    table = table.sort_values(["rms_median", "scheme"], na_position="last", ignore_index=True)
    title = TITLE.format(every=every, count=int(out.sum()))
    results.table(NAME, table, title=title, note=NOTE + told(options), formats=FORMATS, keys=[])
    results.record(
        NAME, {"title": title, "size": f"{len(out)} frames", "seed": None, "seconds": None}
    )
    results.finish()
    say(_lines(table))
    return 0


def _row(
    motion: Motion, name: str, every: int, given: Mapping[str, Any]
) -> list[dict[str, object]]:
    from quatspline.motion import keeping

    return [keeping.row(motion, name, every, given)]


def _lines(table: pd.DataFrame) -> list[str]:
    """A line for each scheme that was measured, and one of each that was not."""
    import numpy as np

    measured = table[table["failure"].isna()]
    width = int(table["scheme"].str.len().max())
    lines = [f"{'scheme':{width}}  median    worst     largest (degrees at frames left out)"]
    for row in measured.to_dict("records"):
        angles = [np.degrees(row[name]) for name in ("rms_median", "rms_worst", "largest")]
        told = "  ".join(f"{angle:<8.4g}" for angle in angles)
        where = f"{row['worst_joint']}, {row['largest_joint']}"
        lines.append(f"{row['scheme']:{width}}  {told} {where}")
    lost = table[table["failure"].notna()].to_dict("records")
    return lines + [f"{row['scheme']:{width}}  n/a: {row['failure']}" for row in lost]
