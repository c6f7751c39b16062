"""Frames of a moving rigid body.

The drawer takes an empty 3-D axes and leaves its panel filled: the camera is orthographic, lengths
are true in every direction, and what is drawn is fitted to the panel at the moment of the call (so
lay the figure out first, at its final size).
"""

from typing import Any

import numpy as np
from matplotlib.colors import to_rgb, to_rgba_array
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from mpl_toolkits.mplot3d.axes3d import Axes3D
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from quatspline.figures.meshes import Mesh

FloatArray = NDArray[np.float64]

BRASS = "#d8a441"

# The shading: light from above, over the camera's left shoulder (right, up, towards camera).
_LIGHT = np.array([-0.45, 0.70, 0.55])
_AMBIENT, _SKY, _DIFFUSE, _SPECULAR, _SHININESS = 0.40, 0.12, 0.66, 0.60, 28.0

# A face's outline in points, in its own colour: it closes the hairlines between neighbours.
_SEAM = 0.5
_SHADOW = "#e8e9ec"
_BOTH = np.array([-1.0, 1.0])
# The path's width and its pieces' length, as fractions of its extent.
_RIBBON_WIDTH, _RIBBON_STEP = 0.0022, 0.004


class _FlatPatch(PathPatch):
    """A patch in the axes' own plane: already projected, drawn as it is."""

    def do_3d_projection(self) -> float:
        """Return a depth, as 3-D axes ask of every patch; the order is by zorder, not by it."""
        return 0.0


def view_axes(elev: float, azim: float) -> FloatArray:
    """Return the camera's right, up and towards-camera unit vectors as rows (3, 3); degrees."""
    # notation: e elevation above the xy plane, a azimuth about z
    e, a = np.radians([elev, azim])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    return np.stack([right, np.cross(towards, right), towards])


def shade(normals: FloatArray, rgb: FloatArray, view: FloatArray) -> FloatArray:
    """Return face colours (f, 3): Lambert's law with ambient light and a Blinn highlight.

    Parameters
    ----------
    normals : (f, 3) unit normals.
    rgb : (f, 3) or (3,) the body's own colour, 0 to 1.
    view : the rows of `view_axes`.
    """
    light = _LIGHT / np.linalg.norm(_LIGHT) @ view
    half = (light + view[2]) / np.linalg.norm(light + view[2])
    # wrapped: some light reaches round the terminator, so that no side goes flat
    lambert = np.clip(0.75 * (normals @ light) + 0.25, 0.0, None)[:, None]
    gloss = np.clip(normals @ half, 0.0, None)[:, None] ** _SHININESS
    sky = _SKY * (normals @ view[1])[:, None]
    lit = rgb * (_AMBIENT + sky + _DIFFUSE * lambert)
    shaded: FloatArray = np.clip(lit + _SPECULAR * gloss * (1.0 - lit), 0.0, 1.0)
    return shaded


def draw_frames(
    ax: Axes3D,
    mesh: Mesh,
    positions: ArrayLike,
    quaternions: ArrayLike,
    *,
    color: Any = BRASS,
    scale: float = 1.0,
    path: ArrayLike | None = None,
    path_color: Any = "#6b7280",
    ground: float | None = None,
    elev: float = 22.0,
    azim: float = -62.0,
    margin: float = 0.03,
) -> Poly3DCollection:
    """Draw rigid frames of a mesh, shaded, hiding one another correctly; return their collection.

    All frames and the path are one collection, sorted by depth and drawn as an image inside
    vector figures. The axes' grid, panes and ticks are removed.

    Parameters
    ----------
    ax : an empty 3-D axes; its whole panel is used, whatever the panel's shape.
    mesh : the body; its surface must hide its inside (faces turned away are not drawn).
    positions : (m, 3) where the body's origin is, in scene units.
    quaternions : (m, 4) unit quaternions, scalar first, body to scene.
    color : one colour, or one for each frame.
    scale : scene units to one mesh unit.
    path : (k, 3) points of the curve that the origin follows, in scene units.
    path_color : its colour.
    ground : height z of a plane that receives the frames' shadows (light from straight above).
    elev : the camera's elevation, in degrees.
    azim : the camera's azimuth, in degrees.
    margin : free border on each side, as a fraction of the panel.

    Raises
    ------
    ValueError
        If positions, quaternions and colours do not match in number.
    """
    view = view_axes(elev, azim)
    turn, place = _poses(positions, quaternions)
    cells = scale * mesh.corners() @ turn[:, None] + place
    normals = mesh.normals() @ turn
    seen = normals @ view[2] > 0.0
    rgb = _frame_colors(color, len(turn)) * mesh.tint[:, None]
    colors = shade(normals[seen], rgb[seen], view)
    # along the orthographic camera's axis a shift changes the order alone, not the picture
    drawn = (cells + scale * mesh.lift[:, None, None] * view[2])[seen]
    if path is not None:
        ribbon = _ribbon(np.asarray(path, dtype=np.float64), view)
        colors = np.concatenate([colors, np.tile(to_rgb(path_color), (len(ribbon), 1))])
        drawn = np.concatenate([drawn, ribbon])
    shadow = cells[normals[..., 2] > 0.0] if ground is not None else drawn[:0]
    shadow[..., 2] = ground or 0.0
    _fit(ax, np.concatenate([drawn, shadow]).reshape(-1, 3), elev, azim, margin)
    _add_shadow(ax, shadow)
    return _add_faces(ax, drawn, colors)


