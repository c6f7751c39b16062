"""Moving frames: the nearest rotation against the polar factor, ends, joins, large steps."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.interpolate import BSpline, make_interp_spline
from scipy.spatial.transform import Rotation

import quatspline as qs
from golden import GOLDEN, KNOTS, Q, assert_golden_new, new_entries
from quatspline import quaternion
from quatspline.families.nearest_rotation import by_three, by_two
from quatspline.fitting import frame_splines
from quatspline.instruments.frame_error import frame_error
from quatspline.kernels.values import Mat, Vec
from quatspline.quaternion import FloatArray
from smoothness import assert_joined, assert_own_rates, motion
from walks import apart, apart_up_to_sign, inside, uneven, walk

T = KNOTS["nonuniform"]
ENDS = ["natural", "not-a-knot", "complete"]
UNIQUE = 1e-3
"""sigma_2 + sign(det) sigma_3 above which the nearest rotation is one, and known to rounding."""


DEGREES = [3, 5, 7, 9]
ROUNDING = {3: 1e-10, 5: 1e-10, 7: 1e-10, 9: 1e-8}
"""Two solves of one spline: the condition of its equations grows with the degree."""
SYSTEMS = [by_three, by_two]


def nearest(b: FloatArray, solve: Any = by_three) -> FloatArray:
    """The Cayley parameters of the nearest rotation."""
    d, _ = solve(Mat(*(Vec(*column) for column in b.T)))
    return np.array(d)


def polar(b: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The nearest rotations (m, 3, 3) by singular values, and how much they are nearest alone."""
    u, s, v = np.linalg.svd(b)
    sign = np.sign(np.linalg.det(u @ v))
    u[..., 2] *= sign[..., None]
    return u @ v, s[..., 1] + sign * s[..., 2]


def matrices(q: FloatArray) -> FloatArray:
    return Rotation.from_quat(q, scalar_first=True).as_matrix()


@pytest.mark.parametrize("solve", SYSTEMS, ids=lambda solve: solve.__name__)
def test_nearest_rotation_golden(solve: Any) -> None:
    golden = GOLDEN["nearest_rotation"]
    b = np.array(golden["B"], float).reshape(3, 3)
    d = nearest(b, solve)
    np.testing.assert_allclose(d, np.array(golden["d"], float), atol=1e-14)
    c = matrices(quaternion.normalise(np.array([1.0, *d])))
    np.testing.assert_allclose(c, np.array(golden["C"], float).reshape(3, 3), atol=1e-14)


def test_published_value() -> None:
    """The table of the specification, twelve digits (golden.json holds no numbers for it)."""
    wanted = [0.879843385930, 0.457086057195, 0.028163318769, -0.127101455655]
    assert apart(qs.build("moving-frame", T, Q)(1.2), wanted) < 1e-11


@pytest.mark.parametrize("entry", new_entries("moving-frame"))
def test_golden_end_rates(entry: str) -> None:
    """Rates alone ask for complete ends."""
    assert_golden_new("moving-frame", entry, degree=int(entry.split()[2]))


@pytest.mark.parametrize("solve", SYSTEMS, ids=lambda solve: solve.__name__)
@pytest.mark.parametrize("spread", [0.1, 0.3, 0.6])
def test_nearest_rotation_is_the_polar_factor(spread: float, solve: Any) -> None:
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
        q = quaternion.normalise(np.array([1.0, *nearest(b, solve)]))
        assert np.abs(matrices(q) - c).max() < 1e-11


def test_systems_of_order_two_make_the_same_steps() -> None:
    rng = np.random.default_rng(7)
    for b in np.eye(3) + 0.3 * rng.normal(size=(200, 3, 3)):
        columns = Mat(*(Vec(*column) for column in b.T))
        (three, many), (two, few) = by_three(columns), by_two(columns)
        assert abs(many - few) <= 1  # the last step is decided by rounding
        size = 1.0 + np.abs(np.array(three)).max()
        assert np.abs(np.array(three) - np.array(two)).max() < 1e-11 * size**2


def test_few_steps_near_a_rotation() -> None:
    """Between keyframes 60 degrees apart or less the iteration converges quadratically."""
    knots, q = uneven(9), walk(9, 60.0)
    axes = qs.build("moving-frame", knots, q).axes
    middle = quaternion.normalise(q[:-1] + q[1:])
    t = inside(knots, 5)
    b = np.stack([axis(t) for axis in axes], axis=-1)
    local = np.swapaxes(np.repeat(matrices(middle), 5, axis=0), -1, -2) @ b
    steps = [by_three(Mat(*(Vec(*column) for column in m.T)))[1] for m in local]
    assert max(steps) <= 6


