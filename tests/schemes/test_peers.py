"""Third-party schemes: each curve is what a direct call of its library gives, and the facts that
`docs/peers.md` tells of them, each in the smallest case, on the versions installed here.

What a fact's test asserts is a property of a library at a version: a release that changes it makes
the test fail, and then the page is to be rewritten.
"""

from __future__ import annotations

import importlib.metadata
import importlib.util
import warnings

import numpy as np
import pytest

import quatspline as qs
from quatspline import quaternion, stencil
from quatspline.catalogue import version
from quatspline.curve import Curve
from quatspline.instruments.continuity import jumps
from quatspline.peers import installed
from quatspline.peers.splines import reflected
from quatspline.quaternion import FloatArray
from quatspline.system.quiet import quiet
from walks import apart, apart_up_to_sign, inside, loop, spin, uneven, walk

pytestmark = pytest.mark.peers

SAME = 1e-13
"""The library's own numbers, in our form."""
UNEVEN = np.array([0.0, 1.0, 1.3, 3.3, 4.0, 4.2, 6.0])


def needs(module: str) -> pytest.MarkDecorator:
    """Skip where a library is not installed, without importing it."""
    missing = importlib.util.find_spec(module) is None
    return pytest.mark.skipif(missing, reason=f"{module} is not installed")


def random_case(n: int = 8, degrees: float = 70.0, seed: int = 3) -> tuple[FloatArray, FloatArray]:
    return uneven(n), walk(n, degrees, seed)


def both(name: str, closed: bool = False) -> tuple[Curve, FloatArray, FloatArray]:
    """A peer's curve on random data, its keyframes as the library gets them, sample times."""
    times, q = random_case()
    if closed:
        times = uneven(9)
        q = loop(times, 1, wobble=0.5)
    curve = qs.build(name, times + 7.0, q, closed=closed)
    return curve, curve.quaternions, inside(times, 5)


def knots_of(curve: Curve) -> FloatArray:
    return curve.times - curve.times[0]


# -- a direct call gives the same ---------------------------------------------------------------


@needs("scipy")
@pytest.mark.parametrize("name", ["Slerp", "RotationSpline"])
def test_scipy_is_called_directly(name: str) -> None:
    from scipy.spatial import transform

    curve, q, t = both({"Slerp": "scipy-slerp", "RotationSpline": "scipy-rotation-spline"}[name])
    rotations = transform.Rotation.from_quat(q, scalar_first=True)
    direct = getattr(transform, name)(knots_of(curve), rotations)
    assert apart_up_to_sign(curve(t + 7.0), direct(t).as_quat(scalar_first=True)) < SAME
    for order in curve.orders[1:]:
        assert apart(curve(t + 7.0, order), direct(t, order)) < SAME


@needs("splines")
@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("name", ["CatmullRom", "KochanekBartels"])
def test_splines_is_called_directly(name: str, closed: bool) -> None:
    from splines import quaternion as library

    scheme = {"CatmullRom": "splines-catmull-rom", "KochanekBartels": "splines-kochanek-bartels"}
    curve, q, t = both(scheme[name], closed)
    keys = [library.UnitQuaternion.from_unit_xyzw(row[[1, 2, 3, 0]]) for row in q]
    with quiet():
        direct = getattr(library, name)(
            keys, list(knots_of(curve)), endconditions="closed" if closed else "natural"
        )
    wanted = np.array([direct.evaluate(x).wxyz for x in t], dtype=float)
    assert apart_up_to_sign(curve(t + 7.0), wanted) < 1e-12


@needs("splines")
@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("name", ["BarryGoldman", "Squad"])
def test_always_closed_splines_are_called_directly(name: str, closed: bool) -> None:
    from splines import quaternion as library

    scheme = {"BarryGoldman": "splines-barry-goldman", "Squad": "splines-squad"}[name]
    curve, q, t = both(scheme, closed)
    knots = knots_of(curve)
    if not closed:
        q, knots = reflected(curve.keyframes)
    keys = [library.UnitQuaternion.from_unit_xyzw(row[[1, 2, 3, 0]]) for row in q]
    direct = getattr(library, name)(keys, list(knots))
    wanted = np.array([direct.evaluate(x).wxyz for x in t], dtype=float)
    assert apart_up_to_sign(curve(t + 7.0), wanted) < 1e-12


