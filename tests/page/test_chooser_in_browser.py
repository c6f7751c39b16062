"""The chooser in a headless Chromium: it filters as the conditions do, and its view is in the address."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from pages import Opened
from quatspline.page.folder import Folder
from quatspline.runs.results import Results
from test_chooser import qualified

pytestmark = pytest.mark.browser

VISIBLE = "#chooser tbody tr:not([hidden]) th"


def shown(page: Opened) -> list[str]:
    return [text.strip() for text in page.page.locator(VISIBLE).all_inner_texts()]


@pytest.fixture
def page(opened: Any) -> Opened:
    one: Opened = opened()
    return one


@pytest.mark.parametrize(
    "answers",
    [
        {"rates": "acceleration", "live": "yes"},
        {"rates": "velocity", "closed": "yes", "safe": "yes"},
        {"large": "yes", "rates": "acceleration"},
        {"holds": "yes"},
        {"holds": "overshoot"},
    ],
)
def test_answers_filter_as_the_conditions_do(
    page: Opened, page_folder: Path, answers: dict[str, str]
) -> None:
    for name, value in answers.items():
        page.page.select_option(f"#chooser select[name={name}]", value)
    expected = qualified(Folder(page_folder), **answers)
    assert shown(page) == expected
    said = page.page.locator("#chooser output").inner_text()
    assert said.startswith(f"{len(expected)} of ")


def test_a_view_is_in_the_address_and_is_restored(page: Opened) -> None:
    tab = page.page
    tab.select_option("#chooser select[name=rates]", "acceleration")
    tab.select_option("#chooser select[name=live]", "yes")
    tab.locator("#chooser th[data-column=time] button").click()
    before = shown(page)
    assert page("location.hash") == "#choosing?rates=acceleration&live=yes&sort=time"
    assert tab.locator("#chooser a.share").get_attribute("href") == page("location.hash")
    tab.reload()
    assert shown(page) == before
    assert tab.locator("#chooser select[name=live]").input_value() == "yes"
    assert tab.locator("#chooser th[data-column=time]").get_attribute("aria-sort") == "ascending"
    page("location.hash = '#choosing?closed=yes&holds=never&unknown=1'")
    tab.wait_for_function(
        "() => document.querySelector('#chooser select[name=closed]').value === 'yes'"
    )
    assert tab.locator("#chooser select[name=holds]").input_value() == ""  # no such answer
    tab.get_by_role("button", name="Clear the answers").click()
    assert page("location.hash") == "#choosing"


def test_sorting_puts_what_is_missing_last(page: Opened, page_folder: Path) -> None:
    table = Results(page_folder).read_table("choosing")
    missing = set(table.loc[table["torque"].isna(), "scheme"])
    head = page.page.locator("#chooser th[data-column=torque] button")
    head.click()
    up = shown(page)
    head.click()
    down = shown(page)
    assert up[0] == "min-torque"
    assert missing
    for names in (up, down):
        assert {name.split()[0] for name in names[-len(missing) :]} == missing


def test_no_answer_leaves_nobody_without_a_way_out(page: Opened) -> None:
    tab = page.page
    for name, value in {"rates": "acceleration", "holds": "yes"}.items():
        tab.select_option(f"#chooser select[name={name}]", value)
    assert shown(page) == []
    assert "Without the answer to" in tab.locator("#chooser output").inner_text()


def test_the_head_and_the_names_stay_in_sight(opened: Any) -> None:
    page = opened(viewport={"width": 375, "height": 800})
    region = page.page.locator("#chooser .steady")
    region.scroll_into_view_if_needed()
    box = "document.querySelector('#chooser .steady')"
    page(f"{box}.scrollTo(300, 400)")
    edges = page(
        f"(() => {{ const r = {box}.getBoundingClientRect(); "
        "const h = document.querySelector('#chooser thead th').getBoundingClientRect(); "
        "const c = document.querySelector('#chooser tbody tr:nth-child(20) th').getBoundingClientRect(); "
        "return [h.top - r.top, h.left - r.left, c.left - r.left]; })()"
    )
    assert all(abs(edge) < 3 for edge in edges), edges
