"""Where every iterative scheme converges, in how many iterations, and how fast in the end."""

import time
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline import catalogue
from quatspline.curve import Curve
from quatspline.figures import style
from quatspline.instruments.continuity import jumps
from quatspline.instruments.convergence import (
    FAILURES,
    failures,
    measured_rate,
    methods,
    solved,
    theoretical_rate,
)
from quatspline.instruments.trials import reason
from quatspline.quaternion import FloatArray
from quatspline.runs.experiment import Run
from quatspline.timing.budget import too_many
from quatspline.trajectories.walks import walk

TITLE = "Convergence of iterative schemes"
PAPER = False
KEYS = ["scheme", "method", "keyframes", "step_degrees", "unevenness"]
LIMIT = 200
UPDATES, UPDATES_BEYOND = 4_200_000, 1_500_000
"""Keyframe updates a cell may spend, up to 33 keyframes (all sets, none of which converges) and beyond: a
bound in seconds would make the table depend on the machine."""
PRACTICAL = 24
"""A scheme that names the keyframes it is practical for may update that many this often in a cell."""
BATCH = 100
"""Keyframes solved in one call: sets on the same times, of which every call draws its own."""

NOTE = (
    "Open random walks about random axes; unevenness is the largest possible ratio of two knot spacings, which are "
    f"log-uniform. At most {LIMIT} iterations to a residual of 1e-6 (min-torque: to a change of that size). Failures: "
    "limit, the iterations ran out; wrong, the iteration settled where the curve misses keyframes; gave_up, the "
    "solver ended its search; not_finite. Iterations are of the sets that converge. rate is the factor by which a "
    "late iteration reduces the change (median of a few sets); rate_theory is the spectral radius of the flat "
    "equations for the same knots, and above 1 the linear iterations diverge. jump_*: acceleration jumps at inner "
    "keyframes relative to the peak, for curves that claim C2; share_jumping is the share of sets in which it counts "
    "as a jump. Libraries that solve for all keyframes without a report are listed by that jump alone, over jump_sets "
    "sets. Where the keyframe updates of a cell reach their limit, failure says over budget, and sets says how many "
    f"were measured: a few for min-torque. One call solves sets of up to {BATCH} keyframes together, on the same times."
)
FORMATS = {"seconds_median": ".2e", "jump_median": ".1e", "jump_worst": ".1e"}
ANGLES = (1, 30, 60, 90, 120, 150, 170)
RATIOS = (1, 3, 10, 30)
COUNTS = (5, 9, 17, 33)
BEYOND = (100, 1000, 10_000)
SETS, SETS_BEYOND, SETS_QUICK = 10_000, 100, 20
"""A scheme and step angle: in all up to 33 keyframes; for each count beyond; a cell at quick size."""
DENSE = 200
"""Keyframes up to which the rate is measured, and the theory's matrix is held."""
RATED, RATED_QUICK = 3, 2
"""Sets of a cell whose rate is measured."""
JUMP_KEYFRAMES, JUMP_KEYFRAMES_QUICK = 330, 20
"""Keyframes in all the sets of a cell whose jump is measured."""


def cells(run: Run) -> list[dict[str, Any]]:
    angles, ratios = ((1, 60, 170), (1, 10)) if run.quick else (ANGLES, RATIOS)
    counts = (5, 33) if run.quick else COUNTS + BEYOND
    return [
        {"scheme": name, "method": method, "step_degrees": a, "unevenness": r, "keyframes": n}
        for name, cls in _concerned(run).items()
        for method in (methods(cls) if cls.iterative else (None,))
        for n in counts
        for a in angles
        for r in ratios
        if cls.iterative or n in COUNTS
    ]


def _concerned(run: Run) -> dict[str, type[Curve]]:
    """Iterative schemes, and libraries that solve for all keyframes without telling how it went."""
    known = {name: catalogue.scheme(name) for name in run.schemes or catalogue.schemes()}
    silent = {name for name, cls in known.items() if cls.peer and cls.support is None}
    return {name: cls for name, cls in known.items() if cls.iterative or name in silent}


def measure_cell(
    run: Run, scheme: str, method: str | None, step_degrees: int, unevenness: int, keyframes: int
) -> dict[str, Any]:
    cls = catalogue.scheme(scheme)
    row: dict[str, Any] = {"scheme": scheme, "method": method, "keyframes": keyframes}
    row |= {"step_degrees": step_degrees, "unevenness": unevenness, "failure": None}
    if failure := too_many(cls, keyframes):
        return row | {"sets": 0, "failure": failure}
    rng = run.rng("convergence", step_degrees, unevenness, keyframes)
    sets = _sets(run, keyframes)
    q = walk(rng, keyframes, float(step_degrees), sets)
    grids = [_times(rng, keyframes, unevenness) for _ in range(sets)]
    try:
        if cls.iterative:
            row |= _solves(run, cls, method, grids, q)
        return row | _jumps(run, cls, method, grids, q)
    except Exception as error:  # what does not apply is a row with its reason
        return row | {"failure": reason(error)}


