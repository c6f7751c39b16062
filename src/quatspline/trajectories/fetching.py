"""Fetches the recorded clips of `recorded.toml` from their sources into a folder, whole files or none.

What is fetched is known by its words and numbers, not by its bytes: mirrors differ in line endings, and
comments name the folders of whoever recorded.
"""

from __future__ import annotations

import hashlib
import importlib.util
import struct
import tomllib
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from urllib.parse import urlsplit

from quatspline.system.atomic import replacing

TABLE = Path(__file__).with_name("recorded.toml")

PATIENCE = 30.0
"""Seconds without a byte after which a server counts as silent."""


@dataclass(frozen=True)
class Remote:
    """A file to fetch: its name in the folder, its address, and the digest of its words and numbers."""

    name: str
    address: str
    numbers: str


@dataclass(frozen=True)
class Source:
    """Whose files they are, and on which terms."""

    name: str
    terms: str
    acknowledgement: str
    files: tuple[Remote, ...]


@dataclass
class Fetched:
    """What became of the files, by name; of a failure a sentence."""

    new: list[str] = field(default_factory=list)
    kept: list[str] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)


class _Silent(Exception):
    """A server that does not answer."""


@cache
def sources() -> tuple[Source, ...]:
    """The sources of the clips that this project measures on."""
    table = tomllib.loads(TABLE.read_text(encoding="utf-8"))
    return tuple(
        Source(
            one["name"],
            one["terms"],
            one["acknowledgement"],
            tuple(Remote(**file) for file in one["file"]),
        )
        for one in table["source"]
    )


def digest(content: bytes) -> str:
    r"""SHA-256 of a text file's words and numbers; blanks, line endings and comments do not count.

    Examples
    --------
    >>> from quatspline.trajectories.fetching import digest
    >>> digest(b"root .50 1e1\r\n") == digest(b"# from here\nroot\t0.5 10\n")
    True
    """
    found = hashlib.sha256()
    for line in content.decode("latin-1").splitlines():
        for word in line.partition("#")[0].split():
            found.update(_as_bytes(word))
    return found.hexdigest()


def _as_bytes(word: str) -> bytes:
    try:
        return b"number" + struct.pack("<d", float(word))
    except ValueError:
        return b"word" + word.encode() + b"\0"


def fetch(
    folder: Path,
    *,
    mirror: str | None = None,
    force: bool = False,
    progress: Callable[[list[Remote]], Iterable[Remote]] = iter,
) -> Fetched:
    """Fetch the files that a folder lacks; the next call goes on where one was interrupted.

    Parameters
    ----------
    folder : made where it is not there
    mirror : the address of a folder that has all files by name, instead of their sources
    force : replace files of these names that hold something else
    progress : goes over the files, and may say so

    Raises
    ------
    ValueError
        Without the extra "motions", for a folder that cannot be made, or an address of another kind.
    """
    _check(folder, mirror)
    found, silent = Fetched(), dict[str, list[str]]()
    for remote in progress([file for source in sources() for file in source.files]):
        address = remote.address if mirror is None else f"{mirror.rstrip('/')}/{remote.name}"
        if not _settled(folder / remote.name, remote, force, found):
            _try(folder / remote.name, address, remote, found, silent)
    found.failures += [
        f"{host} does not answer: {', '.join(lost)}" for host, lost in silent.items()
    ]
    return found


def _check(folder: Path, mirror: str | None) -> None:
    if importlib.util.find_spec("pooch") is None:
        raise ValueError("motions needs the extra: pip install 'quatspline[motions]'")
    if mirror is not None and urlsplit(mirror).scheme not in ("http", "https"):
        raise ValueError(
            f"--from {mirror}: expected an address that begins with http:// or https://"
        )
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ValueError(f"{folder}: cannot be made: {error.strerror}") from None


def _settled(path: Path, remote: Remote, force: bool, found: Fetched) -> bool:
    """Whether a file is not to be fetched: it is there, or what is there is to stay."""
    if not path.exists():
        return False
    if path.is_file() and digest(path.read_bytes()) == remote.numbers:
        found.kept.append(remote.name)
        return True
    if force and path.is_file():
        return False
    found.failures.append(f"{path}: something else is there: --force replaces files")
    return True


def _try(
    path: Path, address: str, remote: Remote, found: Fetched, silent: dict[str, list[str]]
) -> None:
    """Fetch a file, unless its server was silent before: each would be waited for anew."""
    host = urlsplit(address).netloc
    if host in silent:
        silent[host].append(remote.name)
        return
    try:
        download(path, address, remote)
        found.new.append(remote.name)
    except _Silent:
        silent[host] = [remote.name]
    except ValueError as failure:
        found.failures.append(f"{remote.name}: {failure}")


def download(path: Path, address: str, remote: Remote) -> None:
    """Fetch a file.

    Raises
    ------
    ValueError
        Where the server refuses, sends half, or sends something else; `_Silent` where none answers.
    """
    import pooch
    import requests

    try:
        with replacing(path) as aside:
            pooch.HTTPDownloader(timeout=PATIENCE)(address, str(aside), None)
            if digest(aside.read_bytes()) != remote.numbers:
                raise ValueError(f"{address} does not hold the numbers of the clip measured here")
    except requests.HTTPError as error:
        raise ValueError(str(error)) from None
    except (requests.ConnectionError, requests.Timeout):
        raise _Silent from None
    except requests.RequestException as error:
        raise ValueError(f"{address}: not fetched whole: {type(error).__name__}") from None
