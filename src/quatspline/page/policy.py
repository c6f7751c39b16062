"""The page's content security policy: it runs the scripts that it was written with, and loads nothing."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Iterable

FORBIDDEN = "default-src 'none'"
PICTURES = "img-src data: blob:"
STYLES = "style-src 'unsafe-inline'"
"""Plotly and the page's own elements set styles."""

FIXED = "base-uri 'none'; form-action 'none'"


def policy(scripts: Iterable[str]) -> str:
    """The policy of a page with these scripts between its script tags.

    A script of another text, an attribute such as ``onclick``, and text that is made code (``eval``) are refused by
    the browser.
    """
    allowed = " ".join(map(digest, scripts))
    return "; ".join((FORBIDDEN, PICTURES, STYLES, f"script-src {allowed}", FIXED))


def digest(script: str) -> str:
    """A script's source expression: the SHA-256 of its text as a browser reads it, in UTF-8."""
    read = script.replace("\r\n", "\n").replace("\r", "\n")
    coded = base64.b64encode(hashlib.sha256(read.encode("utf-8")).digest())
    return f"'sha256-{coded.decode('ascii')}'"
