"""Machine code on disk: loaded where it is whole, compiled again where it is not."""

from __future__ import annotations

import os
import stat
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
import pytest

from quatspline.engines import compiler, disk
from quatspline.system.loading import load


def twice(x):
    return 2.0 * x


def loads(folder: Path) -> bool:
    """Whether code that a fresh process would run was loaded; what it returns is right either way."""
    function: Any = numba.njit(twice)
    disk.keep(function, twice, folder)
    assert function(1.5) == 3.0
    return bool(function.stats.cache_hits)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder that holds the code of `twice`."""
    made = tmp_path / "base" / "0123456789abcdef"
    assert not loads(made)
    assert loads(made)
    return made


def replaced(change: Callable[[bytes], bytes]) -> Callable[[Path], None]:
    return lambda path: path.write_bytes(change(path.read_bytes())) and None


def _folder_instead(path: Path) -> None:
    path.unlink()
    path.mkdir()
    (path / "inside").touch()


DAMAGE: dict[str, Callable[[Path], Any]] = {
    "removed": Path.unlink,
    "emptied": replaced(lambda _: b""),
    "cut within the hash": replaced(lambda raw: raw[:10]),
    "cut within the code": replaced(lambda raw: raw[: len(raw) // 2]),
    "one byte short": replaced(lambda raw: raw[:-1]),
    "longer": replaced(lambda raw: raw + b"\0"),
    "one bit turned": replaced(lambda raw: raw[:40] + bytes([raw[40] ^ 1]) + raw[41:]),
    "another's": replaced(lambda _: os.urandom(4096)),
    "a pickle without a hash": replaced(lambda raw: raw[disk.DIGEST :]),
    "unreadable": lambda path: path.chmod(0),
    "a link to itself": lambda path: (path.unlink(), path.symlink_to(path)),
    "a folder": _folder_instead,
}


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
@pytest.mark.parametrize("damage", DAMAGE.values(), ids=DAMAGE)
def test_damage_is_compiled_over(
    folder: Path, damage: Callable[[Path], Any], suffix: str, recwarn: pytest.WarningsRecorder
) -> None:
    path = next(p for p in folder.iterdir() if p.suffix == suffix)
    damage(path)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of a folder in its place, which cannot be replaced
        loads(folder)
    assert loads(folder) or path.is_dir()


def test_code_of_equal_files_in_two_places_is_kept_apart(tmp_path: Path) -> None:
    """It names its module, and of a file loaded by path the name is that place's: elsewhere there is none."""
    source = "def thrice(x):\n    return 3.0 * x\n"
    for place in ("a", "b"):
        (tmp_path / place).mkdir()
        path = tmp_path / place / "plugin.py"
        path.write_text(source)
        module = load(path, "baseline")
        function: Any = numba.njit(module.thrice)
        disk.keep(function, module.thrice, tmp_path / "code")
        assert function(1.0) == 3.0
        assert not function.stats.cache_hits
        del sys.modules[module.__name__]  # as in a process that has the other one


class _Trap:
    """What is unpickled runs this."""

    def __reduce__(self) -> tuple[Any, ...]:
        return (pytest.fail, ("an unchecked file was unpickled",))


def test_nothing_is_unpickled_that_does_not_match_its_hash(folder: Path) -> None:
    import pickle

    for path in folder.iterdir():
        path.write_bytes(bytes(disk.DIGEST) + pickle.dumps(_Trap()))
    assert not loads(folder)


def test_code_that_cannot_be_linked_here_is_compiled_again(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*_: Any) -> None:
        raise ModuleNotFoundError("quatspline_baseline_of_another_checkout")

    with monkeypatch.context() as patch:
        patch.setattr(disk.caching.CompileResultCacheImpl, "rebuild", fails)
        assert not loads(folder)
    assert loads(folder)


def test_where_nothing_can_be_written_code_stays_in_memory_and_one_warning_names_the_folder(
    tmp_path: Path,
) -> None:
    base = tmp_path / "file"
    base.write_text("no folder can be made below a file")
    disk.tell.cache_clear()
    with pytest.warns(RuntimeWarning, match="not kept for the next process") as told:
        assert not any(loads(base / "a") for _ in range(2))
    assert len(told) == 1
    assert str(base) in str(told[0].message)


def test_a_folder_that_may_only_be_read_serves(folder: Path) -> None:
    folder.chmod(stat.S_IRUSR | stat.S_IXUSR)
    assert loads(folder)
    folder.chmod(stat.S_IRWXU)


def test_code_is_kept_in_the_folder_of_its_sources_and_numbas_setting_is_left_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("QUATSPLINE_CACHE", str(tmp_path))
    config: Any = numba.config
    before = config.CACHE_DIR
    source = Path(twice.__code__.co_filename)
    compiler.cache_folder.cache_clear()
    folder = compiler.cache_folder(source)
    compiler.cache_folder.cache_clear()
    assert folder.parent == tmp_path
    assert not loads(folder)
    assert loads(folder)
    assert before == config.CACHE_DIR
