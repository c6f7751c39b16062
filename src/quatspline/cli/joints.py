"""The command ``compare`` on many tracks: tables, figures and a page of what schemes make of every K-th frame."""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from quatspline.engines.engine import always_compiled
from quatspline.system.sentence import printable
from quatspline.system.stdout import say

if TYPE_CHECKING:
    import pandas as pd

    from quatspline.findings.needs import Needs
    from quatspline.inputs.arrays import BoolArray
    from quatspline.instruments.trials import Row
    from quatspline.motion import Motion
    from quatspline.runs.results import Results

NAME, JOINTS = "kept", "joints"
FILES = [
    *(
        f"{name}{end}"
        for name in (NAME, JOINTS)
        for end in (".csv", ".md", ".png", ".svg", ".caption.txt")
    ),
    *(f"{NAME}.replay.json", "report.html"),
]
"""What the command writes."""

TITLE = "Every {every}-th frame kept, measured at the {count} left out"
NOTE = (
    "Angles in rad between the motion and its rebuilding, over the joints that turn by more than a degree: the "
    "median of their root mean squares, the worst and the largest with their joints; end_rms is that of the end "
    "effectors in the motion's unit of length, on the root's true path; seconds are of one set-up; excursion is the "
    "largest angle off the arcs between neighbouring keyframes (degrees), empty for a library that would take too "
    "long. Sorted by rms_median."
)
JOINTS_TITLE = "Joint by joint"
JOINTS_NOTE = (
    "Root mean square and largest angle (rad) between a joint of the motion and of its rebuilding, at the frames left "
    "out, and the largest off the arcs between its neighbouring keyframes (excursion, degrees); joints on which a "
    "scheme fails have no row."
)
SPANS = (
    "Angles at the frames left out: dots are the median over the joints of their root mean squares, bars reach to the "
    "worst joint, strokes are the largest angle of all; in colour the schemes that are drawn joint by joint; hollow: "
    "third-party schemes.\n"
)
BY_JOINT = (
    "Root mean square angle of every joint at the frames left out, by slerp and the best schemes.\n"
)
DRAWN = 4
"""Schemes that are told apart joint by joint."""
FORMATS = {"rms_median": ".3e", "rms_worst": ".3e", "largest": ".3e"}
FORMATS |= {"excursion": ".3g", "seconds": ".2e"}
COLUMNS = [
    *("scheme", "joints", "rms_median", "rms_worst", "worst_joint", "largest", "largest_joint"),
    *("excursion", "support", "lookahead", "end_rms", "seconds", "failed_joints", "failure"),
]


def command(
    motion: Motion,
    *,
    schemes: Sequence[str] | None,
    every: int,
    results: Results,
    needs: Needs,
    options: Mapping[str, Any],
    call: Sequence[str],
    name: str,
) -> int:
    """Serve ``quatspline compare --keep`` on a motion of several tracks: tables, figures and a page in a folder."""
    from quatspline.cli import joint_ranking
    from quatspline.cli.played import played
    from quatspline.motion import keeping
    from quatspline.page import write_page
    from quatspline.page.own_sections import KEPT

    began = time.perf_counter()
    out = keeping.left_out(motion, every)
    results.begin(call, schemes=list(schemes) if schemes is not None else None)
    title = TITLE.format(every=every, count=int(out.sum()))
    with always_compiled():
        rows = _measured(motion, schemes, every, out, options)
        table, joints = _tables(results, rows, title, options)
        wanted = joint_ranking.meeting(table, needs)
        results.replays(NAME, played(motion, wanted, "rms_median", every, name))
    found = joint_ranking.answer(table, needs)
    say(joint_ranking.spoken(found, table, needs))  # before a disk runs full
    _drawn(results, table, joints, wanted)
    entry = {"title": title, "size": f"{len(out)} frames", "seed": None}
    results.record(NAME, entry | {"seconds": round(time.perf_counter() - began, 3)})
    results.finish()
    page = write_page(
        results,
        title=f"{name}: {title[0].lower()}{title[1:]}",
        scenes=[],
        sections=KEPT,
        findings=found,
    )
    print(printable(str(page)), file=sys.stderr)
    return 0


