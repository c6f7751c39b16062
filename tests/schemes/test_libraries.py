"""The libraries that products are built on: what `docs/peers.md` tells of them, in the smallest case.

What such a test asserts is a property of a library at a version: a release that changes it makes the test
fail, and then the page is to be rewritten.
"""

import importlib.metadata
import math
import os
import shutil
import signal
import subprocess

import numpy as np
import pytest

import quatspline as qs
from quatspline import quaternion
from quatspline.catalogue import found
from quatspline.claims import libraries
from quatspline.claims.claim import DEPARTS, HOLDS, UNKNOWN, Claim, judged
from quatspline.claims.published import published
from quatspline.peers import controls, installed, node
from quatspline.quaternion import FloatArray
from walks import apart, apart_up_to_sign, inside, loop, uneven, walk

pytestmark = pytest.mark.peers

SAME = 1e-13
HALF = math.sqrt(0.5)
ONE, ABOUT_X = (1.0, 0.0, 0.0, 0.0), (HALF, HALF, 0.0, 0.0)
"""No rotation, and 90 degrees about x."""
SHORT, LONG = math.radians(45.0) / 2.0, math.radians(-135.0) / 2.0
"""Half the angles between the two: the short way's, and the long way's to the negated quaternion."""


def here(name: str) -> None:
    """Skip where a scheme's library is not installed."""
    item = found()[name]
    if item.scheme is None:
        pytest.skip(item.problem)


def about_x(half: float) -> FloatArray:
    return np.array([math.cos(half), math.sin(half), 0.0, 0.0])


# -- quaternions with the other sign ------------------------------------------------------------


def test_glm_mixes_the_long_way_and_slerps_the_short_one() -> None:
    here("pyglm-mix")
    from pyglm import glm

    a, b = glm.dquat(*ONE), -glm.dquat(*ABOUT_X)
    for call, half in ((glm.slerp, SHORT), (glm.mix, LONG)):
        q = call(a, b, 0.5)
        assert apart_up_to_sign(np.array([q.w, q.x, q.y, q.z]), about_x(half)) < SAME


def test_spatialmath_goes_the_long_way_unless_told_otherwise() -> None:
    here("spatialmath-qslerp")
    from spatialmath.base import qslerp

    a, b = np.array(ONE), -np.array(ABOUT_X)
    assert apart_up_to_sign(qslerp(a, b, 0.5), about_x(LONG)) < SAME
    assert apart_up_to_sign(qslerp(a, b, 0.5, shortest=True), about_x(SHORT)) < SAME


def test_pyquaternion_negates_its_first_argument() -> None:
    here("pyquaternion-slerp")
    from pyquaternion import Quaternion

    a, b = Quaternion(*ONE), -Quaternion(*ABOUT_X)
    Quaternion.slerp(a, b, 0.5)
    assert list(a) == [-1.0, 0.0, 0.0, 0.0]


# -- squads -------------------------------------------------------------------------------------


def test_vtk_spline_gives_w_in_degrees() -> None:
    """0, 20, 40 degrees about x at t = 0, 1, 2: w is 180 / pi times what it should be."""
    here("vtk-spline")
    from vtkmodules.vtkCommonMath import vtkQuaternionInterpolator

    spline = vtkQuaternionInterpolator()
    spline.SetInterpolationTypeToSpline()
    for k in range(3):
        spline.AddQuaternion(float(k), about_x(math.radians(20.0 * k) / 2.0))
    q = [0.0] * 4
    for t in (0.25, 1.0, 1.5):  # 1 is a keyframe
        spline.InterpolateQuaternion(t, q)
        w, x, *_ = about_x(math.radians(20.0 * t) / 2.0)
        assert q == pytest.approx([math.degrees(w), x, 0.0, 0.0], rel=1e-9)


