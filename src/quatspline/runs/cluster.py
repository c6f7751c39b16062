"""A Dask cluster: its cells as they finish, and how it is told that a cell or all workers are lost.

A cluster says nothing of its own accord when its last worker leaves: what is asked of it waits for another
to join.  So who waits here looks at the workers from time to time.
"""

from __future__ import annotations

import asyncio
import importlib.util
import logging
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from queue import Empty, SimpleQueue
from typing import Any

GREETING = 3.0
"""Seconds to wait for a Dask scheduler at an address: with what a command takes to start, fewer than five."""
ANSWER = 4.0
"""Seconds to wait for it later."""
JOINING = 10.0
"""Seconds to wait for its first worker."""
LOOK = 2.0
"""Seconds between two looks at its workers."""
ALONE = 20.0
"""Seconds without any worker, or an answer, after which cells are given up: a nanny restarts one in fewer."""

NO_SCHEDULER = "what answers is no scheduler"
NO_WORKER = "the Dask cluster has no workers any more"
GONE = "the Dask scheduler does not answer any more"


def connected(address: str) -> Any:
    """A client of the scheduler at an address, which has a worker.

    Raises
    ------
    ValueError
        Without the extra "dask", a scheduler at the address, or a worker of it.
    """
    if importlib.util.find_spec("distributed") is None:
        raise ValueError("--dask needs the extra: pip install 'quatspline[dask]'")
    import distributed

    logging.getLogger("distributed.client").setLevel(logging.CRITICAL)  # what matters is told here
    try:
        with ThreadPoolExecutor(1) as own:  # whose thread has no loop of events that runs
            own.submit(asyncio.run, _answer(address)).result()
        client = distributed.Client(address, timeout=ANSWER, set_as_default=False)
    except TimeoutError:
        raise _nobody(address, f"nothing came within {GREETING:g} s") from None
    except (OSError, ValueError) as error:
        raise _nobody(address, " ".join(str(error).split()) or type(error).__name__) from None
    except Exception:  # whatever distributed makes of what a stranger's port says
        raise _nobody(address, NO_SCHEDULER) from None
    try:
        client.wait_for_workers(1, timeout=JOINING)
    except TimeoutError:
        client.close()
        raise ValueError(f"--dask {address}: the scheduler has no workers") from None
    return client


async def _answer(address: str) -> None:
    """Have what is at an address say that it is a scheduler.

    A client waits without end for what accepts a connection and stays silent, and one that fails leaves
    its attempts behind.
    """
    from distributed.comm import resolve_address
    from distributed.core import connect
    from distributed.security import Security

    security = Security().get_connection_args("client")
    async with asyncio.timeout(GREETING):
        comm = await connect(resolve_address(address), timeout=GREETING, **security)
        try:
            await comm.write({"op": "identity", "reply": True})
            if (await comm.read()).get("type") != "Scheduler":
                raise ValueError(NO_SCHEDULER)
        finally:
            comm.abort()


def _nobody(address: str, reason: str) -> ValueError:
    return ValueError(f"--dask {address}: no Dask scheduler answers: {reason}")


def outcomes(
    client: Any, function: Callable[..., Any], tasks: Sequence[tuple[Any, ...]]
) -> Iterator[tuple[int, Any, str | None]]:
    """The place of a task, its result, and what trouble of the cluster's it was lost to; as they end."""
    done: SimpleQueue[Any] = SimpleQueue()
    places: dict[Any, int] = {}
    for place, task in enumerate(tasks):  # a task each: one that is lost takes no other with it
        places[client.submit(function, *task, pure=False)] = place
    for future in places:
        future.add_done_callback(done.put)
    watch = _Watch(client)
    try:
        while places:
            with suppress(Empty):
                future = done.get(timeout=LOOK)
                ended = _ended(future)
                if ended is not None:
                    yield (places.pop(future), *ended)
                    continue
                future.add_done_callback(done.put)
            if trouble := watch.trouble():
                for place in places.values():
                    yield place, None, trouble
                return
    finally:
        with suppress(Exception):  # a scheduler that left has nothing to cancel
            client.cancel(list(places))


def _ended(future: Any) -> tuple[Any, str | None] | None:
    """A result, or the trouble; None where the worker that had the result left, and it is measured again."""
    from distributed import CancelledError, KilledWorker

    try:
        return future.result(timeout=ANSWER), None
    except TimeoutError:
        return None
    except CancelledError:  # nobody here has
        return None, GONE
    except KilledWorker:
        return None, "the Dask workers that were to measure it died"
    except Exception as error:
        return None, f"the Dask cluster lost it: {type(error).__name__}"


class _Watch:
    """Whether a cluster can still measure, by looks at it."""

    def __init__(self, client: Any) -> None:
        self.client, self.seen = client, time.monotonic()

    def trouble(self) -> str | None:
        """Why it cannot, for longer than a worker takes to be restarted, or a scheduler to be out of breath."""
        why = NO_WORKER
        try:
            known = self.client.sync(self.client.scheduler.identity, callback_timeout=ANSWER)
            if known["workers"]:
                self.seen = time.monotonic()
        except Exception:
            why = GONE
        return why if time.monotonic() - self.seen > ALONE else None
