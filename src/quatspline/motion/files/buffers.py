"""A glTF's JSON and buffers: whatever points somewhere is checked before it is followed."""

from __future__ import annotations

import base64
import binascii
import json
import struct
from functools import cached_property
from pathlib import Path
from typing import Any, NoReturn
from urllib.parse import unquote, urlsplit

import numpy as np
from numpy.typing import NDArray

from quatspline.motion.errors import MotionFileError
from quatspline.motion.files.opening import check_regular
from quatspline.quaternion import FloatArray

MAGIC, JSON, BINARY = b"glTF", 0x4E4F534A, 0x004E4942

KINDS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
"""Numbers by their glTF code."""

WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
INDICES = (5121, 5123, 5125)

LARGEST = 10**7
"""More elements than this in an accessor (a day at 120 Hz) are no keyframes."""


class Document:
    """The JSON of a file, whose parts are looked up by index, and its buffers."""

    def __init__(self, path: Path) -> None:
        self.path = path
        raw = path.read_bytes()
        text, self._binary = self._chunks(raw) if raw[:4] == MAGIC else (raw, None)
        try:
            self.json = json.loads(text.decode("utf-8-sig"), parse_constant=self._constant)
        except (ValueError, RecursionError) as error:
            self.refuse(f"not JSON: {str(error)[:80]}")
        if not isinstance(self.json, dict):
            self.refuse("its JSON is no object")

    def refuse(self, what: str) -> NoReturn:
        """Raise the MotionFileError of one sentence."""
        raise MotionFileError(f"{self.path}: {what}")

    def _constant(self, name: str) -> NoReturn:
        raise ValueError(f"{name} is no number of JSON")

    # -- parts ------------------------------------------------------------------------------------

    def items(self, kind: str, of: dict[str, Any] | None = None) -> list[Any]:
        """All parts of a kind, such as nodes: objects in a list."""
        found = (self.json if of is None else of).get(kind, [])
        if not isinstance(found, list) or not all(isinstance(item, dict) for item in found):
            self.refuse(f"{kind} is no list of objects")
        return found

    def item(self, kind: str, index: Any, of: dict[str, Any] | None = None) -> dict[str, Any]:
        """A part by its index."""
        found = self.items(kind, of)
        if not _is_whole(index) or index >= len(found):
            self.refuse(f"{kind}[{index!r}] does not exist: there are {len(found)}")
        part: dict[str, Any] = found[index]
        return part

    def whole(self, of: dict[str, Any], name: str, default: int | None = None) -> int:
        """A whole number, at least 0."""
        value: Any = of.get(name, default)
        if not _is_whole(value):
            self.refuse(f"{name} = {str(value)[:40]}: a whole number, at least 0, is expected")
        return int(value)

    def vector(self, of: dict[str, Any], name: str, default: tuple[float, ...]) -> FloatArray:
        """So many finite numbers as the default has."""
        value = of.get(name, default)
        try:
            vector = np.array(value, dtype=float)
        except (TypeError, ValueError, OverflowError):
            vector = np.empty(0)
        if vector.shape != (len(default),) or not np.isfinite(vector).all():
            self.refuse(f"{name} = {str(value)[:40]}: {len(default)} numbers are expected")
        return vector

    # -- buffers ----------------------------------------------------------------------------------

    def _chunks(self, raw: bytes) -> tuple[bytes, bytes | None]:
        """The JSON and the binary buffer of a GLB."""
        if len(raw) < 20:
            self.refuse("the file ends within its header")
        version, length = struct.unpack_from("<II", raw, 4)
        if version != 2:
            self.refuse(f"version {version} of GLB: 2 is read")
        if length > len(raw):
            self.refuse(f"the file has {len(raw)} of {length} bytes")
        found: dict[int, bytes] = {}
        at = 12
        while at + 8 <= length:
            size, kind = struct.unpack_from("<II", raw, at)
            if at + 8 + size > length:
                self.refuse("a chunk goes beyond the end of the file")
            found.setdefault(kind, raw[at + 8 : at + 8 + size])
            at += 8 + size
        if JSON not in found:
            self.refuse("no chunk of JSON in it")
        return found[JSON], found.get(BINARY)

    @cached_property
    def _buffers(self) -> dict[int, bytes]:
        return {}

    def _buffer(self, index: int) -> bytes:
        if index not in self._buffers:
            buffer = self.item("buffers", index)
            uri, length = buffer.get("uri"), self.whole(buffer, "byteLength")
            found = self._fetched(uri) if uri is not None or index else self._binary
            if found is None or len(found) < length:
                self.refuse(f"buffers[{index}] has {len(found or b'')} of {length} bytes")
            self._buffers[index] = found[:length]
        return self._buffers[index]

    def _fetched(self, uri: Any) -> bytes | None:
        """The bytes that a URI holds or names: files in the folder of this one alone."""
        if not isinstance(uri, str):
            return None
        if uri.startswith("data:"):
            head, _, data = uri.partition(",")
            try:
                return base64.b64decode(data, validate=True) if head.endswith(";base64") else None
            except (binascii.Error, ValueError):
                self.refuse("a buffer is not base64")
        name = unquote(uri)
        if (
            urlsplit(uri).scheme
            or Path(name).is_absolute()
            or ".." in Path(name).parts
            or "\0" in name
        ):
            self.refuse(f"buffer {uri[:60]!r}: only files in its folder are read")
        try:
            check_regular(self.path.parent / name)
            return (self.path.parent / name).read_bytes()
        except OSError as error:
            self.refuse(f"buffer {name[:60]!r} cannot be read: {error.strerror or error}")

    # -- accessors --------------------------------------------------------------------------------

    def accessor(self, index: Any, kind: str, what: str) -> FloatArray:
        """The numbers (n, width) of an accessor of a type, normalised integers as fractions."""
        accessor = self.item("accessors", index)
        count, code = self.whole(accessor, "count"), accessor.get("componentType")
        if accessor.get("type") != kind or code not in KINDS:
            told = f"{accessor.get('type')} of {code}"
            self.refuse(f"{what}: {kind} expected, found {str(told)[:40]}")
        if count > LARGEST:
            self.refuse(f"{what} declares {count} elements: more than {LARGEST:,} are not read")
        dtype, width = np.dtype(KINDS[code]), WIDTHS[kind]
        if dtype.kind != "f" and not accessor.get("normalized"):
            self.refuse(f"{what}: whole numbers that are not normalised")
        values = self._sparse(accessor, self._dense(accessor, count, dtype, width), dtype, width)
        if dtype.kind == "f":
            return values.astype(float)
        return np.maximum(values.astype(float) / np.iinfo(dtype).max, -1.0)

    def _dense(
        self, accessor: dict[str, Any], count: int, dtype: np.dtype[Any], width: int
    ) -> NDArray[Any]:
        if "bufferView" not in accessor:
            if "sparse" not in accessor:
                self.refuse("an accessor without data")
            return np.zeros((count, width), dtype)
        return self._view(accessor, count, dtype, width)

    def _view(
        self, of: dict[str, Any], count: int, dtype: np.dtype[Any], width: int
    ) -> NDArray[Any]:
        """Elements (count, width) of the view that something names."""
        view = self.item("bufferViews", of.get("bufferView"))
        buffer = self._buffer(self.whole(view, "buffer"))
        size = dtype.itemsize * width
        stride = self.whole(view, "byteStride", size)
        start, inside = self.whole(view, "byteOffset", 0), self.whole(of, "byteOffset", 0)
        end = inside + stride * (count - 1) + size if count else inside
        if stride < size or end > self.whole(view, "byteLength") or start + end > len(buffer):
            self.refuse("an accessor reaches beyond its buffer")
        begin = start + inside
        rows = np.ndarray((count, size), np.uint8, buffer, begin, (stride, 1))
        return np.ascontiguousarray(rows).view(dtype).reshape(count, width)

    def _sparse(
        self, accessor: dict[str, Any], values: NDArray[Any], dtype: np.dtype[Any], width: int
    ) -> NDArray[Any]:
        """Values with those replaced that a sparse accessor tells apart."""
        sparse = accessor.get("sparse")
        if not isinstance(sparse, dict):
            return values
        count = self.whole(sparse, "count")
        places, news = (sparse.get(name) for name in ("indices", "values"))
        if not isinstance(places, dict) or not isinstance(news, dict) or count > len(values):
            self.refuse("a sparse accessor without indices or values")
        code = places.get("componentType")
        if code not in INDICES:
            self.refuse(f"indices of a sparse accessor of type {code}")
        index = self._view(places, count, np.dtype(KINDS[code]), 1)[:, 0]
        if count and int(index.max()) >= len(values):
            self.refuse("a sparse accessor replaces what does not exist")
        changed = values.copy()
        changed[index] = self._view(news, count, dtype, width)
        return changed


def _is_whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < 2**53
