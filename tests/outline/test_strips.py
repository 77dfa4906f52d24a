"""Slender members are cut off and meshed in rows; needs no Gmsh."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.errors import InputError, ResourceError
from corota.outline import OutlineError, arc, circle, clean, line, outline, polyline, spline
from corota.outline.loops import area
from corota.outline.strips import cut, polygon


def faces_of(curves, size=2.0, through=4):
    loops = clean(curves)
    faces = cut(loops, size, through)
    total = sum((1 if k == part[0] else -1) * area(loops.polygon(k))
                for part in loops.parts for k in part)  # fmt: skip
    cells = sum(area(polygon(faces.curves, loop)) for face in faces.faces for loop in face)
    assert cells == pytest.approx(total, rel=1e-4)
    return faces


def members(faces):
    """Thickness, length and counts of the faces in rows, the thinnest first."""
    found = []
    for number, counts in faces.rows.items():
        lengths = [faces.curves[k].length for k, _ in faces.faces[number][0]]
        thin = int(lengths[0] + lengths[2] > lengths[1] + lengths[3])
        found.append((lengths[thin], lengths[1 - thin], counts[thin], counts[1 - thin]))
    return sorted(found)


def test_leaves_between_fillets():
    """A stage on two leaves 1 x 40 with fillets of 2: 36 mm between the fillets are in rows."""
    outer = polyline([(0, 0), (44, 0), (44, 50), (0, 50)], closed=True)
    window = polyline([(1, 5), (43, 5), (43, 45), (1, 45)], closed=True, fillet=2.0)
    faces = faces_of([*outer, *window])
    leaves = members(faces)[:2]
    for thickness, length, across, along in leaves:
        assert (thickness, length, across) == pytest.approx((1.0, 36.0, 4))
        assert length / along <= 5.0 * thickness / across * (1 + 1e-9)
    rounded = [c for c in faces.curves if c.center is not None]
    assert len(rounded) == 4
    assert sum(c.length for c in rounded) == pytest.approx(4.0 * np.pi, rel=1e-3)


@pytest.mark.parametrize("through", [2, 5])
@pytest.mark.parametrize("angle", [0.0, 0.3, 1.9])
def test_rows_do_not_depend_on_the_orientation(through, angle):
    corner = np.array([(0, 0), (30, 0), (30, 3), (3, 3), (3, 20), (0, 20)], dtype=float)
    c, s = np.cos(angle), np.sin(angle)
    faces = faces_of(polyline(corner @ np.array([[c, s], [-s, c]]), closed=True), 2.0, through)
    # Two legs and the block at the corner.
    assert len(faces.rows) == len(faces.faces) == 3
    assert {m[2] for m in members(faces)} == {through}


def test_a_curved_leaf_of_two_splines():
    """A cosine beam 1 thick: one member between two splines and the clamped ends."""
    x = np.linspace(0.0, 100.0, 60)
    y = 3.0 * (1.0 - np.cos(2.0 * np.pi * x / 100.0))
    low, high = np.column_stack([x, y]), np.column_stack([x, y + 1.0])
    faces = faces_of([*spline(low), line(low[-1], high[-1]), *spline(high), line(high[0], low[0])])
    ((thickness, _, across, _),) = members(faces)
    assert thickness == pytest.approx(1.0)
    assert across == 4


def test_rings_and_bends_take_as_many_cells_as_their_angle_needs():
    """Half a ring 1 thick, 24 cells a turn; a leg before and after shares its rows."""
    half = np.pi
    curves = [
        line((0, 0), (30, 0)), *arc((30, 6), 6, -half / 2, half / 2), line((30, 12), (0, 12)),
        line((0, 12), (0, 11)), line((0, 11), (30, 11)), *arc((30, 6), 5, half / 2, -half / 2),
        line((30, 1), (0, 1)), line((0, 1), (0, 0)),
    ]  # fmt: skip
    faces = faces_of(curves)
    assert len(faces.rows) == len(faces.faces) == 4
    assert {m[2] for m in members(faces)} == {4}


def test_a_wide_link_between_leaves_is_cut_off_beside_its_ends():
    """Two leaves 0.6 x 6 and a link 6 x 30 between: three members, the link's within its ends."""
    right = [(0.3, 0), (0.3, 6), (3, 6), (3, 36), (0.3, 36), (0.3, 42)]
    outline = right + [(-x, y) for x, y in reversed(right)]
    thin, also, link = members(faces_of(polyline(outline, closed=True), 1.0))
    for leaf in (thin, also):
        assert leaf[:3] == pytest.approx((0.6, 6.0, 4))
    assert link[:2] == pytest.approx((6.0, 24.0))