@needs("splines")
def test_the_wrap_of_an_always_closed_spline_does_not_tell() -> None:
    """Another return time and another keyframe behind the phantom change nothing inside."""
    from splines.quaternion import BarryGoldman, UnitQuaternion

    curve, _, t = both("splines-barry-goldman")
    q, times = reflected(curve.keyframes)
    q = np.vstack([q, [1.0, 0.0, 0.0, 0.0]])
    keys = [UnitQuaternion.from_unit_xyzw(row[[1, 2, 3, 0]]) for row in q]
    direct = BarryGoldman(keys, [*times, times[-1] + 5.0])
    wanted = np.array([direct.evaluate(x).wxyz for x in t], dtype=float)
    assert apart_up_to_sign(curve(t + 7.0), wanted) < 1e-12


@needs("quaternionic")
def test_quaternionic_is_called_directly() -> None:
    import quaternionic

    curve, q, t = both("quaternionic-squad")
    direct = quaternionic.squad(quaternionic.array(q.copy()), knots_of(curve), t)
    assert apart(curve(t + 7.0), direct.ndarray) < SAME


@needs("quaternion")
def test_numpy_quaternion_is_called_directly() -> None:
    import quaternion as library

    curve, q, t = both("numpy-quaternion-squad")
    direct = library.squad(library.as_quat_array(q.copy()), knots_of(curve), t)
    assert apart(curve(t + 7.0), library.as_float_array(direct)) < SAME


@needs("interpolatepy")
@pytest.mark.parametrize(
    ("name", "key"),
    [
        ("SquadC2", "interpolatepy-squad-c2"),
        ("QuaternionSpline", "interpolatepy-quaternion-spline"),
        ("LogQuaternionInterpolation", "interpolatepy-log"),
    ],
)
def test_interpolatepy_is_called_directly(name: str, key: str) -> None:
    import interpolatepy

    curve, q, t = both(key)
    keys = [interpolatepy.Quaternion(*row) for row in q.tolist()]
    direct = getattr(interpolatepy, name)(knots_of(curve).tolist(), keys)
    points = [direct.evaluate(x) for x in t.tolist()]
    wanted = np.array([(p.w, p.x, p.y, p.z) for p in points])
    assert apart_up_to_sign(curve(t + 7.0), wanted) < SAME
    if name != "LogQuaternionInterpolation":
        world = [direct.evaluate_velocity(x) for x in t.tolist()]
        assert apart(curve(t + 7.0, 1, frame="world"), np.array(world)) < 1e-8


@needs("rowan")
def test_rowan_is_called_directly() -> None:
    import rowan

    curve, q, _ = both("rowan-slerp")
    u = np.linspace(0.0, 1.0, 7)[:-1]
    knots = curve.times
    for i in range(len(q) - 1):
        wanted = rowan.interpolate.slerp(q[i], q[i + 1], u)
        assert apart(curve(knots[i] + u * (knots[i + 1] - knots[i])), wanted) < SAME


@needs("pytransform3d")
def test_pytransform3d_is_called_directly() -> None:
    from pytransform3d.rotations import quaternion_slerp

    curve, q, _ = both("pytransform3d-slerp")
    knots = curve.times
    for i in range(len(q) - 1):
        for u in (0.0, 0.3, 0.9):
            t = knots[i] + u * (knots[i + 1] - knots[i])
            assert apart(curve(t), quaternion_slerp(q[i], q[i + 1], u)) < 1e-12


@pytest.mark.parametrize("closed", [False, True])
def test_slerps_agree(closed: bool) -> None:
    """All piecewise slerps are one curve, ours too."""
    times = uneven(9 if closed else 8)
    q = loop(times, 1, wobble=0.5) if closed else walk(8, 70.0, 3)
    t = inside(times, 4)
    wanted = qs.build("slerp", times, q, closed=closed)
    for name in [name for name in peers() if qs.scheme(name).continuity == 0]:
        curve = qs.build(name, times, q, closed=closed)
        assert apart(curve(t), wanted(t)) < 1e-13, name
        if 1 in curve.orders:
            assert apart(curve(t, 1), wanted(t, 1)) < 1e-12, name


