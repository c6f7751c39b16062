"""What stands in for slerp: errors against formulas, series in many digits, and each other."""

from __future__ import annotations

import json
import math
import re

import mpmath as mp
import numpy as np
import pandas as pd
import pytest
from scipy.optimize import minimize_scalar

from quatspline.figures import style
from quatspline.findings.findings import FINDINGS
from quatspline.findings.quotes import Ledger
from quatspline.instruments.slerp_variants import largest_error, nlerp_error
from quatspline.runs.experiment import Run, files
from quatspline.runs.results import Results
from quatspline.system.loading import load

ROUNDING = 3e-15


def rng() -> np.random.Generator:
    return np.random.default_rng(4)


@pytest.fixture(scope="module")
def table(tmp_path_factory) -> pd.DataFrame:
    module = load(files()["slerp-variants"], "experiment")
    run = Run(quick=True)
    rows = [row for cell in module.cells(run) for row in module.measure_cell(run, **cell)]
    frame = module.gather(run, pd.DataFrame(json.loads(json.dumps(rows))))
    return Results(tmp_path_factory.mktemp("variants")).table(
        "slerp-variants", frame, keys=module.KEYS
    )


# -- nlerp --------------------------------------------------------------------------------------


@pytest.mark.parametrize("degrees", [1, 20, 45, 90, 120, 170])
def test_the_formula_is_the_largest_lag(degrees: int) -> None:
    """The lag u theta - atan2(u sin theta, 1 - u + u cos theta), searched for its peak in 30 digits."""
    with mp.workdps(30):
        theta = mp.radians(degrees)
        sine, cosine = mp.sin(theta), mp.cos(theta)

        def lag(u):
            return u * theta - mp.atan2(u * sine, 1 - u + u * cosine)

        best = minimize_scalar(lambda u: -float(lag(mp.mpf(u))), bounds=(0, 0.5), method="bounded")
        u = mp.findroot(lambda u: mp.diff(lag, u), best.x)
        assert nlerp_error(math.radians(degrees)) == pytest.approx(2 * float(lag(u)), rel=1e-11)


def test_four_degrees_at_ninety() -> None:
    """As textbooks have it, with both angles on the sphere of unit quaternions."""
    assert math.degrees(nlerp_error(0.5 * math.pi)) / 2.0 == pytest.approx(4.075, abs=5e-4)
    measured = math.degrees(largest_error("nlerp", 0.5 * math.pi, rng())) / 2.0
    assert measured == pytest.approx(4.075, abs=5e-4)


def test_nlerp_is_measured_as_its_formula_has_it(table: pd.DataFrame) -> None:
    rows = table[table["scheme"] == "nlerp"]
    assert len(rows) > 10
    np.testing.assert_allclose(rows["error"], rows["closed_form"], rtol=1e-7)
    np.testing.assert_allclose(rows["sphere_error_degrees"], np.degrees(rows["error"]) / 2.0)


# -- fast-slerp ---------------------------------------------------------------------------------


def cut_off(theta: float, terms: int) -> float:
    """The error of the plain series cut off, without a correction of its last term, in 30 digits."""
    with mp.workdps(30):
        y, worst = 1 - mp.cos(mp.mpf(theta)), mp.mpf(0)

        def weight(u):
            term = total = u
            for k in range(1, terms + 1):
                term *= (k * k - u * u) * y / (k * (2 * k + 1))
                total += term
            return total

        for u in mp.linspace(0, 1, 101):
            f, g = weight(1 - u), weight(u)
            angle = mp.atan2(g * mp.sin(mp.mpf(theta)), f + g * mp.cos(mp.mpf(theta)))
            worst = max(worst, abs(angle - u * theta))
        return float(2 * worst)


@pytest.mark.parametrize("terms", [4, 8, 16])
def test_the_correction_is_worth_what_it_is_made_for(terms: int) -> None:
    """At a right angle the corrected polynomial beats the series cut off; at small angles it does not."""
    right, small = 0.5 * math.pi, math.radians(20.0)
    assert largest_error("fast-slerp", right, rng(), terms=terms) < cut_off(right, terms) / 2.0
    assert largest_error("fast-slerp", small, rng(), terms=terms) > cut_off(small, terms) - ROUNDING


