"""What turns docs/ into pages: formulas as MathML, citations, links out of docs, two more pages.

The sources stay plain Markdown that a repository's viewer renders.  Whatever cannot be resolved, a
formula, a key of references.bib, a file, is a warning, which ends a strict build.
"""

from __future__ import annotations

import html
import re
from pathlib import Path
from typing import Any

from latex2mathml.converter import convert
from mkdocs.plugins import get_plugin_logger
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parents[2]
REFERENCES = "references.md"
AT_ROOT = {"CHANGELOG.md": "changelog.md", "CONTRIBUTING.md": "contributing.md"}
"""Pages that stand at the root of a checkout."""
SHOWN = ("author", "year", "title", "journal", "booktitle", "volume", "pages", "note")
"""Fields of an entry that its line prints, in this order."""

# Code comes first in the alternation: a dollar or bracket inside it is none of ours.
CODE = r"(?P<code>^ *```.*?^ *```$|`[^`\n]+`)"
FORMULA = re.compile(CODE + r"|\$\$(?P<block>.+?)\$\$|\$(?P<inline>[^$]+?)\$", re.M | re.S)
CITATION = re.compile(CODE + r"|\[(?P<keys>@[\w:]+(?:; *@[\w:]+)*)\]", re.M | re.S)
LINK = re.compile(
    CODE + r"|\[(?P<text>[^\]]+)\]\((?P<target>\.\./[^)#]+)(?P<anchor>#[^)]*)?\)", re.M | re.S
)
FROM_ROOT = re.compile(CODE + r"|\]\((?P<file>(?:docs/)?(?P<page>[\w/-]+\.md))", re.M | re.S)
RELATION = r"=|\\(?:approx|le|ge|equiv|mapsto|leftarrow|Rightarrow)(?![a-z])"
BREAK = re.compile(
    r"(?P<open>\\left(?![a-z])|\\begin\{\w+\*?\}|\\?[{(\[])|(?P<close>\\right(?![a-z])|\\end\{\w+\*?\}|\\?[})\]])"
    rf"|(?P<space>\\q?quad)|(?P<before>{RELATION}|(?<![\^_,])[+-]|\\(?:exp|ln)(?![a-z]))"
)
"""What opens and closes a group, and where a formula may be broken."""
SIGN = re.compile(r"^\s*[+-](?=.*\S)")
LONE = re.compile(rf"\s*(?:{RELATION}|[+-])?\s*")
"""What does not stand on a line by itself."""
FONT = re.compile(r"\\math(bb|bf|sf) ?([A-Za-z])")
UNIT = re.compile(r"(?<=\d)(?=dd|cc|mm|cm|em|ex|sp|bp|pc|pt|mu)")
"""A number before two letters that the converter takes for a length, as in 2dd."""
TAG = re.compile(r"\\tag\{([^}]*)\}")
UNREAD = re.compile(r"\\[A-Za-z]+|<mi>&</mi>")
"""What the converter passes through where it does not know a command or an environment."""
ENTRY = re.compile(r"^@\w+\{(?P<key>\w+),\n(?P<body>.*?)^\}", re.M | re.S)
FIELD = re.compile(r"^ *(\w+) *= *\{?(.*?)\}?,?$", re.M)

log = get_plugin_logger("docs")
formulas: dict[str, list[str]] = {}
"""The MathML of each page, by its place, while Markdown is at work on the text around it."""


def on_files(files: Files, config: Any) -> Files:
    """Add the pages that stand at the root, and the references."""
    for source, place in AT_ROOT.items():
        files.append(File.generated(config, place, abs_src_path=str(ROOT / source)))
    files.append(File.generated(config, REFERENCES, content=_references()))
    return files


def on_page_markdown(text: str, page: Any, **_: Any) -> str:
    """Resolve citations and links out of docs, and take formulas out of Markdown's way."""
    place = page.file.src_uri
    up = "../" * place.count("/")
    if place in AT_ROOT.values():
        text = FROM_ROOT.sub(lambda m: m["code"] or f"]({AT_ROOT.get(m['file'], m['page'])}", text)
    text = CITATION.sub(lambda m: m["code"] or _cited(m["keys"], up, place), text)
    text = LINK.sub(lambda m: m["code"] or _linked(m, place), text)
    kept = formulas[place] = []

    def keep(m: re.Match[str]) -> str:
        if m["code"]:
            return m["code"]
        kept.append(_mathml(m["block"] or m["inline"], m["block"] is not None, place))
        return f"MATHML{len(kept) - 1}X"

    return FORMULA.sub(keep, text)


