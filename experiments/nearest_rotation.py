"""The nearest rotation that every sample of moving frames requires: three ways to find it."""

from typing import Any

import pandas as pd

from quatspline.instruments.trials import Row
from quatspline.runs.experiment import Run
from quatspline.timing.interleaved import LEAST
from quatspline.timing.nearest_rotation import measured, noisy, walked

TITLE = "The nearest rotation"
PAPER = False
SERIAL = True
KEYS = ["data", "step_degrees", "method"]
NOTE = (
    "The nearest rotation is found for two kinds of matrices: frames of cubic splines through walks of 9 keyframes, "
    "between keyframes and seen from the middle of their arc ('frames', by step), and rotations by up to a radian "
    "with noise of 0.3 in every entry ('noise'). systems: linear systems that the iteration solves per matrix, each "
    "of order three or of order two. error: largest angle from the stationary rotation, in rad. Seconds are per "
    "matrix, timed in turn on one thread, compiled, and compared with numpy's singular values of all matrices in one "
    "call; lower is better."
)
FORMATS = {
    "error": ".1e",
    "systems_median": ".0f",
    "systems_q95": ".0f",
    "seconds_median": ".3g",
    "seconds_iqr": ".1g",
    "over_svd": ".3f",
}
DEGREES = (20, 60, 90, 120)


def cells(run: Run) -> list[dict[str, Any]]:
    return [{"data": "frames", "degrees": degrees} for degrees in DEGREES] + [{"data": "noise"}]


def measure_cell(run: Run, data: str, degrees: int | None = None) -> list[Row]:
    rng, count = run.rng("nearest-rotation", data, degrees), 2_000 if run.quick else 20_000
    matrices = noisy(rng, count) if degrees is None else walked(rng, count, float(degrees))
    least, rounds = (LEAST / 10, 3) if run.quick else (LEAST, 15)
    base = {"data": data, "step_degrees": degrees}
    return [base | row for row in measured(matrices, rounds, run.seed, least)]


def gather(run: Run, table: pd.DataFrame) -> pd.DataFrame:
    return table.assign(run_size=run.size)