# -- what all wrappers share --------------------------------------------------------------------


def peers() -> list[str]:
    return [name for name in qs.schemes() if qs.scheme(name).peer is not None]


@pytest.mark.parametrize("name", peers())
def test_version_is_known(name: str) -> None:
    scheme = qs.scheme(name)
    assert version(scheme.name) == installed.version(str(scheme.peer))


def test_our_own_have_our_version() -> None:
    assert version("slerp") == importlib.metadata.version("quatspline")


def test_warnings_stay_inside() -> None:
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        with quiet():
            warnings.warn("theirs", DeprecationWarning, stacklevel=1)
            np.log(np.zeros(1))
        assert not seen
        warnings.warn("ours", UserWarning, stacklevel=1)
        assert len(seen) == 1


@pytest.mark.parametrize("name", peers())
def test_an_order_that_a_peer_lacks_is_refused(name: str) -> None:
    curve = qs.build(name, None, walk(5, 40.0))
    for order in set(range(3)) - set(curve.orders):
        with pytest.raises(ValueError, match=f"order={order}: {name} offers"):
            curve(0.5, order)


# -- facts: docs/peers.md -----------------------------------------------------------------------


def jump(curve: Curve, order: int) -> FloatArray:
    """Jumps of omega (1) or alpha (2) at the inner knots, from orientations alone."""
    knots = knots_of(curve)
    inner = knots[1:-1]
    left = stencil.rates_of(curve, np.nextafter(inner, -np.inf))[order - 1]
    right = stencil.rates_of(curve, inner)[order - 1]
    return np.linalg.norm(left - right, axis=1)


@needs("scipy")
def test_rotation_spline_stops_silently_after_ten_iterations() -> None:
    """170 degree steps at uneven times: the acceleration of a C^2 spline jumps, nothing is said.

    At 60 degrees it does not.
    """
    relative = []
    for seed in range(10):
        curve = qs.build("scipy-rotation-spline", UNEVEN, walk(7, 170.0, seed))
        size = np.linalg.norm(curve(inside(UNEVEN, 20), 2), axis=1).max()
        relative.append(jump(curve, 2).max() / size)
        assert curve.solve_report is None
    assert max(relative) > 0.05
    curve = qs.build("scipy-rotation-spline", UNEVEN, walk(7, 60.0))
    size = np.linalg.norm(curve(inside(UNEVEN, 20), 2), axis=1).max()
    assert jump(curve, 2).max() < 1e-7 * size


@needs("scipy")
def test_rotation_spline_rests_on_the_unit_of_time() -> None:
    """Its iteration ends at a change of 1e-9 in rad per unit: in microseconds, at once."""
    times, q = random_case()
    seconds, slow = (qs.build("scipy-rotation-spline", times * k, q) for k in (1.0, 1e6))
    t = inside(times)
    assert 1e-7 < apart(slow(1e6 * t), seconds(t)) < 1e-2


@needs("scipy")
def test_rotation_spline_extrapolates_and_slerp_does_not() -> None:
    from scipy.spatial.transform import Rotation, RotationSpline, Slerp

    keys = Rotation.from_quat(walk(4, 50.0), scalar_first=True)
    assert np.isfinite(RotationSpline(range(4), keys)([9.0]).as_quat()).all()
    with pytest.raises(ValueError, match="within the range"):
        Slerp(range(4), keys)([9.0])
    with pytest.raises(ValueError, match="outside the domain"):
        qs.build("scipy-rotation-spline", None, walk(4, 50.0))(9.0)


@needs("splines")
def test_splines_loses_small_rotations() -> None:
    """An angle by acos: rotations below about 1e-8 rad do not move at all."""
    axis = np.array([0.6, 0.0, 0.8])
    for angle, lost in ((1e-9, True), (1e-3, False)):
        q = quaternion.exp(0.5 * np.array([[0.0], [angle], [2 * angle]]) * axis)
        curve = qs.build("splines-catmull-rom", None, q)
        moved = float(quaternion.distance(curve(0.0), curve(0.5)))
        assert (moved < 1e-6 * angle) == lost