def _poses(positions: ArrayLike, quaternions: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return transposed rotation matrices (m, 3, 3) and translations (m, 1, 1, 3)."""
    place, q = np.asarray(positions, np.float64), np.asarray(quaternions, np.float64)
    if q.ndim != 2 or q.shape[1] != 4 or place.shape != (len(q), 3):
        raise ValueError(f"positions {place.shape} for quaternions {q.shape}")
    turn = Rotation.from_quat(q, scalar_first=True).as_matrix().swapaxes(1, 2)
    return turn, place[:, None, None, :]


def _frame_colors(color: Any, count: int) -> FloatArray:
    """Return a colour for each frame: (count, 1, 3)."""
    rgb = to_rgba_array(color)[:, None, :3]
    if len(rgb) not in (1, count):
        raise ValueError(f"{len(rgb)} colours for {count} frames")
    return np.broadcast_to(rgb, (count, 1, 3))


def _ribbon(path: FloatArray, view: FloatArray) -> FloatArray:
    """Return a curve (k, 3) as a narrow ribbon that faces the camera: cells (…, 4, 3)."""
    extent = float(np.linalg.norm(np.ptp(path, axis=0)))
    points = _resampled(path, extent * _RIBBON_STEP)
    across = np.cross(np.gradient(points, axis=0), view[2])
    length = np.linalg.norm(across, axis=1, keepdims=True)
    side = 0.5 * extent * _RIBBON_WIDTH * across / np.where(length > 0.0, length, 1.0)
    left, right = points - side, points + side
    return np.stack([left[:-1], right[:-1], right[1:], left[1:]], axis=1)


def _resampled(path: FloatArray, step: float) -> FloatArray:
    """Return points about `step` apart along a polygon (k, 3), so that depths sort finely."""
    chords = np.linalg.norm(np.diff(path, axis=0), axis=1)
    arc = np.concatenate([[0.0], np.cumsum(chords)])
    even = np.linspace(0.0, arc[-1], max(2, round(arc[-1] / step)))
    return np.stack([np.interp(even, arc, axis) for axis in path.T], axis=1)


def _add_faces(ax: Axes3D, cells: FloatArray, colors: FloatArray) -> Poly3DCollection:
    faces = Poly3DCollection(cells, facecolors=colors, edgecolors=colors, linewidths=_SEAM)
    faces.set(rasterized=True, clip_on=False, zorder=2)
    ax.computed_zorder = False
    ax.add_collection3d(faces, autolim=False)
    return faces


def _add_shadow(ax: Axes3D, cells: FloatArray) -> None:
    """Add the shadow of upward cells (k, 4, 3), flattened already, as the fitted camera sees it.

    The cells all turn one way, so as one path, filled where the winding is not 0, they are their
    union, without seams.
    """
    flat = project(ax, np.concatenate([cells, cells[:, :1]], axis=1).reshape(-1, 3))
    codes = np.tile([Path.MOVETO, *3 * [Path.LINETO], Path.CLOSEPOLY], len(cells))
    shadow = _FlatPatch(Path(flat, codes), facecolor=_SHADOW, edgecolor="none", zorder=0)
    shadow.set(rasterized=True, clip_on=False)
    ax.add_artist(shadow)  # add_patch would walk the path to find limits that are set already


def project(ax: Axes3D, points: FloatArray) -> FloatArray:
    """Return points (k, 3) in the axes' own plane, as its camera sees them: (k, 2)."""
    homogeneous: FloatArray = (
        np.pad(points, ((0, 0), (0, 1)), constant_values=1.0) @ ax.get_proj().T
    )
    return homogeneous[:, :2] / homogeneous[:, 3:]


def _fit(ax: Axes3D, points: FloatArray, elev: float, azim: float, margin: float) -> None:
    """Aim an orthographic camera so that points (…, 3) fill the axes' panel, lengths true."""
    ax.set_axis_off()
    ax.set_proj_type("ortho")
    ax.view_init(elev=elev, azim=azim)
    view = view_axes(elev, azim)
    seen = points.reshape(-1, 3) @ view.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    centre, reach = 0.5 * (low + high) @ view, 0.5 * np.linalg.norm(high - low)
    ax.set(xlim=centre[0] + reach * _BOTH, ylim=centre[1] + reach * _BOTH)
    ax.set(zlim=centre[2] + reach * _BOTH)
    ax.set_box_aspect((1, 1, 1))
    scale = _panel_scale(ax, centre, view, (high - low)[:2])
    ax.set_box_aspect((1, 1, 1), zoom=(1.0 - 2.0 * margin) * scale)


def _panel_scale(ax: Axes3D, centre: FloatArray, view: FloatArray, size: FloatArray) -> float:
    """Return the zoom at which a view (width, height) of scene units just fills the panel."""
    ax.apply_aspect()
    pixels = ax.transData.transform(project(ax, np.stack([centre, centre + view[0]])))
    unit = np.linalg.norm(pixels[1] - pixels[0])
    panel = ax.get_position(original=True).transformed(ax.figure.transSubfigure)
    return float(min(panel.width / (unit * size[0]), panel.height / (unit * size[1])))
