"""The paper's theorem and formulas in 50 digits, and golden numbers made in 50 digits elsewhere."""

import itertools
from functools import partial
from typing import Any

import mpmath as mp
import numpy as np
import pytest

import quatspline as qs
from golden import GOLDEN, KNOTS, assert_golden
from powers import powers
from quatspline import quaternion
from quatspline.families import cumulative
from quatspline.instruments.smoothness import inner_jumps, inner_smoothness
from walks import apart, random_units, uneven, walk

DIGITS = 50
ZERO = 1e-20
"""What is left of an identity in 50 digits after two numerical derivatives."""
CLOSE = 1e-14

Vector = list[Any]


@pytest.fixture(autouse=True)
def fifty_digits() -> Any:
    with mp.workdps(DIGITS):
        yield


# -- quaternions in 50 digits: nothing shared with the package ----------------------------------


def mul(a: Vector, b: Vector) -> Vector:
    return [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]


def conj(q: Vector) -> Vector:
    return [q[0], -q[1], -q[2], -q[3]]


def plus(*terms: Vector) -> Vector:
    return [sum(column) for column in zip(*terms, strict=True)]


def times(c: Any, q: Vector) -> Vector:
    return [c * x for x in q]


def size(q: Vector) -> Any:
    return mp.sqrt(sum(x * x for x in q))


def log(q: Vector) -> Vector:
    """theta n as a quaternion without scalar part."""
    length = size(q[1:])
    scale = mp.atan2(length, q[0]) / length if length else mp.mpf(1)
    return [mp.mpf(0), *(scale * x for x in q[1:])]


def exp(v: Vector) -> Vector:
    angle = size(v)
    return [mp.cos(angle), *times(mp.sin(angle) / angle if angle else mp.mpf(1), v[1:])]


def unit(row: Any) -> Vector:
    q = [mp.mpf(x) if isinstance(x, str) else mp.mpf(float(x)) for x in row]
    return times(1 / size(q), q)


def floats(q: Vector) -> np.ndarray:
    return np.array([float(x) for x in q])


# -- the paper's curve --------------------------------------------------------------------------

# notation: (4) as printed, coefficients of u^0 ... u^4
BLENDING = {
    0: ("0", "-1/2", "3/2", "-3/2", "1/2"),
    1: ("1", "0", "-3", "5/2", "-1/2"),
    2: ("0", "1/2", "3/2", "-1/2", "-1/2"),
    3: ("0", "0", "0", "-1/2", "1/2"),
}


def fraction(text: str) -> Any:
    numerator, _, denominator = text.partition("/")
    return mp.mpf(int(numerator)) / int(denominator or 1)


def cumulated(j: int) -> Vector:
    """Coefficients of the cumulative sum from B_j to B_3."""
    return plus(*([fraction(c) for c in BLENDING[k]] for k in range(j, 4)))


def value(coefficients: Vector, u: Any) -> Any:
    return sum(c * u**k for k, c in enumerate(coefficients))


def with_ghosts(q: list[Vector]) -> list[Vector]:
    return [q[0], *q, q[-1]]


def segment(q: list[Vector], i: int, u: Any) -> Vector:
    """(1) on the keyframes with ghosts: segment i runs from q[i] to q[i + 1]."""
    product = q[i - 1]
    for j in (1, 2, 3):
        step = log(mul(conj(q[i + j - 2]), q[i + j - 1]))
        product = mul(product, exp(times(value(cumulated(j), u), step)))
    return product


def derivatives(curve: Any, u: Any, order: int) -> Vector:
    """A derivative of an analytic curve in R^4 by central differences: (1) goes on past its ends.

    Steps of 1e-12 (1e-9 for the third) leave errors of 1e-24 (1e-18), rounding less.
    """
    h = mp.mpf(10) ** (-9 if order == 3 else -12)
    weights = {
        1: {-1: -0.5, 1: 0.5},
        2: {-1: 1, 0: -2, 1: 1},
        3: {-2: -0.5, -1: 1, 1: -1, 2: 0.5},
    }[order]
    return plus(*(times(mp.mpf(w) / h**order, curve(u + k * h)) for k, w in weights.items()))


def keys(count: int, seed: int) -> list[Vector]:
    return [unit(q) for q in quaternion.align(random_units(count, seed))]


