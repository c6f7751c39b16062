"""The golden numbers of `spec/golden.json`, which independent implementations computed."""

import json
from pathlib import Path

import numpy as np

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
