"""Keyframes: validation, normalisation, alignment, closing; options."""

import math
from typing import Annotated, Any, Literal

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from quatspline import quaternion
from quatspline.catalogue import scheme
from quatspline.curve import Curve
from quatspline.keyframes import Keyframes, prepare
from quatspline.options import Above, AtLeast, Count, among, checked, nearest, per_keyframe
from quatspline.solving import ConvergenceError, SolveReport
from toys import Toy
from walks import random_units, uneven, walk

Q = walk(5, 60.0)


class Nodding(Curve):
    """Nearest keyframe: a scheme that needs nothing compiled."""

    title = reference = "-"
    continuity, order, support, constant_rate = 0, 1, 2, "no"
    non_uniform = False
    closable = False
    min_keyframes = 3
    orders = (0, 1)

    def _fit(self, keyframes: Keyframes, *, gain: float = 1.0, fail: bool = False) -> None:
        misses = np.linspace(0.0, 0.5, keyframes.count)
        if fail:
            report = SolveReport("guess", "residual", 3, 0.25, misses[-1], False, 1e-6)
            self._conclude(report)

    def _orientation(self, t: np.ndarray) -> np.ndarray:
        near = np.argmin(np.abs(t[:, None] - self.keyframes.knots), axis=1)
        return self.keyframes.quaternions[near]


def test_prepared_form() -> None:
    times = uneven(5) + 3.0
    frames = prepare(times, Q)
    assert frames.tracks.shape == (1, 5, 4)
    assert frames.track_shape == ()
    assert frames.count == 5
    assert frames.sign == 1.0
    assert np.array_equal(frames.knots, uneven(5))
    assert np.array_equal(frames.spacings, np.diff(times))
    assert np.array_equal(frames.shaped(), frames.quaternions)


def test_times_inside_segments_are_found_again() -> None:
    frames = prepare([3.0, 4.0, 6.0], Q[:3])
    assert np.array_equal(frames.inside(2), [0.25, 0.75, 1.5, 2.5])
    assert np.array_equal(frames.inside([0.0, 0.75]), [0.0, 0.75, 1.0, 2.5])
    segment, u = frames.locate(frames.inside([0.0, 0.25, 0.75]))
    assert np.array_equal(segment, [0, 0, 0, 1, 1, 1])
    assert np.array_equal(u, [0.0, 0.25, 0.75] * 2)
    segment, u = frames.locate(frames.knots)
    assert np.array_equal(segment, [0, 1, 1])
    assert np.array_equal(u, [0.0, 0.0, 1.0])


def test_times_inside_the_segment_of_the_return() -> None:
    closed = prepare([0.0, 1.0, 2.0, 5.0], Q[:3], closed=True)
    assert np.array_equal(closed.inside(1), [0.5, 1.5, 3.5])
    assert np.array_equal(closed.locate(np.array([3.5, 5.0]))[0], [2, 2])


def test_times_default_to_counting() -> None:
    assert np.array_equal(prepare(None, Q).times, np.arange(5.0))
    assert np.array_equal(prepare(None, Q, closed=True).times, np.arange(6.0))
    assert prepare([0, 1, 2, 3, 4], Q).times.dtype == np.float64


def test_tracks_keep_their_shape() -> None:
    q = random_units(5 * 6, 1).reshape(5, 2, 3, 4)
    frames = prepare(None, q, align=False)
    assert frames.tracks.shape == (6, 5, 4)
    assert frames.track_shape == (2, 3)
    assert frames.signs.shape == (6,)
    assert np.abs(frames.shaped() - q).max() < 1e-15
    assert np.abs(frames.track(4).quaternions - q[:, 1, 1]).max() < 1e-15
    with pytest.raises(ValueError, match=r"6 tracks: pick one with track\(k\)"):
        _ = frames.quaternions


