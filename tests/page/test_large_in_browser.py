"""A motion of 2,000 keyframes in the browser: smooth, no finer than a screen, its curves in space when asked for."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from pages import DESKTOP, SCHEMES, Opened
from quatspline import quaternion
from quatspline.keyframes import prepare
from quatspline.page import own_scene, write_page
from quatspline.runs.results import Results

KEYFRAMES = 2000

pytestmark = pytest.mark.browser

FRAMES = """() => {
  const { player } = quatspline, times = [];
  for (let k = 0; k < 120; k++) {
    const before = performance.now();
    player.seek((k + 0.5) / 120 * player.motion.span);
    times.push(performance.now() - before);
  }
  return times;
}"""

COUNT = """() => {
  const pen = CanvasRenderingContext2D.prototype, own = pen.lineTo;
  quatspline.lines = 0;
  pen.lineTo = function (...values) { quatspline.lines++; return own.apply(this, values); };
}"""

LOG = "#log-curves [data-motion=log]"
CHART = f"document.querySelector('{LOG} .chart')"


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a folder with one table, whose motion is long."""
    results = Results(tmp_path_factory.mktemp("large"))
    results.table("x", pd.DataFrame({"a": [1]}))
    rng = np.random.default_rng(0)
    steps = rng.normal(scale=0.1, size=(KEYFRAMES, 3))
    q = [quaternion.exp(steps[0])]
    for step in steps[1:]:
        q.append(quaternion.mul(q[-1], quaternion.exp(step)))
    keyframes = prepare(np.arange(KEYFRAMES) / 30.0, np.array(q))
    scene = own_scene("long", "A long motion", keyframes, schemes=SCHEMES)
    return write_page(results, scenes=[scene])


@pytest.fixture
def page(browser: Any, path: Path) -> Iterator[Opened]:
    one = Opened(browser, path, viewport=DESKTOP)
    yield one
    one.context.close()
    one.check()


def test_a_frame_is_short_and_first_content_early(
    page: Opened, capsys: pytest.CaptureFixture[str]
) -> None:
    """Lines of a frame are counted and bounded; milliseconds are reported, since a machine may be busy."""
    page(FRAMES)  # once for the browser's compiler
    times = np.array(page(FRAMES))
    first = page("performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? NaN")
    with capsys.disabled():
        told = f"median {np.median(times):.2f} ms, 95 % below {np.quantile(times, 0.95):.2f} ms"
        print(f"\n{KEYFRAMES} poses: script per frame {told}; first content after {first:.0f} ms")
    page(COUNT)
    page("quatspline.player.seek(12.3456)")
    corners = page("2 * 4 * quatspline.player.motion.body.cells.length")
    assert 0 < page("quatspline.lines") < corners + 100  # bodies and cursors: curves were kept


def test_curves_in_space_are_drawn_when_asked_for(page: Opened) -> None:
    page.page.locator(LOG).scroll_into_view_if_needed()
    button = page.page.locator(f"{LOG} button", has_text="Draw the log-curves")
    button.wait_for()
    assert "2000 keyframes" in page.page.locator(f"{LOG} .ask").inner_text()
    assert not page(f"Boolean({CHART}.data)")
    page("quatspline.MotionPlot.canTurn = () => true")
    button.click()
    page.page.wait_for_function(f"{CHART}.data || {CHART}.textContent")
    drawn = page(f"{CHART}.data.filter((d) => d.visible === true).map((d) => [d.name, d.x.length])")
    assert {name for name, _ in drawn} == set(SCHEMES)
    samples = page("quatspline.player.motion.t.length")
    assert all(2 < count <= samples for _, count in drawn)


def test_points_nearer_than_a_pixel_are_left_out(page: Opened) -> None:
    made = page(
        "quatspline.MotionPlot.thinned(Array.from({ length: 10001 }, (_, i) => [i / 1e4, 0, 0]))"
    )
    steps = np.diff(np.array(made)[:, 0])
    assert 900 < len(made) < 1010
    assert steps[:-1].min() >= 1e-3
    assert made[-1] == [1, 0, 0]


def test_schemes_are_shown_and_hidden_by_the_legend(page: Opened) -> None:
    place = page.page.locator("#rates [data-motion=rates]")
    place.scroll_into_view_if_needed()
    place.locator(".main-svg").first.wait_for()
    chart = "document.querySelector('#rates .chart')"
    shown = f"{chart}.data.filter((d) => d.visible === true).map((d) => d.name)"
    assert page(shown) == [name for name in SCHEMES for _ in range(2)]
    page(f"{chart}.emit('plotly_legendclick', {{ data: {chart}.data, curveNumber: 0 }})")
    assert page(shown) == [SCHEMES[1]] * 2
    assert page(f"{chart}.data.map((d) => [d.name, d.x.length])")[0] == [SCHEMES[0], 1]
    page("window.dispatchEvent(new Event('beforeprint'))")
    assert page(f"{chart}.data.map((d) => d.name)") == [SCHEMES[1]] * 2
    page("window.dispatchEvent(new Event('afterprint'))")
    page(f"{chart}.emit('plotly_legenddoubleclick', {{ data: {chart}.data, curveNumber: 0 }})")
    assert page(shown) == [SCHEMES[0]] * 2
