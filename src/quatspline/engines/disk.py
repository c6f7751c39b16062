"""Machine code between processes: files that are believed only where their hash says that they are whole.

A file holds the SHA-256 of what follows and numba's pickle of the code; what is damaged, or cannot be
read or written, counts as absent, and the code is compiled again.
"""

from __future__ import annotations

import hashlib
import pickle
import warnings
from collections.abc import Callable
from functools import cache
from multiprocessing import parent_process
from pathlib import Path
from typing import Any

from numba.core import caching

from quatspline.system.atomic import replacing

DIGEST = hashlib.sha256().digest_size


class _Files(caching.IndexDataCacheFile):
    """The index of a function's code and the code itself, each in a file that is hashed."""

    def _load_index(self) -> dict[Any, str]:
        found = _whole(Path(self._index_path))
        stamp, overloads = (None, {}) if found is None else pickle.loads(found)
        return overloads if stamp == self._source_stamp else {}

    def _save_index(self, overloads: dict[Any, str]) -> None:
        _save(Path(self._index_path), self._dump((self._source_stamp, overloads)))

    def _load_data(self, name: str) -> Any:
        found = _whole(Path(self._data_path(name)))
        return None if found is None else pickle.loads(found)

    def _save_data(self, name: str, data: Any) -> None:
        _save(Path(self._data_path(name)), self._dump(data))


def _whole(path: Path) -> bytes | None:
    """What a file holds behind its hash; None where it does not match, or nothing can be read."""
    try:
        raw = path.read_bytes()
    except OSError:
        return None
    digest, content = raw[:DIGEST], raw[DIGEST:]
    return content if hashlib.sha256(content).digest() == digest else None


def _save(path: Path, content: bytes) -> None:
    """Write a file, whole or not at all; where the disk refuses, this process keeps what it compiled."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with replacing(path) as aside:
            aside.write_bytes(hashlib.sha256(content).digest() + content)
    except OSError as error:
        tell(path.parents[1], error.strerror or str(error))


@cache
def tell(base: Path, reason: str) -> None:
    """Warn once in this process that a folder cannot be written, and why."""
    if parent_process() is None:  # which of many workers tells does not matter to the user
        told = f"compiled kernels are not kept for the next process: {base} cannot be written: {reason}"
        warnings.warn(told, RuntimeWarning, stacklevel=2)


class _Folder:
    """Where code from a file is, and which sources it is of: numba's locator."""

    def __init__(self, path: Path, line: int) -> None:
        self.path, self.line = path, line

    def get_cache_path(self) -> str:
        return str(self.path)

    def ensure_cache_path(self) -> None:
        """Made when something is saved."""

    def get_source_stamp(self) -> str:
        return self.path.name

    def get_disambiguator(self) -> str:
        return str(self.line)


def keep(made: Any, function: Callable[..., Any], folder: Path) -> None:
    """Have numba keep the code that it made of a function in a folder that is named after the sources."""

    class Implementation(caching.CompileResultCacheImpl):
        def __init__(self, function: Callable[..., Any]) -> None:
            code = function.__code__
            self._lineno = code.co_firstlineno
            self._locator = _Folder(folder, self._lineno)
            # Code names its module, which a file loaded by path has after its place.
            name = f"{function.__module__}.{function.__qualname__}"
            self._filename_base = self.get_filename_base(name, "")

    class Cache(caching.FunctionCache):
        _impl_class = Implementation

        def _load_overload(self, *wanted: Any) -> Any:
            try:
                return super()._load_overload(*wanted)
            except Exception:  # whole, and yet of names that this process has not: compiled again
                return None

    made._cache = Cache(function)
    made._cache._cache_file = _Files(str(folder), made._cache._impl.filename_base, folder.name)
