"""The page of a comparison in the browser: its table is ranked as the file is, its player opens on the recommended."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from pages import DESKTOP, Opened
from quatspline.cli import main
from walks import walk

pytestmark = pytest.mark.browser

SCHEMES = ["quartic", "slerp", "smoothing-spline", "kim", "local-quintic"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("own")
    rows = np.column_stack([0.5 * np.arange(9.0), walk(9, 50.0)])
    np.savetxt(out / "keys.csv", rows, delimiter=",", header="t,w,x,y,z", comments="")
    file = str(out / "keys.csv")
    assert main(["compare", file, "--schemes", *SCHEMES, "--out", str(out / "compared")]) == 0
    return out / "compared"


@pytest.fixture
def page(browser: Any, folder: Path) -> Iterator[Opened]:
    one = Opened(browser, folder / "report.html", viewport=DESKTOP)
    yield one
    one.context.close()
    one.check()


def test_the_table_is_ranked_as_the_file_until_a_reader_sorts_it(
    page: Opened, folder: Path
) -> None:
    table, frame = page.page.locator("#table-compare"), pd.read_csv(folder / "compare.csv")

    def shown() -> list[str]:
        return table.locator("tbody tr > :first-child").all_inner_texts()

    assert shown() == list(frame["scheme"])
    assert shown()[-1] == "smoothing-spline"
    assert "Ranked: what is recommended first" in table.locator("p.order").inner_text()
    table.locator("th[data-column=torque_over_least] button").click()
    by_torque = frame.sort_values("torque_over_least", kind="stable")["scheme"]
    assert shown() == list(by_torque) != list(frame["scheme"])
    assert "Sorted by torque over least" in table.locator("p.order").inner_text()


def test_the_player_opens_on_the_recommended_scheme(page: Opened, folder: Path) -> None:
    best = pd.read_csv(folder / "compare.csv")["scheme"][0]
    poses = page("quatspline.player.pose().poses.map((pose) => pose.scheme)")
    assert poses == [best, "quartic"]
    assert best not in ("quartic", "nielson")
