"""A folder with one writer at a time, which never replaces a file that is not its own.

Its own are the files that its manifest lists, by name and SHA-256.  A file enters the manifest before
it gets its name: so a run that was killed at any moment leaves none that the next takes for foreign.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from typing import Any

from quatspline.runs.manifest import MANIFEST, SCHEMA, listed, read_manifest, sha256, write_json
from quatspline.runs.provenance import now, provenance
from quatspline.system.atomic import ASIDE, clear_asides, replacing, same_file
from quatspline.system.locking import sole_writer

JOURNAL = ".journal.json"


class Store:
    """A folder of files that are written aside and renamed: none is ever half there.

    Attributes
    ----------
    folder : the directory, made if need be (a ValueError tells why it cannot)
    force : whether files that are not its own may be replaced
    manifest : what `manifest.json` holds, {} where there is none of ours
    """

    def __init__(self, folder: str | Path, *, force: bool = False) -> None:
        self.folder, self.force = Path(folder), force
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ValueError(f"{folder}: no such folder can be made: {error.strerror}") from None
        self._held = False
        self._written: set[str] = set()
        self._load()

    def _load(self) -> None:
        self.manifest: dict[str, Any] = read_manifest(self.folder)
        self._own = listed(self.manifest)
        for name in self.manifest.pop("claims", {}):  # of a writer that was killed
            if self.owns(name):
                self.manifest.setdefault("files", {})[name] = sha256(self.folder / name)

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Be the only writer of the folder.

        Raises ValueError where another process is, and where the folder cannot be written.
        """
        if self._held:
            yield
            return
        with sole_writer(self.folder):
            self._held = True
            self._load()  # as the writer before left it
            if self.manifest:  # what looks like ours in somebody else's folder is not
                clear_asides(self.folder)
            try:
                yield
            finally:
                self._held = False

    # -- whose files ----------------------------------------------------------------------------

    def guard(self, names: Iterable[str] = (), inputs: Iterable[str | Path] = ()) -> None:
        """Refuse to write files of these names where that would cost somebody theirs.

        Raises ValueError for a name that is one of the inputs or a folder, and for files that are
        not this folder's own, unless they may be replaced.
        """
        paths = [self.folder / name for name in (MANIFEST, *names)]
        for given in inputs:
            if any(same_file(given, path) for path in paths):
                raise ValueError(
                    f"{given}: is also read here, so it is not overwritten: name another --out"
                )
        for path in paths:
            if path.exists() and not path.is_file():  # nor a link to one
                raise ValueError(f"{path}: not a regular file, so it cannot be written")
        foreign = [path for path in paths if not self.force and self._foreign(path.name)]
        if foreign:
            more = f" and {len(foreign) - 1} more" if len(foreign) > 1 else ""
            raise ValueError(
                f"{foreign[0]}{more}: not written by quatspline in this folder, or edited since: "
                "name another folder, or replace with --force"
            )

    def owns(self, name: str) -> bool:
        """Whether a file is there and as this folder's writers left it."""
        path = self.folder / name
        return path.is_file() and sha256(path) in self._own.get(name, ())

    def _foreign(self, name: str) -> bool:
        path = self.folder / name
        if not os.path.lexists(path):  # a link that leads nowhere is somebody's, too
            return False
        if name == MANIFEST:
            return not read_manifest(self.folder)
        if name == JOURNAL:  # written too often to be listed; a run began by writing a manifest
            return not self.manifest or path.is_symlink()
        return not self.owns(name)

    # -- writing --------------------------------------------------------------------------------

    @contextmanager
    def placing(self, name: str) -> Iterator[Path]:
        """A path to write a file of the folder to, which gets its name when the block ends well.

        A link of that name is replaced: nothing is written outside the folder.
        """
        path = self.folder / name
        with replacing(path, ASIDE, follow=False) as aside:
            yield aside
            if not self.force and self._foreign(name):
                raise ValueError(_left(path, aside))
            digest = sha256(aside)
            self._claim(name, digest)
        self._written.add(name)
        if self.manifest:
            self.manifest.setdefault("files", {})[name] = digest

    def _claim(self, name: str, digest: str) -> None:
        """List a file that is about to be there, beside the one that it replaces."""
        self._own.setdefault(name, set()).add(digest)
        if self.manifest:
            self._save({name: digest})

    def text(self, name: str, content: str) -> Path:
        """Write a text file."""
        with self.placing(name) as aside:
            aside.write_text(content, encoding="utf-8", newline="\n")
        return self.folder / name

    def intact(self, files: Mapping[str, str]) -> bool:
        """Whether files are all there with the given SHA-256."""
        paths = {self.folder / name: digest for name, digest in files.items()}
        return all(path.is_file() and sha256(path) == digest for path, digest in paths.items())

    # -- manifest -------------------------------------------------------------------------------

    def begin(self, command: Sequence[str], *, seed: int | None = None, **more: Any) -> None:
        """Open the manifest of a run.  Entries of earlier runs stay while their files do."""
        self.guard()
        earlier = self.manifest.get("experiments", {}).items()
        kept = {name: entry for name, entry in earlier if self.intact(entry.get("files", {}))}
        files = {name: sha256(self.folder / name) for name in self._own if self.owns(name)}
        self.manifest = {"schema": SCHEMA, "command": list(command), "start": now(), "end": None}
        self.manifest |= provenance() | {"seeds": {"seed": seed}} | more
        self.manifest |= {"experiments": kept, "files": files}
        self.refresh()

    def finish(self) -> None:
        """Close the manifest of a run."""
        self.manifest["end"] = now()
        self.refresh()

    def refresh(self) -> None:
        """Write the manifest with every file of its own that is in the folder."""
        self.manifest = {"schema": SCHEMA} | self.manifest
        self._save({})

    def _save(self, claims: Mapping[str, str]) -> None:
        """Write the manifest; claims are files that are about to be there."""
        entries = dict(sorted(self.manifest.get("experiments", {}).items()))
        sizes = {name: entry["size"] for name, entry in entries.items() if "size" in entry}
        files = dict(sorted(self.manifest.get("files", {}).items()))
        there = {name: sha for name, sha in files.items() if (self.folder / name).is_file()}
        self.manifest |= {"sizes": sizes, "experiments": entries, "files": there}
        write_json(self.folder / MANIFEST, self.manifest | ({"claims": claims} if claims else {}))


def _left(path: Path, aside: Path) -> str:
    """Leave a file that came while this ran, and what was to replace it beside it; say so."""
    for number in count(1):
        spare = path.with_name(f"{path.name}.{number}")
        with suppress(FileExistsError):
            spare.touch(exist_ok=False)
            os.replace(aside, spare)
            break
    return f"{path}: came or was edited while this ran: left as it is; {spare.name} holds what was to replace it"
