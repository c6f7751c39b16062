"""The hierarchy of a BVH: joints with offsets and channels, read word by word."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from quatspline.motion.errors import MotionFileError
from quatspline.motion.euler import AXES
from quatspline.motion.files.scripts import Line, numbers, refusal
from quatspline.motion.skeleton import ROOT
from quatspline.quaternion import FloatArray

MOST_CHANNELS = 6
_NOWHERE = np.full(3, np.nan)
"""An offset that is still to come."""


@dataclass
class Tree:
    """Joints in the order of the file.

    Attributes
    ----------
    names, parents, offsets, orders, ends : see `Motion` and `Skeleton`
    columns : the joint, the axis and whether it turns, of every value of a frame
    """

    names: list[str] = field(default_factory=list)
    parents: list[int] = field(default_factory=list)
    offsets: list[FloatArray] = field(default_factory=list)
    orders: list[str] = field(default_factory=list)
    ends: dict[int, FloatArray] = field(default_factory=dict)
    columns: list[tuple[int, int, bool]] = field(default_factory=list)


def tree(path: Path, lines: Sequence[str]) -> Tree:
    """The hierarchy told by the lines before MOTION."""
    content = iter(list(_words(lines)))
    first = next(content, (1, []))
    if [word.upper() for word in first[1]] != ["HIERARCHY"]:
        raise refusal(path, first[0], "HIERARCHY is expected first")
    reader = _Reader(path)
    for number, words in content:
        reader.take(number, words)
    return reader.finished(len(lines))


def _words(lines: Sequence[str]) -> Iterator[Line]:
    """Statements: braces stand on lines of their own."""
    for number, line in enumerate(lines, 1):
        for part in line.replace("{", "\n{\n").replace("}", "\n}\n").split("\n"):
            if words := part.split():
                yield number, words


class _Reader:
    """What was read, and the joints that are open: an end site is that of the joint around it."""

    def __init__(self, path: Path) -> None:
        self.path, self.tree = path, Tree()
        self.open: list[int | None] = []
        self.opening: int | None = None
        self.waiting = ""
        self.told: set[tuple[int, str]] = set()

    def take(self, number: int, words: list[str]) -> None:
        """One statement."""
        word = words[0].upper()
        if (word == "{") != bool(self.waiting):
            what = f"{{ is expected after {self.waiting}" if self.waiting else "{ opens nothing"
            raise self.error(number, what)
        if word == "{":
            self.waiting = ""
            self.open.append(self.opening)
        elif word == "}":
            self._close(number)
        elif word in ("ROOT", "JOINT"):
            self._joint(number, word, " ".join(words[1:]))
        elif word == "END":
            self._end(number)
        elif word == "OFFSET":
            self._offset(number, words[1:])
        elif word == "CHANNELS":
            self._channels(number, words[1:])
        else:
            raise self.error(number, f"unknown word {words[0]!r}")

    def error(self, number: int, what: str) -> MotionFileError:
        """A refusal that names the file and the line."""
        return refusal(self.path, number, what)

    def finished(self, last: int) -> Tree:
        """The whole hierarchy, closed and not empty."""
        if self.open or self.waiting:
            raise self.error(last, "the hierarchy is not closed: a } is missing")
        if not self.tree.names:
            raise self.error(last, "no joint in the hierarchy")
        return self.tree

    def _close(self, number: int) -> None:
        if not self.open:
            raise self.error(number, "} closes nothing")
        closed = self.open.pop()
        joint = len(self.tree.names) - 1 if closed is None else closed
        if closed is not None and (joint, "OFFSET") not in self.told:
            raise self.error(number, f"joint {self.tree.names[joint]!r} has no OFFSET")

    def _joint(self, number: int, word: str, name: str) -> None:
        if (word == "ROOT") != (not self.open):
            place = "stands inside a joint" if self.open else "stands outside a root"
            raise self.error(number, f"{word} {name} {place}")
        parent = self._current(number, word) if self.open else ROOT
        if not name or name in self.tree.names:
            what = f"a second joint is called {name!r}" if name else f"{word} without a name"
            raise self.error(number, what)
        self.opening, self.waiting = len(self.tree.names), f"{word} {name}"
        self.tree.names.append(name)
        self.tree.parents.append(parent)
        self.tree.offsets.append(_NOWHERE)
        self.tree.orders.append("")

    def _end(self, number: int) -> None:
        joint = self._current(number, "End Site")
        if (joint, "END") in self.told:
            name = self.tree.names[joint]
            raise self.error(number, f"joint {name!r} has a second end site")
        self.told.add((joint, "END"))
        self.opening, self.waiting = None, "End Site"

    def _current(self, number: int, word: str) -> int:
        """The joint that is open."""
        if not self.open or self.open[-1] is None:
            raise self.error(number, f"{word} stands outside a joint")
        return self.open[-1]

    def _offset(self, number: int, words: list[str]) -> None:
        offset = numbers(self.path, number, words, 3, "OFFSET")
        if self.open and self.open[-1] is None:
            around = self.open[-2]
            assert around is not None
            if around in self.tree.ends:
                raise self.error(number, "a second OFFSET of one end site")
            self.tree.ends[around] = offset
            return
        joint = self._current(number, "OFFSET")
        self._once(number, joint, "OFFSET")
        self.tree.offsets[joint] = offset

    def _channels(self, number: int, words: list[str]) -> None:
        joint = self._current(number, "CHANNELS")
        self._once(number, joint, "CHANNELS")
        count, channels = words[0] if words else "", [word.lower() for word in words[1:]]
        if not count.isdecimal() or count != str(len(channels)) or len(channels) > MOST_CHANNELS:
            what = f"CHANNELS {count} and {len(channels)} names: as many as said, at most six"
            raise self.error(number, what)
        for channel in channels:
            axis, kind = channel[:1].upper(), channel[1:]
            if not axis or axis not in AXES or kind not in ("position", "rotation"):
                raise self.error(number, f"unknown channel {channel!r}")
            if channels.count(channel) > 1:
                raise self.error(number, f"channel {channel!r} comes twice")
            turning = kind == "rotation"
            self.tree.columns.append((joint, AXES.index(axis), turning))
            self.tree.orders[joint] += axis if turning else ""

    def _once(self, number: int, joint: int, word: str) -> None:
        if (joint, word) in self.told:
            raise self.error(number, f"a second {word} of joint {self.tree.names[joint]!r}")
        self.told.add((joint, word))