@pytest.mark.parametrize("seed", range(3))
def test_theorem_1(seed: int) -> None:
    """Interpolation and C^2 at equidistant knots, and no more than C^2."""
    q = with_ghosts(keys(5, seed))
    for i in range(1, 5):
        assert size(plus(segment(q, i, mp.mpf(0)), times(-1, q[i]))) < ZERO
        assert size(plus(segment(q, i, mp.mpf(1)), times(-1, q[i + 1]))) < ZERO
    for i in range(2, 5):
        gaps = []
        for order in (1, 2, 3):
            before = derivatives(lambda u, i=i: segment(q, i - 1, u), mp.mpf(1), order)
            after = derivatives(lambda u, i=i: segment(q, i, u), mp.mpf(0), order)
            gaps.append(size(plus(after, times(-1, before))))
        assert gaps[0] < ZERO
        assert gaps[1] < ZERO
        assert gaps[2] > 0.1


def components(q: list[Vector], i: int) -> list[Any]:
    return [lambda u, k=k: segment(q, i, u)[k] for k in range(4)]


@pytest.mark.parametrize("order", [3, 4, 5, 6])
def test_c_infinity_inside_segments(order: int) -> None:
    """Derivatives from either side agree to 30 digits inside a segment; at a knot the third does not."""
    q = with_ghosts(keys(5, 1))
    for u in ("0.25", "0.6"):
        sides = [
            [mp.diff(f, mp.mpf(u), order, direction=side) for f in components(q, 2)]
            for side in (-1, 1)
        ]
        assert size(plus(sides[1], times(-1, sides[0]))) < mp.mpf(10) ** -30 * size(sides[0])
    at_knot = [
        [mp.diff(f, mp.mpf(u), order, direction=side) for f in components(q, i)]
        for i, u, side in ((1, 1, -1), (2, 0, 1))
    ]
    assert size(plus(at_knot[1], times(-1, at_knot[0]))) > 0.01 * size(at_knot[0])


def test_the_measured_derivatives_inside_segments_are_those_of_the_formula() -> None:
    """What says that the package's curve has no break inside reads its derivatives up to the sixth right."""
    quaternions = quaternion.align(random_units(5, 1))
    table = inner_jumps(qs.build("quartic", None, quaternions))
    assert inner_smoothness(table) == 6
    q = with_ghosts(keys(5, 1))
    for order, widest in table[table["width"] == 0.25].set_index("order")["size"].items():
        sizes = [
            size([mp.diff(f, mp.mpf(u), int(order)) for f in components(q, i)])
            for i in range(1, 5)
            for u in ("0.25", "0.5", "0.75")
        ]
        assert widest == pytest.approx(float(max(sizes)), rel=1e-2)


def knot(q: list[Vector], i: int) -> tuple[Vector, Vector]:
    """The steps a and b into and out of keyframe i."""
    return log(mul(conj(q[i - 1]), q[i])), log(mul(conj(q[i]), q[i + 1]))


def printed(q: Vector, a: Vector, b: Vector) -> Vector:
    total = plus(a, b)
    return plus(
        times(mp.mpf(1) / 4, mul(q, mul(total, total))), times(3, mul(q, plus(b, times(-1, a))))
    )


def corrected(q: Vector, a: Vector, b: Vector) -> Vector:
    square = plus(mul(a, a), times(2, mul(a, b)), mul(b, b))
    return mul(q, plus(times(mp.mpf(1) / 4, square), times(3, plus(b, times(-1, a)))))


def second_at(q: list[Vector], i: int) -> Vector:
    return derivatives(lambda u: segment(q, i, u), mp.mpf(0), 2)


def test_first_derivative_at_knots() -> None:
    q = keys(4, 11)
    a, b = knot(q, 1)
    wanted = times(mp.mpf(1) / 2, mul(q[1], plus(a, b)))
    first = derivatives(lambda u: segment(q, 1, u), mp.mpf(0), 1)
    assert size(plus(first, times(-1, wanted))) < ZERO


