"""Draw your own, in a headless Chromium: the page's five schemes are the package's, and what a reader does is kept."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pages import DESKTOP, Opened
from quatspline import build, quaternion
from quatspline.instruments.excursion import excursion

SCHEMES = ("slerp", "squad", "quartic", "local-quintic", "monotone-quintic")
EXACT = 1e-12

pytestmark = pytest.mark.browser

EVALUATED = """([scheme, times, keyframes, at]) => {
  const curve = quatspline.curves.build(scheme, times, keyframes);
  return at.map((t) => { const { q, omega, alpha } = curve(t); return [...q, ...omega, ...alpha]; });
}"""


@pytest.fixture(scope="module")
def desktop(browser: Any, page_folder: Path) -> Iterator[Opened]:
    one = Opened(browser, page_folder / "report.html", viewport=DESKTOP)
    yield one
    one.check()
    one.context.close()


@pytest.fixture
def page(desktop: Opened) -> Opened:
    """The section as it was at first."""
    desktop("location.hash = ''")
    desktop.page.locator("#drawn button[name=reset]").click()
    desktop("quatspline.drawing.seek(0)")
    return desktop


def walk(seed: int, count: int, degrees: float) -> tuple[np.ndarray, np.ndarray]:
    """Uneven times, and keyframes as far apart."""
    rng = np.random.default_rng(seed)
    axes = rng.normal(size=(count, 3))
    axes *= np.radians(degrees) / 2 / np.linalg.norm(axes, axis=1, keepdims=True)
    q = quaternion.exp(rng.normal(size=(1, 3)))
    for axis in axes[1:]:
        q = np.vstack([q, quaternion.mul(q[-1], quaternion.exp(axis))])
    return np.cumsum(rng.uniform(0.2, 2.0, count)), q * rng.choice([-1.0, 1.0], (count, 1))


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize(
    ("count", "degrees"), [(2, 60), (3, 120), (5, 0), (9, 20), (9, 90), (9, 175)]
)
def test_curves_in_the_page_are_the_package_s(
    desktop: Opened, name: str, count: int, degrees: float
) -> None:
    times, q = walk(count, count, degrees)
    at = np.concatenate([times, np.random.default_rng(1).uniform(times[0], times[-1], 40)])
    made = np.array(desktop(EVALUATED, [name, times.tolist(), q.tolist(), at.tolist()]))
    curve = build(name, times, q)
    np.testing.assert_allclose(made[:, :4], curve(at) * np.sign(q[0] @ curve(times[0])), atol=EXACT)
    for order, rate in ((1, made[:, 4:7]), (2, made[:, 7:])):
        expected = curve(at, order)
        np.testing.assert_allclose(rate, expected, atol=EXACT * max(np.abs(expected).max(), 1.0))


def test_the_page_offers_exactly_these(desktop: Opened) -> None:
    assert tuple(desktop("quatspline.curves.SCHEMES")) == SCHEMES


def pasted(page: Opened, times: np.ndarray, q: np.ndarray) -> None:
    rows = [",".join(map(repr, map(float, (t, *key)))) for t, key in zip(times, q, strict=True)]
    page("text => quatspline.drawing.paste(text)", "\n".join(["t,w,x,y,z", *rows]))


def test_overshoot_is_that_of_the_table(page: Opened) -> None:
    times = np.arange(6.0)
    q = quaternion.exp(np.outer([0.0, 0.6, 0.6, 0.0, 0.9, 0.9], [0.0, 0.0, 1.0]))
    pasted(page, times, q)
    for scheme in SCHEMES:
        shown = page("name => quatspline.drawing.motion.overshoot(name)", scheme)
        found = excursion(build(scheme, times, q))
        expected = np.degrees(found.over.max())
        assert shown == pytest.approx(expected, abs=0.02 * max(expected, 1e-3)), scheme
    assert page("quatspline.drawing.motion.overshoot('monotone-quintic')") < 1e-6
    assert page("quatspline.drawing.motion.overshoot('squad')") > 5.0
    page.page.wait_for_function(
        "() => [...document.querySelectorAll('#drawn .measured tbody tr')].some((row) => "
        "row.cells[0].textContent === 'squad' && Number(row.cells[1].textContent) > 5)"
    )


def test_a_drag_turns_the_keyframe_and_the_curve_follows(page: Opened) -> None:
    page("quatspline.drawing.jump(1)")
    before = page("quatspline.drawing.motion.keyframes")
    stage = page.page.locator("#drawn canvas.stage").first
    stage.scroll_into_view_if_needed()
    box = stage.bounding_box()
    assert box is not None
    page.page.mouse.move(box["x"] + 100, box["y"] + 100)
    page.page.mouse.down()
    page.page.mouse.move(box["x"] + 160, box["y"] + 100, steps=3)
    page.page.mouse.up()
    after = page("quatspline.drawing.motion.keyframes")
    moved = [k for k in range(len(before)) if not np.allclose(before[k], after[k])]
    assert moved == [1]
    turn = 2 * np.arccos(abs(np.dot(before[1], after[1])))
    assert turn == pytest.approx(np.radians(30.0), abs=1e-3)  # half a degree a pixel
    shown = page("quatspline.drawing.pose()")["poses"][0]["q"]
    assert abs(np.dot(shown, after[1])) == pytest.approx(1.0, abs=1e-9)
    page.page.select_option("#drawn select[name=drag]", "view")
    page.page.mouse.move(box["x"] + 100, box["y"] + 100)
    page.page.mouse.down()
    page.page.mouse.move(box["x"] + 160, box["y"] + 100, steps=3)
    page.page.mouse.up()
    assert page("quatspline.drawing.motion.keyframes") == after
    page.page.select_option("#drawn select[name=drag]", "body")


def test_marks_move_keyframes_in_time_between_their_neighbours(page: Opened) -> None:
    mark = page.page.locator("#drawn .marks button").nth(2)
    mark.scroll_into_view_if_needed()
    box = mark.bounding_box()
    assert box is not None
    middle = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.page.mouse.move(*middle)
    page.page.mouse.down()
    page.page.mouse.move(middle[0] + 60, middle[1], steps=3)
    half = page("quatspline.drawing.motion.times[2]")
    page.page.mouse.move(middle[0] + 5000, middle[1], steps=2)
    page.page.mouse.up()
    times = page("quatspline.drawing.motion.times")
    assert 2.0 < half < times[2] < times[3] == 3.0
    mark = page.page.locator("#drawn .marks button").nth(1)
    mark.focus()
    page.page.keyboard.press("Shift+ArrowLeft")
    assert page("quatspline.drawing.motion.times[1]") == pytest.approx(1.0 - 0.04)


def test_a_motion_is_shared_by_its_address(page: Opened) -> None:
    times, q = walk(5, 4, 70.0)
    pasted(page, times, q)
    page.page.select_option("#drawn select[name=a]", "local-quintic")
    page.page.locator("#drawn button[name=add]").click()  # at a keyframe: refused, and said
    assert "between two keyframes" in page.page.locator("#drawn .said").inner_text()
    address = page("location.hash")
    assert page.page.locator("#drawn a.share").get_attribute("href") == address
    before = page("quatspline.drawing.motion.keyframes")
    page.page.reload()
    assert page("quatspline.drawing.controls.a.value") == "local-quintic"
    np.testing.assert_allclose(page("quatspline.drawing.motion.times"), times, atol=1e-6)
    np.testing.assert_allclose(page("quatspline.drawing.motion.keyframes"), before, atol=2e-6)


def test_csv_goes_in_and_comes_out(page: Opened, tmp_path: Path) -> None:
    times, q = walk(6, 5, 50.0)
    pasted(page, times, q)
    with page.page.expect_download() as waiting:
        page.page.locator("#drawn button[name=save]").click()
    waiting.value.save_as(tmp_path / "keyframes.csv")
    table = np.loadtxt(tmp_path / "keyframes.csv", delimiter=",", skiprows=1)
    np.testing.assert_allclose(table[:, 0], times, rtol=1e-15)
    np.testing.assert_allclose(np.abs((table[:, 1:] * q).sum(axis=1)), 1.0, atol=1e-12)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("0,1,0,0,0", "At least two lines"),
        ("0,1,0,0,0\n0,0,1,0,0", "Keyframe 1: its time 0 does not come after 0"),
        ("0,1,0,0,0\n1,0,0,0,0", "Keyframe 1: its quaternion has no length"),
        ("0,1,0,0,0\n1,a,0,0,0", "Keyframe 1: expected five numbers"),
        ("0,1,x,0,0\n1,1,0,0,0\n2,0,1,0,0", "Keyframe 0: expected five numbers"),
        ("0,1,0,0,0\n1,0,1,,0", "Keyframe 1: expected five numbers"),
        ("0,1,0,0,0\n1,0,nan,1,0", "Keyframe 1: expected five numbers"),
        ("0,1,0,0,0\n1e300,0,1,0,0", "Keyframe 1: its time 1e+300 is beyond"),
        ("t,a,b,c\n0,1,0,0\n1,1,0,0", "does not name w, x, y, z"),
        ("", "At least two lines"),
    ],
)
def test_what_cannot_be_a_curve_is_refused_in_a_sentence(
    page: Opened, text: str, said: str
) -> None:
    before = page("quatspline.drawing.motion.times")
    page("text => quatspline.drawing.paste(text)", text)
    assert said in page.page.locator("#drawn .said").inner_text()
    assert page("quatspline.drawing.motion.times") == before


@pytest.mark.parametrize(
    "text",
    [
        "0,0.6,0.8,0,0\n1.5,0,0,0,1",
        "t,x,y,z,w\n0,0.8,0,0,0.6\n1.5,0,0,1,0",
        "\ufeffTimestamp;qw;qx;qy;qz\r\n0;0,6;0,8;0;0\r\n1,5;0;0;0;1\r\n",
        "# a comment\n0\t0.6\t0.8\t0\t0\n\n1.5\t0\t0\t0\t1\n",
        "  0 0.6 0.8 0 0\n1.5  0 0 0 1",
        "note,t,w,x,y,z\nstart,0,3,4,0,0\nend,1.5,0,0,0,2",
    ],
)
def test_keyframes_are_taken_as_spreadsheets_and_files_have_them(page: Opened, text: str) -> None:
    page("text => quatspline.drawing.paste(text)", text)
    assert page.page.locator("#drawn .said").inner_text() == "2 keyframes taken."
    assert page("quatspline.drawing.motion.times") == [0, 1.5]
    keys = np.array(page("quatspline.drawing.motion.keyframes"))
    np.testing.assert_allclose(np.abs(keys), [[0.6, 0.8, 0, 0], [0, 0, 0, 1]], atol=1e-15)


@pytest.mark.parametrize(
    "keys", ["garbage", "", "0,1,0,0,0;0,1,0,0,0", "%E0%A4%A", "0,0,0,0,0;1,1,0,0,0"]
)
def test_an_address_without_a_motion_is_told(page: Opened, keys: str) -> None:
    before = page("quatspline.drawing.motion.times")
    page("keys => { location.hash = `#draw?a=<b>&keys=${keys}`; }", keys)
    page.page.wait_for_function(
        "document.querySelector('#drawn .said').textContent.startsWith('The address holds no motion. ')"
    )
    assert page("quatspline.drawing.motion.times") == before
    assert page("quatspline.drawing.controls.a.value") in SCHEMES


def test_times_that_are_close_stay_apart_in_the_address(page: Opened) -> None:
    times, q = np.array([0.0, 2e-9, 5e-9]), walk(7, 3, 40.0)[1]
    pasted(page, times, q)
    page.page.reload()
    np.testing.assert_allclose(page("quatspline.drawing.motion.times"), times, rtol=1e-5)


def test_two_thousand_keyframes_are_drawn(page: Opened) -> None:
    times, q = walk(8, 2000, 5.0)
    cost = page(
        "text => { const t = performance.now(); quatspline.drawing.paste(text); return performance.now() - t; }",
        "\n".join(",".join(map(str, (t, *key))) for t, key in zip(times, q, strict=True)),
    )
    print(f"2,000 pasted keyframes cost {cost:.0f} ms of script")
    assert page("quatspline.drawing.motion.times.length") == 2000
    assert page("quatspline.drawing.motion.samples.length") <= 5 * 2000


def test_keyframes_are_added_and_removed(page: Opened) -> None:
    count = "quatspline.drawing.motion.times.length"
    first = page(count)
    page("quatspline.drawing.seek(0.5)")
    page.page.locator("#drawn button[name=add]").click()
    assert page(count) == first + 1
    for _ in range(first + 3):
        page.page.locator("#drawn button[name=remove]").click()
    assert page(count) == 2


def test_script_per_change_is_told(page: Opened, record_property: Any) -> None:
    """Measured and reported: what a drag costs per frame."""
    cost = page(
        "(() => { const d = quatspline.drawing, all = [];"
        " for (let i = 0; i < 20; i++) { const t = performance.now();"
        " d._turnKeyframe(d.stages[0], 2, 1); all.push(performance.now() - t); }"
        " return all.sort((a, b) => a - b)[10]; })()"
    )
    record_property("milliseconds_per_drag", cost)
    print(f"a drag costs {cost:.1f} ms of script (median of 20)")
    assert len(page("quatspline.drawing.motion.keyframes")) == 5
