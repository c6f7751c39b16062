"""The player of recorded motion in a headless Chromium: it shows what Python computed, and obeys its reader."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pages import DESKTOP, EVERY, Opened, loop, replays
from quatspline import quaternion
from quatspline.motion import Motion
from quatspline.motion.replay import body_size, wires
from quatspline.trajectories.figure_walk import figure_walk

pytestmark = pytest.mark.browser

POSE = "quatspline.replay.pose()"
HALF = 0.5001
"""Of a step by which a place that is stored may be off."""

CALLS = 8
"""Times the points of all figures: the most calls of a canvas that a frame may make beside its curves' points."""

COUNT = """() => {
  const kinds = ["moveTo", "lineTo", "arc", "stroke", "fill", "fillText", "strokeText"], counts = { all: 0 };
  for (const kind of kinds) {
    const own = CanvasRenderingContext2D.prototype[kind];
    CanvasRenderingContext2D.prototype[kind] = function (...values) { counts.all++; return own.apply(this, values); };
  }
  const asked = window.getComputedStyle;
  counts.styles = 0;
  window.getComputedStyle = (...values) => { counts.styles++; return asked(...values); };
  quatspline.counts = counts;
}"""
"""Has the page count what its canvases are asked for, and how often a style is."""

FRAMES = """() => {
  const { replay } = quatspline, times = [];
  for (let k = 0; k < 300; k++) {
    const before = performance.now();
    replay.seek((k + 0.5) / 300 * replay.motion.span);
    times.push(performance.now() - before);
  }
  return times;
}"""


@pytest.fixture(scope="module")
def desktop(browser: Any, page_folder: Path) -> Iterator[Opened]:
    one = Opened(browser, page_folder / "report.html", viewport=DESKTOP)
    yield one
    one.context.close()


@pytest.fixture
def page(desktop: Opened) -> Iterator[Opened]:
    """The page opened once for many tests, the player at the start of the walk."""
    player = desktop.page.locator("#replay")
    player.get_by_label("Scheme A").select_option("slerp")
    player.get_by_label("Scheme B").select_option("quartic")
    desktop("quatspline.replay.choose(0)")
    yield desktop
    desktop.check()


@pytest.fixture(scope="module")
def walk() -> Motion:
    return figure_walk()


@pytest.fixture(scope="module")
def steps() -> list[float]:
    return [motion["step"] for motion in replays()]


def rebuilt(motion: Motion, scheme: str, t: float) -> Motion:
    """What a scheme makes of a frame, a skeleton on its root's true path."""
    q, x = motion.curve(scheme, EVERY)([t])
    one = motion.frames(np.array([round(t * (len(motion.times) - 1) / motion.times[-1])]))
    return one.moved(one.stamps, q, one.positions if motion.skeleton else x)


def test_figures_are_those_of_forward_kinematics(
    page: Opened, walk: Motion, steps: list[float]
) -> None:
    for frame in (0, 38, 250, 598):
        time = float(walk.times[frame])
        page("t => quatspline.replay.seek(t)", time)
        shown = page(POSE)
        assert shown["time"] == pytest.approx(time, abs=1e-6)
        assert (shown["keyframe"] >= 0) == (frame % EVERY == 0)
        near = {"atol": HALF * steps[0] + 2e-6, "rtol": 0.0}  # times are stored as 32-bit numbers
        truth = wires(walk.frames(np.array([frame]))).points[0]
        np.testing.assert_allclose(shown["truth"], truth, **near)
        for side, scheme in (("a", "slerp"), ("b", "quartic")):
            assert shown[side]["scheme"] == scheme
            expected = wires(rebuilt(walk, scheme, time)).points[0]
            np.testing.assert_allclose(shown[side]["points"], expected, **near)


def test_the_ghost_is_the_truth_and_schemes_meet_it_at_keyframes(
    page: Opened, steps: list[float]
) -> None:
    page("quatspline.replay.seek(0)")
    for k in range(5):
        shown = page(POSE)
        assert shown["keyframe"] == k
        for side in ("a", "b"):
            np.testing.assert_allclose(shown[side]["points"], shown["truth"], atol=2 * steps[0])
        between = shown["time"] + 0.5 * EVERY / 120.0
        page("t => quatspline.replay.seek(t)", between)
        off = np.array(page(POSE)["a"]["points"]) - np.array(page(POSE)["truth"])
        assert np.abs(off).max() > 20 * steps[0]
        page("quatspline.replay.jump(1)")


def test_between_frames_figures_go_straight(page: Opened, walk: Motion, steps: list[float]) -> None:
    page("t => quatspline.replay.seek(t)", float(0.25 * walk.times[100] + 0.75 * walk.times[102]))
    ends = [wires(walk.frames(np.array([k]))).points[0] for k in (100, 102)]
    expected = 0.25 * ends[0] + 0.75 * ends[1]
    np.testing.assert_allclose(page(POSE)["truth"], expected, atol=HALF * steps[0] + 4e-6)