@pytest.mark.parametrize(
    "b",
    [np.zeros((3, 3)), np.diag([1.0, -1.0, -1.0]), np.diag([1.0, 1.0, -1.0]), -np.eye(3)],
    ids=["zero", "half turn", "mirror", "inversion"],
)
def test_nearest_rotation_is_defined_where_it_is_not_unique(b: FloatArray) -> None:
    assert all(np.isfinite(nearest(b, solve)).all() for solve in SYSTEMS)


@pytest.mark.parametrize("degree", DEGREES)
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
        assert off.magnitude()[alone > UNIQUE].max() < ROUNDING[degree]
        assert np.isfinite(curve(t, 1)).all()
        assert np.isfinite(curve(t, 2)).all()


@pytest.mark.parametrize("degree", DEGREES)
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


@pytest.mark.parametrize(
    ("degree", "ends", "counts"),
    [
        (3, "complete", (81, 161)),
        (5, "complete", (81, 161)),
        (7, "complete", (61, 121)),
        (9, "complete", (41, 81)),
        (3, "not-a-knot", (81, 161)),
        (5, "not-a-knot", (81, 161)),
        (7, "not-a-knot", (121, 241)),
        (9, "not-a-knot", (161, 321)),
    ],
)
def test_ends_keep_the_order(degree: int, ends: str, counts: tuple[int, int]) -> None:
    """On smooth motion, ends included: velocity to the derivative of jerk estimated, or none needed."""

    def motion(t: FloatArray) -> FloatArray:
        a = np.stack([0.8 * np.sin(1.1 * t), 0.6 * np.cos(0.7 * t + 0.3), 0.5 * np.sin(1.7 * t)], 1)
        return quaternion.exp(a)

    errors = []
    for count in counts:
        knots = np.linspace(0.0, 10.0, count)
        curve = qs.build("moving-frame", knots, motion(knots), degree=degree, ends=ends)
        t = inside(knots, 5)
        errors.append(apart_up_to_sign(curve(t), motion(t)))
    assert np.log2(errors[0] / errors[1]) > degree + 1 - 0.4


@pytest.mark.parametrize("degree", DEGREES)
def test_the_constant_of_the_error(degree: int) -> None:
    """That of flat splines, on a closed motion: the published bound with its constant."""
    row = frame_error(degree, "closed", 64)
    assert row["constant"] == pytest.approx(row["expected"], rel=0.15)
    assert row["axis_constant"] < row["axis_bound"]


@pytest.mark.parametrize("degree", DEGREES)
def test_the_order_with_given_ends(degree: int) -> None:
    coarse, fine = (frame_error(degree, "given", count) for count in (24, 48))
    order = np.log(coarse["angle"] / fine["angle"]) / np.log(coarse["spacing"] / fine["spacing"])
    assert order > degree + 1 - 0.1


RATES: dict[str, Any] = {
    "start_velocity": [0.4, -0.1, 0.3],
    "start_acceleration": [-0.2, 0.5, 0.1],
    "end_velocity": [0.0, 0.6, -0.3],
    "end_acceleration": [0.3, 0.0, -0.4],
}


@pytest.mark.parametrize("degree", DEGREES)
@pytest.mark.parametrize("unit", [1.0, 1e-9])
def test_given_rates_are_those_of_the_curve(degree: int, unit: float) -> None:
    """One, some or all of them, in any unit of time."""
    given = {k: v for k, v in RATES.items() if degree > 3 or k.endswith("velocity")}
    given = {k: np.array(v) / unit ** (1 + k.endswith("acceleration")) for k, v in given.items()}
    knots, q = unit * uneven(12), walk(12, 20.0)
    for names in [*([name] for name in given), list(given)]:
        curve = qs.build("moving-frame", knots, q, degree=degree, **{k: given[k] for k in names})
        for name in names:
            end = curve.domain[0 if name.startswith("start") else 1]
            order = 1 + name.endswith("acceleration")
            assert apart(curve(end, order), given[name]) < 1e-7 / unit**order, name


