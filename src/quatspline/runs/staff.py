"""Who measures cells: processes of this machine, or a Dask cluster."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar
from typing import Any, NamedTuple

from quatspline.system.crew import Crew
from quatspline.system.ending import hang_up_ignored
from quatspline.system.limits import CELL_SECONDS, memory, seconds

PATIENCE = 10.0
"""Seconds to wait for a Dask scheduler, and for its first worker."""

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

    def __init__(self, jobs: int, cluster: bool = False) -> None:
        limits = seconds(CELL_SECONDS), memory()
        self.cluster = cluster
        self.crew = Crew(jobs, *limits, ONE_THREAD)
        self.timing = Crew(1, *limits)  # in the environment of the command

    def done(
        self, measure: Callable[..., Done], tasks: Sequence[tuple[Any, ...]], serial: bool
    ) -> Iterator[Done]:
        """``measure(*task)`` for tasks that begin with their place, as they finish."""
        if self.cluster and not serial:
            yield from _on_cluster(measure, tasks)
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


def _on_cluster(measure: Callable[..., Done], tasks: Sequence[tuple[Any, ...]]) -> Iterator[Done]:
    from joblib import Parallel, delayed

    # A cell a task: a task that dies takes no finished cell with it.
    parallel = Parallel(return_as="generator_unordered", batch_size=1, max_nbytes=None)
    yield from parallel(delayed(measure)(*task) for task in tasks)


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
    from joblib import cpu_count, parallel_config
    from joblib.externals.loky.backend import resource_tracker

    with hang_up_ignored():  # it cleans up after all others, SIGINT and SIGTERM notwithstanding
        resource_tracker.ensure_running()
    if dask is None:
        with _employing(Staff(jobs or cpu_count())):
            yield
        return
    with (
        _client(dask) as client,
        parallel_config("dask", client=client),
        _employing(Staff(1, cluster=True)),
    ):
        yield


@contextmanager
def _employing(employed: Staff) -> Iterator[None]:
    token = _employed.set(employed)
    try:
        yield
    finally:
        _employed.reset(token)
        employed.close()


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
