"""The algebra against 40-digit arithmetic, scipy, and its own laws."""

import math

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation, Slerp

from quatspline import quaternion as qn
from walks import random_units

EXACT = 1e-14
"""A few roundings."""
SMALL = 1e-10
"""Relative accuracy that tiny rotations keep."""
TINY = 1e-12
DIGITS = 40

AXES = [
    np.array([1.0, 0.0, 0.0]),
    np.array([0.0, 0.0, -1.0]),
    np.array([2.0, -1.0, 2.0]) / 3.0,
    np.array([3.0, 4.0, 12.0]) / 13.0,
]
ANGLES = [0.0, 1e-300, 1e-12, 1e-8, 1e-4, 0.01, 0.5, 1.0, math.pi / 2, 2.0, 3.0, math.pi - 1e-7]


def precise_mul(a: list[mp.mpf], b: list[mp.mpf]) -> list[mp.mpf]:
    return [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]


def precise_exp(v: list[mp.mpf]) -> list[mp.mpf]:
    angle = mp.sqrt(sum(x * x for x in v))
    scale = mp.sin(angle) / angle if angle else mp.mpf(1)
    return [mp.cos(angle), *(scale * x for x in v)]


def precise_log(q: list[mp.mpf]) -> list[mp.mpf]:
    length = mp.sqrt(sum(x * x for x in q[1:]))
    scale = mp.atan2(length, q[0]) / length if length else mp.mpf(1)
    return [scale * x for x in q[1:]]


def exactly(array: np.ndarray) -> list[mp.mpf]:
    return [mp.mpf(float(x)) for x in array]


def off(computed: np.ndarray, wanted: list[mp.mpf]) -> float:
    """The relative error of a vector."""
    with mp.workdps(DIGITS):
        pairs = zip(computed, wanted, strict=True)
        gap = mp.sqrt(sum((mp.mpf(float(c)) - w) ** 2 for c, w in pairs))
        size = mp.sqrt(sum(w * w for w in wanted))
        return float(gap / size) if size else float(gap)


# -- products, exponentials, logarithms ---------------------------------------------------------


def test_mul_matches_exact_arithmetic() -> None:
    for a, b in zip(random_units(20, 1), random_units(20, 2), strict=True):
        with mp.workdps(DIGITS):
            assert off(qn.mul(a, b), precise_mul(exactly(a), exactly(b))) < EXACT


def test_mul_is_scipys_composition() -> None:
    a, b = random_units(50, 1), random_units(50, 2)
    wanted = Rotation.from_quat(a, scalar_first=True) * Rotation.from_quat(b, scalar_first=True)
    assert np.max(qn.distance(qn.mul(a, b), wanted.as_quat(scalar_first=True))) < EXACT


def test_units_of_hamilton() -> None:
    one, i, j, k = np.eye(4)
    assert np.array_equal(qn.mul(i, j), k)
    assert np.array_equal(qn.mul(j, i), -k)
    assert np.array_equal(qn.mul(i, i), -one)
    assert np.array_equal(qn.conj(k), -k)


@pytest.mark.parametrize("axis", AXES, ids=str)
@pytest.mark.parametrize("angle", ANGLES)
def test_exp_and_log(axis: np.ndarray, angle: float) -> None:
    with mp.workdps(DIGITS):
        v = angle * axis
        q = qn.exp(v)
        assert off(q, precise_exp(exactly(v))) < EXACT
        # relative, however small; near pi as far as pi - |v| itself is known
        known = EXACT + 1e-15 / (math.pi - angle)
        assert off(q[1:], precise_exp(exactly(v))[1:]) < known
        assert off(qn.log(q), precise_log(exactly(q))) < EXACT
        assert off(qn.log(q), exactly(v)) < EXACT


@pytest.mark.parametrize("angle", [4.0, 10.0, 1e3, -7.5, 1e5])
def test_exp_of_many_turns(angle: float) -> None:
    with mp.workdps(DIGITS):
        v = angle * AXES[2]
        assert np.linalg.norm(qn.exp(v) - np.array(precise_exp(exactly(v)), float)) < EXACT * (
            1 + abs(angle)
        )


def test_log_matches_scipy() -> None:
    q = random_units(100, 3)
    q *= np.sign(q[:, :1])
    rotvec = Rotation.from_quat(q, scalar_first=True).as_rotvec()
    assert np.abs(2 * qn.log(q) - rotvec).max() < EXACT