@needs("splines")
def test_splines_own_velocity_is_not_that_of_its_curve() -> None:
    """Inside a segment; at keyframes it is."""
    from splines.quaternion import CatmullRom, UnitQuaternion

    q = walk(5, 80.0)
    library = CatmullRom([UnitQuaternion.from_unit_xyzw(row[[1, 2, 3, 0]]) for row in q])
    curve = qs.build("splines-catmull-rom", None, q)
    t = np.array([1.25, 2.0])
    body = stencil.rates_of(curve, t)[0]
    world = quaternion.rotate(curve(t), body)
    off = np.linalg.norm(np.array([library.evaluate(x, 1) for x in t]) - world, axis=1)
    assert off[0] > 1e-4
    assert off[1] < 1e-8


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("numpy-quaternion-squad", marks=needs("quaternion")),
        pytest.param("interpolatepy-squad-c2", marks=needs("interpolatepy")),
        pytest.param("interpolatepy-quaternion-spline", marks=needs("interpolatepy")),
    ],
)
def test_squads_leap_inside_segments_where_steps_are_large(name: str) -> None:
    """A rotation by more than a rad within 1e-10 of a segment, at 170 degrees; none at 60."""
    leaps = {}
    for degrees in (60.0, 170.0):
        cases = (qs.build(name, uneven(7), walk(7, degrees, seed)) for seed in range(3))
        leaps[degrees] = max(jumps(curve).loc[0, "jump"] for curve in cases)
    assert leaps[60.0] < 1e-6
    assert leaps[170.0] > 1.0


@needs("splines")
def test_splines_natural_end_starts_a_spin_too_fast() -> None:
    """The end control lies halfway to the next keyframe, where a constant rate has a third."""
    curve = qs.build("splines-catmull-rom", None, spin(np.arange(6.0), (0.0, 0.0, 1.0), 0.5))
    rate = stencil.rates_of(curve, np.array([0.0, 2.5]))[0]
    assert np.linalg.norm(rate, axis=1) == pytest.approx([0.75, 0.5], abs=1e-7)


@needs("splines")
def test_splines_squad_breaks_at_uneven_times_with_large_steps() -> None:
    largest = [
        max(jump(qs.build("splines-squad", UNEVEN, walk(7, degrees, s)), 1).max() for s in range(6))
        for degrees in (60.0, 120.0)
    ]
    assert largest[0] < 1e-6
    assert largest[1] > 1.0


@needs("quaternion")
def test_numpy_quaternion_squad_and_a_flipped_keyframe() -> None:
    """One key with the other sign, as documented, moves the curve; ``unflip`` puts it right."""
    q = walk(7, 50.0)
    q = quaternion.align(q)
    flipped = q.copy()
    flipped[3] *= -1.0
    t = inside(np.arange(7.0))
    wanted = qs.build("numpy-quaternion-squad", None, q)(t)
    astray = qs.build("numpy-quaternion-squad", None, flipped, align=False)
    assert np.degrees(apart_up_to_sign(astray(t), wanted)) > 20.0
    mended = qs.build("numpy-quaternion-squad", None, flipped, align=False, unflip=True)
    assert apart_up_to_sign(mended(t), wanted) < 1e-12
    assert apart_up_to_sign(qs.build("numpy-quaternion-squad", None, flipped)(t), wanted) < 1e-12


@pytest.mark.parametrize(
    ("name", "module", "degrees"),
    [
        ("numpy-quaternion-squad", "quaternion", 120.0),
        ("quaternionic-squad", "quaternionic", 170.0),
    ],
)
def test_squads_of_one_formula_break_at_uneven_times_with_large_steps(
    name: str, module: str, degrees: float
) -> None:
    """Published as continuous in the first derivative; so it is for smaller steps."""
    pytest.importorskip(module)
    for uneven_times, steps, breaks in (
        (np.arange(7.0), degrees, False),
        (UNEVEN, 60.0, False),
        (UNEVEN, degrees, True),
    ):
        curves = [qs.build(name, uneven_times, walk(7, steps, seed)) for seed in range(6)]
        assert (max(jump(curve, 1).max() for curve in curves) > 1.0) == breaks


