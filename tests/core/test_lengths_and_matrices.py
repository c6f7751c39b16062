"""Quaternions and vectors of any length, and rotation matrices, against scipy and 40-digit arithmetic."""

import math

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from quatspline import quaternion as qn
from walks import random_units

EXACT = 1e-14
"""A few roundings."""
LENGTHS = (1e-200, 1e-3, 1.0, 7.0, 1e200)
T = np.array([-0.7, 0.0, 0.25, 0.5, 1.0, 1.6])


def unit_vectors(count: int, seed: int) -> np.ndarray:
    v = np.random.default_rng(seed).normal(size=(count, 3))
    return v / np.linalg.norm(v, axis=1)[:, None]


def apart(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.max(np.abs(a - b)))


# -- any length ---------------------------------------------------------------------------------


def test_inverse_undoes_a_product() -> None:
    q = random_units(20, 1) * np.random.default_rng(0).uniform(0.1, 9.0, (20, 1))
    assert apart(qn.mul(qn.inverse(q), q), np.tile([1.0, 0, 0, 0], (20, 1))) < EXACT
    assert apart(qn.inverse([0.0, 0.0, 1e-200, 0.0]) * 1e-200, np.array([0, 0, -1, 0])) < EXACT


def power(q: list[mp.mpf], t: mp.mpf) -> list[mp.mpf]:
    """q^t of a quaternion of any length by its definition."""
    size, turn = (mp.sqrt(sum(x * x for x in part)) for part in (q, q[1:]))
    angle = mp.atan2(turn, q[0])
    return [
        size**t * x for x in (mp.cos(t * angle), *(mp.sin(t * angle) * x / turn for x in q[1:]))
    ]


def product(a: list[mp.mpf], b: list[mp.mpf]) -> list[mp.mpf]:
    return [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]


@pytest.mark.parametrize("seed", range(5))
def test_slerp_with_modulus_is_the_general_power(seed: int) -> None:
    """a (a^-1 b)^t in 40 digits, for moduli of 0.2 and 5."""
    a, b = random_units(2, seed) * [[0.2], [5.0]]
    with mp.workdps(40):
        left, right = ([mp.mpf(float(x)) for x in q] for q in (a, b))
        square = sum(x * x for x in left)
        step = product([x * s / square for x, s in zip(left, (1, -1, -1, -1), strict=True)], right)
        wanted = [[float(x) for x in product(left, power(step, mp.mpf(float(t))))] for t in T]
    found = qn.slerp_modulus(a, b, T)
    np.testing.assert_allclose(found, wanted, atol=1e-14 * np.abs(wanted).max())


def test_slerp_with_modulus_of_units_is_slerp() -> None:
    a, b = random_units(30, 2), random_units(30, 3)
    assert apart(qn.slerp_modulus(a, b, 0.3), qn.slerp(a, b, 0.3)) < EXACT
    small = qn.mul(a, qn.exp(1e-9 * unit_vectors(30, 4)))
    assert apart(qn.slerp_modulus(a, small, 0.3), qn.slerp(a, small, 0.3)) < 1e-15


@pytest.mark.parametrize("between", [qn.slerp_vectors, qn.lerp_vectors, qn.slerp_modulus])
@pytest.mark.parametrize("lengths", ["linear", "geometric"])
def test_ends_are_met_and_lengths_are_what_they_should_be(between, lengths: str) -> None:
    rng = np.random.default_rng(5)
    width = 4 if between is qn.slerp_modulus else 3
    a, b = rng.normal(size=(2, 40, width)) * rng.uniform(0.1, 9.0, (2, 40, 1))
    b[:10] = -a[:10] + 1e-9 * rng.normal(size=(10, width))  # nearly opposite
    b[10:20] = a[10:20] * (1.0 + 1e-12 * rng.normal(size=(10, width)))
    l, m = np.linalg.norm(a, axis=1), np.linalg.norm(b, axis=1)
    for t, wanted in ((0.0, a), (1.0, b)):
        assert apart(between(a, b, t, lengths), wanted) < 1e-13
    middle = np.linalg.norm(between(a, b, 0.5, lengths), axis=1)
    np.testing.assert_allclose(middle, 0.5 * (l + m) if lengths == "linear" else np.sqrt(l * m))


def test_vectors_turn_about_the_axis_across_both() -> None:
    """Against scipy: u turned by shares of the rotation vector theta n."""
    u, v = unit_vectors(50, 6), unit_vectors(50, 7)
    n = np.cross(u, v)
    theta = np.arctan2(np.linalg.norm(n, axis=1), np.sum(u * v, axis=1))
    n /= np.linalg.norm(n, axis=1)[:, None]
    for t in T:
        wanted = Rotation.from_rotvec(t * theta[:, None] * n).apply(u)
        assert apart(qn.slerp_vectors(u, v, t), wanted) < 2e-14
        turned = qn.rotate(qn.power(qn.shortest_rotation(u, v), t), u)
        assert apart(qn.slerp_vectors(u, v, t), turned) < 2e-14


