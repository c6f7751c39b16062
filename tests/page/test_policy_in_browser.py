"""The page runs the scripts that it was written with, and no other."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from pages import DESKTOP, Elements, Opened
from quatspline.page.policy import digest, policy

pytestmark = pytest.mark.browser

FOREIGN = {
    "script": "<script>window.ran = 1</script>",
    "handler": '<img src="data:," onerror="window.ran = 1">',
    "address": '<iframe srcdoc="<script>parent.ran = 1</script>"></iframe>',
    "module": '<script type="module">window.ran = 1</script>',
    "file": '<script src="data:text/javascript,window.ran=1"></script>',
}
KINDS = """[...document.querySelectorAll(".chart")].flatMap(
  (chart) => (chart._fullData ?? []).map((trace) => trace.type))"""


def opened_with(browser: Any, page_folder: Path, folder: Path, added: str) -> Opened:
    """The page with something added at the end of its body, as a hole in its escaping would."""
    text = (page_folder / "report.html").read_text(encoding="utf-8")
    path = folder / "added.html"
    path.write_text(text.replace("</body>", f"{added}</body>"), encoding="utf-8")
    return Opened(browser, path, viewport=DESKTOP)


@pytest.mark.parametrize("kind", FOREIGN)
def test_what_is_added_to_the_page_does_not_run(
    browser: Any, page_folder: Path, tmp_path: Path, kind: str
) -> None:
    one = opened_with(browser, page_folder, tmp_path, FOREIGN[kind])
    one.page.wait_for_timeout(300)
    assert one("window.ran") is None
    assert any("Content Security Policy" in text for text in one.said)
    one.context.close()


def test_the_added_script_runs_where_the_policy_names_it(
    browser: Any, page_folder: Path, tmp_path: Path
) -> None:
    """The control: without it the trial above could not fail."""
    added = "window.ran = 1\r\n"
    html = (page_folder / "report.html").read_text(encoding="utf-8")
    html = html.replace("script-src ", f"script-src {digest(added)} ", 1)
    path = tmp_path / "named.html"
    path.write_bytes(html.replace("</body>", f"<script>{added}</script></body>").encode())
    one = Opened(browser, path, viewport=DESKTOP)
    assert one("window.ran") == 1
    one.context.close()
    one.check()


def test_text_is_not_made_code(opened: Any) -> None:
    page = opened()
    for made in ("Function('return 1')()", "(0, eval)('1')"):
        tried = f"new Promise((done) => setTimeout(() => {{ try {{ done({made}) }} catch (e) {{ done(e.name) }} }}))"
        assert page(tried) == "EvalError"
    page.said.clear()  # the browser told of both


def test_all_kinds_of_plots_are_drawn_without_it(opened: Any) -> None:
    page = opened()
    for plot in page.page.query_selector_all(".plot"):
        plot.scroll_into_view_if_needed()
        page.page.wait_for_function(
            "p => p.querySelector('.main-svg, canvas') || p.textContent.includes('WebGL')", arg=plot
        )
    kinds = set(page(KINDS))
    assert {"scatter", "heatmap"} <= kinds
    if page("Boolean(document.createElement('canvas').getContext('webgl'))"):
        assert "scatter3d" in kinds


def test_the_policy_names_each_script_of_the_page_and_nothing_looser(page_folder: Path) -> None:
    elements = Elements((page_folder / "report.html").read_text(encoding="utf-8"))
    scripts = ["".join(text) for tag, a, text in elements.items if tag == "script" and not a]
    (meta,) = [a for tag, a, _ in elements.items if "http-equiv" in a]
    assert len(scripts) > 10
    assert meta["content"] == policy(scripts)
    (allowed,) = [part for part in meta["content"].split("; ") if part.startswith("script-src")]
    assert all(source.startswith("'sha256-") for source in allowed.split()[1:])
