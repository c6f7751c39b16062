"""Files written whole or not at all: aside first, then renamed over what they replace."""

from __future__ import annotations

import os
import re
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PART = ".part"
ASIDE = ".quatspline.part"
"""How names of files aside end in a folder with one writer: what a killed one left is known by it."""

OURS = re.compile(rf"\..+\.[0-9a-f]{{16}}{re.escape(ASIDE)}", re.DOTALL)
"""Names of files aside, of which anybody else's that only end alike are none."""

SHOWN = 32
"""Characters of the target's name that a file aside bears: a long name has room for no more."""


@contextmanager
def replacing(path: Path, end: str = PART, *, follow: bool = True) -> Iterator[Path]:
    """A path to write to, renamed onto ``path`` when the block ends well and removed otherwise.

    The file aside is new, in the target's folder, under a name that nobody else has.  It takes the
    mode of the file that it replaces, a new one what the umask leaves.  ``end`` is how its name ends;
    without ``follow`` a link is replaced and not what it leads to.  An OSError names the path.
    """
    with naming(path):
        yield from _replacing(Path(os.path.realpath(path)) if follow else path, end)


@contextmanager
def naming(where: str | Path) -> Iterator[None]:
    """An OSError of what is written here names the place: that of a full disk has none."""
    try:
        yield
    except OSError as error:
        if error.filename is None and error.errno is not None:
            error.filename = str(where)
        raise


def _replacing(target: Path, end: str) -> Iterator[Path]:
    if target.exists() and not target.is_file():
        yield target  # a device or a pipe: renaming would replace it
        return
    mode = target.stat().st_mode & 0o777 if target.exists() else None
    aside = target.with_name(f".{target.name[:SHOWN]}.{secrets.token_hex(8)}{end}")
    # Never wider than the target while it is written, but open to its writer.
    aside.touch(mode=0o666 if mode is None else mode | 0o200, exist_ok=False)
    try:
        yield aside
        _settle(aside, mode)
        os.replace(aside, target)
    finally:
        aside.unlink(missing_ok=True)


def _settle(aside: Path, mode: int | None) -> None:
    """Have a finished file on the disk, with its final mode, before its name changes."""
    with aside.open("rb+") as stream:
        os.fsync(stream.fileno())
    if mode is not None:
        aside.chmod(mode)


def clear_asides(folder: Path) -> None:
    """Remove what killed writers left in a folder of ours whose only writer this process is."""
    for aside in folder.glob(f".*{ASIDE}"):
        if OURS.fullmatch(aside.name) and aside.is_file() and not aside.is_symlink():
            aside.unlink(missing_ok=True)


def check_plain(path: Path) -> None:
    """Refuse what is there and no plain file: reading a pipe or a device may never end.

    Raises
    ------
    ValueError
        For what is none.
    OSError
        Where nothing is there, or may be looked at.
    """
    if not stat.S_ISREG(path.stat().st_mode):
        raise ValueError("no plain file")


def same_file(one: str | Path, other: str | Path) -> bool:
    """Whether two paths lead to one file, through links of either kind or not."""
    try:
        return os.path.samefile(one, other)
    except OSError:
        return False