@settings(deadline=None)
@given(st.floats(1e-9, math.pi - 1e-6), st.floats(0.0, 1.0))
def test_a_lerp_of_directions_lags_as_nlerp_does(theta: float, t: float) -> None:
    """Its angle from u is atan2(t sin theta, 1 - t + t cos theta), on the same great arc."""
    u, v = np.array([1.0, 0, 0]), np.array([math.cos(theta), math.sin(theta), 0.0])
    x, y, z = qn.lerp_vectors(2.0 * u, 2.0 * v, t)
    angle = math.atan2(t * math.sin(theta), 1.0 - t + t * math.cos(theta))
    assert (math.hypot(x, y), z) == (pytest.approx(2.0), 0.0)
    assert math.atan2(y, x) == pytest.approx(angle, rel=1e-9, abs=1e-15)


def test_lengths_may_be_huge_and_tiny() -> None:
    u, v = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    for size in LENGTHS:
        found = qn.slerp_vectors(size * u, size * v, 0.5) / size
        assert apart(found, np.array([1.0, 1.0, 0.0]) / math.sqrt(2.0)) < EXACT


def test_axes_are_broadcast() -> None:
    assert qn.slerp_vectors(unit_vectors(5, 1), [0.0, 0, 1], T[:, None]).shape == (6, 5, 3)
    assert qn.slerp_modulus([1.0, 0, 0, 0], [0.0, 3, 0, 0], T).shape == (6, 4)
    assert qn.to_matrix(np.ones((2, 7, 4))).shape == (2, 7, 3, 3)
    assert qn.from_matrix(np.tile(np.eye(3), (2, 7, 1, 1))).shape == (2, 7, 4)
    assert qn.rotation_matrix_between(unit_vectors(5, 1), [0.0, 0, 1]).shape == (5, 3, 3)


X, Y = [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]
REFUSED = [
    (lambda: qn.slerp_vectors([X, [0.0] * 3], Y, 0.5), r"^u\[1\] has a direction of length zero$"),
    (lambda: qn.lerp_vectors(X, [0.0, np.nan, 0.0], 0.5), r"^v\[1\] = nan: not a finite number$"),
    (lambda: qn.slerp_vectors([Y, X], [X, [-2.0, 0, 0]], 0.5), r"^u and v are antipodes\[1\]: no"),
    (lambda: qn.lerp_vectors(X, [-3.0, 0, 0], 0.5), "^u and v are antipodes: no single arc"),
    (lambda: qn.slerp_modulus(X, Y, 0.5), r"^a has shape \(3,\): expected a last axis of 4$"),
    (lambda: qn.slerp_modulus([1.0, 0, 0, 0], [-2.0, 0, 0, 0], 0.5), "^a and b are antipodes"),
    (lambda: qn.slerp_vectors(X, Y, np.inf), "^t = inf: not a finite number$"),
    (lambda: qn.slerp_vectors(X, Y, 0.5, "cubic"), "^lengths='cubic': expected 'geometric' or"),
    (lambda: qn.slerp_vectors([X, X], [Y] * 3, 0.5), r"do not go together: leading axes \(2,\)"),
    (lambda: qn.inverse([0.0] * 4), "^q has a direction of length zero$"),
    (lambda: qn.to_matrix([[1.0, 0, 0, 0], [0.0] * 4]), r"^q\[1\] has a direction of length zero$"),
    (lambda: qn.from_matrix(np.eye(4)), r"^matrices has shape \(4, 4\): expected last axes of 3"),
    (lambda: qn.from_matrix(-np.eye(3)), "^matrices is a reflection, which no quaternion is"),
    (lambda: qn.from_matrix([np.eye(3), 2.0 * np.eye(3)]), r"^matrices\[1\] is no rotation: its"),
    (lambda: qn.from_matrix(np.full((3, 3), np.nan)), r"^matrices\[0, 0\] = nan: not a finite"),
    (lambda: qn.rotation_matrix_between(X, [0.0] * 3), "^t has a direction of length zero$"),
    (lambda: qn.rotation_matrix_between([X, X], [Y] * 3), "^s and t do not go together: shapes"),
]


@pytest.mark.parametrize(("call", "message"), REFUSED)
def test_bad_input_is_refused_in_a_sentence(call, message: str) -> None:
    with pytest.raises(ValueError, match=message) as refusal:
        call()
    assert "\n" not in str(refusal.value)


# -- matrices -----------------------------------------------------------------------------------


