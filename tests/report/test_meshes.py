"""The meshes of the scenes: closed where they claim to be, symmetric, smooth, facing outwards."""

import numpy as np
import pytest

from quatspline.figures.meshes import KEY_PARTS, TEAPOT_PARTS, Mesh, key_mesh, teapot_mesh
from quatspline.figures.teapot import FloatArray, outer_points, patch_points, teapot_patches

# Published coordinates have at most five decimals: mirrored or turned they match to rounding.
SAME = 1e-12
RESOLUTION = 5
ROUND_PARTS = ("rim", "body", "lid", "bottom")


def nets_of(*names: str) -> FloatArray:
    parts, nets = teapot_patches()
    return nets[np.isin(parts, names)]


def faces_of(mesh: Mesh, part: int) -> np.ndarray:
    """Return a part's faces: parts share no vertices."""
    members = np.zeros(len(mesh.vertices), dtype=bool)
    members[mesh.cells[mesh.part == part]] = True
    return mesh.faces[members[mesh.faces].all(axis=1)]


def signed_volume(mesh: Mesh, part: int) -> float:
    a, b, c = np.moveaxis(mesh.vertices[faces_of(mesh, part)], 1, 0)
    return float(np.einsum("fc,fc->", a, np.cross(b, c)) / 6.0)


def edge_counts(mesh: Mesh, part: int) -> np.ndarray:
    faces = faces_of(mesh, part)
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return np.unique(edges, axis=0, return_counts=True)[1]


def same_points(a: FloatArray, b: FloatArray) -> bool:
    """Return whether two sets of points are equal: each point has a partner in the other."""
    a, b = a.reshape(-1, 3), b.reshape(-1, 3)
    distance = np.linalg.norm(a[:, None] - b[None], axis=2)
    return bool(max(distance.min(axis=0).max(), distance.min(axis=1).max()) < SAME)


def borders(nets: FloatArray) -> FloatArray:
    """Return the four border control polygons of each patch, lowest end first: (4p, 4, 3)."""
    rows = np.concatenate([nets[:, 0], nets[:, -1], nets[:, :, 0], nets[:, :, -1]])
    return np.array([min(row.tolist(), row[::-1].tolist()) for row in rows])


def test_teapot_data_is_the_published_one() -> None:
    parts, nets = teapot_patches()
    counts = {name: parts.count(name) for name in parts}
    assert counts == {"rim": 4, "body": 8, "handle": 4, "spout": 4, "lid": 8, "bottom": 4}
    assert nets.shape == (32, 4, 4, 3)
    assert len(np.unique(nets.reshape(-1, 3), axis=0)) == 290
    np.testing.assert_array_equal(nets.min(axis=(0, 1, 2)), [-3.0, -2.0, 0.0])
    np.testing.assert_array_equal(nets.max(axis=(0, 1, 2)), [3.525, 2.0, 3.15])


def test_teapot_data_cannot_be_overwritten() -> None:
    with pytest.raises(ValueError, match="read-only"):
        teapot_patches()[1][0, 0, 0, 0] = 1.0


@pytest.mark.parametrize("part", ["rim", "body", "handle", "spout", "lid", "bottom"])
def test_each_part_is_its_own_mirror_image(part: str) -> None:
    points = patch_points(nets_of(part), RESOLUTION)
    assert same_points(points, points * [1.0, -1.0, 1.0])
    assert not same_points(points, np.add(points, [0.0, 0.01, 0.0]))


@pytest.mark.parametrize("part", ROUND_PARTS)
def test_round_parts_look_alike_after_a_quarter_turn(part: str) -> None:
    points = patch_points(nets_of(part), RESOLUTION)
    assert same_points(points, points @ np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]]))


@pytest.mark.parametrize("part", ["handle", "spout"])
def test_handle_and_spout_do_not(part: str) -> None:
    points = patch_points(nets_of(part), RESOLUTION)
    assert not same_points(points, points @ np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]]))