@pytest.mark.parametrize("seed", range(4))
def test_printed_second_derivative_needs_commuting_steps(seed: int) -> None:
    """The paper's Q'' is off by (ab - ba)/4; the product rule gives a^2 + 2ab + b^2."""
    q = keys(4, seed)
    a, b = knot(q, 1)
    second = second_at(q, 1)
    assert size(plus(second, times(-1, corrected(q[1], a, b)))) < ZERO
    gap = size(plus(second, times(-1, printed(q[1], a, b))))
    commutator = plus(mul(a, b), times(-1, mul(b, a)))
    assert gap > 0.01
    assert abs(gap - size(commutator) / 4) < ZERO


def test_printed_second_derivative_holds_about_one_axis() -> None:
    base = keys(1, 3)[0]
    axis = [mp.mpf(0), mp.mpf(2) / 7, mp.mpf(3) / 7, mp.mpf(6) / 7]
    q = [mul(base, exp(times(mp.mpf(x), axis))) for x in ("0", "0.7", "1.1", "2.3")]
    a, b = knot(q, 1)
    second = second_at(q, 1)
    assert size(plus(second, times(-1, printed(q[1], a, b)))) < ZERO
    assert size(plus(second, times(-1, corrected(q[1], a, b)))) < ZERO


def test_printed_second_derivative_on_the_golden_keys() -> None:
    """Off by 0.17 of 3.08, 0.40 of 3.70 and 0.42 of 4.51 at the inner keyframes."""
    q = [unit(row) for row in GOLDEN["meta"]["raw_keyframes"]]
    for i, gap, whole in ((1, 0.169, 3.080), (2, 0.398, 3.700), (3, 0.424, 4.508)):
        a, b = knot(q, i)
        true = corrected(q[i], a, b)
        wrong = plus(true, times(-1, printed(q[i], a, b)))
        assert float(size(wrong)) == pytest.approx(gap, abs=1e-3)
        assert float(size(true)) == pytest.approx(whole, abs=1e-3)


def test_rates_at_the_keyframes() -> None:
    """omega = a + b, alpha = 6 (b - a) + a x b, in body terms."""
    q = walk(6, 70.0, seed=2)
    curve = qs.QuarticSpline(None, q)
    for i in range(1, 5):
        a, b = (quaternion.log(quaternion.mul(quaternion.conj(q[j]), q[j + 1])) for j in (i - 1, i))
        assert apart(curve(float(i), 1), a + b) < CLOSE
        assert apart(curve(float(i), 2), 6 * (b - a) + np.cross(a, b)) < 10 * CLOSE


# -- the scheme against the paper ---------------------------------------------------------------


def coefficients_of(curve: Any, i: int) -> np.ndarray:
    """The scheme's own polynomials of segment i, per unit of the step: (3, 6)."""
    constants = curve.segments[0, i]
    angles = powers(constants[cumulative.ANGLES :].reshape(3, 6))
    frames = curve.quaternions
    steps = np.linalg.norm(
        quaternion.log(quaternion.mul(quaternion.conj(frames[:-1]), frames[1:])), axis=1
    )
    return angles / steps[i - 1 : i + 2, None]


def test_blending_functions() -> None:
    """The scheme's own coefficients are the paper's (4), summed."""
    curve = qs.QuarticSpline(None, walk(6, 80.0, seed=3))
    for i in (1, 2, 3):
        own = coefficients_of(curve, i)
        own[0, 0] += 1.0  # the scheme starts from q_i, the paper from q_{i-1}
        wanted = np.array([[*map(float, cumulated(j)), 0.0] for j in (1, 2, 3)])
        assert np.abs(own - wanted).max() < CLOSE
        single = own - np.vstack([own[1:], np.zeros(6)])
        for j in (1, 2, 3):
            printed_row = [float(fraction(c)) for c in BLENDING[j]]
            assert np.abs(single[j - 1, :5] - printed_row).max() < CLOSE
    assert [float(x) for x in cumulated(0)] == [1.0, 0.0, 0.0, 0.0, 0.0]


@pytest.mark.parametrize("closed", [False, True])
def test_no_fifth_power_on_any_knots(closed: bool) -> None:
    knots = uneven(9 if closed else 8)
    curve = qs.QuarticSpline(knots, walk(8, 40.0, seed=5), closed=closed)
    angles = powers(curve.segments[0, :, cumulative.ANGLES :].reshape(-1, 3, 6))
    assert np.abs(angles[..., 5]).max() < CLOSE
    assert np.abs(angles[..., 4]).max() > 0.01


