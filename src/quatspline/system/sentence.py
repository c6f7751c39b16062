"""What is told in one line, whatever it quotes."""

from __future__ import annotations

MOST = 300
"""Characters of a line that is told."""


def one_line(text: str, most: int = MOST) -> str:
    r"""A text in one line: white space one blank, what no terminal should obey escaped, its middle cut.

    Examples
    --------
    >>> one_line("a\n  b\x1b[31m")
    'a b\\x1b[31m'
    >>> one_line("0" * 1000, most=9)
    '0000...00'
    """
    line = printable(" ".join(text.split()))
    if len(line) <= most:
        return line
    kept = most - len("...")
    return f"{line[: kept - kept // 3]}...{line[-(kept // 3) :]}"


def printable(text: str) -> str:
    r"""A text with what no terminal should obey, and no file can hold, escaped.

    Examples
    --------
    >>> printable("a\nb\udcff")
    'a\\nb\\udcff'
    """
    return "".join(c if c.isprintable() else _escaped(c) for c in text)


def _escaped(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")
