"""Acclaim's ASF: a skeleton of bones, each with an axis frame and the axes about which it turns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from quatspline.motion import euler
from quatspline.motion.errors import MotionFileError
from quatspline.motion.euler import AXES
from quatspline.motion.files.opening import lines_of
from quatspline.motion.files.scripts import numbers, refusal
from quatspline.motion.skeleton import ROOT, Skeleton
from quatspline.quaternion import FloatArray

ROOT_NAME = "root"
SECTIONS = (":units", ":root", ":bonedata", ":hierarchy")
INCH = 0.0254


def fixed_turns(angles: FloatArray, order: str) -> FloatArray:
    """Quaternions (..., 4) of turns (rad) about fixed axes: "XYZ" is Rz Ry Rx."""
    return euler.from_angles(angles[..., ::-1], order[::-1])


@dataclass
class Bone:
    """A bone, or the root.

    Attributes
    ----------
    line : where it begins in the file
    axis : angles (3,) as the file has them, with their order, of the frame in which it turns
    dof : what its values are, as "rx"; of the root "tx", too
    tail : direction times length (3,), from where its children hang
    """

    line: int
    name: str = ""
    axis: tuple[FloatArray, str] = (np.zeros(3), AXES)
    dof: tuple[str, ...] = ()
    direction: FloatArray = field(default_factory=lambda: np.zeros(3))
    length: float = 0.0
    place: FloatArray = field(default_factory=lambda: np.zeros(3))

    @property
    def tail(self) -> FloatArray:
        """Where it ends, from where it begins, in global axes at rest."""
        return self.direction * self.length

    @property
    def order(self) -> str:
        """The fixed axes about which it turns, the first first."""
        return "".join(word[1].upper() for word in self.dof if word[0] == "r")


@dataclass
class Bones:
    """What an ASF tells: bones by name, parents, factors to metres and radians."""

    path: Path
    bones: dict[str, Bone] = field(default_factory=dict)
    parents: dict[str, str] = field(default_factory=dict)
    length: float = 1.0
    degrees: bool = True

    def metres(self, units: str) -> float:
        """Metres of a length in the file: CMU divides by the unit of length, Acclaim multiplies."""
        return INCH * (self.length if units == "spec" else 1.0 / self.length)

    def frame(self, name: str) -> FloatArray:
        """The frame (4,) in which a bone turns."""
        angles, order = self.bones[name].axis
        return fixed_turns(np.radians(angles) if self.degrees else angles, order)

    @property
    def names(self) -> list[str]:
        """Bones from the root outwards, each before what hangs on it."""
        children: dict[str, list[str]] = {}
        for child, parent in self.parents.items():
            children.setdefault(parent, []).append(child)
        order, waiting = [], [ROOT_NAME]
        while waiting:
            order.append(name := waiting.pop())
            waiting += children.get(name, [])[::-1]
        return order

    def skeleton(self, scale: float) -> Skeleton:
        """Joints: one at the head of every bone, which hangs on its parent's tail."""
        names = self.names
        index = {name: i for i, name in enumerate(names)}
        parents = [index[self.parents[name]] if name in self.parents else ROOT for name in names]
        offsets = [
            self.bones[ROOT_NAME].place if parent == ROOT else self.bones[names[parent]].tail
            for parent in parents
        ]
        leaves = set(range(len(names))) - set(parents)
        ends = {i: scale * self.bones[names[i]].tail for i in sorted(leaves)}
        orders = ("",) * len(names)
        return Skeleton(np.array(parents, dtype=np.int64), scale * np.array(offsets), orders, ends)


