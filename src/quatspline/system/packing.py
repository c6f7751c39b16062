"""Arrays as text, for files that a browser reads."""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np


def packed(values: Any, kind: str = "<f4") -> str:
    """Base64 of an array's numbers, row by row, in a little-endian format of numpy."""
    return base64.b64encode(np.ascontiguousarray(values, kind).tobytes()).decode("ascii")


def deflated(text: str) -> str:
    """Base64 of a text in UTF-8, deflated in zlib's format, which browsers inflate by themselves."""
    return base64.b64encode(zlib.compress(text.encode("utf-8"), 9)).decode("ascii")
