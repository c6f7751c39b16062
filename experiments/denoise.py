"""What smoothing gains where keyframes are noisy, and where it gains nothing: on a known motion and on clips."""

from functools import cache, partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from quatspline.catalogue import called
from quatspline.figures import direct, named, style
from quatspline.instruments.denoising import KNOWN, denoising, disturbed
from quatspline.instruments.reconstruction import truth
from quatspline.instruments.summary import ALL, compared
from quatspline.instruments.trials import Row, attempted
from quatspline.motion import Motion
from quatspline.quaternion import FloatArray
from quatspline.runs.experiment import Run, crossed
from quatspline.trajectories.clips import OWN, clip, middle, names, tumbling
from quatspline.trajectories.smooth import tumble_rates

TITLE = "Noisy keyframes, with and without smoothing"
PAPER = False
KEYS = ["clip", "every", "noise_degrees", "scheme"]
NOTE = (
    "Every n-th frame of a dense motion and the last one are kept, and white rotation errors with the standard "
    "deviation noise_degrees about each axis are added to them. Curves are compared with the frames left out, which "
    "have no added noise. 'tumble' is analytic: several draws of the noise take the place of joints, and its truth is "
    f"exact. Clips are recordings (the project's own '{OWN}' if QUATSPLINE_MOTIONS names none), and their frames left "
    f"out have noise of their own. '{ALL}' pools the joints of all clips. rms_degrees: a joint's rms angle, median "
    "over joints; worst_degrees: the largest; keyframes_degrees: the same at the keyframes, where an interpolant is "
    "off by the noise itself, sqrt(3) noise_degrees; over_slerp: a joint's rms angle relative to slerp's, geometric "
    "mean; most_over_slerp: the largest; omega: rms error of the angular velocity, degrees per second, of the tumble; "
    "told_degrees: the noise as estimated from the keyframes alone. Lower is better, except for told_degrees, which "
    "should equal noise_degrees. smoothing-spline chooses its weight by itself, by cross-validation (', gcv') or from "
    "the noise that was added, if any (', told')."
)
FORMATS = {
    **dict.fromkeys(("rms_degrees", "worst_degrees", "keyframes_degrees", "told_degrees"), ".3f"),
    **dict.fromkeys(("over_slerp", "most_over_slerp"), ".3f"),
    "omega": ".3g",
}
SLERP, OURS = "slerp", "smoothing-spline"
CHOSEN = (SLERP, "quartic", "squad", "local-quintic", "kim", OURS)
WAYS: dict[str, dict[str, Any]] = {
    f"{OURS}, gcv": {"smoothing": "gcv"},
    f"{OURS}, told": {KNOWN: None},
}
"""Other ways to choose the weight, and their options: the noise is filled in."""
TUMBLE = "tumble"
SIGMAS, SIGMAS_QUICK = (0.0, 0.03, 0.1, 0.3, 1.0, 3.0), (0.0, 0.3, 1.0)
KEPT, KEPT_QUICK = (2, 4, 8), (8,)
"""Of clips; of the tumble those that follow: 401, 101 and 26 keyframes."""
TUMBLED, TUMBLED_QUICK = (3, 12, 48), (3,)
DRAWS, DRAWS_QUICK = 20, 3
FRAMES_QUICK = 180
"""Of a clip, at quick size."""


def cells(run: Run) -> list[dict[str, Any]]:
    """A clip's cells follow each other: a process reads it once."""
    asked = list(dict.fromkeys([SLERP, *(run.schemes or CHOSEN)]))
    schemes = asked + (list(WAYS) if OURS in asked else [])
    sigmas = SIGMAS_QUICK if run.quick else SIGMAS
    kept: dict[str, tuple[int, ...]] = {TUMBLE: TUMBLED_QUICK if run.quick else TUMBLED}
    kept |= dict.fromkeys(names(), KEPT_QUICK if run.quick else KEPT)
    found = [
        cell
        for name, counts in kept.items()
        for cell in crossed(clip=(name,), every=counts, noise_degrees=sigmas, scheme=schemes)
    ]
    return [cell for cell in found if cell["noise_degrees"] or not _is_told(cell["scheme"])]


def _is_told(scheme: str) -> bool:
    return KNOWN in WAYS.get(scheme, {})


def measure_cell(run: Run, clip: str, every: int, noise_degrees: float, scheme: str) -> list[Row]:
    measured = partial(_measured, run, clip, every, noise_degrees, scheme)
    case = {"clip": clip, "every": every, "noise_degrees": noise_degrees}
    return attempted(measured, **case, scheme=scheme)


def _measured(run: Run, clip: str, every: int, noise_degrees: float, scheme: str) -> list[Row]:
    true, omega = _truth(clip, run.quick)
    noisy = disturbed(true, noise_degrees, run.rng("denoise", clip, every, noise_degrees))
    options = dict(WAYS.get(scheme, {}))
    if _is_told(scheme):
        options[KNOWN] = float(np.radians(noise_degrees))
    return [denoising(true, noisy, scheme.split(",")[0], every, omega, **options)]