def test_log_of_the_poles() -> None:
    assert np.array_equal(qn.log([1.0, 0, 0, 0]), np.zeros(3))
    assert np.array_equal(qn.log([-1.0, 0, 0, 0]), [math.pi, 0, 0])
    near = qn.log([-1.0, 0.0, 1e-9, 0.0])
    assert near == pytest.approx([0.0, math.pi - 1e-9, 0.0], abs=1e-15)


@pytest.mark.parametrize("axis", AXES, ids=str)
def test_tiny_rotations_keep_their_digits(axis: np.ndarray) -> None:
    """1e-12 rad: acos would give 0 here."""
    half = 0.5 * TINY * axis
    for base in [np.array([1.0, 0, 0, 0]), *random_units(3, 4)]:
        with mp.workdps(DIGITS):
            b = qn.mul(base, qn.exp(half))
            relative = precise_mul(exactly(qn.conj(base)), exactly(b))
            wanted = precise_log(relative)
            angle = 2 * mp.sqrt(sum(x * x for x in wanted))
            assert abs(float(qn.distance(base, b) / angle) - 1.0) < SMALL + 1e-3 * (base[0] != 1.0)
            assert off(qn.log(qn.exp(half)), exactly(half)) < SMALL
            assert off(qn.power(qn.exp(half), 0.3), precise_exp(exactly(0.3 * half))) < SMALL
            assert off(qn.power(qn.exp(half), 0.3)[1:], exactly(0.3 * half)) < SMALL
    one = np.array([1.0, 0, 0, 0])
    between = qn.slerp(one, qn.exp(half), 0.25)
    assert off(between[1:], exactly(0.25 * half)) < SMALL
    assert qn.distance(one, between) == pytest.approx(0.25 * TINY, rel=SMALL)
    assert off(qn.nlerp(one, qn.exp(half), 0.25)[1:], exactly(0.25 * half)) < SMALL


@pytest.mark.parametrize("angle", [1e-12, 1e-8, 1e-3, 1.0, 3.0])
def test_between_directions(angle: float) -> None:
    u, w = np.array([0.6, 0.0, 0.8]), np.array([0.8, 0.0, -0.6])
    v = math.cos(angle) * u + math.sin(angle) * w
    q = qn.shortest_rotation(3.0 * u, 0.2 * v)
    assert off(2 * qn.log(q), exactly(angle * np.cross(u, w))) < max(SMALL, 4e-16 / angle * 4)
    assert np.linalg.norm(qn.rotate(q, u) - v) < EXACT


def test_between_exactly_representable_tiny_turn() -> None:
    q = qn.shortest_rotation([1.0, 0.0, 0.0], [1.0, TINY, 0.0])
    assert off(2 * qn.log(q), exactly(np.array([0.0, 0.0, TINY]))) < SMALL


def test_between_parallel_and_opposite() -> None:
    assert np.array_equal(qn.shortest_rotation([0.0, 2.0, 0.0], [0.0, 5.0, 0.0]), [1, 0, 0, 0])
    for u in [*np.eye(3), *AXES, np.array([1.0, 1.0, 1.0]), np.array([1e-200, 0.0, 0.0])]:
        q = qn.shortest_rotation(u, -u)
        direction = u / np.abs(u).max() / np.linalg.norm(u / np.abs(u).max())
        assert np.linalg.norm(qn.rotate(q, direction) + direction) < EXACT
        assert abs(q[1:] @ direction) < EXACT
        assert abs(np.linalg.norm(q) - 1.0) < EXACT
        nearly = qn.shortest_rotation(direction, -direction + 1e-10 * np.roll(direction, 1))
        assert np.isfinite(nearly).all()
    for name, vectors in {"u": ([0, 0, 0], [1, 0, 0]), "v": ([1, 0, 0], [0, 0, 0])}.items():
        with pytest.raises(ValueError, match=rf"^{name} has a direction of length zero"):
            qn.shortest_rotation(*vectors)


# -- half turns and antipodes -------------------------------------------------------------------


def test_half_turns() -> None:
    one = np.array([1.0, 0, 0, 0])
    for axis in AXES:
        half = np.array([0.0, *axis])
        assert qn.distance(one, half) == pytest.approx(math.pi, abs=EXACT)
        assert np.linalg.norm(qn.log(half) - math.pi / 2 * axis) < EXACT
        middle = qn.slerp(one, half, 0.5)
        assert np.linalg.norm(middle - [math.sqrt(0.5), *(math.sqrt(0.5) * axis)]) < EXACT
        assert np.linalg.norm(qn.nlerp(one, half, 0.5) - middle) < EXACT
        assert np.linalg.norm(qn.power(half, 2.0) + one) < EXACT