def test_rotations_of_scipy() -> None:
    from scipy.spatial.transform import Rotation

    frames = prepare(None, Rotation.from_quat(Q, scalar_first=True))
    assert np.max(quaternion.distance(frames.quaternions, Q)) < 1e-15
    with pytest.raises(ValueError, match=r"^quaternions has shape \(4,\)"):
        prepare(None, Rotation.from_quat(Q[0], scalar_first=True))


def test_whole_numbers_are_numbers() -> None:
    frames = prepare(np.arange(3, dtype=np.int8), [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]])
    assert frames.tracks.dtype == np.float64


def test_alignment_per_track_and_closing() -> None:
    q = np.stack([Q, -Q], axis=1)
    q[2] *= -1.0
    frames = prepare(None, q, closed=True)
    dots = np.einsum("kni,kni->kn", frames.tracks[:, 1:], frames.tracks[:, :-1])
    assert (dots > 0.0).all()
    ends = np.einsum("ki,ki->k", frames.tracks[:, -1], frames.tracks[:, 0])
    assert np.array_equal(frames.signs, np.where(ends < 0.0, -1.0, 1.0))


def test_closing_sign_counts_zero_as_plus() -> None:
    q = [[1.0, 0, 0, 0], [math.sqrt(0.5), math.sqrt(0.5), 0, 0], [0.0, 1.0, 0, 0]]
    assert prepare(None, q, closed=True).sign == 1.0
    full = quaternion.exp(np.arange(5)[:, None] * [0.0, 0.0, math.pi / 5])
    assert prepare(None, full, closed=True).sign == -1.0
    assert prepare(None, full, closed=True, align=False).sign == 1.0
    assert prepare(None, full, closed=True, align=False, closing_sign=-1).sign == -1.0


def test_orthogonal_neighbours_keep_their_sign() -> None:
    q = np.array([[1.0, 0, 0, 0], [0, -1.0, 0, 0], [-1.0, 0, 0, 0]])
    assert np.array_equal(prepare(None, q).quaternions, q)


def test_antipodes_are_neighbours_across_the_seam() -> None:
    q = np.array([[1.0, 0, 0, 0], [0, 1.0, 0, 0], [-1.0, 0, 0, 0]])
    prepare(None, q, align=False)
    with pytest.raises(ValueError, match=r"quaternions\[2\] and quaternions\[0\]"):
        prepare(None, q, closed=True, align=False)
    prepare(None, q, closed=True, align=False, closing_sign=-1)
    with pytest.raises(ValueError, match=r"quaternions\[0\] and quaternions\[1\]"):
        prepare(None, [[1.0, 0, 0, 0], [-1.0, 0, 0, 0]], align=False)
    nearly = quaternion.exp([0.0, math.pi - 1e-12, 0.0])
    prepare(None, [[1.0, 0, 0, 0], nearly], align=False)


def test_uniformity() -> None:
    assert prepare(None, Q).uniform
    assert prepare(0.1 * np.arange(5) + 0.7, Q).uniform
    assert prepare(1.3e9 + 0.01 * np.arange(5), Q).uniform
    assert not prepare(uneven(5), Q).uniform
    assert not prepare(1.3e9 + 0.01 * np.array([0, 1, 2.01, 3, 4]), Q).uniform
    assert not prepare([0, 1, 2, 3, 4 + 1e-6], Q).uniform


def test_arrays_are_copies_and_frozen() -> None:
    times, q = uneven(5), Q.copy()
    frames = prepare(times, q)
    q[:], times[:] = 0.0, 0.0
    assert np.abs(frames.quaternions - Q).max() < 1e-15
    for array in (frames.times, frames.tracks, frames.signs):
        assert not array.flags.writeable


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.floats(0.9, 1.1), st.integers(0, 4))
def test_norms(scale: float, index: int) -> None:
    q = Q.copy()
    q[index] *= scale
    if abs(scale - 1.0) < 0.99e-3:
        norms = np.linalg.norm(prepare(None, q).quaternions, axis=1)
        assert np.abs(norms - 1.0).max() < 1e-15
    elif abs(scale - 1.0) > 1.01e-3:
        with pytest.raises(ValueError, match=rf"^quaternions\[{index}\] .* norm"):
            prepare(None, q)


