"""The golden numbers of `spec/golden.json`, which independent implementations computed."""

import json
from pathlib import Path

import numpy as np

from quatspline.catalogue import build
from quatspline.curve import Curve
from walks import apart

GOLDEN = json.loads((Path(__file__).parent / "data" / "golden.json").read_text())
META = GOLDEN["meta"]

Q = np.array(META["q"], dtype=float)
KNOTS = {
    kind: np.array(META[f"t_{kind}"], dtype=float) for kind in ("uniform", "nonuniform", "closed")
}
"""Times by what an entry says of its knots."""


def assert_golden(curve: Curve, entry: str, bounds: tuple[float, float, float]) -> None:
    """Orientations, velocities and accelerations of a curve are an entry's, within a bound each."""
    for value in GOLDEN["schemes"][entry]["values"]:
        for order, (kind, bound) in enumerate(zip(("q", "omega", "alpha"), bounds, strict=True)):
            wanted = np.array(value[kind], dtype=float)
            assert apart(curve(float(value["x"]), order), wanted) < bound, f"{kind} at {value['x']}"


NEW = json.loads((Path(__file__).parent / "data" / "golden_new.json").read_text())
"""Values of further schemes, each at 50 digits; entries are named `scheme variant knots`."""


def new_entries(start: str) -> list[str]:
    """The entries of `golden_new.json` whose name begins so: at least one."""
    found = [entry for entry in NEW["schemes"] if entry.startswith(start)]
    assert found, f"golden_new.json has no entry {start!r}"
    return found


def assert_golden_new(scheme: str, entry: str, **options: object) -> None:
    """A scheme's orientations are an entry's to 1e-12, ω to 1e-10 and α to 1e-8.

    `options` say in the scheme's terms what the entry says in words.
    """
    golden = NEW["schemes"][entry]
    given = NEW["meta"]["keyframes"][golden["knots"]]
    keyframes = np.array(given["raw_keyframes"], dtype=float)
    numbers = {
        name: np.array(value, dtype=float)
        for name, value in golden["options"].items()
        if not isinstance(value, str)
    }
    curve = build(
        scheme,
        np.array(given["times"], dtype=float),
        keyframes / np.linalg.norm(keyframes, axis=1, keepdims=True),
        closed=given["closed"],
        **numbers,
        **options,
    )
    for value in golden["values"]:
        for order, kind, bound in ((0, "q", 1e-12), (1, "omega", 1e-10), (2, "alpha", 1e-8)):
            wanted = np.array(value[kind], dtype=float)
            error = np.max(np.abs(curve(float(value["x"]), order) - wanted))
            assert error < bound, f"{entry}: {kind} at {value['x']} off by {error:.2g}"
