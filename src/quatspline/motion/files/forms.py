"""Forms in which columns tell an orientation: a quaternion, a matrix, angles in a named order."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from quatspline.motion import euler
from quatspline.motion.files import checks
from quatspline.motion.files.checks import Faults, Rows
from quatspline.motion.files.names import words
from quatspline.quaternion import FloatArray

ORTHOGONAL = 1e-3
"""A matrix is the nearest rotation where its rows' products are off by less; KITTI's are by 1e-6."""

ANGLE = re.compile(r"(?:\w+_)?euler_([xyz]{2,3})_([xyz])(?:_(deg|rad)[a-z]*)?")
UNIT = re.compile(r"[\[(]\s*(deg|rad)", re.IGNORECASE)
LOOSE = frozenset({"roll", "pitch", "yaw"})
"""Names of angles that do not say in which order they turn."""


class Form(Protocol):
    """What the columns of an orientation are, in order, and how they become a quaternion."""

    @property
    def names(self) -> tuple[str, ...]:
        """The columns."""

    def check(self, faults: Faults, rows: Rows, table: FloatArray) -> None:
        """Faults of rows (m, columns) that stand in the given rows of the file."""

    def quaternions(self, table: FloatArray) -> FloatArray:
        """Quaternions (m, 4) of rows without faults."""


@dataclass(frozen=True)
class Quaternion:
    """Four components."""

    names = ("qw", "qx", "qy", "qz")

    def check(self, faults: Faults, rows: Rows, table: FloatArray) -> None:
        """See `Form`."""
        checks.check_norms(faults, rows, table)

    def quaternions(self, table: FloatArray) -> FloatArray:
        """See `Form`."""
        return table.copy()


@dataclass(frozen=True)
class Matrix:
    """A rotation matrix by rows: the nearest rotation."""

    names = tuple(f"r{i}{j}" for i in range(3) for j in range(3))

    def check(self, faults: Faults, rows: Rows, table: FloatArray) -> None:
        """See `Form`."""
        m = table.reshape(-1, 3, 3)
        with np.errstate(all="ignore"):
            off = np.abs(m @ np.swapaxes(m, 1, 2) - np.eye(3)).max(axis=(1, 2), initial=0.0)
            mirrored = np.linalg.det(m) < 0.0
        far = dict(zip(rows.tolist(), off.tolist(), strict=True))
        limit = f"no rotation (within {ORTHOGONAL:g})"
        faults.add(
            rows[~(off <= ORTHOGONAL)],
            lambda row: f"matrix is off orthogonality by {far[row]:.3g}, {limit}",
        )
        faults.add(rows[(off <= ORTHOGONAL) & mirrored], lambda row: "matrix mirrors")

    def quaternions(self, table: FloatArray) -> FloatArray:
        """See `Form`."""
        from scipy.spatial.transform import Rotation

        u, _, v = np.linalg.svd(table.reshape(-1, 3, 3))
        return np.asarray(Rotation.from_matrix(u @ v).as_quat(scalar_first=True))


@dataclass(frozen=True)
class Angles:
    """Euler angles about the axes of an order, the first first."""

    order: str
    degrees: bool

    @property
    def names(self) -> tuple[str, ...]:
        """See `Form`."""
        return tuple(f"euler_{self.order}_{axis}".lower() for axis in self.order)

    def check(self, faults: Faults, rows: Rows, table: FloatArray) -> None:
        """Any angles do."""

    def quaternions(self, table: FloatArray) -> FloatArray:
        """See `Form`."""
        return euler.from_angles(np.radians(table) if self.degrees else table, self.order)


QUATERNION, MATRIX = Quaternion(), Matrix()


def other_form(names: Sequence[str]) -> tuple[Form, tuple[int, ...]] | None:
    """A matrix or angles among names of columns, and where they stand; None where there are none.

    Raises
    ------
    ValueError
        Angles that do not say their order or unit, or are not all there.
    """
    told = ["".join(words(name)) for name in names]
    if set(MATRIX.names) <= set(told):
        return MATRIX, tuple(told.index(name) for name in MATRIX.names)
    angles = _angles(names)
    loose = [name for name, word in zip(names, told, strict=True) if word in LOOSE]
    if not angles and loose:
        raise ValueError(
            f"{', '.join(map(repr, loose))}: not said in which order they turn; name them as "
            "'euler_zyx_z [deg]': about z, then y, then x as turned"
        )
    return _angles_form(angles) if angles else None


def _angles(names: Sequence[str]) -> dict[tuple[str, str, str], int]:
    """Columns of angles by order, axis and unit."""
    found = {}
    for i, name in enumerate(names):
        match, unit = ANGLE.fullmatch("_".join(words(name))), UNIT.search(name)
        if match:
            told = match[3] or (unit[1].lower() if unit else "")
            found[match[1].upper(), match[2].upper(), told] = i
    return found


def _angles_form(angles: dict[tuple[str, str, str], int]) -> tuple[Form, tuple[int, ...]]:
    kinds = {(order, unit) for order, _, unit in angles}
    order, unit = next(iter(kinds))
    if len(kinds) > 1 or len(set(order)) < len(order):
        raise ValueError("angles of more than one order or unit, or an order that repeats an axis")
    if not unit:
        raise ValueError(f"euler_{order.lower()}: name the unit, as 'euler_zyx_z [deg]'")
    missing = [axis for axis in order if (order, axis, unit) not in angles]
    if missing or len(angles) > len(order):
        raise ValueError(f"euler_{order.lower()}: one column of each axis is expected")
    columns = tuple(angles[order, axis, unit] for axis in order)
    return Angles(order, unit == "deg"), columns
