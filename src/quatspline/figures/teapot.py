"""The Utah teapot's control points, and points on bicubic Bezier patches.

M. E. Newell's teapot (University of Utah, 1975) is 28 bicubic patches for rim, body, handle, spout
and lid; the four patches of the bottom were added later. The numbers stand in `data/teapot.txt`.
"""

from functools import cache
from importlib.resources import files

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

# Handle and spout are cut where they are this fraction of the body's radius away from its axis:
# just inside its wall, so that the join shows no gap.
_CUT = 0.985


@cache
def teapot_patches() -> tuple[tuple[str, ...], FloatArray]:
    """Return the part that each patch belongs to (32 names) and the control nets (32, 4, 4, 3).

    Units and axes are the published ones: z up from 0 to 3.15, spout towards +x, mirror plane
    y = 0. Every patch's (u × v) normal points inwards. The array is read-only: it is cached.
    """
    text = (files("quatspline.figures") / "data" / "teapot.txt").read_text(encoding="utf-8")
    rows = [line.split() for line in text.splitlines() if line[:1] in ("v", "p")]
    points = np.array([row[1:] for row in rows if row[0] == "v"], dtype=np.float64)
    parts = tuple(row[1] for row in rows if row[0] == "p")
    nets = points[np.array([row[2:] for row in rows if row[0] == "p"], dtype=np.intp)]
    nets = nets.reshape(-1, 4, 4, 3)
    nets.setflags(write=False)
    return parts, nets


def bernstein(u: FloatArray) -> FloatArray:
    """Return the four cubic Bernstein polynomials at u: shape (k,) to (k, 4)."""
    # notation: v = 1 - u
    v = 1.0 - u
    return np.stack([v**3, 3.0 * u * v**2, 3.0 * u**2 * v, u**3], axis=-1)


def patch_points(nets: FloatArray, resolution: int) -> FloatArray:
    """Return an evenly spaced grid of points on each patch: (p, 4, 4, 3) to (p, r+1, r+1, 3)."""
    if resolution < 1:
        raise ValueError(f"a patch needs at least one cell a side, not {resolution}")
    basis = bernstein(np.linspace(0.0, 1.0, resolution + 1))
    points: FloatArray = np.einsum("ai,bj,pijc->pabc", basis, basis, nets)
    return points


def outer_points(nets: FloatArray, resolution: int) -> FloatArray:
    """Return points on handle or spout patches as `patch_points` does, but outside the body only.

    Each line along the first parameter is cut where it enters the body, to the step of a fine
    search, and divided evenly: what lies inside the pot would only disturb sorting by depth.
    """
    fine = np.linspace(0.0, 1.0, 257)
    even = np.linspace(0.0, 1.0, resolution + 1)
    across = bernstein(even)
    x, y, z = np.moveaxis(np.einsum("ai,bj,pijc->pabc", bernstein(fine), across, nets), -1, 0)
    outside = np.hypot(x, y) > _CUT * np.interp(z, *_body_radius())
    start = fine[outside.argmax(axis=1)][:, None]
    stop = fine[::-1][outside[:, ::-1].argmax(axis=1)][:, None]
    along = bernstein(start + (stop - start) * even[:, None])
    points: FloatArray = np.einsum("pabi,bj,pijc->pabc", along, across, nets)
    return points


def _body_radius() -> tuple[FloatArray, FloatArray]:
    """Return the body's outline as heights, increasing, and radii: (k,), (k,)."""
    parts, nets = teapot_patches()
    body = nets[np.equal(parts, "body")][[0, 4]]
    x, _, z = np.moveaxis(patch_points(body, 64)[:, :, 0], -1, 0).reshape(3, -1)
    order = np.argsort(z, kind="stable")
    return z[order], np.abs(x[order])
