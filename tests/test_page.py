"""The page: what stands in it, and how it behaves in a browser."""

from __future__ import annotations

import csv
import io
import json
import os
import re
import shutil
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from quatspline import running
from quatspline.cli import main
from quatspline.keyframes import prepare
from quatspline.quaternion import exp
from quatspline.registry import scheme
from quatspline.report import page as page_module
from quatspline.report.findings import FINDINGS, findings, reader
from quatspline.report.page import Scene, motion, paper_scenes, write_page
from quatspline.report.page.document import embedded
from quatspline.report.page.glossary import GLOSSARY
from quatspline.report.page.plots import scheme_look
from quatspline.report.page.sections import RANKINGS, SECTIONS
from quatspline.report.page.table1 import duration
from quatspline.report.quotes import EXPRESSIONS, Cell, Quote, said
from quatspline.report.readme import REFERENCE
from quatspline.report.results import Results
from quatspline.report.shapes import key_mesh
from quatspline.trajectories.paper import CASES

LARGEST = 15_000_000
"""Bytes that the page may have."""

POSE = 1e-6
"""Rotation angle that a pose on the canvas may be off: samples are stored as 32-bit numbers."""

EVIL = '</script><script>alert(1)</script><img src=x onerror="alert(2)">&amp;'

CONVERGENCE = pd.DataFrame(
    [
        {"scheme": name, "method": way, "keyframes": 5, "step_degrees": a, "unevenness": r}
        | {"share_converged": 1.0 / (a + r), "rate": 0.01**a}
        for name, way in (("kim", "newton"), ("min-torque", None))
        for a in (1, 4)
        for r in (1, 10)
    ]
)
"""A table that is drawn as a map."""

SCHEMES = ("quartic", "slerp")
"""Schemes of the player in these tests: two kernels to compile, not thirty."""


class Elements(HTMLParser):
    """Elements with attributes and text, and scripts by id."""

    VOID = ("meta", "link", "input", "img", "br")

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.items: list[tuple[str, dict[str, str], list[str]]] = []
        self.open: list[tuple[str, dict[str, str], list[str]]] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.items.append((tag, {k: v or "" for k, v in attrs}, []))
        if tag not in self.VOID:
            self.open.append(self.items[-1])

    def handle_endtag(self, tag: str) -> None:
        while self.open and self.open.pop()[0] != tag:
            pass

    def handle_data(self, data: str) -> None:
        if self.open:
            self.open[-1][2].append(data)

    def with_class(self, name: str) -> list[tuple[dict[str, str], str]]:
        return [(a, "".join(t)) for _, a, t in self.items if name in a.get("class", "").split()]

    def data(self, name: str) -> Any:
        return next(json.loads("".join(t)) for _, a, t in self.items if a.get("id") == name)


def results(folder: Path) -> Path:
    """A results folder: the reference tables, one that no section knows, and figures."""
    shutil.copytree(REFERENCE, folder)
    rows = {"scheme": ["quartic", "slerp", EVIL], "score": [2.0, np.inf, np.nan]}
    frame = pd.DataFrame({**rows, "comment, quoted": ['a "b"', "c\nd", "e"]})
    made = Results(folder)
    made.begin(["quatspline", "run"], seed=0)
    made.table("unheard-of", frame, title=f"Unheard {EVIL}", note="Nobody knows.", keys=[])
    figure = Figure(figsize=(3.0, 2.0))
    figure.subplots().plot([0, 1])
    for name in ("unheard-of", "figure1"):
        made.figure(name, figure)
    made.table("convergence", CONVERGENCE)
    made.table("figure1", pd.DataFrame({"u": [0.0, 1.0]}))
    made.text("unheard-of.caption.txt", "A <b>line</b>.\n")
    entry = {"size": "quick", "seed": 0, "seconds": 1.0, "failure": None}
    made.record("unheard-of", entry)
    made.record("broken", entry | {"failure": "ValueError: <none>"})
    made.finish()
    return folder


