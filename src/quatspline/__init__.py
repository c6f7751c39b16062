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
    from quatspline.keyframes import Keyframes
    from quatspline.motion import Motion, MotionFileError, read_motion, write_motion
    from quatspline.operations import Operations, Per
    from quatspline.proposed.quartic import QuarticSpline
    from quatspline.solving import ConvergenceError, SolveReport

__version__ = "0.2.0"

_HOMES = {
    "Curve": "quatspline.curve",
    "SolveReport": "quatspline.solving",
    "ConvergenceError": "quatspline.solving",
    "Keyframes": "quatspline.keyframes",
    "Motion": "quatspline.motion",
    "MotionFileError": "quatspline.motion",
    "Operations": "quatspline.operations",
    "Per": "quatspline.operations",
    "QuarticSpline": "quatspline.proposed.quartic",
    "build": "quatspline.catalogue",
    "compare": "quatspline.comparing",
    "read_motion": "quatspline.motion",
    "scheme": "quatspline.catalogue",
    "schemes": "quatspline.catalogue",
    "write_motion": "quatspline.motion",
}

__all__ = [
    "ConvergenceError",
    "Curve",
    "Keyframes",
    "Motion",
    "MotionFileError",
    "Operations",
    "Per",
    "QuarticSpline",
    "SolveReport",
    "__version__",
    "build",
    "compare",
    "read_motion",
    "scheme",
    "schemes",
    "write_motion",
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
