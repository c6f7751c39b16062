"""Quote measurements in the README: ``python -m quatspline.report.readme [--adopt results]``.

Text between ``<!-- begin NAME -->`` and ``<!-- end NAME -->`` is generated from ``results/reference``; --adopt
first takes the tables of a finished run as the new reference.
"""

from __future__ import annotations

import argparse
import re
import shutil
from collections.abc import Callable
from pathlib import Path

from quatspline.registry import PACKAGE, found
from quatspline.report import targets
from quatspline.report.findings import lines, reader
from quatspline.report.results import MANIFEST, read_json

ROOT = PACKAGE.parents[1]
REFERENCE = ROOT / "results" / "reference"
PICTURES = ROOT / "docs" / "images"


def findings_block() -> str:
    """The findings, from the reference tables."""
    return "\n".join(lines(REFERENCE))


def schemes_block() -> str:
    """The table of schemes and what they claim."""
    head = [
        "| scheme | what it is | C^k | order | shaped by | from |",
        "| --- | --- | ---: | ---: | --- | --- |",
    ]
    rows = []
    for name, item in found().items():
        s = item.scheme
        if s is None:
            rows.append(f"| `{name}` | n/a: {item.problem} | | | | |")
            continue
        support = "all keyframes" if s.support is None else f"{s.support} keyframes"
        origin = s.peer or "quatspline"
        rows.append(f"| `{name}` | {s.title} | {s.continuity} | {s.order} | {support} | {origin} |")
    return "\n".join(head + rows)


def speed_block() -> str:
    """The speed targets with the machine that they were measured on, from the reference tables."""
    run = read_json(REFERENCE / MANIFEST)
    cpu, known = run["cpu"], run["versions"]
    where = (
        f"{cpu['model']}, {cpu['cores']} cores, Python {known['python']}, numba {known['numba']}"
    )
    return f"Measured on {where}, {run['end'][:10]}.\n\n{targets.markdown(reader(REFERENCE))}"


BLOCKS: dict[str, Callable[[], str]] = {
    "findings": findings_block,
    "speed": speed_block,
    "schemes": schemes_block,
}


def renewed(text: str) -> str:
    """The README's text with every generated block written anew."""
    for name, block in BLOCKS.items():
        begin, end = f"<!-- begin {name} -->\n", f"<!-- end {name} -->"
        if begin in text:
            before, rest = text.split(begin, 1)
            text = f"{before}{begin}{block()}\n{end}{rest.split(end, 1)[1]}"
    return text


def adopt(results: Path) -> None:
    """Take the tables of a finished run as the reference that later runs are compared with."""
    REFERENCE.mkdir(parents=True, exist_ok=True)
    for table in sorted([*results.glob("*.csv"), *results.glob("*.md"), results / MANIFEST]):
        if not re.fullmatch(r"figure\d", table.stem):
            shutil.copyfile(table, REFERENCE / table.name)
    PICTURES.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(results / "figure3.png", PICTURES / "figure3.png")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--adopt", type=Path, metavar="RESULTS")
    arguments = parser.parse_args()
    if arguments.adopt:
        adopt(arguments.adopt)
    readme = ROOT / "README.md"
    readme.write_text(renewed(readme.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
