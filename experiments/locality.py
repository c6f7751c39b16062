"""How far a change of one keyframe reaches, in segments and in size."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import scheme as scheme_class
from quatspline.figures import rows, style
from quatspline.figures.heat import ROW, log_heat, scheme_rows
from quatspline.instruments import lookahead as ahead
from quatspline.instruments.locality import locality, responses
from quatspline.instruments.trials import Row, attempted, builder, facts, records
from quatspline.quaternion import FloatArray
from quatspline.runs.experiment import Run, crossed
from quatspline.trajectories.walks import walk

TITLE = "Locality"
PAPER = False
KEYS = ["step_degrees", "scheme", "offset"]
NOTE = (
    "The middle one of 41 keyframes of a random walk at uniform times is turned by 0.01 rad about three axes. "
    "response: the largest angle by which the curve moves on a segment, relative to the angle of the turn; offset: "
    "the segment, counted from the keyframe. amplification: the largest response (lower is calmer, 1 is neutral); "
    "reach_before, reach_after: segments up to the last one with a response over 1e-8; support: their sum, which is "
    "the number of keyframes that shape a segment; decay: the factor per segment beyond the second (lower is more "
    "local). claimed_support is empty where all keyframes count; agrees: the measured support is the claimed one, or "
    "a tail decays where none is claimed. lookahead: keyframes after a segment's own two that shape it, found by "
    "turning each of 12 keyframes in turn; empty where all do. claimed_lookahead is read in the same way, and "
    "lookahead_agrees compares the two."
)
FORMATS = {"response": ".2e", "amplification": ".3f", "decay": ".3f"}
COUNT = 41
SHOWN = 8
"""Segments to either side in the figure."""
ANGLE = 60
"""Of the steps in the figure."""
LIMITS = (1e-8, 1.0)


def cells(run: Run) -> list[dict[str, Any]]:
    return crossed(scheme=run.names, degrees=(60,) if run.quick else (10, 60, 120))


def measure_cell(run: Run, scheme: str, degrees: int) -> list[Row]:
    measured = partial(_measured, run, scheme, degrees)
    return attempted(measured, step_degrees=degrees, scheme=scheme)


def _measured(run: Run, name: str, degrees: int) -> list[Row]:
    times = np.arange(float(COUNT))
    keyframes = walk(run.rng("locality", degrees), COUNT, float(degrees))[:, 0]
    build = builder(name)
    table = responses(build, times, keyframes)
    summary = locality(table)
    claimed = scheme_class(name).support
    agrees = not np.isnan(summary["decay"]) if claimed is None else summary["support"] == claimed
    more = {"claimed_support": claimed, "agrees": agrees, **facts(build(times, keyframes))}
    more |= _lookahead(name, times, keyframes)
    return [row | summary | more for row in records(table)]


def _lookahead(name: str, times: FloatArray, keyframes: FloatArray) -> Row:
    few = times[: ahead.COUNT], keyframes[: ahead.COUNT]
    measured = ahead.lookahead(ahead.moved(builder(name), *few))
    claimed = scheme_class(name).lookahead
    return {
        "lookahead": measured,
        "claimed_lookahead": claimed,
        "lookahead_agrees": measured == claimed,
    }


def gather(run: Run, table: pd.DataFrame) -> pd.DataFrame:
    whole = ["offset", "reach_before", "reach_after", "support", "claimed_support"]
    whole += ["lookahead", "claimed_lookahead"]
    return table.astype({name: "Int64" for name in whole if name in table})


def draw(table: pd.DataFrame) -> Figure:
    shown = _responses(table)
    summary = table[table["step_degrees"] == ANGLE].drop_duplicates("scheme").set_index("scheme")
    sharing = _sharing(table)
    reach = summary.loc[list(sharing), ["support", "amplification"]].round(2)
    names = list(reach.sort_values(["support", "amplification"], kind="stable").index)
    widths = {"gridspec_kw": {"width_ratios": (2.6, 1)}}
    fig, panels = style.axes(style.PAGE, ROW * len(names) + 1.2, 1, 2, **widths)
    label = "largest movement over that of the keyframe"
    shown.columns = [f"{int(offset):+d}" for offset in shown.columns]
    log_heat(panels[0, 0], shown.loc[names], label, LIMITS)
    panels[0, 0].set(title="reach", xlabel="segment, from the keyframe")
    rows.label(panels[0, 0], names, sharing, chosen=None)
    ax = panels[0, 1]
    rows.mark(ax, summary["amplification"], names, None)
    ax.axvline(1.0, color="#888888", lw=0.6, zorder=1)
    ax.set(title="amplification", xlabel="largest movement", xlim=(0.0, None))
    scheme_rows(ax, names, shown=False)
    style.letters(panels[0])
    return fig


def _responses(table: pd.DataFrame) -> pd.DataFrame:
    near = table[(table["step_degrees"] == ANGLE) & (table["offset"].abs() <= SHOWN)]
    return near.pivot(index="scheme", columns="offset", values="response")


def _sharing(table: pd.DataFrame) -> dict[str, list[str]]:
    return rows.shared(_responses(table).clip(*LIMITS).transform(np.log10))


def caption(table: pd.DataFrame) -> str:
    return (
        f"(a) How far turning one keyframe moves the curve, on the segments to either side of it ({ANGLE} degree "
        f"steps, uniform times), as a share of the turn; below {LIMITS[0]:g} palest. Rows are sorted by the number of "
        "segments reached. (b) The largest movement in segments, relative to that of the keyframe: above 1 the change "
        f"is amplified. Hollow marks are third-party schemes. {rows.said(_sharing(table))}"
    )
