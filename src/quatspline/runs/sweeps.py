"""Sweeps: an experiment's cells measured on all cores or on a Dask cluster, none ever lost.

An experiment that varies something defines, instead of ``measure(run)``,

``cells(run) -> list[dict]``                 what is varied: JSON scalars by name, in order
``measure_cell(run, **cell) -> dict | list`` the row or rows of a cell; what fails is a row too
``gather(run, table) -> DataFrame``          optional: columns that need all cells
``SERIAL: bool``                             optional: its cells time something, so they run one
                                             after the other in this process

A finished cell is appended to a journal at once, and an interrupted run goes on with the others.  Rows
pass through JSON, which keeps every bit of a float, and stand in the order of the cells: the table
does not depend on the number of workers or on interruptions.
"""

from __future__ import annotations

import importlib.util
import json
import os
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from functools import cache
from types import ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple

from quatspline import catalogue
from quatspline.engines.engine import always_compiled
from quatspline.runs import experiment
from quatspline.runs.experiment import Run
from quatspline.runs.journal import Cell, Kept, key
from quatspline.system.ending import bind_to, hang_up_ignored
from quatspline.trajectories import clips

if TYPE_CHECKING:
    import pandas as pd

PATIENCE = 10.0
"""Seconds to wait for a Dask scheduler, and for its first worker."""


class Done(NamedTuple):
    """A measured cell as it comes from a worker: its rows as JSON, or the trace of what went wrong."""

    place: int
    rows: str
    problem: str | None = None


# -- the sweep ----------------------------------------------------------------------------------


def sweep(name: str, module: ModuleType, run: Run, kept: Kept) -> pd.DataFrame:
    """Measure the cells that are not kept and return the rows of all, in the order of the cells.

    Raises RuntimeError naming the first cell that went wrong, once all others are kept.
    """
    import pandas as pd

    cells = module.cells(run)
    keys = [key(cell) for cell in cells]
    if len(set(keys)) < len(keys):
        twice = next(k for i, k in enumerate(keys) if k in keys[:i])
        raise ValueError(f"two cells are {twice}")
    left = [cell for cell, k in zip(cells, keys, strict=True) if k not in kept.rows]
    if len(left) < len(cells):
        message = f"{name}: {len(cells) - len(left)} of {len(cells)} cells kept"
        print(message, file=sys.stderr, flush=True)
    measure = _one_by_one if getattr(module, "SERIAL", False) else _side_by_side
    problems = []
    for done in run.progress(measure(name, run, left), len(left), name):
        if done.problem is None:
            kept.add(left[done.place], done.rows)
        else:
            problems.append(done)
    if problems:
        first = min(problems)
        raise RuntimeError(f"cell {key(left[first.place])}: {first.problem}")
    table = pd.DataFrame([row for k in keys for row in kept.rows[k]])
    return module.gather(run, table) if hasattr(module, "gather") else table


def _one_by_one(name: str, run: Run, cells: Sequence[Cell]) -> Iterator[Done]:
    for place, cell in enumerate(cells):
        yield _measured(place, name, run, cell)


def _side_by_side(name: str, run: Run, cells: Sequence[Cell]) -> Iterator[Done]:
    """Cells on the workers, as they finish; those begun when a worker dies are tried alone.

    A death says not whose it was and takes the cells beside it along: only a cell whose worker dies
    with nothing beside it is to blame.
    """
    from joblib.externals.loky.process_executor import TerminatedWorkerError

    environment = _environment()
    shared = (
        os.getpid(),
        name,
        run,
        environment,
        _sources(*environment.items()),
        catalogue.schemes(),
    )
    left = dict(enumerate(cells))
    while left:
        begun: set[int] = set()
        try:
            for done in _dispatched(shared, dict(left), begun):
                del left[done.place]
                yield done
        except TerminatedWorkerError:
            for place in [place for place in left if place in begun]:
                yield _alone(shared, place, left.pop(place))


def _alone(shared: tuple[Any, ...], place: int, cell: Cell) -> Done:
    """A cell with nothing beside it, on a worker: this process must outlive it."""
    from joblib.externals.loky.process_executor import TerminatedWorkerError

    try:
        (done,) = _dispatched(shared, {place: cell}, set())
        return done
    except TerminatedWorkerError as error:
        return Done(place, "", f"a worker died, this cell alone on it: {experiment.traced(error)}")


