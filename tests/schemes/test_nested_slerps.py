"""Slerp's relatives and the nested slerps: squad, slerp-Bezier, Kochanek-Bartels, Barry-Goldman."""

from __future__ import annotations

import math

import numpy as np
import pytest

import quatspline as qs
from golden import GOLDEN, KNOTS, Q, assert_golden
from quatspline import quaternion, stencil
from quatspline.families import chords, nested
from quatspline.kernels.values import Quat

ENTRIES = {
    "slerp": ("slerp", {}),
    "nlerp": ("nlerp", {}),
    "squad_textbook": ("squad", {"inner": "textbook"}),
    "squad_single_a": ("squad", {"inner": "single-a"}),
    "squad_two_a_secant_ends": ("squad", {"ends": "secant"}),
    "shoemake85_third_uniform": ("shoemake-bezier", {}),
    "catmull_rom_slerp_bezier_chart_ends": ("catmull-rom", {}),
    "kochanek_bartels_T.3_C.1_B.2_secant_ends": (
        "kochanek-bartels",
        {"tension": 0.3, "continuity": 0.1, "bias": 0.2, "ends": "secant"},
    ),
    "barry_goldman_reflected_ends": ("barry-goldman", {}),
}

SCHEMES = {
    "nlerp": 0,
    "fast-slerp": 0,
    "incremental-slerp": 0,
    "squad": 1,
    "shoemake-bezier": 1,
    "catmull-rom": 1,
    "kochanek-bartels": 1,
    "barry-goldman": 1,
}
"""Every scheme of this file and its continuity."""

T = KNOTS["nonuniform"]
NEAR = 1e-9
"""Distance of one-sided samples from a knot: smooth rates move less than `SMOOTH` within it."""
SMOOTH = 1e-6


def angle(a, b):
    """Rotation angle between quaternions on S^3, signs kept, to rounding even when tiny."""
    return 2.0 * np.linalg.norm(quaternion.log(quaternion.mul(quaternion.conj(a), b)), axis=-1)


def walk(count, degrees, seed=5):
    """Keyframes with random axes and steps of one size."""
    rng = np.random.default_rng(seed)
    axes = rng.normal(size=(count - 1, 3))
    axes *= math.radians(degrees) / 2.0 / np.linalg.norm(axes, axis=1, keepdims=True)
    q = [np.array([1.0, 0.0, 0.0, 0.0])]
    for step in quaternion.exp(axes):
        q.append(quaternion.mul(q[-1], step))
    return np.array(q)


def jump(curve, knots, order):
    """The largest one-sided jump of an order at the knots."""
    knots = np.asarray(knots)
    return np.linalg.norm(curve(knots + NEAR, order) - curve(knots - NEAR, order), axis=-1).max()


def odd_loop():
    """Seven keyframes that return after one full turn, on S^3 with the sign -1."""
    angles = np.arange(7) * math.pi / 7.0
    tilt = quaternion.exp(0.2 * np.random.default_rng(3).normal(size=(7, 3)))
    return quaternion.mul(quaternion.exp(np.outer(angles, [0.0, 0.6, 0.8])), tilt)


@pytest.mark.parametrize("entry", ENTRIES)
def test_golden(entry):
    name, options = ENTRIES[entry]
    curve = qs.build(name, KNOTS[GOLDEN["schemes"][entry]["knots"]], Q, **options)
    assert_golden(curve, entry, (1e-12, 1e-12, 1e-10))


