"""Files written whole or not at all."""

from __future__ import annotations

import errno
import os
import secrets
import shutil
from pathlib import Path

import pytest

from quatspline.system.atomic import ASIDE, clear_asides, replacing, same_file


@pytest.fixture(autouse=True)
def usual_umask():
    before = os.umask(0o027)
    yield
    os.umask(before)


def mode(path: Path) -> int:
    return path.stat().st_mode & 0o777


def test_a_new_file_has_the_mode_that_the_umask_leaves(tmp_path: Path) -> None:
    with replacing(tmp_path / "new") as aside:
        aside.write_text("x")
    assert mode(tmp_path / "new") == 0o640


@pytest.mark.parametrize("bits", [0o600, 0o666, 0o755, 0o444])
def test_a_file_replaced_keeps_its_mode_and_is_never_wider_before(
    tmp_path: Path, bits: int
) -> None:
    path = tmp_path / "old"
    path.write_text("old")
    path.chmod(bits)
    with replacing(path) as aside:
        aside.write_text("new")
        assert mode(aside) & ~(bits | 0o200) == 0
    assert mode(path) == bits
    assert path.read_text() == "new"


def test_files_aside_of_others_are_neither_written_nor_removed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    others = [f".k.csv.{os.getpid()}.part", ".k.csv.part", "k.csv.part"]
    for name in others:
        (tmp_path / name).write_text("foreign")
    with replacing(tmp_path / "k.csv") as aside:
        aside.write_text("new")
    clear_asides(tmp_path)
    assert {name: (tmp_path / name).read_text() for name in others} == dict.fromkeys(
        others, "foreign"
    )
    monkeypatch.setattr(secrets, "token_hex", lambda size: "taken")
    taken = tmp_path / ".k.csv.taken.part"
    taken.write_text("foreign")
    with pytest.raises(FileExistsError), replacing(tmp_path / "k.csv"):
        pass
    assert taken.read_text() == "foreign"


def test_two_writers_of_one_name_do_not_meet(tmp_path: Path) -> None:
    path = tmp_path / "k"
    with replacing(path) as one, replacing(path) as two:
        one.write_text("one")
        two.write_text("two")
    assert path.read_text() == "one"
    assert os.listdir(tmp_path) == ["k"]


def test_what_a_killed_writer_left_is_cleared(tmp_path: Path) -> None:
    with replacing(tmp_path / "k", ASIDE) as aside:
        aside.write_text("half")
        shutil.copy(aside, tmp_path / f".k.{16 * '0'}{ASIDE}")
    clear_asides(tmp_path)
    assert os.listdir(tmp_path) == ["k"]


def test_what_only_ends_as_ours_do_is_not_cleared(tmp_path: Path) -> None:
    names = [f".a{ASIDE}", f".a.0123{ASIDE}", f".a.{16 * 'g'}{ASIDE}", f".{16 * '0'}{ASIDE}"]
    for name in names:
        (tmp_path / name).write_text("foreign")
    (tmp_path / f".d.{16 * '0'}{ASIDE}").mkdir()
    (tmp_path / f".l.{16 * '0'}{ASIDE}").symlink_to("nowhere")
    before = sorted(os.listdir(tmp_path))
    clear_asides(tmp_path)
    assert sorted(os.listdir(tmp_path)) == before


def test_what_cannot_be_written_is_named(tmp_path: Path) -> None:
    path = tmp_path / "k"
    for made in (OSError(errno.ENOSPC, "full"), OSError(errno.EIO, "bad", "other")):
        with pytest.raises(OSError, match=r"full|bad") as told, replacing(path):
            raise made
        assert told.value.filename == (made.filename if "bad" in str(made) else str(path))
    assert os.listdir(tmp_path) == []


def test_a_link_is_followed_or_replaced(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    link = tmp_path / "in" / "link"
    link.symlink_to("../outside")
    for follow in (True, False):
        with replacing(link, follow=follow) as aside:
            aside.write_text(str(follow))
        assert link.is_symlink() == follow
        assert (tmp_path / "outside").read_text() == "True"
    assert link.read_text() == "False"


def test_a_long_name_leaves_room_for_the_one_aside(tmp_path: Path) -> None:
    path = tmp_path / ("ä" * 120 + ".csv")
    with replacing(path) as aside:
        aside.write_text("x")
    assert path.read_text() == "x"


def test_one_file_is_known_through_links_and_roundabout_paths(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "k.csv"
    path.write_text("x")
    (tmp_path / "sub").mkdir()
    (tmp_path / "soft.csv").symlink_to(path)
    os.link(path, tmp_path / "hard.csv")
    monkeypatch.chdir(tmp_path)
    for other in ("k.csv", "./sub/../k.csv", "soft.csv", "hard.csv", path):
        assert same_file(other, path)
    (tmp_path / "copy.csv").write_text("x")
    assert not same_file("copy.csv", path)
    assert not same_file("none.csv", path)
