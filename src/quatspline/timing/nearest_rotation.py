"""The nearest rotation of a matrix by systems of order three, of order two, and by the SVD: work and cost."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.catalogue import build
from quatspline.engines.compiler import machine
from quatspline.families.nearest_rotation import by_three, by_two
from quatspline.instruments.trials import Row
from quatspline.kernels.jit import compiled
from quatspline.kernels.values import Mat, vec_at
from quatspline.quaternion import FloatArray
from quatspline.timing.interleaved import interleaved, repeated
from quatspline.trajectories.walks import walk

KEYFRAMES, SAMPLES = 9, 8
"""Of a walk, and between two of its keyframes."""

SPREAD = 0.3
"""Of the noise in every entry of a rotation by up to a radian."""

SVD = "svd"


def walked(rng: np.random.Generator, count: int, degrees: float) -> FloatArray:
    """Frames (about count, 3, 3) of splines through walks, between keyframes, seen from the middle of the arc."""
    sets = -(-count // ((KEYFRAMES - 1) * SAMPLES))
    curve: Any = build("moving-frame", None, walk(rng, KEYFRAMES, degrees, sets))
    t, q = curve.keyframes.inside(SAMPLES), quaternion.align(curve.quaternions)
    middle = np.repeat(quaternion.normalise(q[:-1] + q[1:]), SAMPLES, axis=0)
    columns = np.stack([axis(t) for axis in curve.axes], axis=-2)  # (m, K, column, component)
    seen = quaternion.rotate(quaternion.conj(middle)[:, :, None], columns)
    return np.ascontiguousarray(np.swapaxes(seen, -1, -2).reshape(-1, 3, 3))


def noisy(rng: np.random.Generator, count: int) -> FloatArray:
    """Rotations (count, 3, 3) by up to a radian, with noise."""
    v = rng.normal(size=(count, 3))
    v *= 0.5 * rng.random((count, 1)) / np.linalg.norm(v, axis=1, keepdims=True)
    turns = np.swapaxes(quaternion.rotate(quaternion.exp(v)[:, None], np.eye(3)), -1, -2)
    return turns + SPREAD * rng.normal(size=turns.shape)


@compiled
def _all_by_three(b, d, steps):
    for i in range(b.shape[0]):
        x, n = by_three(Mat(vec_at(b[i, 0], 0), vec_at(b[i, 1], 0), vec_at(b[i, 2], 0)))
        d[i, 0], d[i, 1], d[i, 2], steps[i] = x.x, x.y, x.z, n


@compiled
def _all_by_two(b, d, steps):
    for i in range(b.shape[0]):
        x, n = by_two(Mat(vec_at(b[i, 0], 0), vec_at(b[i, 1], 0), vec_at(b[i, 2], 0)))
        d[i, 0], d[i, 1], d[i, 2], steps[i] = x.x, x.y, x.z, n


SYSTEMS = {"order three": _all_by_three, "order two": _all_by_two}


def by_svd(b: FloatArray) -> FloatArray:
    """The nearest rotations (m, 3, 3) of matrices, by numpy's singular values."""
    u, _, v = np.linalg.svd(b)
    u[..., 2] *= np.sign(np.linalg.det(u @ v))[:, None]
    return np.asarray(u @ v)


def measured(b: FloatArray, rounds: int, seed: int, least: float) -> list[Row]:
    """One row for every method, on matrices (m, 3, 3), timed in turn."""
    columns = np.ascontiguousarray(np.swapaxes(b, -1, -2))
    d, steps = np.empty((len(b), 3)), np.zeros(len(b), np.int64)
    rows, calls = [], {}
    for name, system in SYSTEMS.items():
        call: Callable[[], Any] = partial(machine(system), columns, d, steps)
        call()
        q = quaternion.normalise(np.concatenate([np.ones((len(d), 1)), d], axis=1))
        turns = np.swapaxes(quaternion.rotate(q[:, None], np.eye(3)), -1, -2)
        rows.append(_row(name, b, turns) | _spread(steps))
        calls[name] = repeated(call)
    rows.append(_row(SVD, b, by_svd(b)) | _spread(None))
    calls[SVD] = repeated(partial(by_svd, b))
    timings = interleaved(calls, rounds, seed, least)
    for row in rows:
        each = timings[row["method"]].median / len(b)
        row |= {
            "seconds_median": each,
            "seconds_iqr": timings[row["method"]].iqr / len(b),
            "over_svd": each / (timings[SVD].median / len(b)),
        }
    return rows


def _row(method: str, b: FloatArray, turns: FloatArray) -> Row:
    """error: the angle to the stationary rotation, M^-1 vee(C^T B), M = tr(P) I - P; largest over matrices."""
    p = np.swapaxes(turns, -1, -2) @ b
    skew = np.stack([p[:, 2, 1] - p[:, 1, 2], p[:, 0, 2] - p[:, 2, 0], p[:, 1, 0] - p[:, 0, 1]], -1)
    m = np.trace(p, axis1=1, axis2=2)[:, None, None] * np.eye(3) - 0.5 * (p + np.swapaxes(p, 1, 2))
    error = np.linalg.norm(np.linalg.solve(m, skew[..., None])[..., 0], axis=1)
    return {"method": method, "matrices": len(b), "error": float(error.max())}


def _spread(steps: Any) -> Row:
    """Systems that were solved, where any were."""
    if steps is None:
        return {"systems_median": None, "systems_q95": None, "systems_most": None}
    median, q95, most = np.quantile(steps, [0.5, 0.95, 1.0])
    return {"systems_median": float(median), "systems_q95": float(q95), "systems_most": int(most)}
