"""The locality instrument on responses of known reach and decay."""

from __future__ import annotations

import numpy as np
import pytest

from quatspline import quaternion
from quatspline.instruments.locality import SAMPLES, locality, responses
from quatspline.instruments.trials import builder
from quatspline.trajectories.walks import walk
from toys import Toy

COUNT = 31
TIMES = np.arange(float(COUNT))
SAME = np.tile([1.0, 0.0, 0.0, 0.0], (COUNT, 1))
U = (np.arange(SAMPLES) + 0.5) / SAMPLES


class _Chart(Toy):
    """Half rotation vectors, combined linearly: on equal keyframes responses are the weights."""

    def _orientation(self, t):
        segment, u = self.keyframes.locate(t)
        weights = self.weights(segment[:, None] - np.arange(COUNT), u[:, None])
        return quaternion.exp(weights @ quaternion.log(self.keyframes.quaternions))

    def weights(self, offset, u):
        """Of keyframes, `offset` before the segment (0: its start, -1: its end), (m, n)."""
        return np.where(offset == 0, 1.0 - u, 0.0) + np.where(offset == -1, u, 0.0)


class _Bumped(_Chart):
    """A keyframe is felt again in the third segment after it, by a tenth."""

    def weights(self, offset, u):
        return super().weights(offset, u) + np.where(offset == 2, 0.1 * np.sin(np.pi * u), 0.0)


class _Fading(_Chart):
    """The response falls to 0.3 from segment to segment."""

    def weights(self, offset, u):
        away = np.where(offset >= 0, offset, -1 - offset)
        return 0.3**away * np.ones_like(u)


def test_the_keyframes_own_segments():
    table = responses(_Chart, TIMES, SAME)
    found = locality(table)
    assert (found["reach_before"], found["reach_after"], found["support"]) == (1, 1, 2)
    assert found["amplification"] == pytest.approx(U.max())
    assert np.isnan(found["decay"])
    assert table["offset"].tolist() == [*range(-15, 0), *range(1, 16)]


def test_a_planted_bump_is_found_where_it_is():
    table = responses(_Bumped, TIMES, SAME)
    found = locality(table)
    assert (found["reach_before"], found["reach_after"]) == (1, 3)
    row = table.set_index("offset")["response"]
    assert row[3] == pytest.approx(0.1 * np.sin(np.pi * U).max(), rel=0.01)
    assert row[2] < 1e-12


def test_a_decay_is_found():
    found = locality(responses(_Fading, TIMES, SAME))
    assert found["decay"] == pytest.approx(0.3, rel=0.01)
    assert found["support"] == COUNT - 1


@pytest.mark.parametrize("name", ["kim", "nielson"])
def test_cubic_splines_decay_by_two_less_root_three(name):
    """In the flat limit both are the interpolating cubic spline: each response is sqrt(3) - 2 of the last."""
    found = locality(responses(builder(name), TIMES, SAME))
    assert found["decay"] == pytest.approx(2.0 - np.sqrt(3.0), rel=0.01)


@pytest.mark.parametrize("name", ["slerp", "squad", "quartic", "local-quintic"])
def test_local_schemes_reach_what_they_claim(name):
    keys = walk(np.random.default_rng(1), COUNT, 60.0)[:, 0]
    assert (
        locality(responses(builder(name), TIMES, keys))["support"]
        == builder(name)(TIMES, keys).support
    )


def test_a_curve_that_ignores_its_keyframes_reaches_nothing():
    class Still(_Chart):
        def weights(self, offset, u):
            return 0.0 * offset * u

    found = locality(responses(Still, TIMES, SAME))
    assert (found["support"], found["amplification"]) == (0, 0.0)
