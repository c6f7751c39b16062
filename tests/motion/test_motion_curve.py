"""Curves of motions: all tracks at once, matched positions, gaps, failures by the joint's name."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from clips import angles, figure, put
from scipy.interpolate import BSpline, make_interp_spline
from scipy.spatial.transform import Rotation

import quatspline as qs
from quatspline import quaternion
from quatspline.motion import positions as families
from quatspline.motion.resampling import grid, sampled


def test_all_tracks_are_one_batched_curve() -> None:
    motion = figure(40)
    curve = motion.curve("local-quintic", every=8)
    assert curve.orientation.keyframes.count == 6  # 0, 8, ..., 32 and the last, 39
    q, x = curve(motion.times[::8])
    assert (q.shape, x.shape) == ((5, 5, 4), (5, 5, 3))
    assert angles(q, motion.quaternions[::8]) < 1e-9
    np.testing.assert_allclose(x, motion.positions[::8], atol=1e-12)
    expected = qs.build(
        "local-quintic",
        motion.times[[0, 8, 16, 24, 32, 39]],
        motion.quaternions[[0, 8, 16, 24, 32, 39]],
    )
    np.testing.assert_array_equal(curve([[0.1, 0.2]])[0], expected([[0.1, 0.2]]))
    q, x = curve(0.3)
    assert (q.shape, x.shape) == ((5, 4), (5, 3))
    assert curve.failures == {}


def test_what_stays_stays_exactly() -> None:
    motion = figure(40)
    resampled = motion.resample(97, "kim")
    still = motion.skeleton.offsets[1:]
    assert (resampled.positions[:, 1:] == still).all()
    assert resampled.skeleton is motion.skeleton


@pytest.mark.parametrize(
    ("chosen", "name"),
    [
        ("slerp", "linear"),
        ("nlerp", "linear"),
        ("squad", "catmull-rom"),
        ("hermite", "catmull-rom"),
        ("shoemake-bezier", "catmull-rom"),
        ("kim", "cubic"),
        ("min-torque", "cubic"),
        ("nielson", "cubic"),
        ("log-cubic", "cubic"),
        ("normalised-cubic", "cubic"),
        ("gltf-cubic", "catmull-rom"),
        ("spherical-average", "cubic"),
        ("local-quintic", "local-quintic"),
        ("quintic", "local-quintic"),
        ("quartic", "quartic"),
    ],
)
def test_positions_match_the_scheme(chosen: str, name: str) -> None:
    assert families.family("matched", qs.scheme(chosen)) is families.FAMILIES[name]


@pytest.mark.parametrize(
    ("chosen", "options", "degree", "ends"),
    [
        ("moving-frame", {}, 3, "natural"),
        ("moving-frame", {"degree": 7, "ends": "not-a-knot"}, 7, "not-a-knot"),
        ("moving-frame", {"degree": 5, "end_velocity": [0.0, 0.0, 0.0]}, 5, "complete"),
        ("log-cubic", {"ends": "not-a-knot"}, 3, "not-a-knot"),
        ("kim", {"ends": "clamped"}, 3, "complete"),
        ("nielson", {"ends": "stationary"}, 3, "stationary"),
    ],
)
def test_positions_take_degree_and_ends(
    chosen: str, options: dict[str, Any], degree: int, ends: str
) -> None:
    wanted = families.SplineFamily(degree, ends)
    assert families.family("matched", qs.scheme(chosen), options) == wanted


CONDITIONS: dict[str, dict[str, Any]] = {
    "natural": {"k": 3, "bc_type": "natural"},
    "not-a-knot": {"k": 3},
    "stationary": {"k": 3, "bc_type": "clamped"},
}


@pytest.mark.parametrize("ends", CONDITIONS)
def test_spline_positions_are_scipys(ends: str) -> None:
    rng = np.random.default_rng(0)
    knots = 1e3 + np.cumsum(rng.uniform(0.5, 1.5, 9)) * 1e-3
    x = rng.normal(size=(9, 3))
    expected = make_interp_spline(knots - 1e3, x, **CONDITIONS[ends])
    t = np.linspace(knots[0], knots[-1], 50)
    found = families.SplineFamily(3, ends)(knots, x, False)(t)
    np.testing.assert_allclose(found, expected(t - 1e3), atol=1e-8)


@pytest.mark.parametrize("degree", [3, 5, 7, 9])
@pytest.mark.parametrize("ends", ["not-a-knot", "complete"])
def test_spline_positions_keep_polynomials_of_their_degree(degree: int, ends: str) -> None:
    """Ends included: derivatives from k + 1 positions are exact."""
    rng = np.random.default_rng(0)
    knots = np.cumsum(rng.uniform(0.5, 1.5, 12))
    c = rng.normal(size=(degree + 1, 3)) / 5.0 ** np.arange(degree + 1)[:, None]
    polynomial = np.polynomial.polynomial.polyval
    t = np.linspace(knots[0], knots[-1], 50)
    found = families.SplineFamily(degree, ends)(knots, polynomial(knots - 6, c).T, False)(t)
    np.testing.assert_allclose(found, polynomial(t - 6, c).T, atol=1e-9)


@pytest.mark.parametrize("degree", [3, 9])
@pytest.mark.parametrize("ends", ["natural", "not-a-knot", "complete", "stationary"])
@pytest.mark.parametrize("count", [2, 3, 4, 12])
def test_spline_positions_of_few_keyframes(degree: int, ends: str, count: int) -> None:
    """A closed motion whose positions drift may have fewer than its degree asks for."""
    rng = np.random.default_rng(1)
    knots, x = np.cumsum(rng.uniform(0.5, 1.5, count)), rng.normal(size=(count, 3))
    places = families.SplineFamily(degree, ends)(knots, x, False)
    np.testing.assert_allclose(places(knots), x, atol=1e-9)
    x[-1] = x[0]
    closed = families.SplineFamily(degree, ends).fitted(knots, x, True)
    np.testing.assert_allclose(closed(knots - knots[0]), x, atol=1e-9)
    seam = closed([0.0, knots[-1] - knots[0] - 1e-12], 1)
    np.testing.assert_allclose(seam[0], seam[1], atol=1e-6)


# -- the rigid motion of moving frames --------------------------------------------------------------


def rigid(closed: bool) -> qs.Motion:
    """A body whose frame and origin move; closed, with the return."""
    rng = np.random.default_rng(4)
    times = np.cumsum(rng.uniform(0.05, 0.15, 12 + closed))
    angle = 2.0 * np.pi * (times - times[0]) / (times[-1] - times[0])
    half = np.stack([0.3 * np.sin(angle), 0.4 * np.cos(angle), 0.2 * np.sin(2 * angle)], axis=1)
    x = np.stack([np.cos(angle), np.sin(angle), 0.3 * np.sin(2 * angle)], axis=1)
    x[-1] = x[0] if closed else x[-1]
    return qs.Motion(times, quaternion.exp(half[: len(half) - closed]), x)


RIGID = [
    ({}, False),
    ({"degree": 5, "ends": "not-a-knot"}, False),
    ({"degree": 7, "ends": "complete"}, False),
    ({"degree": 5}, True),
]


@pytest.mark.parametrize(("options", "closed"), RIGID)
def test_frame_and_origin_are_splines_on_one_knot_vector(
    options: dict[str, Any], closed: bool
) -> None:
    """D, e_x, e_y, e_z of seed and paper: scipy's B-splines, of which the curve is made."""
    motion = rigid(closed)
    curve = motion.curve("moving-frame", closed=closed, **options)
    axes, origin = curve.orientation.axes, curve.origin
    for axis in axes:
        assert isinstance(axis, BSpline)
        assert (axis.k, axis.c.shape[1:]) == (options.get("degree", 3), (1, 3))
        assert np.array_equal(axis.t, origin.t)
    assert (origin.k, origin.c.shape) == (axes.e_x.k, axes.e_x.c.shape)
    s = np.linspace(0.0, motion.times[-1], 60)
    q, x = curve(s)
    np.testing.assert_allclose(x, origin(s), atol=1e-12)
    pseudo = np.stack([axis(s)[:, 0] for axis in axes], axis=-1)
    nearest = Rotation.from_matrix(pseudo)  # scipy's choice for a matrix that is no rotation
    off = nearest.inv() * Rotation.from_quat(q[:, 0], scalar_first=True)
    assert off.magnitude().max() < 1e-10
    if not closed:
        frames = np.stack([axis(motion.times)[:, 0] for axis in axes], axis=-1)
        wanted = Rotation.from_quat(motion.quaternions[:, 0], scalar_first=True).as_matrix()
        np.testing.assert_allclose(frames, wanted, atol=1e-11)


