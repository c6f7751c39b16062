"""Keyframes, samples and outputs as people hold them: taken as meant, or refused by name."""

from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

import quatspline as qs
from quatspline import quaternion
from walks import apart, apart_up_to_sign, walk

Q = walk(4, 40.0)


@pytest.mark.parametrize(
    "names",
    [
        "qx qy qz qw",
        "x y z w",
        "i j k r",
        "qi qj qk qr",
        "x_q y_q z_q w_q",
        "quat.x quat.y quat.z quat.w",
    ],
)
def test_named_columns_tell_their_order(names: str) -> None:
    table = pd.DataFrame(np.roll(Q, -1, axis=1), columns=names.split())
    assert apart(qs.build("slerp", None, table).quaternions, Q) < 1e-15
    nested = table.set_axis(pd.MultiIndex.from_product([["pose"], names.split()]), axis=1)
    assert apart(qs.build("slerp", None, nested).quaternions, Q) < 1e-15
    nullable = table.astype("Float64")
    assert apart(qs.build("slerp", None, nullable).quaternions, Q) < 1e-15


def test_numbered_columns_stand_as_they_are() -> None:
    assert apart(qs.build("slerp", None, pd.DataFrame(Q)).quaternions, Q) < 1e-15


@pytest.mark.parametrize("names", ["q1 q2 q3 q0", "t qx qy qz", "a b c d", "qw qx qy qy"])
def test_columns_that_do_not_tell_are_refused(names: str) -> None:
    with pytest.raises(
        ValueError, match=rf"^quaternions: columns '{names.split()[0]}'.* do not say"
    ):
        qs.build("slerp", None, pd.DataFrame(Q, columns=names.split()))


def test_rotations_and_quaternions_of_other_packages() -> None:
    numpy_quaternion = pytest.importorskip("quaternion")
    listed = [Rotation.from_quat(q, scalar_first=True) for q in Q]
    packed = numpy_quaternion.as_quat_array(Q)
    for given in (listed, tuple(listed), packed, list(packed), packed[::1].copy()):
        assert apart_up_to_sign(qs.build("slerp", None, given).quaternions, Q) < 1e-15
    with pytest.raises(ValueError, match=r"^quaternions\[2\] = .*: not a Rotation"):
        qs.build("slerp", None, [*listed[:2], [1.0, 0, 0, 0]])


def test_normalise_takes_any_length() -> None:
    rounded = np.round(Q, 2)
    with pytest.raises(ValueError, match=r"normalise=True"):
        qs.build("slerp", None, rounded)
    for scale in (1.0, 1e-200, 1e200):
        curve = qs.build("slerp", None, rounded * scale, normalise=True)
        assert np.abs(np.linalg.norm(curve.quaternions, axis=1) - 1.0).max() < 1e-15
        assert apart(curve.quaternions, quaternion.normalise(rounded)) < 1e-15
    for bad, sentence in ((0.0, "has norm 0"), (np.nan, "not a finite number")):
        with pytest.raises(ValueError, match=rf"^quaternions\[2.*{sentence}"):
            qs.build("slerp", None, np.where(np.arange(4)[:, None] == 2, bad, Q), normalise=True)


@pytest.mark.parametrize("shift", [0.0, 1e-3, 0.04, 5.0])
def test_homogeneous_matrices_are_not_four_tracks(shift: float) -> None:
    motion = np.tile(np.eye(4), (4, 1, 1))
    motion[:, :3, :3] = Rotation.from_quat(Q, scalar_first=True).as_matrix()
    motion[:, :3, 3] = shift
    with pytest.raises(ValueError, match=r"^quaternions has shape \(4, 4, 4\) .*from_matrix"):
        qs.build("slerp", None, motion)


def test_four_tracks_are_four_tracks() -> None:
    q = np.stack([walk(4, 40.0, seed) for seed in range(3)] + [np.tile([0, 0, 0, 1.0], (4, 1))], 1)
    assert qs.build("slerp", None, q)(0.5).shape == (4, 4)


@pytest.mark.parametrize(
    "given",
    [
        [np.ma.array(q, mask=[0, 0, 0, i == 2]) for i, q in enumerate(Q)],
        np.ma.array(Q, mask=np.arange(16).reshape(4, 4) == 11),
        [list(Q[0]), list(Q[1]), [*Q[2][:3], np.ma.masked], list(Q[3])],
    ],
)
def test_what_is_masked_was_not_measured(given: Any) -> None:
    with pytest.raises(ValueError, match=r"^quaternions\[2, 3\] is masked"):
        qs.build("slerp", None, given)


def test_masked_samples() -> None:
    curve = qs.build("slerp", None, Q)
    for t in ([1.0, np.ma.masked], np.ma.array([1.0, 2.0], mask=[0, 1])):
        with pytest.raises(ValueError, match=r"^t\[1\] is masked"):
            curve(t)
    assert apart(curve(np.ma.array([1.0, 2.0])), Q[1:3]) < 1e-15


class Labelled(np.ndarray):
    """A subclass that would index in a way of its own."""


def test_out_is_a_plain_array_without_overlap() -> None:
    curve = qs.build("slerp", None, Q)
    t = np.linspace(0.0, 3.0, 7)
    memory = np.zeros(64)
    strided = np.lib.stride_tricks.as_strided
    for out in (
        np.zeros((7, 4)).view(np.matrix),
        np.zeros((7, 4)).view(Labelled),
        strided(memory, (7, 4), (0, 8)),
        strided(memory, (7, 4), (8, 8)),
        np.zeros((7, 4), ">f8"),
    ):
        with pytest.raises(ValueError, match=r"^out: "):
            curve(t, out=out)
    assert not memory.any()


def test_out_may_be_the_samples_own_memory_in_the_world_frame() -> None:
    curve = qs.build("kim", None, Q)
    t = np.linspace(0.1, 2.9, 5)
    for order in (1, 2):
        memory = np.zeros((5, 3))
        memory.reshape(-1)[:5] = t
        wanted = curve(t, order, frame="world")
        assert np.array_equal(
            curve(memory.reshape(-1)[:5], order, frame="world", out=memory), wanted
        )


@pytest.mark.parametrize("value", [2, -1, 1.0, "yes", None, np.array([True]), 3_000_000])
def test_switches_are_true_or_false(value: Any) -> None:
    for name in ("closed", "align", "normalise"):
        with pytest.raises(ValueError, match=rf"^{name}="):
            qs.build("slerp", None, Q, **{name: value})


def test_switches_of_every_kind() -> None:
    for value in (True, 1, np.True_, np.int64(1)):
        assert qs.build("slerp", None, Q, closed=value).closed is True
    for sign in (np.array([1]), np.array([1, -1]), 1.0, True + 1):
        with pytest.raises(ValueError, match=r"^closing_sign="):
            qs.build("slerp", None, Q, closed=True, align=False, closing_sign=sign)
    with pytest.raises(ValueError, match=r"^frame="):
        qs.build("slerp", None, Q)(0.5, 1, frame=np.array(["body", "world"]))
