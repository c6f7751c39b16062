"""Lines of a text file and their fields, whatever separates them."""

from __future__ import annotations

import csv
import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TextIO

from quatspline.motion.errors import MotionFileError
from quatspline.motion.files.names import recognised
from quatspline.motion.files.opening import number, text_lines

SEPARATORS = {";": "semicolons", "|": "bars", ",": "commas", "\t": "tabs", " ": "blanks"}
"""What may separate fields; of two that suit a line alike, the first."""

MISSING = frozenset({"", "nan", "na", "n/a", "null", "none", "-"})
"""What tools write for a number that they do not have."""

DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")


COMMENT = r"#|%|//"
"""What begins a comment, as a pattern; behind the first line that is none, # alone does."""

_FIRST_COMMENTS = re.compile(rf"[\s\ufeff\"']*(?:{COMMENT})")
_LATER_COMMENTS = re.compile(r"\s*#")  # a row may begin with a label such as "#1" or //host/file


@dataclass
class Lines:
    """Lines of a file that are neither blank nor comments; comments are kept while ``heading``."""

    path: Path
    stream: TextIO
    number: int = 0
    heading: bool = True
    comments: list[tuple[int, str]] = field(default_factory=list)

    def __iter__(self) -> Iterator[str]:
        comment = _FIRST_COMMENTS
        for line in text_lines(self.path, self.stream):
            self.number += 1
            if comment.match(line):
                if self.heading:
                    self.comments.append((self.number, line))
            elif line.strip():
                comment = _LATER_COMMENTS
                yield line

    def error(self, what: object, number: int | None = None) -> MotionFileError:
        """A refusal that names the file and the line."""
        return MotionFileError(f"{self.path}, line {number or self.number}: {what}")


def separator(line: str) -> str:
    """What separates the fields of a line: that by which most of them are numbers or names."""

    def suits(mark: str) -> tuple[float, int]:
        found = [part.strip().strip('"') for part in parts(line.strip("\r\n "), mark)]
        fine = [not p or is_number(p, mark != ",") or _is_name(p) for p in found]
        return sum(fine) / max(len(fine), 1), sum(fine)

    present = [mark for mark in SEPARATORS if mark in line.strip()]
    if "\t" in present and " " not in present:
        present.append(" ")  # runs of tabs count as blanks where that makes more sense
    return max(present, key=suits, default=" ")


def _is_name(part: str) -> bool:
    return recognised(part) and not any(mark in part for mark in ";|,\t")


def parts(line: str, mark: str) -> list[str]:
    """What stands between the separators of a line without quotes."""
    return line.split() if mark == " " else line.split(mark)


def split(lines: Lines, line: str, mark: str, more: Iterator[str], width: int = 0) -> list[str]:
    """The fields of a line; one in quotes may go on in the lines that follow."""
    if '"' in line:
        line = line.strip().replace("\t", " ") if mark == " " else line
        reader = csv.reader(
            itertools.chain([line], more), delimiter=mark, skipinitialspace=True, strict=True
        )
        number = lines.number
        try:
            return [part.strip() for part in next(reader)]
        except csv.Error as error:
            raise lines.error(f"quotes do not match: {error}", number) from None
    fields = parts(line, mark)
    if mark == "\t" and len(fields) != width:
        blanks = line.split()  # white space of both kinds
        fields = blanks if len(blanks) == width else fields
    return fields


def is_number(text: str, decimal_comma: bool = True) -> bool:
    """Whether a field is a number or stands for one that is missing."""
    text = text.strip()
    if decimal_comma and DECIMAL_COMMA.fullmatch(text):
        return True
    try:
        number(text)
    except ValueError:
        return text.lower() in MISSING and bool(text)
    return True
