"""What `plain` does, by the compiled driver: imported with the first compilation."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from quatspline.engines import driver, misses
from quatspline.engines.compiler import address, machine
from quatspline.inputs.arrays import FloatArray
from quatspline.kernels.jit import Kernel

described = driver.described


def fit_tracks(kernel: Kernel, *arguments: Any) -> float:
    """See `plain.fit_tracks`."""
    return float(machine(driver.fit_tracks)(address(kernel), *arguments))


def largest_misses(kernel: Kernel, *arguments: Any) -> FloatArray:
    """See `plain.largest_misses`."""
    result: FloatArray = machine(misses.largest_misses)(address(kernel), *arguments)
    return result


def sampler() -> Callable[..., int]:
    """The driver itself: one call through another adds a tenth to the time per sample."""
    sample: Callable[..., int] = machine(driver.sample)
    return sample


def in_threads(
    sample: Callable[..., int],
    kernel: tuple[Any, ...],
    t: FloatArray,
    out: FloatArray,
    threads: int,
) -> int:
    """Run the driver on as many parts of the samples; the first bad index, or -1."""
    edges = np.linspace(0, t.size, threads + 1).astype(int).tolist()
    width = out.size // t.size
    with ThreadPoolExecutor(threads) as pool:
        runs = [
            pool.submit(partial(sample, *kernel), t[a:b], out[width * a : width * b])
            for a, b in pairwise(edges)
        ]
        found = [(run.result(), a) for run, a in zip(runs, edges, strict=False)]
    return min((index + a for index, a in found if index >= 0), default=-1)
