"""The documentation: every scheme derived, examples that run, pages that build and hold together."""

from __future__ import annotations

import doctest
import inspect
import os
import pkgutil
import re
import shutil
import warnings
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

import quatspline as qs
from quatspline import quaternion
from quatspline.catalogue import FOLDERS, found
from quatspline.curve import Curve
from quatspline.engines import engine
from quatspline.options import declared_by
from quatspline.page.glossary import column
from quatspline.runs.experiment import files
from quatspline.segments import SegmentCurve
from tools.derivations import PREFIX, drawn
from tools.new_scheme import COMPILED, new_scheme
from tools.readme import DOCS, QUOTING, REFERENCE, ROBOT, ROOT, compare_block, derivations
from tools.robot import robot
from tools.shown import SHOWN, walked
from walks import inside, uneven, walk

SOURCE_LINK = re.compile(r"\]\(([^)#:]+)(?:#[^)]*)?\)")
SRC = re.compile(r'(?:src|<link[^>]* href)="([^"]+)"')


def listed() -> set[str]:
    """In-house schemes that the docs list; a file newly put into baselines/ owes no page yet."""
    return set(
        re.findall(r"^\| \[?`([\w-]+)`.*\| quatspline(?: \(ours\))? \|$", schemes_page(), re.M)
    )


def schemes_page() -> str:
    return (DOCS / "schemes.md").read_text(encoding="utf-8")


def front() -> str:
    """The README up to the links."""
    return (ROOT / "README.md").read_text(encoding="utf-8").partition("## Read on")[0]


def test_every_scheme_has_a_page() -> None:
    pages = derivations()
    assert listed()
    assert not listed() - pages.keys()
    assert not pages.keys() - found().keys()


def test_pages_number_their_equations_once() -> None:
    """(X.n) is unique over all pages, so that code can cite it."""
    text = "".join(page.read_text(encoding="utf-8") for page in DOCS.rglob("*.md"))
    numbers = re.findall(r"\\tag\{([^}]+)\}", text)
    assert len(numbers) == len(set(numbers))


def test_equations_that_pages_cite_exist() -> None:
    text = "".join(page.read_text(encoding="utf-8") for page in DOCS.rglob("*.md"))
    known = set(re.findall(r"\\tag\{([^}]+)\}", text))
    letters = {number.split(".")[0] for number in known}
    cited = set(re.findall(rf"\(((?:{'|'.join(letters)})\.\d+)\)", text))
    assert not cited - known


@pytest.mark.parametrize("file", QUOTING, ids=lambda file: file.name)
def test_links_of_the_sources_exist(file: Path) -> None:
    targets = SOURCE_LINK.findall(file.read_text(encoding="utf-8"))
    assert not [target for target in targets if not (file.parent / target).exists()]


@pytest.mark.parametrize(
    "file", [ROOT / "README.md", *DOCS.rglob("*.md")], ids=lambda file: file.name
)
def test_pictures_exist_and_are_described(file: Path) -> None:
    pictures = re.findall(r"!\[([^\]]*)\]\(([^)]+)\)", file.read_text(encoding="utf-8"))
    assert all(text for text, _ in pictures)
    assert all((file.parent / place).stat().st_size > 10_000 for _, place in pictures)


def test_every_derivation_has_its_picture() -> None:
    pages = set(derivations().values())
    assert {page.stem for page in pages} == SHOWN.keys()
    for page in pages:
        text = page.read_text(encoding="utf-8")
        assert text.count(f"](../images/{PREFIX}{page.stem}.png)") == 1, page.name


@pytest.mark.parametrize("page", sorted(SHOWN))
def test_a_derivation_shows_what_it_derives(page: str) -> None:
    """Its scheme's blending functions, which add up to 1 where as many keyframes as are drawn shape a segment."""
    shown = SHOWN[page]
    assert derivations()[shown.scheme].stem == page
    left, right = drawn(shown).axes
    lines = [np.asarray(line.get_ydata()) for line in left.lines]
    assert len(lines) == shown.around
    scheme = qs.scheme(shown.scheme)
    if scheme.support == shown.around and not shown.cumulative:
        np.testing.assert_allclose(np.sum(lines, axis=0), 1.0, atol=1e-12)
    assert all(np.isfinite(np.asarray(line.get_ydata(), float)).all() for line in right.lines)


def test_the_readme_is_short() -> None:
    assert len(front().split()) <= 500
    assert front().index("```") < 1000


