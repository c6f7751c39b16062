"""Rotation-vector segments: rates against 40 digits, at every angle down to none."""

from typing import Any

import mpmath
import numpy as np
import pytest

import quatspline as qs
from powers import kept
from quatspline.curve import Curve
from quatspline.families.rotation_vector import PHI, ROTATION_VECTOR, SIZE
from quatspline.kernels.scalars import NEAR
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray
from quatspline.segments import SegmentCurve
from walks import spin

ACCURATE = 1e-12
SAME = 1e-14
SPACING = 0.5
U = (0.0, 0.125, 0.5, 0.875, 1.0)


class Segment(SegmentCurve):
    """A curve of one segment with powers phi (3, 6) and base 1, whatever its keyframes."""

    family = ROTATION_VECTOR

    def _fit(self, keyframes: Keyframes, *, phi: Any) -> None:
        segments = np.zeros((1, 1, SIZE))
        segments[0, 0, 0] = 1.0
        segments[0, 0, PHI:] = kept(phi).reshape(-1)
        self._set_segments(segments, np.abs(phi).sum())


def segment(phi: FloatArray) -> Curve:
    return Segment([0.0, SPACING], [[1.0, 0.0, 0.0, 0.0], [0.8, 0.6, 0.0, 0.0]], phi=phi)


def exact(phi: FloatArray, u: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """q, omega and alpha at u, by differentiating exp(phi) itself in 40 digits."""
    with mpmath.workdps(40):
        rows = [[mpmath.mpf(c) for c in row] for row in phi]

        def component(k: int) -> mpmath.mpf:
            def value(x: mpmath.mpf) -> mpmath.mpf:
                v = [sum(c * x**n for n, c in enumerate(row)) for row in rows]
                r = mpmath.sqrt(sum(c * c for c in v))
                if k == 0:
                    return mpmath.cos(r)
                return v[k - 1] * (mpmath.sin(r) / r if r else 1)

            return value

        jets = [mpmath.taylor(component(k), mpmath.mpf(u), 2) for k in range(4)]
        q, d, e = (np.array([jet[k] for jet in jets]) for k in range(3))
        h = mpmath.mpf(SPACING)
        return tuple(
            np.array(part, float) for part in (q, 2 * vector(q, d) / h, 4 * vector(q, e) / h**2)
        )


def vector(p: FloatArray, q: FloatArray) -> FloatArray:
    """The vector part of p^-1 q, in whatever digits the entries have."""
    (a, *v), (b, *w) = p, q
    cross = [v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]]
    return np.array([a * w[k] - b * v[k] - cross[k] for k in range(3)])


@pytest.mark.parametrize("angle", [1e-9, 1e-5, 1e-2, 0.3, 0.99, 1.01, 1.7])
@pytest.mark.parametrize("far", [False, True])
def test_rates_in_forty_digits(angle: float, far: bool) -> None:
    """phi of that size with slopes of order one: the hardest case for small angles."""
    rng = np.random.default_rng(3)
    base = angle * np.array([0.6, 0.0, 0.8])
    for u in U:
        phi = rng.normal(size=(3, 6)) * [0.0, 1.0, 1.0, 0.0, 0.0, 0.0]
        phi[:, 0] = base - phi[:, 1] * u - phi[:, 2] * u * u
        curve = segment(phi)
        curve.kernels = ROTATION_VECTOR.far if far else ROTATION_VECTOR.near
        for order, wanted in enumerate(exact(phi, u)):
            found = curve(SPACING * u, order)
            assert np.abs(found - wanted).max() < ACCURATE * max(1.0, np.abs(wanted).max())


@pytest.mark.parametrize("angle", [2.0, 3.1, 3.2, 9.0])
def test_any_angle(angle: float) -> None:
    phi = np.random.default_rng(5).normal(size=(3, 6)) * angle / 3
    curve = segment(phi)
    for u in U:
        for order, wanted in enumerate(exact(phi, u)):
            found = curve(SPACING * u, order)
            assert np.abs(found - wanted).max() < 1e-10 * max(1.0, np.abs(wanted).max())


def test_near_and_far_kernels_agree() -> None:
    rng = np.random.default_rng(8)
    t = SPACING * np.linspace(0.0, 1.0, 257)
    for size in (1e-8, 1e-3, 0.5, 1.7):
        phi = rng.normal(size=(3, 6))
        phi *= size / np.linalg.norm(phi, axis=0).sum()
        curve = segment(phi)
        assert np.linalg.norm(phi, axis=0).sum() <= NEAR
        values = []
        for curve.kernels in (ROTATION_VECTOR.near, ROTATION_VECTOR.far):
            values.append([curve(t, order) for order in (0, 1, 2)])
        for near, far in zip(*values, strict=True):
            assert np.abs(near - far).max() < SAME * max(1.0, np.abs(near).max()) * 10


def test_standstill() -> None:
    curve = segment(np.zeros((3, 6)))
    for curve.kernels in (ROTATION_VECTOR.near, ROTATION_VECTOR.far):
        assert np.array_equal(curve(0.1), [1.0, 0.0, 0.0, 0.0])
        assert not curve(0.1, 1).any()
        assert not curve(0.1, 2).any()


def test_large_angles_take_the_far_kernels() -> None:
    t = np.arange(5.0)
    for degrees, family in ((170.0, ROTATION_VECTOR.near), (250.0, ROTATION_VECTOR.far)):
        q = spin(t, [0.0, 0.6, 0.8], np.radians(degrees))
        assert qs.build("local-quintic", t, q, align=False).kernels is family
