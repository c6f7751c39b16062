"""The results directory: tables, figures, manifest, journal."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

import quatspline
from quatspline.runs import provenance as module
from quatspline.runs.journal import Journal
from quatspline.runs.manifest import sha256
from quatspline.runs.results import Results, markdown


@pytest.fixture
def results(tmp_path: Path) -> Results:
    return Results(tmp_path / "deep" / "results")


def table() -> pd.DataFrame:
    return pd.DataFrame(
        {
            "scheme": ["slerp", "quartic", "quartic"],
            "frames": [3, 20, 3],
            "error": [1.0 / 3.0, np.nan, -0.0],
            "reason": [None, "n/a | none\nat all", None],
            "repeats": [1, 2, 3],
        }
    )


# -- tables -------------------------------------------------------------------------------------


def test_a_table_is_sorted_formatted_and_keeps_failures(results: Results) -> None:
    results.table("errors", table())
    assert (results.folder / "errors.csv").read_text() == (
        "scheme,frames,error,reason,repeats\n"
        "quartic,3,0,,3\n"
        'quartic,20,,"n/a | none\nat all",2\n'
        "slerp,3,0.333333333333,,1\n"
    )


def test_a_table_does_not_depend_on_the_order_of_measurement(results: Results) -> None:
    results.table("one", table())
    results.table("two", table().iloc[::-1])
    for end in ("csv", "md"):
        pair = [(results.folder / f"{name}.{end}").read_bytes() for name in ("one", "two")]
        assert pair[0] == pair[1]


def test_rows_that_tie_keep_their_order(results: Results) -> None:
    frame = pd.DataFrame({"scheme": ["b", "a", "b"], "step": [3.0, 2.0, 1.0], "repeats": [9, 8, 7]})
    assert results.table("t", frame)["step"].tolist() == [2, 3, 1]
    assert results.table("t", frame, keys=["scheme", "step"])["step"].tolist() == [2, 1, 3]
    assert results.table("t", frame, keys=[])["step"].tolist() == [3, 2, 1]
    led_by_floats = frame[["step", "scheme"]]
    assert results.table("t", led_by_floats)["step"].tolist() == [2, 3, 1]


def test_numbers_and_text_in_one_key_sort(results: Results) -> None:
    frame = pd.DataFrame({"case": pd.Series([2, "all", 10], dtype=object), "x": [0.5, 1.5, 2.5]})
    assert results.table("t", frame)["x"].tolist() == [2.5, 0.5, 1.5]


def test_a_table_is_read_back_as_it_was(results: Results) -> None:
    frame = pd.DataFrame(
        {"name": ["NA", "None", "nan"], "x": [np.inf, np.nan, 1e-300], "n": [1, 2, 3]}
    )
    read = results.table("t", frame)
    pd.testing.assert_frame_equal(read, frame, check_dtype=False)
    pd.testing.assert_frame_equal(results.read_table("t"), read)


def test_markdown_has_title_note_formats_and_escapes(results: Results) -> None:
    results.table("errors", table(), title="Errors", note="Size: quick.", formats={"error": ".1e"})
    assert (results.folder / "errors.md").read_text() == (
        "# Errors\n\nSize: quick.\n\n"
        "| scheme | frames | error | reason | repeats |\n"
        "| --- | ---: | ---: | --- | ---: |\n"
        "| quartic | 3 | 0.0e+00 |  | 3 |\n"
        "| quartic | 20 |  | n/a \\| none at all | 2 |\n"
        "| slerp | 3 | 3.3e-01 |  | 1 |\n"
    )


def test_markdown_shows_four_digits() -> None:
    frame = pd.DataFrame({"x": [123456.0, 0.25], "ok": [True, False]})
    assert markdown(frame).splitlines()[2:] == ["| 1.235e+05 | True |", "| 0.25 | False |"]


# -- figures ------------------------------------------------------------------------------------

DRAW = """
import sys
from matplotlib.figure import Figure
from quatspline.runs.results import Results
figure = Figure()
axes = figure.subplots()
axes.plot([0, 1], [0, 1], label="a")
axes.fill_between([0, 1], [0, 1])
axes.legend()
Results(sys.argv[1]).figure("figure1", figure)
"""


def test_figures_are_the_same_bytes_in_every_process(tmp_path: Path) -> None:
    for folder in ("one", "two"):
        subprocess.run([sys.executable, "-c", DRAW, str(tmp_path / folder)], check=True)
    for kind in ("png", "svg"):
        one, two = ((tmp_path / f / f"figure1.{kind}").read_bytes() for f in ("one", "two"))
        assert one == two
    svg = (tmp_path / "one" / "figure1.svg").read_text()
    assert "clip-path" in svg  # named by salted hashes: what would differ
    assert "<dc:date>" not in svg
    assert sorted(os.listdir(tmp_path / "one")) == ["figure1.png", "figure1.svg"]


def test_a_figure_that_cannot_be_drawn_leaves_the_old_one(results: Results) -> None:
    class Broken(Figure):
        def savefig(self, fname, **_) -> None:
            Path(fname).write_bytes(b"half")
            raise RuntimeError("no ink")

    results.figure("f", Figure())
    before = results.outputs("f")
    assert set(before) == {"f.png", "f.svg"}
    with pytest.raises(RuntimeError, match="no ink"):
        results.figure("f", Broken())
    assert results.outputs("f") == before
    assert sorted(os.listdir(results.folder)) == ["f.png", "f.svg"]


# -- manifest -----------------------------------------------------------------------------------


def manifest(results: Results) -> dict:
    return json.loads((results.folder / "manifest.json").read_text())


def test_the_manifest_holds_the_circumstances_and_every_file(results: Results) -> None:
    (results.folder / "reference").mkdir()
    results.begin(["quatspline", "run"], seed=7)
    assert manifest(results)["end"] is None
    results.table("errors", table())
    results.record("errors", {"title": "Errors", "size": "quick", "failure": None})
    results.finish()
    found = manifest(results)
    assert found["command"] == ["quatspline", "run"]
    assert found["seeds"] == {"seed": 7}
    assert found["sizes"] == {"errors": "quick"}
    assert found["start"] <= found["end"]
    assert found["cpu"]["model"]
    assert found["cpu"]["cores"] >= 1
    assert found["versions"]["quatspline"] == quatspline.__version__
    assert found["versions"]["numpy"] == np.__version__
    assert {"python", "scipy", "numba", "pandas", "matplotlib"} <= set(found["versions"])
    files = {name: sha256(results.folder / name) for name in ("errors.csv", "errors.md")}
    assert found["files"] == files == found["experiments"]["errors"]["files"]


def test_a_page_added_later_enters_the_manifest(results: Results) -> None:
    results.begin(["quatspline", "run"])
    results.finish()
    again = Results(results.folder)
    page = again.text("report.html", "<p>ε</p>\n")
    again.refresh()
    assert manifest(results)["files"] == {"report.html": sha256(page)}
    assert manifest(results)["command"] == ["quatspline", "run"]


def test_entries_of_earlier_runs_stay_while_their_files_do(results: Results) -> None:
    results.begin(["first"])
    for name in ("kept", "edited"):
        results.table(name, table())
        results.record(name, {"size": "full"})
    results.finish()
    results.text("edited.md", "by hand")
    again = Results(results.folder)
    again.begin(["second"])
    again.finish()
    assert set(manifest(again)["experiments"]) == {"kept"}
    assert set(manifest(again)["files"]) == {"kept.csv", "kept.md", "edited.csv", "edited.md"}


def test_git_is_told_for_a_checkout_of_our_own_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = tmp_path / "src" / "quatspline" / "report" / "provenance.py"
    source.parent.mkdir(parents=True)
    source.write_text("")
    monkeypatch.setattr(module, "__file__", str(source))
    assert module.git_revision() is None
    git = ["git", "-C", str(tmp_path), "-c", "user.name=a", "-c", "user.email=a@b"]
    for command in (["init", "-q"], ["add", "."], ["commit", "-qm", "x"]):
        subprocess.run([*git, *command], check=True)
    found = module.git_revision()
    assert found is not None
    assert len(found["revision"]) == 40
    assert found["dirty"] is False
    source.write_text("edited")
    assert module.git_revision() == found | {"dirty": True}


def test_sweep_removes_what_an_earlier_run_left(results: Results) -> None:
    results.begin(["first"])
    results.table("a", table())
    results.text("a.error.txt", "old")
    results.text("ab.csv", "another experiment")
    (results.folder / "a.png").write_text("of somebody else")
    again = Results(results.folder)
    again.begin(["second"])
    again.table("a", table())
    again.tidy("a")
    left = ["a.csv", "a.md", "a.png", "ab.csv", "manifest.json"]
    assert sorted(os.listdir(results.folder)) == left


def test_a_folder_that_cannot_be_made_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ValueError, match="no such folder can be made"):
        Results(tmp_path / "file")


# -- journal ------------------------------------------------------------------------------------


def test_a_journal_remembers_for_the_same_fingerprint_only(results: Results) -> None:
    results.table("a", table())
    entry = {"size": "quick", "files": results.outputs("a")}
    Journal(results, "print").add("a", entry)
    assert Journal(results, "print").finished("a") == entry
    assert Journal(results, "print").finished("b") is None
    assert Journal(results, "other").finished("a") is None


@pytest.mark.parametrize("harm", ["edit", "remove"])
def test_a_journal_does_not_trust_files_that_changed(results: Results, harm: str) -> None:
    results.table("a", table())
    journal = Journal(results, "print")
    journal.add("a", {"files": results.outputs("a")})
    path = results.folder / "a.md"
    path.write_text("edited") if harm == "edit" else path.unlink()
    assert Journal(results, "print").finished("a") is None


def test_a_journal_altered_by_a_digit_is_not_believed(results: Results) -> None:
    Journal(results, "print").add("a", {"seconds": 12, "files": {}})
    path = results.folder / ".journal.json"
    path.write_text(path.read_text().replace("12", "13"))
    assert Journal(results, "print").finished("a") is None


def test_a_closed_journal_is_gone(results: Results) -> None:
    journal = Journal(results, "print")
    journal.add("a", {"files": {}})
    assert (results.folder / ".journal.json").is_file()
    journal.close()
    assert os.listdir(results.folder) == []
