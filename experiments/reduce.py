"""How many keyframes each scheme needs to rebuild recorded motion within an angle."""

from functools import cache, partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from quatspline import catalogue
from quatspline.catalogue import called
from quatspline.figures import direct, named, style
from quatspline.instruments.reconstruction import truth
from quatspline.instruments.reduction import reduction
from quatspline.instruments.summary import ALL, compared
from quatspline.instruments.trials import Row, attempted
from quatspline.motion import Motion
from quatspline.runs.experiment import Run, crossed
from quatspline.trajectories.clips import OWN, clip, middle, names

TITLE = "Keyframes that recorded motion needs"
PAPER = False
KEYS = ["clip", "filter", "error_degrees", "scheme"]
FRAMES, QUICK = 600, 240
"""Of a clip at most so many, from its middle; fewer at quick size."""
NOTE = (
    "Keyframes of a dense motion are inserted at the worst frame, and removed again where their neighbours do not "
    "need them, joint by joint, until the scheme rebuilds every frame within error_degrees. The clips and the "
    f"exclusions are those of the experiment reconstruct; the middle {FRAMES} frames of a clip are used ({QUICK} at "
    "quick size). keyframes: of all joints that did not fail; share: the same relative to their frames; per_second: "
    "keyframes per joint and second; over_slerp: a joint's number of keyframes relative to slerp's, geometric mean "
    "over the compared joints, on which all schemes ran; most_over_slerp: the largest; lower is better. The search is "
    "greedy: fewer may be enough. Only schemes of this package that are cheap to set up are tried (at quick size "
    f"those of the figure), unless others are requested. Without recorded clips there is only '{OWN}', which the "
    "project generates."
)
FORMATS = {
    "share": ".3f",
    "per_second": ".2f",
    "over_slerp": ".3f",
    "most_over_slerp": ".3f",
    "largest_degrees": ".3f",
}
RAW = "none"
CUTOFFS = {RAW: None, "10 Hz": 10.0}
ERRORS, ERRORS_QUICK = (0.25, 0.5, 1.0, 2.0, 4.0), (0.5, 2.0)
SLERP = "slerp"
SHOWN = ("slerp", "squad", "quartic", "quintic", "local-quintic", "kim", "biarc")
"""In the figure: of schemes that need the same, one."""


def cells(run: Run) -> list[dict[str, Any]]:
    errors = ERRORS_QUICK if run.quick else ERRORS
    schemes = [*dict.fromkeys([SLERP, *_concerned(run)])]
    return crossed(clip=names(), filter=CUTOFFS, error_degrees=errors, scheme=schemes)


def _concerned(run: Run) -> list[str]:
    """Schemes that are cheap to set up hundreds of times per joint; at quick size those that are shown."""
    if run.quick and not run.schemes:
        return list(SHOWN)
    known = {name: catalogue.scheme(name) for name in catalogue.schemes()}
    cheap = [n for n, c in known.items() if c.peer is None and c.practical_keyframes is None]
    return run.schemes or cheap


def measure_cell(run: Run, clip: str, filter: str, error_degrees: float, scheme: str) -> list[Row]:
    measured = partial(_measured, run, clip, filter, error_degrees, scheme)
    return attempted(measured, clip=clip, filter=filter, error_degrees=error_degrees, scheme=scheme)


def _measured(run: Run, clip: str, filter: str, error_degrees: float, scheme: str) -> list[Row]:
    tracks = _tracks(clip, filter, QUICK if run.quick else FRAMES)
    return [reduction(tracks, scheme, float(np.radians(error_degrees)))]


@cache
def _tracks(name: str, filter: str, frames: int) -> Motion:
    tracks = truth(clip(name), CUTOFFS[filter]).tracks
    return middle(tracks, frames)


def gather(run: Run, table: pd.DataFrame) -> pd.DataFrame:
    return compared(table, KEYS, SLERP)


# -- the figure ---------------------------------------------------------------------------------


def draw(table: pd.DataFrame) -> Figure:
    filters = [each for each in CUTOFFS if (table["filter"] == each).any()]
    fig, panels = style.axes(style.PAGE, 3.0, 1, 2 * len(filters))
    panels[0, len(filters) - 1].sharey(panels[0, 0])
    panels[0, -1].sharey(panels[0, len(filters)])
    for k, each in enumerate(filters):
        rows = table[(table["filter"] == each) & table["scheme"].isin(SHOWN)]
        shares, ratios = panels[0, k], panels[0, len(filters) + k]
        _lines(shares, _shares(rows))
        ends = _lines(ratios, rows[rows["clip"] == ALL].set_index("error_degrees"), "over_slerp")
        title = "as recorded" if each == RAW else f"below {each}"
        shares.set(title=title, yscale="log", ylabel="keyframes per frame" if k == 0 else "")
        ratios.set(title=title, ylabel="keyframes over slerp's" if k == 0 else "")
        shares.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        shares.yaxis.set_major_formatter("{x:g}")
    for ax in panels[0]:
        ax.set_xscale("log")
        ax.set_xticks(sorted(table["error_degrees"].unique()), labels=None)
        ax.xaxis.set_major_formatter("{x:g}")
        ax.minorticks_off()
        ax.set_xlabel("allowed error (degrees)")
    style.letters(panels[0])
    named.name_ends(fig, {panels[0, -1]: ends})
    return fig


def _shares(rows: pd.DataFrame) -> pd.DataFrame:
    """Keyframes over frames, of all clips."""
    clips = rows[(rows["clip"] != ALL) & rows["keyframes"].notna()]
    sums = clips.groupby(["error_degrees", "scheme"])[["keyframes", "frames"]].sum().reset_index()
    sums["share"] = sums["keyframes"] / sums["frames"]
    return sums.set_index("error_degrees")


def _lines(ax: Any, rows: pd.DataFrame, column: str = "share") -> dict[str, direct.End]:
    """Draw a curve per scheme; where each ends."""
    ends = {}
    for name in SHOWN:
        own = rows.loc[rows["scheme"] == name, column].dropna().sort_index()
        if len(own):
            look = style.scheme_style(name)
            ax.plot(own.index, own, **look)
            tip = (float(own.index[-1]), float(own.iloc[-1]))
            ends[name] = direct.End(*tip, called(name), look["color"], look["linestyle"])
    return ends


def _count(clips: list[str]) -> str:
    return f"{len(clips)} clip{'' if len(clips) == 1 else 's'}"


def caption(table: pd.DataFrame) -> str:
    clips = sorted(set(table["clip"]) - {ALL})
    made = " No recorded clip was given: this is the project's own walk." if clips == [OWN] else ""
    return (
        "Keyframes of recorded motion that greedy reduction keeps, by the error allowed at every frame, joint by joint "
        f"({_count(clips)}): as a share of all frames, and relative to slerp's number, geometric mean over joints. "
        f"Recordings as they are, and low-pass filtered.{made}"
    )
