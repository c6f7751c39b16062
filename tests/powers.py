"""Polynomials as segments keep them (`families.polynomials`), and by powers of u, as papers print them."""

import numpy as np

from quatspline.quaternion import FloatArray


def powers(kept: FloatArray) -> FloatArray:
    """Coefficients of u^0 to u^5 (..., 6) of f_0, r, g_0 ... g_3 (..., 6)."""
    f0, rise, *g = np.moveaxis(kept, -1, 0)
    return np.stack([f0, rise + g[0], g[1] - g[0], g[2] - g[1], g[3] - g[2], -g[3]], axis=-1)


def kept(coefficients: FloatArray) -> FloatArray:
    """The inverse of `powers`."""
    c = np.moveaxis(coefficients, -1, 0)
    g = [-c[k:].sum(axis=0) for k in (2, 3, 4, 5)]
    return np.stack([c[0], c[1:].sum(axis=0), *g], axis=-1)
