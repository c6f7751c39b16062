"""Tests that take an argument `scheme` run for every scheme that is discovered, by name.

``--scheme NAME`` (or QUATSPLINE_SCHEME, a comma list) keeps some of them.  A check that holds
for some schemes only says so with `walks.applies`; a scheme that does not pass one, such as a peer run as
published, says so in its `departs`, and then has to fail it.
"""

import os
from pathlib import Path

import pytest

os.environ.setdefault("QUATSPLINE_ENGINE", "compiled")  # the engine whose numbers are published

import quatspline as qs
from quatspline.catalogue import found
from quatspline.curve import Curve

VARIABLE = "QUATSPLINE_SCHEME"


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--scheme",
        action="append",
        metavar="NAME",
        help="run what is tested for every scheme on this one only (may be repeated)",
    )


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "scheme" not in metafunc.fixturenames:
        return
    condition = getattr(metafunc.function, "condition", lambda scheme: True)
    check = metafunc.function.__name__
    chosen = [qs.scheme(name) for name in _names(metafunc.config)]
    metafunc.parametrize(
        "scheme",
        [
            pytest.param(scheme, id=scheme.name, marks=_departure(scheme, check))
            for scheme in chosen
            if condition(scheme)
        ],
    )


def _names(config: pytest.Config) -> list[str]:
    given = config.getoption("--scheme") or os.environ.get(VARIABLE, "").split(",")
    names = [name.strip().replace("_", "-") for name in given if name.strip()]
    for name in names:
        if name not in qs.schemes():
            item = found().get(name)
            reason = item.problem if item else f"known: {', '.join(qs.schemes())}"
            raise pytest.UsageError(f"--scheme {name}: {reason}")
    return names or qs.schemes()


def _departure(scheme: type[Curve], check: str) -> list[pytest.MarkDecorator]:
    reason = scheme.departs.get(check)
    return [pytest.mark.xfail(strict=True, reason=f"{scheme.name}: {reason}")] if reason else []


@pytest.fixture(scope="session")
def page_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A results folder with its page."""
    import pages
    from quatspline.page import write_page

    made = pages.results(tmp_path_factory.mktemp("page") / "results")
    write_page(made, scenes=pages.scenes())
    return made
