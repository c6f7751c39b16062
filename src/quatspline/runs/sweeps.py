"""Sweeps: an experiment's cells measured on all cores or on a Dask cluster, none ever lost.

An experiment that varies something defines, instead of ``measure(run)``,

``cells(run) -> list[dict]``                 what is varied: JSON scalars by name, in order
``measure_cell(run, **cell) -> dict | list`` the row or rows of a cell; what fails is a row too
``gather(run, table) -> DataFrame``          optional: columns that need all cells
``SERIAL: bool``                             optional: its cells time something, so they run one
                                             after the other, in one process

A finished cell is appended to a journal at once, and an interrupted run goes on with the others.  Rows
pass through JSON, which keeps every bit of a float, and stand in the order of the cells: the table
does not depend on the number of workers or on interruptions.

Cells are measured in processes of their own, with a limit of time and memory, whatever their number.  A cell that
ends its process is a row that says how, of the scheme that the cell names.
"""

from __future__ import annotations

import json
import os
import sys
import threading
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from types import ModuleType
from typing import TYPE_CHECKING, Any

from quatspline import admission, catalogue
from quatspline.engines.engine import always_compiled
from quatspline.instruments.trials import reason
from quatspline.runs import experiment
from quatspline.runs.experiment import Run
from quatspline.runs.journal import Cell, Kept, key
from quatspline.runs.staff import Done, Staff, staff
from quatspline.system.loading import load
from quatspline.trajectories import clips

if TYPE_CHECKING:
    import pandas as pd

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
    problems = []
    with staff() as employed:
        serial = bool(getattr(module, "SERIAL", False))
        measured = _Sweep(name, run, serial, employed).measured(left)
        for done in run.progress(measured, len(left), name):
            if done.problem is None:
                kept.add(left[done.place], done.rows)
            else:
                problems.append(done)
    if problems:
        first = min(problems)
        raise RuntimeError(f"cell {key(left[first.place])}: {first.problem}")
    table = pd.DataFrame([row for k in keys for row in kept.rows[k]])
    return module.gather(run, table) if hasattr(module, "gather") else table


class _Sweep:
    """The cells of one experiment on what measures them."""

    def __init__(self, name: str, run: Run, serial: bool, employed: Staff) -> None:
        self.name, self.run, self.serial, self.employed = name, run, serial, employed
        folders = _environment()
        verdicts = admission.verdicts()
        self.shared = folders, _sources(*folders.items()), catalogue.schemes(), verdicts

    def measured(self, cells: Sequence[Cell]) -> Iterator[Done]:
        """Cells as they finish; last those that ended their process and name no scheme."""
        unnamed = []
        for done in self._done([(self.run, cell) for cell in cells]):
            scheme = _named(cells[done.place]) if done.death else None
            if done.death is None:
                yield done
            elif scheme is None:
                unnamed.append(done)
            else:
                yield Done(done.place, self._labelled(cells[done.place], scheme, done.death))
        for done in unnamed:
            yield self._without_culprits(done, cells[done.place])

    def _done(
        self, asked: Sequence[tuple[Run, Cell]], left_out: Mapping[str, str] = {}
    ) -> Iterator[Done]:
        shared = (*self.shared, dict(left_out))
        tasks = [(i, self.name, run, *shared, cell) for i, (run, cell) in enumerate(asked)]
        return self.employed.done(_measured_elsewhere, tasks, self.serial)

    def _without_culprits(self, done: Done, cell: Cell) -> Done:
        """A cell of many schemes that ended its process: measured without those that do so alone.

        Suspects are schemes that are not shipped; where none is to blame the cell itself is.
        """
        asked = self.run.schemes
        suspects = [name for name in asked or catalogue.schemes() if name in catalogue.plug_ins()]
        alone = list(self._done([(replace(self.run, schemes=[name]), cell) for name in suspects]))
        deaths = {suspects[one.place]: one.death for one in alone if one.death}
        if not deaths:
            return Done(done.place, "", done.death)
        rest = [name for name in asked if name not in deaths] if asked else None
        rows: list[Any] = []
        if rest != []:
            (again,) = self._done([(replace(self.run, schemes=rest), cell)], deaths)
            if again.death or again.problem:
                return Done(done.place, "", again.death or again.problem)
            rows = json.loads(again.rows)
        there = {row.get("scheme") for row in rows}
        for scheme in sorted(deaths.keys() - there):
            rows += json.loads(self._labelled(cell, scheme, deaths[scheme]))
        return Done(done.place, json.dumps(rows))

    def _labelled(self, cell: Cell, scheme: str, death: str) -> str:
        """The row of a cell that a scheme did not survive, which is told, too."""
        print(f"{self.name}: {scheme}: {death}", file=sys.stderr, flush=True)
        return json.dumps([{**cell, "scheme": scheme, "failure": death}])


def _named(cell: Cell) -> str | None:
    """The scheme that a cell measures."""
    values = [cell.get("scheme"), *cell.values()]
    return next((v for v in values if isinstance(v, str) and v in catalogue.found()), None)


# -- in a worker --------------------------------------------------------------------------------

_measuring = threading.Lock()
"""One cell at a time in a process: a Dask worker has several threads, and what a cell times, or a
library that bears no threads, must not share it."""


def _measured_elsewhere(
    place: int,
    name: str,
    run: Run,
    environment: dict[str, str],
    sources: str,
    usable: Sequence[str],
    verdicts: dict[str, str | None],
    left_out: dict[str, str],
    cell: Cell,
) -> Done:
    """A cell in another process, which finds the same files as the one that asks."""
    with _measuring:
        os.environ.update(environment)
        if _sources(*environment.items()) != sources:
            return Done(place, "", "a worker has other sources of quatspline than this process")
        admission.take(verdicts)
        catalogue.leave_out(left_out)
        lacking = _lacking([name for name in usable if name not in left_out], run, cell)
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
        module = load(experiment.files()[name], "experiment")
        with always_compiled():  # in a worker, too
            rows = module.measure_cell(run, **cell)
        listed = [rows] if isinstance(rows, dict) else list(rows)
        return Done(place, json.dumps(listed, default=_plain))
    except MemoryError as error:
        return Done(place, "", death=reason(error))
    except Exception as error:  # told once the other cells are kept
        return Done(place, "", experiment.traced(error))
    except (
        BaseException
    ) as error:  # sys.exit, or an interrupt that nobody sent: signals end processes
        return Done(place, "", death=reason(error))


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
