"""The least curvature energy of paths through keyframes that are no longer than a given one.

Without a bound on the length there is none: a path that winds round and round its great circles bends
as little as one likes.  The path is a chain of geodesic edges, equally long between two keyframes,

    E = sum_j |t_j - t_{j-1}|^2 / l_j,                                                           (1)

with unit directions t of edges in the body frame, in which a geodesic keeps its direction, and l_j the
mean length of the edges at point j.  Points between keyframes move by Gauss-Newton steps with
Levenberg's damping; the bound on the length has a multiplier.  Chains are halved until energies,
extrapolated from two levels, agree.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.inputs.arrays import BoolArray
from quatspline.quaternion import FloatArray

# notation: u (k, 3) are logarithms of edges, l (k,) lengths, t (k, 3) directions; x (n, 3) moves points,
# q_j exp(x_j); a point's residuals are those of (1) and its edges' difference

PIECES, LEVELS = 8, 5
"""Edges between two keyframes to begin with, and how many numbers of them are tried, each twice the last."""

AGREE = 1e-4
"""Two extrapolated energies agree to this share; they fall by sixteen from level to level."""

NOTHING = 1e-12
"""An energy below this, in units of one over the length, is that of a great circle."""

UPDATES, RESTS, TREND, NONE = 400, 1e-9, 4, 1e-12
"""Updates of a level at most, and the relative gain that is still to come when it ends: gains fall by a share each,
slowly where residuals are large, and a geometric series through the last few tells what is left.  One below the
last constant is rounding."""

DAMPING, STUCK, LEAP = 1e-3, 1e10, 0.1
"""Levenberg's weight at first and at most, and the longest move, as a share of the bound."""

BAND = 9
"""Rows of the lower band: a point's residuals depend on its two neighbours."""


class Least(NamedTuple):
    """The least curvature energy (rad^-1), how far the last two levels are apart, and the length (rad)."""

    energy: float
    change: float
    length: float

    @property
    def settled(self) -> bool:
        """Whether the levels agree."""
        return self.change <= AGREE


def least_curvature(curve: Curve, longest: float) -> Least:
    """The least curvature energy of paths no longer than a bound, found from a curve's path downwards.

    Parameters
    ----------
    curve : an open single-track curve that passes through its keyframes; its path is where the search starts, so that
        the minimum found is the one in its neighbourhood
    longest : length on S^3 in rad that no path may exceed, such as half the integral of |omega|

    Raises
    ------
    ValueError
        For a closed curve, and for several tracks.
    """
    if curve.closed or curve.keyframes.tracks.shape[0] != 1:
        raise ValueError(f"{curve!r}: the least curvature is that of one open curve")
    energies: list[float] = []
    estimates: list[float] = []
    points, pieces = _on(curve), PIECES
    for _ in range(LEVELS):
        free = np.arange(len(points)) % pieces != 0
        points = _descended(points, free, longest)
        edges = _edges(points)
        energies.append(float((_bends(edges) ** 2).sum()))
        if len(energies) > 1:
            estimates.append((4.0 * energies[-1] - energies[-2]) / 3.0)
        if _change(estimates, longest) <= AGREE:
            break
        points, pieces = _halved(points), 2 * pieces
    return Least(estimates[-1], _change(estimates, longest), float(edges.l.sum()))


def _change(estimates: list[float], longest: float) -> float:
    """The last change of an estimate over its size; infinite before there are two."""
    if len(estimates) < 2:
        return np.inf
    return abs(estimates[-1] - estimates[-2]) / max(abs(estimates[-1]), NOTHING / longest)


def _on(curve: Curve) -> FloatArray:
    """Points of the path, on it at equal times."""
    knots = curve.keyframes.knots
    since = np.append(curve.keyframes.inside(np.arange(PIECES) / PIECES), knots[-1])
    points = curve.inner(since)[:, 0]
    points[::PIECES] = curve.quaternions
    return quaternion.align(points)


def _halved(points: FloatArray) -> FloatArray:
    finer = np.empty((2 * len(points) - 1, 4))
    finer[::2] = points
    finer[1::2] = quaternion.slerp(points[:-1], points[1:], 0.5)
    return finer