def test_errors_fall_with_terms_and_rise_with_the_angle(table: pd.DataFrame) -> None:
    errors = table[table["scheme"] == "fast-slerp"].pivot(
        index="terms", columns="sphere_degrees", values="error"
    )
    floored = errors.clip(lower=ROUNDING)
    assert (floored.diff().iloc[1:] <= 0.0).all(axis=None)
    assert (floored.loc[4:].diff(axis=1).iloc[:, 1:] >= 0.0).all(axis=None)
    assert errors.loc[8, 90] == pytest.approx(1.661e-5, rel=1e-3)
    assert errors.loc[32].max() < 2e-13


# -- incremental-slerp --------------------------------------------------------------------------


def test_the_drift_grows_nearly_with_the_square_of_the_steps(table: pd.DataFrame) -> None:
    rows = table[table["scheme"] == "incremental-slerp"]
    assert rows["growth"].between(1.4, 2.1).all()
    least = rows[rows["steps"] == 4]["error"]
    most = rows[rows["steps"] == 4096]["error"]
    assert least.max() < 10 * ROUNDING
    assert most.min() > 1e-12
    assert most.max() < 2e-9


def test_growth_is_a_slope_of_logarithms() -> None:
    module = load(files()["slerp-variants"], "experiment")
    rows = [
        {"scheme": "incremental-slerp", "sphere_degrees": a, "steps": m, "error": c * 1e-16 * m**p}
        for a, p, c in ((5, 2.0, 1.0), (45, 1.5, 7.0))
        for m in (4, 16, 64)
    ]
    rows.append({"scheme": "nlerp", "sphere_degrees": 5, "error": 1e-5})
    grown = module.gather(Run(quick=True), pd.DataFrame(rows))["growth"]
    assert grown[:6].tolist() == pytest.approx([2.0] * 3 + [1.5] * 3)
    assert np.isnan(grown[6])


# -- the experiment -----------------------------------------------------------------------------


def test_an_arc_that_is_none_is_refused() -> None:
    for theta in (0.0, math.pi, math.nan):
        with pytest.raises(ValueError, match=r"^theta=.*: expected an angle between 0 and pi$"):
            largest_error("nlerp", theta, rng())


def test_what_a_scheme_refuses_is_a_row_with_its_reason(monkeypatch) -> None:
    module = load(files()["slerp-variants"], "experiment")
    monkeypatch.setattr(module, "STEPS", (8, 10**6))
    rows = module.measure_cell(Run(quick=True), "incremental-slerp", 45)
    assert rows[0]["error"] > 0.0
    assert re.match("ValueError: steps=1000000", rows[1]["failure"])
    assert rows[1]["steps"] == 10**6


def test_only_variants_are_measured() -> None:
    module = load(files()["slerp-variants"], "experiment")
    chosen = module.cells(Run(quick=True, schemes=["nlerp", "quartic"]))
    assert {cell["scheme"] for cell in chosen} == {"nlerp"}
    with pytest.raises(ValueError, match="only fast-slerp, incremental-slerp, nlerp stand in"):
        module.cells(Run(quick=True, schemes=["quartic"]))


def test_the_figure_is_drawn_from_the_table(table: pd.DataFrame) -> None:
    module = load(files()["slerp-variants"], "experiment")
    with style.applied():
        figure = module.draw(table)
    assert [len(ax.lines) for ax in figure.axes] == [3, 3, 2]
    assert set(module.FORMATS) <= set(table.columns)
    assert "half a turn" in module.caption(table)


def test_the_finding_says_what_the_table_holds(table: pd.DataFrame) -> None:
    sentence = dict(FINDINGS)["slerp-variants"]
    said = "".join(map(str, sentence(Ledger({"slerp-variants": table}.__getitem__))))
    assert "off by up to 4.075 degrees" in said
    assert "a step of 180 degrees" in said
    assert re.search(
        r"off by 6\.3e-04 rad with 4 terms, 1\.7e-05 with 8 and 2\.5e-08 with 16", said
    )
    assert re.search(r"drifts by \d\.\de-13 rad in 64 steps and \d\.\de-10 in 4096", said)
