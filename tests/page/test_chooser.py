"""The chooser and Table 1 as they stand in the page: the documentation's questions, the tables' answers."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from pages import Elements
from quatspline.findings.choices import CHOICES
from quatspline.findings.decisions import decisions
from quatspline.findings.quotes import Quote
from quatspline.page import write_page
from quatspline.page.chooser import COLUMNS, chooser, facts, failure
from quatspline.page.derivations import Derivations
from quatspline.page.folder import Folder
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
    assert Derivations(tmp_path).of("quartic") == ""


def test_table_1_has_the_twelve_rows_of_the_paper() -> None:
    rows = side_by_side(Results(REFERENCE).read_table("table1"))
    printed = [(case.name, str(row.frames)) for case in CASES.values() for row in case.rows]
    assert [tuple(row["key"][:2]) for row in rows] == [key for key in printed for _ in range(2)]
    assert [row["key"][2] for row in rows] == ["B-spline (nielson)", "quartic"] * 6
    assert [row["cells"][:2] for row in rows[:2]] == [["16", "16"], ["—", "—"]]


def test_a_quick_run_says_so_and_what_the_reference_has(tmp_path: Path) -> None:
    made = Results(tmp_path / "quick")
    frame = Results(REFERENCE).read_table("choosing").assign(run_size="quick")
    frame.loc[frame["scheme"] == "local-quintic", "torque"] = 1.5
    made.table("choosing", frame, keys=[])
    page = Elements(write_page(made.folder, scenes=[]).read_text(encoding="utf-8"))
    (banner,) = page.with_class("quick")
    assert banner[0]["role"] == "note"
    cells = {row["scheme"]: row["cells"] for row in page.data("choices")["rows"]}
    assert cells["local-quintic"]["torque"]["told"] == "1.007"
    assert cells["kim"]["torque"]["told"] == ""
    made.table("choosing", frame.assign(run_size="full"), keys=[])
    full = Elements(write_page(made.folder, scenes=[]).read_text(encoding="utf-8"))
    assert not full.with_class("quick")


def test_ids_are_unique(page_folder: Path) -> None:
    page = Elements((page_folder / "report.html").read_text(encoding="utf-8"))
    ids = [attributes["id"] for _, attributes, _ in page.items if "id" in attributes]
    assert len(ids) == len(set(ids))
