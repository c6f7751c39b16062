"""The documentation in a browser: formulas keep to the page, and their numbers show."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import pytest

from pages import needed
from quatspline.discovery import PACKAGE

pytestmark = pytest.mark.browser

ROOT = PACKAGE.parents[1]
LEAST = 0.62
"""Of fit.js: formulas are set no smaller."""

MEASURE = """() => {
  const wide = [], hidden = [], width = document.documentElement.clientWidth;
  for (const box of document.querySelectorAll(".equation")) {
    const parts = box.querySelector(".parts");
    if (parts.scrollWidth > parts.clientWidth + 1) wide.push(parseFloat(parts.style.fontSize) / 100);
    for (const number of box.querySelectorAll(".number"))
      if (number.getBoundingClientRect().right > width) hidden.push(number.textContent);
  }
  return { wide, hidden, page: document.documentElement.scrollWidth - width };
}"""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    commands = needed("mkdocs.commands.build")
    from mkdocs.config import load_config

    folder = tmp_path_factory.mktemp("site")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of the tool and its dependencies
        commands.build(load_config(config_file=str(ROOT / "mkdocs.yml"), site_dir=str(folder)))
    return folder


@pytest.mark.parametrize("width", [1440, 390])
def test_formulas_keep_to_the_page(browser: Any, site: Path, width: int) -> None:
    """On a desk none scrolls; on a phone only one that would not be legible if it were smaller."""
    page = browser.new_page(viewport={"width": width, "height": 900})
    for file in sorted(site.rglob("*.html")):
        page.goto(file.as_uri())
        found = page.evaluate(MEASURE)
        assert found["page"] <= 0, file.name
        assert found["hidden"] == [], file.name
        assert found["wide"] == ([] if width > 1000 else len(found["wide"]) * [LEAST]), file.name
    page.close()
