"""Bad plug-ins under commands other than ``run``: those that behave while they are tried, and fail on a user's file."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from plugins import CELLS, HUGE, SEGV, Bad

import quatspline as qs
from processes import STUCK, command, environment

CUT = "if self.keyframes.count == 4: "
BAD = {
    "fit-exit": Bad("SystemExit: 3", fit=CELLS + "sys.exit(3)"),
    "fit-interrupt": Bad("KeyboardInterrupt: ", fit=CELLS + "raise KeyboardInterrupt"),
    "fit-end": Bad("it ended its process: status 7", fit=CELLS + "os._exit(7)"),
    "fit-huge": Bad("MemoryError: ", fit=CELLS + HUGE),
    "sample-exit": Bad("SystemExit: 3", sample=CUT + "sys.exit(3)"),
    "sample-error": Bad("ZeroDivisionError: division by zero", sample=CUT + "1 / 0"),
    "sample-segv": Bad("it ended its process: SIGSEGV", sample=CUT + SEGV),
    "sample-nan": Bad("no unit quaternions: length nan", sample=CUT + "values[-1] = np.nan"),
    "sample-double": Bad("no unit quaternions: length 2", sample=CUT + "values *= 2.0"),
}
GOOD = Bad(None, fit=CELLS + "print('noise')")
ROWS = np.array([[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0.64, 0.48, 0.6, 0], [0.512, 0.384, 0.48, 0.6]])


@pytest.fixture
def plugins(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "plugins"
    folder.mkdir()
    for name, bad in {"good": GOOD, **BAD}.items():
        (folder / f"{name.replace('-', '_')}.py").write_text(bad.text, encoding="utf-8")
    monkeypatch.setenv("QUATSPLINE_BASELINES", str(folder))
    return folder


def motion(folder: Path, tracks: int = 1) -> Path:
    """Keyframes of four frames, or seven of which every second is kept, of several joints."""
    path = folder / "motion.npz"
    if tracks == 1:
        np.savez(path, times=np.arange(4.0), quaternions=ROWS)
    else:
        between = [qs.build("slerp", None, ROWS)(t / 2.0) for t in range(7)]
        np.savez(path, times=np.arange(7.0), quaternions=np.stack([between] * tracks, axis=1))
    return path


def run(folder: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    given = {"capture_output": True, "text": True, "cwd": folder, "env": environment()}
    return subprocess.run(command(*arguments), timeout=STUCK, check=False, **given)


def test_a_comparison_labels_plug_ins_that_fail_on_its_keyframes(plugins: Path) -> None:
    table = qs.compare(None, ROWS, ["slerp", "good", *BAD]).set_index("scheme")
    assert table.loc[["slerp", "good"], "failure"].isna().all()
    for name, bad in BAD.items():
        assert str(bad.reason) in table.loc[name, "failure"], name


def test_joints_are_compared_without_plug_ins_that_fail_on_them(
    tmp_path: Path, plugins: Path
) -> None:
    bad = ["fit-exit", "fit-end", "sample-segv", "sample-nan", "sample-double"]
    given = ["--keep", 2, "--schemes", "slerp", "good", *bad, "--out", "out"]
    done = run(tmp_path, "compare", motion(tmp_path, tracks=2), *given)
    assert done.returncode == 0, done.stderr
    assert "noise" not in done.stdout
    table = pd.read_csv(tmp_path / "out" / "kept.csv").set_index("scheme")
    assert table.loc[["slerp", "good"], "failure"].isna().all()
    for name in bad:
        assert str(BAD[name].reason) in table.loc[name, "failure"], name


@pytest.mark.parametrize("name", ["fit-exit", "fit-interrupt", "sample-exit"])
@pytest.mark.parametrize("asked", [("sample", "--count", 5), ("reduce", "--error", "1deg")])
def test_what_would_leave_the_program_is_an_error(
    tmp_path: Path, plugins: Path, name: str, asked: tuple[object, ...]
) -> None:
    """Neither the status of ``sys.exit``, nor an interruption that nobody asked for."""
    if asked[0] == "reduce":  # which takes interpolating schemes
        file = plugins / f"{name.replace('-', '_')}.py"
        file.write_text(file.read_text().replace('"none", False', '"none", True'))
    verb, *more = asked
    done = run(tmp_path, verb, motion(tmp_path), "--scheme", name, *more, "-o", "out.csv")
    assert done.returncode == 1
    assert done.stderr.splitlines() == [
        f"quatspline: {BAD[name].reason}: raised by a scheme or a library"
    ]
    assert not (tmp_path / "out.csv").exists()


def test_a_folder_of_plug_ins_may_hold_anything(tmp_path: Path) -> None:
    """What is no file of schemes is told by its name, and takes nothing down."""
    folder = tmp_path / "plugins"
    folder.mkdir()
    (folder / "loop.py").symlink_to("loop.py")
    (folder / "folder.py").mkdir()
    os.mkfifo(folder / "pipe.py")
    os.mkfifo(folder / "_private.py")
    (folder / "device.py").symlink_to("/dev/zero")
    (folder / "empty.py").touch()
    (folder / "large.py").write_bytes(b"#" * 50_000_000)
    (folder / "good.py").write_text(Bad(None).text)
    os.close(os.open(os.fsencode(folder) + b"/odd\xff.py", os.O_CREAT))
    (folder / "red.py").write_text(r"raise ValueError('\x1b[31m')")
    done = subprocess.run(
        command("list"),
        capture_output=True,
        env=environment(QUATSPLINE_BASELINES=str(folder)),
        timeout=STUCK,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    lines = done.stdout.decode("utf-8").splitlines()
    said = {name: rest for name, _, rest in (line.partition("  n/a: ") for line in lines) if rest}
    said = {name.strip(): rest for name, rest in said.items()}
    assert any(line.startswith("good ") and "Held" in line for line in lines)
    for name in ("folder", "pipe", "device"):
        assert said[name] == "it is no file"
    assert said["loop"].startswith("OSError")
    assert (
        said["empty"] == said[r"odd\udcff"] == "TypeError: one subclass of Curve expected, 0 found"
    )
    assert said["large"].startswith("it has 50,000,000 bytes")
    assert said["red"] == r"ValueError: \x1b[31m"
