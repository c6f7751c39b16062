"""The lookahead instrument on curves that look ahead as far as the test says, and the claim's default."""

from __future__ import annotations

import numpy as np
import pytest

from quatspline import quaternion
from quatspline.catalogue import build, scheme
from quatspline.claims import probes
from quatspline.instruments.lookahead import COUNT, lookahead, moved
from quatspline.instruments.trials import builder
from quatspline.trajectories.walks import walk
from toys import Toy

TIMES = np.arange(float(COUNT))
KEYS = walk(np.random.default_rng(2), COUNT, 40.0)[:, 0]


def seeing(behind: int, ahead: int) -> type[Toy]:
    """A slerp nudged by so many keyframes behind and ahead of a segment's own two."""

    class Seeing(Toy):
        def _orientation(self, t):
            segment, u = self.keyframes.locate(t)
            q, last = self.keyframes.quaternions, len(self.keyframes.quaternions) - 1
            nudge = np.zeros((len(t), 3))
            for k in range(-behind, ahead + 2):
                nudge += quaternion.log(q[np.clip(segment + k, 0, last)])
            weight = (0.01 * u * (1.0 - u))[:, None]
            return quaternion.mul(self.slerped(segment, u), quaternion.exp(weight * nudge))

    return Seeing


@pytest.mark.parametrize(("behind", "ahead"), [(0, 0), (0, 1), (3, 0), (2, 4), (COUNT, 3)])
def test_what_lies_ahead_is_told_from_what_lies_behind(behind, ahead):
    assert lookahead(moved(seeing(behind, ahead), TIMES, KEYS)) == ahead


def test_all_keyframes_ahead_are_none():
    assert lookahead(moved(seeing(0, COUNT), TIMES, KEYS)) is None
    assert lookahead(moved(builder("kim"), TIMES, KEYS)) is None
    assert probes.lookahead("kim") == "all"
    assert probes.lookahead("quartic") == 1


def test_one_segment_alone_that_looks_ahead_counts():
    responses = np.zeros((COUNT, COUNT - 1))
    responses[7, 2] = 1e-6
    assert lookahead(responses) == 4
    responses[7, 2] = np.nan
    assert lookahead(responses) == 4


def test_the_claim_follows_from_the_support_of_class_and_instance():
    assert [scheme(name).lookahead for name in ("slerp", "quartic", "local-quintic", "kim")] == [
        *(0, 1, 3),
        None,
    ]
    for window in (2, 4):
        curve = build("local-quintic", TIMES, KEYS, window=window)
        assert curve.lookahead == window
        again = builder("local-quintic", window=window)
        assert lookahead(moved(again, TIMES, KEYS)) == window
    assert build("hermite", TIMES, KEYS, window=5).lookahead == 2


def test_a_claim_of_its_own_goes_before_the_default():
    class Marching(Toy):
        lookahead = 0

        def _fit(self, keyframes, *, wait: int = 0):
            self.lookahead = wait

        def _orientation(self, t):
            return self.slerped(*self.keyframes.locate(t))

    assert (Toy.lookahead, Marching.lookahead) == (None, 0)
    assert Marching(TIMES, KEYS, wait=2).lookahead == 2
