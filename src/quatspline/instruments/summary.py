"""What clips say together: ratios to one scheme over the joints on which all compared schemes ran."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
import pandas as pd

ALL = "all clips"
"""The clip whose rows take the joints of all clips together."""

RAN = 0.9
"""A scheme is compared on a clip where it ran on at least this share of the joints: one that fails on many would
take them, the hardest, from all others' comparison."""

LISTS = "by_joint"
"""The column of lists of what was measured of each joint, None where a scheme failed on it."""


def compared(
    table: pd.DataFrame, keys: Sequence[str], reference: str, apart: Collection[str] = ()
) -> pd.DataFrame:
    """The table with ratios in place of the lists of joints, and with rows of all clips together.

    Adds, for a reference "slerp", columns over_slerp and most_over_slerp, the geometric mean and the largest over
    joints of what was measured over that of slerp, and compared_joints, how many those are.

    Parameters
    ----------
    table : a row a measurement, with `LISTS` where it did not fail
    keys : columns that tell rows apart, among them clip and scheme
    reference : the scheme that others are held against
    apart : clips that stand for themselves
    """
    table = table.reindex(columns=list(dict.fromkeys([*table.columns, LISTS, "failure"])))
    logs = _logs(table, list(keys), reference)
    together = logs[~logs["clip"].isin(list(apart))].assign(clip=ALL)
    ratios = pd.concat([_means(logs, keys, reference), _all(together, keys, reference)])
    merged = table.drop(columns=LISTS).merge(ratios, "outer", list(keys), suffixes=("", "_all"))
    merged["failure"] = merged["failure"].combine_first(merged["failure_all"])
    first = [*keys, *_ratios(reference), "compared_joints"]
    return merged[
        [*first, *[name for name in table if name not in (*keys, LISTS, "failure")], "failure"]
    ]


def _logs(table: pd.DataFrame, keys: list[str], reference: str) -> pd.DataFrame:
    """A row per joint that is compared: the keys, the clip's name and the logarithm of its ratio."""
    case = [key for key in keys if key != "scheme"]
    joints = table.loc[table[LISTS].notna(), [*keys, LISTS]]
    joints = joints.assign(joint=joints[LISTS].map(lambda values: list(range(len(values)))))
    joints = joints.explode([LISTS, "joint"], ignore_index=True)
    joints[LISTS] = pd.to_numeric(joints[LISTS])
    fine = np.isfinite(joints[LISTS]) & (joints[LISTS] > 0)
    joints = joints[fine.groupby([joints[key] for key in keys]).transform("mean") >= RAN]
    ran = fine[joints.index].groupby([joints[key] for key in [*case, "joint"]]).transform("all")
    joints = joints[ran]
    by = joints.loc[joints["scheme"] == reference, [*case, "joint", LISTS]]
    joints = joints.merge(by, on=[*case, "joint"], suffixes=("", "_reference"))
    log = np.log(joints[LISTS] / joints[f"{LISTS}_reference"])
    return joints[keys].assign(log=log, source=joints["clip"])


def _means(logs: pd.DataFrame, keys: Sequence[str], reference: str) -> pd.DataFrame:
    groups = logs.groupby(list(keys), as_index=False)
    means = groups.agg(mean=("log", "mean"), most=("log", "max"), compared_joints=("log", "size"))
    means[f"over_{reference}"] = np.exp(means.pop("mean"))
    means[f"most_over_{reference}"] = np.exp(means.pop("most"))
    return means.astype({"compared_joints": "Int64"})


def _ratios(reference: str) -> list[str]:
    return [f"over_{reference}", f"most_over_{reference}"]


def _all(logs: pd.DataFrame, keys: Sequence[str], reference: str) -> pd.DataFrame:
    """Ratios of all clips; a scheme that did not run on each has a failure instead."""
    means = _means(logs, keys, reference)
    clips = logs.groupby(list(keys), as_index=False).agg(clips=("source", "nunique"))
    case = [key for key in keys if key != "scheme"]
    of = clips.groupby(case)["clips"].transform("max")
    few = clips["clips"] < of
    means.loc[few, _ratios(reference)] = np.nan
    told = "on " + clips["clips"].astype(str) + " of " + of.astype(str) + " clips only"
    return means.assign(failure=told.where(few, None))