def test_a_span_beyond_float64_is_told_in_plain_numbers() -> None:
    message = r"^times span -1e\+308 to 1e\+308: too long for float64$"
    with pytest.raises(ValueError, match=message):
        prepare([-1e308, 1e308], Q[:2])


def test_times_that_float64_does_not_tell_apart_are_refused() -> None:
    message = (
        r"^times\[2\] = 2\.0 is too close to times\[1\] = 1\.0, 1e\+17 after times\[0\]: float64"
    )
    with pytest.raises(ValueError, match=message):
        prepare([-1e17, 1.0, 2.0], np.tile([1.0, 0, 0, 0], (3, 1)))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=9))
def test_times_strictly_increase(times: list[float]) -> None:
    q = np.tile(Q[0], (len(times), 1))
    stuck = [i for i in range(1, len(times)) if not times[i] > times[i - 1]]
    if stuck:
        with pytest.raises(ValueError, match=rf"^times\[{stuck[0]}\] = .* does not exceed"):
            prepare(times, q)
    elif (np.diff(np.array(times) - times[0]) == 0.0).any():
        with pytest.raises(ValueError, match="too close"):
            prepare(times, q)
    else:
        assert np.array_equal(prepare(times, q).times, times)


# -- what the base class refuses, on a scheme made for it ---------------------------------------


def test_schemes_that_take_uniform_times_only() -> None:
    Nodding(1.3e9 + 0.01 * np.arange(5), Q)
    with pytest.raises(ValueError, match=r"^times\[1\] to times\[2\] is 0\.75, not 0\.375"):
        Nodding(uneven(5), Q)


def test_schemes_that_do_not_close() -> None:
    with pytest.raises(ValueError, match=r"^closed=True: .*no closed curve"):
        Nodding(None, Q, closed=True)


def test_schemes_that_need_more_keyframes() -> None:
    with pytest.raises(ValueError, match=r"^quaternions has 2 keyframes: at least 3 are needed"):
        Nodding(None, Q[:2])
    with pytest.raises(ValueError, match=r"^quaternions has 2 keyframes: .* needs 3"):
        Nodding.from_keyframes(prepare(None, Q[:2]))


def test_schemes_that_lack_an_order() -> None:
    with pytest.raises(ValueError, match=r"^order=2: .* offers orders \(0, 1\) only"):
        Nodding(None, Q)(0.5, 2)


def test_failed_solves_raise_their_report() -> None:
    with pytest.raises(ConvergenceError, match="did not converge: after 3 iterations") as failure:
        Nodding(None, Q, fail=True)
    assert failure.value.report.residual == 0.5
    assert not failure.value.report.converged
    import pickle

    copy = pickle.loads(pickle.dumps(failure.value))
    assert copy.report == failure.value.report
    assert str(copy) == str(failure.value)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.floats(-1e9, 1e9), st.floats(1e-3, 1e3))
@example(-0.49999999999999994, 0.75)
def test_four_ulp_of_an_end_count_as_the_end(first: float, span: float) -> None:
    """Also where subtracting the first time rounds."""
    times = first + span * np.array([0.0, 0.5, 1.0])
    curve = Nodding(times, Q[:3])
    for end, outwards in zip(curve.domain, (-math.inf, math.inf), strict=True):
        ulp = np.spacing(abs(end))
        t = end + math.copysign(4 * ulp, outwards)
        if abs(t - end) > 4 * ulp:  # rounded beyond, where a power of two lies between
            t = np.nextafter(t, end)
        assert np.array_equal(curve(t), curve(end))
        with pytest.raises(ValueError, match="outside the domain"):
            curve(t + math.copysign(8 * np.spacing(np.abs(times).max()), outwards))