# -- edges and residuals ------------------------------------------------------------------------


class _Edges(NamedTuple):
    """Logarithms (k, 3), lengths (k,), directions (k, 3), mean lengths at inner points (k - 1,)."""

    u: FloatArray
    l: FloatArray
    t: FloatArray
    mean: FloatArray


def _edges(points: FloatArray) -> _Edges:
    u = quaternion.log(quaternion.mul(quaternion.conj(points[:-1]), points[1:]))
    l = np.linalg.norm(u, axis=1)
    return _Edges(u, l, u / l[:, None], 0.5 * (l[1:] + l[:-1]))


def _bends(edges: _Edges) -> FloatArray:
    """The residuals of (1), (k - 1, 3)."""
    return np.diff(edges.t, axis=0) / np.sqrt(edges.mean)[:, None]


def _residuals(edges: _Edges, inner: FloatArray) -> FloatArray:
    """Those of (1) and, between keyframes, the difference of lengths: (k - 1, 4)."""
    uneven = inner * np.diff(edges.l) / edges.mean**1.5
    return np.concatenate([_bends(edges), uneven[:, None]], axis=1)


class _Moves(NamedTuple):
    """Derivatives of edges by the moves of their two ends: directions (k, 3, 3), lengths (k, 3)."""

    t_begin: FloatArray
    t_end: FloatArray
    l_begin: FloatArray
    l_end: FloatArray


def _moves(edges: _Edges) -> _Moves:
    """u goes by Jr^-1 x at its end and by -Jl^-1 x at its beginning; Jl is Jr transposed."""
    end = quaternion.right_jacobian_inverse(2.0 * edges.u)
    begin = -np.swapaxes(end, 1, 2)
    t = edges.t[:, :, None]
    across = (np.eye(3) - t * edges.t[:, None, :]) / edges.l[:, None, None]
    along = (np.einsum("ki,kij->kj", edges.t, x) for x in (begin, end))
    return _Moves(across @ begin, across @ end, *along)


def _derivatives(edges: _Edges, moves: _Moves, inner: FloatArray) -> list[FloatArray]:
    """Of residuals by the moves of the point before, of the point and of the one after: (k - 1, 4, 3) each."""
    r, root = _bends(edges), 1.0 / np.sqrt(edges.mean)[:, None, None]
    shrink = (-0.5 * r / edges.mean[:, None])[:, :, None]
    weight = (inner / edges.mean**1.5)[:, None]
    ease = (-1.5 * np.diff(edges.l) / edges.mean)[:, None]
    a, b, la, lb = moves
    none = np.zeros_like(la[1:])
    parts = (
        (-a[:-1], -la[:-1], 0.5 * la[:-1]),
        (a[1:] - b[:-1], la[1:] - lb[:-1], 0.5 * (la[1:] + lb[:-1])),
        (b[1:], none + lb[1:], 0.5 * lb[1:]),
    )
    return [
        np.concatenate(
            [t * root + shrink * m[:, None, :], (weight * (d + ease * m))[:, None, :]], axis=1
        )
        for t, d, m in parts
    ]


# -- descent ------------------------------------------------------------------------------------


def _descended(points: FloatArray, free: BoolArray, longest: float) -> FloatArray:
    """Points at the minimum of half the squared residuals under the bound on the length."""
    inner = free[1:-1].astype(float)
    damping, pull, weight = DAMPING, 0.0, 0.0
    cost, length = _cost(points, inner)
    gains: list[float] = []
    for _ in range(UPDATES):
        matrix, slope, lengthening = _equations(points, free, pull)
        gain = None
        while gain is None:
            x, wanted = _step(matrix, slope, lengthening, damping, length - longest)
            weight = max(weight, 1.2 * wanted)
            if np.abs(x).max() <= LEAP * longest:
                moved = quaternion.normalise(quaternion.mul(points, quaternion.exp(x)))
                lower, longer = _cost(moved, inner)
                merit = cost + weight * max(0.0, length - longest)
                new = lower + weight * max(0.0, longer - longest)
                gain = merit - new if new <= merit * (1.0 + 1e-14) else None
            if gain is None:
                damping *= 4.0
                if damping > STUCK:
                    return points
        points, cost, length, pull = moved, lower, longer, wanted
        damping = max(0.25 * damping, 1e-12)
        gains.append(gain)
        if gain <= NONE * merit or _to_come(gains) <= RESTS * merit:
            break
    return points


