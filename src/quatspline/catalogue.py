"""Finds schemes: one file, one scheme, the key being the file's stem with hyphens.

Looked through, in order: the package's own ``proposed``, ``baselines`` (beside ``src`` in a checkout,
inside the package when installed), the folders named by ``QUATSPLINE_BASELINES`` (a path list), and the
entry points of the group ``quatspline.schemes``.
"""

from __future__ import annotations

import copyreg
import importlib
import importlib.metadata
import os
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from quatspline.curve import Curve
from quatspline.options import nearest
from quatspline.peers import installed
from quatspline.system.forking import undivided
from quatspline.system.loading import load, passing, unfinished

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from quatspline.keyframes import Keyframes

PACKAGE = Path(__file__).parent
ENTRY_POINTS = "quatspline.schemes"
FOLDERS = "QUATSPLINE_BASELINES"
PAPERS = "quartic"
"""The curve of the paper that this project began with: of its proposed schemes the one that is not its own."""


@dataclass(frozen=True)
class Found:
    """A scheme's class, or the reason why it cannot be used."""

    name: str
    origin: str
    scheme: type[Curve] | None
    problem: str | None = None
    settled: bool = True
    """False where the problem is an import under way, after which it may be gone."""


def shipped(folder: str) -> Path:
    """A folder that a checkout keeps beside ``src`` and a wheel carries inside the package."""
    inside = PACKAGE / folder
    return inside if inside.is_dir() else PACKAGE.parents[1] / folder


def folders() -> list[Path]:
    """Where files with schemes are looked for."""
    return list(_folders(os.environ.get(FOLDERS, "")))


@cache
def _folders(extra: str) -> tuple[Path, ...]:
    given = (Path(p) for p in extra.split(os.pathsep) if p)
    return (PACKAGE / "proposed", shipped("baselines"), *given)


_complete: dict[Any, dict[str, Found]] = {}
"""What was found, by the folders and when they last changed."""


def found() -> dict[str, Found]:
    """Every scheme by name, those that cannot be used included, with the reason.

    Threads that ask first at the same time all look, and wait for each other's imports; what one
    finds while a scheme is still being imported is not kept.
    """
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


def _find(places: tuple[Path, ...]) -> dict[str, Found]:
    files = [path for folder in places for path in sorted(folder.glob("[!_]*.py"))]
    once = {path.resolve(): path for path in reversed(files)}  # the first folder that has it
    everything: dict[str, Found] = {}
    for item in _discover(tuple(reversed(once.values()))):
        if item.name in everything:
            raise ValueError(
                f"two schemes are called {item.name!r}: {everything[item.name].origin} and {item.origin}"
            )
        everything[item.name] = item
    return dict(sorted(everything.items()))


def schemes() -> list[str]:
    """Sorted names of every usable scheme, peers included where their library imports.

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
        An unknown name (with the nearest known one), or a scheme that cannot be used and why.

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
        raise ValueError(f"unknown scheme {name!r}: {nearest(name, everything)}")
    item = everything[name]
    if item.scheme is None:
        raise ValueError(f"scheme {name!r} cannot be used: {item.problem}")
    return item.scheme


def ours(name: str) -> bool:
    """Whether a scheme is this project's own."""
    item = found().get(name)
    return item is not None and Path(item.origin).parent == PACKAGE / "proposed" and name != PAPERS


def called(name: str) -> str:
    """A scheme's name where schemes are compared: this project's own are marked, since it also judges."""
    return f"{name} (ours)" if ours(name) else name


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
    """The curve of a scheme through keyframes: the scheme's class called (see `Curve`).

    Besides the scheme's own options, ``closing_sign``, ``hold`` and ``normalise`` are as there.

    Examples
    --------
    >>> import quatspline as qs
    >>> curve = qs.build("quartic", [0, 1, 2], [[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0.6, 0.8, 0, 0]])
    >>> curve(0.5).shape, curve([0.5, 1.5], order=1).shape
    ((4,), (2, 3))
    """
    return scheme(name)(times, quaternions, closed=closed, align=align, **options)


def _by_name(curve: Curve) -> Any:
    """How a curve is pickled: by its scheme's name, for a file loaded by path is no module elsewhere."""
    return _rebuilt, (curve.name, *curve.__getstate__())


def _rebuilt(name: str, keyframes: Keyframes, given: dict[str, Any], hold: bool = False) -> Curve:
    return scheme(name).from_keyframes(keyframes, hold=hold, **given)


def _discover(files: tuple[Path, ...]) -> Iterator[Found]:
    yield from map(_from_file, files)
    for entry in sorted(importlib.metadata.entry_points(group=ENTRY_POINTS), key=lambda e: e.name):
        yield _from_entry(entry)


def _from_file(path: Path) -> Found:
    name, origin = path.stem.replace("_", "-"), str(path)
    try:
        module = _module(path)
        if unfinished(module.__name__):
            return Found(name, origin, None, "it is still being imported", settled=False)
        scheme = _only_scheme(module)
    except (Exception, SystemExit) as error:  # a broken plug-in must not take the others down
        return _broken(name, origin, error)
    return _usable(name, origin, scheme)


def _module(path: Path) -> ModuleType:
    if path.parent == PACKAGE / "proposed":
        return importlib.import_module(f"quatspline.proposed.{path.stem}")
    return load(path, "baseline")


def _only_scheme(module: ModuleType) -> type[Curve]:
    classes = [
        value
        for value in vars(module).values()
        if isinstance(value, type)
        and issubclass(value, Curve)
        and value.__module__ == module.__name__
        and not value.__name__.startswith("_")
    ]
    if len(classes) != 1:
        raise TypeError(f"one subclass of Curve expected, {len(classes)} found")
    return classes[0]


def _from_entry(entry: importlib.metadata.EntryPoint) -> Found:
    try:
        scheme = entry.load()
        if not (isinstance(scheme, type) and issubclass(scheme, Curve)):
            raise TypeError(f"no subclass of Curve: {scheme!r}")
    except (Exception, SystemExit) as error:
        return _broken(entry.name, entry.value, error)
    return _usable(entry.name, entry.value, scheme)


def _broken(name: str, origin: str, error: BaseException) -> Found:
    return Found(name, origin, None, f"{type(error).__name__}: {error}", settled=not passing(error))


def _usable(name: str, origin: str, scheme: type[Curve]) -> Found:
    scheme.name = name
    copyreg.pickle(scheme, _by_name)
    if scheme.peer is not None:
        try:
            installed.version(scheme.peer)
        except installed.NotInstalledError as missing:
            return Found(name, origin, None, str(missing))
    return Found(name, origin, scheme)
