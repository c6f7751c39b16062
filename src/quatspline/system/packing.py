"""Arrays as text, for files that a browser reads."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np


def packed(values: Any, kind: str = "<f4") -> str:
    """Base64 of an array's numbers, row by row, in a little-endian format of numpy."""
    return base64.b64encode(np.ascontiguousarray(values, kind).tobytes()).decode("ascii")
