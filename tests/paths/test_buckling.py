"""Linear buckling against Euler, against the path and against dense eigenvalues."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
import scipy.optimize

import corota as ct
from corota.analysis.equations import System
from corota.analysis.linear.lanczos import largest
from corota.analysis.linear.solvers import Multifrontal
from corota.mesh import Mesh
from corota.mesh.data import Cells
from corota.model.loads import EdgeLoad, NodalForce
from support.frames import column, euler_load, node_at, williams_toggle
from support.tied import with_nodes


@pytest.mark.parametrize("element", ["Q8", "Q9", "Q4I", "Q4D", "OPT"])
def test_column_buckles_at_the_euler_load(element):
    """Modes 1, 2, 3 at 1, 9, 25 times the first, less the shear."""
    model = column(element, n=80)
    modes = ct.solve(model, ct.Buckle(modes=3)).modes[0]
    # Drilling elements are a little too soft on regular meshes.
    tolerance = 5e-3 if element in ("Q4D", "OPT") else 2e-3
    assert modes.factors[0] == pytest.approx(euler_load(), rel=tolerance)
    assert modes.factors / modes.factors[0] == pytest.approx([1.0, 9.0, 25.0], rel=5e-3)
    tip = node_at(model.mesh, 100.0, 0.0)
    assert abs(modes.shapes[0, tip, 1]) == pytest.approx(1.0)


def test_path_bifurcates_where_linear_buckling_says():
    """They differ by the order of the critical strain, 8e-5."""
    model = column()
    factor = ct.solve(model, ct.Buckle()).modes[0].factors[0]
    path = ct.ArcLength(factor=1.5 * factor)
    found = ct.solve(model, ct.Static(path=path)).critical_points
    assert [p.kind for p in found] == ["bifurcation"]
    assert found[0].factor == pytest.approx(factor, rel=2e-4)


def test_buckling_about_a_loaded_state_adds_to_it():
    """Half of the load first: what is left is the other half."""
    model = column()
    whole = ct.solve(model, ct.Buckle()).modes[0].factors[0]
    steps = [ct.Static(path=ct.ArcLength(factor=0.5 * whole)), ct.Buckle(modes=1)]
    left = ct.solve(model, steps).modes[0].factors[0]
    assert left == pytest.approx(0.5 * whole, rel=2e-4)


def test_prediction_sharpens_towards_a_limit_point():
    """About states ever nearer, buckling predicts the toggle's limit load from below."""
    model, _ = williams_toggle()
    limit = 33.862
    errors = []
    for share in (0.8, 0.9, 0.98):
        steps = [ct.Static(path=ct.ArcLength(factor=share * limit)), ct.Buckle()]
        left = ct.solve(model, steps).modes[0].factors[0]
        errors.append(abs(share * limit + left - limit))
    assert errors[2] < errors[1] < errors[0]


def test_a_step_after_buckling_starts_where_buckling_found_the_structure():
    model = column()
    tip = node_at(model.mesh, 100.0, 1.0)
    model.loads[0].value = (-0.05 / 2.0, 0.0)
    model.force([tip], y=1e-4)
    one = ct.solve(model, ct.Static())
    two = ct.solve(model, [ct.Static(), ct.Buckle(), ct.Static()])
    assert pytest.approx(one.frames[-1].U, abs=1e-9) == two.frames[-1].U


def test_factors_are_those_of_the_dense_pencil():
    """A small bent frame: all positive factors, none missed."""
    model, _ = williams_toggle(cells=4)
    from corota.analysis.procedures.buckling import _derivative, _perturbation

    modes = ct.solve(model, ct.Buckle(modes=4)).modes[0]
    system = System(model, Multifrontal())
    system.begin(ct.Buckle(), 0.0, np.zeros(system.n_dofs), None)
    u = np.zeros(system.n_dofs)
    force, move, loads = _perturbation(system, ct.Buckle(), 1, u)
    values = system.evaluate(u, 0.0).values
    response, _ = system.correct(system.evaluate(u, 0.0), force, move)
    change = _derivative(system, u, values, response, loads)
    free = np.flatnonzero(~system.conditions.constrained)
    n = system.n_dofs

    def dense(data):
        upper = scipy.sparse.csc_array(
            (data, system.pattern.indices, system.pattern.indptr), shape=(n, n)
        )
        full = upper.toarray()
        return (full + np.triu(full, 1).T)[np.ix_(free, free)]

    theta = scipy.linalg.eigh(-dense(change), dense(values), eigvals_only=True)
    expected = np.sort(1.0 / theta[theta > 0.0])[:4]
    assert modes.factors == pytest.approx(expected, rel=1e-7)