@pytest.mark.parametrize(("options", "closed"), RIGID)
def test_a_rigid_change_of_the_world_moves_frame_and_origin_together(
    options: dict[str, Any], closed: bool
) -> None:
    """And one of the body's own frame, with a lever from the origin, moves them as it moves keyframes."""
    motion = rigid(closed)
    turn, shift = quaternion.normalise(np.array([0.3, -0.5, 0.7, 0.2])), np.array([3.0, -1.0, 2.0])
    moved = qs.Motion(
        motion.stamps,
        quaternion.mul(turn, motion.quaternions),
        quaternion.rotate(turn, motion.positions) + shift,
    )
    s = np.linspace(0.0, motion.times[-1], 60)
    q, x = motion.curve("moving-frame", closed=closed, **options)(s)
    other_q, other_x = moved.curve("moving-frame", closed=closed, **options)(s)
    assert angles(other_q, quaternion.mul(turn, q)) < 1e-9
    np.testing.assert_allclose(other_x, quaternion.rotate(turn, x) + shift, atol=1e-10)


def test_positions_without_a_spline_have_no_origin() -> None:
    motion = rigid(False)
    with pytest.raises(ValueError, match="the positions are not a B-spline"):
        _ = motion.curve("kim").origin
    bare = qs.Motion(motion.stamps, motion.quaternions)
    with pytest.raises(ValueError, match="no positions"):
        _ = bare.curve("moving-frame").origin