def _measured(
    motion: Motion,
    schemes: Sequence[str] | None,
    every: int,
    out: BoolArray,
    options: Mapping[str, Any],
) -> list[Row]:
    """A row per scheme, with what was measured of each joint."""
    from quatspline import catalogue
    from quatspline.instruments.trials import attempted
    from quatspline.runs import rehearsal
    from quatspline.runs.experiment import Run

    names = list(schemes or catalogue.schemes())
    count = int((~out).sum()) * len(motion.tracks)
    given = (motion, every, count, schemes is not None, dict(options))
    failed = rehearsal.failures(_alone, names, *given)
    rows = []
    for scheme in Run(quick=True).progress(names, label="compare"):
        measure = partial(_row, scheme, *given)
        row = {"failure": failed[scheme]} if scheme in failed else attempted(measure)[0]
        rows.append({"scheme": scheme} | row)
    return rows


def _alone(scheme: str, motion: Motion, every: int, *given: Any) -> None:
    """All that is asked of one scheme, whose orientations have to be unit quaternions."""
    from quatspline import catalogue
    from quatspline.admission import no_unit
    from quatspline.options import among

    _row(scheme, motion, every, *given)
    options = among(catalogue.scheme(scheme), given[-1])
    for piece in motion.curve(scheme, every=every, **options).pieces:
        curve = piece.orientation
        if flaw := no_unit(curve, curve.keyframes.inside([0.0, 0.5, 1.0])):
            raise ValueError(flaw)


def _row(
    scheme: str, motion: Motion, every: int, count: int, asked: bool, options: Mapping[str, Any]
) -> list[Row]:
    """The row of one scheme; ``count``: keyframes in all, ``asked``: whether it was for this one by name."""
    from quatspline import catalogue
    from quatspline.instruments import kept
    from quatspline.instruments.excursion import SAMPLES
    from quatspline.options import among
    from quatspline.timing.own_keyframes import left_out, too_dear

    if not asked and (reason := left_out(scheme, count)):
        return [{"failure": reason}]
    arcs = not (asked and too_dear(scheme, count, SAMPLES + 1))
    given = among(catalogue.scheme(scheme), options)
    return [kept.row(motion, scheme, every, given, arcs=arcs)]


def _tables(
    results: Results, rows: Sequence[Row], title: str, options: Mapping[str, Any]
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Write both tables: of schemes, and of every joint under each."""
    import pandas as pd

    from quatspline.comparing import told

    table = pd.DataFrame(rows).reindex(columns=COLUMNS)
    table = table.sort_values(["rms_median", "scheme"], na_position="last", ignore_index=True)
    table = results.table(
        NAME, table, title=title, note=NOTE + told(options), formats=FORMATS, keys=[]
    )
    of = [{"scheme": row["scheme"]} | joint for row in rows for joint in row.get("by_joint", [])]
    joints = pd.DataFrame(of, columns=["scheme", "joint", "rms", "largest", "excursion"])
    formats = {"rms": ".3e", "largest": ".3e", "excursion": ".3g"}
    return table, results.table(
        JOINTS, joints, title=JOINTS_TITLE, note=JOINTS_NOTE, formats=formats, keys=[]
    )


def _drawn(
    results: Results, table: pd.DataFrame, joints: pd.DataFrame, wanted: pd.DataFrame
) -> None:
    """Draw both figures, told apart the schemes that are wanted; none where nothing was measured."""
    import matplotlib as mpl

    from quatspline.cli.played import chosen
    from quatspline.figures import kept, style

    if joints.empty:
        return
    mpl.use("Agg")  # nothing here may open a window
    with style.applied():
        names = chosen(wanted, "rms_median")[:DRAWN]
        results.figure(NAME, kept.spans(table, names))
        results.figure(JOINTS, kept.by_joint(joints, names))
    results.text(f"{NAME}.caption.txt", SPANS)
    results.text(f"{JOINTS}.caption.txt", BY_JOINT)
