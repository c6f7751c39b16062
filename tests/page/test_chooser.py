"""The chooser and Table 1 as they stand in the page: the documentation's questions, the tables' answers."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from pages import Elements
from quatspline.findings.choices import CHOICES
from quatspline.findings.decisions import decisions
from quatspline.findings.quotes import Quote
from quatspline.page import write_page
from quatspline.page.chooser import COLUMNS, chooser, facts, failure
from quatspline.page.derivations import Derivations
from quatspline.page.folder import Folder
from quatspline.page.reference import reference
from quatspline.page.speed import speed as bounds
from quatspline.page.table1 import side_by_side
from quatspline.runs.results import Results
from quatspline.trajectories.paper import CASES
from tools.readme import REFERENCE

DOCS = REFERENCE.parents[1] / "docs"


@pytest.fixture(scope="module")
def folder(page_folder: Path) -> Folder:
    return Folder(page_folder)


def qualified(folder: Folder, **answers: str) -> list[str]:
    """Schemes that meet answers, by the conditions themselves."""
    rows = facts(folder)
    for choice in CHOICES:
        for answer in choice.answers:
            if answers.get(choice.key) == answer.key:
                for condition in answer.conditions:
                    rows = rows[condition(rows, {}).astype(bool)]
    return list(rows["scheme"])


def test_every_question_is_a_heading_of_the_documentation() -> None:
    headings = (DOCS / "choosing.md").read_text(encoding="utf-8").splitlines()
    assert {f"## {choice.text}" for choice in CHOICES} <= set(headings)


def test_a_decision_is_the_first_row_of_its_answers(folder: Folder) -> None:
    """The first decision: C2 wherever measured, local, of least torque."""
    sentence = next(iter(decisions(folder.frame("choosing"))))
    named = next(part for part in sentence if isinstance(part, Quote))
    assert qualified(folder, rates="acceleration", live="yes", large="yes")[0] == named.value


def test_rows_have_nine_columns_and_say_whose_a_scheme_is(folder: Folder) -> None:
    made = chooser(folder)
    assert len(COLUMNS) == 9
    rows = {row["scheme"]: row["cells"] for row in made["rows"]}
    assert set(rows) == set(folder.frame("choosing")["scheme"])
    assert {len(cells) for cells in rows.values()} == {len(COLUMNS) - 1}
    whose = {name: rows[name]["origin"]["text"] for name in ("quartic", "local-quintic", "kim")}
    assert whose == {"quartic": "the paper's", "local-quintic": "ours", "kim": "published"}
    assert rows["scipy-slerp"]["origin"]["text"] == "library: scipy"
    assert rows["local-quintic"]["local"]["text"] == "8 keyframes, 3 ahead"
    assert rows["slerp"]["torque"]["text"] == "∞"


@pytest.mark.parametrize(
    ("noted", "said"),
    [
        ("leaps: 170 degrees, uniform; solves 0 %: x", "leaps at steps of 170 degrees, even times"),
        (None, "none found"),
        ("error: exact half-turns", "raises an error: exact half-turns"),
        (
            "solves 0 %: 33 keyframes, 150 degrees, unevenness 30",
            "solves 0 % of the sets of 33 keyframes with steps of 150 degrees, spacings up to 30 : 1",
        ),
    ],
)
def test_failures_are_said_in_words(noted: str | None, said: str) -> None:
    assert failure({"passes_keys": "yes", "worst_failure": noted}) == said


def test_what_was_not_measured_cannot_be_asked(tmp_path: Path) -> None:
    shutil.copy(REFERENCE / "choosing.csv", tmp_path)
    made = chooser(Folder(tmp_path))
    assert [q["key"] for q in made["questions"] if not q["known"]] == ["holds"]


def test_derivations_are_linked_from_folders_beside_the_documentation(tmp_path: Path) -> None:
    beside = Derivations(REFERENCE)
    for scheme in ("quartic", "squad", "scipy-slerp"):
        assert (REFERENCE / beside.of(scheme)).is_file()
    assert beside.of("unheard-of") == ""
    assert Derivations(tmp_path).of("quartic") == Derivations(tmp_path).reading("speed") == ""


def test_tables_are_linked_to_what_their_columns_mean() -> None:
    beside = Derivations(REFERENCE)
    for table in Folder(REFERENCE).tables:
        page, _, anchor = beside.reading(table).partition("#")
        assert (REFERENCE / page).is_file(), table
        assert re.search(rf"^## .*`{table}`", (REFERENCE / page).read_text("utf-8"), re.MULTILINE)
        assert table in anchor
    assert beside.reading("unheard-of") == ""


def test_table_1_has_the_twelve_rows_of_the_paper() -> None:
    rows = side_by_side(Results(REFERENCE).read_table("table1"))
    printed = [(case.name, str(row.frames)) for case in CASES.values() for row in case.rows]
    assert [tuple(row["key"][:2]) for row in rows] == [key for key in printed for _ in range(2)]
    assert [row["key"][2] for row in rows] == ["B-spline (nielson)", "quartic"] * 6
    assert [row["cells"][:2] for row in rows[:2]] == [[("16", "")] * 2, [("—", "")] * 2]


def test_a_quick_run_says_so_and_what_the_reference_has(tmp_path: Path) -> None:
    made = Results(tmp_path / "quick")
    frame = Results(REFERENCE).read_table("choosing").assign(run_size="quick")
    frame.loc[frame["scheme"] == "local-quintic", "torque"] = 1.5
    frame.loc[frame["scheme"] == "squad", ["smooth_k", "smooth_k_worst"]] = np.nan
    frame.loc[frame["scheme"] == "kim", "worst_failure"] = np.nan
    made.table("choosing", frame, keys=[])
    page = Elements(write_page(made.folder, scenes=[]).read_text(encoding="utf-8"))
    (banner,) = page.with_class("quick")
    assert banner[0]["role"] == "note"
    cells = {row["scheme"]: row["cells"] for row in page.data("choices")["rows"]}
    assert cells["local-quintic"]["torque"]["told"] == "1.007"
    assert cells["kim"]["torque"]["told"] == ""
    assert cells["squad"]["smooth"] == {"text": "—", "order": "", "told": "C¹, at worst C⁰"}
    assert cells["kim"]["failure"]["text"] == "none found"
    assert cells["kim"]["failure"]["told"].startswith("solves 0 % of the sets")
    made.table("choosing", frame.assign(run_size="full"), keys=[])
    full = Elements(write_page(made.folder, scenes=[]).read_text(encoding="utf-8"))
    assert not full.with_class("quick")


def test_quick_times_and_targets_have_the_reference_s_beside_them(tmp_path: Path) -> None:
    made = Results(tmp_path / "quick")
    made.begin(["quatspline", "run"], seed=0)
    table1, speed = (Results(REFERENCE).read_table(name) for name in ("table1", "speed"))
    once = table1["protocol"] == "solve-once"
    made.table("table1", table1.assign(ratio_to_quartic=table1["ratio_to_quartic"] + once))
    made.table("speed", speed[speed["task"] != "velocity"], keys=[])
    for name in ("table1", "speed"):
        made.record(name, {"size": "quick", "seed": 0, "seconds": 1.0, "failure": None})
    made.finish()
    folder = Folder(made.folder)
    cells = side_by_side(folder.frame("table1"), reference(folder, "table1"))[2]["cells"]
    full = side_by_side(table1)[2]["cells"]
    assert cells[:-1] == full[:-1]  # what is the same stands once
    assert cells[-1] == (f"{float(full[-1][0]) + 1:.3g}", full[-1][0])
    beside = {target[0]: (target[2], other) for target, other in bounds(folder)["rows"]}
    value, other = beside.pop("orders 0, 1 and 2 of `quartic` over order 0 alone")
    assert value == ""  # not measured there
    assert re.fullmatch(r"[\d.]+ x", other)
    assert {other for _, other in beside.values()} == {""}


def test_ids_are_unique(page_folder: Path) -> None:
    page = Elements((page_folder / "report.html").read_text(encoding="utf-8"))
    ids = [attributes["id"] for _, attributes, _ in page.items if "id" in attributes]
    assert len(ids) == len(set(ids))
