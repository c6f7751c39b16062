"""Both engines: plain Python is the reference that compiled kernels are held against."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

import quatspline as qs
from processes import environment
from quatspline.comparing import compare
from quatspline.engines import engine, plain
from quatspline.families.arcs import SIZE, acceleration, near_point, velocity
from quatspline.kernels.family import family as made_family
from quatspline.kernels.jit import compiled, fit_kernel
from quatspline.segments import CHUNK, FITTED, LAZY, SegmentCurve
from walks import applies, count_of, inside, knots_of, walk

AGREE, REPEATED, MANY = 1e-13, 1e-11, 10
"""Engines round differently, by contraction to fused multiply-adds; rates of what an iteration solved, or of
many steps one after the other, multiply that."""


@pytest.fixture
def automatic(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(engine.VARIABLE, raising=False)


@applies(lambda scheme: issubclass(scheme, SegmentCurve))
@pytest.mark.parametrize("degrees", [5.0, 40.0, 150.0])
def test_engines_agree(scheme, degrees: float, monkeypatch: pytest.MonkeyPatch) -> None:
    n = min(count_of(scheme), 5)
    repeats = scheme.iterative or scheme.operations.logs.keyframe > MANY
    for closed in (False, True) if scheme.closable else (False,):
        t = knots_of(scheme, n + closed)
        q = walk(n, degrees, seed=3)
        values = {}
        for name in ("python", "compiled"):
            monkeypatch.setenv(engine.VARIABLE, name)
            try:
                curve = scheme(t, q, closed=closed)
            except qs.ConvergenceError:
                values[name] = None
                continue
            assert curve.engine == name
            at = np.concatenate([inside(curve.times, 3), curve.times])
            values[name] = [curve(at, order) for order in curve.orders]
            assert curve.engine == name  # nothing made it give up in between
        plain, fast = values["python"], values["compiled"]
        assert (plain is None) == (fast is None)
        for order, (a, b) in enumerate(zip(plain or (), fast or (), strict=True)):
            bound = REPEATED if order and repeats else AGREE
            assert np.abs(a - b).max() <= bound * max(1.0, np.abs(b).max())


def test_several_tracks_and_flips_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two tracks that close with either sign, over several periods."""
    half = np.linspace(0.0, np.pi, 5)[:, None]
    turn = np.where(np.arange(4) == 0, np.cos(half), np.where(np.arange(4) == 1, np.sin(half), 0))[
        :4
    ]
    q = np.stack([turn, walk(4, 30.0, seed=1)], axis=1)
    got = {}
    for name in ("python", "compiled"):
        monkeypatch.setenv(engine.VARIABLE, name)
        curve = qs.build("squad", np.arange(5.0), q, closed=True)
        got[name] = curve(np.linspace(-6.0, 9.0, 31)), curve.keyframes.signs
    assert set(got["python"][1]) == {1.0, -1.0}
    np.testing.assert_allclose(got["python"][0], got["compiled"][0], atol=1e-14)


def test_a_refused_sample_is_named_by_plain_python_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(engine.VARIABLE, "python")
    curve = qs.build("slerp", None, walk(4, 30.0))
    with pytest.raises(ValueError, match=r"t\[1\] = 3\.5: outside the domain"):
        curve([0.5, 3.5])
    with pytest.raises(ValueError, match=r"t = nan: not a finite number"):
        curve(np.nan)


FRESH = """
import sys, quatspline as qs
keys = [[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0, 0.6, 0.8, 0], [0, 0, 1, 0]]
curve = qs.build("local-quintic", None, keys)
curve(0.5), curve([0.5, 2.5], 2)
print(curve.engine, "numba" in sys.modules, end=" ")
curve.keyframes.inside(40000), curve(curve.keyframes.inside(40000))
print(curve.engine, "numba" in sys.modules, qs.build("local-quintic", None, keys).engine)
"""


def test_an_answer_needs_no_compiler_and_work_that_repays_it_gets_one() -> None:
    env = {k: v for k, v in environment().items() if k != engine.VARIABLE}
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", FRESH],
        capture_output=True,
        text=True,
        env=env,
        check=True,
    )
    assert done.stdout.split() == ["python", "False", "compiled", "True", "compiled"]


def fresh_scheme() -> type[SegmentCurve]:
    """Slerp with kernels that nothing has compiled."""
    kernel = fit_kernel(qs.build("slerp", None, walk(4, 30.0)).fit_kernel.python)

    class Fresh(SegmentCurve):
        title = reference = "-"
        continuity, order, support, constant_rate = 0, 2, 2, "everywhere"
        family = made_family(SIZE, near_point, velocity=velocity, acceleration=acceleration)

        def _fit(self, keyframes):
            self._solve(kernel)

    return Fresh


