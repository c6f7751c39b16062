"""Keyframe reduction: the bound holds on every frame, no keyframe is idle, joints apart or together."""

from __future__ import annotations

import numpy as np
import pytest
from clips import angles, figure

import quatspline as qs
from quatspline import quaternion

BOUND = np.radians(0.5)


@pytest.mark.parametrize(
    "chosen", ["slerp", "squad", "local-quintic", "quartic", "kim", "min-torque"]
)
@pytest.mark.parametrize("together", [False, True])
def test_the_bound_holds_and_says_so(chosen: str, together: bool) -> None:
    motion = figure(240, noise=0.0003)
    found = motion.reduce(chosen, error=BOUND, together=together)
    assert 0 < found.largest <= BOUND
    assert angles(found.motion.quaternions, motion.quaternions) == pytest.approx(
        np.degrees(found.largest)
    )
    assert list(found.frames) == motion.tracks
    for track, frames in enumerate(found.frames.values()):
        assert frames[0] == 0
        assert frames[-1] == 239
        assert (np.diff(frames) > 0).all()
        curve = qs.build(chosen, motion.times[frames], motion.quaternions[frames, track])
        rebuilt = curve(motion.times)
        assert angles(rebuilt, motion.quaternions[:, track]) <= np.degrees(BOUND) + 1e-9
        # As many tracks are fitted at once, or one: the curves are the same.
        assert angles(rebuilt, found.motion.quaternions[:, track]) < 1e-9
    if together:
        assert all(
            np.array_equal(frames, found.frames["joint 0"]) for frames in found.frames.values()
        )
    assert sum(map(len, found.frames.values())) < 0.7 * motion.quaternions[..., 0].size


@pytest.mark.parametrize("chosen", ["slerp", "local-quintic"])
def test_no_keyframe_is_idle(chosen: str) -> None:
    motion = figure(120)
    frames = motion.reduce(chosen, error=BOUND).frames["joint 1"]
    q = motion.quaternions[:, 1]
    for idle in frames[1:-1]:
        fewer = frames[frames != idle]
        rebuilt = qs.build(chosen, motion.times[fewer], q[fewer])(motion.times)
        assert quaternion.distance(rebuilt, q).max() > BOUND


def test_a_constant_spin_needs_two_keyframes() -> None:
    t = np.arange(100) / 30
    motion = qs.Motion(t, quaternion.exp(t[:, None] * [0.0, 0.2, 0]))
    found = motion.reduce("slerp", error=1e-6)
    np.testing.assert_array_equal(found.frames["body"], [0, 99])
    assert found.largest < 1e-12


def test_a_jump_keeps_the_frames_around_it() -> None:
    q = np.tile([1.0, 0, 0, 0], (50, 1))
    q[25:] = [0.0, 1, 0, 0]
    frames = qs.Motion(np.arange(50.0), q).reduce("slerp", error=BOUND).frames["body"]
    np.testing.assert_array_equal(frames, [0, 24, 25, 49])


def test_a_solver_that_fails_names_the_joint() -> None:
    with pytest.raises(qs.ConvergenceError, match=r"^joint 0: nielson"):
        figure(60).reduce("nielson", error=1e-5, max_iterations=1, tolerance=1e-14)


def test_a_scheme_that_passes_near_keyframes_keeps_no_bound() -> None:
    with pytest.raises(ValueError, match=r"^smoothing-spline passes near its keyframes"):
        figure(20).reduce("smoothing-spline", error=0.1)


@pytest.mark.parametrize("error", [0, -1, np.nan, np.inf, "1deg"])
def test_wrong_bounds_are_refused(error: object) -> None:
    with pytest.raises(ValueError, match="a positive angle in rad"):
        figure(20).reduce("slerp", error=error)


def test_a_solver_that_fails_on_few_keyframes_gets_more() -> None:
    """Two updates are enough on keyframes that lie close together, and not on those that the bound asks for."""
    motion, bound = figure(240), np.radians(2.0)
    found = motion.reduce("kim", error=bound, max_iterations=2)
    enough = motion.reduce("kim", error=bound).frames
    assert not found.failures
    assert found.largest <= bound
    for track, (name, frames) in enumerate(found.frames.items()):
        assert len(enough[name]) < len(frames) < 60
        t, q = motion.times[frames], motion.quaternions[frames, track]
        assert qs.build("kim", t, q, max_iterations=2).solve_report.converged


def test_more_keyframes_than_are_practical_are_told() -> None:
    rng = np.random.default_rng(0)
    q = quaternion.exp(0.1 * rng.normal(size=(260, 2, 3)))
    q[:, 1] = [1.0, 0.0, 0.0, 0.0]
    found = qs.Motion(np.arange(260.0), q, tracks=["noise", "rest"]).reduce(
        "min-torque", error=0.01
    )
    told = "min-torque is practical up to 200 keyframes, and more are needed within 0.573 degrees"
    assert found.failures == {"noise": told}
    assert {name: len(index) for name, index in found.frames.items()} == {"noise": 260, "rest": 2}
    with pytest.raises(ValueError, match=f"^body: {told}"):
        qs.Motion(np.arange(260.0), q[:, 0]).reduce("min-torque", error=0.01)
