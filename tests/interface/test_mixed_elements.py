"""An element for each kind of cell, and what is said of elements and names that do not fit."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.mesh import Cells, Mesh

STEEL = ct.Elastic(E=1000.0, nu=0.25)


def mixed() -> Mesh:
    """A square of a quadrilateral and two triangles."""
    points = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [0.0, 1.0]])
    cells = [
        Cells("quad4", np.array([[0, 1, 4, 5]]), np.array([1])),
        Cells("tri3", np.array([[1, 2, 3], [1, 3, 4]]), np.array([2, 3])),
    ]
    return Mesh(points, cells, np.arange(1, 7))


def test_each_kind_of_cell_gets_its_element() -> None:
    """A constant strain of both: sigma = E u / L."""
    model = ct.Model(mixed())
    model.section(element={"quad4": "Q4I", "tri3": "T3"}, material=STEEL)
    assert [s.element for s in model.sections] == ["Q4I", "T3"]
    model.fix([0, 5], x=0.0, y=None)
    model.fix(0, x=None, y=0.0)
    model.fix([2, 3], x=0.002, y=None)
    results = ct.solve(model, ct.Static(nlgeom=False))
    assert results.nodal("S11") == pytest.approx(1.0, rel=1e-9)


def test_a_kind_without_an_element_is_named() -> None:
    model = ct.Model(mixed())
    with pytest.raises(ct.InputError, match="2 tri3 cells"):
        model.section(element={"quad4": "Q4I"}, material=STEEL)


def test_one_element_for_two_kinds_says_how() -> None:
    model = ct.Model(mixed())
    model.section(element="Q4I", material=STEEL)
    model.fix([0, 5])
    with pytest.raises(ct.ModelError, match="element=\\{'quad4': 'Q4I', 'tri3': 'OPT'\\}"):
        ct.solve(model)


def test_an_element_of_decks_is_named_as_such() -> None:
    model = ct.Model(mixed())
    with pytest.raises(ct.InputError, match=r"element of decks.*Q4I"):
        model.section(element="CPS4R", material=STEEL)


def test_allowables_are_named_in_any_case() -> None:
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1))
    model.section(element="Q4I", material=STEEL)
    model.stage("right", axis="x", allowable={"mises": 2.0})
    assert model.stages[0].allowable == {"MISES": 2.0}


def test_a_run_without_a_load_says_so() -> None:
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1))
    model.section(element="Q4I", material=STEEL)
    model.fix("left")
    assert any("nothing moved" in note for note in ct.solve(model).notes)
    model.force("right", x=1.0)
    assert not any("nothing moved" in note for note in ct.solve(model).notes)
