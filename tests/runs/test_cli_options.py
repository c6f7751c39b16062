"""``--option``, ``--no-align`` and the command ``options``."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import quatspline as qs
from quatspline import quaternion
from quatspline.cli import main, options
from quatspline.options import declared_by

ROWS = "0,1,0,0,0\n1,0.8,0.6,0,0\n2.5,0.6,0,0.8,0\n3,0,0,1,0\n4,0,0.6,0.8,0\n"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "k.csv"
    path.write_text(ROWS)
    return path


def run(*words: object) -> int:
    return main([str(word) for word in words])


def sampled(out: str) -> np.ndarray:
    rows = [line.split(",")[:5] for line in out.splitlines()[1:]]
    return np.array(rows, dtype=float)


@pytest.mark.parametrize(
    ("name", "given", "meant"),
    [
        ("squad", ["inner=textbook"], {"inner": "textbook"}),
        ("kochanek-bartels", ["tension=.5", "bias=0,0,1,0,0"], {"tension": 0.5, "bias": [0, 0, 1, 0, 0]}),
        ("kim", ["ends=clamped", "start_velocity=0,0,2"], {"ends": "clamped", "start_velocity": [0, 0, 2]}),
        ("moving-frame", ["degree = 5"], {"degree": 5}),
        ("nielson", ["max_iterations=500", "on_failure=return"], {"max_iterations": 500}),
        ("squad", ["ends=None"], {}),
    ],
)  # fmt: skip
def test_sample_hands_options_on(
    name: str,
    given: list[str],
    meant: dict[str, object],
    file: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    words = [word for pair in given for word in ("--option", pair)]
    assert run("sample", file, "--scheme", name, "--count", 9, *words) == 0
    found = sampled(capsys.readouterr().out)
    keys = qs.read_motion(file)
    curve = qs.build(name, keys.times, keys.quaternions[:, 0], **meant)
    np.testing.assert_allclose(found[:, 1:], curve(found[:, 0]), atol=1e-12)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--option", "iner=textbook"], "squad has no option 'iner': did you mean 'inner'?"),
        (["--option", "inner=text"], "inner='text': expected one of 'two-a'"),
        (["--option", "inner"], "--option inner: name=value is expected"),
        (["--option", "=3"], "--option =3: name=value is expected"),
        (["--option", "ends=chart", "--option", "ends=chart"], "ends is given twice"),
        (["--option", "closed=True"], "squad has no option 'closed'"),
        (["--option", "inner=" + "(" * 500], "inner='(((("),
    ],
)
def test_bad_options_are_told_before_a_file_is_read(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    for command in (
        ["sample", "none.csv", "--scheme", "squad", "--count", "3"],
        ["reduce", "none.csv", "--scheme", "squad", "--error", "1deg"],
    ):
        assert run(*command, *words) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert said in line


def test_no_align_keeps_signs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "k.csv"
    path.write_text("0,1,0,0,0\n1,-0.8,-0.6,0,0\n")
    words = ("sample", path, "--scheme", "slerp", "--count", 3)
    q = [[1, 0, 0, 0], [-0.8, -0.6, 0, 0]]
    for more, align in (((), True), (("--no-align",), False)):
        assert run(*words, *more) == 0
        found = sampled(capsys.readouterr().out)
        np.testing.assert_allclose(
            found[:, 1:], qs.build("slerp", None, q, align=align)([0, 0.5, 1])
        )
    path.write_text("0,1,0,0,0\n1,-1,0,0,0\n")
    assert run(*words) == 0
    capsys.readouterr()
    assert run(*words, "--no-align") == 2
    assert "antipod" in capsys.readouterr().err


def test_compare_gives_options_to_schemes_that_have_them(
    file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = (
        "compare",
        file,
        "--schemes",
        "slerp,squad,kochanek-bartels",
        "--out",
        tmp_path / "out",
    )
    assert run(*words, "--option", "tension=1", "--option", "inner=single-a") == 0
    table = pd.read_csv(tmp_path / "out" / "compare.csv").set_index("scheme")
    assert table.loc["kochanek-bartels", "key_speed"] < 1e-6  # full tension stops at keyframes
    assert table.loc["squad", "key_speed"] > 0.1
    told = (tmp_path / "out" / "compare.md").read_text()
    assert "Options, of the schemes that have them: tension=1, inner=single-a." in told
    assert run(*words, "--option", "tensoin=1") == 2
    assert "none of the schemes has an option 'tensoin': did you mean 'tension'?" in (
        capsys.readouterr().err
    )


def test_compare_of_skeletons_takes_options(tmp_path: Path) -> None:
    t = np.arange(40) / 10
    q = quaternion.exp(np.stack([np.sin(t), np.cos(2 * t), 0 * t], axis=1) / 2)
    motion = qs.Motion(t, np.stack([q, q[::-1]], axis=1), tracks=["a", "b"])
    qs.write_motion(tmp_path / "m.npz", motion)
    words = ("compare", tmp_path / "m.npz", "--keep", 4, "--schemes", "kochanek-bartels", "--out")
    rms = []
    for out, more in (("plain", ()), ("tense", ("--option", "tension=1"))):
        assert run(*words, tmp_path / out, *more) == 0
        rms.append(pd.read_csv(tmp_path / out / "kept.csv")["rms_median"][0])
    assert rms[1] > 1.5 * rms[0]


def test_compare_in_python_takes_options() -> None:
    q = np.array([row.split(",")[1:] for row in ROWS.split()], dtype=float)
    table = qs.compare(None, q, ["kochanek-bartels", "slerp"], tension=1.0)
    assert table.set_index("scheme").loc["kochanek-bartels", "key_speed"] < 1e-6
    with pytest.raises(ValueError, match="none of the schemes has an option 'tensions'"):
        qs.compare(None, q, ["kochanek-bartels", "slerp"], tensions=1.0)


def test_options_of_every_scheme_are_shown(
    scheme: type, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("options", scheme.name) == 0
    told = capsys.readouterr().out
    assert told.startswith(f"{scheme.name}: {scheme.title}\n")
    known = declared_by(scheme)
    for name, parameter in known.items():
        assert f"  --option {name}={parameter.default}" in told
        assert options.of_scheme(scheme.name, [f"{name}={parameter.default}"]) == {
            name: parameter.default
        }
    assert ("no options" in told) == (not known)


def test_kinds_are_told_in_words(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("options", "kim") == 0
    told = {
        line.split()[1]: line.split("  ")[-1]
        for line in capsys.readouterr().out.splitlines()
        if "--option" in line
    }
    assert told["ends=natural"].strip() == "natural | clamped"
    assert told["tolerance=1e-06"].strip() == "a number, above 0"
    assert told["max_iterations=None"].strip() == "a whole number, at least 1, at most 10000 | None"
    assert told["start_velocity=None"].strip() == "a number, or several by commas"
    assert run("options", "kimm") == 2
    assert "did you mean 'kim'?" in capsys.readouterr().err