@pytest.mark.parametrize("function", [qn.slerp, qn.nlerp])
def test_antipodes_are_refused(function: object) -> None:
    q = random_units(4, 6)
    other = random_units(4, 7)
    other[2] = -q[2]
    with pytest.raises(ValueError, match=r"antipodes\[2\]"):
        function(q, other, 0.5)  # type: ignore[operator]
    with pytest.raises(ValueError, match="antipodes"):
        function(q[0], -q[0], 0.5)  # type: ignore[operator]


@pytest.mark.parametrize("gap", [1e-15, 1e-13, 1e-9, 1e-5])
def test_close_to_antipodes_is_never_nan(gap: float) -> None:
    one = np.array([1.0, 0, 0, 0])
    far = -qn.exp([0.0, gap, 0.0])
    for t in (0.0, 0.3, 0.5, 1.0):
        for function in (qn.slerp, qn.nlerp):
            q = function(one, far, t)
            assert np.isfinite(q).all()
            assert abs(np.linalg.norm(q) - 1.0) < 1e-12
    assert qn.distance(one, far) == pytest.approx(2 * gap, rel=1e-9)  # one orientation, nearly
    assert qn.distance(one, -one) == 0.0


def test_align() -> None:
    q = random_units(30, 8).reshape(10, 3, 4)
    aligned = qn.align(q)
    assert np.array_equal(aligned[0], q[0])
    assert np.array_equal(np.abs(aligned), np.abs(q))
    assert np.all(np.einsum("nki,nki->nk", aligned[1:], aligned[:-1]) >= 0.0)
    assert np.array_equal(qn.align(aligned), aligned)
    orthogonal = np.array([[1.0, 0, 0, 0], [0, -1.0, 0, 0], [0, 0, 1.0, 0]])
    assert np.array_equal(qn.align(orthogonal), orthogonal)
    assert np.array_equal(qn.align(orthogonal[:1]), orthogonal[:1])


def test_slerp_matches_scipy() -> None:
    keys = qn.align(random_units(2, 9))
    t = np.linspace(0.0, 1.0, 21)
    wanted = Slerp([0, 1], Rotation.from_quat(keys, scalar_first=True))(t)
    assert np.max(qn.distance(qn.slerp(*keys, t), wanted.as_quat(scalar_first=True))) < EXACT


def test_slerp_extrapolates() -> None:
    a, b = qn.align(random_units(2, 10))
    assert np.linalg.norm(qn.slerp(a, b, 2.0) - qn.mul(b, qn.mul(qn.conj(a), b))) < EXACT


def test_rotate_matches_scipy() -> None:
    q, v = random_units(20, 11), np.random.default_rng(1).normal(size=(20, 3))
    assert np.abs(qn.rotate(q, v) - Rotation.from_quat(q, scalar_first=True).apply(v)).max() < EXACT


def test_broadcasting() -> None:
    q = random_units(6, 12).reshape(2, 3, 4)
    assert qn.mul(q, q[0]).shape == (2, 3, 4)
    assert qn.mul(q[:, None], q[:, :, None]).shape == (2, 3, 3, 4)
    assert qn.power(q, np.ones((5, 1, 1))).shape == (5, 2, 3, 4)
    assert qn.slerp(q[0], q[1], np.linspace(0, 1, 4)[:, None]).shape == (4, 3, 4)
    assert qn.distance(q, q[:1]).shape == (2, 3)
    assert qn.distance(q[0, 0], q[0, 1]).shape == ()
    assert qn.log(np.empty((0, 4))).shape == (0, 3)
    assert qn.right_jacobian(np.zeros((2, 3, 3))).shape == (2, 3, 3, 3)
    assert np.array_equal(qn.mul(q[::-1, ::2], q[0, 0])[0, 0], qn.mul(q[1, 0], q[0, 0]))
    for wrong in (1.0, [1.0, 2.0], np.zeros((4, 3))):
        with pytest.raises(ValueError, match="ends in an axis of 4"):
            qn.log(wrong)


# -- Jacobians ----------------------------------------------------------------------------------


