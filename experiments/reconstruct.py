"""Dense recorded motion, rebuilt from every n-th frame: what schemes are worth on what people record."""

from collections.abc import Sequence
from functools import cache, partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import found
from quatspline.figures import rows, style
from quatspline.figures.heat import ROW, label_cells, log_heat
from quatspline.instruments.reconstruction import EULER, Truth, rebuild, reconstruction, truth
from quatspline.instruments.summary import ALL, compared
from quatspline.instruments.trials import Row, attempted
from quatspline.motion.replay import replay
from quatspline.runs.experiment import Run, crossed
from quatspline.timing.budget import OVER, Budget, calls, too_many
from quatspline.trajectories.clips import CONTROLS, OWN, clip, each_kind, middle, names
from quatspline.trajectories.credits import credit

TITLE = "Recorded motion, rebuilt"
PAPER = False
KEYS = ["clip", "filter", "every", "scheme"]
NOTE = (
    "Every n-th frame of a dense motion and the last one are kept, and the others are rebuilt. Clips are the files in "
    f"the folder that QUATSPLINE_MOTIONS names; without it, the project's own clip '{OWN}', which is generated and not "
    f"recorded. '{ALL}' pools the joints of all clips. filter: the truth is the recording itself (none) or what a "
    "zero-phase Butterworth filter of its steps leaves. Angles are of local orientations at the frames left out, "
    "except those within two keyframes of an end; lower is better. over_slerp: a joint's rms angle relative to "
    "slerp's, geometric mean over the compared joints, which are those on which all schemes ran that ran on nine "
    "tenths of the clip's joints; most_over_slerp: the largest. rms_degrees: the joints' rms angle, median; "
    "worst_degrees: the largest, for worst_joint; largest_degrees: the largest angle of all. end_cm: rms distance of "
    "end effectors, with the true path of the root; omega, alpha: rms errors of angular velocity and acceleration "
    "relative to the rms of the truth's, only for filtered truth. Excluded are joints that turn less than 1 degree, "
    "fingers and thumbs, and those in pops, which turn faster than 1800 degrees a second somewhere. At quick size the "
    "middle 180 frames are used. Controls: euler-linear and euler-cubic interpolate Euler channels; 'tumble' is "
    "motion without noise, 'white noise' is noise without motion."
)
FORMATS = {
    **dict.fromkeys(
        ("rms_degrees", "worst_degrees", "end_cm", "over_slerp", "most_over_slerp"), ".3f"
    ),
    **dict.fromkeys(("largest_degrees", "end_largest_cm"), ".2f"),
    **dict.fromkeys(("omega", "alpha"), ".3f"),
}
RAW = "none"
CUTOFFS = {RAW: None, "10 Hz": 10.0, "6 Hz": 6.0}
KEPT, KEPT_QUICK = (2, 4, 8, 16, 32), (4, 16)
FRAMES_QUICK = 180
"""Of a clip, from its middle, at quick size; in full all."""
SLERP = "slerp"

FULL, QUICK = Budget(limit=2e7, meter=calls), Budget(limit=8e4, meter=calls)
"""Of a library's scheme on all joints of a clip."""


def cells(run: Run) -> list[dict[str, Any]]:
    """A clip's cells follow each other: a process reads and filters it once."""
    kept, filters = (KEPT_QUICK, (RAW, "6 Hz")) if run.quick else (KEPT, tuple(CUTOFFS))
    schemes = [*dict.fromkeys([SLERP, *run.names]), *EULER]
    recorded = crossed(clip=names(), filter=filters, every=kept, scheme=schemes)
    return recorded + crossed(clip=CONTROLS, filter=(RAW,), every=kept, scheme=schemes)


def measure_cell(run: Run, clip: str, filter: str, every: int, scheme: str) -> list[Row]:
    measured = partial(_measured, run, clip, filter, every, scheme)
    return attempted(measured, clip=clip, filter=filter, every=every, scheme=scheme)


def _measured(run: Run, clip: str, filter: str, every: int, scheme: str) -> list[Row]:
    true = _truth(clip, filter, run.quick)
    if refusal := _refusal(run, true, scheme, (every, 0, 0)):
        return [{"failure": refusal}]
    rates = filter != RAW and not _refusal(run, true, scheme, (every, every, every))
    rebuilt = rebuild(true, scheme, every, rates=rates)
    return [reconstruction(true, rebuilt, every)]


@cache
def _truth(name: str, filter: str, quick: bool) -> Truth:
    motion = clip(name)
    return truth(middle(motion, FRAMES_QUICK) if quick else motion, CUTOFFS[filter])


def _refusal(run: Run, true: Truth, name: str, samples: tuple[int, int, int]) -> str | None:
    """Why a scheme would take too long for so many samples of every segment, on all joints."""
    cls = found()[name].scheme if name in found() else None
    if cls is None:
        return None
    count = len(true.tracks.times) // samples[0] + 1
    budget = QUICK if run.quick else FULL
    affords = cls.peer is None or budget.affords(len(true.compared) * _work(name, count, samples))
    return too_many(cls, count) or (None if affords else OVER)