@pytest.mark.parametrize("degrees", [1e-6, 20.0, 90.0, 150.0, 179.0])
def test_quartic_is_equation_1(degrees: float) -> None:
    """Orders 0, 1, 2 against 50 digits, to rounding."""
    frames = qs.QuarticSpline(None, walk(5, degrees, seed=7)).quaternions
    curve = qs.QuarticSpline(None, frames)
    exact = with_ghosts([unit(q) for q in frames])
    worst = [0.0, 0.0, 0.0]
    for i, u in itertools.product(range(1, 5), ("0", "0.125", "0.6875", "0.9375")):
        at = mp.mpf(u)
        t = float(i - 1 + at)
        q = segment(exact, i, at)
        first = derivatives(lambda x, i=i: segment(exact, i, x), at, 1)
        second = derivatives(lambda x, i=i: segment(exact, i, x), at, 2)
        wanted = [
            floats(q),
            floats(times(2, mul(conj(q), first)))[1:],
            floats(times(2, mul(conj(q), second)))[1:],
        ]
        for order in range(3):
            worst[order] = max(worst[order], apart(curve(t, order), wanted[order]))
    step = np.radians(degrees)
    assert worst[0] < 1.5e-15
    assert worst[1] < CLOSE * max(step, 0.1)
    assert worst[2] < CLOSE * max(10 * step, 1.0)


def test_ten_thousand_random_samples_err_by_four_ulp_at_most() -> None:
    """Every component of the orientation against 50 digits; steps of all sizes, each its own curve."""
    rng = np.random.default_rng(11)
    worst = 0.0
    for degrees in 10.0 ** rng.uniform(-6.0, np.log10(179.0), 500):
        frames = qs.QuarticSpline(
            None, walk(5, degrees, seed=int(rng.integers(1 << 30)))
        ).quaternions
        curve = qs.QuarticSpline(None, frames)
        i, u = int(rng.integers(1, 5)), rng.integers(0, 1 << 40, 20) / 2.0**40  # exact in t
        q = with_ghosts([unit(x) for x in frames])
        steps = [log(mul(conj(q[i + j - 1]), q[i + j])) for j in range(3)]
        for sample, at in zip(curve(i - 1 + u), u, strict=True):
            product = q[i - 1]
            for j, step in enumerate(steps, 1):
                product = mul(product, exp(times(value(cumulated(j), mp.mpf(at)), step)))
            worst = max(worst, apart(sample, floats(product)))
    assert worst < 1e-15


def precise_hermite(rows: tuple[Vector, Vector], u: Any) -> Any:
    """The quintic with given value, slope and second derivative at both ends."""
    (f0, d0, c0), (f1, d1, c1) = rows
    return (
        f0 * (1 - 10 * u**3 + 15 * u**4 - 6 * u**5)
        + d0 * (u - 6 * u**3 + 8 * u**4 - 3 * u**5)
        + c0 / 2 * (u**2 - 3 * u**3 + 3 * u**4 - u**5)
        + f1 * (10 * u**3 - 15 * u**4 + 6 * u**5)
        + d1 * (-4 * u**3 + 7 * u**4 - 3 * u**5)
        + c1 / 2 * (u**3 - 2 * u**4 + u**5)
    )


def general_segment(q: list[Vector], h: Vector, i: int, u: Any, kappa: int) -> Vector:
    """The extension to spacings h (with those of the ghosts): v_i and a_i spread to exponents."""
    before, own, after = h[i - 1], h[i], h[i + 1]

    def rates(left: Any, right: Any) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
        """(slope, second derivative) at a knot per unit of the step into and out of it."""
        into = (right / left / (left + right), -2 * kappa / (left * (left + right)))
        out = (left / right / (left + right), 2 * kappa / (right * (left + right)))
        return into, out

    (a1, a2), (b1, b2) = rates(before, own)
    (c1, c2), (d1, d2) = rates(own, after)
    zero, one = mp.mpf(0), mp.mpf(1)
    exponents = [
        ((one, own * a1, own**2 * a2), (one, zero, zero)),
        ((zero, own * b1, own**2 * b2), (one, own * c1, own**2 * c2)),
        ((zero, zero, zero), (zero, own * d1, own**2 * d2)),
    ]
    product = q[i - 1]
    for j, rows in enumerate(exponents):
        step = log(mul(conj(q[i + j - 1]), q[i + j]))
        product = mul(product, exp(times(precise_hermite(rows, u), step)))
    return product


