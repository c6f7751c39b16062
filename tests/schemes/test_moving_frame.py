"""Moving frames: the nearest rotation against the polar factor, ends, joins, large steps."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import Rotation

import quatspline as qs
from golden import GOLDEN, KNOTS, Q
from quatspline import quaternion
from quatspline.kernels.values import Mat, Vec
from quatspline.quaternion import FloatArray
from smoothness import assert_joined, assert_own_rates, motion
from walks import apart, apart_up_to_sign, inside, uneven, walk

T = KNOTS["nonuniform"]
ENDS = ["natural", "not-a-knot", "complete"]
UNIQUE = 1e-3
"""sigma_2 + sign(det) sigma_3 above which the nearest rotation is one, and known to rounding."""


def nearest(b: FloatArray) -> FloatArray:
    """The Cayley parameters of the nearest rotation."""
    module = sys.modules[qs.scheme("moving-frame").__module__]
    w, *d = module.nearest(Mat(*(Vec(*column) for column in b.T)))
    return np.array(d) / w


def polar(b: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The nearest rotations (m, 3, 3) by singular values, and how much they are nearest alone."""
    u, s, v = np.linalg.svd(b)
    sign = np.sign(np.linalg.det(u @ v))
    u[..., 2] *= sign[..., None]
    return u @ v, s[..., 1] + sign * s[..., 2]


def matrices(q: FloatArray) -> FloatArray:
    return Rotation.from_quat(q, scalar_first=True).as_matrix()


def test_nearest_rotation_golden() -> None:
    golden = GOLDEN["nearest_rotation"]
    b = np.array(golden["B"], float).reshape(3, 3)
    d = nearest(b)
    np.testing.assert_allclose(d, np.array(golden["d"], float), atol=1e-14)
    c = matrices(quaternion.normalise(np.array([1.0, *d])))
    np.testing.assert_allclose(c, np.array(golden["C"], float).reshape(3, 3), atol=1e-14)


def test_published_value() -> None:
    """The table of the specification, twelve digits (golden.json holds no numbers for it)."""
    wanted = [0.879843385930, 0.457086057195, 0.028163318769, -0.127101455655]
    assert apart(qs.build("moving-frame", T, Q)(1.2), wanted) < 1e-11


@pytest.mark.parametrize("spread", [0.1, 0.3, 0.6])
def test_nearest_rotation_is_the_polar_factor(spread: float) -> None:
    """Rotations up to a quarter turn from the identity, with noise; any scale of the matrix."""
    rng = np.random.default_rng(2)
    for _ in range(200):
        turn = rng.normal(size=3)
        turn *= rng.uniform(0.0, np.pi / 2) / np.linalg.norm(turn)
        b = Rotation.from_rotvec(turn).as_matrix() + spread * rng.normal(size=(3, 3))
        b *= 10.0 ** rng.uniform(-1.0, 1.0)
        c, alone = polar(b)
        if alone < 0.05 * np.linalg.norm(b):
            continue
        q = quaternion.normalise(np.array([1.0, *nearest(b)]))
        assert np.abs(matrices(q) - c).max() < 1e-11


@pytest.mark.parametrize(
    "b",
    [np.zeros((3, 3)), np.diag([1.0, -1.0, -1.0]), np.diag([1.0, 1.0, -1.0]), -np.eye(3)],
    ids=["zero", "half turn", "mirror", "inversion"],
)
def test_nearest_rotation_is_defined_where_it_is_not_unique(b: FloatArray) -> None:
    assert np.isfinite(nearest(b)).all()