@pytest.mark.parametrize(
    ("name", "degree"), [("linear", 1), ("catmull-rom", 2), ("local-quintic", 4)]
)
def test_a_family_has_the_polynomials_of_its_order(name: str, degree: int) -> None:
    knots = np.cumsum(np.random.default_rng(0).uniform(0.5, 1.5, 9))
    c = np.random.default_rng(1).normal(size=(degree + 1, 3))
    x = np.polynomial.polynomial.polyval(knots - 4, c).T
    t = np.linspace(knots[0], knots[-1], 50)
    inside = (t > knots[1]) & (t < knots[-2])
    expected = np.polynomial.polynomial.polyval(t - 4, c).T
    found = families.FAMILIES[name](knots, x, False)(t)
    np.testing.assert_allclose(found[inside], expected[inside], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", families.FAMILIES)
def test_families_pass_through_and_close(name: str) -> None:
    angle = np.linspace(0, 2 * np.pi, 9)
    x = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    x[-1] = x[0]
    family = families.FAMILIES[name]
    for count in (2, 3, 4, 9):
        places = family(angle[:count], x[:count], False)
        np.testing.assert_allclose(places(angle[:count]), x[:count], atol=1e-12)
    closed = family(angle, x, True)
    np.testing.assert_allclose(closed(angle), x, atol=1e-12)
    middle = closed(angle[:-1] + np.pi / 8)
    lengths = np.linalg.norm(middle, axis=1)
    np.testing.assert_allclose(lengths, lengths[0], atol=1e-12)  # no end is felt


def test_the_quartics_positions_are_its_curve_in_flat_space() -> None:
    """About one axis everything commutes: half angles of the paper's curve are its positions."""
    rng = np.random.default_rng(0)
    knots = np.cumsum(rng.uniform(0.5, 1.5, 8))
    half = rng.uniform(-0.5, 0.5, 8)
    curve = qs.QuarticSpline(knots, quaternion.exp(half[:, None] * [0, 0, 1.0]))
    t = np.linspace(knots[0], knots[-1], 60)
    x = families.quartic(knots, half[:, None] * [0, 0, 1.0], False)(t)
    np.testing.assert_allclose(x, curve.log(t), atol=1e-12)


def test_gaps_are_refused_and_pieces_go_on() -> None:
    whole = figure(60)
    motion = whole.frames(np.r_[0:20, 30:60])
    motion = qs.Motion(
        motion.stamps, motion.quaternions, motion.positions, motion.tracks, max_gap=0.1
    )
    assert [len(piece.times) for piece in motion.pieces()] == [20, 30]
    curve = motion.curve("squad")
    assert len(curve.pieces) == 2
    t = motion.times[[3, 25]]
    q, _ = curve(t)
    assert angles(q, motion.quaternions[[3, 25]]) < 1e-9
    piece = motion.pieces()[1].curve("squad")
    np.testing.assert_allclose(
        curve(t + 0.003)[0][1], piece(t[1] + 0.003 - motion.times[20])[0], atol=1e-14
    )
    with pytest.raises(ValueError, match=r"t\[1\] = 0\.4: inside a gap of the motion, 0\.31"):
        curve([0.1, 0.4])
    with pytest.raises(ValueError, match="outside the domain"):
        curve(2.0)
    with pytest.raises(ValueError, match="in 2 pieces"):
        _ = curve.orientation
    with pytest.raises(ValueError, match="the motion has gaps: reduce its 2 pieces"):
        motion.reduce("slerp", error=0.1)
    sampled_at = motion.resample(120, "slerp").times
    assert not (
        (sampled_at > motion.times[19] + 1e-9) & (sampled_at < motion.times[20] - 1e-9)
    ).any()


def test_a_track_on_which_a_solver_fails_is_named_and_the_others_go_on() -> None:
    motion = figure(30)
    q = motion.quaternions.copy()
    spin = np.random.default_rng(3).uniform(-1.5, 1.5, (30, 3))
    q[:, 2] = quaternion.exp(spin)
    wild = motion.moved(motion.stamps, q, motion.positions)
    curve = wild.curve("nielson", max_iterations=14, tolerance=1e-6)
    assert list(curve.failures) == ["joint 2"]
    assert "did not converge" in curve.failures["joint 2"]
    values, _ = curve(0.21)
    assert np.isnan(values[2]).all()
    assert np.isfinite(np.delete(values, 2, axis=0)).all()
    with pytest.raises(qs.ConvergenceError, match=r"^joint 2: nielson"):
        sampled(curve, grid(curve, 50))
    with pytest.raises(qs.ConvergenceError):
        motion.curve("nielson", max_iterations=1, tolerance=1e-14)  # none goes on


def test_resampling_by_rate_and_by_times() -> None:
    motion = figure(61)
    twice = motion.resample(120, "slerp")
    assert len(twice.times) == 121
    np.testing.assert_allclose(twice.times[::2], motion.times, atol=1e-15)
    assert angles(twice.quaternions[::2], motion.quaternions) < 1e-9
    at = motion.resample(times=[0.1, 0.5], scheme="squad", positions="linear")
    assert at.quaternions.shape == (2, 5, 4)
    np.testing.assert_array_equal(at.stamps, [0.1, 0.5])
    for given in ({}, {"rate": 1, "times": [0]}):
        with pytest.raises(ValueError, match="give a rate or times"):
            motion.resample(**given, scheme="slerp")
    with pytest.raises(ValueError, match="outside the domain"):
        motion.resample(times=[5.0], scheme="slerp")


def test_holding_the_ends() -> None:
    motion = figure(20)
    with pytest.raises(ValueError, match="outside the domain"):
        motion.curve("slerp")(-1.0)
    q, x = motion.curve("slerp", hold=True)([-1.0, 99.0])
    np.testing.assert_allclose(q, motion.quaternions[[0, -1]], atol=1e-15)
    np.testing.assert_array_equal(x, motion.positions[[0, -1]])


@pytest.mark.parametrize(
    ("options", "what"),
    [
        ({"every": 0}, "every=0: a whole number"),
        ({"every": 1.5}, "every=1.5: a whole number"),
        ({"positions": "cubik"}, "positions='cubik': did you mean 'cubic'"),
        ({"tension": 1}, "slerp has no option 'tension'"),
    ],
)
def test_wrong_arguments_are_told(options: dict, what: str) -> None:
    with pytest.raises(ValueError, match=what):
        figure(20).curve("slerp", **options)


def test_a_closed_motion_closes() -> None:
    angle = np.linspace(0, 2 * np.pi, 9)
    q = quaternion.exp(0.3 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1))[:-1]
    x = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    motion = qs.Motion(angle, q, x)
    assert motion.closed
    turns, places = motion.curve("kim", closed=True)([0.1, 0.1 + 2 * np.pi])
    np.testing.assert_allclose(turns[0], turns[1], atol=1e-12)
    np.testing.assert_allclose(places[0], places[1], atol=1e-12)


def test_a_motion_of_a_file_is_a_curve(tmp_path) -> None:
    path = put(tmp_path / "a.csv", "t,qw,qx,qy,qz\n5,1,0,0,0\n6,0.8,0.6,0,0\n8,0,1,0,0\n")
    motion = qs.read_motion(path)
    q, x = motion.curve("slerp")(0.5)
    assert x is None
    assert angles(q, quaternion.slerp([1, 0, 0, 0], [0.8, 0.6, 0, 0], 0.5)) < 1e-9
