"""Recorded clips are fetched whole or not at all, known by their numbers, from a server on this machine."""

from __future__ import annotations

import json
import socket
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from clips import recorded

from quatspline.cli import main
from quatspline.trajectories import clips, fetching

pytest.importorskip("pooch")

CLIPS = {"a.asf": b"# by hand\nlength 0.45\n", "a.amc": b"1\nroot 1 2.50 -3e1\n", "b.txt": b"0 1\n"}
"""What the sources hold."""


class Server(ThreadingHTTPServer):
    """Serves `files`; what it was asked for stands in `asked`."""

    def __init__(self) -> None:
        super().__init__(("127.0.0.1", 0), Handler)
        self.files = dict(CLIPS)
        self.short: set[str] = set()
        self.asked: list[str] = []
        self.address = f"http://127.0.0.1:{self.server_port}"


class Handler(BaseHTTPRequestHandler):
    server: Server

    def do_GET(self) -> None:
        name = self.path.rpartition("/")[2]
        self.server.asked.append(name)
        content = self.server.files.get(name)
        if content is None:
            self.send_error(404)
            return
        self.send_response(200)
        self.send_header("Content-Length", str(len(content) + (name in self.server.short)))
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, format: str, *args: object) -> None:
        pass


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Server]:
    """The sources are on it: those of a.* and of b.txt, by different names."""
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    monkeypatch.setattr(fetching, "PATIENCE", 5.0)
    with Server() as made:
        thread = threading.Thread(target=made.serve_forever, args=(0.01,))
        thread.start()
        _sources(monkeypatch, tmp_path / "recorded.toml", made.address)
        yield made
        made.shutdown()
        thread.join()
    fetching.sources.cache_clear()


def _sources(monkeypatch: pytest.MonkeyPatch, path: Path, address: str) -> None:
    lines = []
    for source in ("a", "b"):
        lines += ["[[source]]", f'name = "source {source}"', f'terms = "terms of {source}"']
        lines.append(f'acknowledgement = "thanks to {source}"')
        for name in (name for name in CLIPS if name[0] == source):
            fields = {"name": name, "address": f"{address}/{source}/{name}"}
            fields["numbers"] = fetching.digest(CLIPS[name])
            lines += ["[[source.file]]", *(f"{k} = {json.dumps(v)}" for k, v in fields.items())]
    path.write_text("\n".join(lines))
    monkeypatch.setattr(fetching, "TABLE", path)
    fetching.sources.cache_clear()


def run(*words: object) -> int:
    return main(["motions", *map(str, words)])