def test_lanczos_finds_double_eigenvalues():
    rng = np.random.default_rng(1)
    values = np.array([5.0, 5.0, 4.0, 3.0, *rng.uniform(-1, 1, 56)])
    turn = np.linalg.qr(rng.standard_normal((60, 60)))[0]
    b = np.diag(rng.uniform(1, 10, 60))
    root = np.sqrt(b)
    a = root @ turn @ np.diag(values) @ turn.T @ root
    start = rng.standard_normal((60, 2))
    found, vectors = largest(lambda x: a @ x, lambda y: np.linalg.solve(b, y), start, 4)
    assert found == pytest.approx([5.0, 5.0, 4.0, 3.0], rel=1e-9)
    assert vectors.T @ b @ vectors == pytest.approx(np.eye(4), abs=1e-9)


def test_lanczos_exhausts_a_small_space():
    a, b = np.diag([3.0, -1.0, 2.0]), np.eye(3)
    start = np.random.default_rng(0).standard_normal((3, 2))
    found, _ = largest(lambda x: a @ x, lambda y: np.linalg.solve(b, y), start, 5)
    assert found == pytest.approx([3.0, 2.0])


def test_what_cannot_buckle_is_said():
    model = column()
    model.loads[0].value = (0.5, 0.0)
    with pytest.raises(ct.ModelError, match="tension"):
        ct.solve(model, ct.Buckle())
    model.loads.clear()
    with pytest.raises(ct.ModelError, match="no load"):
        ct.solve(model, ct.Buckle())
    model = column()
    path = ct.ArcLength(factor=0.2)
    with pytest.raises(ct.ModelError, match="unstable"):
        ct.solve(model, [ct.Static(path=path), ct.Buckle()])
    model = column()
    model.pressure("top", 0.1)
    with pytest.raises(ct.UnsupportedError, match="non-conservative"):
        ct.solve(model, ct.Buckle())
    with pytest.raises(ct.InputError, match="at least one"):
        ct.Buckle(modes=0)


def test_plastic_flow_has_no_linear_buckling():
    """The tangent for loading is not the one for unloading."""
    model = column(n=10)
    material = ct.Mises(E=1000.0, nu=0.0, yield_curve=[(0.02, 0.0), (0.03, 0.02)])
    model.sections[0].material = material
    model.loads[0].value = (0.021, 0.0)
    tip = node_at(model.mesh, 100.0, 1.0)
    steps = [ct.Static(), ct.Buckle(loads=[NodalForce(np.array([tip]), 0, -1.0)])]
    with pytest.raises(ct.UnsupportedError, match="changes abruptly"):
        ct.solve(model, steps)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_pivots_count_dense_negative_eigenvalues_along_a_path(seed):
    """Every equilibrium of a toggle with random middle nodes, but for its limit points."""
    model, apex = williams_toggle(cells=10)
    rng = np.random.default_rng(seed)
    inner = (model.mesh.points[:, 0] > 0.1) & (model.mesh.points[:, 0] < 12.9)
    model.mesh.points[inner] += 0.002 * rng.standard_normal((int(inner.sum()), 2))
    path = ct.ArcLength(displacement=([apex], "y", -0.7), locate=False)
    results = ct.solve(model, ct.Static(path=path), fields=False)
    system = System(model, Multifrontal())
    system.begin(ct.Static(), 0.0, np.zeros(system.n_dofs), None)
    free = np.flatnonzero(~system.conditions.constrained)
    n = system.n_dofs
    counts = set()
    for frame in results.frames[1:]:
        u = system.from_nodes(np.column_stack([frame.U, frame.UR]))
        data = system.evaluate(u, frame.factor).values
        upper = scipy.sparse.csc_array(
            (data, system.pattern.indices, system.pattern.indptr), shape=(n, n)
        )
        full = upper.toarray()
        matrix = (full + np.triu(full, 1).T)[np.ix_(free, free)]
        negative = int((np.linalg.eigvalsh(matrix) < 0.0).sum())
        assert frame.scalars["negative pivots"] == negative
        counts.add(negative)
    assert counts == {0, 1}


