"""Who measures cells: processes of this machine, or a Dask cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, NamedTuple

from quatspline.runs import cluster
from quatspline.system.crew import Crew
from quatspline.system.ending import hang_up_ignored
from quatspline.system.limits import CELL_SECONDS, memory, seconds

ONE_THREAD = {
    f"{library}_NUM_THREADS": "1"
    for library in ("OMP", "OPENBLAS", "MKL", "BLIS", "VECLIB_MAXIMUM", "NUMBA", "NUMEXPR")
}
"""The cores are shared out already, and sums do not regroup."""


class Done(NamedTuple):
    """A cell as it comes back: its rows as JSON, or what went wrong.

    ``problem``: the trace of an error, or trouble with the machine; ``death``: how the cell ended
    its process, or would have.
    """

    place: int
    rows: str
    problem: str | None = None
    death: str | None = None


class Staff:
    """What measures: ``jobs`` processes, and the cluster where there is one."""

    def __init__(self, jobs: int, client: Any = None) -> None:
        limits = seconds(CELL_SECONDS), memory()
        self.client = client
        self.crew = Crew(jobs, *limits, ONE_THREAD)
        self.timing = Crew(1, *limits)  # in the environment of the command

    def done(
        self, measure: Callable[..., Done], tasks: Sequence[tuple[Any, ...]], serial: bool
    ) -> Iterator[Done]:
        """``measure(*task)`` for tasks that begin with their place, as they finish."""
        if self.client is not None and not serial:
            yield from _on_cluster(self.client, measure, tasks)
            return
        crew = self.timing if serial else self.crew
        for outcome in crew.outcomes((task[0], (measure, task)) for task in tasks):
            if outcome.death is None:
                yield outcome.result
            elif outcome.strange:
                yield Done(outcome.place, "", f"a worker died twice at it: {outcome.death}")
            else:
                yield Done(outcome.place, "", death=outcome.death)

    def close(self) -> None:
        """End the processes."""
        self.crew.close()
        self.timing.close()


def _on_cluster(
    client: Any, measure: Callable[..., Done], tasks: Sequence[tuple[Any, ...]]
) -> Iterator[Done]:
    for number, done, trouble in cluster.outcomes(client, measure, tasks):
        yield done if trouble is None else Done(tasks[number][0], "", trouble)


_employed: ContextVar[Staff | None] = ContextVar("_employed", default=None)


@contextmanager
def staff() -> Iterator[Staff]:
    """Those that `workers` employs around this, or else some of its own."""
    employed = _employed.get()
    if employed is not None:
        yield employed
        return
    with workers():
        yield _employed.get()  # type: ignore[misc]


@contextmanager
def workers(jobs: int | None = None, dask: str | None = None) -> Iterator[None]:
    """Within it, cells go to processes of this machine (None: one a core) or to a Dask scheduler.

    Raises
    ------
    ValueError
        Without the extra "dask", a scheduler at the address, or a worker of it.
    """
    from joblib import cpu_count
    from joblib.externals.loky.backend import resource_tracker

    with hang_up_ignored():  # it cleans up after all others, SIGINT and SIGTERM notwithstanding
        resource_tracker.ensure_running()
    if dask is None:
        with _employing(Staff(jobs or cpu_count())):
            yield
        return
    with cluster.connected(dask) as client, _employing(Staff(1, client)):
        yield


@contextmanager
def _employing(employed: Staff) -> Iterator[None]:
    token = _employed.set(employed)
    try:
        yield
    finally:
        _employed.reset(token)
        employed.close()
