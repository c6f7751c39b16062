"""The page: what stands in it, and that it is written when it should be."""

from __future__ import annotations

import csv
import io
import json
import re
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from pages import EVIL, Elements, scenes
from quatspline import page as page_module
from quatspline.cli import running
from quatspline.cli.commands import main
from quatspline.figures.meshes import key_mesh
from quatspline.findings import decisions, targets
from quatspline.findings.findings import FINDINGS, findings, reader
from quatspline.findings.quotes import EXPRESSIONS, Cell, Quote, said
from quatspline.keyframes import prepare
from quatspline.page import Scene, motion, write_page
from quatspline.page.document import embedded
from quatspline.page.glossary import GLOSSARY
from quatspline.page.plots import scheme_look
from quatspline.page.rankings import RANKINGS
from quatspline.page.sections import SECTIONS
from quatspline.page.table1 import duration
from quatspline.quaternion import exp
from quatspline.runs.experiment import files
from quatspline.runs.results import Results
from quatspline.trajectories.paper import CASES
from tools.readme import REFERENCE

LARGEST = 15_000_000
"""Bytes that the page may have."""


@pytest.fixture(scope="module")
def html(page_folder: Path) -> str:
    return (page_folder / "report.html").read_text(encoding="utf-8")


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
    """All but those of an experiment that is newer than the reference, which owes it no table yet."""
    owed = set(files()) - {path.stem for path in REFERENCE.glob("*.csv")}
    topics = [finding.topic for finding in findings(reader(REFERENCE))]
    expected = [topic for topic, _ in FINDINGS if topic not in owed]
    assert topics == expected + [decisions.TABLE] * len(decisions.QUESTIONS)


@pytest.mark.parametrize("finding", findings(reader(REFERENCE)), ids=lambda f: f.text[:24])
def test_no_number_of_a_finding_is_written_by_hand(finding: Any) -> None:
    written = "".join(part for part in finding.parts if isinstance(part, str))
    assert not re.search(r"\d", re.sub(r"\bC[012]\b", "", written))


def test_every_number_in_the_page_resolves(elements: Elements, page_folder: Path) -> None:
    quotes = elements.with_class("quote")
    assert len(quotes) == sum(len(f.quotes) for f in findings(reader(page_folder)))
    read = reader(page_folder)

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


def test_the_page_is_the_same_bytes_again_and_in_the_manifest(page_folder: Path, html: str) -> None:
    path = write_page(page_folder, scenes=scenes())
    assert path.read_text(encoding="utf-8") == html
    assert len(html.encode()) < LARGEST
    assert "report.html" in json.loads((page_folder / "manifest.json").read_text())["files"]


def test_the_page_holds_every_table_as_it_is(elements: Elements, page_folder: Path) -> None:
    shown = {a["data-table"] for a, _ in elements.with_class("table")}
    files = sorted(page_folder.glob("*.csv"))
    assert shown == {path.stem for path in files}
    for path in files:
        assert elements.data(f"csv-{path.stem}").encode() == path.read_bytes()


def test_what_a_run_did_not_make_leaves_no_hole(elements: Elements, tmp_path: Path) -> None:
    made = {a["id"] for tag, a, _ in elements.items if tag == "section"}
    assert {"findings", "choosing", "motions", "paper", "accuracy", "cost", "other", "made"} <= made
    bare = tmp_path / "bare"
    Results(bare).table("x", pd.DataFrame({"a": [1]}))
    page = Elements(write_page(bare, scenes=[]).read_text(encoding="utf-8"))
    assert [a["id"] for tag, a, _ in page.items if tag == "section"] == ["other", "made"]
    own = json.loads((bare / "manifest.json").read_text())["files"]
    assert list(own) == ["report.html"]
    write_page(bare, scenes=[])  # knows the page for its own


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


def refusal(folder: Path, capsys: pytest.CaptureFixture[str], left: bool = False) -> str:
    """The one line in which the command refuses a folder."""
    assert main(["report", "--out", str(folder)]) == 2
    told = capsys.readouterr().err
    assert len(told.splitlines()) == 1
    assert (folder / "report.html").exists() == left
    return told.removeprefix("quatspline: ").removesuffix("\n")


