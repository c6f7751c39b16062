"""Which scheme should interpolate my orientations, and what does it cost me?

Keyframes go in, a scheme makes a curve of them, instruments measure the curve, and tables, figures
and a page show what was measured.  Start with ``quatspline.build``.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from quatspline.system import moved

if TYPE_CHECKING:
    from quatspline.catalogue import build, scheme, schemes
    from quatspline.comparing import compare
    from quatspline.curve import Curve
    from quatspline.kernels.operations import Operations, Per
    from quatspline.keyframes import Keyframes
    from quatspline.proposed.quartic import QuarticSpline
    from quatspline.solving import ConvergenceError, SolveReport

__version__ = "0.2.0"

_HOMES = {
    "Curve": "quatspline.curve",
    "SolveReport": "quatspline.solving",
    "ConvergenceError": "quatspline.solving",
    "Keyframes": "quatspline.keyframes",
    "Operations": "quatspline.kernels.operations",
    "Per": "quatspline.kernels.operations",
    "QuarticSpline": "quatspline.proposed.quartic",
    "build": "quatspline.catalogue",
    "compare": "quatspline.comparing",
    "scheme": "quatspline.catalogue",
    "schemes": "quatspline.catalogue",
}

__all__ = [
    "ConvergenceError",
    "Curve",
    "Keyframes",
    "Operations",
    "Per",
    "QuarticSpline",
    "SolveReport",
    "__version__",
    "build",
    "compare",
    "scheme",
    "schemes",
]


moved.install()


def __getattr__(name: str) -> Any:
    # Heavy imports (numba, scipy) wait until a name is used.
    if name in _HOMES:
        value = getattr(importlib.import_module(_HOMES[name]), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module 'quatspline' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
