"""Quote measurements in the README and in docs: ``python -m tools.readme [--adopt results]``.

Text between ``<!-- begin NAME -->`` and ``<!-- end NAME -->`` is generated from ``results/reference``; --adopt
first takes the tables of a finished run as the new reference.  The command that the README shows is run; its
picture and those of derivations are drawn.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from textwrap import fill

from quatspline.catalogue import found, maker
from quatspline.discovery import PACKAGE
from quatspline.findings import targets
from quatspline.findings.findings import findings, lines, reader
from quatspline.findings.headlines import headlines
from quatspline.runs.manifest import MANIFEST, read_json
from quatspline.system.atomic import replacing
from tools.derivations import draw
from tools.robot import robot

ROOT = PACKAGE.parents[1]
REFERENCE = ROOT / "results" / "reference"
DOCS = ROOT / "docs"
PICTURES = DOCS / "images"
QUOTING = (ROOT / "README.md", *(DOCS / f"{page}.md" for page in ("findings", "schemes", "speed")))
"""Files with generated blocks."""
ROBOT = "examples/robot.csv"
SHOWN = ("Warning", "Take ")
TIMES = "ns/sample"
WIDTH = 108
"""Characters of a line that a terminal's output is folded to."""

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


def headlines_block() -> str:
    """The findings in plain words, from the reference tables."""
    return "\n".join(lines(headlines(reader(REFERENCE))))


def compare_block() -> str:
    """What the command of the README prints, folded: warnings, the advice in one sentence, and the table.

    Times, which differ from run to run, are left out.
    """
    with TemporaryDirectory() as folder:
        call = [sys.executable, "-m", "quatspline", "compare", ROBOT, "--out", folder]
        printed = subprocess.run(call, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    above, table = printed.strip().split("\n\n")
    said = [line for line in above.splitlines() if line.startswith(SHOWN)]
    shown = [*said, "", *without_times(table.splitlines())]
    return "\n".join(["```", *(fill(line, WIDTH, subsequent_indent="  ") for line in shown), "```"])


def without_times(table: list[str]) -> list[str]:
    """The rows of a table in text without its last column, nanoseconds; not what is said below it."""
    width = len(table[0].removesuffix(TIMES).rstrip())
    return [line[:width] for line in table if len(line) == len(table[0])]


def schemes_block() -> str:
    """The table of schemes and what they claim, with links from docs."""
    head = [
        "| scheme | what it is | C^k | order | shaped by | from |",
        "| --- | --- | ---: | ---: | --- | --- |",
    ]
    rows, pages = [], derivations()
    for name, item in found().items():
        s = item.scheme
        if s is None:  # not installed here: the page says where all are named
            continue
        support = "all keyframes" if s.support is None else f"{s.support} keyframes"
        link = DOCS / "peers.md" if s.peer else pages.get(name)
        shown = f"[`{name}`]({link.relative_to(DOCS).as_posix()})" if link else f"`{name}`"
        rows.append(
            f"| {shown} | {s.title} | {s.continuity} | {s.order} | {support} | {maker(name)} |"
        )
    return "\n".join(head + rows)


def speed_block() -> str:
    """The speed targets with the machine that they were measured on, from the reference tables."""
    run = read_json(REFERENCE / MANIFEST)
    table = targets.markdown(reader(REFERENCE))
    return f"{targets.measured_on(run)}\n\n{table}\n\n{targets.ACCURACY}"


BLOCKS: dict[str, Callable[[], str]] = {
    "compare": compare_block,
    "headlines": headlines_block,
    "findings": findings_block,
    "speed": speed_block,
    "schemes": schemes_block,
}


def renewed(text: str, blocks: Mapping[str, Callable[[], str]] = BLOCKS) -> str:
    """A file's text with every generated block written anew."""
    for name, block in blocks.items():
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
    robot(ROOT / ROBOT, PICTURES / "robot.png")
    draw(PICTURES)


if __name__ == "__main__":
    main()