def test_golden_tangents_of_catmull_rom():
    golden = GOLDEN["schemes"]["catmull_rom_slerp_bezier_chart_ends"]
    curve = qs.build("catmull-rom", KNOTS[golden["knots"]], Q)
    expected = 2.0 * np.array(golden["v"], dtype=float)
    np.testing.assert_allclose(curve(curve.times, 1), expected, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize("closing", ["open", "closed", "odd"])
def test_rates_are_derivatives_and_knots_join(name, closing):
    closed = closing != "open"
    q = odd_loop() if closing == "odd" else Q
    h = np.ones(len(q) - (not closed))
    if qs.scheme(name).non_uniform:
        h *= np.random.default_rng(2).uniform(0.6, 1.6, h.size)
    times = 10.0 + np.concatenate([[0.0], np.cumsum(h)])
    curve = qs.build(name, times, q, closed=closed)
    period = times[-1] - times[0]
    t = np.linspace(times[0], times[-1], 203)[1:-1]
    velocity, acceleration = stencil.rates(
        lambda s: curve(s + times[0]), t - times[0], times - times[0]
    )
    np.testing.assert_allclose(curve(t, 1), velocity, atol=1e-8)
    np.testing.assert_allclose(curve(t, 2), acceleration, atol=2e-5)
    np.testing.assert_allclose(np.linalg.norm(curve(t), axis=-1), 1.0, atol=1e-14)
    np.testing.assert_allclose(curve(times[: len(q)]), curve.quaternions, atol=1e-12)
    if closed:
        sign = -1.0 if closing == "odd" else 1.0
        np.testing.assert_allclose(curve(t + period), sign * curve(t), atol=1e-12)
    knots = times[:-1] + period if closed else times[1:-1]
    assert jump(curve, knots, 0) < SMOOTH
    assert (jump(curve, knots, 1) < SMOOTH) == (SCHEMES[name] == 1)
    assert jump(curve, knots, SCHEMES[name] + 1) > 0.01


@pytest.mark.parametrize("name", SCHEMES)
def test_tracks_are_fitted_apart(name):
    tracks = np.stack([walk(6, 70, seed) for seed in range(4)], axis=1).reshape(6, 2, 2, 4)
    curve = qs.build(name, None, tracks)
    t = np.linspace(0.0, 5.0, 17)
    single = qs.build(name, None, tracks[:, 1, 0])
    for order in (0, 1, 2):
        np.testing.assert_array_equal(curve(t, order)[:, 1, 0], single(t, order))


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("count", [2, 3])
def test_few_keyframes(name, count, closed):
    q = Q[:count]
    curve = qs.build(name, None, q, closed=closed)
    t = np.linspace(*curve.domain, 50)
    assert all(np.isfinite(curve(t, order)).all() for order in (0, 1, 2))
    np.testing.assert_allclose(curve(np.arange(count)), q, atol=1e-13)
    if count == 2 and not closed and name not in ("nlerp", "fast-slerp", "shoemake-bezier"):
        np.testing.assert_allclose(curve(t), qs.build("slerp", None, q)(t), atol=1e-13)


@pytest.mark.parametrize("name", [n for n in SCHEMES if n not in ("nlerp", "fast-slerp")])
@pytest.mark.parametrize("degrees", [30.0, 110.0, 170.0])
def test_a_constant_spin_stays_constant(name, degrees):
    uniform = not qs.scheme(name).non_uniform
    times = np.arange(7.0) if uniform else np.array([0.0, 1.0, 1.5, 2.4, 3.2, 3.3, 4.1])
    rate = math.radians(degrees) / np.diff(times).max()
    axis = np.array([2.0, -1.0, 2.0]) / 3.0
    q = quaternion.mul(Q[2], quaternion.exp(np.outer(times, 0.5 * rate * axis)))
    curve = qs.build(name, times, q)
    inside = int(qs.scheme(name).constant_rate == "interior")
    t = np.linspace(times[inside], times[-1 - inside], 97)[:-1]
    np.testing.assert_allclose(curve(t, 1), np.tile(rate * axis, (96, 1)), atol=1e-9)


@pytest.mark.parametrize("name", SCHEMES)
def test_equal_keyframes_are_rest(name):
    curve = qs.build(name, None, np.tile(Q[1], (5, 1)))
    t = np.linspace(0.0, 4.0, 33)
    np.testing.assert_allclose(curve(t), np.tile(Q[1], (33, 1)), atol=1e-15)
    assert np.abs(curve(t, 1)).max() < 1e-13
    assert np.abs(curve(t, 2)).max() < 1e-13


@pytest.mark.parametrize("name", SCHEMES)
def test_interior_order(name):
    """Errors on the middle of a smooth motion fall with the claimed order."""

    def motion(t):
        a = [0.8 * np.sin(1.1 * t), 0.6 * np.cos(0.7 * t + 0.3), 0.5 * np.sin(1.7 * t + 1.0)]
        a = np.stack(a, axis=-1)
        b = np.stack([0.3 * t, 0.0 * t, 0.2 * np.cos(t)], -1)
        return quaternion.mul(quaternion.exp(a), quaternion.exp(b))

    t = np.linspace(3.0, 7.0, 1601)
    errors = []
    for count in (81, 161):
        times = np.linspace(0.0, 10.0, count)
        errors.append(quaternion.distance(qs.build(name, times, motion(times))(t), motion(t)).max())
    assert math.log2(errors[0] / errors[1]) == pytest.approx(qs.scheme(name).order, abs=0.2)


def test_the_sine_form_of_slerp_is_the_power_form():
    q = walk(40, 150.0)
    curve = qs.build("slerp", None, q)
    t = np.linspace(0.0, 39.0, 2000)[:-1]
    i = t.astype(int)
    a, b, u = curve.quaternions[i], curve.quaternions[i + 1], (t - i)[:, None]
    np.testing.assert_allclose(curve(t), quaternion.slerp(a, b, t - i), atol=4e-16)
    theta = 2.0 * np.arctan2(np.linalg.norm(a - b, axis=1), np.linalg.norm(a + b, axis=1))[:, None]
    sines = (np.sin((1.0 - u) * theta) * a + np.sin(u * theta) * b) / np.sin(theta)
    np.testing.assert_allclose(curve(t), sines, atol=1e-15)


def test_slerp_against_scipy():
    transform = pytest.importorskip("scipy.spatial.transform")
    rotations = transform.Rotation.from_quat(Q, scalar_first=True)
    t = np.linspace(0.0, 4.0, 301)
    expected = transform.Slerp(T, rotations)(t)
    ours = qs.build("slerp", T, rotations).rotation(t)
    assert (expected * ours.inv()).magnitude().max() < 1e-14


def test_nlerp_runs_slerps_arcs_at_uneven_speed():
    q = walk(2, 120.0)
    curve, arc = qs.build("nlerp", None, q), qs.build("slerp", None, q)
    theta = math.radians(60.0)
    speeds = np.linalg.norm(curve([0.0, 0.5, 1.0], 1), axis=1)
    shape = np.array([1.0, 2.0 / (1.0 + math.cos(theta)), 1.0])
    np.testing.assert_allclose(speeds, 2.0 * math.sin(theta) * shape)
    assert angle(curve(0.5), arc(0.5)) < 1e-15


def test_fast_slerp_falls_with_terms():
    q = walk(30, 179.9)
    arc = qs.build("slerp", None, q)
    t = np.linspace(0.0, 29.0, 3001)
    errors = []
    for terms in (1, 2, 4, 8, 16, 32):
        curve = qs.build("fast-slerp", None, q, terms=terms)
        errors.append(angle(arc(t), curve(t)).max())
        assert 0.8 * curve.angle_error < errors[-1] < 1.01 * curve.angle_error + 1e-14
    assert (np.diff(np.log10(errors)) < -0.3).all()
    assert errors[3] < 2e-5
    assert errors[5] < 1e-12


def test_fast_slerp_corrects_its_last_term_as_eberly_does():
    curve = qs.build("fast-slerp", None, Q)
    last = curve.segments[0, 0, chords.SIZE + 1]
    assert last == pytest.approx(1.85298109240830, abs=1e-7)  # the constant of eberly2011, 8 terms


def test_incremental_slerp_drifts_with_steps():
    q = walk(21, 90.0)
    arc = qs.build("slerp", None, q)
    t = np.linspace(0.0, 20.0, 40001)
    drift = [
        angle(arc(t), qs.build("incremental-slerp", None, q, steps=m)(t)).max()
        for m in (1, 8, 64, 512, 4096)
    ]
    assert drift[0] < 1e-14
    assert (np.diff(drift) > 0.0).all()
    assert 1e-14 < drift[2] < 1e-11
    assert 1e-11 < drift[4] < 1e-7


def test_incremental_slerp_passes_the_points_of_its_recurrence():
    curve = qs.build("incremental-slerp", [0.0, 2.0], Q[:2], steps=5)
    p = [Q[0], quaternion.slerp(Q[0], Q[1], 0.2)]
    for _ in range(4):
        p.append(2.0 * (p[0] @ p[1]) * p[-1] - p[-2])
    np.testing.assert_allclose(curve(np.linspace(0.0, 2.0, 6)), quaternion.normalise(p), atol=1e-14)


SQUADS = [
    # inner, knots, continuity and order on the instance, measured jump of omega
    ("two-a", "uniform", 1, 3, 0.0),
    ("two-a", "nonuniform", 1, 3, 0.0),
    ("single-a", "nonuniform", 1, 3, 0.0),
    ("textbook", "uniform", 1, 3, 0.0),
    ("textbook", "nonuniform", 0, 1, 0.81),
]


@pytest.mark.parametrize(("inner", "knots", "continuity", "order", "size"), SQUADS)
def test_squad_variants(inner, knots, continuity, order, size):
    curve = qs.build("squad", KNOTS[knots], Q, inner=inner)
    assert (curve.continuity, curve.order) == (continuity, order)
    assert jump(curve, KNOTS[knots][1:-1], 1) == pytest.approx(size, abs=0.01 if size else SMOOTH)
    assert qs.scheme("squad").continuity == 1


def test_squads_agree_on_uniform_knots():
    t = np.linspace(0.0, 4.0, 101)
    curves = [
        qs.build("squad", None, Q, inner=inner, ends="secant")(t)
        for inner in ("two-a", "single-a", "textbook")
    ]
    np.testing.assert_allclose(curves[1], curves[0], atol=1e-14)
    np.testing.assert_allclose(curves[2], curves[0], atol=1e-14)


@pytest.mark.parametrize("inner", ["two-a", "single-a", "textbook"])
def test_squad_ends(inner):
    """Secant ends: inner point a_0 = q_0, velocity s_0; chart ends: the parabola's velocity."""
    secant = qs.build("squad", T, Q, inner=inner, ends="secant")
    first = 2.0 * quaternion.log(quaternion.mul(quaternion.conj(Q[0]), Q[1])) / 0.7
    np.testing.assert_allclose(secant(0.0, 1), first, atol=1e-14)
    chart = qs.build("squad", T, Q, inner=inner, ends="chart")
    bezier = qs.build("catmull-rom", T, Q, ends="chart")
    np.testing.assert_allclose(chart(0.0, 1), bezier(0.0, 1), atol=1e-14)
    np.testing.assert_allclose(chart(4.0, 1), bezier(4.0, 1), atol=1e-13)


def test_barry_goldman_has_the_velocities_of_catmull_rom():
    times = T
    pyramid, bezier = qs.build("barry-goldman", times, Q), qs.build("catmull-rom", times, Q)
    np.testing.assert_allclose(pyramid(times[1:-1], 1), bezier(times[1:-1], 1), atol=1e-13)


def test_kochanek_bartels_plain_is_catmull_rom():
    for closed, knots in ((False, "nonuniform"), (True, "closed")):
        plain = qs.build("kochanek-bartels", KNOTS[knots], Q, closed=closed)
        other = qs.build("catmull-rom", KNOTS[knots], Q, closed=closed)
        np.testing.assert_array_equal(plain(np.linspace(0, 4, 50)), other(np.linspace(0, 4, 50)))


@pytest.mark.parametrize(
    ("options", "continuity", "order", "constant"),
    [
        ({"continuity": 0.4}, 0, 2, "no"),
        ({"continuity": [9.0, 0.0, 0.0, 0.0, 9.0]}, 1, 3, "everywhere"),  # the ends have none
        ({"bias": [0.0, 0.0, 0.5, 0.0, 0.0]}, 1, 2, "no"),
        ({"tension": 0.2}, 1, 1, "no"),
        ({"bias": 0.2, "continuity": 0.1}, 0, 1, "no"),
    ],
)
def test_kochanek_bartels_claims_follow_its_options(options, continuity, order, constant):
    times = T
    curve = qs.build("kochanek-bartels", times, Q, **options)
    assert (curve.continuity, curve.order, curve.constant_rate) == (continuity, order, constant)
    assert (jump(curve, times[1:-1], 1) < SMOOTH) == (continuity == 1)
    assert qs.scheme("kochanek-bartels").continuity == 1
    spin = quaternion.exp(np.outer(times, [0.3, 0.2, -0.1]))
    rates = qs.build("kochanek-bartels", times, spin, **options)(np.linspace(0, 4, 60), 1)
    steady = np.abs(rates - [0.6, 0.4, -0.2]).max() < 1e-12
    assert steady == (constant == "everywhere")


def test_bias_and_continuity_keep_a_constant_spin_on_uniform_knots():
    spin = quaternion.exp(np.outer(np.arange(5.0), [0.3, 0.2, -0.1]))
    for options in ({"bias": 0.4}, {"continuity": -0.3}):
        curve = qs.build("kochanek-bartels", None, spin, **options)
        assert curve.constant_rate == "everywhere"
        rates = curve(np.linspace(0, 4, 60), 1)
        np.testing.assert_allclose(rates, np.tile([0.6, 0.4, -0.2], (60, 1)), atol=1e-12)


def test_full_tension_stops_at_keyframes():
    curve = qs.build("kochanek-bartels", T, Q, tension=1.0)
    assert np.abs(curve(T[1:-1], 1)).max() < 1e-13


def test_shoemake_bezier_handles_and_ends():
    third, whole = (qs.build("shoemake-bezier", None, Q, handle=h) for h in ("third", "whole"))
    np.testing.assert_allclose(whole([1, 2, 3], 1), 3.0 * third([1, 2, 3], 1), atol=1e-12)
    assert (whole.order, whole.constant_rate) == (1, "no")
    assert np.abs(third([0, 4], 1)).max() < 1e-14
    ends = qs.build("shoemake-bezier", None, Q, ends="chart")
    np.testing.assert_allclose(ends(0.0, 1), qs.build("catmull-rom", None, Q)(0.0, 1), atol=1e-14)
    assert ends.constant_rate == "everywhere"
    with pytest.raises(ValueError, match="uniform"):
        qs.build("shoemake-bezier", T, Q)


PEERS = {
    "CatmullRom": "catmull-rom",
    "KochanekBartels": "kochanek-bartels",
    "BarryGoldman": "barry-goldman",
}


@pytest.mark.peers
@pytest.mark.parametrize("name", PEERS)
def test_against_splines(name):
    """The package `splines` 0.3.3 on interior segments of a non-uniform grid."""
    peer = pytest.importorskip("splines.quaternion")
    q, h = walk(9, 80.0), np.random.default_rng(8).uniform(0.5, 1.7, 8)
    grid = np.concatenate([[0.0], np.cumsum(h)])
    rotations = [peer.UnitQuaternion.from_unit_xyzw((*p[1:], p[0])) for p in q]
    key = PEERS[name]
    given, ours = {}, {}
    if name == "KochanekBartels":
        given = {"tcb": (0.3, 0.1, 0.2)}
        ours = {"tension": 0.3, "continuity": 0.1, "bias": 0.2}
    # theirs is always closed: one more time
    knots = [*grid, grid[-1] + 1.0] if name == "BarryGoldman" else list(grid)
    theirs = getattr(peer, name)(rotations, knots, **given)
    t = np.linspace(grid[1], grid[-2], 101)[1:-1]
    expected = np.array([theirs.evaluate(float(s)).wxyz for s in t])
    np.testing.assert_allclose(angle(qs.build(key, grid, q, **ours)(t), expected), 0.0, atol=1e-12)


@pytest.mark.parametrize(
    "z", [0.0, 1e-30, 1e-8, 0.3, nested.FAR - 1e-9, nested.FAR + 1e-9, 5.0, 9.8, 60.0]
)
def test_sinc_jet(z):
    """sin(sqrt z)/sqrt z and its derivatives, polynomials and closed forms."""
    mp = pytest.importorskip("mpmath")
    with mp.workdps(40):
        for order, found in enumerate(nested.sinc_jet(z)):
            # sigma^(k) = sum over m of (-1)^m m!/(m - k)! z^(m - k)/(2m + 1)!
            expected = mp.nsum(
                lambda m, k=order: (
                    (-1) ** int(m) * mp.ff(m, k) * mp.mpf(z) ** (m - k) / mp.factorial(2 * m + 1)
                ),
                [order, 80],
            )
            assert found == pytest.approx(float(expected), rel=1e-13, abs=1e-16)


@pytest.mark.parametrize("gap", [1e-9, 1e-4, 0.3, 1.2, 1.49, 1.51, 2.5, 3.0])
def test_slerp_jet(gap):
    """The 2-jet of a slerp whose ends move, the given angle apart, against 40-digit derivatives."""
    mp = pytest.importorskip("mpmath")
    frame = np.linalg.qr(np.random.default_rng(6).normal(size=(4, 4)))[0]

    def arc(first, second, rate, phase, x, lib):
        c, s = lib.cos(rate * x + phase), lib.sin(rate * x + phase)
        return [c * float(p) + s * float(q) for p, q in zip(first, second, strict=True)]

    def ends(x, lib):
        a = arc(frame[0], frame[1], 0.7, 0.0, x, lib)
        b = arc(frame[0], 0.8 * frame[1] + 0.6 * frame[2], 0.9, gap, x, lib)
        return a, b, 0.4 + 0.3 * x + 0.5 * x * x

    def point(x, i):
        a, b, u = ends(x, mp)
        minus = mp.sqrt(mp.fsum((p - q) ** 2 for p, q in zip(a, b, strict=True)))
        plus = mp.sqrt(mp.fsum((p + q) ** 2 for p, q in zip(a, b, strict=True)))
        theta = 2 * mp.atan2(minus, plus)
        return (mp.sin((1 - u) * theta) * a[i] + mp.sin(u * theta) * b[i]) / mp.sin(theta)

    jets = []
    for rate, phase, second in ((0.7, 0.0, frame[1]), (0.9, gap, 0.8 * frame[1] + 0.6 * frame[2])):
        p = arc(frame[0], second, 1.0, phase, 0.0, math)
        turned = arc(second, -frame[0], 1.0, phase, 0.0, math)
        p, turned = Quat(*p), Quat(*turned)
        jets.append((p, rate * turned, -rate * rate * p))
    found = nested.slerp_jet(*jets, (0.4, 0.3, 1.0))
    tolerance = 1e-13 / math.sin(gap) ** 2 if gap > 1.0 else 1e-13
    with mp.workdps(40):
        for order in (0, 1, 2):
            expected = [
                float(
                    mp.diff(lambda x, i=i: point(x, i), 0, order) if order else point(mp.mpf(0), i)
                )
                for i in range(4)
            ]
            np.testing.assert_allclose(found[order], expected, rtol=0.0, atol=tolerance)


@pytest.mark.parametrize("name", ["squad", "catmull-rom", "barry-goldman"])
@pytest.mark.parametrize("size", [1e-3, 1e-8, 1e-15])
def test_small_motions_keep_their_digits(name, size):
    """Keyframes scaled towards one point: the curve tends to its flat limit."""
    v = np.random.default_rng(4).normal(size=(6, 3))

    def scaled(s):
        curve = qs.build(name, None, quaternion.exp(s * v))
        return [curve(np.linspace(0.0, 5.0, 41), order) / s for order in (1, 2)]

    for rate, flat in zip(scaled(size), scaled(1e-12), strict=True):
        np.testing.assert_allclose(rate, flat, atol=max(1e-9, 50.0 * size))