def scenes() -> list[Scene]:
    from dataclasses import replace

    pair = ("quartic", "slerp")
    return [replace(scene, schemes=SCHEMES, pair=pair) for scene in paper_scenes()]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = results(tmp_path_factory.mktemp("page") / "results")
    write_page(made, scenes=scenes())
    return made


@pytest.fixture(scope="module")
def html(folder: Path) -> str:
    return (folder / "report.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def elements(html: str) -> Elements:
    return Elements(html)


# -- quotes -------------------------------------------------------------------------------------


def test_a_sentence_ties_numbers_to_cells() -> None:
    low, high = (Cell("t", {"n": n}, "x", float(n)) for n in (2, 8))
    span = (Quote((high, low), "least"), Quote((high, low), "most"))
    parts = said("From {span:.1f}; {share:.0f} %, {low}, twice {fall:g}.", span=span, low=low,
                 share=Quote((low,), "percent"), fall=Quote((high, low), "ratio"))  # fmt: skip
    assert "".join(map(str, parts)) == "From 2.0 to 8.0; 200 %, 2.0, twice 4."
    quotes = [part for part in parts if isinstance(part, Quote)]
    assert [q.source.value for q in quotes] == [2.0, 8.0, 2.0, 2.0, 8.0]


def test_every_finding_holds_on_the_reference_tables() -> None:
    assert len(findings(reader(REFERENCE))) == len(FINDINGS)


@pytest.mark.parametrize("finding", findings(reader(REFERENCE)), ids=lambda f: f.text[:24])
def test_no_number_of_a_finding_is_written_by_hand(finding: Any) -> None:
    written = "".join(part for part in finding.parts if isinstance(part, str))
    assert not re.search(r"\d", re.sub(r"\bC[012]\b", "", written))


def test_every_number_in_the_page_resolves(elements: Elements, folder: Path) -> None:
    quotes = elements.with_class("quote")
    assert len(quotes) == sum(len(f.quotes) for f in findings(reader(folder)))
    read = reader(folder)

    def looked_up(cell: dict[str, Any]) -> Any:
        rows = read(cell["table"])
        for key, value in cell["row"].items():
            rows = rows[rows[key] == value]
        assert len(rows) == 1, cell
        return rows.iloc[0][cell["column"]]

    for attributes, text in quotes:
        values = [looked_up(cell) for cell in json.loads(attributes["data-cells"])]
        value = EXPRESSIONS[attributes["data-expression"]](*values)
        assert json.loads(attributes["data-value"]) == value
        assert text == format(value, attributes["data-spec"])
        row = json.loads(attributes["data-row"])
        place = {"table": attributes["data-table"], "row": row, "column": attributes["data-column"]}
        assert looked_up(place) in values
        assert attributes["href"] == f"#table-{place['table']}"


# -- the page -----------------------------------------------------------------------------------


def test_the_page_is_the_same_bytes_again_and_in_the_manifest(folder: Path, html: str) -> None:
    path = write_page(folder, scenes=scenes())
    assert path.read_text(encoding="utf-8") == html
    assert len(html.encode()) < LARGEST
    assert "report.html" in json.loads((folder / "manifest.json").read_text())["files"]


def test_the_page_holds_every_table_as_it_is(elements: Elements, folder: Path) -> None:
    shown = {a["data-table"] for a, _ in elements.with_class("table")}
    files = sorted(folder.glob("*.csv"))
    assert shown == {path.stem for path in files}
    for path in files:
        assert elements.data(f"csv-{path.stem}").encode() == path.read_bytes()


def test_what_a_run_did_not_make_leaves_no_hole(elements: Elements, tmp_path: Path) -> None:
    made = {a["id"] for tag, a, _ in elements.items if tag == "section"}
    assert {"findings", "player", "table1", "accuracy", "other", "made"} <= made
    assert "cost" not in made
    bare = tmp_path / "bare"
    Results(bare).table("x", pd.DataFrame({"a": [1]}))
    page = Elements(write_page(bare, scenes=[]).read_text(encoding="utf-8"))
    assert [a["id"] for tag, a, _ in page.items if tag == "section"] == ["other", "made"]
    assert not (bare / "manifest.json").exists()


def test_nothing_in_a_table_becomes_markup(html: str, elements: Elements) -> None:
    assert EVIL not in html
    assert "</script><script>alert" not in html
    assert EVIL in elements.data("csv-unheard-of").replace('""', '"')
    assert not any(tag == "img" and a.get("src") == "x" for tag, a, _ in elements.items)
    assert json.loads(embedded(f"{EVIL}\u2028")) == f"{EVIL}\u2028"


def test_failures_captions_and_circumstances_are_told(elements: Elements) -> None:
    text = " ".join("".join(t) for _, _, t in elements.items)
    assert "ValueError: <none>" in text
    assert "A <b>line</b>." in text
    assert "quatspline run" in text
    assert "Nobody knows." in text


def test_the_page_asks_for_nothing_from_elsewhere(html: str) -> None:
    before_data = html.split('<script type="application/json"')[0]
    assert "default-src 'none'" in before_data
    assert not re.search(r'(?:src|href)="https?:', before_data)


@pytest.mark.parametrize("wanting", ["missing", "empty"])
def test_a_folder_without_tables_is_refused_in_one_line(
    tmp_path: Path, wanting: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "empty").mkdir()
    assert main(["report", "--out", str(tmp_path / wanting)]) == 2
    told = capsys.readouterr().err
    assert wanting in told
    assert len(told.splitlines()) == 1
    assert not (tmp_path / "missing").exists()


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(None, ""), (12.0, "12 s"), (0.00174, "1.74 ms"), (6.42e-6, "6.42 µs"), (3e-10, "0.3 ns")],
)
def test_durations_have_units(seconds: float | None, text: str) -> None:
    assert duration(seconds) == text


