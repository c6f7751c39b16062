"""The rigid bodies that the scenes move: a door key and the Utah teapot, as meshes.

Every surface is written down as quadrilaterals, which `mesh_of_quads` welds.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from quatspline.figures.teapot import FloatArray, outer_points, patch_points, teapot_patches

IntArray = NDArray[np.intp]

# Welding lattice, in points a unit length: finer than any cell drawn here, coarser than rounding.
# The irrational factor keeps decimal coordinates off the lattice's rounding boundaries.
WELD = 1e8 / np.pi

KEY_PARTS = ("bow", "stem", "bit")
_KEY_TINT, _KEY_LIFT = (1.0, 1.0, 1.0), (0.0, 0.0, 0.016)

# Beads of the collar on the stem: centre x, half length and radius, from the bow to the tip.
_BEADS = ((-0.134, 0.014, 0.057), (-0.088, 0.019, 0.070), (-0.046, 0.011, 0.050))
_SHAFT_RADIUS = 0.035

# The bit seen from the side, hanging from the stem: '#' is metal.
_BIT = (
    "##############",
    "##############",
    "##############",
    "######........",
    "######........",
    "##############",
    "##############",
    "###..####..###",
    "###..####..###",
    "###..####..###",
    "###..####.....",
)
_BIT_CORNER, _BIT_CELL, _BIT_HALF_THICKNESS = (0.248, -0.026), 0.0146, 0.021

_LIMBS = ("handle", "spout")
TEAPOT_PARTS = ("pot", "handle", "spout", "lid", "inside")
_TEAPOT_TINT, _TEAPOT_LIFT = (1.0, 1.0, 1.0, 1.0, 0.45), (0.0, 0.02, 0.03, 0.0, 0.0)


@dataclass(frozen=True)
class Mesh:
    """A surface of quadrilateral cells, flat or nearly so, some of them shrunk to triangles.

    Attributes
    ----------
    vertices : (v, 3) positions, in the body's own frame and unit.
    cells : (c, 4) vertex indices, anticlockwise as seen from outside.
    part : (c,) the part of the body that a cell belongs to (an index: 0, 1, …).
    tint : (c,) brightness of a cell's colour, 1 but for what lies in the dark.
    lift : (c,) how much nearer to the camera a cell counts when cells are sorted by depth, in
        the body's unit: a part that grows out of another wins where the two meet.
    """

    vertices: FloatArray
    cells: IntArray
    part: IntArray
    tint: FloatArray
    lift: FloatArray

    @property
    def faces(self) -> IntArray:
        """The cells' triangles, those without area (at poles) left out: (f, 3)."""
        halves = self.cells[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)
        distinct: IntArray = halves[(halves != np.roll(halves, 1, axis=1)).all(axis=1)]
        return distinct

    def corners(self) -> FloatArray:
        """Return the corners of every cell: (c, 4, 3)."""
        return self.vertices[self.cells]

    def normals(self) -> FloatArray:
        """Return the outward unit normal of every cell, across its two diagonals: (c, 3)."""
        a, b, c, d = np.moveaxis(self.corners(), 1, 0)
        cross = np.cross(c - a, d - b)
        unit: FloatArray = cross / np.linalg.norm(cross, axis=1, keepdims=True)
        return unit

    def border(self) -> IntArray:
        """Return the directed edges (e, 2) that no neighbouring face answers: none if closed."""
        edges = np.concatenate([self.faces[:, [i, (i + 1) % 3]] for i in range(3)])
        size = len(self.vertices)
        answered = np.isin(edges @ [size, 1], edges @ [1, size])
        return edges[~answered]


def mesh_of_quads(
    quads: Sequence[FloatArray], tint: Sequence[float], lift: Sequence[float]
) -> Mesh:
    """Return the mesh of several parts, each given as quadrilaterals (k, 4, 3).

    Corners run anticlockwise as seen from outside. Within a part coincident corners are one
    vertex; parts share no vertices. `tint` and `lift` are given for each part.
    """
    meshes = [_weld(part) for part in quads]
    sizes = [len(cells) for _, cells in meshes]
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes[:-1])])
    return Mesh(
        vertices=np.concatenate([vertices for vertices, _ in meshes]),
        cells=np.concatenate([c + start for (_, c), start in zip(meshes, starts, strict=True)]),
        part=np.repeat(np.arange(len(meshes)), sizes),
        tint=np.repeat(np.asarray(tint), sizes),
        lift=np.repeat(np.asarray(lift), sizes),
    )


