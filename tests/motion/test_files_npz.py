"""Hostile NPZ files: damaged, encrypted, of absurd size; each refused in one sentence, none unpacked."""

from __future__ import annotations

import io
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from keyfiles import refusal
from numpy.lib import format as npy

from quatspline.motion.files import MotionFileError, npz, read

COUNT = 200
TIMES = np.arange(COUNT) + np.random.default_rng(0).random(COUNT)
QUATERNIONS = np.tile([0.8, 0.6, 0.0, 0.0], (COUNT, 1))


def member(array: Any) -> bytes:
    stream = io.BytesIO()
    npy.write_array(stream, np.asarray(array))
    return stream.getvalue()


def headed(header: dict[str, Any] | str, data: bytes = b"") -> bytes:
    """An array's bytes with a header of one's own making."""
    text = (header if isinstance(header, str) else repr(header)).encode("latin1") + b"\n"
    return npy.magic(1, 0) + len(text).to_bytes(2, "little") + text + data


def declared(shape: Any, descr: Any = "<f8") -> bytes:
    return headed({"descr": descr, "fortran_order": False, "shape": shape}, bytes(64))


def archive(path: Path, method: int = zipfile.ZIP_STORED, **members: bytes) -> Path:
    with zipfile.ZipFile(path, "w", method) as file:
        for name, content in members.items():
            file.writestr(f"{name}.npy", content)
    return path


