"""Finding schemes: files, folders, entry points; what breaks, and what must not be imported."""

import json
import os
import pickle
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import quatspline as qs
from processes import environment, python
from quatspline import catalogue, discovery
from quatspline.curve import Curve
from quatspline.engines import engine
from tools import new_scheme
from walks import walk

EXAMPLE = Path(__file__).parents[1] / "data" / "example_package"

HALF = '''
"""A scheme of two lines: turns by half of what slerp would."""
import numpy as np
from dataclasses import dataclass
from quatspline.curve import Curve
from quatspline import quaternion

@dataclass
class Setting:
    share: float = 0.5

class {name}(Curve):
    title = reference = "-"
    continuity, order, support, constant_rate = 0, 1, 2, "no"
    interpolates = False

    def _fit(self, keyframes):
        self.share = Setting().share

    def _orientation(self, t):
        return np.tile(self.keyframes.quaternions[0], (len(t), 1))
'''


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder that is looked through."""
    place = tmp_path / "mine"
    place.mkdir()
    monkeypatch.setenv(catalogue.FOLDERS, str(place))
    return place


# -- names --------------------------------------------------------------------------------------


def test_names_are_sorted_and_those_of_the_files() -> None:
    names = qs.schemes()
    assert names == sorted(names)
    assert {"quartic", "quintic", "local-quintic", "slerp", "nielson"} <= set(names)
    for name in names:
        assert qs.scheme(name).name == name
    assert not any(name.startswith("-") for name in catalogue.found())


def test_class_and_build_are_the_same() -> None:
    q = walk(5, 60.0)
    assert qs.scheme("quartic") is qs.QuarticSpline
    t = np.linspace(0, 4, 9)
    assert np.array_equal(qs.build("quartic", None, q)(t), qs.QuarticSpline(None, q)(t))


def test_unknown_names_offer_the_nearest() -> None:
    for call in (qs.scheme, lambda name: qs.build(name, None, walk(4, 30.0))):
        with pytest.raises(ValueError, match=r"unknown scheme 'quatric': did you mean 'quartic'\?"):
            call("quatric")
        with pytest.raises(ValueError, match=r"unknown scheme 'xyzzy': known: .*slerp"):
            call("xyzzy")
        with pytest.raises(ValueError, match=r"unknown scheme '_template'"):
            call("_template")


def test_a_folder_that_is_not_there_is_told_with_an_unknown_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(catalogue.FOLDERS, str(tmp_path / "gone"))
    with pytest.raises(
        ValueError, match=r"\(QUATSPLINE_BASELINES names .*gone, which is no folder"
    ):
        qs.scheme("mine")
    monkeypatch.setenv(catalogue.FOLDERS, str(tmp_path))
    with pytest.raises(
        ValueError, match=r"unknown scheme 'mine': did you mean [^()]*$|known: [^()]*$"
    ):
        qs.scheme("mine")


def test_names_that_are_no_strings() -> None:
    for wrong in (None, 3, ["quartic"], qs.QuarticSpline):
        with pytest.raises(ValueError, match="unknown scheme"):
            qs.scheme(wrong)  # type: ignore[arg-type]


# -- files --------------------------------------------------------------------------------------


def test_a_file_is_a_scheme(folder: Path) -> None:
    (folder / "half_turn.py").write_text(HALF.format(name="Half"))
    (folder / "_helper.py").write_text("raise RuntimeError('not to be loaded')")
    (folder / "notes.txt").write_text("no scheme")
    assert "half-turn" in qs.schemes()
    curve = qs.build("half-turn", None, walk(4, 30.0))
    assert curve.name == "half-turn"
    assert curve(0.5).shape == (4,)
    assert "helper" not in str(catalogue.found())


def test_a_pickle_finds_a_file_by_name(folder: Path) -> None:
    (folder / "half_pickled.py").write_text(HALF.format(name="Half"))
    data = pickle.dumps(qs.build("half-pickled", None, walk(4, 30.0)))
    assert python(f"import pickle; print(pickle.loads({data!r})(0.5).shape)") == "(4,)"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("import no_such_module", "ModuleNotFoundError: No module named 'no_such_module'"),
        ("def (:", "SyntaxError"),
        ("raise SystemExit(3)", "SystemExit: 3"),
        ("1 / 0", "ZeroDivisionError"),
        ("from quatspline.curve import Curve", "one subclass of Curve expected, 0 found"),
        (HALF.format(name="One") + HALF.format(name="Two"), "one subclass .* 2 found"),
    ],
)
def test_a_broken_file_does_not_take_others_down(folder: Path, text: str, reason: str) -> None:
    others = set(qs.schemes())
    (folder / "broken_one.py").write_text(text)
    (folder / "whole.py").write_text(HALF.format(name="Whole"))
    assert set(qs.schemes()) == others | {"whole"}
    item = catalogue.found()["broken-one"]
    assert item.scheme is None
    with pytest.raises(ValueError, match=f"scheme 'broken-one' cannot be used: .*{reason}"):
        qs.scheme("broken-one")


def test_underscored_classes_are_helpers(folder: Path) -> None:
    text = HALF.format(name="_Base") + "\nclass Real(_Base):\n    title = 'Real'\n"
    (folder / "real.py").write_text(text)
    assert qs.scheme("real").title == "Real"


def test_a_duplicate_takes_out_the_two(folder: Path) -> None:
    others = set(qs.schemes()) - {"slerp"}
    (folder / "slerp.py").write_text(HALF.format(name="Slerp"))
    assert set(qs.schemes()) == others
    told = r"cannot be used: two schemes are called 'slerp': .*slerp\.py and .*slerp\.py"
    with pytest.raises(ValueError, match=told):
        qs.scheme("slerp")


def test_several_folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    places = [tmp_path / name for name in ("a", "b")]
    for place in places:
        place.mkdir()
        (place / f"from_{place.name}.py").write_text(HALF.format(name="Half"))
    missing = tmp_path / "missing"
    monkeypatch.setenv(catalogue.FOLDERS, os.pathsep.join(map(str, [*places, missing, ""])))
    assert {"from-a", "from-b"} <= set(qs.schemes())
    assert qs.scheme("from-a") is not qs.scheme("from-b")


def test_a_folder_named_twice_counts_once(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "once.py").write_text(HALF.format(name="Once"))
    shipped = discovery.shipped("baselines")
    monkeypatch.setenv(
        catalogue.FOLDERS, os.pathsep.join([str(folder), f"{folder}/", str(shipped)])
    )
    assert "once" in qs.schemes()


def test_a_peer_that_is_not_installed(folder: Path) -> None:
    text = HALF.format(name="Absent") + "    peer = 'quatspline-no-such-distribution'\n"
    (folder / "absent.py").write_text(text)
    assert "absent" not in qs.schemes()
    with pytest.raises(ValueError, match="no-such-distribution is not installed"):
        qs.scheme("absent")


# -- packages -----------------------------------------------------------------------------------


@pytest.fixture
def installed(tmp_path: Path) -> Path:
    """The example package as an installer leaves it: its module and its dist-info."""
    shutil.copy(EXAMPLE / "quatspline_example.py", tmp_path)
    info = tmp_path / "quatspline_example-1.0.0.dist-info"
    info.mkdir()
    facts = "Metadata-Version: 2.1\nName: quatspline-example\nVersion: 1.0.0\n"
    (info / "METADATA").write_text(facts)
    import tomllib

    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text())["project"]
    group = project["entry-points"][discovery.ENTRY_POINTS]
    lines = [f"{name} = {target}" for name, target in group.items()]
    (info / "entry_points.txt").write_text("\n".join([f"[{discovery.ENTRY_POINTS}]", *lines, ""]))
    return tmp_path


def test_packages_register_by_entry_point(installed: Path) -> None:
    code = """