def _sets(run: Run, keyframes: int) -> int:
    if run.quick:
        return SETS_QUICK
    if keyframes in COUNTS:
        return SETS // (len(COUNTS) * len(RATIOS))
    return SETS_BEYOND // len(RATIOS)


def _times(rng: np.random.Generator, count: int, ratio: float) -> FloatArray:
    """Times (count,) whose spacings are log-uniform in [1, ratio]."""
    return np.concatenate([[0.0], np.cumsum(ratio ** rng.uniform(size=count - 1))])


# -- solves -------------------------------------------------------------------------------------


def _solves(
    run: Run, cls: type[Curve], method: str | None, grids: list[FloatArray], q: FloatArray
) -> dict[str, Any]:
    """Iterations, failures and time of batches of sets, until the updates reach their bound."""
    keyframes, sets = q.shape[:2]
    bound = _bound(run, cls, keyframes)
    size = max(1, min(BATCH // keyframes, bound // (LIMIT * keyframes)))
    solved(cls, grids[0], q[:, :1], method, max_iterations=1)  # compiled code is loaded
    iterations, seconds, failed, spent, measured = [], [], dict.fromkeys(FAILURES, 0), 0, 0
    while measured < sets and spent < bound:
        part = q[:, measured : measured + size]
        start = time.perf_counter()
        _, report = solved(cls, grids[measured], part, method, max_iterations=LIMIT)
        seconds.append((time.perf_counter() - start) / part.shape[1])
        failed = {kind: failed[kind] + n for kind, n in failures(report, LIMIT).items()}
        iterations.append(report.iterations[report.converged])
        spent += int(report.iterations.sum()) * keyframes
        measured += part.shape[1]
    good = np.concatenate(iterations)
    return {
        "sets": measured,
        "share_converged": good.size / measured,
        **{f"failed_{kind}": count for kind, count in failed.items()},
        **_spread(good),
        "seconds_median": float(np.median(seconds)),
        **_rates(cls, method, grids[0], q[:, : RATED_QUICK if run.quick else RATED]),
        "failure": None if measured == sets else f"over budget: {sets} sets were asked for",
    }


def _bound(run: Run, cls: type[Curve], keyframes: int) -> int:
    bound = UPDATES if keyframes in COUNTS else UPDATES_BEYOND
    if cls.practical_keyframes is not None:
        bound = PRACTICAL * cls.practical_keyframes
    return bound // 10 if run.quick else bound


def _spread(iterations: Any) -> dict[str, float]:
    levels = {"iterations_median": 0.5, "iterations_q95": 0.95, "iterations_most": 1.0}
    if not iterations.size:
        return dict.fromkeys(levels, np.nan)
    return dict(zip(levels, np.quantile(iterations, list(levels.values())), strict=True))


def _rates(
    cls: type[Curve], method: str | None, times: FloatArray, q: FloatArray
) -> dict[str, float]:
    if len(times) > DENSE or (cls.practical_keyframes is not None and len(times) > COUNTS[0]):
        return {"rate": np.nan, "rate_theory": np.nan}
    rates = measured_rate(cls, times, q, method)
    _, report = solved(cls, times, q, method, max_iterations=LIMIT)
    rates = rates[report.converged & np.isfinite(rates)]
    rate = float(np.median(rates)) if rates.size else np.nan
    return {"rate": rate, "rate_theory": theoretical_rate(method, times)}


def _jumps(
    run: Run, cls: type[Curve], method: str | None, grids: list[FloatArray], q: FloatArray
) -> dict[str, Any]:
    """What acceleration jumps are left by the scheme's own stop, where C2 is claimed."""
    if cls.continuity < 2:
        return {}
    few = run.quick or (cls.iterative and cls.practical_keyframes is not None)
    sets = max(1, (JUMP_KEYFRAMES_QUICK if few else JUMP_KEYFRAMES) // len(q))
    curves = []
    for k in range(sets):
        if not cls.iterative:
            curves.append(cls(grids[k], q[:, k]))
            continue
        curve, report = solved(cls, grids[k], q[:, k], method, max_iterations=LIMIT)
        curves += [curve] if report.converged else []
    if not curves:
        return {"jump_sets": 0}
    found = pd.concat([jumps(curve, orders=[2]) for curve in curves])
    return {
        "jump_sets": len(curves),
        "jump_median": found["relative"].median(),
        "jump_worst": found["relative"].max(),
        "share_jumping": float((~found["continuous"].astype(bool)).mean()),
    }


# -- figure -------------------------------------------------------------------------------------


COLUMNS = 4


class Block(NamedTuple):
    """Panels of schemes and methods that show one share, in colours of its own, and what is written on it."""

    groups: list[Any]
    share: str
    colours: str
    label: str
    written: str

    @property
    def rows(self) -> int:
        """Of panels."""
        return -(-len(self.groups) // COLUMNS)


def draw(table: pd.DataFrame) -> Figure:
    count = int(table.loc[table["keyframes"] <= COUNTS[-1], "keyframes"].max())
    shown = table[table["keyframes"] == count].fillna({"method": ""})
    shown = shown.assign(share_smooth=1.0 - shown["share_jumping"])
    told = shown.groupby("scheme")["share_converged"].transform("count") > 0
    solving, silent = _groups(shown[told]), _groups(shown[~told])
    blocks = [
        Block(
            solving, "share_converged", "viridis", "share of sets solved", "median of iterations"
        ),
        Block(
            *(silent, "share_smooth", "cividis", "share of sets without a jump"),
            "worst jump of acceleration over the peak",
        ),
    ]
    blocks = [block for block in blocks if block.groups]
    heights = [block.rows for block in blocks]
    size = style.PAGE, 1.6 * sum(heights) + 0.8 * len(heights)
    fig = Figure(figsize=size, layout="constrained")
    parts: Any = fig.subfigures(
        len(blocks), 1, height_ratios=[h + 0.4 for h in heights], squeeze=False
    )
    for letter, part, block in zip("ab", parts[:, 0], blocks, strict=False):
        _block(part, block)
        title = f"({letter}) colour: {block.label}; number: {block.written}"
        part.suptitle(title, x=0.01, ha="left", fontsize=9)
    return fig


def _groups(rows: pd.DataFrame) -> list[Any]:
    return list(rows.groupby(["scheme", "method"], sort=True))


def _block(fig: Any, block: Block) -> None:
    """The panels of one quantity, with its bar."""
    groups, rows = block.groups, block.rows
    panels = fig.subplots(rows, COLUMNS, squeeze=False, sharex=True, sharey=True)
    for ax in panels.flat[len(groups) :]:
        ax.set_visible(False)
    for ax, ((name, method), group) in zip(panels.flat, groups, strict=False):
        image = _heat(ax, group, block.share, block.colours)
        ax.set_title(f"{name}\n{method}" if method else name, fontsize=8)
    for ax in panels.flat[max(len(groups) - COLUMNS, 0) : len(groups)]:  # the lowest that are drawn
        ax.tick_params(labelbottom=True)
    used = panels[:, : min(len(groups), COLUMNS)]
    for ax in used[-1]:
        ax.set_xlabel("unevenness")
    for ax in used[:, 0]:
        ax.set_ylabel("step angle (degrees)")
    fig.colorbar(image, ax=used, label=block.label, shrink=0.9, aspect=14 * rows)


def _heat(ax: Any, group: pd.DataFrame, share: str, colours: str) -> Any:
    """A share as colour; written on it the median of iterations, or the worst jump."""
    solved = share == "share_converged"
    noted = (
        group["iterations_median"].map("{:.0f}".format)
        if solved
        else group["jump_worst"].map(_power)
    )
    frame = group.assign(noted=noted)
    grid = frame.pivot(index="step_degrees", columns="unevenness", values=share)
    notes = frame.pivot(index="step_degrees", columns="unevenness", values="noted")
    image = ax.imshow(grid, origin="lower", aspect="auto", vmin=0.0, vmax=1.0, cmap=colours)
    ax.set_xticks(range(grid.shape[1]), grid.columns)
    ax.set_yticks(range(grid.shape[0]), grid.index)
    ax.grid(False)
    for (i, j), value in np.ndenumerate(grid.to_numpy()):
        if np.isfinite(value) and notes.iat[i, j] != "nan":
            color = "black" if value > 0.6 else "white"
            ax.text(j, i, notes.iat[i, j], ha="center", va="center", fontsize=7, color=color)
    return image


def _power(value: float) -> str:
    """A small number in few characters."""
    return f"{value:.0e}".replace("e-0", "e-").replace("e+00", "")


def caption(table: pd.DataFrame) -> str:
    count = int(table.loc[table["keyframes"] <= COUNTS[-1], "keyframes"].max())
    return (
        f"Share of random sets of {count} keyframes that are solved within {LIMIT} iterations, by step angle and by "
        "unevenness of the knots (largest possible ratio of spacings). The number in a cell is the median of the "
        "iterations of the sets that converge. Libraries that do not report on their solves are shown below, with "
        "their own colour bar: the share of sets without a jump of acceleration, and as a number the worst jump "
        "relative to the peak."
    )