def test_sections_name_no_table_twice() -> None:
    named = [name for section in SECTIONS for name in section.tables]
    assert len(named) == len(set(named))
    plotted = {(p.table, s.key) for s in SECTIONS for p in s.plots if p.table not in s.tables}
    assert not plotted


def test_criteria_and_meanings_belong_to_columns_that_exist() -> None:
    for path in REFERENCE.glob("*.csv"):
        columns = set(next(csv.reader(io.StringIO(path.read_text(encoding="utf-8")))))
        if path.stem in RANKINGS:
            assert RANKINGS[path.stem].column in columns
        own = {key.split(".")[1] for key in GLOSSARY if key.startswith(f"{path.stem}.")}
        assert own <= columns


@pytest.mark.parametrize("name", ["quartic", "local-quintic", "kim", "slerp", "any other"])
def test_schemes_stand_out_from_both_grounds(name: str) -> None:
    look = scheme_look(name)
    assert re.fullmatch("#[0-9a-f]{6}", look["light"])
    assert re.fullmatch("#[0-9a-f]{6}", look["dark"])
    assert look["dark"] != "#000000"


# -- motions ------------------------------------------------------------------------------------


def unpacked(text: str, width: int) -> np.ndarray:
    import base64

    return np.frombuffer(base64.b64decode(text), "<f4").reshape(-1, width)


@pytest.mark.parametrize("name", sorted(CASES))
def test_samples_hold_the_keyframes_and_both_sides_of_them(name: str) -> None:
    scene = next(scene for scene in scenes() if scene.name == name)
    t = motion.grid(scene.keyframes)
    knots = scene.keyframes.knots
    assert (np.diff(t) > 0.0).all()
    at = np.searchsorted(t, knots)
    np.testing.assert_array_equal(t[at], knots)
    assert (knots[1:] - t[at[1:] - 1] < 1e-6).all()
    data = motion.player_data(scene)
    q = unpacked(data["curves"]["slerp"]["q"], 4)[at]
    assert np.abs(np.abs((q * data["keyframes"]).sum(axis=1)) - 1.0).max() < 1e-6
    speed = np.linalg.norm(unpacked(data["curves"]["slerp"]["omega"], 3), axis=1)
    jump = np.abs(speed[at[1:-1]] - speed[at[1:-1] - 1])
    assert jump.max() > 0.1  # slerp's velocity jumps, within one sample