import quatspline as qs
assert "hold-example" in qs.schemes()
curve = qs.build("hold-example", None, [[1, 0, 0, 0], [0.8, 0.6, 0, 0]])
import pickle
copy = pickle.loads(pickle.dumps(curve))
print(curve.name, curve(0.5).tolist(), copy(1.0).tolist(), qs.scheme("hold-example").__module__)
"""
    wanted = "hold-example [1.0, 0.0, 0.0, 0.0] [0.8, 0.6, 0.0, 0.0] quatspline_example"
    assert python(code, installed) == wanted


def test_a_broken_package_does_not_take_others_down(installed: Path) -> None:
    (installed / "quatspline_example.py").write_text("raise OSError('no library')")
    code = """
import quatspline as qs
from quatspline.catalogue import found
print(found()["hold-example"].problem, "slerp" in qs.schemes())
"""
    assert python(code, installed) == "OSError: no library True"


def test_an_entry_point_that_is_no_scheme(installed: Path) -> None:
    (installed / "quatspline_example.py").write_text("Hold = 3")
    code = """
import quatspline as qs
from quatspline.catalogue import found
print(found()["hold-example"].problem, "slerp" in qs.schemes())
"""
    assert python(code, installed) == "TypeError: not a subclass of Curve: 3 True"


# -- imports ------------------------------------------------------------------------------------


def test_import_is_light() -> None:
    code = """
import sys, json, quatspline
heavy = ["numba", "scipy", "matplotlib", "pandas", "joblib", "numpy"]
print(json.dumps([name for name in heavy if name in sys.modules]))
"""
    assert json.loads(python(code)) == []


def test_listing_schemes_imports_no_peer() -> None:
    code = """
