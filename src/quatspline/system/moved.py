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
    "families.bezier": "fitting.bezier",
    "families.block_tridiagonal": "fitting.block_tridiagonal",
    "families.bspline": "fitting.bspline",
    "families.bspline_newton": "fitting.bspline_newton",
    "families.bspline_rows": "fitting.bspline_rows",
    "families.driver": "kernels.driver",
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
    "loading": "system.loading",
    "logcurve": "log_curve",
    "numeric": "stencil",
    "orientations": "inputs.orientations",
    "primitives": "kernels.scalars",
    "registry": "catalogue",
    "report.advice": "findings.recommendation",
    "report.choosing": "findings.decisions",
    "report.findings": "findings.findings",
    "report.heat": "figures.heat",
    "report.motions": "figures.motions",
    "report.page": "page",
    "report.quotes": "findings.quotes",
    "report.results": "runs.results",
    "report.scenes": "figures.scenes",
    "report.shapes": "figures.meshes",
    "report.style": "figures.style",
    "report.targets": "findings.targets",
    "report.teapot": "figures.teapot",
    "rescue": "instruments.rescue",
    "running": "cli.running",
    "stamps": "inputs.stamps",
    "sweeps": "runs.sweeps",
    "trajectories.edges": "trajectories.edge_cases",
    "trajectories.files": "motion.files",
    "warmup": "runs.warmup",
}


class _Moved(MetaPathFinder, Loader):
    """Finds a module under its old name, and puts the module of today in its place."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Of a moved module, or of the package that is gone with all its modules."""
        package, _, old = fullname.partition(".")
        if package != "quatspline" or not (old in MOVED or old == "report"):
            return None
        return ModuleSpec(fullname, self, is_package=old == "report")

    def create_module(self, spec: ModuleSpec) -> None:
        """As usual: an empty one."""

    def exec_module(self, module: ModuleType) -> None:
        """Replace it; the import system hands out what then stands under the name."""
        new = today(module.__name__)
        if new == module.__name__:
            return
        told = f"{module.__name__} has moved to {new}; the old name goes with version 0.3"
        warnings.warn(told, DeprecationWarning, stacklevel=2)
        sys.modules[module.__name__] = importlib.import_module(new)


def today(name: str) -> str:
    """The name that a module of this package, by whichever name, has today."""
    package, _, old = name.partition(".")
    return f"{package}.{MOVED[old]}" if old in MOVED else name


def install() -> None:
    """Have the import system ask here last."""
    sys.meta_path.append(_Moved())