@pytest.mark.parametrize("degree", [3, 5])
@pytest.mark.parametrize("degrees", [20.0, 90.0, 150.0, 179.0])
def test_curve_is_the_polar_factor_of_the_spline(degree: int, degrees: float) -> None:
    for seed in range(3):
        knots, q = uneven(9), walk(9, degrees, seed)
        curve = qs.build("moving-frame", knots, q, degree=degree)
        flat = [(m, np.zeros((3, 3))) for m in range((degree + 1) // 2, degree)]
        spline = make_interp_spline(knots, matrices(q), degree, bc_type=(flat, flat))
        t = inside(knots, 25)
        c, alone = polar(spline(t))
        off = Rotation.from_matrix(c).inv() * curve.rotation(t)
        assert off.magnitude()[alone > UNIQUE].max() < 1e-10
        assert np.isfinite(curve(t, 1)).all()
        assert np.isfinite(curve(t, 2)).all()


@pytest.mark.parametrize("degree", [3, 5])
@pytest.mark.parametrize("kind", ["open", "closed +", "closed -"])
def test_rates_and_joins(degree: int, kind: str) -> None:
    knots, q, given = motion(kind, 9, 50.0)
    curve = qs.build("moving-frame", knots, q, degree=degree, **given)
    assert (curve.continuity, curve.order) == (degree - 1, degree + 1)
    assert_own_rates(curve, inside(knots, 6), (1e-7, 1e-6))
    assert_joined(curve, seam=1e-12)


def test_cubic_ends() -> None:
    """natural: B'' = 0; not-a-knot: one cubic on the first two segments; complete: its own."""
    knots, q = uneven(9), walk(9, 50.0)
    natural, knotless, complete = (qs.build("moving-frame", knots, q, ends=e) for e in ENDS)
    _, _, g0, g1 = natural.segments[0, 0, 4:].reshape(4, 3, 3)
    assert np.abs(2.0 * (g1 - g0)).max() < 1e-12
    cubic = -knotless.segments[0, :, 4:].reshape(8, 4, 3, 3)[:, 3]
    seen = [
        quaternion.rotate(knotless.segments[0, i, :4], cubic[i]) / np.diff(knots)[i] ** 3
        for i in (0, 1)
    ]
    assert np.abs(seen[0] - seen[1]).max() < 1e-9
    t = inside(knots, 4)
    assert apart(natural(t), complete(t)) > 1e-3


@pytest.mark.parametrize(("degree", "order"), [(3, 4), (5, 6)])
def test_complete_ends_keep_the_order(degree: int, order: int) -> None:
    """On smooth motion, ends included."""

    def motion(t: FloatArray) -> FloatArray:
        a = np.stack([0.8 * np.sin(1.1 * t), 0.6 * np.cos(0.7 * t + 0.3), 0.5 * np.sin(1.7 * t)], 1)
        return quaternion.exp(a)

    errors = []
    for count in (81, 161):
        knots = np.linspace(0.0, 10.0, count)
        curve = qs.build("moving-frame", knots, motion(knots), degree=degree, ends="complete")
        t = inside(knots, 5)
        errors.append(apart_up_to_sign(curve(t), motion(t)))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.4)


@pytest.mark.parametrize("degree", [3, 5])
@pytest.mark.parametrize("ends", ENDS)
def test_fewest_keyframes(degree: int, ends: str) -> None:
    least = {"natural": (degree + 1) // 2, "not-a-knot": degree + 1, "complete": 2}[ends]
    q = walk(least, 50.0)
    curve = qs.build("moving-frame", None, q, degree=degree, ends=ends)
    assert apart(curve(curve.times), curve.quaternions) < 1e-12
    if least > 2:
        message = rf"^quaternions has {least - 1} keyframes: degree={degree} with ends='{ends}'"
        with pytest.raises(ValueError, match=message):
            qs.build("moving-frame", None, q[:-1], degree=degree, ends=ends)


def test_two_closed_keyframes() -> None:
    curve = qs.build("moving-frame", None, walk(2, 80.0), closed=True, degree=5)
    assert apart(curve(curve.times[:-1]), curve.quaternions) < 1e-12


@pytest.mark.parametrize("ends", ENDS)
def test_tracks(ends: str) -> None:
    knots = uneven(7)
    q = np.stack([walk(7, 40.0, seed) for seed in range(6)], axis=1).reshape(7, 2, 3, 4)
    curve = qs.build("moving-frame", knots, q, ends=ends)
    t = inside(knots, 3)
    single = qs.build("moving-frame", knots, q[:, 1, 2], ends=ends)
    for order in range(3):
        assert apart(curve(t, order)[:, 1, 2], single(t, order)) < 1e-11


def test_a_frame_carries_no_sign() -> None:
    """align=False: a step the long way round is taken the short way all the same."""
    q = walk(6, 40.0)
    flipped = q * np.array([1.0, 1.0, 1.0, -1.0, -1.0, -1.0])[:, None]
    t = np.linspace(0.0, 5.0, 31)
    long, short = (qs.build("moving-frame", None, x, align=False) for x in (flipped, q))
    assert apart(long(t), short(t)) < 1e-14
