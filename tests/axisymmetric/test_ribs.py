"""Sections in plane stress beside rings: ribs, with the thickness of all of them together."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct

YOUNG, INNER, OUTER, WALL, HEIGHT, DEPTH = 1000.0, 2.0, 10.0, 0.01, 1.0, 3.0
#: Displacement of a thin ring per force around it, and shortening of the ribs.
RING = (OUTER + WALL / 2) ** 2 / (2 * np.pi * (OUTER + WALL / 2) * YOUNG * WALL * HEIGHT)
RIBS = (OUTER - INNER) / (YOUNG * DEPTH * HEIGHT)


def wheel(joined: bool, plane: str = "stress") -> ct.Model:
    """A thin ring on ribs from the radius 2 to 10, without Poisson's ratio."""
    ribs = ct.mesh.rectangle(OUTER - INNER, HEIGHT, 8, 2, origin=(INNER, 0.0))
    ring = ct.mesh.rectangle(WALL, HEIGHT, 1, 2, origin=(OUTER, 0.0))
    mesh = ct.mesh.merge(ribs, ring) if joined else ct.mesh.assembly(ribs=ribs, ring=ring)
    model = ct.Model(mesh)
    x = np.array([mesh.points[n].mean(axis=0)[0] for b in mesh.cells for n in b.nodes])
    steel = ct.Elastic(YOUNG, 0.0)
    model.section(
        np.flatnonzero(x < OUTER), element="Q4I", material=steel, thickness=DEPTH, plane=plane
    )
    model.section(np.flatnonzero(x > OUTER), element="Q4I", material=steel, plane="axisymmetric")
    model.fix(np.flatnonzero(mesh.points[:, 1] == 0.0), x=None, y=0.0)
    return model


@pytest.mark.parametrize("joined", [True, False])
@pytest.mark.parametrize("nlgeom", [True, False])
def test_ribs_push_a_ring(joined: bool, nlgeom: bool) -> None:
    """A force F around: the ring grows by ``F R / 2 pi E A``, the ribs shorten by ``F l / E A``."""
    model = wheel(joined)
    inner = np.flatnonzero(model.mesh.points[:, 0] == INNER)
    force = 1e-3
    share = np.array([1.0, 2.0, 1.0]) / 4.0
    for node, part in zip(inner[np.argsort(model.mesh.points[inner, 1])], share, strict=True):
        model.force([node], x=force * part)
    if not joined:
        model.contact("ring.left", "ribs.right")
    frame = ct.solve(model, ct.Static(nlgeom=nlgeom), threads=1).frames[-1]
    np.testing.assert_allclose(frame.U[inner, 0], force * (RING + RIBS), rtol=1e-4)
    rim = np.flatnonzero(model.mesh.points[:, 0] > OUTER)
    np.testing.assert_allclose(frame.U[rim, 0], force * RING, rtol=1e-3)


@pytest.mark.parametrize("slave", ["ring.left", "ribs.right"])
def test_the_joint_has_the_smaller_depth(slave: str) -> None:
    """The contact pressure acts on the ribs, whichever side is the slave."""
    model = wheel(joined=False)
    model.pressure("ribs.left", 0.01)
    master = {"ring.left": "ribs.right", "ribs.right": "ring.left"}[slave]
    model.contact(slave, master)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    pressure = results.nodal("CPRESS")
    np.testing.assert_allclose(pressure[pressure > 0.0], 0.01, rtol=1e-3)


def test_a_pressure_on_a_rib_acts_on_its_thickness() -> None:
    model = wheel(joined=True)
    model.pressure("left", 0.01)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    assert frame.F[:, 0].sum() == pytest.approx(0.01 * DEPTH * HEIGHT)
    inner = frame.U[model.mesh.points[:, 0] == INNER, 0]
    np.testing.assert_allclose(inner, 0.01 * DEPTH * HEIGHT * (RING + RIBS), rtol=1e-4)


def test_what_has_no_meaning_is_refused() -> None:
    with pytest.raises(ct.ModelError, match="plane strain has no end around the axis"):
        ct.solve(wheel(joined=True, plane="strain"), ct.Static(), threads=1)
    model = wheel(joined=True)
    model.sections[0].material.rho = model.sections[1].material.rho = 1.0
    model.centrifugal(omega=1.0)
    with pytest.raises(ct.ModelError, match="acts about its axis, on rings"):
        ct.solve(model, ct.Static(), threads=1)


DECK = """*NODE, NSET=NALL
1, 2., 0.
2, 10., 0.
3, 10., 1.
4, 2., 1.
5, 10.5, 0.
6, 10.5, 1.
*ELEMENT, TYPE=CPS4, ELSET=RIBS
1, 1, 2, 3, 4
*ELEMENT, TYPE=CAX4, ELSET=RING
2, 2, 5, 6, 3
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=RIBS, MATERIAL=M
3.
*SOLID SECTION, ELSET=RING, MATERIAL=M
*BOUNDARY
1, 2
2, 2
5, 2
*STEP
*STATIC
*CLOAD
1, 1, .5
4, 1, .5
*NODE PRINT, NSET=NALL
U
*END STEP
"""


def test_a_deck_means_the_thickness_around_the_circumference(tmp_path: Path) -> None:
    """CalculiX 2.20 gives 5.931094e-03 and 3.260089e-03 for the inner and the outer radius."""
    (tmp_path / "deck.inp").write_text(DECK)
    model = ct.read(tmp_path / "deck.inp")
    assert any("around the whole circumference" in note for note in model.notes)
    frame = ct.solve(model, threads=1).frames[-1]
    assert frame.U[[0, 4], 0] == pytest.approx([5.931094e-03, 3.260089e-03], rel=2e-4)