def test_a_motion_of_ones_own_is_thinned_and_says_what_does_not_apply() -> None:
    times = np.arange(1001.0) + 1.7e9
    keyframes = prepare(times, exp(0.01 * np.outer(np.arange(1001.0), [1.0, 0.0, 0.0])))
    scene = Scene("mine", "Mine", keyframes, key_mesh(6), lambda t: np.zeros((len(t), 3)),
                  schemes=("slerp", "log-cubic"), pair=("slerp", "log-cubic"))  # fmt: skip
    data = motion.player_data(scene)
    assert len(unpacked(data["t"], 1)) <= 4 * 1001
    assert data["start"] == 1.7e9
    closed = prepare(np.arange(5.0), np.eye(4), closed=True)
    own = Scene("c", "C", closed, key_mesh(6), lambda t: np.zeros((len(t), 3)),
                schemes=("slerp", "log-cubic"))  # fmt: skip
    refused = motion.player_data(own)["refused"]
    assert set(refused) == {"log-cubic"}
    assert "closed" in refused["log-cubic"]


def test_positions_of_ones_own_are_followed() -> None:
    keyframes = prepare([0.0, 1.0, 3.0], exp(np.diag([0.1, 0.2, 0.3])))
    places = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 8.0, 0.0]])
    scene = motion.own_scene("mine", "Mine", keyframes, places, ["slerp"])
    np.testing.assert_allclose(scene.positions(np.array([0.5, 2.0])), [[2, 0, 0], [4, 4, 0]])
    assert scene.scale == 0.25 * 8.0
    still = motion.own_scene("mine", "Mine", keyframes, schemes=["slerp"])
    assert not still.positions(np.array([0.5, 2.0])).any()
    assert motion.player_data(still)["pair"] == ["slerp"]


# -- after a run --------------------------------------------------------------------------------

EXPERIMENT = """
import pandas as pd
TITLE, PAPER = "Small", False
def measure(run):
    return pd.DataFrame({"x": [1]})
"""


