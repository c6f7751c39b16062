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
    "inner_angle": Column("largest angle to the truth, inner window", ANGLE, "less"),
    "angle": Column("largest angle to the truth", ANGLE, "less"),
    "inner_omega": Column("largest error of the angular velocity, inner window", RATE, "less"),
    "inner_alpha": Column("largest error of the angular acceleration, inner window", RATE2, "less"),
    "slope": Column("order of convergence from the level before", "", "more"),
    "regression": Column("order of convergence over the last levels", "", "more"),
    "jump": Column("largest jump at an inner keyframe", "", "less"),
    "relative": Column("largest jump as a share of the quantity's size", "", "less"),
    "measured_k": Column("measured k of C^k", "", "more"),
    "claimed_k": Column("claimed k of C^k"),
    "least_key_speed": Column("least speed at an inner keyframe over the mean speed", "", "more"),
    "peak_speed": Column("peak speed over the mean speed", "", "less"),
    "seconds_median": Column("median time", "s", "less"),
    "seconds_iqr": Column("interquartile range of the times", "s", "less"),
    "ratio_to_quartic": Column("time over the quartic's", "", "less"),
    "iterations": Column("updates until the stop rule is met", "", "less"),
    "deviation": Column("largest angle to what the change should give", ANGLE, "less"),
    "invariance.relative": Column("deviation over the step angle", "", "less"),
    "edge-cases.relative": Column("deviation over the largest step", "", "less"),
    "offset": Column("segments from the changed keyframe"),
    "response": Column("movement of a segment over that of the keyframe", "", "less"),
    "amplification": Column("largest response to the change of a keyframe", "", "less"),
    "support": Column("segments that a keyframe shapes", "", "less"),
    "lookahead": Column("keyframes after a segment that shape it", "", "less"),
    "decay": Column("factor of the response a segment farther", "", "less"),
    "gain": Column("movement of the orientation over the errors", "", "less"),
    "gain_omega": Column("movement of the velocity times spacing over the errors", "", "less"),
    "gain_alpha": Column(
        "movement of the acceleration times spacing squared over the errors", "", "less"
    ),
    "spacing_1deg": Column("spacing from which on the error stays below 1 degree", "t", "more"),
    "spacing_0.1deg": Column("spacing from which on it stays below 0.1 degrees", "t", "more"),
    "spacing_0.01deg": Column("spacing from which on it stays below 0.01 degrees", "t", "more"),
    "unevenness": Column("largest possible ratio of two knot spacings"),
    "share_converged": Column("share of the sets that converge", "", "more"),
    "share_jumping": Column("share of the sets whose acceleration jumps", "", "less"),
    "jump_worst": Column("worst acceleration jump over the peak", "", "less"),
    "jump_median": Column("median acceleration jump over the peak", "", "less"),
    "rate": Column("factor of the change by a late iteration", "", "less"),
    "rate_theory": Column("spectral radius of the flat equations", "", "less"),
    "iterations_median": Column("median iterations", "", "less"),
    "iterations_q95": Column("95 % quantile of iterations", "", "less"),
    "iterations_most": Column("most iterations", "", "less"),
    "size": Column("keyframes, or samples evaluated"),
    "times_fastest": Column("time over the fastest scheme's", "", "less"),
    "times_memory": Column("peak memory over the data's", "", "less"),
    "exps": Column("exponentials for one keyframe or sample", "", "less"),
    "logs": Column("logarithms for one keyframe or sample", "", "less"),
    "slerps": Column("slerps for one keyframe or sample", "", "less"),
    **{
        f"{table}{operation}{part}": Column(f"{operation} executed {what}", "", "less")
        for operation in ("exps", "logs", "slerps")
        for table, part, what in (
            ("table1.", "", "for all frames"),
            ("", "_updates", "in updates and in the frames' samples"),
            ("", "_rest", "in set-up and in the final residual"),
        )
    },
    "fairness.least": Column("least torque energy over the minimum", "", "less"),
    "fairness.median": Column("median of torque energy over the minimum", "", "less"),
    "fairness.q95": Column("95 % quantile of torque energy over the minimum", "", "less"),
    "fairness.worst": Column("worst torque energy over the minimum", "", "less"),
    "worst_finite": Column("the same of sets where it is finite", "", "less"),
    "jumping": Column("sets on which the velocity jumps or the curve leaps", "", "less"),
    "fairness.jerk_median": Column("median of jerk energy over that of the minimum", "", "less"),
    "fairness.length_median": Column("median of arc length over that of the minimum", "", "less"),
    "fairness.peak_median": Column(
        "median of peak acceleration over that of the minimum", "", "less"
    ),
    **{
        f"{share}_{level}": Column(f"{word} of {what}, over the step", "", "less")
        for share, what in (
            ("off", "the distance to the arc between keyframes"),
            ("over", "the way beyond the ends of a step"),
            ("back", "the way back within a step"),
        )
        for level, word in (("median", "median"), ("q95", "95 % quantile"), ("worst", "worst"))
    },
    "overshot": Column("share of steps overshot by more than 1 %", "", "less"),
    "over_degrees": Column("worst way beyond the ends of a step", "degrees", "less"),
    "wander_median": Column("median angle from the keyframe during a hold", "degrees", "less"),
    "wander_worst": Column("largest angle from the keyframe during a hold", "degrees", "less"),
    "compare.excursion": Column("largest angle off the arcs between keyframes", "degrees", "less"),
    "hold_rotation": Column("largest angle from the keyframe during a hold", "degrees", "less"),
    "peak_rate": Column("largest angular velocity", "degrees/t", "less"),
    "peak_acceleration": Column("largest angular acceleration", "degrees/t²", "less"),
    "compare.curvature": Column("curvature energy of the path", "1/rad", "less"),
    "compare.support": Column("keyframes that shape a segment"),
    "compare.lookahead": Column("keyframes after a segment's own two that shape it"),
    "compare.noise": Column("noise told from the keyframes, about each axis", "degrees"),
    "curvature_median": Column(
        "median of curvature energy over the least of no longer paths", "", "less"
    ),
    "curvature_sets": Column("sets that the median of curvature energy rests on"),
    "curvature_infinite": Column("sets on which the curvature energy is infinite", "", "less"),
    "curvature_reason": Column("why it is infinite there"),
    "sphere_degrees": Column("angle between the keyframes on the sphere", "degrees"),
    "terms": Column("terms of the polynomial"),
    "steps": Column("steps of the recurrence an arc"),
    "slerp-variants.error": Column("largest angle from slerp", ANGLE, "less"),
    "sphere_error_degrees": Column("largest angle from slerp on the sphere", "degrees", "less"),
    "growth": Column("power of the steps that the drift grows with", "", "less"),
    "closed_form": Column("largest angle from slerp by a formula", ANGLE),
    "choosing.order": Column("order of convergence, uniform times", "", "more"),
    "choosing.support": Column("keyframes that shape a segment"),
    "smooth_k": Column("k of C^k at steps of 60 degrees", "", "more"),
    "smooth_k_worst": Column("least k of C^k measured", "", "more"),
    "edge_cases_exact": Column("edge cases that come out exact", "", "more"),
    "choosing.torque": Column("median of torque energy over the minimum", "", "less"),
    "torque_worst": Column("worst torque energy over the minimum", "", "less"),
    "operations_sample": Column("exponentials and logarithms per sample", "", "less"),
    "operations_keyframe": Column("exponentials and logarithms per keyframe", "", "less"),
    "nanoseconds_per_sample": Column("time of a sample", "ns", "less"),
    "microseconds_per_keyframe": Column("time of set-up per keyframe", "us", "less"),
    "times_fastest_sample": Column("time of a sample over the fastest scheme's", "", "less"),
    "times_fastest_keyframe": Column("time of set-up over the fastest scheme's", "", "less"),
    "pareto": Column("on the front of torque, order and operations"),
    "times_pareto": Column("on the front of torque, order and timings"),
    "over_slerp": Column("geometric mean over joints, over slerp's", "", "less"),
    "most_over_slerp": Column("the joint farthest above slerp, over slerp's", "", "less"),
    "every": Column("every so many-th frame kept"),
    "rms_degrees": Column("median of the joints' rms angles at frames left out", "degrees", "less"),
    "worst_degrees": Column("largest of the joints' rms angles", "degrees", "less"),
    "largest_degrees": Column("largest angle at a frame left out", "degrees", "less"),
    "end_cm": Column("rms distance of end effectors", "cm", "less"),
    "end_largest_cm": Column("largest distance of an end effector", "cm", "less"),
    **{
        f"reconstruct.{name}": Column(f"rms error of {what} over the truth's rms", "", "less")
        for name, what in (("omega", "angular velocity"), ("alpha", "angular acceleration"))
    },
    "error_degrees": Column("allowed error", "degrees"),
    "share": Column("keyframes over frames", "", "less"),
    "per_second": Column("keyframes of a joint", "1/s", "less"),
    "rms": Column("rms angle of the joint at frames left out", ANGLE, "less"),
    "rms_median": Column("median of the joints' rms angles at frames left out", ANGLE, "less"),
    "rms_worst": Column("largest of the joints' rms angles", ANGLE, "less"),
    "largest": Column("largest angle at a frame left out", ANGLE, "less"),
    "end_rms": Column("rms distance of end effectors", "unit of the file", "less"),
    "left_out_rms": Column("rms angle at frames left out", ANGLE, "less"),
    "left_out_largest": Column("largest angle at a frame left out", ANGLE, "less"),
    "passes_keys": Column("whether the curve passes through its keyframes"),
    "worst_failure": Column("the worst that was seen"),
    "claimed": Column("what is claimed"),
    "measured": Column("what was measured in the case"),
    "verdict": Column("holds, departs, not measurable, or not decided at this size"),
    "fault": Column("whose a departure is: the scheme's or the publication's"),
    "claims.case": Column("a line of Python that prints what was measured"),
    "frame-error.angle": Column("largest error", "rad", "less"),
    "frame-error.order": Column("order from the level before", "", "more"),
    "frame-error.constant": Column("error over h^(k+1)", "", "less"),
    "frame-error.expected": Column("the same of flat splines, away from ends"),
    "axis_constant": Column(
        "error of the axes over h^(k+1) and their derivative k + 1", "", "less"
    ),
    "axis_bound": Column("the same of the worst function on uniform knots"),
    "nearest-rotation.error": Column("largest angle to the stationary rotation", "rad", "less"),
    "systems_median": Column("median of linear systems solved for a matrix", "", "less"),
    "systems_q95": Column("95 % quantile of linear systems solved for a matrix", "", "less"),
    "systems_most": Column("most linear systems solved for a matrix", "", "less"),
    "over_svd": Column("time over that of a singular value decomposition", "", "less"),
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