def _weld(quads: FloatArray) -> tuple[FloatArray, IntArray]:
    corners = quads.reshape(-1, 3)
    lattice = np.round(corners * WELD).astype(np.int64)
    _, first, index = np.unique(lattice, axis=0, return_index=True, return_inverse=True)
    return corners[first], index.reshape(-1, 4)


def _cells(grid: FloatArray) -> FloatArray:
    """Return the cells of a grid (…, a, b, 3) as quadrilaterals (k, 4, 3) facing along ∂a × ∂b."""
    corners = (grid[..., :-1, :-1, :], grid[..., 1:, :-1, :], grid[..., 1:, 1:, :])
    return np.stack([*corners, grid[..., :-1, 1:, :]], axis=-2).reshape(-1, 4, 3)


def _bow(around: int, across: int) -> FloatArray:
    """Return the bow: a tube, oval in section, along a plane closed curve of three lobes."""
    # notation: s runs along the curve, r is its radius; (n_x, n_z) is its outward normal
    s, turn = np.meshgrid(
        np.linspace(0.0, 2.0 * np.pi, around + 1), np.linspace(0.0, 2.0 * np.pi, across + 1)
    )
    r, slope = 0.142 - 0.050 * np.cos(3.0 * s), 0.150 * np.sin(3.0 * s)
    n_x = r * np.cos(s) + slope * np.sin(s)
    n_z = r * np.sin(s) - slope * np.cos(s)
    width = 0.031 * np.cos(turn) / np.hypot(n_x, n_z)
    x = -0.277 + r * np.cos(s) + width * n_x
    return _cells(np.stack([x, 0.035 * np.sin(turn), r * np.sin(s) + width * n_z], axis=-1))


def _stem_outline(fine: int) -> FloatArray:
    """Return the outline (x, radius) of the stem from inside the bow to the tip: (k, 2)."""
    arc = np.linspace(0.0, np.pi, fine)
    shaft = np.full(fine, _SHAFT_RADIUS)
    pieces = [np.column_stack([np.linspace(-0.185, -0.150, 2), (0.018, _SHAFT_RADIUS)])]
    for centre, half, radius in _BEADS:
        swell = _SHAFT_RADIUS + (radius - _SHAFT_RADIUS) * np.sin(arc)
        pieces.append(np.column_stack([centre - half * np.cos(arc), swell]))
    pieces.append(np.column_stack([np.linspace(-0.03, 0.452, 4 * fine), np.tile(shaft, 4)]))
    quarter = np.linspace(0.0, 0.5 * np.pi, fine)
    tip = np.column_stack([0.476 + 0.024 * np.sin(quarter), 0.041 * np.cos(quarter) ** 0.7])
    return np.concatenate([[[-0.185, 0.0]], *pieces, [[0.454, 0.041]], tip])