@cache
def _truth(name: str, quick: bool) -> tuple[Motion, FloatArray | None]:
    """The true motion and, where it is known, its velocity (n, 3)."""
    if name != TUMBLE:
        motion = clip(name)
        return truth(middle(motion, FRAMES_QUICK) if quick else motion).tracks, None
    one, draws = tumbling(), DRAWS_QUICK if quick else DRAWS
    q = np.repeat(one.quaternions, draws, axis=1)
    return Motion(one.times, q, tracks=[f"draw {k}" for k in range(draws)]), tumble_rates(
        one.times
    )[0]


def gather(run: Run, table: pd.DataFrame) -> pd.DataFrame:
    return compared(table, KEYS, SLERP, {TUMBLE})


# -- the figure ---------------------------------------------------------------------------------

MARKS = {f"{OURS}, gcv": ("x", "by cross-validation"), f"{OURS}, told": ("+", "told the noise")}
"""Of other ways to choose the weight, without lines: they lie on the curve of the scheme, or show beside it."""
NONE = 0.2
"""Where no noise is drawn, over the least noise: apart from a curve that would need a logarithm of 0."""


def draw(table: pd.DataFrame) -> Figure:
    fig, axes = style.axes(style.PAGE, 2.9, 1, 3)
    known, recorded = table[table["clip"] == TUMBLE], table[table["clip"] == ALL]
    panels = (
        (known, "rms_degrees", f"{TUMBLE}, {{n}} keyframes", "rms angle (deg)"),
        (known, "omega", f"{TUMBLE}, {{n}} keyframes", "rms velocity error (deg/s)"),
        (recorded, "over_slerp", "clips, 1 frame in {every} kept", "rms angle over slerp's"),
    )
    for ax, (rows, column, title, label) in zip(axes[0], panels, strict=True):
        dense = rows[rows["every"] == rows["every"].min()] if len(rows) else rows
        ends = _lines(ax, dense, column)
        counts = dense["keyframes"].dropna()
        facts = {"n": int(counts.max()) if len(counts) else 0, "every": dense["every"].min()}
        ax.set(title=title.format(**facts), xlabel="noise about each axis (deg)", ylabel=label)
        _noises(ax, sorted(table["noise_degrees"].unique()))
    for ax in axes[0, :2]:
        ax.set_yscale("log")
    axes[0, 2].axhline(1.0, color="#8a8a8a", linewidth=0.6)
    style.letters(axes[0])
    fig.legend(handles=_key(), loc="outside lower center", ncols=2)
    named.name_ends(fig, {axes[0, 2]: ends})
    return fig


def _noises(ax: Any, sigmas: list[float]) -> None:
    """A logarithmic axis, with a place for no noise left of a line."""
    ax.set_xscale("log")
    least = min(sigma for sigma in sigmas if sigma > 0.0)
    shown = [sigma for sigma in sigmas if sigma > 0.0]
    ax.set_xticks([NONE * least, *shown], ["0", *(f"{sigma:g}" for sigma in shown)])
    ax.minorticks_off()
    ax.axvline(np.sqrt(NONE) * least, color="#8a8a8a", lw=0.6, ls=(0, (2, 2)))


def _lines(ax: Any, rows: pd.DataFrame, column: str) -> dict[str, direct.End]:
    """Draw a curve per scheme, without noise a mark apart from it; where curves end."""
    ends = {}
    least = rows.loc[rows["noise_degrees"] > 0.0, "noise_degrees"].min()
    for name in dict.fromkeys(rows["scheme"]):
        own = rows[(rows["scheme"] == name) & rows[column].notna()].sort_values("noise_degrees")
        still, noisy = own[own["noise_degrees"] == 0.0], own[own["noise_degrees"] > 0.0]
        look = _look(name)
        ax.plot(noisy["noise_degrees"], noisy[column], **look)
        ax.plot([NONE * least] * len(still), still[column], **look)
        if len(noisy) and name not in MARKS:
            tip = (noisy["noise_degrees"].iloc[-1], noisy[column].iloc[-1])
            ends[name] = direct.End(*tip, called(name), look["color"], look["linestyle"])
    return ends


def _look(name: str) -> dict[str, Any]:
    look = style.scheme_style(name.split(",")[0])
    if name not in MARKS:
        return look
    return {"color": look["color"], "marker": MARKS[name][0], "linestyle": "", "ms": 6.0}


def _key() -> list[Line2D]:
    return [
        Line2D([], [], label=f"{OURS} {way}", **_look(name)) for name, (_, way) in MARKS.items()
    ]


def caption(table: pd.DataFrame) -> str:
    clips = sorted(set(table["clip"]) - {ALL, TUMBLE})
    made = " No recorded clip was given: this is the project's own walk." if clips == [OWN] else ""
    return (
        "Errors at the frames left out, by the white noise added to the keyframes: (a) of the orientation and (b) of "
        "the angular velocity on a known motion, (c) of the orientation on recordings as multiples of slerp's error, "
        f"geometric mean over joints ({len(clips)} clip{'' if len(clips) == 1 else 's'}). Left of the dashed line no "
        "noise is added. Interpolants pass the noise on. The smoothing spline chooses how close to keep to its "
        f"keyframes: by default (curve), by cross-validation (x) or given the noise (+).{made}"
    )
