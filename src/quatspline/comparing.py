"""Compare schemes on somebody's own keyframes: one table, figures, a recommendation and a page."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from quatspline import keyframes as kf
from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.experiment import Run
from quatspline.instruments.continuity import jumps, measured_continuity, rounding, speeds
from quatspline.instruments.fairness import fairness
from quatspline.instruments.practical import left_out
from quatspline.instruments.timing import interleaved, repeated
from quatspline.instruments.trials import Row, attempted, facts
from quatspline.keyframes import Keyframes
from quatspline.options import declared
from quatspline.quaternion import FloatArray
from quatspline.registry import scheme, schemes
from quatspline.stdout import say

if TYPE_CHECKING:
    import pandas as pd

    from quatspline.report.results import Results
    from quatspline.trajectories.files import Motion

TOLERANCE = 1e-9
"""Of iterative schemes, in rad."""

ROUNDS, LEAST, SLOW = 5, 2e-3, 0.02
"""Of the timings: rounds, seconds a measurement, and the seconds from which one call is enough."""

ENERGIES = ("torque", "jerk", "peak")
TITLE = "Comparison on your keyframes"
NOTE = (
    "continuity is k of C^k as measured on these keyframes; misses the largest angle at a keyframe (rad); torque the "
    "integral of |alpha|^2, jerk that of |alpha'|^2, peak the largest |alpha|, infinite where the velocity jumps, each "
    "also over the least here; key_speed the least speed at an inner keyframe, peak_speed the largest, over the mean. "
    "Iterative schemes solve to 1e-9. Every segment is measured, however many there are; failure says why a scheme was "
    "not. Compare seconds within this table only."
)
FILES = [
    *(f"compare{end}" for end in (".csv", ".md", ".png", ".svg", ".caption.txt")),
    *(f"rates{end}" for end in (".png", ".svg", ".caption.txt")),
    *("recommendation.md", "report.html"),
]
"""What the command writes."""
BARS = "Torque energy over the least of all schemes compared; hollow: not C2 as measured here.\n"
RATES = "Norms of the angular velocity and acceleration over time; grey lines are keyframes.\n"
FORMATS = {
    "misses": ".1e",
    **{f"{name}_over_least": ".4f" for name in ENERGIES},
    "seconds_set_up": ".2e",
    "seconds_per_sample": ".2e",
}


def compare(
    times: ArrayLike | None,
    quaternions: Any,
    schemes: Sequence[str] | None = None,
    *,
    closed: bool = False,
) -> pd.DataFrame:
    """Measure schemes on keyframes: one row a scheme, what does not apply or fails with its reason.

    Parameters
    ----------
    times, quaternions, closed : a single track, as `quatspline.build` takes it
    schemes : names, by default all; of those, libraries' schemes that would take long on so many
        keyframes are left out with a reason, the same ones in every run

    Returns
    -------
    DataFrame with the columns scheme, continuity, misses, torque, jerk, peak, length (rad), the first
    three over the least here, key_speed, peak_speed, support, iterations, rates, version, failure and
    the timings seconds_set_up and seconds_per_sample; sorted by torque, failures last.  ``failure``
    says why a scheme was not measured, all else in its row being NaN; it is NaN where one was.

    Raises
    ------
    ValueError
        On bad keyframes, an unknown scheme, or several tracks.

    Examples
    --------
    >>> import quatspline as qs
    >>> keyframes = [[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0, 0.6, 0.8, 0], [0, 0, 1, 0]]
    >>> table = qs.compare(None, keyframes, ["slerp", "quartic"])
    >>> table.set_index("scheme")["continuity"].to_dict()
    {'quartic': 2, 'slerp': 0}
    """
    keyframes = _prepared(times, quaternions, closed)
    return _compared(keyframes, schemes)[0]


def _prepared(times: ArrayLike | None, quaternions: ArrayLike, closed: bool) -> Keyframes:
    """Keyframes with times since the first: instruments divide steps that the times of a clock round."""
    keyframes = kf.prepare(times, quaternions, closed=closed)
    return replace(keyframes, times=keyframes.knots)


def _compared(
    keyframes: Keyframes, named: Sequence[str] | None
) -> tuple[pd.DataFrame, dict[str, Curve]]:
    """The table, and the curves that were measured."""
    import pandas as pd

    if keyframes.track_shape:
        raise ValueError(f"quaternions has {keyframes.track_shape} tracks: compare takes one")
    names = list(dict.fromkeys(schemes() if named is None else (scheme(n).name for n in named)))
    if not names:
        raise ValueError("schemes is empty: name at least one")
    rows: list[Row] = []
    curves: dict[str, Curve] = {}
    for name in Run(quick=True).progress(names, label="compare"):
        reason = left_out(name, keyframes.count) if named is None else None
        measure = partial(_measured, name, keyframes, curves)
        row = attempted(measure)[0] if reason is None else {"failure": reason}
        rows.append({"scheme": name} | row)
    table = pd.DataFrame(rows).reindex(columns=COLUMNS)
    for name, seconds in _timed(keyframes, curves).items():
        table.loc[table["scheme"] == name, list(seconds)] = list(seconds.values())
    for name in ENERGIES:
        table[f"{name}_over_least"] = _over_least(table[name])
    table = table.sort_values(["torque", "scheme"], na_position="last", ignore_index=True)
    return table, curves


def _over_least(values: pd.Series) -> pd.Series:
    """Multiples of the least, infinite ones of any; where that is 0, 1 for it and infinity for all else."""
    least = values.min()
    if np.isinf(least):
        return values
    if least > 0.0:
        return values / least
    return values.map({least: 1.0}).where(values.eq(least) | values.isna(), np.inf)


COLUMNS = [
    *("scheme", "continuity", "misses"),
    *(f"{name}_over_least" for name in ENERGIES),
    *("key_speed", "peak_speed", *ENERGIES, "length"),
    *(
        "support",
        "iterations",
        "rates",
        "version",
        "seconds_set_up",
        "seconds_per_sample",
        "failure",
    ),
]


def _built(name: str, keyframes: Keyframes) -> Curve:
    cls = scheme(name)
    given = {"tolerance": TOLERANCE} if "tolerance" in declared(cls._fit) else {}
    return cls.from_keyframes(keyframes, **given)


def _measured(name: str, keyframes: Keyframes, curves: dict[str, Curve]) -> list[Row]:
    """The row of one scheme; its curve is kept for timings and figures."""
    curve = _built(name, keyframes)
    smooth = measured_continuity(jumps(curve))
    fair = _above_rounding(curve, fairness(curve))
    if smooth < 1:  # a jump of the velocity is an infinite torque, which no quadrature sees
        fair |= dict.fromkeys(ENERGIES, np.inf)
    pace, report = speeds(curve), curve.solve_report
    row = {
        "continuity": smooth,
        "misses": _misses(curve),
        **fair,
        "key_speed": pace["least_key_speed"],
        "peak_speed": pace["peak_speed"],
        "support": "all" if curve.support is None else str(curve.support),
        "iterations": report.iterations if report else None,
        **facts(curve),
    }
    curves[name] = curve  # of what failed, no seconds
    return [row]


def _above_rounding(curve: Curve, fair: Row) -> Row:
    """Energies of which nothing but rounding is left, at rest or at a constant rate, are zero."""
    h = curve.keyframes.spacings
    alpha, slope = (rounding(curve, order) for order in (2, 3))
    floors = (alpha**2 * (h**-3).sum(), slope**2 * (h**-5).sum(), alpha * (h**-2).max())
    zero = [name for name, floor in zip(ENERGIES, floors, strict=True) if fair[name] <= floor]
    return fair | dict.fromkeys(zero, 0.0)


def _misses(curve: Curve) -> float:
    """The largest angle at a keyframe, rad."""
    at = curve.times[: curve.keyframes.count]
    return float(quaternion.distance(curve(at), curve.keyframes.quaternions).max())


def _timed(keyframes: Keyframes, curves: dict[str, Curve]) -> dict[str, dict[str, float]]:
    """Seconds of set-up and of a sample, interleaved; slow calls are timed once.

    Set-up includes a sample every thousand segments: long curves are fitted where they are called.
    """
    first, last = float(keyframes.times[0]), float(keyframes.times[-1])
    t, sparse = np.linspace(first, last, 1000), keyframes.times[:-1:1000].copy()
    calls: dict[tuple[str, str], Callable[[], object]] = {}
    for name, curve in curves.items():
        calls[name, "seconds_set_up"] = partial(_ready, name, keyframes, sparse)
        calls[name, "seconds_per_sample"] = partial(curve, t)
    once = {key: _elapsed(call) for key, call in calls.items()}
    quick = {"\t".join(key): repeated(calls[key]) for key, s in once.items() if s < SLOW}
    for joined, timing in interleaved(quick, ROUNDS, least=LEAST).items():
        name, column = joined.split("\t")
        once[name, column] = timing.median
    scale = {"seconds_set_up": 1.0, "seconds_per_sample": max(t.size, 1)}
    return {
        name: {column: once[name, column] / size for column, size in scale.items()}
        for name in curves
    }


def _ready(name: str, keyframes: Keyframes, t: FloatArray) -> None:
    _built(name, keyframes)(t)


def _elapsed(call: Callable[[], object]) -> float:
    call()
    start = time.perf_counter()
    call()
    return time.perf_counter() - start


# -- the command ---------------------------------------------------------------------------------


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
    import matplotlib as mpl

    from quatspline.report import advice, style
    from quatspline.report.page import own_scene, write_page
    from quatspline.report.page.sections import OWN

    mpl.use("Agg")  # nothing here may open a window

    began = time.perf_counter()
    keyframes = _prepared(motion.times, motion.quaternions, closed)
    results.begin(call, schemes=list(schemes) if schemes is not None else None)
    table, curves = _compared(keyframes, schemes)
    table = results.table("compare", table, title=TITLE, note=NOTE, formats=FORMATS, keys=[])
    found = advice.recommendation(table)
    say(advice.lines(found))  # before a disk runs full
    results.text("recommendation.md", advice.markdown(found))
    names = advice.shown(table)
    with style.house():
        results.figure("compare", advice.bars(table))
        results.figure("rates", advice.rates({name: curves[name] for name in names}, keyframes))
    results.text("compare.caption.txt", BARS)
    results.text("rates.caption.txt", RATES)
    entry = {"title": TITLE, "size": f"{keyframes.count} keyframes", "seed": None}
    results.record("compare", entry | {"seconds": round(time.perf_counter() - began, 3)})
    results.finish()
    scene = own_scene("own", "Your keyframes", keyframes, motion.positions, names)
    page = write_page(results, title=TITLE, scenes=[scene], sections=OWN, findings=found)
    print(page, file=sys.stderr)
    return 0
