"""Modules under the names that they had in version 0.1: for one release they import, with a warning."""

from __future__ import annotations

import importlib
import sys
import warnings
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType

MOVED = {
    "_jit": "kernels.jit",
    "arguments": "cli.arguments",
    "atomic": "system.atomic",
    "experiment": "runs.experiment",
    "forking": "system.forking",
    "families.bezier": "fitting.bezier",
    "families.block_tridiagonal": "fitting.block_tridiagonal",
    "families.bspline": "fitting.bspline",
    "families.bspline_newton": "fitting.newton",
    "families.bspline_rows": "fitting.bspline_rows",
    "families.driver": "engines.driver",
    "families.four_keyframes": "fitting.four_keyframes",
    "families.least_torque": "fitting.least_torque",
    "families.local_rates": "fitting.local_rates",
    "families.peers": "peers.wrapping",
    "families.quintics": "families.polynomials",
    "families.segments": "segments",
    "families.spherical_mean": "families.means",
    "families.tangents": "fitting.tangents",
    "instruments.budget": "timing.budget",
    "instruments.claims": "claims.claim",
    "instruments.cost": "timing.cost",
    "instruments.edges": "instruments.edge_cases",
    "instruments.operations": "timing.operations",
    "instruments.own_rates": "claims.own",
    "instruments.paper_probes": "claims.paper_probes",
    "instruments.probes": "claims.probes",
    "instruments.protocols": "timing.protocols",
    "instruments.published": "claims.published",
    "instruments.speed": "timing.speed",
    "instruments.timing": "timing.interleaved",
    "journal": "runs.journal",
    "kernels.operations": "operations",
    "loading": "system.loading",
    "locking": "system.locking",
    "logcurve": "log_curve",
    "numeric": "stencil",
    "orientations": "inputs.orientations",
    "primitives": "kernels.scalars",
    "registry": "catalogue",
    "report.advice": "findings.recommendation",
    "report.choosing": "findings.decisions",
    "report.findings": "findings.findings",
    "report.heat": "figures.heat",
    "report.manifest": "runs.manifest",
    "report.motions": "figures.motions",
    "report.page": "page",
    "report.provenance": "runs.provenance",
    "report.quotes": "findings.quotes",
    "report.results": "runs.results",
    "report.scenes": "figures.scenes",
    "report.shapes": "figures.meshes",
    "report.store": "runs.store",
    "report.style": "figures.style",
    "report.targets": "findings.targets",
    "report.teapot": "figures.teapot",
    "rescue": "instruments.rescue",
    "running": "cli.running",
    "stamps": "inputs.stamps",
    "stdout": "system.stdout",
    "sweeps": "runs.sweeps",
    "trajectories.edges": "trajectories.edge_cases",
    "trajectories.files": "motion.files",
    "warmup": "runs.warmup",
    "words": "cli.words",
}

LEFT = {
    "report.readme": "tools/readme.py",
    "scaffold": "tools/new_scheme.py",
    "trajectories.search": "tools/paper_search.py",
}
"""Modules that serve the repository only, and where they are there."""


class _Moved(MetaPathFinder, Loader):
    """Finds a module under its old name, and puts the module of today in its place."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Of a moved module, or of the package that is gone with all its modules."""
        if not fullname.startswith("quatspline."):
            return None
        left = LEFT.get(fullname.removeprefix("quatspline."))
        if left:
            told = f"{fullname} has left the package: it is {left} of the repository"
            raise ModuleNotFoundError(told, name=fullname)
        gone = fullname == "quatspline.report"
        return (
            ModuleSpec(fullname, self, is_package=gone)
            if gone or today(fullname) != fullname
            else None
        )

    def create_module(self, spec: ModuleSpec) -> None:
        """As usual: an empty one."""

    def exec_module(self, module: ModuleType) -> None:
        """Replace it; the import system hands out what then stands under the name."""
        new = today(module.__name__)
        if new == module.__name__:
            return
        tell(module.__name__, new, 3)
        sys.modules[module.__name__] = importlib.import_module(new)


def tell(old: str, new: str, stacklevel: int) -> None:
    """Warn of an old name."""
    told = f"{old} has moved to {new}; the old name goes with version 0.3"
    warnings.warn(told, DeprecationWarning, stacklevel=stacklevel)


def today(name: str) -> str:
    """The name that a module of this package, by whichever name, has today."""
    package, _, old = name.partition(".")
    for parts in range(old.count(".") + 1, 0, -1):  # a moved package takes its modules along
        moved = ".".join(old.split(".")[:parts])
        if moved in MOVED:
            return f"{package}.{MOVED[moved]}{old.removeprefix(moved)}"
    return name


def install() -> None:
    """Have the import system ask here first: below a moved package it would find modules twice."""
    sys.meta_path.insert(0, _Moved())
