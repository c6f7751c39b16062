"""A headless Chromium, and pages opened in it."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from pages import DESKTOP, REQUIRED, Opened, needed

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
FLAGS = [
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
]


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    if CHROMIUM is None:
        report = pytest.fail if os.environ.get(REQUIRED) else pytest.skip
        report("no chromium on this machine: install the system's package")
    playwright = needed("playwright.sync_api")
    with playwright.sync_playwright() as driver:
        opened = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield opened
        opened.close()


@pytest.fixture
def opened(browser: Any, page_folder: Path) -> Iterator[Any]:
    """Opens the page in a context of the test's own."""
    made: list[Opened] = []

    def open_it(**context: Any) -> Opened:
        made.append(
            Opened(browser, page_folder / "report.html", **{"viewport": DESKTOP, **context})
        )
        return made[-1]

    yield open_it
    for one in made:
        one.context.close()
        one.check()
