"""Files imported by path, with the import system's own safety under threads.

A file becomes a module that the import system finds, under a name made of the file's path.  So a
thread that asks for it while another imports it waits for the end and never takes a half-executed
module out of ``sys.modules``; and where waiting would be a deadlock, importlib notices.  A lock of ours
beside its locks could not: a user's module that calls this package as it is imported would hold one
and wait for the other.
"""

from __future__ import annotations

import hashlib
import os
import re
import sys
import traceback
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_file_location
from pathlib import Path
from types import ModuleType

from quatspline.system.forking import undivided

PARTIAL = "partially initialized module", "deadlock detected by"
"""What Python says of a failure that is due to an import under way."""


class _Files(MetaPathFinder):
    """Finds the modules that are named after files."""

    def __init__(self) -> None:
        self.paths: dict[str, Path] = {}

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """The module of a file that was asked for by `load`."""
        place = self.paths.get(fullname)
        return None if place is None else spec_from_file_location(fullname, place)


_files = _Files()
sys.meta_path.append(_files)


def load(path: Path, prefix: str) -> ModuleType:
    """Import a file by path, once; see `unfinished` for what is being imported further up."""
    place = hashlib.sha256(os.fsencode(os.path.realpath(path))).hexdigest()[:8]
    name = re.sub(r"\W", "_", f"quatspline_{prefix}_{path.stem}_{place}")
    _files.paths[name] = path
    with undivided():
        __import__(name)  # importlib.import_module raises where this notices a deadlock and goes on
    return sys.modules[name]


def unfinished(name: str) -> bool:
    """Whether a module is only half executed: imported further up, or by a thread that waits for us."""
    spec = getattr(sys.modules.get(name), "__spec__", None)
    return bool(getattr(spec, "_initializing", False))


def passing(error: BaseException) -> bool:
    """Whether an import failed for want of a module that is being imported: later it may succeed."""
    said = "".join(traceback.format_exception(error))
    return any(sign in said for sign in PARTIAL)