@pytest.mark.parametrize("kappa", [3, 1])
def test_arbitrary_knots(kappa: int) -> None:
    """C^2 in 50 digits on uneven knots, and what the schemes evaluate."""
    frames = quaternion.align(random_units(5, 21))
    h = [mp.mpf(x) for x in ("0.625", "0.625", "2.25", "0.5", "1.75", "1.75")]
    q = with_ghosts([unit(row) for row in frames])
    for i in (2, 3, 4):
        for order in (1, 2):
            left, right = (partial(general_segment, q, h, j, kappa=kappa) for j in (i - 1, i))
            before, after = (
                derivatives(left, mp.mpf(1), order),
                derivatives(right, mp.mpf(0), order),
            )
            gap = plus(times(h[i] ** -order, after), times(-(h[i - 1] ** -order), before))
            assert size(gap) < ZERO
    knots = np.concatenate([[0.0], np.cumsum([float(x) for x in h[1:-1]])])
    curve = qs.build("quartic" if kappa == 3 else "quintic", knots, floats_of(q[1:-1]))
    for i, u in itertools.product(range(1, 5), (0.25, 0.625)):
        wanted = floats(general_segment(q, h, i, mp.mpf(u), kappa))
        assert apart(curve(knots[i - 1] + u * float(h[i])), wanted) < 4e-15


def floats_of(q: list[Vector]) -> np.ndarray:
    return np.array([floats(row) for row in q])


# -- golden numbers -----------------------------------------------------------------------------

CASES: dict[str, tuple[str, dict[str, Any]]] = {
    "slerp": ("slerp", {}),
    "nielson_uniform_natural": ("nielson", {}),
    "nielson_nonuniform_natural": ("nielson", {}),
    "nielson_nonuniform_stationary": ("nielson", {"ends": "stationary"}),
    "nielson_nonuniform_natural_nu5": ("nielson", {"tension": 5.0}),
    "nielson_closed": ("nielson", {}),
}


def golden_curve(case: str, **more: Any) -> Any:
    name, options = CASES[case]
    knots = GOLDEN["schemes"][case]["knots"]
    q = [unit(row) for row in GOLDEN["meta"]["raw_keyframes"]]
    return qs.build(name, KNOTS[knots], floats_of(q), closed=knots == "closed", **options, **more)


@pytest.mark.parametrize("case", CASES)
def test_golden_numbers(case: str) -> None:
    iterative = CASES[case][0] == "nielson"
    to_the_end = {"tolerance": 1e-300, "on_failure": "return", "max_iterations": 400}
    curve = golden_curve(case, **(to_the_end if iterative else {}))
    if iterative:
        assert curve.solve_report.residual < 1e-14
    assert_golden(curve, case, (1e-14, 2e-14, 2e-13))


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9])
def test_golden_numbers_within_the_tolerance(tolerance: float) -> None:
    curve = golden_curve("nielson_nonuniform_natural", tolerance=tolerance)
    assert curve.solve_report.converged
    assert curve.solve_report.residual <= tolerance
    entry = GOLDEN["schemes"]["nielson_nonuniform_natural"]["values"][1]
    assert apart(curve(1.2), np.array([float(v) for v in entry["q"]])) < 2 * tolerance


# -- Nielson's iteration, written again ---------------------------------------------------------


def angle(a: np.ndarray, b: np.ndarray) -> float:
    return 2.0 * np.arctan2(np.linalg.norm(a - b), np.linalg.norm(a + b))


def weight(x: float, theta: float) -> float:
    return x if theta < 1e-12 else np.sin(x * theta) / np.sin(theta)


def arc(a: np.ndarray, b: np.ndarray, x: float) -> np.ndarray:
    theta = angle(a, b)
    return weight(1 - x, theta) * a + weight(x, theta) * b


