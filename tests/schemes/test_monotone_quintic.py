"""The monotone quintic: golden numbers, holds, one axis, continuous dependence, reversal, order."""

import numpy as np
import pytest

import quatspline as qs
from golden import assert_golden_new, new_entries
from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.fitting.monotone_rates import interval, monotone
from quatspline.instruments.fairness import fairness
from quatspline.kernels.values import Vec
from quatspline.quaternion import FloatArray
from quatspline.trajectories.sets import torque_sets
from quatspline.trajectories.smooth import tumble
from walks import apart, uneven, walk

NAME, STILL, OVERSHOOTS = "monotone-quintic", 1e-12, ["none", "limited"]


@pytest.mark.parametrize("entry", new_entries("monotone "))
def test_golden_numbers(entry: str) -> None:
    assert_golden_new(NAME, entry, overshoot=entry.split("overshoot=")[1].split()[0])


def test_an_unknown_overshoot_is_refused_in_one_sentence() -> None:
    with pytest.raises(ValueError, match=r"^overshoot='some': expected one of 'none', 'limited'$"):
        qs.build(NAME, None, walk(4, 30.0), overshoot="some")


# -- holds ----------------------------------------------------------------------------------------


def held(rng: np.random.Generator, count: int, tracks: int) -> tuple[FloatArray, FloatArray]:
    """Times of ratios up to 1e3 and keyframes (count, tracks, 4), of which a third repeat the one before."""
    t = np.concatenate([[0.0], np.cumsum(10.0 ** rng.uniform(-1.0, 2.0, count - 1))])
    q = np.empty((count, tracks, 4))
    q[0] = quaternion.normalise(rng.normal(size=(tracks, 4)))
    for i in range(1, count):
        angle = np.radians(rng.uniform(0.0, 179.0, (tracks, 1)))
        angle[rng.uniform(size=tracks) < 1.0 / 3.0] = 0.0
        axis = quaternion.normalise(rng.normal(size=(tracks, 3)))
        q[i] = quaternion.mul(q[i - 1], quaternion.exp(0.5 * angle * axis))
    return t, quaternion.normalise(q)


@pytest.mark.parametrize("overshoot", OVERSHOOTS)
@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("count", [2, 3, 5, 12])
def test_holds_do_not_wander(count: int, closed: bool, overshoot: str) -> None:
    rng = np.random.default_rng([count, closed])
    t, q = held(rng, count, 200)
    end = t[-1] + (t[-1] - t[-2])
    curve = qs.build(
        NAME, np.append(t, end) if closed else t, q, closed=closed, overshoot=overshoot
    )
    q = curve.quaternions
    still = np.linalg.norm(q[1:] - q[:-1], axis=-1) < 1e-15
    assert still.any()
    s = curve.keyframes.inside(np.linspace(0.0, 1.0, 41, endpoint=False)).reshape(-1, 41)
    away = quaternion.distance(curve(s[: count - 1]), q[:-1, None])
    assert away.max(axis=1)[still].max() <= STILL


def test_a_hold_written_with_rounding_stays() -> None:
    """Keyframes that differ by rounding are no hold by name; the curve stays within what they differ."""
    q = walk(6, 80.0)
    q[3] = quaternion.mul(q[2], quaternion.exp([3e-16, -2e-16, 1e-16]))
    curve = qs.build(NAME, [0.0, 1.0, 2.0, 1000.0, 1001.0, 1002.0], q)
    s = np.linspace(2.0, 1000.0, 1001)
    assert quaternion.distance(curve(s), q[2]).max() <= STILL
    assert quaternion.distance(qs.build("local-quintic", curve.times, q)(s), q[2]).max() > 1.0


# -- one axis -------------------------------------------------------------------------------------

AXIS = np.array([2.0, -1.0, 2.0]) / 3.0
SHAPES = {
    "rising": lambda rng, n: np.cumsum(rng.uniform(0.0, 1.0, (n, 500)), axis=0),
    "turning": lambda rng, n: np.cumsum(rng.uniform(-1.5, 1.5, (n, 500)), axis=0),
    "scales": lambda rng, n: np.cumsum(
        rng.choice([-1.0, 0.0, 1.0], (n, 500)) * 10.0 ** rng.uniform(-8.0, 0.17, (n, 500)), axis=0
    ),
    "one way, in scales": lambda rng, n: np.cumsum(10.0 ** rng.uniform(-6.0, 0.17, (n, 500)), 0),
    "noise": lambda rng, n: rng.normal(scale=1e-3, size=(n, 500)),
}
"""Half angles (n, 500) of motions about one axis."""