def test_all_files_with_terms_and_acknowledgements(
    server: Server, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "deep" / "motions"
    assert run(folder) == 0
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == CLIPS
    told = capsys.readouterr().out
    for source in "ab":
        assert f"terms: terms of {source}" in told
        assert f"thanks to {source}" in told
    assert told.splitlines()[-1] == f"export QUATSPLINE_MOTIONS={folder}"


def test_what_is_there_is_not_fetched_again(server: Server, tmp_path: Path) -> None:
    (tmp_path / "m").mkdir()
    (tmp_path / "m" / "a.amc").write_bytes(CLIPS["a.amc"])
    assert run(tmp_path / "m") == 0
    assert server.asked == ["a.asf", "b.txt"]
    assert run(tmp_path / "m") == 0
    assert len(server.asked) == 2


def test_a_mirror_may_write_the_numbers_otherwise(server: Server, tmp_path: Path) -> None:
    other = b"#!OML:ASF F:\\a.asf\r\n1\r\nroot  1.0\t2.5 -30\r\n"
    server.files["a.amc"] = other
    assert run(tmp_path / "m", "--from", f"{server.address}/mirror/") == 0
    assert (tmp_path / "m" / "a.amc").read_bytes() == other


@pytest.mark.parametrize(
    ("name", "content", "short", "said"),
    [
        ("a.amc", b"1\nroot 1 2.51 -3e1\n", False, "does not hold the numbers"),
        ("a.amc", None, False, "404"),
        ("a.amc", CLIPS["a.amc"], True, "not fetched whole"),
        ("b.txt", b"<html>moved</html>", False, "does not hold the numbers"),
    ],
)
def test_a_failure_is_one_sentence_and_leaves_the_others(
    name: str,
    content: bytes | None,
    short: bool,
    said: str,
    server: Server,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    server.files = {n: c for n, c in CLIPS.items() if n != name}
    server.files |= {} if content is None else {name: content}
    server.short = {name} if short else set()
    assert run(tmp_path / "m") == 1
    assert sorted(p.name for p in (tmp_path / "m").iterdir()) == sorted({*CLIPS} - {name})
    out, err = capsys.readouterr()
    (line,) = err.splitlines()
    assert line.startswith(f"quatspline: {name}: ")
    assert server.address in line
    assert said in line
    assert "export" not in out
    server.files, server.short = dict(CLIPS), set()
    asked = len(server.asked)
    assert run(tmp_path / "m") == 0
    assert server.asked[asked:] == [name]


def test_a_server_that_does_not_answer_is_asked_once(
    server: Server,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    with socket.socket() as bound:  # nobody listens at its port
        bound.bind(("127.0.0.1", 0))
        host = f"127.0.0.1:{bound.getsockname()[1]}"
        tried = []
        fetch = fetching.download

        def counted(path: Path, address: str, remote: fetching.Remote) -> None:
            tried.append(address)
            fetch(path, address, remote)

        monkeypatch.setattr(fetching, "download", counted)
        assert run(tmp_path / "m", "--from", f"http://{host}") == 1
    assert len(tried) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line == f"quatspline: {host} does not answer: a.asf, a.amc, b.txt"
    assert not list((tmp_path / "m").iterdir())


def test_files_of_others_stay(
    server: Server, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "m" / "b.txt").mkdir(parents=True)
    (tmp_path / "m" / "a.amc").write_bytes(b"mine")
    assert run(tmp_path / "m") == 1
    assert (tmp_path / "m" / "a.amc").read_bytes() == b"mine"
    assert len(capsys.readouterr().err.splitlines()) == 2
    assert run(tmp_path / "m", "--force") == 1  # a folder is never replaced
    assert (tmp_path / "m" / "a.amc").read_bytes() == CLIPS["a.amc"]
    assert "b.txt: something else is there" in capsys.readouterr().err


@pytest.mark.parametrize("mirror", ["motions", "ftp://a.b/c", "file:///clips"])
def test_addresses_of_other_kinds_are_refused(
    mirror: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(tmp_path / "m", "--from", mirror) == 2
    assert (
        f"--from {mirror}: expected an address that begins with http://" in capsys.readouterr().err
    )
    assert not (tmp_path / "m").exists()


def test_a_folder_that_cannot_be_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "m").write_text("")
    assert run(tmp_path / "m") == 2
    assert capsys.readouterr().err.endswith("cannot be made: File exists\n")


def test_the_sources_name_clips_that_are_read() -> None:
    """Each AMC with its skeleton; each file once, with an address of its own and a digest."""
    files = [file for source in fetching.sources() for file in source.files]
    names = {file.name for file in files}
    assert len(names) == len(files) == len({file.address for file in files})
    for file in files:
        assert len(file.numbers) == 64
        assert urlsplit(file.address).path.endswith((".asf", ".amc", ".bvh", ".txt"))
        if file.name.endswith(".amc"):
            assert f"{file.name.partition('_')[0]}.asf" in names
        else:
            assert file.name.endswith((".asf", *clips.SUFFIXES))


@pytest.mark.skipif(not recorded(), reason="QUATSPLINE_MOTIONS names no clips")
def test_the_clips_that_are_measured_on_are_those_of_the_sources() -> None:
    known = {file.name: file.numbers for source in fetching.sources() for file in source.files}
    there = {path.name: path for path in clips.contents() if path.name in known}
    assert there
    for name, path in there.items():
        assert fetching.digest(path.read_bytes()) == known[name], name