@needs("interpolatepy")
def test_interpolatepy_squad_c2_stops_at_every_keyframe() -> None:
    times, q = UNEVEN, walk(7, 60.0)
    curve = qs.build("interpolatepy-squad-c2", times, q)
    at_keys, between = (
        np.linalg.norm(stencil.rates_of(curve, t)[0], axis=1)
        for t in (times, 0.5 * (times[1:] + times[:-1]))
    )
    assert at_keys.max() < 1e-8
    assert between.min() > 0.5
    assert jump(curve, 1).max() < 1e-6


@needs("interpolatepy")
def test_interpolatepy_quaternion_spline_jumps_in_velocity() -> None:
    """At the second and the last but one key for even times, at every key for uneven ones."""
    q = walk(7, 60.0)
    even = jump(qs.build("interpolatepy-quaternion-spline", None, q), 1)
    assert even[[0, -1]].min() > 0.1
    assert even[1:-1].max() < 1e-6
    assert jump(qs.build("interpolatepy-quaternion-spline", UNEVEN, q), 1).min() > 0.1


@needs("interpolatepy")
def test_interpolatepy_log_meets_its_keyframes_through_the_half_turn() -> None:
    """Version 3.0.0 missed the third of 160, 170, 190, 200 degrees about x by 20; 3.3 meets all."""
    angles = np.radians([160.0, 170.0, 190.0, 200.0])
    q = quaternion.exp(0.5 * angles[:, None] * [1.0, 0.0, 0.0])
    curve = qs.build("interpolatepy-log", None, q)
    assert apart_up_to_sign(curve(curve.times), q) < 1e-9
    for seed in range(20):
        q = walk(7, 90.0, seed)
        curve = qs.build("interpolatepy-log", None, q)
        assert apart_up_to_sign(curve(curve.times), q) < 1e-9


@needs("interpolatepy")
def test_interpolatepy_log_depends_on_the_reference_frame() -> None:
    q = walk(6, 60.0)
    t = inside(np.arange(6.0))
    turn = quaternion.exp([0.9, -0.4, 0.5])
    plain = qs.build("interpolatepy-log", None, q)(t)
    turned = qs.build("interpolatepy-log", None, quaternion.mul(turn, q))(t)
    assert np.degrees(apart_up_to_sign(turned, quaternion.mul(turn, plain))) > 1.0


@needs("interpolatepy")
def test_interpolatepy_log_has_two_backends_and_two_curves() -> None:
    """A first key with negative scalar part: the compiled backend flips all signs, the other none.

    The library's physical rates come from the second, so that here they are not the curve's.
    """
    import interpolatepy

    if not interpolatepy.HAS_CPP:
        pytest.skip("the compiled backend is not installed")
    q = quaternion.align(walk(5, 60.0, seed=5))
    t = np.array([0.6, 1.5, 2.3, 3.6])
    for sign, agree in ((np.sign(q[0, 0]), True), (-np.sign(q[0, 0]), False)):
        curve = qs.build("interpolatepy-log", None, sign * q)
        slopes = stencil.rates_of(curve, t)[0]
        assert (apart(curve(t, 1), slopes) < 1e-6) == agree


@needs("interpolatepy")
def test_interpolatepy_log_velocity_is_that_of_the_rotation_vector() -> None:
    import interpolatepy

    q = walk(5, 60.0, seed=5)
    q = q if q[0, 0] > 0.0 else -q
    curve = qs.build("interpolatepy-log", None, q)
    keys = [interpolatepy.Quaternion(*row) for row in curve.quaternions.tolist()]
    library = interpolatepy.LogQuaternionInterpolation([0.0, 1.0, 2.0, 3.0, 4.0], keys)
    off = library.evaluate_velocity(1.5) - curve(1.5, 1, frame="world")
    assert np.linalg.norm(off) > 0.1


@needs("interpolatepy")
def test_interpolatepy_differences() -> None:
    """Accelerations are differences over 1e-6, taken twice: good to four digits or so."""
    times, q = random_case()
    t = inside(times)
    for name in ("interpolatepy-squad-c2", "interpolatepy-quaternion-spline"):
        curve = qs.build(name, times, q)
        velocity, acceleration = stencil.rates_of(curve, t)
        assert apart(curve(t, 1), velocity) < 1e-5
        assert 1e-6 < apart(curve(t, 2), acceleration) < 1e-1
