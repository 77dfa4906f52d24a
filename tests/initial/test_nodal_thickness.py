"""Thickness by node: interpolated at every point, in forces, masses, loads and output."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.mesh.shape_functions import shape_functions
from support.models import DRILLING, ELEMENTS, QUADRATIC, cell

E, T0, T1, LENGTH, WIDTH = 1000.0, 1.0, 2.0, 10.0, 1.0


def taper(x: np.ndarray) -> np.ndarray:
    """Thickness along the bar."""
    return T0 + (T1 - T0) * x / LENGTH


def bar(element: str, n: int, **keys: Any) -> ct.Model:
    mesh = ct.mesh.rectangle(LENGTH, WIDTH, nx=n, ny=1, cell=cell(element))
    model = ct.Model(mesh)
    model.section(
        element=element,
        material=ct.Elastic(E=E, nu=0.0, rho=3.0, **keys),
        thickness=taper(mesh.points[:, 0]),
    )
    model.fix("left", y=None, rotation=0.0)
    model.fix([0], x=None)
    return model


def tip(model: ct.Model, frame: ct.Frame) -> float:
    return float(frame.U[model.mesh.points[:, 0] > LENGTH - 1e-9, 0].mean())


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_tapered_bar_lengthens_by_its_logarithm(element: str) -> None:
    """u = F L ln(t1 / t0) / (E w (t1 - t0)), of second order at least in the size of elements."""
    want = 5.0 * LENGTH * np.log(T1 / T0) / (E * WIDTH * (T1 - T0))
    errors = []
    for n in (6, 12):
        model = bar(element, n)
        model.traction("right", x=5.0 / (T1 * WIDTH))
        frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
        errors.append(abs(tip(model, frame) / want - 1.0))
        assert -frame.RF[:, 0].sum() == pytest.approx(5.0, rel=1e-9)
    assert errors[1] < 4e-4
    assert errors[1] < 0.3 * errors[0] or errors[1] < 2e-6 or element == "OPT"


@pytest.mark.parametrize("element", ELEMENTS)
def test_mass_weight_and_expansion(element: str) -> None:
    """The sums of gravity, of inertia, of a pressure and the volume are integrals of t."""
    model = bar(element, 4, expansion=1e-3)
    model.gravity(2e-4, 0.0)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    volume = 0.5 * (T0 + T1) * LENGTH * WIDTH
    assert -frame.RF[:, 0].sum() == pytest.approx(2e-4 * 3.0 * volume, rel=1e-10)
    assert sum(f.volume.sum() for f in frame.fields) == pytest.approx(volume, rel=1e-12)
    for fields in frame.fields:
        assert fields.values["STH"] == pytest.approx(taper(fields.points[..., 0]), rel=1e-4)

    model = bar(element, 4)
    model.pressure("top", 0.5)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    assert frame.RF[:, 1].sum() == pytest.approx(0.5 * 0.5 * (T0 + T1) * LENGTH, rel=1e-10)

    model = bar(element, 4, expansion=1e-3)
    model.temperature(10.0)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    assert tip(model, frame) == pytest.approx(0.01 * LENGTH, rel=1e-8)
    assert abs(frame.scalars["strain energy"]) < 1e-12 * E

    model = bar(element, 4)
    model.supports.clear()
    model.velocity(x=2.0)
    scheme = "energy_momentum"
    step = ct.Dynamic(period=1.0, first_increment=0.5, fixed_increments=True, scheme=scheme)
    frame = ct.solve(model, step, threads=1).frames[-1]
    assert frame.scalars["momentum x"] == pytest.approx(2.0 * 3.0 * volume, rel=1e-9)


@pytest.mark.parametrize("element", [e for e in ELEMENTS if e not in DRILLING])
def test_forces_are_those_of_an_integration_of_its_own(element: str) -> None:
    """Nodal forces of a linear displacement: the integral of t B^T s by many points."""
    mesh = ct.mesh.rectangle(2.0, 1.5, nx=1, ny=1, cell=cell(element))
    rng = np.random.default_rng(4)
    thickness = 1.0 + 0.3 * rng.random(mesh.n_nodes)
    if element in QUADRATIC:  # linear fields keep the points of all rules exact
        thickness = 1.0 + 0.2 * mesh.points[:, 0] + 0.1 * mesh.points[:, 1]
    model = ct.Model(mesh)
    model.section(element=element, material=ct.Elastic(E=E, nu=0.3), thickness=thickness)
    move = mesh.points @ np.array([[2e-3, 1e-3], [-5e-4, 1e-3]])
    for node, (x, y) in enumerate(move):
        model.fix([node], x=float(x), y=float(y))
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    moduli = E / 0.91 * np.array([[1.0, 0.3, 0.0], [0.3, 1.0, 0.0], [0.0, 0.0, 0.35]])
    stress = moduli @ np.array([2e-3, 1e-3, 5e-4])
    tensor = np.array([[stress[0], stress[2]], [stress[2], stress[1]]])
    want = np.zeros((mesh.n_nodes, 2))
    kind, modes = mesh.cells[0].kind, element in ("Q4I", "Q4S")
    for nodes in mesh.cells[0].nodes:
        at, weight = _many_points(kind)
        step = 1e-4
        d = np.eye(2) * step
        slope = np.stack(
            [
                (shape_functions(kind, at + s) - shape_functions(kind, at - s)) / (2 * step)
                for s in d
            ],
            axis=-1,
        )
        shape = shape_functions(kind, at)
        jacobian = np.einsum("pki,kj->pij", slope, mesh.points[nodes])
        gradient = np.einsum("pij,pkj->pki", np.linalg.inv(jacobian), slope)
        volume = weight * np.linalg.det(jacobian) * (shape @ thickness[nodes])
        np.add.at(want, nodes, np.einsum("p,pkj,ji->ki", volume, gradient, tensor))
    if modes:  # they answer to a thickness that varies: the resultant is that of the others
        assert frame.RF[:, :2].sum(axis=0) == pytest.approx([0.0, 0.0], abs=1e-9)
        return
    if element == "Q4R":  # one point sees the thickness in the middle
        assert pytest.approx(want, abs=0.1) == frame.RF[:, :2]
        return
    assert pytest.approx(want, abs=2e-7) == frame.RF[:, :2]


def _many_points(kind: str) -> tuple[np.ndarray, np.ndarray]:
    r, w = np.polynomial.legendre.leggauss(6)
    a, b = (v.ravel() for v in np.meshgrid(r, r))
    weight = np.outer(w, w).ravel()
    if not kind.startswith("tri"):
        return np.stack([a, b], axis=1), weight
    # The square folded into the triangle.
    p, q = 0.5 * (1 + a), 0.5 * (1 + b)
    return np.stack([p, q * (1 - p)], axis=1), 0.25 * weight * (1 - p)


def test_one_thickness_by_node_is_the_thickness(tmp_path: Path) -> None:
    frames = []
    for given in (1.7, np.full(27, 1.7)):
        model = ct.Model(ct.mesh.rectangle(8.0, 2.0, nx=8, ny=2))
        model.section(
            element="Q4I",
            material=ct.Mises(E=E, nu=0.3, yield_stress=4.0, isotropic=50.0),
            thickness=given,
        )
        model.fix("left")
        model.traction("right", y=0.2)
        frames.append(ct.solve(model, threads=1).frames[-1])
    assert pytest.approx(frames[0].U, rel=1e-12, abs=1e-14) == frames[1].U


DECK = """*NODE, NSET=ALL
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
5, 1., 0.
6, 2., .5
7, 1., 1.
8, 0., .5
*ELEMENT, TYPE=CPS8, ELSET=E
1, 1, 2, 3, 4, 5, 6, 7, 8
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=E, MATERIAL=M, NODAL THICKNESS
1.
*NODAL THICKNESS
ALL, 1.
2, 2.
3, 2.
6, 2.
5, 1.5
7, 1.5
*BOUNDARY
1, 1, 2
4, 1
8, 1
*STEP
*STATIC
*DLOAD
E, P2, -3.
*END STEP
"""


def test_decks_interpolate_and_are_written_again(tmp_path: Path) -> None:
    path = tmp_path / "a.inp"
    path.write_text(DECK)
    model = ct.read(path)
    assert not [note for note in model.notes if "mean" in note]
    frame = ct.solve(model, threads=1).frames[-1]
    want = 6.0 * 2.0 * np.log(2.0) / 1000.0
    assert frame.U[[1, 2], 0] == pytest.approx(want, rel=2e-3)
    ct.write(model, tmp_path / "b.inp")
    again = ct.solve(ct.read(tmp_path / "b.inp"), threads=1).frames[-1]
    assert pytest.approx(frame.U, abs=1e-14) == again.U
    assert "NODAL THICKNESS" in (tmp_path / "b.inp").read_text()


def test_section_forces_see_the_thickness() -> None:
    model = bar("Q8R", 8)
    model.traction("right", x=5.0 / (T1 * WIDTH))
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    for x in (1.3, 6.1):
        assert pytest.approx(5.0, rel=1e-6) == results.section((x, -1.0), (x, 2.0)).N


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (np.ones(3), "3 thicknesses for 4 nodes"),
        (np.array([1.0, 0.0, 1.0, 1.0]), "node 2 must be > 0"),
    ],
)
def test_thicknesses_that_do_not_fit_are_refused(given: np.ndarray, words: str) -> None:
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1))
    model.section(element="Q4", material=ct.Elastic(E=E), thickness=given)
    model.fix("left")
    with pytest.raises(ct.ModelError, match=words):
        ct.solve(model, threads=1)


def test_lines_have_no_thickness() -> None:
    with pytest.raises(ct.InputError, match="planar elements"):
        ct.Section("all", "TRUSS", ct.Elastic(E=E), np.ones(3))  # type: ignore[arg-type]