def test_quat_numpy_squad_leaves_squad_where_steps_are_large() -> None:
    """The slerp of inner quaternions more than 90 degrees apart on S^3 goes to the other sign."""
    here("quat-numpy-squad")
    from quat import Quaternion, squad

    for degrees, leaves in ((100.0, False), (150.0, True)):
        q = quaternion.align(walk(4, degrees, 3))
        middle = squad(*(Quaternion(*row) for row in q.tolist()), 0.5)
        wanted = qs.build("squad", None, q, ends="secant")(1.5)
        off = apart_up_to_sign(np.array(list(middle)), wanted)
        assert (off > 1.0) if leaves else (off < 1e-12)


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("name", ["quat-numpy-squad", "gl-matrix-sqlerp"])
def test_squads_are_squad_where_steps_are_small(name: str, closed: bool) -> None:
    here(name)
    times = uneven(9) if qs.scheme(name).non_uniform else np.arange(9.0)
    q = loop(times, 1) if closed else walk(9, 60.0, 3)
    curve, ours = (qs.build(n, times, q, closed=closed, **o) for n, o in (
        (name, {}), ("squad", {"ends": "secant"})))  # fmt: skip
    assert apart(curve(inside(times)), ours(inside(times))) < SAME


# -- times, lengths, rates ----------------------------------------------------------------------


def test_usd_holds_a_sample_until_the_next_if_that_is_near() -> None:
    here("usd-orient")
    keys = np.array([ONE, ABOUT_X])
    for spacing, held in ((0.9e-6, True), (1.1e-6, False)):
        middle = qs.build("usd-orient", [0.0, spacing], keys)(0.5 * spacing)
        assert apart_up_to_sign(middle, keys[0] if held else about_x(SHORT)) < SAME


@pytest.mark.parametrize("name", ["vtk-linear", "usd-orient", "gl-matrix-slerp", "babylon-slerp"])
def test_chords_of_small_steps_are_not_normalised(name: str) -> None:
    here(name)
    lengths = {}
    for degrees in (0.02, 1.0):
        half = math.radians(degrees) / 2.0
        curve = qs.build(name, None, np.array([ONE, about_x(half)]))
        lengths[degrees] = 1.0 - np.linalg.norm(curve(0.5))
    assert 1e-9 < lengths[0.02] < 1e-8
    assert lengths[1.0] < SAME


def test_drake_gives_rates_in_the_world_frame() -> None:
    here("drake-slerp")
    from pydrake.common.eigen_geometry import Quaternion
    from pydrake.trajectories import PiecewiseQuaternionSlerp

    times, q = uneven(6), quaternion.align(walk(6, 70.0, 3))
    curve, ours = (qs.build(name, times, q) for name in ("drake-slerp", "slerp"))
    direct = PiecewiseQuaternionSlerp(times.tolist(), [Quaternion(row) for row in q])
    t = inside(times)
    world = np.array([direct.angular_velocity(x) for x in t])
    assert apart(curve(t, 1, frame="world"), world) < SAME
    assert apart(curve(t, 1), ours(t, 1)) < 1e-12
    assert apart(world, ours(t, 1)) > 0.1
    assert np.abs(curve(t, 2)).max() == 0.0


def test_spice_reads_ticks_between_instances() -> None:
    here("spiceypy-ck3")
    curve = qs.build("spiceypy-ck3", [3.0, 5.0], np.array([ONE, ABOUT_X]))
    assert apart(curve([4.0, 3.0, 5.0]), np.array([about_x(SHORT), ONE, ABOUT_X])) < SAME
    assert curve([]).shape == (0, 4)


# -- claims -------------------------------------------------------------------------------------

VERDICTS = {
    "vtk-spline": {"length": DEPARTS, "squad": DEPARTS},
    "quat-numpy-squad": {"other sign": DEPARTS, "squad": DEPARTS},
    "gl-matrix-sqlerp": {"squad": DEPARTS},
    "pyglm-mix": {"other sign": HOLDS},
    "spatialmath-qslerp": {"sign moves": HOLDS, "shortest mends": HOLDS},
}


@pytest.mark.parametrize("name", VERDICTS)
def test_what_libraries_say_is_measured(name: str) -> None:
    here(name)
    rows = [judged(claim) for claim in published(name)]
    for words, verdict in VERDICTS[name].items():
        (row,) = [row for row in rows if words in row["claim"]]
        assert row["verdict"] == verdict, row


def test_a_library_that_is_not_here_leaves_its_claims_open() -> None:
    gone = [claim for claim in libraries.claims() if found()[claim.scheme].scheme is None]
    assert all(judged(claim)["verdict"] == UNKNOWN for claim in gone)
    assert all(isinstance(claim, Claim) and claim.probes for claim in libraries.claims())