def test_the_joint_picker_changes_the_error_curve(page: Opened, walk: Motion) -> None:
    picker = page.page.locator("#replay select[name=joint]")
    curve = "quatspline.replay.shown.sides.map((side) => side.errors)"
    frames = np.arange(0, 600, 2)
    off = {
        name: np.degrees(
            quaternion.distance(
                walk.curve(name, EVERY)(walk.times[frames])[0], walk.quaternions[frames]
            )
        )
        for name in ("slerp", "quartic")
    }
    rms = [np.sqrt((angles**2).mean(axis=1)) for angles in off.values()]
    np.testing.assert_allclose(page(curve), rms, atol=1e-4)
    strip = "document.querySelector('#replay canvas.strip').toDataURL()"
    before = page(strip)
    for joint in ("left forearm", "right shin"):
        picker.select_option(label=joint)
        own = [angles[:, walk.tracks.index(joint)] for angles in off.values()]
        np.testing.assert_allclose(page(curve), own, atol=1e-4)
        assert page(POSE)["joint"] == joint
        assert joint in page.page.inner_text("#replay figcaption.error")
        assert page(strip) != before
        before = page(strip)


def test_of_all_joints_the_one_farthest_off_is_seen_from_near(page: Opened, walk: Motion) -> None:
    frames = np.arange(0, 600, 2)
    q, _ = walk.curve("slerp", EVERY)(walk.times[frames])
    power = (quaternion.distance(q, walk.quaternions[frames]) ** 2).mean(axis=0)
    assert page(POSE)["joint"] == walk.tracks[int(power.argmax())]


def test_a_body_is_shown_with_its_path(page: Opened, steps: list[float]) -> None:
    page.page.select_option("#replay select[name=scene]", "1")
    motion = loop()
    frame = 72
    page("t => quatspline.replay.seek(t)", float(motion.times[frame]))
    shown, size = page(POSE), body_size(motion)
    near = {"atol": HALF * steps[1] + 1e-5, "rtol": 0.0}
    truth = wires(motion.frames(np.array([frame])), size).points[0]
    np.testing.assert_allclose(shown["truth"], truth, **near)
    expected = wires(rebuilt(motion, "quartic", float(motion.times[frame])), size).points[0]
    np.testing.assert_allclose(shown["b"]["points"], expected, **near)
    assert page("quatspline.replay.motion.path.length") == 200
    assert not page.page.locator("#replay select[name=joint]").is_visible()


def test_a_frame_costs_what_is_drawn_and_asks_for_no_style(
    opened: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    """Calls are counted and bounded; milliseconds are reported, since a machine may be busy."""
    page = opened()
    page(FRAMES)  # once for the browser's compiler
    times = np.array(page(FRAMES))
    with capsys.disabled():
        told = f"median {np.median(times):.2f} ms, 95 % below {np.quantile(times, 0.95):.2f} ms"
        print(f"\nplayer of the walk, script per frame: {told}, worst {times.max():.2f} ms")
    page(COUNT)
    page("quatspline.replay.seek(1.234)")
    counts = page("quatspline.counts")
    points, frames = page(
        "[quatspline.replay.shown.truth.length, quatspline.replay.motion.t.length]"
    )
    assert 0 < counts["all"] < CALLS * 3 * points + 3 * frames
    assert counts["styles"] == 0


def test_playing_takes_as_long_as_the_recording(page: Opened) -> None:
    """In the browser's own time, however slow it is: what a frame advances is what its clock did."""
    page("""() => { const { replay } = quatspline; replay.playing = true; replay.calm = { matches: false };
         replay._frame(1000, 900); replay.pause(); }""")
    assert page(POSE)["time"] == pytest.approx(0.1)


def test_keys_and_clicks_move_through_time(page: Opened) -> None:
    tab = page.page
    tab.focus("#replay canvas.figure")
    tab.keyboard.press("PageDown")
    assert page(POSE)["keyframe"] == 1
    tab.keyboard.press("ArrowRight")
    assert page(POSE)["time"] > EVERY / 120.0
    tab.keyboard.press("Shift+ArrowLeft")
    turns = page("quatspline.replay.views.map((view) => view.turn)")
    assert turns[0] == turns[1]
    tab.keyboard.press("Space")
    tab.wait_for_function(f"() => {POSE}.time > 0.4")
    tab.keyboard.press("Space")
    assert not page("quatspline.replay.playing")
    tab.keyboard.press("Home")
    assert page(POSE)["time"] == 0.0
    strip = tab.locator("#replay canvas.strip")
    strip.scroll_into_view_if_needed()
    box = strip.bounding_box()
    from_, until = page("quatspline.replay.strips[0].part")
    tab.mouse.click(box["x"] + 8 + 0.5 * (box["width"] - 16), box["y"] + 20)
    span = page("quatspline.replay.motion.span")
    assert page(POSE)["time"] == pytest.approx(0.5 * (from_ + until) * span, abs=0.03)


def test_on_a_phone_the_strip_shows_a_part_at_a_time(opened: Any) -> None:
    page = opened(viewport={"width": 390, "height": 844})
    part = "quatspline.replay.strips[0].part"
    page("quatspline.replay.seek(0)")
    first = page(part)
    assert first[0] == 0.0
    assert first[1] < 1.0
    page("quatspline.replay.seek(quatspline.replay.motion.span)")
    assert page(part)[1] == 1.0
    assert "Shown: " in page.page.inner_text("#replay figcaption.error")
    assert page("document.documentElement.scrollWidth") <= 390
