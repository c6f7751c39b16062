"""What make installs is locked, by release and by hash, and what is given to make reaches its command as text."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tools import lock

EXTRAS = lock.extras()
PIN = re.compile(
    r"([a-z0-9.-]+)==([0-9a-z.+!-]+)( ; [^\\]+)?((?: \\\n    --hash=sha256:[0-9a-f]{64})+)\n"
)
MAKE = shutil.which("make")
RECORDER = """#!{python} -S
import json, sys
with open({file!r}, "a") as file:
    file.write(json.dumps(sys.argv[1:]) + chr(10))
"""
EVIL = (
    "a'; touch pwned; '",
    'a"; touch pwned; "',
    "`touch pwned`",
    "$(touch pwned)",
    "$(shell touch pwned)",
    "-x\ny",
)


def pins(name: str) -> dict[str, set[str]]:
    """Releases that a lock file holds, by distribution."""
    text = (lock.LOCKS / f"{name}.txt").read_text(encoding="utf-8")
    found: dict[str, set[str]] = {}
    for match in PIN.finditer(text):
        found.setdefault(match[1], set()).add(match[2])
    return found


# -- what is locked -------------------------------------------------------------------------------


def test_every_extra_has_a_lock_and_nothing_else_has() -> None:
    names = {path.stem for path in lock.LOCKS.iterdir()}
    assert names == {*EXTRAS, lock.RUN, lock.RESOLVER}


@pytest.mark.parametrize("name", [*EXTRAS, lock.RUN, lock.RESOLVER])
def test_a_lock_holds_hashed_releases_and_nothing_else(name: str) -> None:
    text = (lock.LOCKS / f"{name}.txt").read_text(encoding="utf-8")
    rest = PIN.sub("", re.sub(r"^#.*\n", "", text, flags=re.MULTILINE))
    assert rest == ""
    assert pins(name)


@pytest.mark.parametrize("name", [*EXTRAS, lock.RUN])
def test_what_pyproject_asks_for_is_locked_to_releases_that_it_takes(name: str) -> None:
    project = lock.project()["project"]
    asked = [*project["dependencies"], *lock.builders()]
    asked = asked if name == lock.RUN else project["optional-dependencies"][name]
    there = pins(lock.RUN) | pins(name)
    for need in map(Requirement, asked):
        locked = there.get(canonicalize_name(need.name), set())
        assert locked, f"{need} is not in locks/{name}.txt: make lock"
        assert all(need.specifier.contains(release, prereleases=True) for release in locked)


def test_what_an_extra_adds_is_not_what_every_install_has() -> None:
    base = pins(lock.RUN).keys()
    assert not [(name, base & pins(name).keys()) for name in EXTRAS if base & pins(name).keys()]


def test_a_distribution_that_two_locks_hold_is_of_one_release() -> None:
    all_of_them: dict[str, set[frozenset[str]]] = {}
    for name in (*EXTRAS, lock.RUN):
        for distribution, releases in pins(name).items():
            all_of_them.setdefault(distribution, set()).add(frozenset(releases))
    assert not {name: releases for name, releases in all_of_them.items() if len(releases) > 1}


def test_the_build_backend_is_pinned_to_what_is_locked() -> None:
    (backend,) = map(Requirement, lock.project()["build-system"]["requires"])
    assert {str(backend.specifier)} == {f"=={release}" for release in pins(lock.RUN)[backend.name]}


@pytest.mark.parametrize("folder", lock.PACKAGES, ids=lambda folder: folder.name)
def test_packages_of_javascript_are_locked_with_their_hashes(folder: Path) -> None:
    wanted = json.loads((folder / "package.json").read_text())["dependencies"]
    locked = json.loads((folder / "package-lock.json").read_text())["packages"]
    assert locked[""]["dependencies"] == wanted
    others = {path: package for path, package in locked.items() if path}
    assert {f"node_modules/{name}" for name in wanted} <= others.keys()
    assert all(re.fullmatch(r"sha512-[\w+/]{86}==", one["integrity"]) for one in others.values())
    assert not any("resolved" in one for one in others.values())


# -- what make runs -------------------------------------------------------------------------------


@pytest.fixture
def venv(tmp_path: Path) -> Path:
    """A stand-in for .venv, whose Python writes down what it is asked to run."""
    if MAKE is None:
        pytest.skip("no make on this machine")
    for name in ("venv", "venv-lock"):
        path = tmp_path / name / "bin/python"
        path.parent.mkdir(parents=True)
        path.write_text(RECORDER.format(python=sys.executable, file=str(tmp_path / "ran")))
        path.chmod(0o755)
    for stamp in ("run", "test", "motions"):
        (tmp_path / "venv" / stamp).touch()
    return tmp_path / "venv"


def made(venv: Path, *arguments: str) -> list[list[str]]:
    """What make runs by Python, in the order of the commands."""
    python = venv / "bin/python"
    command = [str(MAKE), f"--file={lock.ROOT / 'Makefile'}", f"VENV={venv}", f"PYTHON={python}"]
    for name in ("locks", "pyproject.toml"):
        link = venv.parent / name
        if not link.exists():
            link.symlink_to(lock.ROOT / name)
    done = subprocess.run([*command, *arguments], cwd=venv.parent, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in (venv.parent / "ran").read_text().splitlines()]


OFFLINE = ["--no-deps", "--no-build-isolation", "--editable", "."]
"""The checkout itself: no release is fetched for it."""


def test_make_installs_nothing_whose_hash_is_not_checked(venv: Path) -> None:
    stamps = [str(venv / stamp) for stamp in ("run", "test", "motions")]
    ran = made(venv, "--always-make", *stamps, "peers-heavy", "peers-drake", "lock")
    installs = [command for command in ran if "pip" in command]
    asked = {Path(word).stem for command in installs for word in command if word.endswith(".txt")}
    assert asked == {*EXTRAS, lock.RUN, lock.RESOLVER}
    local = [command for command in installs if "--require-hashes" not in command]
    assert local
    assert all(command[-4:] == OFFLINE for command in local)


@pytest.mark.parametrize("text", EVIL)
@pytest.mark.parametrize(
    ("target", "variable"),
    [
        ("new-baseline", "NAME"),
        ("check-baseline", "NAME"),
        ("motions", "MOTIONS"),
        ("benchmark-speed", "TASK"),
        ("torture", "SHARE"),
        ("torture", "MINUTES"),
    ],
)
def test_text_given_to_make_is_one_argument_and_runs_nothing(
    venv: Path, target: str, variable: str, text: str
) -> None:
    (command,) = made(venv, target, f"{variable}={text}")
    assert text in command
    assert not (venv.parent / "pwned").exists()


@pytest.mark.parametrize(
    ("target", "switch"),
    [("new-baseline", "COMPILED"), ("benchmark", "QUICK"), ("lock", "UPGRADE")],
)
def test_a_switch_of_make_runs_nothing(venv: Path, target: str, switch: str) -> None:
    made(venv, target, "NAME=a", f"{switch}=$(shell touch pwned)")
    assert not (venv.parent / "pwned").exists()