# -- what is installed --------------------------------------------------------------------------


def test_what_is_not_installed_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    def absent(name: str) -> str:
        raise importlib.metadata.PackageNotFoundError(name)

    known = [*importlib.metadata.requires("quatspline"), "no-such-thing>=1; extra == 'peers-heavy'"]
    monkeypatch.setattr(importlib.metadata, "version", absent)
    monkeypatch.setattr(importlib.metadata, "requires", lambda name: known)
    for peer, extra in {"rowan": "peers", "No_such.thing": "peers-heavy"}.items():
        with pytest.raises(
            installed.NotInstalledError,
            match=rf"^{peer} is not installed \(extra '{extra}'\)$",
        ):
            installed.version(peer)
    with pytest.raises(installed.NotInstalledError, match=r"^unheard-of is not installed$"):
        installed.version("unheard-of")


def test_packages_of_javascript_need_node(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(installed.NotInstalledError, match="node is not installed, which three"):
        installed.version("npm:three")
    monkeypatch.setattr(shutil, "which", lambda name: "/usr/bin/node")
    with pytest.raises(installed.NotInstalledError, match=r"nothing .*\(make peers-node\)"):
        installed.version("npm:nothing")


# -- the bridge to JavaScript -------------------------------------------------------------------


@pytest.mark.parametrize("closed", [False, True])
def test_babylon_plays_the_cubic_of_gltf(closed: bool) -> None:
    here("babylon-hermite")
    times = uneven(8)
    q = loop(times, 1, wobble=0.5) if closed else walk(8, 70.0, 3)
    theirs, ours = (
        qs.build(name, times, q, closed=closed) for name in ("babylon-hermite", "gltf-cubic")
    )
    assert apart(theirs(inside(times)), ours(inside(times))) < SAME


def test_tangents_are_those_of_parabolas() -> None:
    times = uneven(6)
    parabola = np.stack([times**2, 3.0 * times - 1.0], axis=1)
    chords = np.diff(parabola, axis=0) / np.diff(times)[:, None]
    slopes = controls.parabola_slopes(chords, np.diff(times), closed=False)
    assert apart(slopes, np.stack([2.0 * times, np.full(6, 3.0)], axis=1)) < SAME
    short = controls.parabola_slopes(chords[:1], np.diff(times)[:1], closed=False)
    assert apart(short, chords[[0, 0]]) == 0.0


def test_an_error_of_javascript_is_told_and_the_next_call_answered() -> None:
    here("three-slerp")
    curve = qs.build("three-slerp", None, walk(4, 50.0))
    before = curve(1.5)
    with pytest.raises(RuntimeError, match="no such call, by node"):
        node.bridge().ask("no such call", np.zeros((2, 5)), np.zeros((1, 3)))
    assert np.array_equal(curve(1.5), before)


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no signals here")
def test_a_bridge_that_was_killed_is_built_again() -> None:
    here("three-slerp")
    curve = qs.build("three-slerp", None, walk(4, 50.0))
    before = curve(1.5)
    process = node.bridge().process
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    assert np.array_equal(curve(1.5), before)
    assert node.bridge().process.pid != process.pid


def test_gl_matrix_keeps_single_precision_that_was_made_at_import() -> None:
    """A type set after the import does not reach what sqlerp keeps between calls."""
    here("gl-matrix-sqlerp")
    script = """
        import { glMatrix, quat } from 'gl-matrix';
        glMatrix.setMatrixArrayType(Float64Array);
        const q = Float64Array.of(0.6, 0, 0, 0.8);
        for (const call of [() => quat.slerp(quat.create(), q, q, 0.5),
                            () => quat.sqlerp(quat.create(), q, q, q, q, 0.5)])
            console.log(Math.abs(call()[0] - 0.6));
    """
    command = ["node", "--input-type=module", "--eval", script]
    done = subprocess.run(
        command, cwd=installed.JAVASCRIPT, capture_output=True, text=True, check=True
    )
    slerp, sqlerp = map(float, done.stdout.split())
    assert slerp < 1e-15
    assert 1e-9 < sqlerp < 1e-7