def test_the_robot_waits(tmp_path: Path) -> None:
    """As the picture's caption and the notebook say."""
    motion = qs.read_motion(ROOT / ROBOT)
    t, q = motion.times, motion.quaternions[:, 0]
    still = (q[:-1] == q[1:]).all(axis=1)
    np.testing.assert_array_equal(t[:-1][still], [2.5, 7.4])
    np.testing.assert_array_equal(t[1:][still], [4.0, 9.4])
    picture = tmp_path / "robot.png"
    robot(ROOT / ROBOT, picture)
    assert picture.read_bytes()[:4] == b"\x89PNG"


def test_the_readme_shows_what_compare_prints() -> None:
    """Line by line, of the schemes that the docs list: one put into baselines/ may change the advice."""
    usable = {name for name, item in found().items() if item.scheme is not None}
    if added := usable - set(re.findall(r"^\| \[?`([\w-]+)`", schemes_page(), re.M)):
        pytest.skip(f"the README's comparison knows nothing of {', '.join(sorted(added))}")
    block = front().split("<!-- begin compare -->\n")[1].split("\n<!-- end compare -->")[0]
    assert block == compare_block()


# -- examples -----------------------------------------------------------------------------------


def test_the_readme_example_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", readme, re.M | re.S)
    assert blocks
    names: dict[str, Any] = {}
    for block in blocks:
        exec(block, names)
    curve = names["curve"]
    assert curve([1.7, 3.0]).shape == (2, 4)
    assert np.abs(curve(3.0, 1)).max() < 1e-9  # it waits
    assert curve([1.7, 3.0], 2).shape == (2, 3)


def test_start_here_runs(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(ROOT)
    names: dict[str, Any] = {}
    for block in re.findall(
        r"^```python\n(.*?)^```", (DOCS / "start.md").read_text("utf-8"), re.M | re.S
    ):
        exec(block, names)
    waiting, most = capsys.readouterr().out.splitlines()
    assert float(waiting) < 1e-9
    assert re.fullmatch(r"at most \d+ °/s and \d+ °/s²", most)


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # of the tool and its dependencies
def test_the_notebook_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    """In a kernel of its own, with the sources that are tested here."""
    nbformat, nbclient = (pytest.importorskip(name) for name in ("nbformat", "nbclient"))
    places = map(str, (*qs.__path__, os.environ.get("PYTHONPATH", "")))
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(Path(next(places)).parent), *places]))
    book = nbformat.read(ROOT / "examples" / "first_curve.ipynb", as_version=4)
    resources = {"metadata": {"path": str(ROOT / "examples")}}
    nbclient.NotebookClient(book, timeout=600, resources=resources).execute()
    printed = [out for cell in book.cells for out in cell.get("outputs", ())]
    assert any("image/png" in out.get("data", {}) for out in printed)
    assert "while it waits" in printed[-1]["text"]


