"""Counts by running kernels on numbers that count, against counts by hand."""

from __future__ import annotations

import importlib
import math

import numpy as np
import pytest

import quatspline as qs
from quatspline import counted
from quatspline.catalogue import scheme
from quatspline.engines import counting
from quatspline.engines.counting import KINDS, Copies, Number, Tally, number
from quatspline.kernels.jit import RESULT
from quatspline.kernels.values import Quat, Vec

# Multiplications and additions by hand, from the formulas.
NEAR = np.array([1 + 2 * 7 + 3, 2 * 7 + 2])
"""`sincos_near`: r r, two polynomials of degree 7 in it, s z r + r and c z + 1."""
SMALL = np.array([1 + 2 * 4 + 3, 2 * 4 + 2])
"""`sincos_small`: the same of degree 4."""
ANY = NEAR + np.array([1 + 2 + 1 + 2 + 2, 2 + 2 + 3 + 1])
"""`sincos`: k, the angle less k pi in two parts, k / 2, whether k is odd, two signs."""
BLEND, DOT, PRODUCT = np.array([8, 4]), np.array([4, 3]), np.array([16, 12])
"""a p + b q, the inner product and Hamilton's product of quaternions."""
TURN, ANGLE = np.array([3, 0]), np.array([1, 0])
"""A sine times an axis, and u times an angle."""
QUINTIC = np.array([3 + 1 + 1 + 1, 3 + 1 + 1 + 1])
"""(u - u^2) g(u) + (r u + f_0), g of degree 3."""
ARCTAN = np.array([1 + 1 + 11 + 1, 10 + 1 + 1])
"""The test for a wide angle, t^2, a polynomial of degree 11 without its constant, t + t p, and the angle's offset."""
ARC = 2 * DOT + ARCTAN + np.array([1 + 2 + 1, 3 * 4 + 1 + 1])
"""|p - q|^2, |p + q|, four times an arc tangent of their ratio, sine and cosine."""


def sampled(name: str) -> tuple[list[float], float, float]:
    operations = scheme(name).operations
    kinds = operations.kinds
    both = [kinds["multiplications"].sample, kinds["additions"].sample]
    divisions = kinds["divisions"].sample if "divisions" in kinds else 0
    return both, operations.roots.sample, divisions


def test_slerp_by_hand() -> None:
    assert sampled("slerp") == ([*(ANGLE + NEAR + BLEND)], 0, 0)
    operations = scheme("slerp").operations
    assert (operations.slerps, operations.logs) == (qs.Per(sample=1), qs.Per(keyframe=1))
    assert operations.exps == qs.Per()


def test_the_quartic_by_hand() -> None:
    """Three angles, the outer ones small; the first factor blends, two axes are multiplied on."""
    hand = 3 * QUINTIC + 2 * SMALL + NEAR + BLEND + 2 * (PRODUCT + TURN)
    assert sampled("quartic") == ([*hand], 0, 0)
    operations = scheme("quartic").operations
    assert (operations.exps, operations.logs) == (qs.Per(sample=3), qs.Per(keyframe=1))
    assert operations.slerps == qs.Per()


def test_squad_by_hand() -> None:
    """Two arcs, the parameter, the slerp between their points, the length restored to first order."""
    points, slerp = 2 * (ANGLE + ANY + BLEND), ARC + ANGLE + ANY + BLEND + np.array([1, 1])
    parameter, restored = np.array([2, 1]), 2 * DOT + np.array([1 + 4, 1 + 1])
    assert sampled("squad") == ([*(points + parameter + slerp + restored)], 2, 2)
    operations = scheme("squad").operations
    # the step, two arcs, and a chart of two neighbours, whose logarithms are each asked for twice
    assert operations.logs == qs.Per(keyframe=1 + 2 + 2 * 2)
    assert operations.exps == qs.Per(keyframe=2)
    assert operations.slerps == qs.Per(sample=3)


