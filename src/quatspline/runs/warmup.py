"""Compile every kernel once, so that nothing waits: ``quatspline warmup``."""

from __future__ import annotations

import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor

import numpy as np

from quatspline import quaternion
from quatspline.catalogue import found, scheme, schemes
from quatspline.engines.engine import always_compiled, mark_warm
from quatspline.segments import SegmentCurve


def compiled_schemes() -> list[str]:
    """Names of the schemes that have kernels."""
    return [
        name
        for name, item in found().items()
        if item.scheme is not None and issubclass(item.scheme, SegmentCurve)
    ]


def warm_up(name: str) -> None:
    """Build and evaluate one compiled scheme on a few keyframes, all orders, both angle ranges."""
    with always_compiled():
        curve = scheme(name)(None, _keyframes())
        assert isinstance(curve, SegmentCurve)
        for order in curve.orders:
            for kernels in (curve.family.near, curve.family.far):
                curve.kernels = kernels
                curve(0.5, order)


def _keyframes() -> quaternion.FloatArray:
    return quaternion.exp(np.outer(np.linspace(0.0, 2.0, 6), (0.3, 0.4, 0.5)))


def main() -> None:
    """Compile what every scheme of this package needs, side by side."""
    start = time.perf_counter()
    names = compiled_schemes()
    warm_up("slerp")  # what all schemes share, before processes part
    with always_compiled():
        quaternion.log(quaternion.mul(_keyframes(), quaternion.conj(_keyframes())))
    for name in schemes():  # peers with compiled caches of their own fill them in one process
        if scheme(name).peer is not None:
            scheme(name)(None, _keyframes())([0.5, 1.5])
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(warm_up, names))
    mark_warm()
    print(f"compiled {len(names)} schemes in {time.perf_counter() - start:.0f} s", file=sys.stderr)


if __name__ == "__main__":
    main()
