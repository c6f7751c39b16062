"""Keyframe files: CSV, TUM and NPZ; every row checked on reading, written whole or not at all.

`lines` splits text into fields, `names`, `columns` and `headers` know columns by their names, `comments`
finds names in comments, `text` gathers rows, `npz` unpacks arrays, `spelled` keeps times exact, `checks`
refuses rows, `writing` is the way back, and `motion` is what they exchange.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from quatspline.motion.files.columns import CSV_COLUMNS, TUM_COLUMNS
from quatspline.motion.files.motion import KeyframeFileError, Motion
from quatspline.motion.files.npz import read_npz
from quatspline.motion.files.text import read_text
from quatspline.motion.files.writing import write_csv, write_npz, write_tum
from quatspline.options import nearest
from quatspline.system.atomic import replacing

__all__ = [
    "KeyframeFileError",
    "Motion",
    "check_suffix",
    "read",
    "write",
    "write_csv",
]

Reader = Callable[[Path], Motion]
Writer = Callable[[Path, Motion], None]

_TUM = partial(read_text, columns=TUM_COLUMNS), write_tum
_FORMATS: dict[str, tuple[Reader, Writer]] = {
    ".csv": (partial(read_text, columns=CSV_COLUMNS), write_csv),
    ".tum": _TUM,
    ".txt": _TUM,
    ".npz": (read_npz, write_npz),
}


def read(path: str | Path) -> Motion:
    """Read keyframes: .csv, .tum or .txt (TUM), .npz.

    Text names its columns in a header, commented out with # or not, in any order, among others:
    ``t``, ``time``, ``timestamp [ns]``; ``qw``, ``w``, ``q_RS_w []``, ``orientation.w``; ``tx``, ``x``,
    ``position.x``.  Without a header, CSV holds ``t,qw,qx,qy,qz`` and TUM ``t tx ty tz qx qy qz qw``.
    Fields are separated by commas, semicolons, tabs or blanks; all but the first go with decimal
    commas, too.  Other lines that begin with #, % or // are comments; one that has quaternions in another
    order than the columns is refused.  NPZ holds ``times``, ``quaternions`` and
    perhaps ``positions``.  Times that are whole and beyond 2**53 stay integers; units stay the file's.

    Raises
    ------
    KeyframeFileError
        A `ValueError` of one sentence that names the file and the first line (NPZ: row) at fault.
    """
    reader, _ = _format(path)
    path = Path(path)
    try:
        return reader(path)
    except OSError as error:
        raise KeyframeFileError(f"{path}: cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise KeyframeFileError(f"{path}: not a text file in UTF-8") from None


def write(path: str | Path, motion: Motion) -> None:
    """Write a motion in the format of the suffix, at full precision, whole or not at all.

    Positions are carried by every format; TUM has zeros where there are none.  Raises
    KeyframeFileError for an unknown suffix and for a file that cannot be written.
    """
    _, writer = _format(path)
    path = Path(path)
    try:
        with replacing(path) as aside:
            writer(aside, motion)
    except OSError as error:
        raise KeyframeFileError(f"{path}: cannot be written: {error.strerror or error}") from None


def check_suffix(path: str | Path) -> None:
    """Refuse a name whose suffix no format has, before any work is done."""
    _format(path)


def _format(path: str | Path) -> tuple[Reader, Writer]:
    given = str(path)
    if not given.strip():
        raise KeyframeFileError(f"{given!r}: a blank name is no file's")
    suffix = Path(path).suffix.lower()
    if suffix not in _FORMATS:
        raise KeyframeFileError(f"{given}: unknown suffix {suffix!r}: {nearest(suffix, _FORMATS)}")
    return _FORMATS[suffix]