@pytest.mark.parametrize(
    ("parts", "open_borders"),
    [(("rim", "body", "bottom"), 4), (("lid",), 4), (("handle",), 4), (("spout",), 4)],
)
def test_patches_share_their_border_curves(parts: tuple[str, ...], open_borders: int) -> None:
    """Every border polygon is shared by two patches, but for the part's free rims and poles."""
    rows, counts = np.unique(borders(nets_of(*parts)), axis=0, return_counts=True)
    pole = np.ptp(rows, axis=1).max(axis=1) == 0.0
    assert set(counts[~pole]) == {1, 2}
    assert (counts[~pole] == 1).sum() == open_borders


def test_tangent_planes_agree_between_quarters() -> None:
    """Across the seams of a quarter turn the surface is smooth: derivatives are opposite."""
    for net in nets_of("body", "handle", "spout"):
        following = [
            other
            for other in nets_of("body", "handle", "spout")
            if np.array_equal(other[:, 0], net[:, 3])
        ]
        assert len(following) == 1
        ahead, behind = following[0][:, 1] - net[:, 3], net[:, 3] - net[:, 2]
        np.testing.assert_allclose(np.cross(ahead, behind), 0.0, atol=SAME)
        assert (np.einsum("ic,ic->i", ahead, behind) > 0.0).all()


def test_patch_points_meet_corners_and_the_centre_of_the_net() -> None:
    _, nets = teapot_patches()
    points = patch_points(nets, 2)
    np.testing.assert_allclose(points[:, ::2, ::2], nets[:, ::3, ::3], atol=SAME)
    weights = np.array([1.0, 3.0, 3.0, 1.0]) / 8.0
    np.testing.assert_allclose(
        points[:, 1, 1], np.einsum("i,j,pijc->pc", weights, weights, nets), atol=SAME
    )
    with pytest.raises(ValueError, match="at least one cell"):
        patch_points(nets, 0)


def test_teapot_is_open_only_where_parts_enter_one_another_and_at_its_seals() -> None:
    mesh = teapot_mesh(RESOLUTION)
    starts = mesh.border()[:, 0]
    rings = [np.isin(starts, mesh.cells[mesh.part == part]).sum() for part in range(5)]
    # in patch borders: the pot's rim 4, two ends of the handle and of the spout 2 × 2, the lid 4;
    # the seals have the circles of rim and lid, and the two halves of the spout's mouth
    assert [int(ring) for ring in rings] == [RESOLUTION * n for n in (4, 4, 4, 4, 4 + 4 + 2)]


@pytest.mark.parametrize("part", ["handle", "spout"])
def test_handle_and_spout_are_cut_just_inside_the_body(part: str) -> None:
    x, _, z = np.moveaxis(patch_points(nets_of("body")[[0, 4]], 200)[:, :, 0], -1, 0)
    order = np.argsort(z.ravel())

    def nearness(points: FloatArray) -> float:
        """Return the least distance from the axis, as a fraction of the body's radius."""
        radius = np.interp(points[..., 2], z.ravel()[order], x.ravel()[order])
        return float((np.hypot(points[..., 0], points[..., 1]) / radius).min())

    assert nearness(patch_points(nets_of(part), 32)) < 0.97
    assert 0.985 <= nearness(outer_points(nets_of(part), 32)) < 0.99


def test_teapot_seals_lie_flush_with_the_borders_they_close() -> None:
    mesh = teapot_mesh(RESOLUTION)
    seals = TEAPOT_PARTS.index("inside")
    edges = mesh.vertices[mesh.border()]
    sealed = np.isin(mesh.border()[:, 0], mesh.cells[mesh.part == seals])
    spout_tip = edges[:, :, 0].mean(axis=1) > 0.35
    top = edges[:, :, 2].mean(axis=1) > 0.12
    assert same_points(edges[sealed & ~spout_tip], edges[~sealed & ~spout_tip & top])
    assert same_points(edges[sealed & spout_tip], edges[~sealed & spout_tip])
    upwards = mesh.normals()[mesh.part == seals] @ [0.0, 0.0, 1.0]
    assert len(upwards) == 6 * RESOLUTION
    np.testing.assert_allclose(upwards, 1.0, atol=SAME)


