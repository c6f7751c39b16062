"""Files opened for reading: regular ones alone, with lines and numbers of bounded length."""

from __future__ import annotations

import stat
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TextIO

from quatspline.motion.errors import MotionFileError

LONGEST = 2**20
"""Characters in a line: ten thousand numbers; beyond, a file is not what its suffix says."""

KINDS = {
    stat.S_ISFIFO: "a pipe",
    stat.S_ISSOCK: "a socket",
    stat.S_ISCHR: "a device",
    stat.S_ISBLK: "a device",
}
"""What may be at a path and is not read: it may never begin, or never end."""


def check_regular(path: Path) -> None:
    """Refuse what is no file on a disk; opening it tells what is wrong with a folder.

    Raises
    ------
    OSError
        Nothing is there, or it may not be looked at.
    """
    mode = path.stat().st_mode
    for is_kind, kind in KINDS.items():
        if is_kind(mode):
            raise MotionFileError(f"{path}: {kind}, not a file")


def text_lines(path: Path, stream: TextIO) -> Iterator[str]:
    """The lines of a stream with their ends; one that is too long, or has NUL characters, is refused."""
    for number, line in enumerate(iter(lambda: stream.readline(LONGEST + 1), ""), 1):
        if len(line) > LONGEST:
            raise MotionFileError(f"{path}, line {number}: longer than {LONGEST:,} characters")
        if "\0" in line:
            raise MotionFileError(f"{path}, line {number}: a NUL character, which no text has")
        yield line


def lines_of(path: Path) -> list[str]:
    """The lines of a text file without their ends, however they end."""
    check_regular(path)
    with path.open(encoding="utf-8-sig") as stream:
        return [line.removesuffix("\n") for line in text_lines(path, stream)]


def number(text: str) -> float:
    """The number that a text spells.

    Raises
    ------
    ValueError
        Where it is none. `float` takes more: underscores, and digits of other scripts.
    """
    check_spelling(text)
    return float(text)


def numbers(words: Iterable[str]) -> list[float]:
    """The numbers that words spell, as `number` takes each."""
    words = list(words)
    check_spelling("".join(words))
    return list(map(float, words))


def is_whole(word: str) -> bool:
    """Whether a word is a whole number without a sign."""
    return word.isascii() and word.isdecimal()


def check_spelling(text: str) -> None:
    """Refuse, with ValueError, what Python takes in a number and no file means."""
    if "_" in text or not text.isascii():
        raise ValueError(f"{text!r} is not a number")