def _stem(around: int) -> FloatArray:
    """Return the stem: shaft, collar and tip as one surface of revolution about the x axis."""
    turn = np.linspace(0.0, 2.0 * np.pi, around + 1)[:, None]
    x, radius = _stem_outline(max(3, around // 3)).T
    y, z = radius * np.cos(turn), radius * np.sin(turn)
    return _cells(np.stack([np.broadcast_to(x, y.shape), y, z], axis=-1))


def _bit() -> FloatArray:
    """Return the bit: the picture `_BIT` made thick, hanging from the stem towards -z."""
    metal = np.pad(np.array([list(row) for row in _BIT]).T == "#", 1)
    filled = np.argwhere(metal)
    sides = []
    for axis, sign in ((0, -1), (0, 1), (1, -1), (1, 1)):
        step = sign * np.eye(2, dtype=np.intp)[axis]
        exposed = filled[~metal[tuple((filled + step).T)]]
        sides.append(_walls(exposed, axis, sign))
    plates = [_plates(filled, sign) for sign in (-1, 1)]
    return _bit_frame(np.concatenate([*sides, *plates]))


def _walls(cells: IntArray, axis: int, sign: int) -> FloatArray:
    """Return the walls of cells (k, 2) towards ±axis, in the bit's lattice: (k, 4, 3)."""
    corners = np.array([(0, -1), (1, -1), (1, 1), (0, 1)])
    wall = np.empty((4, 3))
    wall[:, axis], wall[:, 1 - axis], wall[:, 2] = (sign + 1) // 2, corners[:, 0], corners[:, 1]
    outward = sign * (1 if axis == 0 else -1)
    return _placed(wall[::outward], cells)


def _plates(cells: IntArray, sign: int) -> FloatArray:
    """Return the faces of cells (k, 2) towards the bit's front or back: (k, 4, 3)."""
    plate = np.array([(0, 0, sign), (1, 0, sign), (1, 1, sign), (0, 1, sign)], dtype=np.float64)
    return _placed(plate[::sign], cells)


def _placed(quad: FloatArray, cells: IntArray) -> FloatArray:
    return quad + np.pad(cells, ((0, 0), (0, 1)))[:, None, :]


def _bit_frame(lattice: FloatArray) -> FloatArray:
    """Map the bit's lattice (along, down, across) to the key's x, z and y."""
    along, down, across = np.moveaxis(lattice, -1, 0)
    x = _BIT_CORNER[0] + _BIT_CELL * (along - 1.0)
    z = _BIT_CORNER[1] - _BIT_CELL * (down - 1.0)
    return np.stack([x, _BIT_HALF_THICKNESS * across, z], axis=-1)


def key_mesh(resolution: int = 28) -> Mesh:
    """Return a door key: a three-lobed bow, a stem with a collar, and a bit with notches.

    The key is 1 long, along x, from the bow (x = -0.5) to the tip (x = 0.5); the bit points
    towards -z, and y = 0 is its mirror plane. Its three parts (`KEY_PARTS`) are closed surfaces
    that enter one another. `resolution` is the number of facets around the stem.
    """
    parts = [_bow(4 * resolution, resolution), _stem(resolution), _bit()]
    return mesh_of_quads(parts, _KEY_TINT, _KEY_LIFT)


def teapot_mesh(resolution: int = 16) -> Mesh:
    """Return the Utah teapot, `resolution` × `resolution` cells a patch.

    Scaled to 1 from handle to spout, x along this length, z up, centred in its bounding box; the
    parts are `TEAPOT_PARTS`. Its surfaces are open where handle and spout enter the body, and are
    cut there. The last part closes what shows its inside to a viewer, in a dark tint: the
    gap around the lid and the mouth of the spout.
    """
    parts, nets = teapot_patches()
    points = patch_points(nets, resolution)
    low, high = points.min(axis=(0, 1, 2)), points.max(axis=(0, 1, 2))
    middle, length = 0.5 * (low + high), high[0] - low[0]
    outer = {name: outer_points(nets[np.equal(parts, name)], resolution) for name in _LIMBS}
    groups = {"pot": ("rim", "body", "bottom"), "lid": ("lid",)}
    outer |= {name: points[np.isin(parts, group)] for name, group in groups.items()}
    # the published patches face inwards: swapping u and v turns them
    quads = [_cells(np.swapaxes(outer[name], 1, 2)) for name in TEAPOT_PARTS[:-1]]
    quads = [*quads, _seals(parts, points)]
    return mesh_of_quads([(part - middle) / length for part in quads], _TEAPOT_TINT, _TEAPOT_LIFT)


def _seals(parts: tuple[str, ...], points: FloatArray) -> FloatArray:
    """Return the ring between lid and rim and the disc in the spout's mouth, facing upwards."""
    rim, lid = points[np.equal(parts, "rim")][:, 0], points[np.equal(parts, "lid")][4:, -1]
    mouth = points[np.equal(parts, "spout")][2:, -1]
    centre = np.broadcast_to(0.5 * (mouth[:1, :1] + mouth[:1, -1:]), mouth.shape)
    ring, disc = np.stack([rim, lid], axis=1), np.stack([centre, mouth], axis=1)
    return np.concatenate([_cells(ring), _cells(disc)])
