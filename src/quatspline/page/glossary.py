"""What columns mean, in which unit, and which way is better: axis text and sorting notes derive from it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Better = Literal["less", "more", ""]


@dataclass(frozen=True)
class Column:
    """What a column holds."""

    meaning: str
    unit: str = ""
    better: Better = ""


ANGLE, RATE, RATE2 = "rad", "rad/t", "rad/t²"

GLOSSARY: dict[str, Column] = {
    "spacing": Column("keyframe spacing", "t"),
    "keyframes": Column("number of keyframes"),
    "step_degrees": Column("angle between neighbouring keyframes", "degrees"),
    "inner_angle": Column("largest angle from the truth, inner window", ANGLE, "less"),
    "angle": Column("largest angle from the truth", ANGLE, "less"),
    "inner_omega": Column("largest error of the angular velocity, inner window", RATE, "less"),
    "inner_alpha": Column("largest error of the angular acceleration, inner window", RATE2, "less"),
    "slope": Column("order of convergence from the previous level to this one", "", "more"),
    "regression": Column("order of convergence over the last levels", "", "more"),
    "jump": Column("largest jump at an inner keyframe", "", "less"),
    "relative": Column("largest jump as a share of the quantity's size", "", "less"),
    "measured_k": Column("measured k of C^k", "", "more"),
    "claimed_k": Column("claimed k of C^k"),
    "least_key_speed": Column(
        "least speed at an inner keyframe relative to the mean speed", "", "more"
    ),
    "peak_speed": Column("peak speed relative to the mean speed", "", "less"),
    "seconds_median": Column("median time", "s", "less"),
    "seconds_iqr": Column("interquartile range of the times", "s", "less"),
    "ratio_to_quartic": Column("time relative to the quartic's", "", "less"),
    "iterations": Column("number of updates until the stopping rule is met", "", "less"),
    "deviation": Column("largest angle from what the change should give", ANGLE, "less"),
    "invariance.relative": Column("deviation relative to the step angle", "", "less"),
    "edge-cases.relative": Column("deviation relative to the largest step", "", "less"),
    "offset": Column("segments from the changed keyframe"),
    "response": Column("movement of a segment relative to that of the keyframe", "", "less"),
    "amplification": Column("largest response to the change of a keyframe", "", "less"),
    "support": Column("segments that a keyframe shapes", "", "less"),
    "lookahead": Column("keyframes after a segment that shape it", "", "less"),
    "decay": Column("factor of the response from segment to segment", "", "less"),
    "gain": Column("movement of the orientation relative to the errors", "", "less"),
    "gain_omega": Column(
        "movement of the velocity times spacing, relative to the errors", "", "less"
    ),
    "gain_alpha": Column(
        "movement of the acceleration times spacing squared, relative to the errors", "", "less"
    ),
    "spacing_1deg": Column(
        "largest spacing below which the error stays under 1 degree", "t", "more"
    ),
    "spacing_0.1deg": Column(
        "largest spacing below which the error stays under 0.1 degrees", "t", "more"
    ),
    "spacing_0.01deg": Column(
        "largest spacing below which the error stays under 0.01 degrees", "t", "more"
    ),
    "unevenness": Column("largest possible ratio of two knot spacings"),
    "share_converged": Column("share of the sets that converge", "", "more"),
    "share_jumping": Column("share of the sets whose acceleration jumps", "", "less"),
    "jump_worst": Column("worst acceleration jump relative to the peak", "", "less"),
    "jump_median": Column("median acceleration jump relative to the peak", "", "less"),
    "rate": Column("what a late iteration leaves of the change, as a factor", "", "less"),
    "rate_theory": Column("spectral radius of the flat equations", "", "less"),
    "iterations_median": Column("median iterations", "", "less"),
    "iterations_q95": Column("95 % quantile of iterations", "", "less"),
    "iterations_most": Column("most iterations", "", "less"),
    "size": Column("keyframes, or samples evaluated"),
    "times_fastest": Column("time relative to the fastest scheme's", "", "less"),
    "times_memory": Column("peak memory relative to the size of the data", "", "less"),
    "exps": Column("exponentials per keyframe or sample", "", "less"),
    "logs": Column("logarithms per keyframe or sample", "", "less"),
    "slerps": Column("slerps per keyframe or sample", "", "less"),
    **{
        f"{table}{operation}{part}": Column(f"{operation} executed {what}", "", "less")
        for operation in ("exps", "logs", "slerps")
        for table, part, what in (
            ("table1.", "", "for all frames"),
            ("", "_updates", "in updates and in samples of the frames"),
            ("", "_rest", "in set-up and in the final residual"),
        )
    },
    "fairness.least": Column("least torque energy relative to the minimum", "", "less"),
    "fairness.median": Column("median of torque energy relative to the minimum", "", "less"),
    "fairness.q95": Column("95 % quantile of torque energy relative to the minimum", "", "less"),
    "fairness.worst": Column("worst torque energy relative to the minimum", "", "less"),
    "worst_finite": Column(
        "worst torque energy relative to the minimum, of sets where it is finite", "", "less"
    ),
    "jumping": Column("sets on which the velocity jumps or the curve leaps", "", "less"),
    "fairness.jerk_median": Column(
        "median of jerk energy relative to that of the minimum", "", "less"
    ),
    "fairness.length_median": Column(
        "median of arc length relative to that of the minimum", "", "less"
    ),
    "fairness.peak_median": Column(
        "median of peak acceleration relative to that of the minimum", "", "less"
    ),
    **{
        f"{share}_{level}": Column(f"{word} of {what}, as a share of the step", "", "less")
        for share, what in (
            ("off", "the distance from the arc between keyframes"),
            ("over", "the overshoot beyond the ends of a step"),
            ("back", "the retreat within a step"),
        )
        for level, word in (("median", "median"), ("q95", "95 % quantile"), ("worst", "worst"))
    },
    "overshot": Column("share of steps that are overshot by more than 1 %", "", "less"),
    "over_degrees": Column("worst overshoot beyond the ends of a step", "degrees", "less"),
    "wander_median": Column("median angle from the keyframe during a hold", "degrees", "less"),
    "wander_worst": Column("largest angle from the keyframe during a hold", "degrees", "less"),
    "compare.excursion": Column("largest angle from the arcs between keyframes", "degrees", "less"),
    "hold_rotation": Column("largest angle from the keyframe during a hold", "degrees", "less"),
    "peak_rate": Column("largest angular velocity", "degrees/t", "less"),
    "peak_acceleration": Column("largest angular acceleration", "degrees/t²", "less"),
    "compare.curvature": Column("curvature energy of the path", "1/rad", "less"),
    "compare.support": Column("keyframes that shape a segment"),
    "compare.lookahead": Column("keyframes after a segment's own two that shape it"),
    "compare.noise": Column("noise about each axis, estimated from the keyframes", "degrees"),
    "curvature_median": Column(
        "median of curvature energy relative to the least of paths that are no longer", "", "less"
    ),
    "curvature_sets": Column("sets behind the median of curvature energy"),
    "curvature_infinite": Column("sets on which the curvature energy is infinite", "", "less"),
    "curvature_reason": Column("why the curvature energy is infinite there"),
    "sphere_degrees": Column("angle between the keyframes on the sphere", "degrees"),
    "terms": Column("terms of the polynomial"),
    "steps": Column("steps of the recurrence per arc"),
    "slerp-variants.error": Column("largest angle from slerp", ANGLE, "less"),
    "sphere_error_degrees": Column("largest angle from slerp on the sphere", "degrees", "less"),
    "growth": Column("power of the number of steps with which the drift grows", "", "less"),
    "closed_form": Column("largest angle from slerp by a formula", ANGLE),
    "choosing.order": Column("order of convergence, uniform times", "", "more"),
    "choosing.support": Column("keyframes that shape a segment"),
    "smooth_k": Column("k of C^k at steps of 60 degrees", "", "more"),
    "smooth_k_worst": Column("least k of C^k measured", "", "more"),
    "edge_cases_exact": Column("edge cases with an exact result", "", "more"),
    "choosing.torque": Column("median of torque energy relative to the minimum", "", "less"),
    "torque_worst": Column("worst torque energy relative to the minimum", "", "less"),
    "operations_sample": Column("exponentials and logarithms per sample", "", "less"),
    "operations_keyframe": Column("exponentials and logarithms per keyframe", "", "less"),
    "nanoseconds_per_sample": Column("time of a sample", "ns", "less"),
    "microseconds_per_keyframe": Column("time of set-up per keyframe", "us", "less"),
    "times_fastest_sample": Column("time of a sample relative to the fastest scheme's", "", "less"),
    "times_fastest_keyframe": Column("time of set-up relative to the fastest scheme's", "", "less"),
    "pareto": Column("on the Pareto front of torque, order and operations"),
    "times_pareto": Column("on the Pareto front of torque, order and timings"),
    "over_slerp": Column("geometric mean over joints, relative to slerp's", "", "less"),
    "most_over_slerp": Column("the worst joint, relative to slerp's", "", "less"),
    "every": Column("one frame in this many is kept"),
    "rms_degrees": Column("median of the joints' rms angles at frames left out", "degrees", "less"),
    "worst_degrees": Column("largest of the joints' rms angles", "degrees", "less"),
    "largest_degrees": Column("largest angle at a frame left out", "degrees", "less"),
    "end_cm": Column("rms distance of end effectors", "cm", "less"),
    "end_largest_cm": Column("largest distance of an end effector", "cm", "less"),
    **{
        f"reconstruct.{name}": Column(
            f"rms error of {what} relative to the rms of the truth", "", "less"
        )
        for name, what in (("omega", "angular velocity"), ("alpha", "angular acceleration"))
    },
    "error_degrees": Column("allowed error", "degrees"),
    "share": Column("keyframes as a share of frames", "", "less"),
    "per_second": Column("keyframes per joint", "1/s", "less"),
    "rms": Column("rms angle of the joint at frames left out", ANGLE, "less"),
    "rms_median": Column("median of the joints' rms angles at frames left out", ANGLE, "less"),
    "rms_worst": Column("largest of the joints' rms angles", ANGLE, "less"),
    "largest": Column("largest angle at a frame left out", ANGLE, "less"),
    "end_rms": Column("rms distance of end effectors", "unit of the file", "less"),
    "left_out_rms": Column("rms angle at frames left out", ANGLE, "less"),
    "left_out_largest": Column("largest angle at a frame left out", ANGLE, "less"),
    "passes_keys": Column("whether the curve passes through its keyframes"),
    "worst_failure": Column("the worst failure found"),
    "claimed": Column("what is claimed"),
    "measured": Column("what was measured in this case"),
    "verdict": Column("holds, departs, not measurable, or not decided at this size"),
    "fault": Column("whose fault a departure is: the scheme's or the publication's"),
    "claims.case": Column("a line of Python that prints what was measured"),
    "frame-error.angle": Column("largest error", "rad", "less"),
    "frame-error.order": Column("order from the previous level to this one", "", "more"),
    "frame-error.constant": Column("error divided by h^(k+1)", "", "less"),
    "frame-error.expected": Column("the same constant for flat splines, away from ends"),
    "axis_constant": Column(
        "error of the axes divided by h^(k+1) and their derivative k + 1", "", "less"
    ),
    "axis_bound": Column("the same constant for the worst function on uniform knots"),
    "nearest-rotation.error": Column("largest angle from the stationary rotation", "rad", "less"),
    "systems_median": Column("median of linear systems solved per matrix", "", "less"),
    "systems_q95": Column("95 % quantile of linear systems solved per matrix", "", "less"),
    "systems_most": Column("most linear systems solved per matrix", "", "less"),
    "over_svd": Column("time relative to that of a singular value decomposition", "", "less"),
    "iterations.median": Column("median iterations", "", "less"),
    "iterations.q95": Column("95 % quantile of iterations", "", "less"),
    "iterations.most": Column("most iterations", "", "less"),
    "iterations.not_converged": Column("sets that did not converge", "", "less"),
}
"""By column, or by table and column where a table gives a name a meaning of its own."""


def column(table: str, name: str) -> Column:
    """What a column of a table holds; its own name where nothing is written down."""
    plain = Column(name.replace("_", " "))
    return GLOSSARY.get(f"{table}.{name}") or GLOSSARY.get(name) or plain


def label(table: str, name: str) -> str:
    """Text for an axis: meaning and unit."""
    known = column(table, name)
    return f"{known.meaning} ({known.unit})" if known.unit else known.meaning
