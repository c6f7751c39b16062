"""Compile every kernel once, so that no first measurement waits: ``python -m quatspline.warmup``."""

from __future__ import annotations

import sys
import time

import numpy as np

from quatspline.families.segments import SegmentCurve
from quatspline.quaternion import exp
from quatspline.registry import found


def warm_up() -> int:
    """Build and evaluate every compiled scheme on a few keyframes; returns how many there were."""
    quaternions = exp(np.outer(np.linspace(0.0, 2.0, 6), (0.3, 0.4, 0.5)))
    count = 0
    for item in found().values():
        if item.scheme is None or not issubclass(item.scheme, SegmentCurve):
            continue
        curve = item.scheme(None, quaternions)
        for order in curve.orders:
            for kernels in (curve.family.near, curve.family.far):
                curve.kernels = kernels
                curve(0.5, order)
        count += 1
    return count


if __name__ == "__main__":
    start = time.perf_counter()
    number = warm_up()
    print(f"compiled {number} schemes in {time.perf_counter() - start:.0f} s", file=sys.stderr)
