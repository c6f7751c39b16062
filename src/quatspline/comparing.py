"""Compare schemes on a user's own keyframes: the table, and the curves behind it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from quatspline import keyframes as kf
from quatspline.admission import no_unit
from quatspline.catalogue import scheme, schemes
from quatspline.curve import Curve
from quatspline.engines.engine import always_compiled
from quatspline.fitting.told_noise import told_noise
from quatspline.instruments.own_keyframes import ENERGIES, measured, steps
from quatspline.instruments.rescue import solved
from quatspline.instruments.trials import Row, attempted
from quatspline.keyframes import Keyframes
from quatspline.options import among, declared_by, nearest
from quatspline.runs import rehearsal
from quatspline.runs.experiment import Run
from quatspline.solving import ConvergenceError
from quatspline.timing.own_keyframes import left_out, seconds_of

if TYPE_CHECKING:
    import pandas as pd

TOLERANCE = 1e-9
"""Of iterative schemes, in rad."""

MET = 1e-6
"""Largest angle at a keyframe, in rad, that counts as passing through it."""

DEGREES = ("excursion", "hold_rotation", "peak_rate", "peak_acceleration")
TITLE = "Comparison on your keyframes"
NOTE = (
    "continuity is k of C^k as measured on these keyframes; misses the largest angle at a keyframe (rad); torque the "
    "integral of |alpha|^2, jerk that of |alpha'|^2, peak the largest |alpha|, infinite where the velocity jumps, each "
    "also over the least of curves that pass through the keyframes; excursion the largest angle off the arcs between "
    "keyframes, hold_rotation that from the keyframe during a hold (degrees); peak_rate and peak_acceleration the "
    "largest |omega| and |alpha| in degrees; lookahead how many keyframes after a segment's own two shape it; "
    "curvature the energy of the path's bending (1/rad), of closed forms alone; noise what the keyframes are told to "
    "have (degrees about each axis; 0: none); key_speed the least at an inner keyframe, peak_speed the largest, over "
    "the mean; length what the curve turns, keyframes_length the sum of the steps between keyframes (rad). Iterative "
    "schemes solve to 1e-9 by solver; note says where the published iteration failed and another found the curve. "
    "Every segment is measured, however many there are; failure says why a scheme was not. Compare seconds within "
    "this table only."
)
FORMATS = {
    "misses": ".1e",
    **{f"{name}_over_least": ".4f" for name in ENERGIES},
    **dict.fromkeys(DEGREES, ".3g"),
    "seconds_set_up": ".2e",
    "seconds_per_sample": ".2e",
}


def compare(
    times: ArrayLike | None,
    quaternions: Any,
    schemes: Sequence[str] | None = None,
    *,
    closed: bool = False,
    **options: Any,
) -> pd.DataFrame:
    """Measure schemes on keyframes: one row per scheme; one that does not apply or fails has the reason.

    Parameters
    ----------
    times, quaternions, closed : a single track, as `quatspline.build` takes it
    schemes : names; by default all, except library schemes that would take too long on so many
        keyframes, which are left out with a reason and are the same in every run
    **options : options of schemes; each is passed to the schemes that have it

    Returns
    -------
    DataFrame with the columns scheme, continuity, misses, torque, jerk, peak, length (rad), those
    energies relative to the least of curves that pass through the keyframes, excursion and hold_rotation
    (degrees), peak_rate (degrees/t), peak_acceleration (degrees/t^2), curvature (1/rad), keyframes_length
    (rad) and noise (degrees), the same in every row, key_speed, peak_speed, support, lookahead, solver,
    iterations, rates, version, note, failure and the timings seconds_set_up and seconds_per_sample;
    sorted by torque, failures last.  ``failure`` says why a scheme was not measured, and the measurements in
    its row are then NaN; otherwise ``failure`` is NaN.  ``note`` says if a curve was found by the options of
    `Curve.rescue` because the published iteration failed.

    Raises
    ------
    ValueError
        For bad keyframes, an unknown scheme, an option that no scheme has, or several tracks.

    Examples
    --------
    >>> import quatspline as qs
    >>> keyframes = [[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0, 0.6, 0.8, 0], [0, 0, 1, 0]]
    >>> table = qs.compare(None, keyframes, ["slerp", "quartic"])
    >>> table.set_index("scheme")["continuity"].to_dict()
    {'quartic': 2, 'slerp': 0}
    """
    with always_compiled():
        return compared(prepared(times, quaternions, closed), schemes, options)[0]


def prepared(times: ArrayLike | None, quaternions: ArrayLike, closed: bool) -> Keyframes:
    """Keyframes with times since the first: instruments divide steps that the times of a clock round."""
    keyframes = kf.prepare(times, quaternions, closed=closed)
    return replace(keyframes, times=keyframes.knots)


def compared(
    keyframes: Keyframes,
    named: Sequence[str] | None,
    options: Mapping[str, Any] = MappingProxyType({}),
) -> tuple[pd.DataFrame, dict[str, Curve]]:
    """The table, and the curves that were measured."""
    import pandas as pd

    if keyframes.track_shape:
        raise ValueError(f"quaternions has {keyframes.track_shape} tracks: compare takes one")
    names = list(dict.fromkeys(schemes() if named is None else (scheme(n).name for n in named)))
    if not names:
        raise ValueError("schemes is empty: name at least one")
    check_options(options, names)
    rows: list[Row] = []
    curves: dict[str, Curve] = {}
    asked = named is not None
    failed = rehearsal.failures(_alone, names, keyframes, dict(options), asked)
    for name in Run(quick=True).progress(names, label="compare"):
        reason = failed.get(name) or _left_out(name, keyframes, asked)
        measure = partial(_row, name, keyframes, curves, options)
        row = attempted(measure)[0] if reason is None else {"failure": reason}
        rows.append({"scheme": name} | row)
    table = pd.DataFrame(rows).reindex(columns=COLUMNS)
    table["keyframes_length"] = float(steps(keyframes).sum())
    table["noise"] = float(np.degrees(told_noise(keyframes)))
    for name, seconds in seconds_of(keyframes, curves).items():
        table.loc[table["scheme"] == name, list(seconds)] = list(seconds.values())
    for name in ENERGIES:
        table[f"{name}_over_least"] = _over_least(table[name], table["misses"] <= MET)
    table = table.sort_values(["torque", "scheme"], na_position="last", ignore_index=True)
    return table, curves


def _left_out(name: str, keyframes: Keyframes, asked: bool) -> str | None:
    """Why a scheme that nobody asked for by name is not measured."""
    return None if asked else left_out(name, keyframes.count)


def _alone(name: str, keyframes: Keyframes, options: Mapping[str, Any], asked: bool) -> None:
    """All that is asked of one scheme, whose orientations have to be unit quaternions."""
    if _left_out(name, keyframes, asked) is not None:
        return
    try:
        curve, _ = _solved(name, keyframes, options)
    except ConvergenceError:  # a row in words, soon
        return
    if flaw := no_unit(curve, keyframes.inside([0.0, 0.5, 1.0])):
        raise ValueError(flaw)
    curves: dict[str, Curve] = {}
    _row(name, keyframes, curves, options)
    seconds_of(keyframes, curves)


def _over_least(values: pd.Series, passes: pd.Series) -> pd.Series:
    """Multiples of the least of those that pass; where that is 0, 1 for none and infinity for all else.

    What passes near keyframes only may need less than any curve through them.
    """
    least = values[passes].min() if passes.any() else values.min()
    if np.isinf(least):
        return values
    if least > 0.0:
        return values / least
    return values.map({least: 1.0}).where(values.eq(least) | values.isna(), np.inf)


COLUMNS = [
    *("scheme", "continuity", "misses"),
    *(f"{name}_over_least" for name in ENERGIES),
    *("key_speed", "peak_speed", *ENERGIES, "length", "keyframes_length"),
    *(*DEGREES, "curvature", "noise"),
    *("support", "lookahead", "solver", "iterations", "rates", "version"),
    *("seconds_set_up", "seconds_per_sample", "note", "failure"),
]


def check_options(options: Mapping[str, Any], names: Sequence[str]) -> None:
    """Refuse an option that none of the schemes has."""
    known = {option for name in names for option in declared_by(scheme(name))}
    for option in options:
        if option not in known:
            raise ValueError(
                f"none of the schemes has an option {option!r}: {nearest(option, known)}"
            )


def told(options: Mapping[str, Any]) -> str:
    """A note's sentence on the options of a comparison."""
    listed = ", ".join(f"{name}={value}" for name, value in options.items())
    return f" Options, of the schemes that have them: {listed}." if listed else ""


def _solved(
    name: str, keyframes: Keyframes, options: Mapping[str, Any]
) -> tuple[Curve, str | None]:
    """The curve of one scheme, and how it was found where not as published."""
    cls = scheme(name)
    given = among(cls, {"tolerance": TOLERANCE} | dict(options))
    return solved(cls, keyframes, **given)


def _row(
    name: str, keyframes: Keyframes, curves: dict[str, Curve], options: Mapping[str, Any]
) -> list[Row]:
    """The row of one scheme; its curve is kept for timings and figures."""
    try:
        curve, note = _solved(name, keyframes, options)
    except ConvergenceError as error:  # in words for a table
        return [{"failure": str(error)}]
    curves[name] = curve  # of what failed, no seconds
    return [measured(curve) | {"note": note}]
