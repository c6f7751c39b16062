"""The invariance instrument on schemes that are invariant, and on ones broken on purpose."""

from __future__ import annotations

import numpy as np
import pytest

from quatspline import quaternion
from quatspline.instruments.invariance import PROPERTIES, SHELL, invariance
from quatspline.instruments.trials import builder
from quatspline.trajectories.walks import walk
from toys import Toy

TIMES = np.array([0.0, 1.0, 1.5, 3.25, 4.0])
KEYS = walk(np.random.default_rng(0), 5, 50.0)[:, 0]
STEP = np.radians(50.0)
TILT = 0.01


def rng() -> np.random.Generator:
    return np.random.default_rng(7)


def measured(build, times=TIMES, keys=KEYS):
    return {row["property"]: row for row in invariance(build, times, keys, rng())}


def broken(rows) -> set[str]:
    return {name for name, row in rows.items() if not row["invariant"]}


class _Tilted(Toy):
    """Turned by a constant rotation about a fixed axis of the world."""

    def _orientation(self, t):
        return quaternion.mul(
            quaternion.exp([0.0, 0.0, TILT]), self.slerped(*self.keyframes.locate(t))
        )


class _Late(Toy):
    """Starts every segment at rest."""

    def _orientation(self, t):
        segment, u = self.keyframes.locate(t)
        return self.slerped(segment, u**2)


class _Slow(Toy):
    """Waits at a keyframe after one unit of time."""

    def _orientation(self, t):
        segment, _ = self.keyframes.locate(t)
        since = t - self.keyframes.knots[segment]
        return self.slerped(segment, np.minimum(since, 1.0))


class _Nothing(Toy):
    def _orientation(self, t):
        return np.full((len(t), 4), np.nan)


@pytest.mark.parametrize("name", ["slerp", "squad", "nielson"])
def test_invariant_schemes_are_found_so(name):
    rows = measured(builder(name))
    assert list(rows) == list(PROPERTIES)
    assert broken(rows) == set()
    assert max(row["deviation"] for row in rows.values()) < 1e-10


def test_a_scheme_broken_under_left_multiplication_is_found_by_how_much():
    rows = measured(_Tilted)
    assert broken(rows) == {"left multiplication", "half-turn shell"}
    tilt = quaternion.exp([0.0, 0.0, TILT])
    units = quaternion.normalise(rng().normal(size=(3, 4)))
    expected = quaternion.distance(quaternion.mul(tilt, units), quaternion.mul(units, tilt)).max()
    row = rows["left multiplication"]
    assert row["deviation"] == pytest.approx(expected, rel=1e-9)
    assert row["relative"] == pytest.approx(expected / STEP, rel=1e-9)


def test_a_scheme_with_a_direction_of_time():
    rows = measured(_Late)
    assert broken(rows) == {"time reversal"}
    u = 7.0 / 16.0  # the sample nearest the middle, where u^2 and 1 - (1 - u)^2 are farthest apart
    assert rows["time reversal"]["deviation"] == pytest.approx(2.0 * u * (1.0 - u) * STEP)


def test_a_scheme_with_a_unit_of_time():
    assert "time scale" in broken(measured(_Slow))
    assert "time shift" not in broken(measured(_Slow))


def test_signs_matter_where_they_are_kept():
    def kept(times, keys):
        return builder("slerp", align=False)(times, keys)

    assert broken(measured(kept)) == {"key signs"}


def test_a_fixed_chart_folds_in_the_shell():
    """A chart centred at the first keyframe is invariant; one at the identity is not."""
    assert "half-turn shell" not in broken(measured(builder("log-cubic")))

    class Chart(Toy):
        def _orientation(self, t):
            segment, u = self.keyframes.locate(t)
            logs = quaternion.log(self.keyframes.quaternions)
            return quaternion.exp(
                (1.0 - u)[:, None] * logs[segment] + u[:, None] * logs[segment + 1]
            )

    assert "half-turn shell" in broken(measured(Chart))


def test_the_shell_is_where_it_says():
    changes = PROPERTIES["half-turn shell"](TIMES, KEYS, rng())
    one = np.array([1.0, 0.0, 0.0, 0.0])
    for change, degrees in zip(changes, SHELL, strict=True):
        angles = np.degrees(2.0 * np.arccos(np.clip(change.keyframes @ one, -1.0, 1.0)))
        assert (
            np.abs(angles - degrees).min() < 1e-5 or np.abs(angles - (360 - degrees)).min() < 1e-5
        )


def test_what_is_not_a_number_is_not_invariant():
    rows = measured(_Nothing)
    assert broken(rows) == set(PROPERTIES)


def test_a_refusal_is_a_row_with_its_reason():
    def picky(times, keys):
        if times[0] != 0.0:
            raise ValueError("times[0] must be 0")
        return builder("slerp")(times, keys)

    rows = {row["property"]: row for row in invariance(picky, TIMES, KEYS, rng())}
    assert rows["time shift"]["failure"] == "ValueError: times[0] must be 0"
    assert rows["time scale"]["invariant"]
