"""The command line; experiments come from a folder of their own."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import quatspline
from desk import Desk, count, refused
from processes import command, environment, python
from quatspline.cli import running
from quatspline.motion import files
from quatspline.motion.grid import sample_times
from quatspline.runs import experiment

FAILING = 'self._conclude(SolveReport("jacobi", "residual", 9, 0.1, 0.2, False, 1e-6))'

DERIVED = """
import pandas as pd
TITLE, PAPER = "Total", False
def derive(run, read):
    return pd.DataFrame({"x": [read("errors")["x"].sum()]})
"""


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    return Desk(tmp_path)


# -- usage --------------------------------------------------------------------------------------


def test_help_and_version(desk: Desk) -> None:
    assert desk("--version").stdout == f"quatspline {quatspline.__version__}\n"
    shown = desk("--help")
    assert shown.returncode == 0
    assert {"list", "run", "sample"} <= set(shown.stdout.split())


def test_help_of_run_lists_experiments(desk: Desk) -> None:
    desk.experiment("trial")
    path = desk.folder / "experiments" / "trial.py"
    path.write_text('"""What a trial shows.\n\nMore of it."""\n' + path.read_text())
    (desk.folder / "experiments" / "broken.py").write_text("measure = (")
    shown = desk("run", "--help").stdout.splitlines()
    listed = [line.split(maxsplit=1) for line in shown[shown.index("experiments:") + 1 :]]
    assert ["trial", "What a trial shows."] in listed
    assert ["broken"] in listed
    assert any(words[0] == "table1" and len(words) == 2 for words in listed)


def test_a_run_ends_with_a_line_on_each_table(desk: Desk) -> None:
    desk.experiment("trial", figure=False)
    desk.experiment("failing", before="1 / 0", figure=False)
    done = desk("run", "trial", "failing", "--schemes", "slerp", "--out", "out")
    assert done.stdout == "trial: 1 row, 1 scheme.\n"
    done = desk("run", "figure1", "--out", "paper")
    assert done.stdout.startswith("figure1: ")


def test_help_imports_nothing_slow() -> None:
    python(
        "import sys; from quatspline.cli.commands import main; assert main(['--help']) == 0;"
        "slow = {'numpy', 'numba', 'scipy', 'pandas', 'matplotlib'} & set(sys.modules);"
        "assert not slow, slow"
    )


def test_list_imports_no_table_no_figure() -> None:
    python(
        "import sys; from quatspline.cli.commands import main; assert main(['list']) == 0;"
        "slow = {'pandas', 'matplotlib', 'tqdm'} & set(sys.modules); assert not slow, slow"
    )


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        ([], "the following arguments are required: COMMAND"),
        (["lisst"], "invalid choice: 'lisst'"),
        (["list", "--all"], "unrecognized arguments: --all"),
        (["run", "--quick", "--full"], "not allowed with argument"),
        (["run", "--seed", "-1"], "argument --seed: '-1': expected a whole number, at least 0"),
        (["run", "--jobs", "0"], "argument --jobs: '0': expected a whole number, at least 1"),
        (["run", "--jobs", "2", "--dask", "tcp://a:1"], "not allowed with argument"),
        (["run", "missing"], "unknown experiment 'missing'"),
        (["run", "erors"], "unknown experiment 'erors': did you mean 'errors'?"),
        (["run", "errors", "--schemes", "quartik"], "did you mean 'quartic'?"),
        (["run", "errors", "--schemes", ","], "--schemes: no name given"),
        (["compare", "k.csv", "--schemes", "", ","], "--schemes: no name given"),
        (["run", "errors", "--schemes", "broken"], "scheme 'broken' cannot be used"),
        (["run", "errors", "--out", "k.csv"], "no such folder can be made"),
        (["sample", "k.csv", "--scheme", "stairs"], "one of the arguments --rate --count"),
        (["sample", "k.csv", "--rate", "2"], "required: --scheme"),
        (["sample", "k.csv", "--scheme", "stares", "--count", "2"], "did you mean 'stairs'?"),
        (
            ["sample", "k.csv", "--scheme", "stairs", "--count", "0"],
            "expected a whole number, at least 1",
        ),
        (["sample", "k.csv", "--scheme", "stairs", "--rate", "nan"], "expected a positive number"),
        (
            ["sample", "k.csv", "--scheme", "stairs", "--rate", "fast"],
            "'fast': expected a positive number",
        ),
        (["sample", "k.csv", "--scheme", "stairs", "--rate", "1e308"], "samples are too many"),
        (["sample", "k.csv", "--scheme", "stairs", "--count", "10000000000"], "are too many"),
        (["sample", "k.csv", "--scheme", "stairs", "--count", "1" + 400 * "0"], "a whole number"),
        (
            ["sample", "k.csv", "--scheme", "stairs", "--count", "1_0"],
            "'1_0': expected a whole number",
        ),
        (["run", 5000 * "x"], "xxx..."),
        (["info", "\x1b[31m.csv"], r"quatspline: \x1b[31m.csv: cannot be read: No such file"),
        (["sample", "no.csv", "--scheme", "stairs", "--count", "2"], "no.csv: cannot be read"),
        (
            ["sample", "bad.csv", "--scheme", "stairs", "--count", "2"],
            "bad.csv, line 2: expected 5",
        ),
        (
            ["sample", "one.csv", "--scheme", "stairs", "--count", "2"],
            ": one.csv: quaternions has 1 ",
        ),
        (
            ["compare", "one.csv", "--schemes", "stairs"],
            ": one.csv: quaternions has 1 keyframe: at",
        ),
        (
            ["sample", "pair.csv", "--scheme", "three", "--count", "2"],
            ": pair.csv: quaternions has 2 ",
        ),
        (
            ["sample", "long.csv", "--scheme", "stairs", "--count", "2"],
            ": long.csv: times span -1e+308 to 1e+308: too long for float64",
        ),
        (
            ["sample", "return.npz", "--scheme", "stairs", "--count", "2"],
            ": return.npz: 3 times for 2 quaternions: an open motion has one time per keyframe; "
            "--closed takes the last time as that of the return",
        ),
        (["compare", "return.npz"], ": return.npz: 3 times for 2 quaternions: an open motion has"),
        (["compare", ""], "quatspline: '': a blank name is no file's"),
        (["sample", " ", "--scheme", "stairs", "--count", "2"], ": ' ': a blank name is no file's"),
        (["sample", "k.csv", "--scheme", "stairs", "--count", "2", "-o", ""], ": '': a blank name"),
        (["compare", "."], "quatspline: .: unknown suffix ''"),
        (["sample", "k.csv", "--scheme", "stairs", "--count", "2", "-o", "x.png"], "suffix '.png'"),
        (["sample", "k.csv", "--scheme", "stairs", "--count", "2", "-o", "n/x.csv"], "be written"),
        (
            ["sample", "uneven.csv", "--scheme", "stairs", "--count", "2", "--closed"],
            ": uneven.csv: closed",
        ),
    ],
)
def test_bad_usage_and_bad_input_are_told_in_one_line(
    desk: Desk, arguments: list[str], what: str
) -> None:
    desk.experiment("errors")
    desk.scheme("stairs")
    desk.scheme("three", claims="min_keyframes = 3")
    (desk.folder / "schemes" / "broken.py").write_text("import nothing_of_this_name")
    desk.keyframes()
    desk.keyframes("bad.csv", "0,1,0,0,0\n1,1,0\n")
    desk.keyframes("one.csv", "0,1,0,0,0\n")
    desk.keyframes("pair.csv")
    closed = {"times": [0, 1, 2], "quaternions": [[1, 0, 0, 0], [0.8, 0.6, 0, 0]]}
    np.savez(desk.folder / "return.npz", **closed)
    desk.keyframes("long.csv", "-1e308,1,0,0,0\n1e308,0.8,0.6,0,0\n")
    desk.keyframes("uneven.csv", "0,1,0,0,0\n1,0.8,0.6,0,0\n5,0.6,0.8,0,0\n")
    done = desk(*arguments)
    told = refused(done)
    assert what in told
    assert len(told) < 400
    assert told.strip("\n").isprintable()
    assert done.stdout == ""


def test_files_that_no_reader_unpacks_are_told_in_one_line(desk: Desk) -> None:
    path = desk.folder / "k.npz"
    np.savez_compressed(path, times=[0.0, 1.0], quaternions=[[1.0, 0, 0, 0], [0.8, 0.6, 0, 0]])
    whole = path.read_bytes()
    flags, methods = ((6, 8), b"\x01"), ((8, 10), b"\x63")
    for (local, central), value in (flags, methods):
        damaged = bytearray(whole)
        for mark, offset in ((b"PK\x03\x04", local), (b"PK\x01\x02", central)):
            for at in range(len(whole)):
                if whole.startswith(mark, at):
                    damaged[at + offset : at + offset + 1] = value
        path.write_bytes(damaged)
        line = refused(desk("sample", "k.npz", "--scheme", "slerp", "--count", "2"))
        assert line.startswith("quatspline: k.npz: not an NPZ file of plain arrays: it")


def test_every_malformed_line_is_told(desk: Desk) -> None:
    desk.scheme("stairs")
    for line in ("1,1,0,0", "1,a,0,0,0", "1,nan,0,0,0", "1,2,0,0,0", "0,1,0,0,0"):
        path = desk.keyframes("k.csv", f"t,qw,qx,qy,qz\n0,1,0,0,0\n{line}\n")
        done = desk("sample", path, "--scheme", "stairs", "--count", 3)
        assert refused(done).startswith(f"quatspline: {path}, line 3: ")
        assert done.stdout == ""


# -- list ---------------------------------------------------------------------------------------


def test_list_shows_claims_and_the_unusable_with_reason(desk: Desk) -> None:
    desk.scheme("stairs")
    (desk.folder / "schemes" / "broken.py").write_text("import nothing_of_this_name")
    desk.scheme("far_peer", claims='peer = "no-such-thing"')
    done = desk("list")
    assert done.returncode == 0
    lines = {line.split()[0]: line for line in done.stdout.splitlines()}
    assert lines["quartic"].split()[1:4] == ["C2", "yes", "2"]
    assert lines["stairs"].endswith("Stairs")
    assert "n/a: ModuleNotFoundError: No module named 'nothing_of_this_name'" in lines["broken"]
    assert "n/a: no-such-thing is not installed" in lines["far-peer"]


def test_a_scheme_without_a_claim_does_not_stop_the_list(desk: Desk) -> None:
    desk.scheme("stairs")
    path = desk.folder / "schemes" / "stairs.py"
    path.write_text(path.read_text().replace('constant_rate = "no"', "pass"))
    assert (
        "?" in next(x for x in desk("list").stdout.splitlines() if x.startswith("stairs")).split()
    )


def test_a_reader_that_stops_early_is_no_error(desk: Desk) -> None:
    desk.scheme("stairs")
    desk.keyframes()
    pipe = subprocess.PIPE
    with subprocess.Popen(
        command("sample", "k.csv", "--scheme", "stairs", "--count", 300_000),
        cwd=desk.folder,
        env=environment(**desk.environment),
        stdout=pipe,
        stderr=pipe,
        text=True,
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        assert process.stdout.readline() == "t,qw,qx,qy,qz\n"
        process.stdout.close()
        assert process.stderr.read() == ""
    assert process.returncode == 0


# -- sample -------------------------------------------------------------------------------------


def test_sample_writes_csv_to_stdout(desk: Desk) -> None:
    desk.scheme("stairs")
    done = desk("sample", desk.keyframes(), "--scheme", "stairs", "--rate", 2)
    assert done.returncode == 0, done.stderr
    assert done.stdout == (
        "t,qw,qx,qy,qz\n0.0,1.0,0.0,0.0,0.0\n0.5,1.0,0.0,0.0,0.0\n1.0,0.8,0.6,0.0,0.0\n"
    )


def test_sample_evaluates_the_scheme(desk: Desk) -> None:
    q = np.array([[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0.6, 0, 0.8, 0]])
    np.savez(desk.folder / "k.npz", times=[0.0, 1.0, 2.5], quaternions=q)
    done = desk("sample", "k.npz", "--scheme", "quartic", "--count", 11, "-o", "out.npz")
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""
    samples = files.read(desk.folder / "out.npz")
    expected = quatspline.build("quartic", [0.0, 1.0, 2.5], q)(samples.times)
    np.testing.assert_array_equal(samples.times, np.linspace(0.0, 2.5, 11))
    np.testing.assert_array_equal(samples.quaternions[:, 0], expected)


def test_sample_carries_positions_to_tum(desk: Desk) -> None:
    desk.scheme("stairs")
    tum = desk.keyframes("k.tum", "5 0 0 0 0 0 0 1\n7 4 2 0 0.6 0 0 0.8\n")
    assert desk("sample", tum, "--scheme", "stairs", "--count", 5, "-o", "a.tum").returncode == 0
    assert desk("sample", tum, "--scheme", "stairs", "--count", 5, "-o", "b.csv").returncode == 0
    assert (
        desk("sample", "b.csv", "--scheme", "stairs", "--count", 5, "-o", "c.txt").returncode == 0
    )
    np.testing.assert_allclose(
        files.read(desk.folder / "a.tum").positions[:, 0, 0], [0, 1, 2, 3, 4]
    )
    np.testing.assert_allclose(
        files.read(desk.folder / "c.txt").positions[:, 0, 0], [0, 1, 2, 3, 4]
    )


def test_sample_carries_positions_in_every_format_and_names_what_it_does_not(desk: Desk) -> None:
    desk.scheme("stairs")
    text = "t,x,y,z,qw,qx,qy,qz,label\n0,5,6,7,1,0,0,0,a\n2,7,8,9,0.8,0.6,0,0,b\n"
    path = desk.keyframes("k.csv", text)
    done = desk("sample", path, "--scheme", "stairs", "--count", 3)
    assert done.returncode == 0
    assert done.stderr == f"quatspline: {path}: not read: 'label'\n"
    assert done.stdout.splitlines()[:3] == [
        "t,qw,qx,qy,qz,tx,ty,tz",
        "0.0,1.0,0.0,0.0,0.0,5.0,6.0,7.0",
        "1.0,1.0,0.0,0.0,0.0,6.0,7.0,8.0",
    ]
    for suffix in (".tum", ".npz"):
        out = desk.folder / f"out{suffix}"
        assert desk("sample", path, "--scheme", "stairs", "--count", 3, "-o", out).returncode == 0
        expected = [[5, 6, 7], [6, 7, 8], [7, 8, 9]]
        np.testing.assert_array_equal(files.read(out).positions[:, 0], expected)


def test_sample_of_integer_stamps_is_at_whole_stamps(desk: Desk) -> None:
    epoch = 1_650_000_000_000_000_001
    rows = f"timestamp_ns,w,x,y,z\n{epoch},1,0,0,0\n{epoch + 100},0.8,0.6,0,0\n"
    path = desk.keyframes("k.csv", rows)
    done = desk("sample", path, "--scheme", "slerp", "--count", 4)
    assert (done.returncode, done.stderr) == (0, "")
    _, *lines = (line.split(",") for line in done.stdout.splitlines())
    assert [int(t) - epoch for t, *_ in lines] == [0, 33, 67, 100]
    half = np.arccos(0.8)
    expected = [np.cos(half * share) for share in (0, 0.33, 0.67, 1)]
    np.testing.assert_allclose([float(w) for _, w, *_ in lines], expected, atol=1e-14)
    done = desk("sample", path, "--scheme", "slerp", "--rate", 3e7, "-o", "out.npz")
    times = files.read(desk.folder / "out.npz").stamps
    assert times.dtype == np.int64
    assert (times - epoch).tolist() == [0, 33, 67, 100]


def test_sample_tells_which_reading_of_a_closed_motion_was_taken(desk: Desk) -> None:
    desk.scheme("stairs")
    rows = "0,1,0,0,0\n1,0.8,0.6,0,0\n2,0.6,0.8,0,0\n3,0.999999995,0.0001,0,0\n"
    path = desk.keyframes("k.csv", rows)
    done = desk("sample", path, "--scheme", "stairs", "--rate", 1, "--closed")
    assert done.returncode == 0
    assert done.stdout.splitlines()[-1] == "4.0,1.0,0.0,0.0,0.0"
    assert done.stderr == (
        f"quatspline: {path}: closed: the last row is 0.011 degrees from the first orientation; it "
        "is kept as a keyframe, and the curve returns one step later "
        "(to return at that row, make it equal to the first)\n"
    )


def test_sample_of_a_closed_curve_returns(desk: Desk) -> None:
    desk.scheme("stairs")
    rows = "0,1,0,0,0\n1,0.8,0.6,0,0\n2,0.6,0.8,0,0\n"
    done = desk(
        "sample", desk.keyframes("k.csv", rows), "--scheme", "stairs", "--rate", 1, "--closed"
    )
    assert done.stdout.splitlines()[-1] == "3.0,1.0,0.0,0.0,0.0"
    repeated = desk.keyframes("r.csv", f"{rows}5,-1,0,0,0\n")
    done = desk("sample", repeated, "--scheme", "stairs", "--count", 2, "--closed")
    assert done.stdout.splitlines()[-1] == "5.0,1.0,0.0,0.0,0.0"


def test_a_solve_that_does_not_converge_is_one_line_and_status_1(desk: Desk) -> None:
    desk.scheme("stairs", fit=FAILING)
    done = desk("sample", desk.keyframes(), "--scheme", "stairs", "--count", 2)
    assert "ConvergenceError: stairs (jacobi) did not converge" in refused(done, status=1)


def test_what_nobody_foresaw_is_status_1_with_its_traceback(desk: Desk) -> None:
    desk.scheme("stairs", fit="raise ZeroDivisionError('oops')")
    done = desk("sample", desk.keyframes(), "--scheme", "stairs", "--count", 2)
    assert done.returncode == 1
    assert done.stderr.endswith("quatspline: ZeroDivisionError: oops\n")


@pytest.mark.parametrize(
    ("first", "last", "rate", "expected"),
    [
        (0.0, 1.0, 4.0, [0, 0.25, 0.5, 0.75, 1]),
        (0.0, 0.29, 100.0, np.arange(30) / 100),  # 0.29 * 100 is 28.999999999999996
        (0.0, 1.0, 0.7, [0]),
        (1e9, 1e9 + 0.3, 10.0, 1e9 + np.arange(4) / 10),
        (-1.0, 0.05, 10.0, -1 + np.arange(11) / 10),
    ],
)
def test_rate_samples_from_the_start_to_the_end_where_it_lands(
    first: float, last: float, rate: float, expected: np.ndarray
) -> None:
    times = sample_times(first, last, rate, None)
    np.testing.assert_allclose(times, expected, rtol=0, atol=4 * np.spacing(abs(first) + 1.0))
    assert times.max() <= last


def test_count_samples_both_ends() -> None:
    np.testing.assert_array_equal(sample_times(2.0, 4.0, None, 3), [2, 3, 4])
    np.testing.assert_array_equal(sample_times(2.0, 4.0, None, 1), [2])


# -- run ----------------------------------------------------------------------------------------


def outputs(name: str) -> set[str]:
    return {f"{name}{end}" for end in (".csv", ".md", ".png", ".svg", ".caption.txt")}


def test_run_writes_everything(desk: Desk) -> None:
    desk.experiment("first_errors")
    done = desk("run", "first-errors", "--seed", 3, "--schemes", "slerp,quartic")
    assert done.returncode == 0, done.stderr
    folder = desk.folder / "results"
    assert set(os.listdir(folder)) == outputs("first-errors") | {"manifest.json"}
    assert (
        (folder / "first-errors.md")
        .read_text()
        .startswith("# The first_errors\n\nAs ever. Size: quick; seed 3.\n\n| ")
    )
    assert (folder / "first-errors.caption.txt").read_text() == "2 rows, from quartic.\n"
    manifest = desk.manifest()
    assert manifest["command"][1:] == [
        "run",
        "first-errors",
        "--seed",
        "3",
        "--schemes",
        "slerp,quartic",
    ]
    assert manifest["seeds"] == {"seed": 3}
    assert set(manifest["files"]) == outputs("first-errors")
    assert manifest["end"] is not None


def test_two_runs_with_one_seed_write_the_same_bytes(desk: Desk) -> None:
    desk.experiment("errors")
    for out, seed in (("one", 1), ("two", 1), ("three", 2)):
        assert desk("run", "errors", "--out", out, "--seed", seed).returncode == 0
    for file in outputs("errors"):
        one, two = ((desk.folder / out / file).read_bytes() for out in ("one", "two"))
        assert one == two, file
    three = (desk.folder / "three" / "errors.csv").read_bytes()
    assert three != (desk.folder / "two" / "errors.csv").read_bytes()


def test_the_figure_is_drawn_from_the_file_alone(desk: Desk) -> None:
    desk.experiment("errors")
    path = desk.folder / "experiments" / "errors.py"
    check = "def draw(table):\n    assert list(table['scheme']) == ['a', 'b'], 'as measured'\n"
    path.write_text(path.read_text().replace("def draw(table):\n", check))
    assert desk("run", "errors").returncode == 0  # measured as b, a; sorted in the file


@pytest.mark.parametrize(
    ("option", "sizes"),
    [
        ([], {"paper": "full", "other": "quick"}),
        (["--quick"], {"paper": "quick", "other": "quick"}),
        (["--full"], {"paper": "full", "other": "full"}),
    ],
)
def test_sizes(desk: Desk, option: list[str], sizes: dict[str, str]) -> None:
    note = 'with open("sizes", "a") as log: log.write(f"{TITLE} {run.quick}\\n")'
    desk.experiment("paper", note, paper=True, figure=False)
    desk.experiment("other", note, figure=False)
    assert desk("run", "other", "paper", *option).returncode == 0
    assert desk.manifest()["sizes"] == sizes
    said = {"The paper": sizes["paper"] == "quick", "The other": sizes["other"] == "quick"}
    lines = (desk.folder / "sizes").read_text().splitlines()
    assert lines == [f"The other {said['The other']}", f"The paper {said['The paper']}"]


def test_without_names_all_run_and_the_papers_first(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk.experiment("a")
    desk.experiment("z", paper=True)
    (desk.folder / "experiments" / "_shared.py").write_text("raise RuntimeError")
    monkeypatch.setenv("QUATSPLINE_EXPERIMENTS", str(desk.folder / "experiments"))
    names = [e.name for e in running.experiments()]
    assert {"a", "z"} <= set(names)
    assert names.index("z") < names.index("a")
    assert [e.name for e in running.experiments(["a", "z", "a"])] == ["a", "z"]


def test_two_experiments_of_one_name_are_refused(desk: Desk) -> None:
    (desk.folder / "more").mkdir()
    desk.experiment("a")
    (desk.folder / "more" / "a.py").write_text("")
    both = os.pathsep.join(str(desk.folder / name) for name in ("experiments", "more"))
    desk.environment["QUATSPLINE_EXPERIMENTS"] = both
    assert "two experiments are called 'a'" in refused(desk("run", "a"))


def test_derived_tables_follow_those_they_are_made_of(desk: Desk) -> None:
    desk.experiment("errors", figure=False)
    (desk.folder / "experiments" / "total.py").write_text(DERIVED)
    alone = refused(desk("run", "total"), status=1)
    assert "FileNotFoundError" in alone
    assert desk("run", "total", "errors", "--full").returncode == 0
    folder = desk.folder / "results"
    for seed in (1, 2):
        assert desk("run", "errors", "--seed", seed).returncode == 0
        errors, total = (pd.read_csv(folder / f"{name}.csv") for name in ("errors", "total"))
        assert total["x"].item() == pytest.approx(errors["x"].sum())
        assert desk.manifest()["sizes"] == {"errors": "quick", "total": "full"}


@pytest.mark.parametrize(
    ("broken", "reason", "left"),
    [
        ("measure", "ZeroDivisionError: division by zero (bad.py:6)", set()),
        ("load", "ModuleNotFoundError: No module named 'nothing_of_this_name'", set()),
        ("draw", "KeyError: 'y'", {"bad.csv", "bad.md", "bad.caption.txt"}),
        ("nothing", "TypeError: no function measure(run), nor cells(run)", set()),
        ("empty", "TypeError: measure returned an empty table", set()),
    ],
)
def test_a_failing_experiment_is_told_and_the_rest_run(
    desk: Desk, broken: str, reason: str, left: set[str]
) -> None:
    desk.experiment("bad")
    desk.experiment("good")
    assert desk("run", "bad").returncode == 0  # its files must not pass for those of a later run
    path = desk.folder / "experiments" / "bad.py"
    text = path.read_text()
    path.write_text(
        {
            "measure": text.replace("    pass\n", "    1 / 0\n"),
            "load": "import nothing_of_this_name\n",
            "draw": text.replace('plot(table["x"])', 'plot(table["y"])'),
            "nothing": "TITLE = 'x'\n",
            "empty": text.replace("    pass\n", "    return pd.DataFrame()\n"),
        }[broken]
    )
    done = desk("run", "bad", "good")
    assert done.returncode == 1
    failures = [line for line in done.stderr.splitlines() if "failed" in line]
    assert len(failures) == 1
    assert failures[0].startswith(f"bad: failed: {reason}")
    assert "Traceback" not in done.stderr
    found = set(os.listdir(desk.folder / "results"))
    assert found == left | {"bad.error.txt", "manifest.json"} | outputs("good")
    assert "Traceback" in (desk.folder / "results" / "bad.error.txt").read_text()
    assert desk.manifest()["experiments"]["bad"]["failure"].startswith(reason)
    assert desk.manifest()["experiments"]["good"]["failure"] is None


# -- interruption -------------------------------------------------------------------------------

STOP_ONCE = f"""import os, signal
    from quatspline.system.ending import Ended
    stop = not os.path.exists("second.count")
    {count("second")}
    if stop:
        raise Ended(signal.SIGINT)"""


def interrupted(desk: Desk) -> None:
    """A run of which the first experiment finished and the second was stopped."""
    desk.experiment("first", count("first"), figure=False)
    desk.experiment("second", STOP_ONCE, figure=False)
    done = desk("run", "first", "second")
    assert done.returncode == 130
    assert done.stderr.splitlines()[1:] == [
        "quatspline: interrupted: the same command resumes where it stopped"
    ]
    assert (desk.folder / "results" / ".journal.json").is_file()
    assert desk.manifest()["end"] is None
    assert (desk.counted("first"), desk.counted("second")) == (1, 1)


def test_an_interrupted_run_goes_on_where_it_stopped(desk: Desk) -> None:
    interrupted(desk)
    before = (desk.folder / "results" / "first.csv").read_bytes()
    done = desk("run", "first", "second")
    assert done.returncode == 0, done.stderr
    assert "first: kept as finished by the interrupted run" in done.stderr
    assert (desk.counted("first"), desk.counted("second")) == (1, 2)
    assert (desk.folder / "results" / "first.csv").read_bytes() == before
    tables = {f"{name}.{end}" for name in ("first", "second") for end in ("csv", "md")}
    assert set(desk.manifest()["files"]) == tables
    assert set(desk.manifest()["sizes"]) == {"first", "second"}
    assert not (desk.folder / "results" / ".journal.json").exists()


def test_a_complete_run_is_not_skipped(desk: Desk) -> None:
    interrupted(desk)
    for _ in range(2):
        assert desk("run", "first", "second").returncode == 0
    assert (desk.counted("first"), desk.counted("second")) == (2, 3)


@pytest.mark.parametrize("change", ["seed", "size", "schemes", "source", "file", "lost"])
def test_whatever_changed_is_measured_again(desk: Desk, change: str) -> None:
    interrupted(desk)
    path = desk.folder / "experiments" / "first.py"
    if change == "source":
        path.write_text(path.read_text() + "# edited\n")
    if change == "file":
        (desk.folder / "results" / "first.csv").write_text("edited")
    if change == "lost":
        (desk.folder / "results" / "first.md").unlink()
    options = {"seed": ["--seed", "1"], "size": ["--full"], "schemes": ["--schemes", "quartic"]}
    options["file"] = ["--force"]  # what was edited since is the user's
    done = desk("run", "first", "second", *options.get(change, []))
    assert done.returncode == 0, done.stderr
    assert desk.counted("first") == 2


HELD_ONCE = f"""import os, time
    held = not os.path.exists("second.count")
    {count("second")}
    time.sleep(600 * held)"""


def test_a_killed_run_goes_on_too(desk: Desk) -> None:
    desk.experiment("first", count("first"), figure=False)
    desk.experiment("second", HELD_ONCE, figure=False)
    with subprocess.Popen(
        command("run", "first", "second"),
        cwd=desk.folder,
        env=environment(**desk.environment),
        stderr=subprocess.DEVNULL,
    ) as process:
        wait_until(lambda: desk.counted("second") == 1 or process.poll() is not None)
        process.send_signal(signal.SIGKILL)
    assert process.returncode == -signal.SIGKILL
    assert desk("run", "first", "second").returncode == 0
    assert (desk.counted("first"), desk.counted("second")) == (1, 2)


def wait_until(condition: Callable[[], bool]) -> None:
    while not condition():
        time.sleep(0.01)


# -- what experiments are given -----------------------------------------------------------------


def test_random_numbers_depend_on_seed_and_names_alone() -> None:
    run = running.Run(quick=True, seed=5)
    first = run.rng("case", 3).random(4)
    run.rng("other").random(100)
    np.testing.assert_array_equal(run.rng("case", 3).random(4), first)
    for other in (run.rng("case", 4), run.rng("case3"), running.Run(quick=True).rng("case", 3)):
        assert not np.array_equal(other.random(4), first)


def test_progress_hands_on_the_items_and_says_nothing_when_quick(
    capsys: pytest.CaptureFixture[str],
) -> None:
    run = running.Run(quick=True)
    assert list(run.progress(range(3), 3, "cases")) == [0, 1, 2]
    assert list(run.progress(iter("ab"))) == ["a", "b"]
    assert capsys.readouterr() == ("", "")


def test_progress_shows_what_takes_long(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(experiment, "PATIENCE", 1e-9)
    for _ in running.Run(quick=True).progress(range(3), 3, "cases"):
        time.sleep(0.001)
    assert "cases" in capsys.readouterr().err


def test_a_run_can_be_called_from_python(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    desk.experiment("errors")
    monkeypatch.setenv("QUATSPLINE_EXPERIMENTS", str(desk.folder / "experiments"))
    assert running.run(["errors"], out=desk.folder / "out", size="full") == []
    table = pd.read_csv(desk.folder / "out" / "errors.csv")
    assert table["scheme"].tolist() == ["a", "b"]


def test_a_run_of_no_schemes_is_refused(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    desk.experiment("errors")
    monkeypatch.setenv("QUATSPLINE_EXPERIMENTS", str(desk.folder / "experiments"))
    with pytest.raises(ValueError, match=r"^schemes: no name given$"):
        running.run(["errors"], schemes=[], out=desk.folder / "out")
    assert not (desk.folder / "out").exists()