@pytest.fixture
def small(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a page that an experiment runs into; no motion is sampled."""
    (tmp_path / "experiments").mkdir()
    (tmp_path / "experiments" / "small.py").write_text(EXPERIMENT)
    monkeypatch.setenv("QUATSPLINE_EXPERIMENTS", str(tmp_path / "experiments"))
    monkeypatch.setattr(page_module, "paper_scenes", list)
    out = tmp_path / "out"
    out.mkdir()
    (out / "report.html").write_text("stale")
    return out


def test_a_run_renews_the_page_that_is_there(small: Path) -> None:
    assert running.run(["small"], out=small) == []
    assert "csv-small" in (small / "report.html").read_text(encoding="utf-8")
    assert "report.html" in json.loads((small / "manifest.json").read_text())["files"]
    (small / "report.html").unlink()
    assert running.run(["small"], out=small) == []
    assert not (small / "report.html").exists()


def test_a_page_that_cannot_be_written_costs_no_table(
    small: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def broken(folder: Path) -> Path:
        raise OSError("no room")

    monkeypatch.setattr(page_module, "write_page", broken)
    assert running.run(["small"], out=small) == ["report.html"]
    assert "OSError: no room" in capsys.readouterr().err
    assert (small / "small.csv").is_file()


# -- in the browser -----------------------------------------------------------------------------

REQUIRED = "QUATSPLINE_BROWSER"
"""Set where a missing browser is a failure: in continuous integration."""

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
FLAGS = [
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
]
browsing = pytest.mark.browser


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    if CHROMIUM is None:
        report = pytest.fail if os.environ.get(REQUIRED) else pytest.skip
        report("no chromium on this machine: install the system's package")
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    with playwright.sync_playwright() as driver:
        opened = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield opened
        opened.close()


class Opened:
    """The page in a browser, with what it said and asked for."""

    def __init__(self, browser: Any, path: Path, **context: Any) -> None:
        self.context = browser.new_context(accept_downloads=True, **context)
        self.page = self.context.new_page()
        self.said: list[str] = []
        self.asked: list[str] = []
        self.page.on("console", lambda m: m.type == "error" and self.said.append(m.text))
        self.page.on("pageerror", lambda error: self.said.append(str(error)))
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.goto(path.as_uri())

    def __call__(self, script: str, *arguments: Any) -> Any:
        return self.page.evaluate(script, *arguments)

    def check(self) -> None:
        """It said nothing wrong and asked for nothing from elsewhere."""
        assert self.said == []
        assert all(url.startswith(("file:", "data:", "blob:")) for url in self.asked), self.asked


DESKTOP = {"width": 1280, "height": 900}


@pytest.fixture
def opened(browser: Any, folder: Path) -> Iterator[Any]:
    """Opens the page in a context of the test's own."""
    made: list[Opened] = []

    def open_it(**context: Any) -> Opened:
        made.append(Opened(browser, folder / "report.html", **{"viewport": DESKTOP, **context}))
        return made[-1]

    yield open_it
    for one in made:
        one.context.close()
        one.check()


@pytest.fixture(scope="module")
def desktop(browser: Any, folder: Path) -> Iterator[Opened]:
    one = Opened(browser, folder / "report.html", viewport=DESKTOP)
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


@browsing
def test_every_plot_is_drawn_without_an_error(page: Opened) -> None:
    for plot in page.page.query_selector_all(".plot"):
        plot.scroll_into_view_if_needed()
        page.page.wait_for_function(
            "p => p.querySelector('.main-svg, canvas') || p.textContent.includes('WebGL')", arg=plot
        )


@browsing
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


@browsing
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


@browsing
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


@browsing
def test_between_keyframes_the_player_shows_the_curve(page: Opened) -> None:
    case = next(iter(CASES.values()))
    curves = {name: scheme(name).from_keyframes(case.keyframes()) for name in SCHEMES}
    for time in (0.3712, 1.5, 2.9031):
        page("t => quatspline.player.seek(t)", time)
        for pose in page("quatspline.player.pose()")["poses"]:
            assert angle(pose["q"], curves[pose["scheme"]](time)) < 1e-3  # slerp between samples


@browsing
def test_the_player_plays_pauses_and_obeys_the_keys(page: Opened) -> None:
    time = "quatspline.player.pose().time"
    page.page.focus("input[name=time]")
    page.page.keyboard.press("Space")
    page.page.wait_for_function(f"{time} > 0.05")
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


@browsing
def test_scrubbing_moves_the_body_and_catches_keyframes(page: Opened) -> None:
    strip = page.page.locator("canvas.strip").first
    strip.scroll_into_view_if_needed()
    box = strip.bounding_box()
    middle = box["y"] + box["height"] / 2
    page.page.mouse.click(box["x"] + 0.37 * box["width"], middle)
    assert 1.3 < page("quatspline.player.pose().time") < 1.7
    page.page.mouse.click(box["x"] + 8 + 0.5 * (box["width"] - 16) + 1, middle)
    assert page("quatspline.player.pose().keyframe") == 2
    page.page.locator("input[name=time]").fill("1.25")
    assert page("quatspline.player.pose().time") == 1.25


@browsing
def test_the_canvas_shows_the_body_move(page: Opened) -> None:
    picture = "document.querySelector('canvas.stage').toDataURL()"
    first = page(picture)
    page("quatspline.player.seek(1.5)")
    second = page(picture)
    page("quatspline.player.seek(0)")
    assert first != second
    assert page(picture) == first


@browsing
def test_less_motion_goes_from_keyframe_to_keyframe(opened: Any) -> None:
    page = opened(reduced_motion="reduce")
    page.page.click("button[name=play]")
    for k in (1, 2):
        page.page.wait_for_function(f"quatspline.player.pose().keyframe === {k}")


@browsing
def test_tables_sort_filter_and_download(page: Opened, folder: Path, tmp_path: Path) -> None:
    tab = page.page
    table = tab.locator("#table-fairness")
    frame = Results(folder).read_table("fairness")

    def shown() -> list[str]:
        return table.locator("tbody tr td:first-child").all_inner_texts()

    ranked = frame.sort_values("median", kind="stable")["scheme"].tolist()
    assert shown() == ranked[:15]
    assert "Ranked by median" in table.locator("p.order").inner_text()
    table.get_by_role("button", name="worst").click()
    assert shown() == frame.sort_values("worst", kind="stable")["scheme"].tolist()[:15]
    assert "less is better" in table.locator("p.order").inner_text()
    head = table.locator("th[data-column=worst]")
    assert head.get_attribute("aria-sort") == "ascending"
    table.get_by_role("button", name="worst").click()
    assert head.get_attribute("aria-sort") == "descending"
    table.get_by_label("Filter").fill("nielson")
    assert shown() == ["nielson"]
    with tab.expect_download() as waiting:
        table.get_by_role("button", name="Download CSV").click()
    saved = tmp_path / "fairness.csv"
    waiting.value.save_as(saved)
    assert waiting.value.suggested_filename == "fairness.csv"
    assert saved.read_bytes() == (folder / "fairness.csv").read_bytes()


@browsing
def test_missing_values_come_last_and_text_stays_text(page: Opened) -> None:
    tab = page.page
    table = tab.locator("#table-unheard-of")
    for expected in (["2", "∞", ""], ["∞", "2", ""]):
        table.get_by_role("button", name="score").click()
        assert table.locator("tbody tr td:nth-child(2)").all_inner_texts() == expected
    assert EVIL in table.locator("tbody").inner_text()


@browsing
def test_figures_are_downloaded_as_they_are(page: Opened, folder: Path, tmp_path: Path) -> None:
    tab = page.page
    with tab.expect_download() as waiting:
        tab.locator("#result-unheard-of button.svg").click()
    waiting.value.save_as(tmp_path / "a.svg")
    saved = (tmp_path / "a.svg").read_text(encoding="utf-8")
    assert saved.strip() == (folder / "unheard-of.svg").read_text(encoding="utf-8").strip()


@browsing
def test_a_number_leads_to_its_row(page: Opened) -> None:
    tab = page.page
    link = tab.locator("a.quote[data-expression=least]").first
    value = json.loads(link.get_attribute("data-value"))
    link.click()
    cell = tab.locator("tr.cited td.cited")
    assert cell.count() == 1
    assert float(cell.get_attribute("title")) == value


@browsing
def test_the_look_follows_the_system_and_the_switch(opened: Any) -> None:
    page = opened(color_scheme="dark")
    assert page("quatspline.theme.look()") == "dark"
    page.page.click("#look")
    assert page("quatspline.theme.look()") == "light"
    page.page.reload()
    assert page("quatspline.theme.look()") == "light"


@browsing
@pytest.mark.parametrize(("width", "look"), [(1280, "light"), (375, "dark")])
def test_the_page_is_accessible_and_fits(opened: Any, look: str, width: int) -> None:
    axe = pytest.importorskip("axe_playwright_python.sync_playwright")
    page = opened(color_scheme=look, viewport={"width": width, "height": 800})
    for _ in range(2):  # as the system prefers, then switched
        assert page("document.documentElement.scrollWidth") <= width
        page.page.click("#look")
    violations = axe.Axe().run(page.page).response["violations"]
    serious = [v for v in violations if v["impact"] in ("serious", "critical")]
    assert serious == [], [(v["id"], v["nodes"][0]["html"][:200]) for v in serious]