def test_rigid_extension_of_a_column_buckles_by_its_own_equation():
    """Load at the end of a rigid arm a on the column: tan(k L) = 1 / (k a), P = k^2 EI.

    The force in the rigid body turns with it, which is what the arm's stiffness is made of.
    """
    length, depth, arm = 100.0, 2.0, 60.0
    mesh = ct.mesh.rectangle(length, depth, nx=40, ny=2, cell="quad8")
    mesh = with_nodes(mesh, (length + arm, depth / 2.0))
    reference = mesh.n_nodes - 1
    model = ct.Model(mesh)
    model.section("all", element="Q8", material=ct.Elastic(E=1000.0, nu=0.0))
    model.fix("left")
    model.rigid("right", reference)
    model.force([reference], x=-1.0)
    bending = 1000.0 * depth**3 / 12.0
    k = scipy.optimize.brentq(lambda k: np.tan(k * length) - 1.0 / (k * arm), 1e-4, 0.0156)
    exact = k * k * bending
    assert exact < 0.5 * euler_load()
    found = ct.solve(model, ct.Buckle(modes=2)).modes[0].factors
    assert found[0] == pytest.approx(exact, rel=2e-3)
    path = ct.ArcLength(factor=1.5 * exact)
    critical = ct.solve(model, ct.Static(path=path)).critical_points
    assert [p.kind for p in critical] == ["bifurcation"]
    assert critical[0].factor == pytest.approx(found[0], rel=2e-4)


@pytest.mark.parametrize("joint", ["tie", "rough contact", "open contact"])
def test_a_column_of_two_parts_buckles_as_what_holds_it_says(joint):
    """Tied or pressed together a column of two meshes has Euler's load of the whole length.

    Across an open joint beside it the column does not see the other body.
    """
    length, h, young = 10.0, 0.5, 1e4
    if joint == "open contact":
        first = ct.mesh.rectangle(length, h, 16, 2, "quad8")
        second = ct.mesh.rectangle(length, h, 16, 2, "quad8", origin=(0.0, 2.0 * h))
        mesh = ct.mesh.assembly(left=first, right=second)
        end = "left.right"
    else:
        first = ct.mesh.rectangle(length / 2, h, 8, 2, "quad8")
        second = ct.mesh.rectangle(length / 2, h, 8, 2, "quad8", origin=(length / 2, 0.0))
        mesh = ct.mesh.assembly(left=first, right=second)
        end = "right.right"
    model = ct.Model(mesh)
    model.section("all", element="Q8", material=ct.Elastic(E=young, nu=0.0))
    model.fix("left.left")
    euler = np.pi**2 * young * h**3 / 12.0 / (4.0 * length**2)
    if joint == "tie":
        model.tie("right.left", "left.right")
        steps = [ct.Buckle()]
    elif joint == "rough contact":
        model.contact("right.left", "left.right", friction=0.5)
        steps = [ct.Static(loads=[EdgeLoad(end, "traction", (-0.2 * euler / h, 0.0))])]
        steps.append(ct.Buckle(loads=[EdgeLoad(end, "traction", (-euler / h, 0.0))]))
    else:
        model.fix("right.left")
        model.contact("right.bottom", "left.top")
        steps = [ct.Buckle()]
    if joint != "rough contact":
        model.traction(end, x=-euler / h)
    found = ct.solve(model, steps, threads=1, fields=False).modes[-1].factors[0]
    exact = 0.8 if joint == "rough contact" else 1.0
    assert found == pytest.approx(exact, rel=0.02)


@pytest.mark.parametrize("share", [1.0, 0.75, 0.25])
def test_all_that_perturbs_adds_to_the_preload(share):
    """After half the critical load a column has half of it left, be it force, heat or shortening.

    A clamped bar: N = 4 pi^2 E I / L^2, by a force, by E A alpha (T - T0), by E A u / L.
    """
    young, area, inertia, alpha, n, start = 1e7, 0.01, 4e-7, 1e-5, 32, 20.0
    points = np.column_stack([np.linspace(0.0, 1.0, n + 1), np.zeros(n + 1)])
    critical = 4.0 * np.pi**2 * young * inertia

    def factor(hot, give, critical):
        lines = np.stack([np.arange(n), np.arange(1, n + 1)], axis=1)
        mesh = Mesh(points, [Cells("line2", lines, np.arange(1, n + 1))])
        model = ct.Model(mesh)
        material = ct.Elastic(E=young, expansion=alpha)
        model.beam(np.arange(n), material=material, area=area, inertia=inertia)
        model.fix([0], rotation=True)
        model.fix([n], x=0.0 if hot else None, y=0.0, rotation=True)
        model.initial_temperature(start)
        steps = [ct.Static(**give(0.5 * critical)), ct.Buckle(**give(share * critical))]
        return ct.solve(model, steps, threads=1, fields=False).modes[-1].factors[0]

    def heat(rise):
        return {"loads": [ct.Temperature(np.arange(n + 1), np.full(n + 1, start + rise))]}

    found = [
        factor(False, lambda p: {"loads": [NodalForce([n], 0, -p)]}, critical),
        factor(True, heat, critical / (young * area * alpha)),
        factor(False, lambda u: {"supports": [ct.Fixed([n], 0, -u)]}, critical / (young * area)),
    ]
    assert found == pytest.approx(3 * [0.5 / share], rel=0.02)