def _to_come(gains: list[float]) -> float:
    """What updates will gain yet, if each gains as much less than the one before as the last few did at worst."""
    last = np.array(gains[-TREND:])
    if len(last) < TREND or (last[1:] >= last[:-1]).any():
        return np.inf
    share = float((last[1:] / last[:-1]).max())
    return gains[-1] * share / (1.0 - share)


def _cost(points: FloatArray, inner: FloatArray) -> tuple[float, float]:
    edges = _edges(points)
    return 0.5 * float((_residuals(edges, inner) ** 2).sum()), float(edges.l.sum())


def _equations(
    points: FloatArray, free: BoolArray, pull: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Blocks (3, n, 3, 3) of the normal matrix by distance, and slopes (n, 3) of cost and length.

    The multiplier of the length, ``pull``, stiffens edges across their direction.
    """
    edges, inner, n = _edges(points), free[1:-1].astype(float), len(points)
    moves = _moves(edges)
    residuals, parts = _residuals(edges, inner), _derivatives(edges, moves, inner)
    matrix, slope, lengthening = np.zeros((3, n, 3, 3)), np.zeros((n, 3)), np.zeros((n, 3))
    for i, part in enumerate(parts):
        slope[i : i + n - 2] += np.einsum("kij,ki->kj", part, residuals)
        for j in range(i, 3):
            matrix[j - i, i : i + n - 2] += np.swapaxes(part, 1, 2) @ parts[j]
    lengthening[:-1] += moves.l_begin
    lengthening[1:] += moves.l_end
    stiff = (pull * edges.l)[:, None, None] * np.swapaxes(moves.t_begin, 1, 2)
    matrix[0, :-1] += stiff @ moves.t_begin
    matrix[1, :-1] += stiff @ moves.t_end
    matrix[0, 1:] += (pull * edges.l)[:, None, None] * np.swapaxes(moves.t_end, 1, 2) @ moves.t_end
    slope[~free] = lengthening[~free] = 0.0
    _hold(matrix, ~free)
    return matrix, slope, lengthening


def _hold(matrix: FloatArray, held: BoolArray) -> None:
    """Leave points where they are: rows and columns of the identity."""
    matrix[0, held] = np.eye(3)
    for apart in (1, 2):
        matrix[apart, held] = 0.0
        matrix[apart, :-apart][held[apart:]] = 0.0


def _step(
    matrix: FloatArray,
    slope: FloatArray,
    lengthening: FloatArray,
    damping: float,
    excess: float,
) -> tuple[FloatArray, float]:
    """Moves (n, 3) and the multiplier with which they meet the bound to first order, none below it."""
    from scipy.linalg import solveh_banded

    both = np.stack([slope.reshape(-1), lengthening.reshape(-1)], axis=1)
    y, z = solveh_banded(_banded(matrix, damping), both, lower=True, check_finite=False).T
    g = both[:, 1]
    pull = max(0.0, float((excess - g @ y) / (g @ z))) if g @ z > 0.0 else 0.0
    return -(y + pull * z).reshape(-1, 3), pull


def _banded(matrix: FloatArray, damping: float) -> FloatArray:
    """The lower band that LAPACK takes, with Levenberg's damping on the diagonal."""
    n = matrix.shape[1]
    band = np.zeros((BAND, n, 3))
    for apart, column, row in np.ndindex(3, 3, 3):
        below = 3 * apart + row - column
        if below >= 0:
            band[below, :, column] = matrix[apart, :, column, row]
    band[0] *= 1.0 + damping
    return band.reshape(BAND, 3 * n)