@pytest.mark.parametrize("method", [zipfile.ZIP_DEFLATED, zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2])
def test_compression_is_read_and_its_damage_told(tmp_path: Path, method: int) -> None:
    members = {"times": member(TIMES), "quaternions": member(QUATERNIONS)}
    path = archive(tmp_path / "k.npz", method, **members)
    np.testing.assert_array_equal(read(path).stamps, TIMES)
    whole = path.read_bytes()
    with zipfile.ZipFile(path) as file:
        size = file.getinfo("times.npy").compress_size
    told = []
    for at in range(0, size, 29):  # the data begin after the local header of 30 bytes and the name
        damaged = bytearray(whole)
        damaged[39 + at] ^= 0x5A
        path.write_bytes(damaged)
        try:  # a byte that pads says nothing
            np.testing.assert_array_equal(read(path).stamps, TIMES)
        except MotionFileError as error:
            told.append(str(error))
    assert set(told) == {f"{path}: not an NPZ file of plain arrays"}
    assert len(told) > 0.9 * (size // 29)


@pytest.mark.parametrize("keep", [0, 10, 100, 1000, 2000, -1, -30])
def test_a_truncated_file_is_refused(tmp_path: Path, keep: int) -> None:
    path = archive(tmp_path / "k.npz", times=member(TIMES), quaternions=member(QUATERNIONS))
    path.write_bytes(path.read_bytes()[:keep])
    assert refusal(path) == ": not an NPZ file of plain arrays"


def patched(path: Path, offset_local: int, offset_central: int, value: int) -> None:
    """Set two bytes in every local and central header of an archive."""
    content = bytearray(path.read_bytes())
    for signature, offset in ((b"PK\x03\x04", offset_local), (b"PK\x01\x02", offset_central)):
        at = content.find(signature)
        while at >= 0:
            content[at + offset : at + offset + 2] = value.to_bytes(2, "little")
            at = content.find(signature, at + 4)
    path.write_bytes(content)


def test_an_encrypted_file_is_refused(tmp_path: Path) -> None:
    path = archive(tmp_path / "k.npz", times=member(TIMES), quaternions=member(QUATERNIONS))
    patched(path, 6, 8, 1)
    assert "it is encrypted" in refusal(path)


@pytest.mark.parametrize("method", [1, 6, 9, 97, 99])
def test_an_unknown_compression_is_refused(tmp_path: Path, method: int) -> None:
    path = archive(tmp_path / "k.npz", times=member(TIMES), quaternions=member(QUATERNIONS))
    patched(path, 8, 10, method)
    assert "its compression is not known here" in refusal(path)


@pytest.mark.parametrize(
    "times",
    [
        declared((10**15,)),
        declared((2**31, 2**31)),
        declared((2**40, 2**40)),
        declared((10**30,)),
        declared((npz.LARGEST + 1,)),
        declared((10**15,), "|V0"),
        declared((10**15,), "|O"),
    ],
)
@pytest.mark.parametrize("method", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
def test_more_numbers_than_keyframes_have_are_refused(
    tmp_path: Path, times: bytes, method: int
) -> None:
    path = archive(tmp_path / "k.npz", method, times=times, quaternions=member(QUATERNIONS))
    assert "more than 100,000,000 numbers are not read" in refusal(path)


HEADERS: dict[str, bytes] = {
    "negative": declared((-5,)),
    "negative twice": declared((-5, -5)),
    "less than declared": declared((1000,)),
    "not a tuple": declared(5),
    "no shape": headed({"descr": "<f8", "fortran_order": False}),
    "no type": declared((8,), "nonsense"),
    "no header": headed("garbage ("),
    "deep": headed("(" * 5000),
    "code": headed("__import__('os').abort()"),
    "not text": npy.magic(1, 0) + b"\x05\x00\xff\xfe\x00\x01\x02",
    "long header": npy.magic(2, 0) + (2**31).to_bytes(4, "little") + b"{}",
    "magic": b"\x93NUMPX" + member(TIMES)[6:],
    "version": b"\x93NUMPY\x09\x09" + member(TIMES)[8:],
    "empty": b"",
    "a pickle": headed({"descr": "|O", "fortran_order": False, "shape": (2,)}, b"cos\nabort\n(tR."),
}


@pytest.mark.parametrize("times", HEADERS.values(), ids=HEADERS)
def test_a_header_that_makes_no_sense_is_refused(tmp_path: Path, times: bytes) -> None:
    path = archive(tmp_path / "k.npz", times=times, quaternions=member(QUATERNIONS))
    assert refusal(path) == ": not an NPZ file of plain arrays"


@pytest.mark.parametrize("name", ["times", "quaternions", "positions"])
def test_a_bomb_is_refused_before_it_is_unpacked(
    tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(npz, "LARGEST", 100_000)
    bomb = np.zeros(4_000_000)
    members = {"times": member(TIMES), "quaternions": member(QUATERNIONS), name: member(bomb)}
    path = archive(tmp_path / "k.npz", zipfile.ZIP_DEFLATED, **members)
    assert path.stat().st_size < bomb.nbytes / 100
    tracemalloc.start()
    message = refusal(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert message.startswith(
        f": {name} declares 4000000 numbers, 32,000,128 bytes: more than 100,000"
    )
    assert peak < bomb.nbytes / 8


def test_a_bomb_behind_a_small_header_is_refused(tmp_path: Path) -> None:
    """What follows the numbers that a header declares is bounded by the size in the directory."""
    path = tmp_path / "k.npz"
    archive(path, times=member(TIMES), quaternions=member(QUATERNIONS))
    content = bytearray(path.read_bytes())
    at = content.find(b"PK\x01\x02")
    content[at + 24 : at + 28] = (2**32 - 2).to_bytes(4, "little")  # the size once unpacked
    path.write_bytes(content)
    assert refusal(path).startswith(": times declares 200 numbers, 4,294,967,294 bytes: more than")


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (lambda t, q: (t, q, {"positions": np.zeros((COUNT, 2))}), "expected positions (200, 3)"),
        (lambda t, q: (t, q, {"positions": np.zeros((COUNT - 1, 3))}), "expected positions (200,"),
        (lambda t, q: (t, q > 0.5, {}), "quaternions (bool): not numbers"),
        (lambda t, q: (t > 0.5, q, {}), "times (bool), quaternions (float64): not numbers"),
        (lambda t, q: (t, q, {"positions": np.zeros((COUNT, 3), bool)}), "positions (bool)"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(
    tmp_path: Path, change: Callable[..., Any], what: str
) -> None:
    times, quaternions, more = change(TIMES, QUATERNIONS)
    np.savez(tmp_path / "k.npz", times=times, quaternions=quaternions, **more)
    assert what in refusal(tmp_path / "k.npz")


def test_positions_are_read_and_other_arrays_named(tmp_path: Path) -> None:
    x = np.arange(3.0 * COUNT).reshape(-1, 3)
    np.savez(tmp_path / "k.npz", times=TIMES, quaternions=QUATERNIONS, positions=x, speeds=TIMES)
    motion = read(tmp_path / "k.npz")
    np.testing.assert_array_equal(motion.positions[:, 0], x)
    assert motion.unread == ("speeds",)
    x[3, 1] = np.nan
    np.savez(tmp_path / "k.npz", times=TIMES, quaternions=QUATERNIONS, positions=x)
    with pytest.raises(MotionFileError, match=r", row 3: ty holds no number"):
        read(tmp_path / "k.npz")
