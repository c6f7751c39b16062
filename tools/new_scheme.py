"""A new scheme from a template: ``python -m tools.new_scheme NAME [FOLDER] [--compiled]``."""

from __future__ import annotations

import argparse
import keyword
import re
import sys
from pathlib import Path

from quatspline.catalogue import found
from quatspline.discovery import PACKAGE, shipped

TEMPLATE, COMPILED = "_template.py", "_template_compiled.py"
NAME = re.compile(r"[a-z][a-z0-9]*([_-][a-z0-9]+)*", re.IGNORECASE)


def new_scheme(name: str, folder: Path, template: str = TEMPLATE) -> Path:
    """Write a template as a scheme of its own into a folder; returns the file.

    Raises
    ------
    ValueError
        For a name that no scheme can have, or that one has, and for a file or folder in the way.
    """
    if not NAME.fullmatch(name) or keyword.iskeyword(name):
        raise ValueError(f"{name!r} is not a name: letters and digits, joined by single _ or -")
    stem = name.lower().replace("-", "_")
    key = stem.replace("_", "-")
    if key in found():
        raise ValueError(f"{key!r} is there already: {found()[key].origin}")
    path = folder / f"{stem}.py"
    text = (shipped("baselines") / template).read_text(encoding="utf-8")
    for old, new in {
        "class Template(": f"class {''.join(part.capitalize() for part in stem.split('_'))}(",
        '"Template"': f'"{key.replace("-", " ").capitalize()}"',
    }.items():
        text = text.replace(old, new)
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        raise ValueError(f"{path}: {error.strerror}") from None
    return path


def default_folder() -> Path:
    """The checkout's baselines; the current folder where the package is installed without one."""
    folder = shipped("baselines")
    return Path.cwd() if folder.is_relative_to(PACKAGE) else folder


def main(arguments: list[str] | None = None) -> int:
    """Exit status: 0 written, 2 refused in one line on stderr."""
    parser = argparse.ArgumentParser(prog="python -m tools.new_scheme", description=__doc__)
    parser.add_argument("name", help="the new scheme: my_scheme or my-scheme")
    parser.add_argument("folder", nargs="?", type=Path, help="where to (default: baselines/)")
    parser.add_argument(
        "--compiled", action="store_true", help="with a family and a fit of its own"
    )
    given = parser.parse_args(arguments)
    template = COMPILED if given.compiled else TEMPLATE
    try:
        path = new_scheme(given.name, given.folder or default_folder(), template)
    except ValueError as refusal:
        print(f"scaffold: {refusal}", file=sys.stderr)
        return 2
    print(f"{path} written: now `make check-baseline NAME={path.stem}`")
    return 0


if __name__ == "__main__":
    sys.exit(main())