def times_of(rng: np.random.Generator, count: int, ratio: float) -> FloatArray:
    return np.concatenate([[0.0], np.cumsum(ratio ** rng.uniform(0.0, 1.0, count - 1))])


def progress(curve: Curve, per: int = 33) -> tuple[FloatArray, FloatArray]:
    """Half angles from a segment's start about AXIS (segments, per, K), and those of the steps (segments, K)."""
    h = curve.keyframes.spacings
    s = curve.times[: h.size, None] + h[:, None] * np.linspace(0.0, 1.0, per)
    s[:, -1] = np.nextafter(curve.times[1:], -np.inf)
    q = curve.quaternions
    after = (
        np.concatenate([q[1:], curve.keyframes.signs[:, None] * q[:1]]) if curve.closed else q[1:]
    )
    start = quaternion.conj(q[: h.size])
    along = quaternion.log(quaternion.mul(start[:, None], curve(s))) @ AXIS
    return along, quaternion.log(quaternion.mul(start, after)) @ AXIS


@pytest.mark.parametrize("slack", [0.0, 0.2, 0.5])
@pytest.mark.parametrize("ratio", [1.0, 30.0, 1e4])
@pytest.mark.parametrize("shape", SHAPES)
def test_one_axis_is_monotone(shape: str, ratio: float, slack: float) -> None:
    """500 tracks on each of four knots, open and closed, of 15 shapes and ratios: 3e4 sets of keyframes."""
    for count, closed in ((4, False), (9, False), (7, True), (25, False)):
        rng = np.random.default_rng([list(SHAPES).index(shape), int(ratio), count])
        q = quaternion.exp(SHAPES[shape](rng, count)[..., None] * AXIS)
        t = times_of(rng, count + closed, ratio)
        curve = qs.build(NAME, t, q, closed=closed, slack=slack)
        along, step = progress(curve)
        along, step = along * np.sign(step)[:, None], np.abs(step)
        assert (along - step[:, None]).max() <= STILL  # nothing beyond the end ...
        assert along.min() >= -STILL  # ... or before the start
        assert (np.maximum.accumulate(along, axis=1) - along).max() <= STILL  # and no way back


def test_limited_overshoots_little() -> None:
    rng = np.random.default_rng(8)
    worst = {"none": 0.0, "limited": 0.0}
    for _ in range(10):
        half = SHAPES["turning"](rng, 8)
        t = times_of(rng, 8, 10.0)
        for overshoot in worst:
            q = quaternion.exp(half[..., None] * AXIS)
            along, step = progress(qs.build(NAME, t, q, overshoot=overshoot))
            over = (along * np.sign(step)[:, None]).max(axis=1) - np.abs(step)
            worst[overshoot] = max(worst[overshoot], (over / np.abs(step)).max())
    assert worst["none"] <= 1e-9
    assert 0.1 < worst["limited"] < 0.7


def test_derivatives_of_the_widest_limits_do_not_change_sign() -> None:
    """The rule's proof in numbers: any two ends that keep to (2) of `monotone_rates` make an increasing quintic."""
    rng = np.random.default_rng(3)
    u = np.linspace(0.0, 1.0, 201)
    powers = np.stack([(1 - u) ** 4, 4 * u * (1 - u) ** 3, 6 * u**2 * (1 - u) ** 2])
    basis = np.concatenate([powers, powers[1::-1, ::-1]])
    for slack in (0.0, 0.3, 0.5):
        v = rng.uniform(0.0, 2.5 - 0.5 * slack, (4000, 2))
        low, high = np.vectorize(interval)(v, 1.0, slack)
        bent = np.where(rng.uniform(size=v.shape) < 0.5, low, high)  # corners are the worst
        d = v + bent / 4.0
        middle = 5.0 - v.sum(axis=1) - d.sum(axis=1)
        assert (low <= high + 1e-12).all()
        assert (middle.min() < -0.1) == (slack > 0.0)
        slopes = np.column_stack([v[:, 0], d[:, 0], middle, d[:, 1], v[:, 1]]) @ basis
        assert slopes.min() > -1e-12