def _dispatched(shared: tuple[Any, ...], cells: dict[int, Cell], begun: set[int]) -> Iterator[Done]:
    """Cells on the workers, as they finish; enters in ``begun`` those that are handed out."""
    from joblib import Parallel, delayed

    def tasks() -> Iterator[Any]:  # drawn from a few at a time, as workers become free
        for place, cell in cells.items():
            begun.add(place)
            yield delayed(_measured_elsewhere)(place, *shared, cell)

    # A cell a task: a task that dies takes no finished cell with it.
    parallel = Parallel(return_as="generator_unordered", batch_size=1, max_nbytes=None)
    yield from parallel(tasks())


@contextmanager
def workers(jobs: int | None = None, dask: str | None = None) -> Iterator[None]:
    """Within it, cells go to processes of this machine (None: one a core) or to a Dask scheduler.

    Raises
    ------
    ValueError
        Without the extra "dask", a scheduler at the address, or a worker of it.
    """
    from joblib import parallel_config
    from joblib.externals.loky.backend import resource_tracker

    if dask is None:
        with hang_up_ignored():  # it cleans up after all others, SIGINT and SIGTERM notwithstanding
            resource_tracker.ensure_running()
        # One thread a process: the cores are shared out already, and sums do not regroup.
        with parallel_config("loky", n_jobs=jobs or -1, inner_max_num_threads=1):
            yield
        return
    with _client(dask) as client, parallel_config("dask", client=client):
        yield


def _client(address: str) -> AbstractContextManager[Any]:
    if importlib.util.find_spec("distributed") is None:
        raise ValueError("--dask needs the extra: pip install 'quatspline[dask]'")
    import distributed
    from distributed.comm import resolve_address

    try:
        resolve_address(address)  # a client that fails at this cannot be closed
        client = distributed.Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise ValueError(f"--dask {address}: no Dask scheduler answers: {reason}") from None
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
    except TimeoutError:
        client.close()
        raise ValueError(f"--dask {address}: the scheduler has no workers") from None
    return client


# -- in a worker --------------------------------------------------------------------------------

_measuring = threading.Lock()
"""One cell at a time in a process: a Dask worker has several threads, and what a cell times, or a
library that bears no threads, must not share it."""


def _measured_elsewhere(
    place: int,
    starter: int,
    name: str,
    run: Run,
    environment: dict[str, str],
    sources: str,
    usable: Sequence[str],
    cell: Cell,
) -> Done:
    """A cell in another process, which finds the same files as the one that asks."""
    bind_to(starter)
    with _measuring:
        os.environ.update(environment)
        if _sources(*environment.items()) != sources:
            raise RuntimeError("a worker has other sources of quatspline than this process")
        lacking = _lacking(usable, run, cell)
        return Done(place, "", lacking) if lacking else _measured(place, name, run, cell)


def _lacking(usable: Sequence[str], run: Run, cell: Cell) -> str | None:
    """Why this process cannot measure a cell that the one that asks could.

    A scheme that fails here alone says nothing of the scheme: its row would be a wrong one.  A cell
    that names no scheme may need any of the run's.
    """
    here = catalogue.found()
    named = {*usable, *here} & {value for value in cell.values() if isinstance(value, str)}
    needed = named or run.schemes or usable
    for name in usable:
        if name in needed and (name not in here or here[name].scheme is None):
            reason = here[name].problem if name in here else "it is not found"
            return (
                f"scheme {name!r} can be used where the run started, not on this worker: {reason}"
            )
    return None


def _measured(place: int, name: str, run: Run, cell: Cell) -> Done:
    """Measure a cell of an experiment that is found by its name (modules do not travel)."""
    try:
        module = catalogue.load(experiment.files()[name], "experiment")
        with always_compiled():  # in a worker, too
            rows = module.measure_cell(run, **cell)
        listed = [rows] if isinstance(rows, dict) else list(rows)
        return Done(place, json.dumps(listed, default=_plain))
    except Exception as error:  # told once the other cells are kept
        return Done(place, "", experiment.traced(error))


def _plain(value: Any) -> Any:
    """A numpy scalar as Python's own."""
    if hasattr(value, "item"):
        return value.item()
    raise TypeError(f"{value!r} in a row: a plain scalar is expected")


@cache
def _sources(*environment: tuple[str, str]) -> str:
    """A hash of what this process measures with, as it was when first asked for."""
    return experiment.sources()


def _environment() -> dict[str, str]:
    """The folders of schemes, experiments and clips, for a process that started elsewhere."""
    names = (catalogue.FOLDERS, experiment.FOLDERS)
    folders = {name: os.environ.get(name, "").split(os.pathsep) for name in names}
    folders[clips.FOLDER] = [os.environ.get(clips.FOLDER, "")]  # one, whatever is in its name
    return {k: os.pathsep.join(os.path.abspath(p) for p in v if p) for k, v in folders.items()}