def my_cubic() -> str:
    """The file that the page on compiled families shows."""
    page = (DOCS / "writing-a-family.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"^```python\n(.*?)^```", page, re.M | re.S)
    return str(block)


def test_the_worked_family_is_what_the_scaffold_writes(tmp_path: Path) -> None:
    """Whose conformance and claims are checked there (test_catalogue)."""
    written = new_scheme("my_cubic", tmp_path, COMPILED)
    assert my_cubic() == written.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def folder_of_the_page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One for all tests, because the compiler's cache goes by path."""
    folder = tmp_path_factory.mktemp("worked")
    (folder / "my_cubic.py").write_text(my_cubic(), encoding="utf-8")
    return folder


@pytest.fixture(params=["python", "compiled"])
def worked(
    request: pytest.FixtureRequest, folder_of_the_page: Path, monkeypatch: pytest.MonkeyPatch
) -> type[Curve]:
    """The scheme that the page shows, found in its folder, by one engine and then the other."""
    monkeypatch.setenv(FOLDERS, str(folder_of_the_page))
    monkeypatch.setenv(engine.VARIABLE, request.param)
    scheme = qs.scheme("my-cubic")
    assert issubclass(scheme, SegmentCurve)
    assert scheme(None, walk(3, 40.0)).engine == request.param
    return scheme


def normalised_cubic(t: Any, q: Any, x: Any) -> list[Any]:
    """Orientations and rates of scipy's cubic through t, q and the ends' parabolas, normalised."""
    cubic = CubicHermiteSpline(t, q, np.gradient(q, t, axis=0, edge_order=2))
    p, p1, p2 = cubic(x), cubic(x, 1), cubic(x, 2)
    size, along = ((p * d).sum(axis=1, keepdims=True) for d in (p, p1))
    w, bent = (2.0 * quaternion.mul(quaternion.conj(p), d)[:, 1:] / size for d in (p1, p2))
    return [p / np.sqrt(size), w, bent - 2.0 * along / size * w]


def test_the_worked_family_is_the_normalised_cubic(worked: type[Curve]) -> None:
    t, q = uneven(9), quaternion.align(walk(9, 70.0))
    curve, x = worked(t, q), inside(t, 5)
    for order, wanted in enumerate(normalised_cubic(t, q, x)):
        np.testing.assert_allclose(curve(x, order), wanted, atol=1e-13 * np.abs(wanted).max())


def test_the_worked_family_answers_where_its_point_has_no_length(worked: Any) -> None:
    """On a segment whose cubic goes straight through 0, as between antipodes."""
    curve = worked(None, walk(2, 40.0))
    curve.segments[0, 0] = [1.0, 0.0, 0.0, 0.0, -2.0] + 11 * [0.0]
    np.testing.assert_array_equal(curve([0.5, 0.25]), 2 * [[1.0, 0.0, 0.0, 0.0]])
    assert np.isfinite(curve(0.5, 1)).all()
    assert np.isfinite(curve(0.5, 2)).all()


def modules() -> list[str]:
    """Modules of the package that have examples."""
    return [
        item.name
        for item in pkgutil.walk_packages(qs.__path__, "quatspline.")
        if ">>> " in _source(item)
    ]


def _source(item: pkgutil.ModuleInfo) -> str:
    spec = item.module_finder.find_spec(item.name, None)
    assert spec is not None
    assert spec.origin is not None
    return Path(spec.origin).read_text(encoding="utf-8")


@pytest.mark.parametrize("name", modules())
def test_docstring_examples_run(name: str) -> None:
    result = doctest.testmod(import_module(name))
    assert result.attempted > 0
    assert result.failed == 0


@pytest.mark.parametrize("name", sorted({*qs.__all__} - {"__version__", "Keyframes"}))
def test_public_names_have_an_example(name: str) -> None:
    """Keyframes are made by a curve, whose example shows them."""
    assert ">>> " in (inspect.getdoc(getattr(qs, name)) or "")


# -- pages --------------------------------------------------------------------------------------


def build(docs: Path, site: Path) -> None:
    """Build pages as `make docs` does."""
    commands = pytest.importorskip("mkdocs.commands.build", reason="needs the extra 'docs'")
    from mkdocs.config import load_config

    config = load_config(str(ROOT / "mkdocs.yml"), docs_dir=str(docs), site_dir=str(site))
    commands.build(config)


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # of the tool and its dependencies
def test_pages_build_and_load_nothing_from_elsewhere(tmp_path: Path) -> None:
    build(DOCS, tmp_path)
    pages = sorted(tmp_path.rglob("*.html"))
    assert len(pages) > len(list(DOCS.rglob("*.md")))
    for page in pages:
        text = page.read_text(encoding="utf-8")
        assert not [source for source in SRC.findall(text) if "//" in source], page
        assert "$$" not in text
    assert "<math" in (tmp_path / "mathematics" / "quartic.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """All pages as HTML."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        folder = tmp_path_factory.mktemp("site")
        build(DOCS, folder)
    return folder


@pytest.fixture(scope="module")
def reference(site: Path) -> str:
    """The page of the API."""
    return (site / "api.html").read_text(encoding="utf-8")


def test_the_page_of_results_explains_columns(site: Path) -> None:
    text = (site / "results.html").read_text(encoding="utf-8")
    explained = text.split("Columns of <code>accuracy.csv</code>")[1].split("</table>")[0]
    assert f"<td>{column('accuracy', 'inner_angle').meaning}</td>" in explained
    told = set(re.findall(r"Columns of <code>([\w-]+)\.csv</code>", text))
    assert told == {file.stem for file in REFERENCE.glob("*.csv")}


@pytest.mark.parametrize("module", ["quatspline", "quatspline.motion"])
def test_the_api_page_has_every_public_name(reference: str, module: str) -> None:
    """Names of `quatspline.motion` that the package itself hands on stand under the package."""
    told = set(re.findall(r'id="(quatspline[\w.]*)"', reference))
    names = {name for name in import_module(module).__all__ if name != "__version__"}
    assert {n for n in names if not told & {f"{module}.{n}", f"quatspline.{n}"}} == set()


@pytest.mark.parametrize("name", sorted(listed()))
def test_the_api_page_has_every_option(reference: str, name: str) -> None:
    section = reference.split(f'id="options-{name}"')[1].split("<h3")[0]
    rows = re.findall(r"<tr>(.*?)</tr>", section, re.S)
    cells = [re.findall(r"<td>(.*?)</td>", row, re.S) for row in rows]
    options = {
        row[0].removeprefix("<code>").removesuffix("</code>") for row in cells if row and row[-1]
    }
    assert options == declared_by(qs.scheme(name)).keys()


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.parametrize(
    "line",
    [
        "[a page](nowhere.md)",
        "[an anchor](notation.md#nowhere)",
        "[a file](../../baselines/nowhere.py)",
        "As shown [@nobody1900].",
        r"A formula $\nonsense{x}$.",
    ],
)
def test_what_is_broken_does_not_build(line: str, tmp_path: Path) -> None:
    docs = tmp_path / "docs"
    shutil.copytree(DOCS, docs)
    with (docs / "mathematics" / "slerp.md").open("a", encoding="utf-8") as page:
        page.write(f"\n{line}\n")
    with pytest.raises(pytest.importorskip("mkdocs.exceptions").Abort):
        build(docs, tmp_path / "site")


def test_tables_that_pages_cite_exist() -> None:
    """A page names a table of an experiment, and not tables at large."""
    known = {f"{name}.csv" for name in files()}
    for page in [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]:
        text = page.read_text(encoding="utf-8")
        cited = set(re.findall(r"results/([\w-]+\.csv)", text))
        assert cited <= known, (page.name, cited - known)
        assert "the results tables" not in text, page.name


def test_nielson_is_shown_where_it_jumps_most() -> None:
    """As the caption says: of ten walks, one of which is not solved, by a component's jump over its largest value."""
    shown = SHOWN["nielson"]
    page = (DOCS / "mathematics" / "nielson.md").read_text(encoding="utf-8")
    sets = [walked(seed, 6, 120.0, (3.0, 1.0, 1.0))() for seed in range(10)]
    jumps = [_jump_shares(*keyframes) for keyframes in sets]
    assert [found is None for found in jumps].count(True) == 1
    largest = max((found for found in jumps if found is not None), key=np.max)
    times, q = shown.keyframes()
    np.testing.assert_array_equal(largest, _jump_shares(times, q))
    knot, component = np.unravel_index(np.argmax(largest), largest.shape)
    assert component == shown.component
    assert f"most at {times[1 + knot]:g};" in page
    assert f"{100.0 * largest.max():.0f} %" in page


def _jump_shares(times: np.ndarray, q: np.ndarray) -> np.ndarray | None:
    """Of the acceleration's components at inner keyframes, over their largest values; None where unsolved."""
    try:
        curve = qs.build("nielson", times, q)
    except qs.ConvergenceError:
        return None
    knots, beside = times[1:-1], 1e-6
    jumps = np.abs(curve(knots + beside, 2) - curve(knots - beside, 2))
    return jumps / np.abs(curve(curve.keyframes.inside(120), 2)).max(axis=0)


def test_a_keyframe_looks_the_same_on_every_page() -> None:
    seen: dict[str, set[tuple[object, object]]] = {}
    for shown in SHOWN.values():
        left = drawn(shown).axes[0]
        for text, line in zip(left.texts, left.lines, strict=True):
            look = (line.get_color(), line.get_linestyle())
            seen.setdefault(text.get_text().lstrip("$qL"), set()).add(look)
            assert text.get_color() == line.get_color()
    assert all(len(looks) == 1 for looks in seen.values()), seen


@pytest.mark.parametrize("page", sorted(SHOWN))
def test_curves_differ_in_grey_print(page: str) -> None:
    """In their dashes, which the lines to their names have, too."""
    right = drawn(SHOWN[page]).axes[1]
    names = [text for text in right.texts if text.arrow_patch is not None]
    dashes = {str(text.arrow_patch.get_linestyle()) for text in names}
    assert len(dashes) == len(names) == len(SHOWN[page].curves)