def test_one_acceleration_serves_both_sides() -> None:
    """(3) of `monotone_rates` on one axis: whatever the raw rates, both sides' conditions hold."""
    rng = np.random.default_rng(5)
    for _ in range(3000):
        v, a, l0, l1, h0, h1 = 10.0 ** rng.uniform(-1.0, 1.0, 6) * np.append(
            rng.choice((-1.0, 1.0), 2), np.ones(4)
        )
        slack = float(rng.choice((0.0, 0.3, 0.5)))
        steps = Vec(l0, 0.0, 0.0), Vec(l1, 0.0, 0.0)
        v, a = (x.x for x in monotone(Vec(v, 0, 0), Vec(a, 0, 0), *steps, h0, h1, True, slack))
        assert -1e-12 <= v <= (2.5 - 0.5 * slack) * min(l0, l1) + 1e-12
        for pulled, length in ((h1 * a, l1), (-h0 * a, l0)):
            low, high = interval(v, length, slack)
            assert low - 1e-12 * (l0 + l1) <= pulled <= high + 1e-12 * (l0 + l1)


def test_slack_costs_less_torque() -> None:
    costs = []
    for slack in (0.0, 0.5):
        curves = [qs.build(NAME, t, q, slack=slack) for t, q, _ in torque_sets(40)]
        costs.append([fairness(curve)["torque"] for curve in curves])
    smooth = [fairness(qs.build("local-quintic", t, q))["torque"] for t, q, _ in torque_sets(40)]
    even, slack = np.median(np.array(costs) / smooth, axis=1)
    assert 1.0 < slack < 1.015
    assert even - 1.0 > 2.0 * (slack - 1.0)


# -- dependence on keyframes, frames and time -----------------------------------------------------


@pytest.mark.parametrize("overshoot", OVERSHOOTS)
@pytest.mark.parametrize("degrees", [1.0, 60.0, 120.0, 150.0, 175.0])
def test_depends_continuously_on_the_keyframes(degrees: float, overshoot: str) -> None:
    t = uneven(9)
    s = np.linspace(0.0, t[-1], 401)
    for seed in range(20):
        q = walk(9, degrees, seed)
        nudge = quaternion.exp(1e-9 * np.random.default_rng(seed).normal(size=(9, 3)))
        one = qs.build(NAME, t, q, align=False, overshoot=overshoot)
        two = qs.build(NAME, t, quaternion.mul(q, nudge), align=False, overshoot=overshoot)
        assert apart(one(s), two(s)) < 3e-7


def moving(x: FloatArray, path: str) -> FloatArray:
    """Keyframes (7, K, 4) of which the middle one moves with x (K,), through where a rule might jump."""
    q = np.repeat(walk(7, 50.0, seed=4)[:, None], x.size, axis=1)
    zero = np.zeros_like(x)
    if path == "through its neighbour":  # the step vanishes and turns round
        q[3] = quaternion.mul(q[2], quaternion.exp(np.stack([x, 1e-4 + zero, zero], -1)))
    elif path == "through opposition":  # the steps' directions pass through 180 degrees
        back = quaternion.log(quaternion.mul(quaternion.conj(q[2]), q[1]))
        aside = np.cross(back, [0.3, -0.5, 0.8])
        q[3] = quaternion.mul(q[2], quaternion.exp(back + x[:, None] * aside))
    else:  # the whole way round one axis
        q[3] = quaternion.mul(q[2], quaternion.exp(np.stack([zero, zero, 1.5 * x], -1)))
    return q


@pytest.mark.parametrize("overshoot", OVERSHOOTS)
@pytest.mark.parametrize("path", ["through its neighbour", "through opposition", "round one axis"])
def test_no_jump_on_the_way(path: str, overshoot: str) -> None:
    """A Lipschitz bound holds at every scale: no two curves differ by more than so many times their keyframes."""
    for reach in (1.0, 1e-2, 1e-4):
        x = np.linspace(-reach, reach, 401)
        q = moving(x, path)
        curve = qs.build(NAME, uneven(7), q, align=False, overshoot=overshoot)
        s = curve(np.linspace(0.0, curve.times[-1], 121))
        moved = quaternion.distance(s[:, 1:], s[:, :-1]).max(axis=0)
        keys = quaternion.distance(q[3, 1:], q[3, :-1])
        assert (moved / keys).max() < 60.0


