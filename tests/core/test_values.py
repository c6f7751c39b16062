"""Values in kernels: the same formulas in plain Python and compiled, against array algebra and mpmath."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest

from quatspline import quaternion
from quatspline.engines import engine
from quatspline.kernels import jacobians, quick, values
from quatspline.kernels.jit import compiled
from quatspline.kernels.values import Mat, Quat, Vec

ROUNDING = 1e-15
DIGITS = 40


def quat(rng: np.random.Generator) -> Quat:
    return values.unit(Quat(*rng.normal(size=4).tolist()))


def vec(rng: np.random.Generator) -> Vec:
    return Vec(*rng.normal(size=3).tolist())


def mat(rng: np.random.Generator) -> Mat:
    return Mat(vec(rng), vec(rng), vec(rng))


def dense(m: Mat) -> Any:
    return np.array(m).T


@compiled
def _quaternions(p, q, f):
    return p * q, ~p, -q, p + q, p - q, f * p, p @ q


@compiled
def _vectors(a, b, f):
    return a + b, a - b, -a, f * a, a @ b, values.cross(a, b)


@compiled
def _matrices(a, b, v, f):
    return a * b, a @ v, a + b, a - b, -a, f * a, values.transposed(a)


@compiled
def _functions(p, q, v, u):
    return (
        values.exp(v),
        values.log(p),
        values.polar(v),
        values.arc(p, q),
        values.turn(p, q),
        values.slerp(p, q, u),
        values.rotate(p, v),
        values.unrotate(0.6, 0.8, values.unit(v), v),
        jacobians.right_jacobian(v, v),
        jacobians.inverse_right_jacobian(0.1 * v, v),
        jacobians.jacobian_matrix(v),
        jacobians.inverse_jacobian_matrix(0.1 * v),
        jacobians.turn_matrix(v),
    )


def same(a: Any, b: Any) -> None:
    """Equal kinds, equal numbers to rounding."""
    assert type(a) is type(b)
    if isinstance(a, tuple):
        for x, y in zip(a, b, strict=True):
            same(x, y)
    else:
        assert a == pytest.approx(b, rel=4 * ROUNDING, abs=4 * ROUNDING)


def test_python_and_compiled_code_agree() -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        p, q, a, b, m, n = quat(rng), quat(rng), vec(rng), vec(rng), mat(rng), mat(rng)
        f = float(rng.normal())
        for function, given in (
            (_quaternions, (p, q, f)),
            (_vectors, (a, b, f)),
            (_matrices, (m, n, a, f)),
            (_functions, (p, q, a, 0.3)),
        ):
            same(function(*given), engine.machine(function)(*given))


def test_operators_are_those_of_mathematics() -> None:
    rng = np.random.default_rng(2)
    p, q, a, b, m, n = quat(rng), quat(rng), vec(rng), vec(rng), mat(rng), mat(rng)
    close = {"rtol": 0.0, "atol": 1e-14}
    np.testing.assert_allclose(p * q, quaternion.mul(p, q), **close)
    np.testing.assert_allclose(~p * p, (1.0, 0.0, 0.0, 0.0), **close)
    np.testing.assert_allclose(values.cross(a, b), np.cross(a, b), **close)
    assert p @ q == pytest.approx(np.dot(p, q), abs=1e-14)
    np.testing.assert_allclose(dense(m * n), dense(m) @ dense(n), **close)
    np.testing.assert_allclose(m @ a, dense(m) @ np.array(a), **close)
    np.testing.assert_allclose(dense(values.transposed(m)), dense(m).T, **close)
    for x, y in ((p, q), (a, b), (m, n)):
        np.testing.assert_allclose(x + y, np.array(x) + np.array(y), **close)
        np.testing.assert_allclose(x - y, np.array(x) - np.array(y), **close)
        for f in (2.0, np.float64(2.0), 2):  # numpy's numbers leave the product to the value
            assert f * x == x + x
            assert type(f * x) is type(x)


@pytest.mark.parametrize("value", [Quat(1.0, 2.0, 3.0, 4.0), Vec(1.0, 2.0, 3.0)])
def test_values_do_not_behave_as_tuples(value: Any) -> None:
    """Of tuples these would be longer ones."""
    with pytest.raises((TypeError, AttributeError)):
        value * 2
    with pytest.raises((TypeError, AttributeError)):
        value + value[:1]


@pytest.mark.parametrize("size", [0.0, 1e-200, 1e-9, 1e-3, 0.03, 0.04, 1.0, 1.58, 1.6, 3.0])
def test_exponential_and_logarithm(size: float) -> None:
    v = Vec(0.36 * size, 0.48 * size, 0.8 * size)
    s = math.sin(size) / size if size else 1.0
    for exp, log in ((values.exp, values.log), (quick.exp, quick.log)):
        wanted = (math.cos(size), *(s * np.array(v)))
        np.testing.assert_allclose(exp(v), wanted, rtol=0.0, atol=ROUNDING)
        np.testing.assert_allclose(log(exp(v)), v, rtol=4 * ROUNDING, atol=0.0)


def test_the_logarithm_does_not_see_a_length() -> None:
    for size in (1e-6, 0.02, 0.5, 2.0):
        q = values.exp(Vec(0.0, size, 0.0))
        np.testing.assert_allclose(values.log(1.001 * q), values.log(q), rtol=4 * ROUNDING)
    assert values.log(Quat(-1.0, 0.0, 0.0, 0.0)) == (math.pi, 0.0, 0.0)


def exact_coefficients(z: Any) -> tuple[Any, ...]:
    """a, b, k of the Jacobians at z."""
    x = mpmath.sqrt(z)
    s, c = mpmath.sin(x) / x, mpmath.cos(x)
    return s * s, (1 - s * c) / z, (1 - c / s) / z


@pytest.mark.parametrize("x", [1e-8, 1e-3, 0.1, 0.5, 0.9999, 1.0001, 1.5, 1.78, 1.8, 2.5, 3.1])
def test_coefficients_of_jacobians_in_every_range(x: float) -> None:
    with mpmath.workdps(DIGITS):
        z = mpmath.mpf(x) ** 2
        a, b, k = exact_coefficients(z)
        da, db, dk = (
            mpmath.diff(lambda z, j=j: exact_coefficients(z)[j], z, h=z * mpmath.mpf(10) ** -10)
            for j in range(3)
        )
        found = jacobians.coefficients(x * x)
        wanted = (a, b, 2 * da, 2 * db)
        assert found == pytest.approx([float(w) for w in wanted], rel=1e-12)
        found = jacobians.inverse_coefficient(x * x)
        assert found[0] == pytest.approx(float(k), rel=1e-13)
        assert found[1] == pytest.approx(float(dk), rel=1e-11)


@pytest.mark.parametrize("size", [1e-9, 0.3, 1.2, 2.0, 2.9])
def test_jacobians_are_what_they_are_called(size: float) -> None:
    rng = np.random.default_rng(3)
    v, w = size * values.unit(vec(rng)), vec(rng)
    step = 1e-6
    ahead, behind = values.exp(v + step * w), values.exp(v - step * w)
    slope = values.vec(~values.exp(v) * ((0.5 / step) * (ahead - behind)))
    np.testing.assert_allclose(jacobians.right_jacobian(v, w), slope, atol=1e-8)
    back = jacobians.inverse_right_jacobian(v, jacobians.right_jacobian(v, w))
    np.testing.assert_allclose(back, w, atol=1e-12)
    np.testing.assert_allclose(
        jacobians.jacobian_matrix(v) @ w, jacobians.right_jacobian(v, w), atol=1e-14
    )
    inverse = jacobians.inverse_jacobian_matrix(v) * jacobians.jacobian_matrix(v)
    np.testing.assert_allclose(dense(inverse), np.eye(3), atol=1e-12)
    np.testing.assert_allclose(
        jacobians.turn_matrix(v) @ w, values.rotate(values.exp(v), w), atol=1e-14
    )


def test_symmetric_systems() -> None:
    rng = np.random.default_rng(4)
    m, v = mat(rng), vec(rng)
    square = values.transposed(m) * m
    x, definite = values.solve_symmetric(square, v)
    np.testing.assert_allclose(x, np.linalg.solve(dense(square), np.array(v)), rtol=1e-10)
    assert definite
    assert not values.solve_symmetric(-square, v)[1]
