"""quatspline: which scheme should interpolate my orientations, and what does it cost me?

Keyframes go in, a scheme makes a curve of them, instruments measure the curve, and tables, figures
and a page show what was measured.  Start with ``quatspline.build``.
"""

from __future__ import annotations

import importlib
import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from quatspline.comparing import compare
    from quatspline.curve import Curve
    from quatspline.keyframes import Keyframes
    from quatspline.registry import build, scheme, schemes
    from quatspline.schemes.quartic import QuarticSpline
    from quatspline.solving import ConvergenceError, SolveReport

__version__ = "0.1.0"

_HOMES = {
    "Curve": "quatspline.curve",
    "SolveReport": "quatspline.solving",
    "ConvergenceError": "quatspline.solving",
    "Keyframes": "quatspline.keyframes",
    "QuarticSpline": "quatspline.schemes.quartic",
    "build": "quatspline.registry",
    "compare": "quatspline.comparing",
    "scheme": "quatspline.registry",
    "schemes": "quatspline.registry",
}

__all__ = [
    "ConvergenceError",
    "Curve",
    "Keyframes",
    "QuarticSpline",
    "SolveReport",
    "__version__",
    "build",
    "compare",
    "scheme",
    "schemes",
]


class _Package(ModuleType):
    """This package, in which `schemes` is the function and never the subpackage of that name.

    The import system binds a subpackage when its import ends.  Taken away later, it would stand there
    for a moment in which other threads call it.
    """

    def __setattr__(self, name: str, value: Any) -> None:
        if not (name == "schemes" and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package


def __getattr__(name: str) -> Any:
    # Heavy imports (numba, scipy) wait until a name is used.
    if name in _HOMES:
        value = getattr(importlib.import_module(_HOMES[name]), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module 'quatspline' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