@pytest.mark.parametrize("overshoot", OVERSHOOTS)
@pytest.mark.parametrize("count", [2, 3, 5, 12])
def test_reversed_keyframes_have_reversed_rates(count: int, overshoot: str) -> None:
    """On steps and spacings of every size, where limits act on both sides of a keyframe."""
    t, q = held(np.random.default_rng(count), count, 200)
    one = qs.build(NAME, t, q, overshoot=overshoot)
    two = qs.build(NAME, t[-1] - t[::-1], q[::-1], overshoot=overshoot)
    for order, sign in ((1, -1.0), (2, 1.0)):
        rates = one(t, order)
        there = sign * two(two.times, order)[::-1]
        assert np.abs(rates - there).max() < 1e-10 * np.abs(rates).max() + 1e-20


@pytest.mark.parametrize("overshoot", OVERSHOOTS)
def test_equivariant_under_both_frames(overshoot: str) -> None:
    t, q = uneven(9), np.stack([walk(9, 110.0, seed) for seed in range(40)], axis=1)
    base, body = walk(2, 70.0, seed=9)
    s = np.linspace(0.0, t[-1], 201)
    curve = qs.build(NAME, t, q, overshoot=overshoot)
    moved = quaternion.mul(quaternion.mul(base, q), body)
    other = qs.build(NAME, t, moved, overshoot=overshoot)
    wanted = quaternion.mul(quaternion.mul(base, curve(s)), body)
    assert quaternion.distance(other(s), wanted).max() < 1e-11
    assert np.abs(other(s, 1) - quaternion.rotate(quaternion.conj(body), curve(s, 1))).max() < 1e-10


@pytest.mark.parametrize("overshoot", OVERSHOOTS)
@pytest.mark.parametrize("degrees", [5.0, 60.0, 150.0, 175.0])
def test_c2_to_rounding(degrees: float, overshoot: str) -> None:
    t, q = uneven(15), np.stack([walk(15, degrees, seed) for seed in range(10)], axis=1)
    q[7], q[11] = q[6], q[10]
    curve = qs.build(NAME, t, q, overshoot=overshoot)
    scale = max(1.0, np.abs(curve(np.linspace(t[0], t[-1], 301), 2)).max())
    for order in (0, 1, 2):
        at, before = curve(t[1:-1], order), curve(np.nextafter(t[1:-1], 0.0), order)
        assert np.abs(at - before).max() < 1e-12 * scale


# -- order ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("slack", [0.0, 0.5])
@pytest.mark.parametrize("overshoot", OVERSHOOTS)
def test_dense_keyframes_of_a_motion_are_left_alone(overshoot: str, slack: float) -> None:
    """From 81 keyframes on no limit acts: the curve is the local quintic, of order 4."""
    s, errors = np.linspace(3.0, 7.0, 801), []
    for count in (81, 161, 321):
        t = np.linspace(0.0, 10.0, count)
        curve = qs.build(NAME, t, tumble(t), overshoot=overshoot, slack=slack)
        assert np.array_equal(curve(s), qs.build("local-quintic", t, tumble(t))(s))
        errors.append(apart(curve(s), tumble(s)))
    assert np.log2(errors[0] / errors[-1]) / 2 == pytest.approx(4.0, abs=0.15)
    assert (curve.order, curve.support) == (4, 8)


def swing(t: FloatArray) -> FloatArray:
    """A motion that comes to rest at t = 5 and turns back, about one axis."""
    return quaternion.exp(0.4 * np.cos(t - 5.0)[:, None] * AXIS)


def test_order_two_at_rest() -> None:
    """An even number of keyframes: the instant of rest lies between two that are equal."""
    s, errors = np.linspace(4.0, 6.0, 801), []
    for count in (80, 160, 320, 640):
        t = np.linspace(0.0, 10.0, count)
        errors.append(apart(qs.build(NAME, t, swing(t))(s), swing(s)))
    assert np.log2(errors[0] / errors[-1]) / 3 == pytest.approx(2.0, abs=0.1)


def test_long_curves_are_fitted_in_windows() -> None:
    q = np.tile(walk(9, 60.0), (2100, 1))
    q[5::9] = q[4::9]
    curve = qs.build(NAME, None, q)
    assert curve._waiting is not None
    s = np.linspace(9000.0, 9030.0, 301)
    near = slice(8900, 9131)
    short = qs.build(NAME, np.arange(q.shape[0], dtype=float)[near], q[near])
    assert curve._waiting is not None
    assert apart(np.abs(curve(s)), np.abs(short(s))) < 1e-13
