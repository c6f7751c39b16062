"""Experiments: what is asked of one, and where they are found.

An experiment is a file in ``experiments`` (beside ``src`` in a checkout, inside the package when
installed) or in a folder named by ``QUATSPLINE_EXPERIMENTS`` (a path list).  Its name is the file's
stem with hyphens.  It holds

``TITLE: str``                   what the table is called
``PAPER: bool``                  whether it is one of the paper's (run in full by default)
``measure(run) -> DataFrame``    one row a measurement, a failure being a row with its reason; or
``cells(run)``, ``measure_cell(run, **cell)``  the same in parts that run side by side (see `sweeps`)
``derive(run, read) -> DataFrame``  a table made of others of the folder, by name: run after them
``draw(table) -> Figure``        optional: the figure, drawn from the table as read from its file
``caption(table) -> str``        optional: what the figure shows, where there is one
``replays(run) -> list``         optional: motions for the page's player, each made by `quatspline.motion.replay`
``text(table) -> str``           optional: Markdown that follows the table in its Markdown copy
``FORMATS: dict[str, str]``      optional: format specifications of columns in the Markdown
``NOTE: str``                    optional: what a reader of the table must know
``KEYS: list[str]``              optional: columns that rows are sorted by (see `Results.table`)
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
import traceback
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Literal, Self, TypeVar

from quatspline import catalogue, discovery
from quatspline.instruments.trials import reason
from quatspline.options import nearest
from quatspline.runs.provenance import cpu_model, versions
from quatspline.system.loading import load
from quatspline.trajectories import clips

if TYPE_CHECKING:
    import numpy as np

FOLDERS = "QUATSPLINE_EXPERIMENTS"
PATIENCE = 2.0
"""Seconds before a progress bar shows."""

Size = Literal["quick", "full"]
QUICK: Size = "quick"
FULL: Size = "full"

T = TypeVar("T")


@dataclass(frozen=True)
class Run:
    """What an experiment is asked for.

    Attributes
    ----------
    quick : the small size, of seconds rather than minutes
    schemes : the names asked for, or None for those that the experiment chooses
    seed : of every random number, through `rng`
    """

    quick: bool
    schemes: list[str] | None = None
    seed: int = 0

    @classmethod
    def of(cls, size: Size, schemes: list[str] | None = None, seed: int = 0) -> Self:
        """A run of a size by name."""
        return cls(size == QUICK, schemes, seed)

    @property
    def size(self) -> Size:
        """The name of the size: "quick" or "full"."""
        return QUICK if self.quick else FULL

    @property
    def names(self) -> list[str]:
        """The schemes asked for; all that are found, the unusable too, where none are."""
        return self.schemes or list(catalogue.found())

    def rng(self, *names: object) -> np.random.Generator:
        """A generator seeded by the run's seed and by names, whatever else was drawn before."""
        import numpy as np

        digest = hashlib.sha256("\0".join(map(str, names)).encode()).digest()
        return np.random.default_rng([self.seed, int.from_bytes(digest[:16], "little")])

    def progress(
        self, iterable: Iterable[T], total: int | None = None, label: str = ""
    ) -> Iterator[T]:
        """The items, with a bar on stderr once they have taken two seconds."""
        from tqdm import tqdm

        often = 0.2 if sys.stderr.isatty() else PATIENCE  # a log keeps every state of the bar
        bar = tqdm(
            iterable, label, total, leave=False, delay=PATIENCE, mininterval=often, file=sys.stderr
        )
        return iter(bar)


def crossed(**axes: Iterable[Any]) -> list[dict[str, Any]]:
    """Cells of every combination of values, those of the last name changing fastest."""
    return [dict(zip(axes, values, strict=True)) for values in product(*axes.values())]


@dataclass(frozen=True)
class Experiment:
    """An experiment's file, loaded; or why it could not be."""

    name: str
    module: ModuleType | None
    problem: BaseException | None = None

    @property
    def paper(self) -> bool:
        """Whether it is one of the paper's."""
        return bool(getattr(self.module, "PAPER", False))

    @property
    def size(self) -> Size:
        """At which it runs unless asked otherwise."""
        return FULL if self.paper else QUICK

    @property
    def derived(self) -> bool:
        """Whether it is made of the tables of others."""
        return callable(getattr(self.module, "derive", None))

    @property
    def outputs(self) -> list[str]:
        """How the names of the files that it may write end."""
        drawn = {"draw": [".png", ".svg"], "caption": [".caption.txt"], "replays": [".replay.json"]}
        more = [end for name, ends in drawn.items() if hasattr(self.module, name) for end in ends]
        return [".csv", ".md", *more, ".error.txt"]

    @property
    def title(self) -> str:
        """What its table is called."""
        return str(getattr(self.module, "TITLE", self.name))


def files() -> dict[str, Path]:
    """The files of all experiments by name."""
    extra = [Path(p) for p in os.environ.get(FOLDERS, "").split(os.pathsep) if p]
    named: dict[str, Path] = {}
    for folder in (discovery.shipped("experiments"), *extra):
        for path in sorted(folder.glob("[!_]*.py")):
            name = path.stem.replace("_", "-")
            if name in named:
                raise ValueError(f"two experiments are called {name!r}: {named[name]} and {path}")
            named[name] = path
    return dict(sorted(named.items()))


def experiments(names: Sequence[str] = ()) -> list[Experiment]:
    """The experiments asked for in that order; by default all, the paper's first; derived ones last.

    Raises
    ------
    ValueError
        An unknown name (with the nearest known one), or none there at all.
    """
    known = files()
    for name in names:
        if name not in known:
            raise ValueError(f"unknown experiment {name!r}: {nearest(name, known)}")
    if not known:
        raise ValueError(f"no experiments in {discovery.shipped('experiments')} or ${FOLDERS}")
    if names:
        asked = [_loaded(name, known[name]) for name in dict.fromkeys(names)]
        return sorted(asked, key=lambda e: e.derived)
    loaded = [_loaded(*item) for item in known.items()]
    return sorted(loaded, key=lambda e: (e.derived, not e.paper, e.name))


def _loaded(name: str, path: Path) -> Experiment:
    try:
        return Experiment(name, load(path, "experiment"))
    except Exception as error:  # told when its turn comes, and the others run
        return Experiment(name, None, error)


def fingerprint(runs: dict[str, Run]) -> str:
    """A hash of all that decides what a run measures: options, sources, versions, processor."""
    options = {name: [run.quick, run.schemes, run.seed] for name, run in runs.items()}
    decisive = [options, versions(), cpu_model(), sources()]
    return hashlib.sha256(json.dumps(decisive).encode()).hexdigest()


def sources() -> str:
    """A hash of the package's own files, of all schemes, of all experiments and of the clips they run on."""
    others = {"__pycache__", "node_modules"}
    paths = {path for path in discovery.PACKAGE.rglob("*") if others.isdisjoint(path.parts)}
    paths |= {path for folder in catalogue.folders() for path in folder.glob("*.py")}
    folders = {path.parent for path in files().values()}  # experiments may share private modules
    paths |= {path for folder in folders for path in folder.glob("*.py")}
    paths |= set(clips.contents())
    digest = hashlib.sha256()
    for path in sorted({path.resolve() for path in paths if path.is_file()}):
        digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()


def traced(error: BaseException) -> str:
    """The reason on one line, and where it was raised."""
    last = traceback.extract_tb(error.__traceback__)[-1:]
    where = f" ({Path(last[0].filename).name}:{last[0].lineno})" if last else ""
    return f"{reason(error)}{where}"