def precise_jacobian(r: np.ndarray) -> np.ndarray:
    """Jr by central differences in 40 digits: exp(r)^-1 exp(r + d) = exp(Jr d), full angles."""
    with mp.workdps(DIGITS):
        step = mp.mpf(10) ** -12
        columns = []
        for k in range(3):
            sides = []
            for sign in (1, -1):
                moved = [mp.mpf(float(x)) / 2 for x in r]
                back = precise_exp([-x for x in moved])
                moved[k] += sign * step / 2
                sides.append(precise_log(precise_mul(back, precise_exp(moved))))
            columns.append([float(2 * (a - b) / (2 * step)) for a, b in zip(*sides, strict=True)])
        return np.array(columns).T


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-3, 0.1, 0.999, 1.001, 2.0, math.pi, 4.5, 6.0, 9.0])
@pytest.mark.parametrize("axis", AXES[1:], ids=str)
def test_right_jacobian(angle: float, axis: np.ndarray) -> None:
    r = angle * axis
    wanted = precise_jacobian(r)
    assert np.abs(qn.right_jacobian(r) - wanted).max() < EXACT
    inverse = qn.right_jacobian_inverse(r)
    size = np.linalg.norm(np.linalg.inv(wanted))
    assert np.abs(inverse @ wanted - np.eye(3)).max() < EXACT * size
    assert np.abs(inverse - np.linalg.inv(wanted)).max() < EXACT * size**2


def test_right_jacobian_is_singular_at_full_turns() -> None:
    for turns in (1, 2):
        with pytest.raises(ValueError, match="singular"):
            qn.right_jacobian_inverse([0.0, 0.0, 2 * math.pi * turns])
    assert np.isfinite(qn.right_jacobian_inverse([0.0, 0.0, 2 * math.pi - 1e-6])).all()


# -- laws ---------------------------------------------------------------------------------------

numbers = st.floats(-1.0, 1.0, allow_subnormal=False, width=64)
vectors = arrays(np.float64, 3, elements=numbers).map(lambda v: 1.8 * v)  # |v| < pi
units = (
    arrays(np.float64, 4, elements=numbers)
    .filter(lambda q: np.linalg.norm(q) > 1e-3)
    .map(lambda q: qn.normalise(q))
)
laws = settings(max_examples=60, deadline=None, derandomize=True)


@laws
@given(units, units, units)
def test_associativity(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> None:
    gap = qn.mul(qn.mul(a, b), c) - qn.mul(a, qn.mul(b, c))
    assert np.linalg.norm(gap) < EXACT


@laws
@given(units, units)
def test_norms_multiply(a: np.ndarray, b: np.ndarray) -> None:
    assert abs(np.linalg.norm(qn.mul(a, b)) - 1.0) < EXACT
    assert np.linalg.norm(qn.mul(a, qn.conj(a)) - [1, 0, 0, 0]) < EXACT
    assert np.linalg.norm(qn.conj(qn.mul(a, b)) - qn.mul(qn.conj(b), qn.conj(a))) < EXACT


@laws
@given(vectors)
def test_log_undoes_exp(v: np.ndarray) -> None:
    room = math.pi - np.linalg.norm(v)
    if room > 1e-3:
        assert np.linalg.norm(qn.log(qn.exp(v)) - v) < EXACT / min(room, 1.0)
    assert np.linalg.norm(qn.exp(-v) - qn.conj(qn.exp(v))) < EXACT


@laws
@given(units)
def test_exp_undoes_log(q: np.ndarray) -> None:
    assert np.linalg.norm(qn.exp(qn.log(q)) - q) < EXACT


@laws
@given(units, units, st.floats(0.0, 1.0))
def test_slerp_ends_and_symmetry(a: np.ndarray, b: np.ndarray, t: float) -> None:
    if np.linalg.norm(a + b) < 1e-3:
        return
    assert np.linalg.norm(qn.slerp(a, b, 0.0) - a) < EXACT
    assert np.linalg.norm(qn.slerp(a, b, 1.0) - b) < 4 * EXACT
    room = np.linalg.norm(a + b)
    assert np.linalg.norm(qn.slerp(a, b, t) - qn.slerp(b, a, 1.0 - t)) < 10 * EXACT / room


@laws
@given(units, units, units)
def test_distance_is_a_metric_of_rotations(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> None:
    assert qn.distance(a, -b) == pytest.approx(qn.distance(a, b), abs=EXACT)
    assert qn.distance(a, a) < EXACT
    assert qn.distance(a, c) <= qn.distance(a, b) + qn.distance(b, c) + EXACT
    assert qn.distance(qn.mul(c, a), qn.mul(c, b)) == pytest.approx(qn.distance(a, b), abs=1e-13)