@pytest.fixture
def spoilt(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a table that is in order, for a file that is not."""
    monkeypatch.setattr(page_module, "paper_scenes", list)
    Results(tmp_path).table("x", pd.DataFrame({"a": [1]}))
    return tmp_path


@pytest.mark.parametrize("name", ["table1", "noise", "unheard-of"])
@pytest.mark.parametrize("content", [b"", b'a,b\n"1,2\n', b"\x89PNG\r\n\x1a\n\x00"])
def test_a_file_that_is_no_table_is_refused_by_name(
    spoilt: Path, name: str, content: bytes, capsys: pytest.CaptureFixture[str]
) -> None:
    (spoilt / f"{name}.csv").write_bytes(content)
    assert refusal(spoilt, capsys).startswith(f"{spoilt / name}.csv: not a table in CSV: ")


@pytest.mark.parametrize("column", ["case", "protocol", "paper_iterations", "seconds_median"])
def test_a_table_without_a_column_is_refused_by_name(
    spoilt: Path, column: str, capsys: pytest.CaptureFixture[str]
) -> None:
    table = Results(REFERENCE).read_table("table1").drop(columns=column)
    table.to_csv(spoilt / "table1.csv", index=False)
    assert refusal(spoilt, capsys) == f"{spoilt / 'table1.csv'}: no column '{column}'"


@pytest.mark.parametrize(
    ("table", "column"), [("table1", "seconds_median"), ("speed", "nanoseconds_per_item")]
)
def test_text_in_place_of_numbers_is_refused_by_name(
    spoilt: Path, table: str, column: str, capsys: pytest.CaptureFixture[str]
) -> None:
    frame = Results(REFERENCE).read_table(table)
    frame.assign(**{column: "many"}).to_csv(spoilt / f"{table}.csv", index=False)
    assert refusal(spoilt, capsys).startswith(f"{spoilt / table}.csv: ")


@pytest.mark.parametrize("table", sorted(path.stem for path in REFERENCE.glob("*.csv")))
def test_a_table_with_one_column_makes_a_page_or_is_refused_by_name(
    spoilt: Path, table: str, capsys: pytest.CaptureFixture[str]
) -> None:
    frame = Results(REFERENCE).read_table(table)
    frame.iloc[:, -1:].to_csv(spoilt / f"{table}.csv", index=False)
    status, told = main(["report", "--out", str(spoilt)]), capsys.readouterr().err
    assert status == 0 or told.startswith(f"quatspline: {spoilt / table}.csv: no column ")


def test_a_count_that_was_read_as_a_float_is_written_whole() -> None:
    """A column with gaps is read as floats: Table 1 of schemes among which some were not measured."""
    assert str(Quote((Cell("t", {"n": 1}, "x", 16.0),), spec="d")) == "16"
    with pytest.raises(ValueError, match=r"^t\.csv\[n=1\]\.x: "):
        str(Quote((Cell("t", {"n": 1}, "x", 16.5),), spec="d"))


def test_a_quote_of_what_is_no_number_names_its_cell() -> None:
    with pytest.raises(ValueError, match=r"^t\.csv\[n=1\]\.x: "):
        str(Quote((Cell("t", {"n": 1}, "x", "many"),), spec=".3g"))


MANIFESTS = {
    '{"cpu": 3}': "cpu: an object is expected, found 3",
    '{"cpu": {"model": "A"}}': "cpu: 'cores' is missing",
    '{"git": "abc"}': "git: an object is expected, found 'abc'",
    '{"command": "run"}': "command: a list is expected, found 'run'",
    '{"end": 5}': "end: text is expected, found 5",
    '{"sizes": []}': "sizes: an object is expected, found []",
    '{"experiments": {"x": 1}}': "experiments: x: an object is expected, found 1",
    '{"experiments": {"x": {}}}': "experiments: x: 'size' is missing",
    '{"command": ["quat': "not a file in JSON: Unterminated string",
    "": "not a file in JSON: Expecting value",
    "[]": "a JSON object is expected, found list",
}


@pytest.mark.parametrize("content", MANIFESTS)
def test_a_manifest_that_no_run_wrote_is_refused_and_kept(
    spoilt: Path, content: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = spoilt / "manifest.json"
    path.write_text(content)
    assert refusal(spoilt, capsys).startswith(f"{path}: {MANIFESTS[content]}")
    assert path.read_text() == content


def test_a_manifest_may_lack_what_is_not_known(spoilt: Path) -> None:
    cpu = {"model": "Abacus", "cores": 1, "usable": 1}
    bare = {"cpu": cpu, "end": None, "git": None, "experiments": None}
    for manifest in ({}, bare):
        (spoilt / "manifest.json").write_text(json.dumps(manifest))
        text = write_page(spoilt, force=True).read_text(encoding="utf-8")
        assert ("<dd>Abacus, 1 of 1 cores usable</dd>" in text) == bool(manifest)


# -- the speed targets --------------------------------------------------------------------------


def test_speed_targets_stand_above_their_table(html: str, page_folder: Path) -> None:
    section = html.partition('<section id="speed">')[2].partition("</section>")[0]
    read = reader(page_folder)
    shown = [targets.cells(verdict) for verdict in targets.verdicts(read)]
    cells = [
        unescape(cell)
        for cell in re.findall(r"<td>(.*?)</td>", section.partition('id="result-speed"')[0])
    ]
    assert cells == [cell for row in shown for cell in row[1:]]
    heads = re.findall(r'<th scope="row">(.*?)</th>', section)
    assert [re.sub("</?code>", "`", head) for head in heads] == [row[0] for row in shown]
    manifest = json.loads((page_folder / "manifest.json").read_text(encoding="utf-8"))
    assert targets.measured_on(manifest) in section
    assert manifest["cpu"]["model"] in section
    assert "<code>quartic</code> agrees with evaluation in 50 digits" in section


def test_targets_that_a_speed_table_does_not_reach_say_why(tmp_path: Path) -> None:
    speed = Results(REFERENCE).read_table("speed")
    quick = speed[(speed["task"] == "set-up") & (speed["scheme"] == "quartic")]
    Results(tmp_path).table("speed", quick)
    page = write_page(tmp_path, scenes=[]).read_text(encoding="utf-8")
    assert "Measured on a machine that no manifest names." in page
    assert page.count("<td>not measured: ") == len(targets.TARGETS) - 1


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
    both = motion.own_scene("mine", "Mine", keyframes, schemes=["slerp", "quartic"])
    assert motion.player_data(both)["pair"] == ["quartic", "slerp"]  # nielson is not offered


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
    before = Results(tmp_path / "out")
    before.begin(["quatspline", "run"])
    before.text("report.html", "stale")
    before.finish()
    return before.folder


def test_a_run_renews_the_page_that_is_there(small: Path) -> None:
    assert running.run(["small"], out=small) == []
    assert "csv-small" in (small / "report.html").read_text(encoding="utf-8")
    assert "report.html" in json.loads((small / "manifest.json").read_text())["files"]
    (small / "report.html").unlink()
    assert running.run(["small"], out=small) == []
    assert not (small / "report.html").exists()


def test_a_run_leaves_a_page_that_is_not_its_own(
    small: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = small / "report.html"
    page.write_text("by hand")
    assert running.run(["small"], out=small) == []
    assert page.read_text() == "by hand"
    assert (
        f"{page}: not written by a run in this folder, so it was left as it is"
        in capsys.readouterr().err
    )
    assert "report.html: not written by quatspline" in refusal(small, capsys, left=True)
    assert main(["report", "--out", str(small), "--force"]) == 0
    assert "csv-small" in page.read_text(encoding="utf-8")


def test_the_command_writes_and_opens_the_page(
    small: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    Results(small).table("small", pd.DataFrame({"x": [1]}))
    assert main(["report", "--out", str(small), "--open"]) == 0
    page = small / "report.html"
    assert opened == [page.resolve().as_uri()]
    assert capsys.readouterr().out == f"{page}\n"
    assert "csv-small" in page.read_text(encoding="utf-8")


def test_a_page_that_cannot_be_written_costs_no_table(
    small: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def broken(folder: Path) -> Path:
        raise OSError("no room")

    monkeypatch.setattr(page_module, "write_page", broken)
    assert running.run(["small"], out=small) == ["report.html"]
    assert "OSError: no room" in capsys.readouterr().err
    assert (small / "small.csv").is_file()
