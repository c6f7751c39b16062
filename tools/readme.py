"""Quote measurements in the README and in docs: ``python -m tools.readme [--adopt results]``.

Text between ``<!-- begin NAME -->`` and ``<!-- end NAME -->`` is generated from ``results/reference``; --adopt
first takes the tables of a finished run as the new reference.
"""

from __future__ import annotations

import argparse
import re
import shutil
from collections.abc import Callable
from pathlib import Path

from quatspline.catalogue import PACKAGE, found
from quatspline.findings import targets
from quatspline.findings.findings import findings, lines, reader
from quatspline.runs.manifest import MANIFEST, read_json
from quatspline.system.atomic import replacing

ROOT = PACKAGE.parents[1]
REFERENCE = ROOT / "results" / "reference"
DOCS = ROOT / "docs"
PICTURES = DOCS / "images"
QUOTING = (ROOT / "README.md", DOCS / "index.md")
"""Files with generated blocks."""

TREATED = re.compile(r"^Schemes?: (.+)\.$", re.M)
"""The line by which a page of docs/mathematics says which schemes it derives."""


def findings_block() -> str:
    """The findings, from the reference tables."""
    return "\n".join(lines(findings(reader(REFERENCE))))


def derivations() -> dict[str, Path]:
    """The page that derives a scheme, by the scheme's name."""
    pages = {}
    for page in sorted((DOCS / "mathematics").glob("*.md")):
        for line in TREATED.findall(page.read_text(encoding="utf-8")):
            pages.update(dict.fromkeys(re.findall(r"`([^`]+)`", line), page))
    return pages


def pages_block() -> str:
    """Which page treats a scheme."""
    pages, rows = derivations(), ["| scheme | what it is | page |", "| --- | --- | --- |"]
    for name, item in found().items():
        if item.scheme is None:
            continue
        page = DOCS / "peers.md" if item.scheme.peer else pages.get(name)
        if page is None:
            rows.append(f"| `{name}` | {item.scheme.title} | – |")
            continue
        title = page.read_text(encoding="utf-8").partition("\n")[0].removeprefix("# ")
        link = f"[{title}]({page.relative_to(DOCS).as_posix()})"
        rows.append(f"| `{name}` | {item.scheme.title} | {link} |")
    return "\n".join(rows)


def schemes_block() -> str:
    """The table of schemes and what they claim."""
    head = [
        "| scheme | what it is | C^k | order | shaped by | from |",
        "| --- | --- | ---: | ---: | --- | --- |",
    ]
    rows, pages = [], derivations()
    for name, item in found().items():
        s = item.scheme
        if s is None:
            rows.append(f"| `{name}` | n/a: {item.problem} | | | | |")
            continue
        support = "all keyframes" if s.support is None else f"{s.support} keyframes"
        origin = s.peer or "quatspline"
        link = pages.get(name)
        shown = f"[`{name}`]({link.relative_to(ROOT).as_posix()})" if link else f"`{name}`"
        rows.append(f"| {shown} | {s.title} | {s.continuity} | {s.order} | {support} | {origin} |")
    return "\n".join(head + rows)


def speed_block() -> str:
    """The speed targets with the machine that they were measured on, from the reference tables."""
    run = read_json(REFERENCE / MANIFEST)
    table = targets.markdown(reader(REFERENCE))
    return f"{targets.measured_on(run)}\n\n{table}\n\n{targets.ACCURACY}"


BLOCKS: dict[str, Callable[[], str]] = {
    "findings": findings_block,
    "speed": speed_block,
    "schemes": schemes_block,
    "pages": pages_block,
}


def renewed(text: str) -> str:
    """A file's text with every generated block written anew."""
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
    """Renew the quotes, of adopted results where there are any."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--adopt", type=Path, metavar="RESULTS")
    arguments = parser.parse_args()
    if arguments.adopt:
        adopt(arguments.adopt)
    for file in QUOTING:
        with replacing(file) as aside:
            aside.write_text(renewed(file.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
