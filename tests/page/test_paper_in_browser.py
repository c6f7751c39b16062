"""The page on paper and on a phone: nothing is cut off, nothing is blank, the clock is where the body is."""

from __future__ import annotations

from typing import Any

import pytest

from pages import Opened

A4 = {"width": 688, "height": 1000}
"""CSS pixels between margins of 14 mm."""
PHONE = {"width": 375, "height": 800}

pytestmark = pytest.mark.browser

BLANK = """(() => [...document.querySelectorAll('main canvas')].filter((canvas) => {
  const box = canvas.getBoundingClientRect();
  if (!box.width || !box.height || canvas.closest('.plot')) return false;
  const pixels = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
  return !pixels.some((value) => value > 0);
}).map((canvas) => canvas.className))()"""
"""Canvases that are shown and hold nothing."""

CUT = """(() => [...document.querySelectorAll('main *')].filter((element) => {
  const box = element.getBoundingClientRect();
  return box.width && box.right > window.innerWidth + 1 && !element.closest('svg, .plot');
}).map((element) => element.outerHTML.slice(0, 120)))()"""
"""Elements that reach beyond the paper's edge."""


@pytest.fixture
def paper(opened: Any) -> Opened:
    """The page as it is printed from a dark screen."""
    page: Opened = opened(color_scheme="dark")
    page("window.dispatchEvent(new Event('beforeprint'))")
    page.page.set_viewport_size(A4)
    page.page.emulate_media(media="print")
    return page


def test_every_block_is_on_the_paper_and_none_is_blank(paper: Opened) -> None:
    for plot in paper.page.query_selector_all(".plot"):
        paper.page.wait_for_function(
            "p => p.querySelector('.main-svg, canvas') || p.textContent.includes('WebGL')", arg=plot
        )
    assert paper(CUT) == []
    assert paper(BLANK) == []
    widths = paper("[...document.querySelectorAll('.plot .main-svg')].map((s) => s.clientWidth)")
    assert widths
    assert max(widths) <= A4["width"]


LEGENDS = """(() => [...document.querySelectorAll('.plot')].flatMap((plot) => {
  const end = plot.getBoundingClientRect().bottom + 2;
  return [...plot.querySelectorAll('.legend')].filter((legend) => legend.getBoundingClientRect().bottom > end);
}).length)()"""
"""Legends that reach into what follows their plot."""


def test_no_legend_lies_over_what_follows(paper: Opened) -> None:
    for plot in paper.page.query_selector_all(".plot"):
        paper.page.wait_for_function(
            "p => p.querySelector('.main-svg, canvas') || p.textContent.includes('WebGL')", arg=plot
        )
    assert paper("document.querySelectorAll('.plot .legend').length") > 3
    assert paper(LEGENDS) == 0
    heights = paper("[...document.querySelectorAll('.plot .chart')].map((c) => c.layout?.height)")
    assert set(heights) - {None} == {
        410
    }  # not the screen's, at which the browser tells that it will print


def test_figures_are_on_the_paper(opened: Any) -> None:
    page = opened()
    page("quatspline.figures")  # waits until all are inflated
    assert (
        page("[...document.querySelectorAll('img.picture')].map((i) => i.naturalWidth > 100)")
        == [True] * 2
    )


def test_paper_is_white_and_the_screen_is_as_before(paper: Opened) -> None:
    assert paper("quatspline.theme.look()") == "light"
    paper.page.emulate_media(media="screen")
    paper("window.dispatchEvent(new Event('afterprint'))")
    assert paper("quatspline.theme.look()") == "dark"


def test_the_browser_prints_it(opened: Any) -> None:
    page = opened()
    document = page.page.pdf(format="A4")
    assert document.startswith(b"%PDF")
    assert document.count(b"/Type /Page\n") > 5


def test_on_a_phone_the_clock_stands_under_the_first_body(opened: Any) -> None:
    page = opened(viewport=PHONE)
    tops = page(
        "['#player .bodies figure:first-child', '#player button[name=play]', '#player .bodies figure:last-child']"
        ".map((name) => document.querySelector(name).getBoundingClientRect().top)"
    )
    assert tops == sorted(tops)


def test_no_toolbar_lies_over_a_plot_on_a_phone(opened: Any) -> None:
    page = opened(viewport=PHONE)
    plot = page.page.locator("#plot-cost-lines")
    plot.scroll_into_view_if_needed()
    plot.locator(".main-svg").first.wait_for()
    assert plot.locator(".modebar-btn").count() == 0
    assert plot.locator("h4").inner_text() == "median time (s)"


def test_the_contents_mark_what_is_being_read(opened: Any) -> None:
    page = opened()
    for key in ("accuracy", "claims"):
        page(f"document.getElementById('{key}').scrollIntoView({{behavior: 'instant'}})")
        page.page.wait_for_function(
            f"() => document.querySelector('.contents [aria-current]').getAttribute('href') === '#{key}'"
        )


def test_first_content_and_script_per_frame_are_told(opened: Any, record_property: Any) -> None:
    """Measured and reported, not asserted: machines differ."""
    page = opened()
    first = page("performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? NaN")
    frame = page(
        "(() => { const p = quatspline.player, all = [];"
        " for (let i = 0; i < 60; i++) { const t = performance.now(); p.seek(p.motion.span * i / 60);"
        " all.push(performance.now() - t); } return all.sort((a, b) => a - b)[30]; })()"
    )
    record_property("first_content_ms", first)
    record_property("script_per_frame_ms", frame)
    print(f"first content after {first:.0f} ms, {frame:.2f} ms of script a frame (median of 60)")
    assert page("quatspline.player.pose().time") > 0
