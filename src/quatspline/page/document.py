"""The page's text: sections with what the folder holds for them, the data, and the assets, in one file."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from quatspline import __version__
from quatspline.findings.findings import Finding, findings
from quatspline.findings.quotes import Quote
from quatspline.page import plots, rankings, sections
from quatspline.page.chooser import chooser
from quatspline.page.derivations import Derivations
from quatspline.page.folder import Folder
from quatspline.page.glossary import column
from quatspline.page.motion import Scene, player_data
from quatspline.page.policy import policy
from quatspline.page.reference import Beside, place, quick, reference
from quatspline.page.sections import Section
from quatspline.page.speed import speed
from quatspline.page.table1 import side_by_side
from quatspline.system.packing import deflated

ASSETS = Path(__file__).parent / "assets"
SCRIPTS = (
    *("data", "address", "theme", "contents", "figures", "chooser", "tables", "plots"),
    *("scenes", "geometry", "stage", "path", "strip", "clock", "player"),
    *("jets", "curves", "pasted", "drawing"),
    *("recording", "wires", "replay", "start"),
)
"""Scripts in the order that they are run."""

TOPICS = {
    "reproduction": "What reproduces",
    "protocol": "What is protocol",
    "warning": "Before any advice",
    "recommendation": "Recommendation",
}
MAKERS: dict[str, tuple[tuple[str, ...], Callable[[Folder], Any]]] = {
    "chooser": (("choosing", "excursion"), chooser),
    "table1": (
        ("table1",),
        lambda folder: side_by_side(folder.frame("table1"), reference(folder, "table1")),
    ),
    "speed": (("speed",), speed),
}
"""What templates of sections show that is made from tables, by the section's block: the tables, and what makes it."""

ADDED, FOUND = "What the measurements add", "What was found"
"""Headings of further topics, of the whole page and of a section."""


def document(
    folder: Folder,
    *,
    title: str,
    scenes: Sequence[Scene],
    parts: Sequence[Section],
    said: Sequence[Finding] | None = None,
) -> str:
    """The whole page as text: the same for the same folder."""
    measured = _schemes(folder, [])
    sampled = [player_data(scene, measured) for scene in scenes]
    motions = [motion for motion in sampled if motion["curves"]]
    have = {kind for kind, some in (("scenes", motions), ("replays", folder.replays)) if some}
    told = findings(folder.frame) if said is None else said
    shown = [_filled(section, folder, have, told) for section in _sections(folder, parts)]
    scripts = list(_scripts())
    context = {
        "title": title,
        "version": __version__,
        "findings": _grouped([each for each in told if each.topic not in _apart(parts)]),
        "sections": [section for section in shown if section],
        "manifest": folder.manifest,
        "failures": folder.failures,
        "quick": quick(folder),
        "reference": place() is not None,
        "beside": Beside(folder),
        "docs": Derivations(folder.path),
        "data": list(_data(folder, motions)),
        "style": Markup((ASSETS / "page.css").read_text(encoding="utf-8")),
        "policy": Markup(policy(scripts)),
        "scripts": list(map(Markup, scripts)),
    }
    return _environment().get_template("page.html").render(context)


def _environment() -> Environment:
    """Everything that is not marked as safe is escaped; a name that is missing is an error."""
    options: dict[str, Any] = {"trim_blocks": True, "lstrip_blocks": True}
    loader = FileSystemLoader(ASSETS)
    environment = Environment(loader=loader, autoescape=True, undefined=StrictUndefined, **options)
    environment.filters |= {
        "quote": quote_attributes,
        "embedded": embedded,
        "coded": coded,
    }
    environment.tests["quote"] = lambda part: isinstance(part, Quote)
    return environment


def _scripts() -> Iterator[str]:
    from plotly.offline import get_plotlyjs

    yield str(get_plotlyjs())
    yield from ((ASSETS / f"{name}.js").read_text(encoding="utf-8") for name in SCRIPTS)


# -- sections -----------------------------------------------------------------------------------


def _sections(folder: Folder, parts: Sequence[Section]) -> tuple[Section, ...]:
    """All sections, the last with the tables that no other names."""
    named = {name for section in parts for name in section.tables}
    rest = tuple(name for name in folder.tables if name not in named)
    other = Section(sections.OTHER.key, sections.OTHER.title, tables=rest)
    return (*parts, other)