import sys, json, quatspline
quatspline.schemes()
heavy = ["matplotlib", "pandas", "splines", "interpolatepy", "rowan", "quaternionic"]
print(json.dumps([name for name in heavy if name in sys.modules]))
"""
    assert json.loads(python(code)) == []


@pytest.mark.parametrize("first", ["qs.schemes()", "qs.QuarticSpline", "qs.Curve"])
def test_names_stay_what_they_are(first: str) -> None:
    """The subpackage `schemes` does not take the place of the function, whatever comes first."""
    code = f"""
import quatspline as qs
{first}
assert qs.schemes() == qs.schemes()
from quatspline.proposed.quartic import QuarticSpline
assert QuarticSpline is qs.QuarticSpline is qs.scheme("quartic")
assert set(qs.__all__) <= set(dir(qs))
print(callable(qs.schemes))
"""
    assert python(code) == "True"


def test_unknown_attributes() -> None:
    with pytest.raises(AttributeError, match="no attribute 'quatric'"):
        _ = qs.quatric
    for name in qs.__all__:
        assert getattr(qs, name) is not None


# -- the template -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("flags", "base", "numeric"),
    [([], "Curve", (1, 2)), (["--compiled"], "SegmentCurve", ())],
    ids=["plain", "compiled"],
)
def test_scaffold_writes_a_working_scheme(
    flags: list[str],
    base: str,
    numeric: tuple[int, ...],
    folder: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv(engine.VARIABLE, "python")
    assert new_scheme.main(["my_scheme", str(folder), *flags]) == 0
    written = folder / "my_scheme.py"
    assert str(written) in capsys.readouterr().out
    assert f"class MyScheme({base}):" in written.read_text()
    curve = qs.build("my-scheme", None, walk(5, 60.0), closed=True)
    assert np.abs(np.linalg.norm(curve(np.linspace(-3.0, 9.0, 50)), axis=-1) - 1.0).max() < 1e-14
    assert curve(0.5, 2).shape == (3,)
    assert curve.numeric_orders == numeric


@pytest.mark.parametrize("flags", [[], ["--compiled"]], ids=["plain", "compiled"])
def test_scaffold_passes_its_own_checks(flags: list[str], folder: Path) -> None:
    """What `make check-baseline NAME=...` runs."""
    new_scheme.main(["my-checked", str(folder), *flags])
    tests = [
        str(Path(__file__).parents[1] / "schemes" / f"test_{name}.py")
        for name in ("conformance", "claims")
    ]
    options = ["-q", "-x", "-p", "no:cacheprovider", "-p", "no:randomly", "--scheme", "my_checked"]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *options, *tests, "-k", "my-checked"],
        capture_output=True,
        text=True,
        env=environment(),
        cwd=Path(__file__).parents[2],
        check=False,
    )
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    assert " passed" in done.stdout
    assert "failed" not in done.stdout


@pytest.mark.parametrize("template", [new_scheme.TEMPLATE, new_scheme.COMPILED])
def test_templates_have_little_but_comments_to_replace(template: str) -> None:
    text = (discovery.shipped("baselines") / template).read_text(encoding="utf-8")
    code = [line for line in text.splitlines() if line.strip() and line.lstrip()[0] != "#"]
    assert len(code) <= 100


def test_the_template_names_every_claim_and_hook() -> None:
    """What a scheme may set or write, it meets there."""
    text = (discovery.shipped("baselines") / new_scheme.TEMPLATE).read_text(encoding="utf-8")
    claims = set(Curve.__annotations__) - {"name", "solve_report"}  # made, not written
    hooks = {"_fit", "_orientation", "_velocity", "_acceleration", "_conclude"}
    assert not {name for name in claims | hooks if not re.search(rf"\b{name}\b", text)}


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("", "not a name"),
        ("2fast", "not a name"),
        ("../evil", "not a name"),
        ("_hidden", "not a name"),
        ("class", "not a name"),
        ("with space", "not a name"),
        ("Slerp.py", "not a name"),
        ("slerp", "'slerp' is there already"),
        ("local_quintic", "'local-quintic' is there already"),
    ],
)
def test_scaffold_refuses(
    name: str, message: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert new_scheme.main([name, str(folder)]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1
    assert list(folder.iterdir()) == []


def test_scaffold_does_not_overwrite(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "precious.py").write_text("mine")
    assert new_scheme.main(["precious", str(folder)]) == 2
    assert (folder / "precious.py").read_text() == "mine"
    assert new_scheme.main(["other", str(folder / "nowhere")]) == 2
    assert capsys.readouterr().err.count("\n") == 2


def test_this_projects_own_schemes_are_marked_and_the_papers_is_not() -> None:
    proposed = {
        path.stem.replace("_", "-") for path in (discovery.PACKAGE / "proposed").glob("[!_]*.py")
    }
    marked = {name for name in catalogue.found() if catalogue.called(name) == f"{name} (ours)"}
    assert marked == proposed - {"quartic"}
    assert catalogue.called("slerp") == "slerp"
    assert catalogue.called("no-such-scheme") == "no-such-scheme"
