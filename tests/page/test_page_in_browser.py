"""The page in a headless Chromium: no error, no request, and everything that a reader can do."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pages import DESKTOP, EVIL, SCHEMES, Opened, needed
from quatspline.catalogue import scheme
from quatspline.runs.results import Results
from quatspline.trajectories.paper import CASES
from tools.readme import REFERENCE

POSE = 1e-6
"""Rotation angle that a pose on the canvas may be off: samples are stored as 32-bit numbers."""

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def desktop(browser: Any, page_folder: Path) -> Iterator[Opened]:
    one = Opened(browser, page_folder / "report.html", viewport=DESKTOP)
    yield one
    one.context.close()


@pytest.fixture
def page(desktop: Opened) -> Iterator[Opened]:
    """The page opened once for many tests (it loads for a second), the player at its start."""
    desktop("quatspline.player.choose(0)")
    for name, value in (("layout", "split"), ("chart", "log"), ("a", "quartic"), ("b", "slerp")):
        desktop.page.select_option(f"select[name={name}]", value)
    yield desktop
    desktop.check()


def angle(p: Any, q: Any) -> float:
    """Rotation angle between two orientations; exact for small ones, where arccos is not."""
    p, q = np.asarray(p), np.asarray(q)
    return 4.0 * float(np.arcsin(min(np.linalg.norm(p - q), np.linalg.norm(p + q)) / 2.0))


def test_every_plot_is_drawn_without_an_error(page: Opened) -> None:
    for plot in page.page.query_selector_all(".plot"):
        plot.scroll_into_view_if_needed()
        page.page.wait_for_function(
            "p => p.querySelector('.main-svg, canvas') || p.textContent.includes('WebGL')", arg=plot
        )


def test_maps_show_what_the_table_holds(page: Opened) -> None:
    plot = page.page.locator("#plot-convergence-map")
    plot.scroll_into_view_if_needed()
    plot.locator(".main-svg").first.wait_for()
    drawn = "document.querySelector('#plot-convergence-map .chart').data[0]"
    assert page(drawn + ".z") == pytest.approx([1 / 2, 1 / 11, 1 / 5, 1 / 14])
    plot.get_by_label("scheme").select_option("min-torque")
    assert plot.get_by_label("method").locator("option").all_inner_texts() == ["–"]
    plot.get_by_label("Colour").select_option("rate")
    assert page(drawn + ".z") == pytest.approx([-2, -2, -8, -8])  # coloured by the logarithm
    assert page(drawn + ".text") == ["0.01", "0.01", "1.00e−8", "1.00e−8"]
    plot.get_by_label("scheme").select_option("hermite")  # it opened where there are data
    assert page(drawn + ".z") == []
    assert plot.get_by_text("no data for this choice").count() == 1


def test_a_series_is_picked_out_and_axes_are_switched(page: Opened) -> None:
    plot = page.page.locator("#plot-accuracy-lines")
    plot.scroll_into_view_if_needed()
    plot.locator(".main-svg").first.wait_for()
    chart = "document.querySelector('#plot-accuracy-lines .chart')"
    assert page(chart + ".layout.yaxis.type") == "log"
    plot.get_by_label("log y").uncheck()
    assert page(chart + ".layout.yaxis.type") == "linear"
    plot.get_by_label("Pick out").select_option("quintic")
    strong = f"{chart}.data.filter((d) => d.opacity === 1).map((d) => d.name)"
    assert page(strong) == ["quintic"]
    points = f"{chart}.data.find((d) => d.name === 'quintic').y[0]"
    frame = Results(REFERENCE).read_table("accuracy")
    rows = frame[(frame["scheme"] == "quintic") & (frame["knots"] == "uniform")]
    finest = rows.sort_values("spacing").iloc[0]
    assert page(points) == finest["inner_angle"]


def colours(page: Opened, chart: str) -> dict[str, str]:
    script = f"Object.fromEntries({chart}.data.map((d) => [d.name, d.line.color]))"
    made: dict[str, str] = page(script)
    return made


def test_eight_lines_are_in_colour_until_others_are_picked(page: Opened) -> None:
    plot = page.page.locator("#plot-cost-lines")
    plot.scroll_into_view_if_needed()
    plot.locator(".main-svg").first.wait_for()
    chart = "document.querySelector('#plot-cost-lines .chart')"
    grey = page("quatspline.theme.color('ghost')")
    first = colours(page, chart)
    lit = {name for name, color in first.items() if color != grey}
    assert len(lit) == 8 < len(first)
    assert {"quartic", "slerp"} <= lit
    assert first["quartic"] == page("quatspline.plots.seriesColor('quartic')")
    page(f"{chart}.emit('plotly_legendclick', {{data: {chart}.data, curveNumber: "
         f"{chart}.data.findIndex((d) => d.name === 'biarc')}})")  # fmt: skip
    assert colours(page, chart)["biarc"] != grey


def test_ratios_are_drawn_as_excess_on_logarithmic_axes(page: Opened) -> None:
    plot = page.page.locator("#plot-choosing-points")
    plot.scroll_into_view_if_needed()
    plot.locator(".main-svg").first.wait_for()
    point = "document.querySelector('#plot-choosing-points .chart').data.find((d) => d.name === 'kim').y[0]"
    torque = Results(REFERENCE).read_table("choosing").set_index("scheme").loc["kim", "torque"]
    assert page(point) == pytest.approx(torque - 1.0, rel=1e-12)
    plot.get_by_label("log y").uncheck()
    assert page(point) == torque
    plot.get_by_label("log y").check()


def test_the_player_has_the_colours_of_the_plots(page: Opened) -> None:
    key = "getComputedStyle(document.querySelector('#player .key')).borderTopColor"
    rgb = page("quatspline.plots.seriesColor('quartic')").lstrip("#")
    wanted = ", ".join(str(int(rgb[k : k + 2], 16)) for k in (0, 2, 4))
    assert page(key) == f"rgb({wanted})"


@pytest.mark.parametrize("index", [0, 1])
def test_the_player_shows_the_pose_of_each_keyframe(page: Opened, index: int) -> None:
    case = list(CASES.values())[index]
    page.page.select_option("select[name=scene]", str(index))
    keyframes = case.keyframes()
    poses = [*keyframes.quaternions, keyframes.quaternions[0]][: len(case.times)]
    for k, time in enumerate(case.times):
        page("t => quatspline.player.seek(t)", float(time))
        shown = page("quatspline.player.pose()")
        assert shown["keyframe"] == k
        assert shown["time"] == time
        assert [pose["scheme"] for pose in shown["poses"]] == ["quartic", "slerp"]
        for pose in shown["poses"]:
            assert angle(pose["q"], poses[k]) < POSE


def test_between_keyframes_the_player_shows_the_curve(page: Opened) -> None:
    case = next(iter(CASES.values()))
    curves = {name: scheme(name).from_keyframes(case.keyframes()) for name in SCHEMES}
    for time in (0.3712, 1.5, 2.9031):
        page("t => quatspline.player.seek(t)", time)
        for pose in page("quatspline.player.pose()")["poses"]:
            assert angle(pose["q"], curves[pose["scheme"]](time)) < 1e-3  # slerp between samples


def test_the_player_plays_pauses_and_obeys_the_keys(page: Opened) -> None:
    time = "quatspline.player.pose().time"
    page.page.focus("#player input[name=time]")
    page.page.keyboard.press("Space")
    page.page.wait_for_function(f"() => {time} > 0.05")
    page.page.keyboard.press("Space")
    stopped = page(time)
    page.page.wait_for_timeout(120)
    assert page(time) == stopped
    page.page.keyboard.press("End")
    assert page(time) == 4.0
    page.page.keyboard.press("PageUp")
    assert page(time) == 3.0
    page.page.keyboard.press("ArrowLeft")
    assert 2.9 < page(time) < 3.0
    page.page.keyboard.press("Home")
    assert page(time) == 0.0
    page.page.click("button[name=next]")
    assert page("quatspline.player.pose().keyframe") == 1
    page.page.select_option("select[name=layout]", "over")
    page.page.select_option("select[name=chart]", "stereographic")
    assert len(page("quatspline.player.pose().poses")) == 2


def test_scrubbing_moves_the_body_and_catches_keyframes(page: Opened) -> None:
    strip = page.page.locator("#player canvas.strip").first
    strip.scroll_into_view_if_needed()
    box = strip.bounding_box()
    middle = box["y"] + box["height"] / 2
    page.page.mouse.click(box["x"] + 0.37 * box["width"], middle)
    assert 1.3 < page("quatspline.player.pose().time") < 1.7
    page.page.mouse.click(box["x"] + 8 + 0.5 * (box["width"] - 16) + 1, middle)
    assert page("quatspline.player.pose().keyframe") == 2
    page.page.locator("#player input[name=time]").fill("1.25")
    assert page("quatspline.player.pose().time") == 1.25


def test_the_canvas_shows_the_body_move(page: Opened) -> None:
    picture = "document.querySelector('canvas.stage').toDataURL()"
    first = page(picture)
    page("quatspline.player.seek(1.5)")
    second = page(picture)
    page("quatspline.player.seek(0)")
    assert first != second
    assert page(picture) == first


def test_less_motion_goes_from_keyframe_to_keyframe(opened: Any) -> None:
    page = opened(reduced_motion="reduce")
    page.page.select_option("#player select[name=speed]", "0.25")  # keyframes stand for long
    page.page.click("#player button[name=play]")
    for k in (1, 2):
        page.page.wait_for_function(f"() => quatspline.player.pose().keyframe === {k}")


def test_tables_sort_filter_and_download(page: Opened, page_folder: Path, tmp_path: Path) -> None:
    tab = page.page
    table = tab.locator("#table-fairness")
    frame = Results(page_folder).read_table("fairness")
    frame = frame[frame["data"] == "committed"]  # what the page shows at first

    def shown() -> list[str]:
        return table.locator("tbody tr > :first-child").all_inner_texts()

    ranked = frame.sort_values("median", kind="stable")["scheme"].tolist()
    assert shown() == ranked[:15]
    assert "Ranked by median" in table.locator("p.order").inner_text()
    table.locator("th[data-column=worst] button").click()
    assert shown() == frame.sort_values("worst", kind="stable")["scheme"].tolist()[:15]
    assert "less is better" in table.locator("p.order").inner_text()
    head = table.locator("th[data-column=worst]")
    assert head.get_attribute("aria-sort") == "ascending"
    table.locator("th[data-column=worst] button").click()
    assert head.get_attribute("aria-sort") == "descending"
    table.get_by_label("Filter").fill("nielson")
    assert shown() == ["nielson"]
    with tab.expect_download() as waiting:
        table.get_by_role("button", name="Download CSV").click()
    saved = tmp_path / "fairness.csv"
    waiting.value.save_as(saved)
    assert waiting.value.suggested_filename == "fairness.csv"
    assert saved.read_bytes() == (page_folder / "fairness.csv").read_bytes()


def test_missing_values_come_last_and_text_stays_text(page: Opened) -> None:
    tab = page.page
    table = tab.locator("#table-unheard-of")
    for expected in (["2", "∞", ""], ["∞", "2", ""]):
        table.get_by_role("button", name="score").click()
        assert table.locator("tbody tr > :nth-child(2)").all_inner_texts() == expected
    assert EVIL in table.locator("tbody").inner_text()


def test_figures_are_downloaded_as_they_are(
    page: Opened, page_folder: Path, tmp_path: Path
) -> None:
    tab = page.page
    with tab.expect_download() as waiting:
        tab.locator("#result-unheard-of button.svg").click()
    waiting.value.save_as(tmp_path / "a.svg")
    saved = (tmp_path / "a.svg").read_text(encoding="utf-8")
    assert saved.strip() == (page_folder / "unheard-of.svg").read_text(encoding="utf-8").strip()


def test_a_number_leads_to_its_row(page: Opened) -> None:
    tab = page.page
    link = tab.locator("a.quote[data-expression=least]").first
    value = json.loads(link.get_attribute("data-value"))
    link.click()
    cell = tab.locator("tr.cited td.cited")
    assert cell.count() == 1
    assert float(cell.get_attribute("title")) == value


def test_the_look_follows_the_system_and_the_switch(opened: Any) -> None:
    page = opened(color_scheme="dark")
    assert page("quatspline.theme.look()") == "dark"
    page.page.click("#look")
    assert page("quatspline.theme.look()") == "light"
    page.page.reload()
    assert page("quatspline.theme.look()") == "light"


@pytest.mark.parametrize("look", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 375])
def test_the_page_is_accessible_and_fits(opened: Any, look: str, width: int) -> None:
    """With everything drawn and unfolded, as the system prefers."""
    axe = needed("axe_playwright_python.sync_playwright")
    page = opened(color_scheme=look, viewport={"width": width, "height": 800})
    assert page("document.documentElement.scrollWidth") <= width
    page("document.querySelectorAll('main details').forEach((fold) => { fold.open = true; })")
    page(
        "window.dispatchEvent(new Event('beforeprint')); window.dispatchEvent(new Event('afterprint'))"
    )
    page("quatspline.figures")
    assert page("quatspline.theme.look()") == look
    assert page("document.documentElement.scrollWidth") <= width
    violations = (
        axe.Axe().run(page.page, options={"resultTypes": ["violations"]}).response["violations"]
    )
    serious = [v for v in violations if v["impact"] in ("serious", "critical")]
    assert serious == [], [(v["id"], v["nodes"][0]["html"][:200]) for v in serious]
