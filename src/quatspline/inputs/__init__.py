"""What users hand over, taken as arrays or refused in one sentence."""

from __future__ import annotations

import importlib
from typing import Any

from quatspline.system import moved


def __getattr__(name: str) -> Any:
    """What stood here while this was one module, in version 0.1."""
    new = "quatspline.inputs.arrays"
    arrays = importlib.import_module(new)
    if name.startswith("_") or name not in vars(arrays):
        raise AttributeError(f"module 'quatspline.inputs' has no attribute {name!r}")
    moved.tell(f"quatspline.inputs.{name}", f"{new}.{name}", 3)
    return vars(arrays)[name]
