"""Lists in sentences: names, and quantities after them."""

from __future__ import annotations

from collections.abc import Sequence

from quatspline.findings.quotes import Cell


def listed(names: Sequence[str], spec: str) -> str:
    """A template that names quantities v0, v1, ... after their schemes."""
    return ", ".join(f"{name} {{v{i}:{spec}}}" for i, name in enumerate(names))


def joined(names: Sequence[str]) -> str:
    """Names as a sentence lists them: two at least."""
    return f"{', '.join(names[:-1])} and {names[-1]}"


def numbered(cells: Sequence[Cell]) -> dict[str, Cell]:
    """Cells under the names that `listed` gives them."""
    return {f"v{i}": cell for i, cell in enumerate(cells)}
