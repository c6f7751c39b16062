"""Curvature energy against closed forms, and its least against elasticas and other curves."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import quatspline as qs
from quatspline import quaternion
from quatspline.instruments.curvature import curvature_energy
from quatspline.instruments.fairness import fairness
from quatspline.instruments.least_curvature import Least, least_curvature
from quatspline.instruments.trials import builder
from quatspline.trajectories.sets import step_sets, torque_sets
from toys import AXIS, Toy, Turn, turned

TIMES = np.array([0.0, 0.7, 2.0, 3.1])


class Path(Toy):
    """A path q(s) on S^3 with two derivatives, run as s(t)."""

    def path(self, s):
        raise NotImplementedError

    def clock(self, t):
        return t, np.ones_like(t), np.zeros_like(t)

    def _orientation(self, t):
        return self.path(self.clock(t)[0])[0]

    def _velocity(self, t):
        s, s1, _ = self.clock(t)
        q, q1, _ = self.path(s)
        return 2.0 * s1[:, None] * quaternion.mul(quaternion.conj(q), q1)[:, 1:]

    def _acceleration(self, t):
        s, s1, s2 = self.clock(t)
        q, q1, q2 = self.path(s)
        moved = q2 * (s1**2)[:, None] + q1 * s2[:, None]
        return 2.0 * quaternion.mul(quaternion.conj(q), moved)[:, 1:]


def along(cls, times=TIMES, **more):
    """A curve of a class of paths; its keyframes shape nothing."""
    blank = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))
    return type("_", (cls,), {"name": "path", **more})(times, blank)


def columns(*parts):
    return np.stack(np.broadcast_arrays(*parts), axis=-1)


class SmallCircle(Path):
    """All points rho from the quaternion 1, in one plane."""

    rho = 0.5

    def path(self, s):
        c, k = math.cos(self.rho), math.sin(self.rho)
        return (
            columns(c, k * np.cos(s), k * np.sin(s), 0.0),
            columns(0.0, -k * np.sin(s), k * np.cos(s), 0.0),
            columns(0.0, -k * np.cos(s), -k * np.sin(s), 0.0),
        )


class Helix(Path):
    """exp(a s) exp(b s): both factors turn at a constant rate."""

    a, b = np.array([0.3, -0.5, 0.7]), np.array([0.6, 0.4, 0.1])

    def path(self, s):
        left, right = (quaternion.exp(s[:, None] * v) for v in (self.a, self.b))
        a, b = np.array([0.0, *self.a]), np.array([0.0, *self.b])
        q = quaternion.mul(left, right)
        q1 = quaternion.mul(a, q) + quaternion.mul(q, b)
        return q, q1, quaternion.mul(a, q1) + quaternion.mul(q1, b)


class Ellipse(Path):
    """An ellipse so small that S^3 is flat there, with half axes of size and size * squeezed."""

    size, squeezed = 1e-6, 0.01

    def path(self, s):
        x, y = self.size * np.cos(s), self.size * self.squeezed * np.sin(s)
        x1, y1 = -self.size * np.sin(s), self.size * self.squeezed * np.cos(s)
        w = np.sqrt(1.0 - x * x - y * y)
        w1 = -(x * x1 + y * y1) / w
        w2 = -(x1 * x1 + y1 * y1 - x * x - y * y + w1 * w1) / w
        o = 0.0 * s
        return columns(w, x, y, o), columns(w1, x1, y1, o), columns(w2, -x, -y, o)


def eased(self, t):
    """A clock that hurries and lingers: s = t + 0.4 sin(2 t) / 2."""
    return t + 0.2 * np.sin(2.0 * t), 1.0 + 0.4 * np.cos(2.0 * t), -0.8 * np.sin(2.0 * t)


# -- curves -------------------------------------------------------------------------------------


class Uneven(Turn):
    """A turn about one axis at any speed but none."""

    def theta(self, t):
        return t + 0.3 * np.sin(3.0 * t), 1.0 + 0.9 * np.cos(3.0 * t), -2.7 * np.sin(3.0 * t)


def test_a_great_circle_does_not_bend():
    assert curvature_energy(turned(Uneven, TIMES)).energy < 1e-25
    assert curvature_energy(builder("local-quintic")(*spin())).energy < 1e-20


def spin():
    return TIMES, quaternion.exp(0.6 * TIMES[:, None] * AXIS)


@pytest.mark.parametrize("rho", [0.01, 0.5, 1.2, math.pi / 2])
def test_a_small_circle_bends_by_the_cotangent_of_its_radius(rho):
    """kappa = cot(rho), and its length is sin(rho) times the angle."""
    energy = curvature_energy(along(SmallCircle, rho=rho)).energy
    wanted = math.sin(rho) * TIMES[-1] / math.tan(rho) ** 2
    assert energy == pytest.approx(wanted, rel=1e-12, abs=1e-20)


def test_a_helix_bends_evenly():
    """Its speed in log units is |a + b| turned, v^2 = a^2 + b^2 + 2 a.b, and kappa = 2 |a x b| / v^2."""
    a, b = Helix.a, Helix.b
    squared = a @ a + b @ b + 2.0 * a @ b
    kappa = 2.0 * np.linalg.norm(np.cross(a, b)) / squared
    wanted = kappa**2 * math.sqrt(squared) * TIMES[-1]
    assert curvature_energy(along(Helix)).energy == pytest.approx(wanted, rel=1e-10)


@pytest.mark.parametrize("path", [SmallCircle, Helix])
def test_it_does_not_matter_how_fast_a_path_is_run(path):
    times = np.array([0.0, 1.0, 0.5 * math.pi, math.pi])
    even = curvature_energy(along(path, times)).energy
    assert curvature_energy(along(path, times, clock=eased)).energy == pytest.approx(even, rel=1e-7)


@pytest.mark.parametrize("squeezed", [0.3, 0.01, 1e-3])
def test_sharp_bends_inside_a_segment_are_resolved(squeezed):
    """integral of e^2 / (sin^2 + e^2 cos^2)^(5/2) over the size, with its peaks at the ends of the long axis."""
    times = np.array([-0.9, 1.2, 4.4])
    ends = [*np.linspace(-0.9, 1.2, 5), *np.linspace(2.0, 4.4, 4)]
    peaks = sorted(
        [*ends, *(c + d for c in (0.0, math.pi) for d in (-3 * squeezed, 0, 3 * squeezed))]
    )

    def kappa(t):
        return squeezed**2 / (math.sin(t) ** 2 + squeezed**2 * math.cos(t) ** 2) ** 2.5

    wanted = sum(quad(kappa, *part, epsabs=0.0, limit=200)[0] for part in pairwise(peaks))
    curve = along(Ellipse, times, squeezed=squeezed)
    # Times begin at the first keyframe for a scheme.
    curve.clock = lambda t: (t - 0.9, np.ones_like(t), np.zeros_like(t))
    assert curvature_energy(curve).energy == pytest.approx(wanted / Ellipse.size, rel=1e-6)


def test_the_fallback_of_a_library_agrees():
    """A curve known by its orientations alone."""
    whole = along(SmallCircle)
    known = along(SmallCircle, peer="numpy")
    known.clock = whole.clock
    assert curvature_energy(known).energy == pytest.approx(curvature_energy(whole).energy, rel=1e-6)


@pytest.mark.parametrize("at", [0.7, 1.3, 0.0, 3.1])
def test_a_stop_is_infinite_and_said(at):
    """At a keyframe, inside a segment, and at either end."""

    def halting(self, t):
        x = t - at
        return x**3, 3.0 * x**2, 6.0 * x

    bent = curvature_energy(along(Helix, clock=halting))
    assert math.isinf(bent.energy)
    assert bent.reason == f"the curve stops at t = {at:g}"


def test_turning_back_on_the_spot_is_a_stop():
    class Back(Turn):
        def theta(self, t):
            return (t - 1.3) ** 2, 2.0 * (t - 1.3), 2.0 + 0.0 * t

    bent = curvature_energy(turned(Back, TIMES))
    assert (math.isinf(bent.energy), bent.reason) == (True, "the curve stops at t = 1.3")


def test_rest_is_infinite_and_no_nan():
    still = np.tile([0.6, 0.0, 0.8, 0.0], (4, 1))
    bent = curvature_energy(qs.build("local-quintic", TIMES, still))
    assert (math.isinf(bent.energy), bent.reason) == (True, "the curve rests")


def test_a_curve_that_slows_down_is_no_stop():
    def slow(self, t):
        x = t - 1.3
        return x**3 + 1e-3 * x, 3.0 * x**2 + 1e-3, 6.0 * x

    bent = curvature_energy(along(Helix, clock=slow))
    lengths = [1.8**3 + 1.8e-3, 1.3**3 + 1.3e-3]
    a, b = Helix.a, Helix.b
    squared = a @ a + b @ b + 2.0 * a @ b
    kappa = 2.0 * np.linalg.norm(np.cross(a, b)) / squared
    assert bent.reason is None
    assert bent.energy == pytest.approx(kappa**2 * math.sqrt(squared) * sum(lengths), rel=1e-6)


# -- the least ----------------------------------------------------------------------------------


def least(times, keyframes, longest=None) -> Least:
    curve = builder("min-torque", 1e-9)(times, keyframes)
    return least_curvature(curve, longest or 0.5 * fairness(curve)["length"])


def test_keyframes_on_a_great_circle_need_no_bend():
    found = least(*spin())
    assert found.settled
    assert abs(found.energy) < 1e-10


def elastica(turn: float) -> tuple[float, float]:
    """Energy times chord of the free elastica through three points, equal chords with a turn between.

    Either half begins without curvature; its length being free, kappa^2 = 2 F sin(psi) with psi the
    tangent's angle from the beginning, so that with F = 1 all follows from the last psi.
    """

    def half(end):
        energy = quad(lambda psi: math.sqrt(2.0 * math.sin(psi)), 0.0, end)[0]
        across = energy / 2.0  # integral of sin / sqrt(2 sin)
        along = math.sqrt(2.0 * math.sin(end))
        return energy, math.hypot(along, across), end - math.atan2(across, along)

    end = brentq(lambda psi: half(psi)[2] - 0.5 * turn, 1e-6, 0.5 * math.pi)
    energy, chord, _ = half(end)
    return 2.0 * energy * chord, end


@pytest.mark.parametrize("degrees", [20.0, 60.0, 100.0])
@pytest.mark.parametrize("size", [1e-4, 1e-2])
def test_three_keyframes_close_together_are_met_by_an_elastica(degrees, size):
    """Where S^3 is flat, and where the path may be as long as it likes."""
    half = 0.5 * math.radians(degrees)
    points = size * np.array(
        [[0, 0, 0], [math.cos(half), math.sin(half), 0], [2.0 * math.cos(half), 0, 0]]
    )
    keyframes = quaternion.mul([0.5, -0.5, 0.5, 0.5], quaternion.exp(points))
    found = least(np.array([0.0, 1.0, 2.0]), keyframes, longest=3.0 * size)
    assert found.settled
    assert found.length < 2.5 * size
    assert found.energy * size == pytest.approx(elastica(math.radians(degrees))[0], rel=3e-4)


SETS = [(t, q) for t, q, _ in torque_sets(4)] + step_sets(10, 2) + step_sets(170, 2)


@pytest.mark.parametrize("index", range(len(SETS)))
def test_no_curve_that_is_not_longer_bends_less(index):
    times, keyframes = SETS[index]
    reference = builder("min-torque", 1e-9)(times, keyframes)
    longest = 0.5 * fairness(reference)["length"]
    found = least_curvature(reference, longest)
    assert found.settled
    assert found.length < longest * (1.0 + 1e-8)
    tried = 0
    for name in ("min-torque", "local-quintic", "kim", "hermite", "squad", "quartic", "nielson"):
        curve = builder(name, 1e-9)(times, keyframes)
        if 0.5 * fairness(curve)["length"] <= longest * (1.0 + 1e-9):
            tried += 1
            assert curvature_energy(curve).energy > found.energy * (1.0 - 1e-4), name
    assert tried > 1


def test_a_longer_path_may_bend_less():
    times, keyframes = SETS[3]
    energies = [least(times, keyframes, longest).energy for longest in (2.5, 2.615, 2.8, 3.2)]
    assert np.all(np.diff(energies) < 0.0)


def test_without_a_bound_the_path_winds_round_great_circles():
    """Steps of 10 degrees in random directions, half of it on S^3: the path is a full turn longer."""
    times, keyframes = step_sets(10, 1)[0]
    bounded, free = least(times, keyframes), least(times, keyframes, longest=60.0)
    assert bounded.length < 1.0
    assert free.length > 2.0 * math.pi
    assert free.energy < 0.25 * bounded.energy


def test_frames_and_the_direction_of_time_do_not_matter():
    times, keyframes = SETS[1]
    p, r = (np.array([0.5, -0.1, 0.7, 0.5]), np.array([0.1, 0.9, -0.3, 0.3]))
    p, r = quaternion.normalise(p), quaternion.normalise(r)
    turned_frames = quaternion.mul(quaternion.mul(p, keyframes), r)
    energies = [
        least(times, keyframes).energy,
        least(times, turned_frames).energy,
        least(times[-1] - times[::-1], keyframes[::-1]).energy,
    ]
    np.testing.assert_allclose(energies, energies[0], rtol=1e-5)


def test_closed_curves_and_several_tracks_are_refused():
    times, keyframes = SETS[0]
    closed = qs.build("kim", np.append(times, times[-1] + 1.0), keyframes, closed=True)
    tracks = qs.build("kim", times, np.stack([keyframes, keyframes], axis=1))
    for curve in (closed, tracks):
        with pytest.raises(ValueError, match="the least curvature is that of one open curve"):
            least_curvature(curve, 1.0)