def test_updates_are_counted_apart() -> None:
    """Of Nielson's iteration, 2 slerps and by its residual 3 more; each residual is looked at before, too."""
    assert scheme("nielson").operations.slerps == qs.Per(sample=6, keyframe=3 + 3 + 2, iteration=5)
    q = counted.typical(6)
    by_change = scheme("nielson")(None, q, stop="change").operations
    assert by_change.slerps == qs.Per(sample=6, keyframe=3 + 2, iteration=2)


def test_the_cumulative_spline_by_hand() -> None:
    """Newton's: of every knot three jets an update; before and after, its own again and four factors a segment."""
    operations = scheme("kim").operations
    assert operations.exps == qs.Per(sample=3, keyframe=3 + 4, iteration=3)
    assert operations.logs == qs.Per(keyframe=3, iteration=1)


def test_options_of_a_curve_are_counted() -> None:
    q = counted.typical(9)
    assert scheme("hermite")(None, q, window=3).operations.logs == qs.Per(keyframe=1 + 2 * 2)
    assert scheme("hermite")(None, q, window=5).operations.logs == qs.Per(keyframe=1 + 4 * 2)


def test_a_set_up_that_no_kernel_does_is_not_counted() -> None:
    operations = scheme("log-cubic").operations
    assert operations.exps.sample == 1
    assert all(math.isnan(per.keyframe) for per in operations.kinds.values())


@pytest.mark.parametrize("name", sorted(KINDS))
def test_primitives_are_there(name: str) -> None:
    module, _, function = name.rpartition(".")
    room = {"values": "kernels", "quick": "kernels", "scalars": "kernels"}
    room |= {"bspline_rows": "fitting", "local_rates": "fitting"}
    made = importlib.import_module(f"quatspline.{room.get(module, 'families')}.{module}")
    assert vars(made)[function].__name__ == function


@pytest.mark.parametrize("name", ["quartic", "squad", "kim", "local-quintic"])
@pytest.mark.parametrize("order", [0, 1, 2])
def test_numbers_that_count_are_the_numbers_that_kernels_make(name: str, order: int) -> None:
    curve = scheme(name)(None, counted.typical(5))
    tally = Tally()
    sheet = counting.sheet_of(curve.segments[0, 1], 0.3, 1.0, tally)
    Copies(tally).of(curve.kernels[order].python)(sheet, counting.TOGETHER)
    found = sheet[RESULT : RESULT + (3 if order else 4), 0].astype(float)
    assert np.abs(found - curve(1.3, order)).max() <= 1e-12
    assert tally["multiplications"] > 0


def test_a_fit_on_numbers_that_count_is_the_fit() -> None:
    curve = scheme("kim")(None, counted.typical(6))
    frames, tally = curve.keyframes, Tally()
    segments = counting.fitted(
        *(curve.fit_kernel, frames.tracks[0], frames.spacings, False, 1.0, curve.parameters),
        *(curve.segments.shape[1:], tally),
    )
    assert np.abs(segments.astype(float) - curve.segments[0]).max() <= 1e-12


def test_numbers() -> None:
    tally = Tally()
    a, b = number(3.0, tally), number(4.0, tally)
    value = 2.0 * a + b * b - 1 / a
    assert value == 6.0 + 16.0 - 1.0 / 3.0
    assert isinstance(value, Number)
    # one addition takes up one product, the other product stays a multiplication
    assert tally == {"multiplications": 2, "additions": 2, "divisions": 1, "fused": 1}
    tally.clear()
    assert (a * Quat(1.0, 2.0, 3.0, 4.0)) == Quat(3.0, 6.0, 9.0, 12.0)
    assert Vec(a, a, a) @ Vec(b, b, b) == 36.0
    assert tally == {"multiplications": 4 + 3, "additions": 2, "fused": 2}
    assert (-a, abs(-a), a < b, max(a, 5.0)) == (-3.0, 3.0, True, 5.0)
    assert counted.packed(tally) == 7 + 2 - 2


def test_originals_are_left_alone() -> None:
    from quatspline.kernels import values

    before = values.log, values.math
    assert scheme("slerp").operations.logs.keyframe == 1
    assert (values.log, values.math) == before
    assert type(values.log(Quat(0.6, 0.8, 0.0, 0.0)).x) is float