def on_page_content(content: str, page: Any, **_: Any) -> str:
    """Put the formulas back."""
    kept = formulas.pop(page.file.src_uri)
    return re.sub(r"MATHML(\d+)X", lambda m: kept[int(m[1])], content)


def _mathml(source: str, block: bool, place: str) -> str:
    if not block:
        return _converted(source, "inline", place)
    made = "".join(_converted(part, "block", place) for part in parts(TAG.sub("", source)))
    number = "".join(f'<span class="number" id="{t}">({t})</span>' for t in TAG.findall(source))
    return f'<span class="equation"><span class="parts">{made}</span>{number}</span>'


def _converted(source: str, display: str, place: str) -> str:
    try:
        made = str(convert(_dialect(SIGN.sub(r"{}\g<0>", source)), display=display))
    except Exception as error:  # of many kinds, by what is malformed
        log.warning("%s: %s in the formula %r", place, error, source)
        return html.escape(source)
    if left := UNREAD.findall(made):
        log.warning("%s: %s is left of the formula %r", place, left[0], source)
    return made


def parts(source: str) -> list[str]:
    """A displayed formula in pieces between which a narrow page may break its line.

    Breaks stand after a wide space, before relations, sums and the factors of a product of exponentials, outside
    braces, brackets and environments.
    """
    pieces, depth, start = [], 0, 0
    for m in BREAK.finditer(source):
        depth += bool(m["open"]) - bool(m["close"])
        at = m.end() if m["space"] else m.start()
        if depth == 0 and (m["space"] or m["before"]) and not LONE.fullmatch(source[start:at]):
            pieces.append(source[start:at])
            start = at
    return [piece for piece in (*pieces, source[start:]) if piece.strip()]


def _dialect(source: str) -> str:
    """A formula as the converter reads it."""
    source = UNIT.sub("{}", FONT.sub(r"\\math\1{\2}", source))
    return source.replace("{aligned}", "{align*}").strip()


def _cited(keys: str, up: str, place: str) -> str:
    known, links = _entries(), []
    for key in re.findall(r"@([\w:]+)", keys):
        if key not in known:
            log.warning("%s cites %s, which references.bib does not have", place, key)
        links.append(f"[{key}]({up}{REFERENCES}#{key})")
    return f"({', '.join(links)})"


def _linked(m: re.Match[str], place: str) -> str:
    """A link that stays in docs; one that leads to a file of the checkout becomes its text."""
    docs = ROOT / "docs"
    target = ((docs / place).parent / m["target"]).resolve()
    if target.is_relative_to(docs):
        return m[0]
    if target.parent == ROOT and (known := AT_ROOT.get(target.name)):
        return f"[{m['text']}]({'../' * place.count('/')}{known})"
    if not target.exists():
        log.warning("%s links to %s, which does not exist", place, m["target"])
    return m["text"]


def _entries() -> dict[str, dict[str, str]]:
    text = (ROOT / "references.bib").read_text(encoding="utf-8")
    return {m["key"]: dict(FIELD.findall(m["body"])) for m in ENTRY.finditer(text)}


def _references() -> str:
    lines = [
        "# References",
        "",
        "The publications and programs that pages and docstrings cite, by key.",
        "",
    ]
    for key, fields in sorted(_entries().items()):
        if "author" in fields:
            fields["author"] = fields["author"].replace(" and ", "; ")
        parts = [_plain(fields[name]) for name in SHOWN if name in fields]
        if "doi" in fields:
            parts.append(f"[doi:{fields['doi']}](https://doi.org/{fields['doi']})")
        elif "url" in fields:
            parts.append(f"<{fields['url']}>")
        parts = [part.rstrip(".") for part in parts]
        lines += [f'- <span id="{key}"></span>**{key}**: ' + ". ".join(parts)]
    return "\n".join(lines) + "\n"


def _plain(value: str) -> str:
    r"""BibTeX's braces and escapes as text; formulas, such as {$C^2$}, stay."""
    value = re.sub(r'\{?\\"\{?(\w)\}?\}?', lambda m: m[1] + "\u0308", value)
    return re.sub(r"[{}]", "", value).replace(r"\&", "&").replace("--", "–")