def _filled(
    section: Section, folder: Folder, have: set[str], told: Sequence[Finding]
) -> dict[str, Any] | None:
    """A section with its tables, figures, plots and findings; None if there is nothing to show."""
    tables = [_table(name, section, folder) for name in section.tables if name in folder.tables]
    played = section.needs in have
    if not tables and not played:
        return None
    own = _grouped([each for each in told if each.topic in section.topics], FOUND)
    block = section.block if played or not section.needs else ""
    made = _made(section, folder)
    return {"section": section, "block": block, "tables": tables, "findings": own, "made": made}


def _apart(parts: Sequence[Section]) -> set[str]:
    """Topics of findings that stand in sections of their own."""
    return {topic for section in parts for topic in section.topics}


def _made(section: Section, folder: Folder) -> Any:
    """What the section's own template shows beside its tables.

    Raises ValueError that names the tables if they lack a column, or hold what they cannot.
    """
    names, make = MAKERS.get(section.block, ((), lambda folder: None))
    try:
        return make(folder) if not names or names[0] in folder.tables else None
    except (LookupError, TypeError, ValueError) as error:
        there = [name for name in names if name in folder.tables]
        files = ", ".join(str(folder.path / f"{name}.csv") for name in there)
        what = f"no column {error}" if isinstance(error, KeyError) else error
        raise ValueError(f"{files}: {what}") from error


def _table(name: str, section: Section, folder: Folder) -> dict[str, Any]:
    table, picture = folder.tables[name], folder.pictures.get(name)
    drawn = [plots.specification(p, table) for p in section.plots if p.table == name]
    return {
        "table": table,
        "plots": [spec for spec in drawn if spec],
        "picture": picture,
        "size": folder.manifest.get("sizes", {}).get(name, ""),
    }


# -- findings -----------------------------------------------------------------------------------


def _grouped(found: Sequence[Finding], other: str = ADDED) -> list[tuple[str, list[Finding]]]:
    """Findings under their headings, in order; those of further topics under the other."""
    groups: dict[str, list[Finding]] = {}
    for finding in found:
        groups.setdefault(TOPICS.get(finding.topic, other), []).append(finding)
    return list(groups.items())


def quote_attributes(quote: Quote) -> dict[str, str]:
    """Where a number comes from, as data attributes; values are JSON."""
    cells = [
        {"table": c.table, "row": _plain(c.row), "column": c.column, "value": _plain(c.value)}
        for c in quote.cells
    ]
    source = quote.source
    return {
        "data-table": source.table,
        "data-row": json.dumps(_plain(source.row), ensure_ascii=False),
        "data-column": source.column,
        "data-value": json.dumps(_plain(quote.value), ensure_ascii=False),
        "data-expression": quote.expression,
        "data-spec": quote.spec,
        "data-cells": json.dumps(cells, ensure_ascii=False),
    }


def _plain(value: Any) -> Any:
    """A value of a table as JSON takes it."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    return value.item() if hasattr(value, "item") else value


def coded(text: str) -> Markup:
    """Text in which what stands between backticks is code."""
    kinds = (Markup("{}"), Markup("<code>{}</code>"))
    return Markup("").join(kinds[i % 2].format(part) for i, part in enumerate(text.split("`")))


# -- data ---------------------------------------------------------------------------------------


def _data(folder: Folder, motions: list[dict[str, Any]]) -> Iterator[tuple[str, Any]]:
    """What scripts read, by the id of the element that holds it."""
    for name, table in folder.tables.items():
        yield f"csv-{name}", table.text
        if name in folder.pictures:
            yield f"picture-{name}", deflated(folder.pictures[name].svg)
    yield "scenes", motions
    yield "replays", folder.replays
    yield "looks", {name: plots.scheme_look(name) for name in sorted(_schemes(folder, motions))}
    yield "columns", {name: _columns(name, table.columns) for name, table in folder.tables.items()}
    yield "rankings", {name: vars(ranking) for name, ranking in rankings.RANKINGS.items()}


def _schemes(folder: Folder, motions: list[dict[str, Any]]) -> set[str]:
    named = {name for motion in motions for name in motion["curves"]}
    for name, table in folder.tables.items():
        if "scheme" in table.columns:
            named |= set(folder.frame(name)["scheme"].astype(str))
    return named


def _columns(table: str, names: list[str]) -> dict[str, Any]:
    return {name: vars(column(table, name)) for name in names}


def embedded(value: Any) -> Markup:
    """JSON that may stand in a script element whatever it holds."""
    text = json.dumps(value, ensure_ascii=False, separators=(",", ":"))
    return Markup(text.replace("<", "\\u003c").replace("\u2028", "\\u2028"))
