"""The scheme that a file or an entry point holds, or why it cannot be used.

One file, one scheme, the key being the file's stem with hyphens.  What does not come with the package is a
plug-in, and admitted first (see `admission`).
"""

from __future__ import annotations

import importlib
import importlib.metadata
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from types import ModuleType

from quatspline import admission
from quatspline.curve import Curve
from quatspline.peers import installed
from quatspline.system.loading import load, passing, unfinished
from quatspline.system.sentence import printable

PACKAGE = Path(__file__).parent
PROPOSED = PACKAGE / "proposed"
ENTRY_POINTS = "quatspline.schemes"
SHIPPED = "_shipped.txt"
"""The stems of the baselines that come with the package."""


@dataclass(frozen=True)
class Found:
    """A scheme's class, or the reason why it cannot be used."""

    name: str
    origin: str
    scheme: type[Curve] | None
    problem: str | None = None
    settled: bool = True
    """False where the problem is an import under way, after which it may be gone."""
    shipped: bool = False
    """Whether it comes with the package."""


def shipped(folder: str) -> Path:
    """A folder that a checkout keeps beside ``src`` and a wheel carries inside the package."""
    inside = PACKAGE / folder
    return inside if inside.is_dir() else PACKAGE.parents[1] / folder


def named(files: Sequence[Path]) -> Iterator[str]:
    """The names of schemes in files, and of the entry points of `ENTRY_POINTS`."""
    plugins: list[admission.Plugin] = [*files, *_entries()]
    return (_named(plugin)[0] for plugin in plugins)


def discover(files: Sequence[Path]) -> Iterator[Found]:
    """What is found in files, and at the entry points of `ENTRY_POINTS`."""
    ours = [path for path in files if _is_shipped(path)]
    plugins: list[admission.Plugin] = [*(path for path in files if path not in ours), *_entries()]
    refused = admission.refusals(plugins)
    for path in ours:
        yield replace(_from_file(path), shipped=True)
    for plugin in plugins:
        if plugin in refused:
            settled = refused[plugin] != admission.PENDING
            yield Found(*_named(plugin), None, refused[plugin], settled)
        else:
            yield _from_file(plugin) if isinstance(plugin, Path) else _from_entry(plugin)


def _entries() -> list[importlib.metadata.EntryPoint]:
    found = importlib.metadata.entry_points(group=ENTRY_POINTS)
    return sorted(found, key=lambda entry: entry.name)


def _is_shipped(path: Path) -> bool:
    return path.parent == PROPOSED or (
        path.parent == shipped("baselines") and path.stem in _baselines()
    )


@cache
def _baselines() -> frozenset[str]:
    """Stems of the package's own files among those that a checkout's owner has put beside them."""
    with suppress(OSError):  # then all are plug-ins
        return frozenset((shipped("baselines") / SHIPPED).read_text(encoding="ascii").split())
    return frozenset()


def _named(plugin: admission.Plugin) -> tuple[str, str]:
    """The name of a scheme, and where it comes from."""
    if isinstance(plugin, Path):
        return printable(plugin.stem.replace("_", "-")), printable(str(plugin))
    return plugin.name, plugin.value


def loaded(kind: str, place: str) -> type[Curve]:
    """The class in a "file", or of the "entry" point of that name, imported as it comes."""
    if kind == "file":
        return _only_scheme(_module(Path(place)))
    (entry,) = importlib.metadata.entry_points(group=ENTRY_POINTS, name=place)
    return _loaded(entry)


def _from_file(path: Path) -> Found:
    name, origin = _named(path)
    try:
        module = _module(path)
        if unfinished(module.__name__):
            return Found(name, origin, None, "it is still being imported", settled=False)
        scheme = _only_scheme(module)
    except (Exception, SystemExit) as error:  # a broken plug-in must not take the others down
        return _broken(name, origin, error)
    return _usable(name, origin, scheme)


def _module(path: Path) -> ModuleType:
    if path.parent == PROPOSED:
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
        scheme = _loaded(entry)
    except (Exception, SystemExit) as error:
        return _broken(*_named(entry), error)
    return _usable(*_named(entry), scheme)


def _loaded(entry: importlib.metadata.EntryPoint) -> type[Curve]:
    scheme = entry.load()
    if not (isinstance(scheme, type) and issubclass(scheme, Curve)):
        raise TypeError(f"not a subclass of Curve: {scheme!r}")
    return scheme


def _broken(name: str, origin: str, error: BaseException) -> Found:
    return Found(name, origin, None, f"{type(error).__name__}: {error}", settled=not passing(error))


def _usable(name: str, origin: str, scheme: type[Curve]) -> Found:
    scheme.name = name
    if scheme.peer is not None:
        try:
            installed.version(scheme.peer)
        except installed.NotInstalledError as missing:
            return Found(name, origin, None, str(missing))
    return Found(name, origin, scheme)
