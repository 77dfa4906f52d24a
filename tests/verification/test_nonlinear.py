"""Large displacement against exact and converged solutions; Newton converges quadratically."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.model import EdgeLoad, NodalForce
from corota.steps import Static
from support.models import (
    Watch,
    assert_contracts,
    assert_quadratic,
    balance,
    cantilever,
    cell,
    cook,
    edge_forces,
    nearest,
    run,
)

SLENDER = 2e-3
CONTINUUM = 3e-4
#: What the best-fit frame adds on sheared cells at strains up to a third.
FRAME = 2e-3

# P L^2 / EI, deflection / L, shortening / L of the inextensible elastica under a dead end
# force across the axis (agrees with K. Mattiasson, Int. J. Numer. Meth. Engng 17, 1981).
ELASTICA = [
    (0.2, 0.0663644821, 0.0026465483),
    (0.5, 0.1621435757, 0.0159189625),
    (1, 0.3017207738, 0.0564332363),
    (2, 0.4934574804, 0.1606417208),
    (3, 0.6032534411, 0.2544201846),
    (4, 0.6699641813, 0.3289412422),
    (5, 0.7137915236, 0.3876283607),
    (6, 0.7445711489, 0.4345888287),
    (7, 0.7673690997, 0.4729274284),
    (8, 0.7849823750, 0.5048277321),
    (9, 0.7990555275, 0.5318205627),
    (10, 0.8106090249, 0.5549955978),
    (15, 0.8477156743, 0.6352857804),
    (20, 0.8686958983, 0.6838855676),
]


@pytest.mark.parametrize(
    ("element", "nx", "ny"),
    [("Q8", 50, 1), ("Q8R", 50, 1), ("Q9", 50, 1), ("T6", 60, 1), ("Q4I", 100, 1),
     ("OPT", 200, 2), ("Q4D", 100, 4)],
)  # fmt: skip
def test_elastica(element, nx, ny):
    length, height, E = 10.0, 0.1, 1.2e9
    inertia = height**3 / 12.0
    model = cantilever(element, length, height, nx, ny, E=E)
    steps = [
        Static(
            loads=[EdgeLoad("right", "traction", (0.0, k * E * inertia / length**2 / height))],
            increments=1,
            tolerance=1e-12,
        )
        for k, _, _ in ELASTICA
    ]
    watch = Watch()
    results = ct.solve(model, steps, observers=[watch], threads=1, fields=False)
    tip = nearest(model.mesh, length, 0.0) if ny > 1 or "9" in element else None
    for step, (k, w, u) in enumerate(ELASTICA, start=1):
        frame = [f for f in results.frames if f.step == step][-1]
        end = frame.U[model.mesh.node_sets["right"]] if tip is None else frame.U[[tip]]
        found = end.mean(axis=0) / length
        assert abs(found[1] - w) <= SLENDER * w, (k, found)
        assert abs(-found[0] - u) <= SLENDER * u, (k, found)
        assert max(balance(model, frame)) <= 1e-8
    assert_contracts(watch, 20 * length / height**2, 1e-9 * length)


ROLL_UP = {
    0.25: (0.6366197724, 0.6366197724),
    0.5: (0.0, 0.6366197724),
    0.75: (-0.2122065908, 0.2122065908),
    1.0: (0.0, 0.0),
}


@pytest.mark.parametrize(("element", "nx", "ny"), [("OPT", 200, 2), ("Q4D", 200, 4)])
def test_roll_up(element, nx, ny):
    """A cantilever under the end moment 2 pi E I / L becomes a circle; h / L = 0.01."""
    length, height, E = 10.0, 0.1, 1.2e9
    model = cantilever(element, length, height, nx, ny, E=E)
    tip = model.mesh.node_sets["right"]
    moment = 2.0 * np.pi * E * height**3 / 12.0 / length / len(tip)
    steps = [Static(loads=[NodalForce(tip, 2, part * moment)], increments=4) for part in ROLL_UP]
    watch = Watch()
    results = ct.solve(model, steps, observers=[watch], threads=1, fields=False)
    for step, (part, place) in enumerate(ROLL_UP.items(), start=1):
        frame = [f for f in results.frames if f.step == step][-1]
        found = (model.mesh.points[tip] + frame.U[tip]).mean(axis=0) / length
        assert np.abs(found - place).max() <= SLENDER, (part, found)
    assert_contracts(watch, 20 * length / height**2, 1e-9 * length)


def test_thick_cantilever_of_the_biot_continuum():
    """10 x 1, parabolic dead end shear, Q9 80 x 8; converged values of that continuum.

    The continuum is W = (U - I) : C : (U - I) / 2, the limit of linear local strain; values
    by an independent computation.
    """
    model = cantilever("Q9", 10.0, 1.0, 80, 8, E=1200.0, nu=0.3)
    watch = Watch()
    tip = nearest(model.mesh, 10.0, 0.0)
    rows = {1: (-0.56737, 3.03767), 2: (-1.61730, 4.97497), 4: (-3.31596, 6.77129)}
    steps = [
        Static(
            loads=edge_forces(
                model.mesh, "right", lambda x, p=p: (0.0, 1.5 * p * (1.0 - 4.0 * x[1] ** 2))
            ),
            increments=2,
            tolerance=1e-10,
        )
        for p in rows
    ]
    with pytest.warns(UserWarning, match="local strain"):
        results = ct.solve(model, steps, observers=[watch], threads=1)
    for step, expected in enumerate(rows.values(), start=1):
        frame = [f for f in results.frames if f.step == step][-1]
        assert np.abs(frame.U[tip] / expected - 1.0).max() <= CONTINUUM, frame.U[tip]
    assert_quadratic(watch, 0.1)


#: Load, displacement of (48, 52): converged values of the Biot continuum, Q9 32 x 32.
COOK_BIOT = {
    0.05: (-0.54267, 1.17457),
    0.1: (-1.09874, 2.30164),
    0.2: (-2.23563, 4.41288),
    0.5: (-5.63346, 9.68620),
    1.0: (-10.59336, 15.86147),
}


def test_cook_membrane_beside_the_biot_continuum():
    """Large displacement of (48, 52) on Q9 32 x 32, dead end shear.

    The best-fit frame is the polar rotation only where the nodes of a cell have equal second
    moments in all directions; on the sheared cells of this mesh the limit differs from the
    Biot continuum by a share of the strain, whatever the refinement.
    """
    model, tip = cook("Q9", 32)
    model.loads.clear()
    steps = [
        Static(loads=[EdgeLoad("right", "traction", (0.0, f / 16.0))], tolerance=1e-10)
        for f in COOK_BIOT
    ]
    watch = Watch()
    results = ct.solve(model, steps, observers=[watch], threads=1, fields=False)
    for step, (force, expected) in enumerate(COOK_BIOT.items(), start=1):
        frame = [f for f in results.frames if f.step == step][-1]
        error = np.abs(frame.U[tip] / expected - 1.0).max()
        assert error <= (CONTINUUM if force <= 0.05 else FRAME), (force, frame.U[tip])
    assert_quadratic(watch, 4.0)


@pytest.mark.parametrize("local_strain", ["simplified", "modified"])
@pytest.mark.parametrize("element", ["T3", "T6", "Q4", "Q4I", "Q8", "Q8R", "Q9", "OPT", "Q4D"])
def test_newton_is_quadratic_for_every_element(element, local_strain):
    model, _ = cook(element, 4, force=0.3, local_strain=local_strain)
    watch = Watch()
    frame = run(model, Static(increments=2, tolerance=1e-12), watch)
    assert_quadratic(watch, 10.0)
    assert watch.cuts == 0
    assert max(balance(model, frame)) <= 1e-10


ANNULUS = [("T3", 2), ("T6", 3), ("Q4", 2), ("Q4I", 2), ("Q8", 3), ("Q8R", 3), ("Q9", 3),
           ("OPT", 2), ("Q4D", 2)]  # fmt: skip


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize(("element", "order"), ANNULUS)
def test_annulus_under_inner_pressure_converges(element, order, plane):
    """Lame's solution: a = 100, b = 200, p = 100, E = 210000, nu = 0.3."""
    exact = {
        "stress": (0.0936507936507936, 0.0634920634920635),
        "strain": (0.0907936507936508, 0.0577777777777778),
    }[plane]
    errors = []
    for n in (4, 8, 16):
        mesh = ct.mesh.annulus(100.0, 200.0, n, 2 * n, angle=90.0, cell=cell(element))
        model = ct.Model(mesh)
        material = ct.Elastic(E=210000.0, nu=0.3)
        model.section("all", element=element, material=material, thickness=3.0, plane=plane)
        model.fix("start", x=None, rotation=True)
        model.fix("end", y=None, rotation=True)
        model.pressure("inner", 100.0)
        frame = run(model, Static(nlgeom=False))
        found = []
        for name in ("inner", "outer"):
            nodes = mesh.node_sets[name]
            normal = mesh.points[nodes] / np.hypot(*mesh.points[nodes].T)[:, None]
            found.append((frame.U[nodes] * normal).sum(axis=1).mean())
        errors.append(np.abs(np.array(found) / exact - 1.0).max())
    assert errors[-1] <= 5e-3
    assert np.log2(errors[-2] / errors[-1]) >= order - 0.2, errors