def read_asf(path: Path) -> Bones:
    """Read the skeleton of an ASF."""
    try:
        lines = lines_of(path)
    except OSError as error:
        raise MotionFileError(f"{path}: cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise MotionFileError(f"{path}: not a text file in UTF-8") from None
    reader = _Reader(path)
    for number, line in enumerate(lines, 1):
        plain = line.partition("#")[0]
        for mark in "(),":
            plain = plain.replace(mark, " ")
        if words := plain.split():
            reader.take(number, words)
    return reader.finished(len(lines))


class _Reader:
    """What was read, the section and the bone that is being told."""

    def __init__(self, path: Path) -> None:
        self.found = Bones(path)
        self.section, self.bone = "", Bone(0)
        self.seen: set[str] = set()

    def take(self, number: int, words: list[str]) -> None:
        """One line."""
        word = words[0].lower()
        if word.startswith(":"):
            self.section = word
            self.seen.add(word)
            if word == ":root":
                self.bone = self.found.bones[ROOT_NAME] = Bone(number, ROOT_NAME)
        elif self.section == ":units":
            self._unit(number, word, words[1:])
        elif self.section == ":root":
            self._of_root(number, word, words[1:])
        elif self.section == ":bonedata":
            self._of_bone(number, word, words[1:])
        elif self.section == ":hierarchy" and word not in ("begin", "end"):
            self._hang(number, words)

    def error(self, number: int, what: str) -> MotionFileError:
        """A refusal that names the file and the line."""
        return refusal(self.found.path, number, what)

    def finished(self, last: int) -> Bones:
        """The whole skeleton."""
        missing = [section for section in SECTIONS if section not in self.seen]
        if missing:
            raise self.error(last, f"no section {missing[0]}")
        loose = sorted(set(self.found.bones) - set(self.found.names))
        if loose:
            line = self.found.bones[loose[0]].line
            raise self.error(line, f"bone {loose[0]!r} does not hang on the root")
        return self.found

    def _unit(self, number: int, word: str, words: Sequence[str]) -> None:
        if word == "angle":
            self.found.degrees = self._degrees(number, words)
        elif word == "length":
            (self.found.length,) = numbers(self.found.path, number, words, 1, "length")
            if self.found.length <= 0.0:
                raise self.error(number, f"length {self.found.length:g}: not positive")

    def _degrees(self, number: int, words: Sequence[str]) -> bool:
        unit = words[0].lower() if len(words) == 1 else ""
        if unit not in ("deg", "rad"):
            raise self.error(number, f"angle {' '.join(words)}: deg or rad is expected")
        return unit == "deg"

    def _of_root(self, number: int, word: str, words: Sequence[str]) -> None:
        path, bone = self.found.path, self.bone
        if word == "order":
            bone.dof = self._dof(number, words)
        elif word == "axis":
            bone.axis = bone.axis[0], self._order(number, words)
        elif word == "orientation":
            bone.axis = numbers(path, number, words, 3, word), bone.axis[1]
        elif word == "position":
            bone.place = numbers(path, number, words, 3, word)

    def _of_bone(self, number: int, word: str, words: Sequence[str]) -> None:
        path, bone = self.found.path, self.bone
        if word == "begin":
            self.bone = Bone(number)
        elif word == "end":
            self._keep(number)
        elif word == "name" and len(words) == 1:
            bone.name = words[0]
        elif word == "direction":
            bone.direction = numbers(path, number, words, 3, word)
        elif word == "length":
            (bone.length,) = numbers(path, number, words, 1, word)
        elif word == "axis":
            angles = numbers(path, number, words[:3], 3, word)
            bone.axis = angles, self._order(number, words[3:])
        elif word == "dof":
            bone.dof = self._dof(number, words)
            if bone.order.lower() != "".join(w[1:] for w in bone.dof):
                raise self.error(number, f"dof {' '.join(words)}: only turns are read of bones")

    def _keep(self, number: int) -> None:
        name = self.bone.name
        if not name or name in self.found.bones:
            raise self.error(number, f"a second bone {name!r}" if name else "a bone without a name")
        self.found.bones[name] = self.bone

    def _order(self, number: int, words: Sequence[str]) -> str:
        order = "".join(words).upper()
        if order not in euler.ORDERS:
            raise self.error(number, f"axis {order or 'without an order'}: as XYZ is expected")
        return order

    def _dof(self, number: int, words: Sequence[str]) -> tuple[str, ...]:
        dof = tuple(word.lower() for word in words)
        known = [f"{kind}{axis}" for kind in "tr" for axis in "xyz"]
        if not set(dof) <= set(known) or len(set(dof)) < len(dof):
            raise self.error(number, f"{' '.join(words)}: each of {' '.join(known)} once at most")
        return dof

    def _hang(self, number: int, words: Sequence[str]) -> None:
        for name in words:
            if name not in self.found.bones:
                raise self.error(number, f"no bone is called {name!r}")
        for name in words[1:]:
            if name in self.found.parents or name == ROOT_NAME:
                raise self.error(number, f"bone {name!r} hangs on two others")
            self.found.parents[name] = words[0]