def test_exact_rates_are_better_than_estimates() -> None:
    """What is given is not estimated, and what is not is estimated with what is given."""

    def motion(t: FloatArray) -> FloatArray:
        return quaternion.exp(0.5 * np.stack([np.sin(t), 0.3 * t, np.cos(1.3 * t)], axis=1))

    knots = np.linspace(0.0, 4.0, 13)
    fine = np.linspace(0.0, 4.0, 401)
    truth = qs.build("moving-frame", fine, motion(fine), degree=9, ends="complete")
    t = inside(knots, 5)[:10]
    errors = []
    for names in ((), ("velocity",), ("velocity", "acceleration")):
        rates = {f"start_{name}": truth(0.0, order + 1) for order, name in enumerate(names)}
        curve = qs.build("moving-frame", knots, motion(knots), degree=7, ends="complete", **rates)
        errors.append(apart_up_to_sign(curve(t), motion(t)))
    assert errors[0] > errors[1] > errors[2]


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("degree", DEGREES)
def test_axes_are_scipys_splines(degree: int, closed: bool) -> None:
    """Control points and knots that can be read, and make the curve."""
    knots, q, given = motion("closed -" if closed else "open", 12, 40.0)
    curve = qs.build("moving-frame", knots, q, degree=degree, **given)
    axes = curve.axes
    t = inside(curve.times, 5)
    assert axes._fields == ("e_x", "e_y", "e_z")
    for axis in axes:
        assert isinstance(axis, BSpline)
        assert axis.k == degree
        assert axis.c.shape == (len(axis.t) - degree - 1, 3)
    s = t - curve.times[0]
    c, alone = polar(np.stack([axis(s) for axis in axes], axis=-1))
    assert alone.min() > UNIQUE
    assert (Rotation.from_matrix(c).inv() * curve.rotation(t)).magnitude().max() < 1e-10
    ends = curve.times[: len(q)] - curve.times[0]
    frames = np.stack([axis(ends) for axis in axes], axis=-1)
    assert np.abs(frames - matrices(curve.quaternions)).max() < 1e-10


def test_axes_and_rates_of_tracks() -> None:
    knots = uneven(9)
    q = np.stack([walk(9, 40.0, seed) for seed in range(6)], axis=1).reshape(9, 2, 3, 4)
    start = np.random.default_rng(1).normal(size=(2, 3, 3))
    rates: dict[str, Any] = {"start_velocity": start, "end_velocity": [0.1, 0.2, 0.3]}
    curve = qs.build("moving-frame", knots, q, degree=5, **rates)
    single = qs.build(
        "moving-frame", knots, q[:, 1, 2], degree=5, **rates | {"start_velocity": start[1, 2]}
    )
    t = inside(knots, 3)
    assert apart(curve(t)[:, 1, 2], single(t)) < 1e-11
    assert curve.axes.e_y.c.shape == (13, 2, 3, 3)
    assert apart(curve.axes.e_y(t)[:, 1, 2], single.axes.e_y(t)) < 1e-11


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"start_velocity": [1.0, 0.0]}, r"^start_velocity has shape \(2,\): expected \(3,\)"),
        ({"end_velocity": [1.0, np.nan, 0.0]}, r"^end_velocity\[1\] = nan"),
        ({"end_velocity": [0.0, 0.0, 1e9]}, r"^end_velocity\[2\] = 1e\+09: more than 1e\+06 rad"),
        ({"start_acceleration": [0, 0, 0]}, r"^start_acceleration: degree=3 takes velocities only"),
        (
            {"start_velocity": [0, 0, 0], "ends": "natural"},
            r"^start_velocity: only with ends='complete'",
        ),
        (
            {"start_velocity": [0, 0, 0], "closed": True},
            r"^start_velocity: a closed curve has no ends",
        ),
        ({"degree": 4}, r"^degree=4: expected one of 3, 5, 7, 9"),
    ],
)
def test_rates_that_are_none(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        qs.build("moving-frame", None, walk(8, 30.0), **given)


@pytest.mark.parametrize("degree", DEGREES)
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


@pytest.mark.parametrize("degree", DEGREES)
def test_two_closed_keyframes(degree: int) -> None:
    curve = qs.build("moving-frame", None, walk(2, 80.0), closed=True, degree=degree)
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


@pytest.mark.parametrize("degree", [3, 9])
@pytest.mark.parametrize("chunk", [1, 4, 11])
def test_constants_do_not_depend_on_how_many_are_made_at_once(
    degree: int, chunk: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    t, q = uneven(12), np.stack([walk(12, 60.0, seed) for seed in (1, 2)], axis=1)
    whole = qs.build("moving-frame", t, q, degree=degree).segments
    monkeypatch.setattr(frame_splines, "CHUNK", chunk)
    np.testing.assert_array_equal(qs.build("moving-frame", t, q, degree=degree).segments, whole)
