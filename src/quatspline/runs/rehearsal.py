"""Plug-ins tried on a user's own keyframes before they are measured beside others in one process.

A comparison interleaves its timings and draws its curves in the process of its command.  A plug-in that behaves
where it is admitted may end that process on other keyframes; so it does first, in a worker, all that it will be
asked for here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from quatspline import admission, catalogue
from quatspline.engines.engine import always_compiled
from quatspline.instruments.trials import reason
from quatspline.runs.experiment import Run
from quatspline.runs.staff import Done, staff


def failures(measure: Callable[..., object], names: Iterable[str], *given: Any) -> dict[str, str]:
    """Why plug-ins among schemes cannot be measured, by name.

    Parameters
    ----------
    measure : called with a name and ``given`` in a process of its own, which finds it by its name
    names : of schemes; those that come with the package are not tried
    """
    plug_ins = catalogue.plug_ins()
    suspects = [name for name in names if name in plug_ins]
    if not suspects:
        return {}
    known = admission.verdicts()
    tasks = [(i, known, measure, name, *given) for i, name in enumerate(suspects)]
    with staff() as employed:
        done = employed.done(_alone, tasks, serial=False)
        shown = Run(quick=True).progress(done, len(tasks), "plug-ins")
        failed = {suspects[one.place]: one.death or one.problem for one in shown}
    return {name: why for name, why in failed.items() if why}


def _alone(
    place: int, verdicts: dict[str, str | None], measure: Callable[..., object], *given: Any
) -> Done:
    """One plug-in, in a worker."""
    admission.take(verdicts)
    try:
        with always_compiled():
            measure(*given)
    except BaseException as error:  # an interrupt, too, is its own: signals end a worker
        return Done(place, "", death=reason(error))
    return Done(place, "")
