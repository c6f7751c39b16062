"""Which version of a third-party library is here, and how to get one that is not."""

from __future__ import annotations

import importlib.metadata
import json
import re
import shutil
from collections.abc import Iterator
from pathlib import Path

EXTRA = re.compile(r"^([\w.-]+).*\bextra\s*==\s*['\"]([\w.-]+)['\"]")
"""A requirement's distribution, and the extra that asks for it."""


class NotInstalledError(LookupError):
    """A library that is not here; the message says how to get it."""


NPM = "npm:"
"""Begins the name of a package of JavaScript."""
JAVASCRIPT = Path(__file__).parent / "javascript"
"""Where such packages are installed."""


def version(peer: str) -> str:
    """The version of a distribution, or of a package of JavaScript ("npm:three"), that is installed.

    Raises
    ------
    NotInstalledError
        With the extra of this package, or the target of make, that installs it.
    """
    if peer.startswith(NPM):
        return _javascript(peer.removeprefix(NPM))
    try:
        return importlib.metadata.version(peer)
    except importlib.metadata.PackageNotFoundError:
        raise NotInstalledError(f"{peer} is not installed{_hint(peer)}") from None


def _javascript(package: str) -> str:
    if shutil.which("node") is None:
        raise NotInstalledError(f"node is not installed, which {package} needs")
    try:
        text = (JAVASCRIPT / "node_modules" / package / "package.json").read_text(encoding="utf-8")
    except OSError:
        raise NotInstalledError(f"{package} is not installed (make peers-node)") from None
    return str(json.loads(text)["version"])


def _hint(peer: str) -> str:
    extras = (extra for name, extra in _optional() if _plain(name) == _plain(peer))
    return next((f" (extra '{extra}')" for extra in extras), "")


def _optional() -> Iterator[tuple[str, str]]:
    """Every distribution that an extra asks for, with the extra."""
    try:
        requirements = importlib.metadata.requires("quatspline") or []
    except importlib.metadata.PackageNotFoundError:  # sources that nobody installed
        return
    yield from ((m[1], m[2]) for m in map(EXTRA.match, requirements) if m)


def _plain(name: str) -> str:
    """A distribution's name as registries compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()
