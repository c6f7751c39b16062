"""Motion files: every frame checked on reading, written whole or not at all.

`lines` splits text into fields, `names`, `columns` and `headers` know columns by their names, `comments`
finds names in comments, `forms` knows forms of orientations, `text` gathers rows, `npz` unpacks arrays,
`spelled` keeps times exact, `checks` refuses rows, `writing` is the way back.  `bvh` and `bvh_writing`,
`asf` and `amc`, `gltf`, `buffers` and `glb` are the formats of skeletons.  `reading` has the options.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from quatspline.motion.errors import MotionFileError, warn
from quatspline.motion.files.amc import read_amc
from quatspline.motion.files.bvh import read_bvh
from quatspline.motion.files.bvh_writing import write_bvh
from quatspline.motion.files.columns import CSV_COLUMNS, EUROC_COLUMNS, KITTI_COLUMNS, TUM_COLUMNS
from quatspline.motion.files.glb import write_glb
from quatspline.motion.files.gltf import read_gltf
from quatspline.motion.files.npz import read_npz
from quatspline.motion.files.opening import check_regular
from quatspline.motion.files.reading import Reading
from quatspline.motion.files.text import read_text
from quatspline.motion.files.writing import write_csv, write_euroc, write_npz, write_tum
from quatspline.motion.motion import Motion
from quatspline.options import nearest
from quatspline.system.atomic import replacing

__all__ = [
    "Motion",
    "MotionFileError",
    "Reading",
    "check_suffix",
    "lenient",
    "read",
    "write",
    "write_csv",
]


@dataclass(frozen=True)
class Format:
    """How files of a suffix are read and written, and which options of `read_motion` say something of them."""

    read: Callable[[Path, Reading], Motion]
    write: Callable[[Path, Motion], None] | None = None
    takes: tuple[str, ...] = ()
    bones: bool = False
    """Whether it holds skeletons."""
    tangents: bool = False
    """Whether it holds the tangents of a glTF's cubic splines."""


_ROWS = ("duplicates", "missing")
_CLIP = ("rate", "times")
_CSV = Format(partial(read_text, columns=CSV_COLUMNS, unit="file"), write_csv, (*_ROWS, *_CLIP))
_TUM = Format(partial(read_text, columns=TUM_COLUMNS, unit="m"), write_tum, (*_ROWS, *_CLIP))
_GLTF = ("animation",)
_FORMATS = {
    ".csv": _CSV,
    ".euroc.csv": Format(partial(read_text, columns=EUROC_COLUMNS, unit="m"), write_euroc, _ROWS),
    ".tum": _TUM,
    ".txt": _TUM,
    ".kitti": Format(
        partial(read_text, columns=KITTI_COLUMNS, unit="m"), None, (*_CLIP, "missing")
    ),
    ".npz": Format(read_npz, write_npz, _ROWS, bones=True, tangents=True),
    ".bvh": Format(read_bvh, write_bvh, _CLIP, bones=True),
    ".amc": Format(read_amc, None, (*_CLIP, "skeleton", "units")),
    ".gltf": Format(read_gltf, None, _GLTF),
    ".glb": Format(read_gltf, write_glb, _GLTF, bones=True),
}


def read(path: str | Path, reading: Reading | None = None) -> Motion:
    """Read a motion with the signs of its quaternions as the file has them (see `read_motion`)."""
    reading = Reading() if reading is None else reading
    found = _format(path)
    path = Path(path)
    reading.check_use(path, found.takes)
    try:
        check_regular(path)
        motion = found.read(path, reading)
    except OSError as error:
        raise MotionFileError(f"{path}: cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise MotionFileError(f"{path}: not a text file in UTF-8") from None
    if reading.skip >= len(motion.quaternions):
        skipped = reading.named("skip", reading.skip)
        what = f"{skipped} leaves none of its {len(motion.quaternions)} frames"
        raise MotionFileError(f"{path}: {what}")
    motion = replace(motion, max_gap=reading.max_gap)
    return motion.frames(slice(reading.skip, None)) if reading.skip else motion


def write(path: str | Path, motion: Motion) -> None:
    """Write a motion in the format of the suffix (see `write_motion`), whole or not at all."""
    writer = _writer(path)
    if motion.skeleton is not None and not _format(path).bones:
        warn(path, "the skeleton is not carried: .bvh, .glb and .npz hold it")
    if motion.in_tangents is not None and not _format(path).tangents:
        warn(path, "tangents of its splines are not carried: .npz holds them")
    path = Path(path)
    try:
        with replacing(path) as aside:
            writer(aside, motion)
    except MotionFileError:
        raise
    except OSError as error:
        raise MotionFileError(f"{path}: cannot be written: {error.strerror or error}") from None
    except ValueError as error:
        raise MotionFileError(f"{path}: {error}") from None


def lenient(path: str | Path, reading: Reading) -> Reading:
    """The same options, but that repeated stamps and rows without numbers are left out."""
    takes = _format(path).takes
    return replace(
        reading,
        duplicates="first" if "duplicates" in takes else "refuse",
        missing="skip" if "missing" in takes else "refuse",
    )


def check_suffix(path: str | Path) -> None:
    """Refuse a name whose suffix no format has that is written, before any work is done."""
    _writer(path)


def _writer(path: str | Path) -> Callable[[Path, Motion], None]:
    found = _format(path)
    if found.write is None:
        written = sorted(suffix for suffix, kind in _FORMATS.items() if kind.write is not None)
        raise MotionFileError(f"{path}: is read and not written; written are {', '.join(written)}")
    return found.write


def _format(path: str | Path) -> Format:
    given = str(path)
    if not given.strip():
        raise MotionFileError(f"{given!r}: a blank name is no file's")
    suffixes = [suffix.lower() for suffix in Path(path).suffixes]
    double = "".join(suffixes[-2:])
    if double in _FORMATS:
        return _FORMATS[double]
    suffix = suffixes[-1] if suffixes else ""
    if suffix == ".asf":
        raise MotionFileError(f"{given}: a skeleton without motion: name the .amc that moves it")
    if suffix not in _FORMATS:
        raise MotionFileError(f"{given}: unknown suffix {suffix!r}: {nearest(suffix, _FORMATS)}")
    return _FORMATS[suffix]