def test_teapot_is_centred_one_long_and_faces_outwards() -> None:
    mesh = teapot_mesh(RESOLUTION)
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    np.testing.assert_allclose(low + high, 0.0, atol=2e-3)
    assert np.ptp(mesh.vertices[:, 0]) == pytest.approx(1.0, abs=2e-3)
    for part in range(4):
        assert signed_volume(mesh, part) > 0.0
    outer = mesh.part == TEAPOT_PARTS.index("pot")
    # seen from the pot's axis at half height, its wall turns its back
    centres = mesh.corners().mean(axis=1)[outer] - [-0.04, 0.0, -0.05]
    wall = np.abs(centres[:, 2]) < 0.1
    outward = np.einsum("fc,fc->f", mesh.normals()[outer], centres)
    assert wall.sum() > 50
    assert (outward[wall] > 0.0).all()


@pytest.mark.parametrize("part", KEY_PARTS)
@pytest.mark.parametrize("resolution", [9, 28])
def test_key_parts_are_watertight_and_face_outwards(part: str, resolution: int) -> None:
    mesh, index = key_mesh(resolution), KEY_PARTS.index(part)
    assert set(edge_counts(mesh, index)) == {2}
    assert signed_volume(mesh, index) > 0.0
    assert len(mesh.border()) == 0


def test_border_finds_a_hole() -> None:
    mesh = key_mesh(9)
    holed = Mesh(mesh.vertices, mesh.cells[1:], mesh.part[1:], mesh.tint[1:], mesh.lift[1:])
    assert len(holed.border()) == 4


@pytest.mark.parametrize(("part", "handles"), [("bow", 1), ("stem", 0), ("bit", 0)])
def test_bow_is_a_ring_and_stem_and_bit_are_not(part: str, handles: int) -> None:
    """Euler's formula: vertices - edges + faces = 2 - 2 handles."""
    mesh, index = key_mesh(), KEY_PARTS.index(part)
    faces, edges = faces_of(mesh, index), edge_counts(mesh, index)
    assert len(np.unique(faces)) - len(edges) + len(faces) == 2 - 2 * handles


def test_key_is_one_long_symmetric_and_has_its_bit_below() -> None:
    mesh = key_mesh()
    x, y, z = mesh.vertices.T
    assert (x.min(), x.max()) == (pytest.approx(-0.5), pytest.approx(0.5))
    np.testing.assert_allclose(np.sort(y), -np.sort(y)[::-1], atol=SAME)
    bit = np.unique(mesh.cells[mesh.part == KEY_PARTS.index("bit")])
    assert z[bit].max() < 0.0
    assert z[bit].min() < -0.15
    assert x[bit].min() > 0.2
    assert x[bit].max() < 0.5


def test_bit_has_three_teeth() -> None:
    mesh = key_mesh()
    centres = mesh.corners()[mesh.part == KEY_PARTS.index("bit")].mean(axis=1)
    front = mesh.normals()[mesh.part == KEY_PARTS.index("bit")][:, 1] < -0.5
    tips = np.unique(np.round(centres[front & (centres[:, 2] < -0.135), 0], 6))
    assert (np.diff(tips) > 0.02).sum() == 2


@pytest.mark.parametrize("mesh", [key_mesh(), teapot_mesh(RESOLUTION)], ids=["key", "teapot"])
def test_normals_are_unit_and_fields_match(mesh: Mesh) -> None:
    np.testing.assert_allclose(np.linalg.norm(mesh.normals(), axis=1), 1.0, atol=SAME)
    assert mesh.part.shape == mesh.tint.shape == mesh.lift.shape == mesh.cells.shape[:1]
    assert set(np.unique(mesh.cells)) == set(range(len(mesh.vertices)))