def test_matrices_are_scipys() -> None:
    q = random_units(500, 8)
    wanted = Rotation.from_quat(q, scalar_first=True).as_matrix()
    assert apart(qn.to_matrix(q), wanted) < EXACT
    assert apart(qn.to_matrix(-7.0 * q), wanted) < EXACT
    for size in LENGTHS:
        assert apart(qn.to_matrix(size * q), wanted) < EXACT


def test_quaternions_of_matrices_are_scipys() -> None:
    rotations = Rotation.from_quat(random_units(500, 9), scalar_first=True)
    found = qn.from_matrix(rotations.as_matrix())
    wanted = rotations.as_quat(canonical=True, scalar_first=True)
    assert apart(found, wanted) < EXACT


HALF_TURNS = [
    *np.eye(3),
    *unit_vectors(20, 10),
    np.array([1.0, 1.0, 0.0]) / math.sqrt(2.0),
    np.array([-1.0, -1.0, -1.0]) / math.sqrt(3.0),
    np.array([1e-9, 1.0, -1e-9]),
]


@pytest.mark.parametrize("short", [0.0, 1e-12, 1e-8, 1e-4])
@pytest.mark.parametrize("axis", HALF_TURNS)
def test_half_turns_and_what_is_near_them(axis: np.ndarray, short: float) -> None:
    rotation = Rotation.from_rotvec((math.pi - short) * axis / np.linalg.norm(axis))
    q = qn.from_matrix(rotation.as_matrix())
    assert abs(np.linalg.norm(q) - 1.0) < EXACT
    assert qn.distance(q, rotation.as_quat(scalar_first=True)) < 1e-15 / 1e-1
    assert q[0] >= 0.0
    assert apart(qn.to_matrix(q), rotation.as_matrix()) < EXACT


@pytest.mark.parametrize("angle", [1e-12, 1e-8, 1e-4])
def test_small_turns_keep_their_digits(angle: float) -> None:
    v = angle * np.array([2.0, -1.0, 2.0]) / 3.0
    assert 2.0 * qn.log(qn.from_matrix(qn.to_matrix(qn.exp(0.5 * v)))) == pytest.approx(
        v, rel=1e-10
    )


def test_an_exact_half_turn_takes_the_sign_of_its_largest_component() -> None:
    for k, turn in enumerate(np.eye(3)):
        matrix = 2.0 * np.outer(turn, turn) - np.eye(3)
        assert qn.from_matrix(matrix).tolist() == [0.0, *(float(i == k) for i in range(3))]


def test_a_rounded_matrix_is_taken_and_a_worse_one_is_not() -> None:
    matrix = qn.to_matrix(random_units(1, 11)[0])
    rounded = np.round(matrix, 4)
    assert abs(np.linalg.norm(qn.from_matrix(rounded)) - 1.0) < EXACT
    assert qn.distance(qn.from_matrix(rounded), qn.from_matrix(matrix)) < 2e-4
    with pytest.raises(ValueError, match="is no rotation"):
        qn.from_matrix(np.round(matrix, 1))


def is_rotation(matrix: np.ndarray) -> bool:
    square = matrix @ np.swapaxes(matrix, -1, -2)
    return apart(square, np.eye(3)) < EXACT and bool(np.all(np.linalg.det(matrix) > 0.0))


@pytest.mark.parametrize(
    "gap", [0.0, 1e-300, 1e-12, 1e-8, 1e-3, 1.0, math.pi / 2, 3.0, math.pi - 1e-3]
)
def test_the_least_rotation_between_directions_is_scipys(gap: float) -> None:
    """Turned by a rotation vector of that length across the first direction."""
    s = unit_vectors(40, 12)
    axis = np.cross(s, unit_vectors(40, 13))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    rotation = Rotation.from_rotvec(gap * axis)
    found = qn.rotation_matrix_between(3.0 * s, 0.2 * rotation.apply(s))
    assert is_rotation(found)
    assert apart(found, rotation.as_matrix()) < (EXACT if gap < 3.1 else 1e-12)


@pytest.mark.parametrize("gap", [0.0, 1e-300, 1e-15, 3e-15, 1e-13, 1e-10, 1e-6])
def test_nearly_opposite_directions_give_a_rotation_that_turns_one_into_the_other(
    gap: float,
) -> None:
    s = np.concatenate([np.eye(3), unit_vectors(40, 14)])
    t = -s + gap * np.roll(s, 1, axis=-1)
    found = qn.rotation_matrix_between(s, t)
    assert is_rotation(found)
    goal = t / np.linalg.norm(t, axis=1)[:, None]
    assert apart(np.einsum("nij,nj->ni", found, s), goal) < EXACT
    if gap == 0.0 or gap > 1e-8:
        assert apart(found, qn.to_matrix(qn.shortest_rotation(s, t))) < 1e-6