# -- options ------------------------------------------------------------------------------------


class Choosy(Toy):
    """Every kind of annotation that an option may have."""

    name = "test"

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        kind: Literal["one", "two"] = "one",
        tolerance: Annotated[float, Above(0.0)] = 1e-6,
        ratio: Annotated[float, AtLeast(2)] = 2.0,
        count: Count = 3,
        flag: bool = False,
        limit: int | None = None,
        value: float = 0.0,
    ) -> None:
        """Nothing to prepare."""


@pytest.mark.parametrize(
    "options",
    [
        {"kind": "two"},
        {"tolerance": 1e-300, "count": 1, "ratio": 2},
        {"limit": None},
        {"limit": 5, "flag": True, "value": -3},
        {"value": np.float32(0.5), "count": np.int64(2)},
    ],
)
def test_good_options(options: dict[str, Any]) -> None:
    assert checked(Choosy, options) == options


def test_options_among_those_wanted_are_the_declared() -> None:
    assert among(Choosy, {"count": 2, "stop": "change", "flag": True}) == {"count": 2, "flag": True}


def test_a_curve_tells_its_options() -> None:
    curve = scheme("nielson")(None, walk(4, 20.0, seed=0), tolerance=1e-9)
    assert curve.options == {"tolerance": 1e-9}
    curve.options["tolerance"] = 1.0
    assert curve.options == {"tolerance": 1e-9}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"kinds": "one"}, r"^test has no option 'kinds': did you mean 'kind'\?"),
        ({"zzz": 1}, r"^test has no option 'zzz': known: count, flag, kind"),
        ({"kind": "three"}, r"^kind='three': expected one of 'one', 'two'"),
        ({"kind": ["one"]}, r"^kind="),
        ({"tolerance": 0.0}, r"^tolerance=0.0: must be above 0"),
        ({"tolerance": math.nan}, r"^tolerance=nan: expected a finite number"),
        ({"tolerance": "small"}, r"^tolerance='small': expected a finite number"),
        ({"tolerance": None}, r"^tolerance=None"),
        ({"ratio": 1.5}, r"^ratio=1.5: must be at least 2"),
        ({"count": 0}, r"^count=0: must be at least 1"),
        ({"count": 2.0}, r"^count=2.0: expected an integer"),
        ({"count": True}, r"^count=True: expected an integer"),
        ({"limit": 1.5}, r"^limit=1.5: expected an integer"),
        ({"value": True}, r"^value=True: expected a finite number"),
        ({"value": 1j}, r"^value=1j: expected a finite number"),
        ({"flag": "yes"}, r"^flag='yes': expected True or False"),
        ({"flag": 1}, r"^flag=1: expected True or False"),
        ({"kind": np.array(["one", "two"])}, r"^kind="),
    ],
)
def test_bad_options(options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        checked(Choosy, options)


def test_options_per_keyframe() -> None:
    assert np.array_equal(per_keyframe("tension", 2, 3), [2.0, 2.0, 2.0])
    assert np.array_equal(per_keyframe("tension", [1, 2, 3], 3), [1.0, 2.0, 3.0])
    for bad, message in {
        (1.0, 2.0): r"^tension has shape \(2,\): expected a number or 3 of them",
        (0.0, math.nan, 0.0): r"^tension\[1\] = nan",
        ("a", "b", "c"): "^tension",
        (1j, 1j, 1j): "^tension",
    }.items():
        with pytest.raises(ValueError, match=message):
            per_keyframe("tension", list(bad), 3)
    with pytest.raises(ValueError, match=r"^tension"):
        per_keyframe("tension", [[1.0], [2.0, 3.0]], 3)


def test_nearest_names() -> None:
    assert nearest("tensoin", ["tension", "ends"]) == "did you mean 'tension'?"
    assert nearest("x", []) == "known: none"