def test_bulky_parts_and_members_with_holes_keep_their_outline():
    plate = polyline([(0, 0), (40, 0), (40, 20), (0, 20)], closed=True)
    assert list(faces_of(plate).rows.values()) == [(20, 10, 20, 10)]
    wedge = polyline([(0, 0), (40, 0), (40, 20), (30, 20)], closed=True)
    assert not faces_of([*wedge]).rows
    assert not faces_of(polyline([(0, 0), (40, 0), (40, 20)], closed=True)).rows
    bar = polyline([(0, 0), (60, 0), (60, 4), (0, 4)], closed=True)
    faces = faces_of([*bar, *circle((30.0, 2.0), 1.0)])
    assert all(len(faces.faces[f]) == 1 for f in faces.rows)
    assert len(members(faces)) == 2


def test_fillets_that_do_not_fit_are_refused():
    with pytest.raises(InputError, match="do not fit"):
        polyline([(0, 0), (4, 0), (4, 2), (0, 2)], closed=True, fillet=1.1)
    with pytest.raises(InputError, match=">= 0"):
        polyline([(0, 0), (4, 0), (4, 2)], fillet=-1.0)


def test_a_fillet_is_tangent():
    first, bend, last = polyline([(0, 0), (10, 0), (16, 8)], fillet=2.0)
    out = bend.points[[0, -1]] - bend.center
    assert np.hypot(*out.T) == pytest.approx([2.0, 2.0])
    ways = [np.diff(c.points, axis=0)[0] for c in (first, last)]
    assert [o @ w for o, w in zip(out, ways, strict=True)] == pytest.approx([0.0, 0.0], abs=1e-9)


@pytest.fixture
def without_gmsh(monkeypatch):
    import corota.outline.mesher as mesher

    monkeypatch.setattr(mesher, "find_spec", lambda name: None)


def test_parts_of_four_sides_need_no_gmsh(without_gmsh):
    curved = [
        *arc((0, 0), 10.0, 0.0, 1.5, "rim"), line((10 * np.cos(1.5), 10 * np.sin(1.5)),
        (9 * np.cos(1.5), 9 * np.sin(1.5)), "clamp"), *arc((0, 0), 9.0, 1.5, 0.0, "rim"),
        line((9, 0), (10, 0), "load"),
    ]  # fmt: skip
    mesh = outline(curved, through=3)
    assert set(mesh.edge_sets) == {"rim", "clamp", "load"}
    assert list(mesh.cell_sets) == ["part"]
    assert len(mesh.edge_sets["clamp"]) == 3
    radii = np.hypot(*mesh.points[mesh.nodes_of("rim")].T)
    assert np.minimum(abs(radii - 10.0), abs(radii - 9.0)).max() < 1e-9
    model = ct.Model(mesh)
    model.section("part", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("clamp")
    model.force("load", y=1e-3)
    assert ct.solve(model, threads=1).history("RF2", at="clamp")[-1] == pytest.approx(-1e-3)


def test_other_parts_need_gmsh(without_gmsh, monkeypatch):
    with pytest.raises(ResourceError, match="four sides and no hole"):
        outline([*polyline([(0, 0), (9, 0), (9, 9)], closed=True)])


def test_places_are_drawn(tmp_path):
    pytest.importorskip("matplotlib")
    cross = polyline([(0, 0), (4, 3), (4, 0), (0, 3)], closed=True)
    with pytest.raises(OutlineError, match=r"cross at \(2, 1.5\)") as caught:
        clean(cross)
    assert caught.value.places == pytest.approx(np.array([[2.0, 1.5]]))
    caught.value.plot(path=tmp_path / "where.png")
    assert (tmp_path / "where.png").stat().st_size > 5000
