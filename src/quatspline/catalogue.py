"""Schemes by name: one file, one scheme, the key being the file's stem with hyphens.

Looked through, in order: the package's own ``proposed``, ``baselines`` (beside ``src`` in a checkout,
inside the package when installed), the folders named by ``QUATSPLINE_BASELINES`` (a path list), and the
entry points of the group ``quatspline.schemes`` (see `discovery`).
"""

from __future__ import annotations

import copyreg
import os
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from quatspline.curve import Curve
from quatspline.discovery import PROPOSED, Found, discover, named, shipped
from quatspline.options import nearest
from quatspline.peers import installed
from quatspline.system.forking import undivided

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from quatspline.keyframes import Keyframes

FOLDERS = "QUATSPLINE_BASELINES"
PLUG_IN: Final = "plug-in"
"""What a scheme is called that does not come with the package, where others are the package's or a library's."""
PAPERS = "quartic"
"""The curve of the paper that this project began with: of its proposed schemes the one that is not its own."""


def folders() -> list[Path]:
    """Where files with schemes are looked for."""
    return list(_folders(os.environ.get(FOLDERS, "")))


@cache
def _folders(extra: str) -> tuple[Path, ...]:
    given = (Path(p) for p in extra.split(os.pathsep) if p)
    return (PROPOSED, shipped("baselines"), *given)


_left_out: dict[str, str] = {}
"""Why schemes are not to be used in this process for now, by name."""
_complete: dict[Any, dict[str, Found]] = {}
"""What was found, by the folders and when they last changed."""


def found() -> dict[str, Found]:
    """Every scheme by name, those that cannot be used included, with the reason.

    Threads that ask first at the same time all look, and wait for each other's imports; what one
    finds while a scheme is still being imported is not kept.
    """
    out = {name: replace(_all()[name], scheme=None, problem=why) for name, why in _left_out.items()}
    return {**_all(), **out} if out else _all()


def leave_out(reasons: Mapping[str, str]) -> None:
    """Have this process count schemes as unusable, each for a reason, until it is told otherwise."""
    global _left_out
    _left_out = dict(reasons)


def _all() -> dict[str, Found]:
    places = _folders(os.environ.get(FOLDERS, ""))
    key = places, tuple(map(_changed, places))
    if key not in _complete:
        with undivided():
            everything = _find(places)
        if not all(item.settled for item in everything.values()):
            return everything
        _complete.setdefault(key, everything)
    return _complete[key]


def _changed(folder: Path) -> int:
    """When files were last added to a folder or taken from it."""
    try:
        return os.stat(folder).st_mtime_ns
    except OSError:
        return 0


def names() -> list[str]:
    """Sorted names of every scheme, usable or not; nothing is imported."""
    return sorted(set(named(_files(_folders(os.environ.get(FOLDERS, ""))))))


def _files(places: tuple[Path, ...]) -> tuple[Path, ...]:
    files = [path for folder in places for path in sorted(folder.glob("[!_]*.py"))]
    # Of one file in several folders, the first. (`Path.resolve` raises where links go round.)
    once = {os.path.realpath(path): path for path in reversed(files)}
    return tuple(reversed(once.values()))


def _find(places: tuple[Path, ...]) -> dict[str, Found]:
    everything: dict[str, Found] = {}
    for item in discover(_files(places)):
        other = everything.get(item.name)
        everything[item.name] = item if other is None else _twice(other, item)
        if item.scheme is not None:
            copyreg.pickle(item.scheme, _by_name)
    return dict(sorted(everything.items()))


def _twice(one: Found, other: Found) -> Found:
    """Neither of two schemes: whose a name is would depend on the order of folders."""
    origins = f"{one.origin} and {other.origin}"
    return Found(one.name, origins, None, f"two schemes are called {one.name!r}: {origins}")


def schemes() -> list[str]:
    """Sorted names of all usable schemes, including those of installed libraries.

    Examples
    --------
    >>> import quatspline as qs
    >>> {"slerp", "quartic", "nielson"} <= set(qs.schemes())
    True
    """
    return [name for name, item in found().items() if item.scheme is not None]


def scheme(name: str) -> type[Curve]:
    """The class of a scheme.

    Raises
    ------
    ValueError
        For an unknown name (with the nearest known one), or a scheme that cannot be used (with the reason).

    Examples
    --------
    >>> import quatspline as qs
    >>> qs.scheme("squad").continuity, qs.scheme("squad").support
    (1, 4)
    >>> qs.scheme("quatric")
    Traceback (most recent call last):
    ValueError: unknown scheme 'quatric': did you mean 'quartic'?
    """
    everything = found()
    if not isinstance(name, str) or name not in everything:
        raise ValueError(f"unknown scheme {name!r}: {nearest(name, everything)}{_absent()}")
    item = everything[name]
    if item.scheme is None:
        raise ValueError(f"scheme {name!r} cannot be used: {item.problem}")
    return item.scheme


def _absent() -> str:
    """A word on folders that `FOLDERS` names and that are not there: a name that is not found may be in one."""
    missing = [str(folder) for folder in folders() if not folder.is_dir()]
    return f" ({FOLDERS} names {', '.join(missing)}, which is no folder)" if missing else ""


def ours(name: str) -> bool:
    """Whether a scheme is this project's own."""
    item = found().get(name)
    return item is not None and Path(item.origin).parent == PROPOSED and name != PAPERS


def called(name: str) -> str:
    """A scheme's name where schemes are compared: this project's own are marked, since it also judges."""
    return f"{name} (ours)" if ours(name) else name


def maker(name: str) -> str:
    """Whose a usable scheme is, for lists: a library's, quatspline's (its own designs are marked), or a plug-in."""
    peer = scheme(name).peer
    if name in plug_ins():
        return f"{PLUG_IN} ({peer})" if peer else PLUG_IN
    return peer or f"quatspline{' (ours)' if ours(name) else ''}"


def version(name: str) -> str | None:
    """The version measured: of the peer that a scheme wraps, otherwise of quatspline."""
    item = found()[name]
    if item.scheme is None:
        return None
    return installed.version(item.scheme.peer or "quatspline")


def build(
    name: str,
    times: ArrayLike | None,
    quaternions: Any,
    *,
    closed: bool = False,
    align: bool = True,
    **options: Any,
) -> Curve:
    """Build the curve of a scheme through keyframes, by calling the scheme's class (see `Curve`).

    Options are those of the scheme, and ``closing_sign``, ``hold`` and ``normalise`` of `Curve`.

    Examples
    --------
    >>> import quatspline as qs
    >>> curve = qs.build("quartic", [0, 1, 2], [[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0.6, 0.8, 0, 0]])
    >>> curve(0.5).shape, curve([0.5, 1.5], order=1).shape
    ((4,), (2, 3))
    """
    return scheme(name)(times, quaternions, closed=closed, align=align, **options)


def plug_ins() -> set[str]:
    """Names of the usable schemes that do not come with the package."""
    return {name for name, item in found().items() if item.scheme is not None and not item.shipped}


def _by_name(curve: Curve) -> Any:
    """How a curve is pickled: by its scheme's name, for a file loaded by path is no module elsewhere."""
    return _rebuilt, (curve.name, *curve.__getstate__())


def _rebuilt(name: str, keyframes: Keyframes, given: dict[str, Any], hold: bool = False) -> Curve:
    return scheme(name).from_keyframes(keyframes, hold=hold, **given)