@cache
def _work(name: str, count: int, samples: tuple[int, int, int]) -> float:
    cls = found()[name].scheme
    return 0.0 if cls is None else FULL.work(cls, count, samples)


def gather(run: Run, table: pd.DataFrame) -> pd.DataFrame:
    return compared(table, KEYS, SLERP, set(CONTROLS))


# -- the player --------------------------------------------------------------------------------


PLAYED, KEPT_PLAYED = ("slerp", "local-quintic", "kim", "squad", "quartic", "circular-blend"), 16
"""Schemes that the page's player offers, and of which frames they make the motion."""


def replays(run: Run) -> list[dict[str, Any]]:
    return [each for name in each_kind() for each in _replay(name, run.schemes or PLAYED)]


def _replay(name: str, schemes: Sequence[str]) -> list[dict[str, Any]]:
    """A clip for the player; none where nothing moves, is left out or is rebuilt: its rows say so."""
    motion, source = clip(name), credit(name)
    try:
        joints = _truth(name, RAW, quick=False).compared.tolist()
        return [replay(motion, schemes, KEPT_PLAYED, title=name, source=source, joints=joints)]
    except ValueError:
        return []


# -- the figure ---------------------------------------------------------------------------------


def draw(table: pd.DataFrame) -> Figure:
    panels, sharing = _panels(table), _sharing(table)
    names = list(sharing)
    fig, axes = style.axes(style.PAGE, ROW * len(names) + 1.2, 1, len(panels))
    for ax, (name, each) in zip(axes[0], panels, strict=True):
        shown = _shown(table, name, each).reindex(names)
        looks: dict[str, Any] = {
            "names_shown": ax is axes[0, 0],
            "colours": "RdBu_r",
            "ticks": TICKS,
            "under": list(axes[0]) if ax is axes[0, -1] else [],
        }
        log_heat(ax, shown, "rms angle over slerp's", (1 / SPAN, SPAN), **looks)
        label_cells(ax, shown.map(_text), shown.gt(DARK) | shown.lt(1 / DARK))
        ax.set(title=_title(name, each), xlabel="one frame kept of")
    rows.label(axes[0, 0], names, sharing, None)
    style.letters(axes[0])
    return fig


def _panels(table: pd.DataFrame) -> list[tuple[str, str]]:
    """Clips and filters of which there are numbers."""
    panels = [(ALL, each) for each in CUTOFFS] + [(name, RAW) for name in CONTROLS]
    return [panel for panel in panels if _shown(table, *panel).size]


def _sharing(table: pd.DataFrame) -> dict[str, list[str]]:
    """Schemes with a row of their own, the best on recorded motion first."""
    shown = {panel: _shown(table, *panel) for panel in _panels(table)}
    ratios = pd.concat(shown, axis=1).reindex(_order(table))
    return rows.shared(ratios.clip(1 / SPAN, SPAN).transform(np.log))


SPAN = 8.0
"""Ratios to slerp beyond which a colour says no more."""
DARK = 3.5
"""Ratios beyond this, or its inverse, are written in white."""
TICKS = {1 / 8: "1/8", 1 / 2: "1/2", 2.0: "2", 8.0: "8"}


def _shown(table: pd.DataFrame, name: str, filter: str) -> pd.DataFrame:
    own = table[(table["clip"] == name) & (table["filter"] == filter)]
    return own.pivot(index="scheme", columns="every", values="over_slerp").dropna(how="all")


def _order(table: pd.DataFrame) -> list[str]:
    """Schemes that ran, the best on recorded motion first."""
    own = table[(table["clip"] == ALL) & table["over_slerp"].notna()]
    logs = np.log(own["over_slerp"])
    # Over the other schemes of a cell: one that did not run in all is not judged by which.
    logs -= logs.groupby([own["filter"], own["every"]]).transform("median")
    return [str(name) for name in logs.groupby(own["scheme"]).mean().sort_values().index]


def _text(ratio: float) -> str:
    if np.isnan(ratio):
        return ""
    if ratio < 0.005:
        return "<.01"
    return f"{ratio:.2f}".lstrip("0") if ratio < 9.95 else f"{ratio:.0f}"


def _title(name: str, filter: str) -> str:
    if name != ALL:
        return name
    return "as recorded" if filter == RAW else f"below {filter}"


def _count(clips: list[str]) -> str:
    return f"{len(clips)} clip{'' if len(clips) == 1 else 's'}"


def caption(table: pd.DataFrame) -> str:
    clips = sorted(set(table["clip"]) - {ALL, *CONTROLS})
    made = " No recorded clip was given: this is the project's own walk." if clips == [OWN] else ""
    return (
        "Rms angle of joints at the frames left out when every 2nd, 4th, ... frame is kept, relative to slerp's, "
        f"geometric mean ({_count(clips)}): below 1 (blue) is better than slerp. Recordings as they are, low-pass "
        f"filtered, and two controls, motion without noise and noise without motion; grey: too slow, or refused.{made} "
        f"{rows.said(_sharing(table))}"
    )