def test_a_curve_tells_its_engine_and_keeps_it(automatic, monkeypatch) -> None:
    """At a twenty-fifth of the work."""
    monkeypatch.setattr(engine, "REPAYS", 4000.0)
    Fresh = fresh_scheme()
    curve = Fresh(None, walk(4, 30.0))
    assert curve.engine == "python"
    before = curve(0.5)
    assert curve.engine == "python"
    curve(np.linspace(0.0, 3.0, 4000))
    assert curve.engine == "compiled"
    np.testing.assert_allclose(curve(0.5), before, atol=1e-15)


def test_many_small_curves_repay_it_too(automatic, monkeypatch) -> None:
    monkeypatch.setattr(engine, "REPAYS", 3000.0)
    Small = fresh_scheme()
    engines = []
    for _ in range(40):
        curve = Small(None, walk(4, 30.0))
        curve(np.linspace(0.0, 3.0, 100))
        engines.append(curve.engine)
    assert engines[0] == "python"
    assert engines[-1] == "compiled"


def test_one_order_that_is_compiled_commits_no_other(automatic, monkeypatch) -> None:
    monkeypatch.setattr(engine, "REPAYS", 4000.0)
    Fresh = fresh_scheme()
    worked = Fresh(None, walk(4, 30.0))
    worked(np.linspace(0.0, 3.0, 4000))
    for curve in (worked, Fresh(None, walk(4, 30.0))):
        assert curve.engine == "compiled"
        curve(0.5, 2)
        assert [bool(kernel.address) for kernel in curve.kernels] == [True, False, False]


def test_windows_of_a_long_curve_count_where_they_are_fitted(automatic, monkeypatch) -> None:
    """Nothing before, so that a look costs no compiling; then each, until they repay it."""
    for name in ("REPAYS", "LOADS"):
        monkeypatch.setattr(engine, name, 2.5 * FITTED * CHUNK)
    curve = fresh_scheme()(None, np.tile([1.0, 0.0, 0.0, 0.0], (LAZY + 2, 1)))
    assert curve.fit_kernel.work == 0.0
    machine = []
    for chunk in range(4):
        curve((chunk + 0.5) * CHUNK)
        machine.append(bool(curve.fit_kernel.address))
    assert machine == [False, False, True, True]


def test_a_scheme_without_kernels_has_no_engine() -> None:
    assert qs.build("scipy-slerp", None, walk(4, 30.0)).engine is None


def test_tables_are_compiled_first(automatic, monkeypatch) -> None:
    def never(*arguments):
        raise AssertionError("plain Python ran")

    monkeypatch.setattr(plain, "fit_tracks", never)
    monkeypatch.setattr(plain, "sample", never)
    assert compare(None, walk(4, 30.0), ["slerp"])["failure"].isna().all()


def test_what_was_compiled_before_repays_sooner(automatic, monkeypatch, tmp_path) -> None:
    monkeypatch.setenv("QUATSPLINE_CACHE", str(tmp_path))
    engine.mark_warm()
    assert [engine.compiles(work) for work in (1.0, engine.LOADS)] == [False, True]
    next(tmp_path.glob("*.warm")).unlink()
    engine.forget_warm()
    assert not engine.compiles(engine.LOADS)
    assert engine.compiles(engine.REPAYS)


def test_what_python_refuses_to_divide_is_compiled(monkeypatch) -> None:
    monkeypatch.setenv(engine.VARIABLE, "python")

    def inverse(x):
        return 1.0 / x

    assert engine.run(compiled(inverse), 1, 4.0) == 0.25
    assert engine.run(compiled(inverse), 1, 0.0) == np.inf


def test_a_mistake_is_not_compiled_away(monkeypatch) -> None:
    monkeypatch.setenv(engine.VARIABLE, "python")

    def wrong(x):
        return np.zeros(3) + np.zeros(4)

    with pytest.raises(ValueError, match="broadcast"):
        engine.run(compiled(wrong), 1, 1.0)


def test_what_plain_python_wrote_before_it_gave_up_is_undone(monkeypatch) -> None:
    monkeypatch.setenv(engine.VARIABLE, "python")

    def halved(x, y):
        x[0] = 0.5 * x[0]
        return x[0] / y

    x = np.array([4.0])
    assert engine.run(compiled(halved), 1, x, 0.0) == np.inf
    assert x[0] == 2.0


def test_an_unknown_engine_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(engine.VARIABLE, "gpu")
    with pytest.raises(
        ValueError, match="QUATSPLINE_ENGINE='gpu': expected 'python' or 'compiled'"
    ):
        qs.build("slerp", None, walk(4, 30.0))
