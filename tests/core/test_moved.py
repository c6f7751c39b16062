"""Modules under their names of version 0.1: the same modules, with a warning."""

from __future__ import annotations

import copy
import importlib
import sys
from pathlib import Path

import numpy as np
import pytest

import quatspline as qs
from processes import python
from quatspline.system.moved import LEFT, MOVED, today
from walks import walk


@pytest.mark.parametrize("old", MOVED)
def test_an_old_name_is_the_module_of_today(old: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, f"quatspline.{old}", raising=False)
    with pytest.warns(DeprecationWarning, match=f"quatspline.{MOVED[old]}"):
        module = importlib.import_module(f"quatspline.{old}")
    assert module is importlib.import_module(f"quatspline.{MOVED[old]}")
    assert module.__spec__ is not None
    assert module.__spec__.name == f"quatspline.{MOVED[old]}"


def test_names_of_today_and_unknown_ones_are_left_alone() -> None:
    assert today("quatspline.curve") == "quatspline.curve"
    assert today("quatspline._jit") == "quatspline.kernels.jit"
    with pytest.raises(ModuleNotFoundError, match=r"quatspline\.nothing"):
        importlib.import_module("quatspline.nothing")


def test_modules_of_a_moved_package_are_found_once() -> None:
    with pytest.warns(DeprecationWarning, match="quatspline.motion.files"):
        old = importlib.import_module("quatspline.trajectories.files.npz")
    assert old is importlib.import_module("quatspline.motion.files.npz")
    assert today("quatspline.report.page.document") == "quatspline.page.document"


@pytest.mark.parametrize("old", LEFT)
def test_a_module_that_left_the_package_is_told_where_it_is(old: str) -> None:
    with pytest.raises(ModuleNotFoundError, match=LEFT[old]):
        importlib.import_module(f"quatspline.{old}")
    assert (Path(__file__).parents[2] / LEFT[old]).is_file()


def test_what_one_module_of_inputs_held_is_in_its_arrays() -> None:
    inputs = importlib.import_module("quatspline.inputs")
    with pytest.warns(DeprecationWarning, match=r"quatspline\.inputs\.arrays\.float_array"):
        assert inputs.float_array is importlib.import_module("quatspline.inputs.arrays").float_array
    with pytest.raises(AttributeError, match="nothing"):
        _ = inputs.nothing
    with pytest.raises(ImportError):
        importlib.import_module("quatspline.inputs.float_array")


def test_old_names_leave_the_public_functions_alone() -> None:
    code = (
        "import warnings; warnings.simplefilter('ignore')\n"
        "import quatspline as qs, quatspline.registry, quatspline.report.results\n"
        "print(callable(qs.schemes), callable(qs.scheme), qs.registry.found is qs.catalogue.found)"
    )
    assert python(code).split() == ["True"] * 3


def test_a_class_pickles_before_any_catalogue_saw_it() -> None:
    code = (
        "import pickle, sys\n"
        "from quatspline.proposed.quartic import QuarticSpline\n"
        "curve = QuarticSpline(None, [[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0, 0.6, 0.8, 0]])\n"
        "assert 'quatspline.catalogue' not in sys.modules\n"
        "twin = pickle.loads(pickle.dumps(curve))\n"
        "print((twin(0.3) == curve(0.3)).all(), 'quatspline.catalogue' in sys.modules)"
    )
    assert python(code).split() == ["True", "False"]


@pytest.mark.parametrize("name", ["quartic", "squad", "kim", "scipy-slerp"])
def test_a_copy_is_a_curve_of_its_own(name: str) -> None:
    curve = qs.build(name, None, walk(5, 40.0))
    twin = copy.deepcopy(curve)
    assert twin is not curve
    assert twin.keyframes is not curve.keyframes
    np.testing.assert_array_equal(twin([0.3, 2.5]), curve([0.3, 2.5]))