class PlainNielson:
    """The specification's section 7 with loops over plain arrays, Jacobi, stop by change."""

    def __init__(self, t: np.ndarray, q: np.ndarray, sign: float | None, tolerance: float) -> None:
        self.q, self.sign, self.t = q, sign, t
        n = self.n = len(q)
        steps = np.diff(t)
        if sign is None:
            steps = np.concatenate([[steps[0], steps[0]], steps, [steps[-1], steps[-1]]])
            self.h = {i: steps[i + 1] for i in range(-1, n + 2)}
        else:
            self.h = {i: steps[(i - 1) % n] for i in range(-2, n + 3)}
        self.inner = range(1, n - 1) if sign is None else range(n)
        self.d = q.copy()
        for self.iterations in range(1, 3000):
            new = self.d.copy()
            for i in self.inner:
                new[i] = self.update(i)
            change = np.linalg.norm(new - self.d) / np.linalg.norm(new)
            self.d = new
            if change <= tolerance:
                break

    def point(self, i: int) -> np.ndarray:
        around = 1.0 if 0 <= i < self.n else self.sign
        return around * self.d[i % self.n]

    def shares(self, i: int) -> tuple[float, float, float]:
        """lambda, mu, delta for nu = 0, where every gamma is 1."""
        a, b, c, d = (self.h[i + k] for k in (-1, 0, 1, 2))
        return (a + b) / (a + b + c), b / (b + c + d), b / (b + c)

    def sides(self, i: int) -> tuple[np.ndarray, np.ndarray]:
        lam, mu, _ = self.shares(i)
        return (
            arc(self.point(i - 1), self.point(i), lam),
            arc(self.point(i), self.point(i + 1), mu),
        )

    def update(self, i: int) -> np.ndarray:
        lam, mu, delta = self.shares(i)
        left, right = self.sides(i)
        alpha = angle(self.point(i - 1), self.point(i))
        gamma = angle(self.point(i), self.point(i + 1))
        beta = angle(left, right)
        s1, s2 = weight(1 - delta, beta), weight(delta, beta)
        rest = s1 * weight(1 - lam, alpha) * self.point(i - 1)
        rest = rest + s2 * weight(mu, gamma) * self.point(i + 1)
        new = (self.q[i] - rest) / (s1 * weight(lam, alpha) + s2 * weight(1 - mu, gamma))
        return new / np.linalg.norm(new)

    def __call__(self, x: float) -> np.ndarray:
        i = min(int(np.searchsorted(self.t, x, side="right")) - 1, len(self.t) - 2)
        u = (x - self.t[i]) / (self.t[i + 1] - self.t[i])
        first, last = self.key(i), self.key(i + 1)
        right = arc(self.point(i), self.point(i + 1), self.shares(i)[1])
        left = arc(self.point(i), self.point(i + 1), self.shares(i + 1)[0])
        rows = [first, right, left, last]
        while len(rows) > 1:
            rows = [arc(a, b, u) for a, b in itertools.pairwise(rows)]
        return rows[0]

    def key(self, i: int) -> np.ndarray:
        return self.q[i] if i < self.n else self.sign * self.q[0]


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("seed", range(8))
def test_nielson_iterates_as_published(seed: int, closed: bool) -> None:
    """Iteration counts equal, curves equal, on random keyframes."""
    rng = np.random.default_rng(seed)
    q = quaternion.align(walk(7, 30.0 + 10.0 * seed, seed))
    t = np.concatenate([[0.0], np.cumsum(rng.uniform(0.5, 1.5, 6 + closed))])
    sign = (-1.0 if q[-1] @ q[0] < 0 else 1.0) if closed else None
    plain = PlainNielson(t, q, sign, 1e-6)
    curve = qs.build("nielson", t, q, closed=closed, stop="change", on_failure="return")
    assert curve.solve_report.stop == "change"
    assert curve.solve_report.method == "jacobi"
    assert curve.solve_report.iterations == plain.iterations
    for x in np.linspace(t[0], t[-1], 23)[:-1]:
        assert apart(curve(x), plain(x)) < 1e-9


def test_iterations_are_those_of_the_specification() -> None:
    """Medians on open walks of 5 keyframes: 12, 14, 16 at steps of 20, 60, 90 degrees."""
    for degrees, wanted in ((20.0, 12), (60.0, 14), (90.0, 16)):
        q = np.stack([walk(5, degrees, seed) for seed in range(200)], axis=1)
        report = qs.build("nielson", None, q, stop="change", on_failure="return").solve_report
        assert abs(np.median(report.iterations) - wanted) <= 1
