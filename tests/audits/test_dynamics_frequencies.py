"""Frequencies and complex modes, against closed forms and small programs."""

# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
import pytest
from scipy import linalg

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells
from corota.model.loads import Fixed
from support.audits import CELL
from support.particles import (
    bars,
    chain,
    chain_matrices,
    network,
)

pytestmark = pytest.mark.filterwarnings("ignore:central differences took")


def test_chain_modes_masses_and_participation():
    # Generalized eigenproblem of three particles by LAPACK; unit modal mass; participation
    # phi^T M 1 and its square over the total mass.
    stiffness, masses = [100.0, 200.0, 50.0], [1.0, 2.0, 0.5]
    k, m, _ = chain_matrices(stiffness, masses)
    squares, modes = linalg.eigh(k, m)
    results = ct.solve(chain(stiffness, masses), ct.Frequency(modes=3))
    found = results.modes[-1]
    np.testing.assert_allclose(2 * np.pi * found.factors, np.sqrt(squares), rtol=1e-9)
    shapes = found.shapes[:, 1:, 0]
    np.testing.assert_allclose(
        np.abs(np.einsum("ij,jk->ik", shapes @ m, modes)), np.eye(3), atol=1e-7
    )
    for i in range(3):
        factor = modes[:, i] @ masses
        scalars = results.frames[-1].scalars
        np.testing.assert_allclose(abs(scalars[f"participation x {i + 1}"]), abs(factor), rtol=1e-7)
        np.testing.assert_allclose(scalars[f"effective mass x {i + 1}"], factor**2 / 3.5, rtol=1e-7)


def test_complex_modes_of_damping_that_couples_and_overdamps():
    # s^2 M + s C + K: a dashpot to the ground, one between two particles and Rayleigh damping; the
    # companion matrix by LAPACK. Shapes satisfy the quadratic eigenproblem themselves.
    stiffness, masses = [100.0, 200.0, 50.0], [1.0, 2.0, 0.5]
    k, m, _ = chain_matrices(stiffness, masses)
    c = 0.3 * m + 0.004 * k
    c[2, 2] += 4.0
    c[:2, :2] += 6.0 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    model = chain(stiffness, masses)
    model.dashpot(3, x=4.0)
    model.dashpot(1, 2, c=6.0)
    step = ct.Frequency(modes=3, complex_modes=True, rayleigh=(0.3, 0.004))
    found = ct.solve(model, step).modes[-1]
    companion = np.block(
        [[np.zeros((3, 3)), np.eye(3)], [-np.linalg.solve(m, k), -np.linalg.solve(m, c)]]
    )
    roots = np.linalg.eigvals(companion)
    roots = roots[roots.imag > 0]
    roots = roots[np.argsort(np.abs(roots))]
    s = found.growth + 2j * np.pi * found.factors
    np.testing.assert_allclose(s[np.argsort(np.abs(s))], roots, rtol=1e-8)
    for i, root in enumerate(s):
        shape = (found.shapes + 1j * found.imaginary)[i, 1:, 0]
        rest = (root**2 * m + root * c + k) @ shape
        assert np.abs(rest).max() < 1e-7 * np.abs(k @ shape).max()


def test_aperiodic_modes_of_an_overdamped_particle():
    # m s^2 + c s + k with c above critical: two real rates, no frequency.
    model = chain([100.0], [1.0])
    model.dashpot(0, 1, c=50.0)
    found = ct.solve(model, ct.Frequency(modes=2, complex_modes=True)).modes[-1]
    np.testing.assert_allclose(found.factors, 0.0, atol=1e-12)
    np.testing.assert_allclose(
        np.sort(found.growth), np.sort(np.roots([1.0, 50.0, 100.0])), rtol=1e-8
    )


@pytest.mark.parametrize("omega", [3.0, 12.0])
def test_particle_on_two_pairs_of_springs_in_a_turning_frame(omega):
    # (kx - m W^2 + m s^2)(ky - m W^2 + m s^2) + 4 m^2 W^2 s^2 = 0: whirl forward and backward at 3,
    # divergence where W^2 lies between kx/m and ky/m.
    kx, ky = 60.0, 200.0
    model = network([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]], [[0, 1], [0, 2], [0, 3], [0, 4]])
    model.truss([0, 1], material=ct.Elastic(E=kx / 2, rho=0.5), area=1.0)
    model.truss([2, 3], material=ct.Elastic(E=ky / 2, rho=0.5), area=1.0)
    model.fix([1, 2, 3, 4])
    model.centrifugal(omega)
    mass = 1.0
    a, b = kx / mass - omega**2, ky / mass - omega**2
    squares = np.roots([1.0, a + b + 4 * omega**2, a * b])
    step = ct.Frequency(modes=2, complex_modes=True, mass="lumped")
    steps = [ct.Static(), step]
    if a * b < 0:
        with pytest.warns(UserWarning, match="divergence"):
            found = ct.solve(model, steps).modes[-1]
    else:
        found = ct.solve(model, steps).modes[-1]
    s = np.sort_complex(np.sqrt(squares.astype(complex)))
    own = found.growth + 2j * np.pi * found.factors
    if a * b > 0:
        np.testing.assert_allclose(np.sort(own.imag), np.sort(np.abs(s.imag)), rtol=1e-7)
        np.testing.assert_allclose(own.real, 0.0, atol=1e-6)
    else:
        np.testing.assert_allclose(found.growth.max(), np.abs(s.real).max(), rtol=1e-7)


def test_growth_of_an_overloaded_pendulum():
    # A bar under the dead weight P stands on its support, a spring holds its top sideways:
    # m w^2 = k - P/l with the shortened length l; above P = k l it falls at that rate.
    k, stiff, m, length = 10.0, 1e4, 2.0, 1.0
    for weight in (4.0, 25.0):
        model = network([[0, 0], [0, length], [-1000.0, length]], [[0, 1], [1, 2]])
        bars(model, [0], stiff, length)
        bars(model, [1], k, 1000.0)
        model.point_mass([1], m)
        model.fix([0, 2])
        model.force([1], y=-weight)
        short = length - weight / stiff
        square = (k - weight / short) / m
        steps = [ct.Static(), ct.Frequency(modes=1)]
        if square > 0:
            found = ct.solve(model, steps).modes[-1]
            np.testing.assert_allclose(2 * np.pi * found.factors[0], math.sqrt(square), rtol=1e-5)
        else:
            with (
                pytest.warns(UserWarning, match="divergence"),
                pytest.warns(UserWarning, match="a bifurcation or limit point was passed"),
            ):
                found = ct.solve(model, steps).modes[-1]
            np.testing.assert_allclose(found.growth[0], math.sqrt(-square), rtol=1e-5)
            assert found.factors[0] == 0.0


@pytest.mark.parametrize("push", [5.0, 40.0])
def test_rigid_plate_on_springs_under_a_following_force(push):
    # A plate of mass m with its center at (sx, 0) from the reference node, on springs kx, ky, kt
    # there, pushed by a pressure on its right side: the pressure turns with the plate and adds
    # P theta to y. Frequencies of the unsymmetric 2 x 2 problem; at 40 they meet: flutter.
    kx, ky, kt = 500.0, 50.0, 20.0
    mesh = ct.mesh.rectangle(1.0, 0.5, nx=2, ny=1, origin=(-0.2, -0.25))
    pivot = ct.mesh.add_node(mesh, 0.0, 0.0, name="pivot")
    points, cells = mesh.points, list(mesh.cells)
    cells.append(Cells("point1", np.array([[pivot]] * 3), np.array([11, 12, 13])))
    mesh = Mesh(points, cells, mesh.node_labels, mesh.node_sets, mesh.cell_sets, mesh.edge_sets)
    model = ct.Model(mesh)
    model.section([0, 1], element="Q4", material=ct.Elastic(E=1e5, rho=8.0), thickness=0.5)
    model.spring([2], kx, "x")
    model.spring([3], ky, "y")
    model.spring([4], kt, "rotation")
    model.rigid(np.arange(6), pivot)
    model.pressure("right", push / (0.5 * 0.5))
    m, s = 8.0 * 0.5 * 0.5, 0.3
    inertia = m * (1.0 + 0.25) / 12 + m * s**2
    mass = np.array([[m, m * s], [m * s, inertia]])
    stiff = np.array([[ky, push], [0.0, kt]])
    squares = np.linalg.eigvals(np.linalg.solve(mass, stiff)).astype(complex)
    flutter = abs(squares.imag).max() > 1e-9
    assert flutter == (push > 20.0)
    roots = np.sqrt(-squares)
    steps = [ct.Static(), ct.Frequency(modes=3)]
    if flutter:
        with pytest.warns(UserWarning, match="flutter"):
            found = ct.solve(model, steps).modes[-1]
        i = int(np.argmax(found.growth))
        np.testing.assert_allclose(found.growth[i], abs(roots.real).max(), rtol=1e-6)
        np.testing.assert_allclose(2 * np.pi * found.factors[i], abs(roots.imag).max(), rtol=1e-6)
    else:
        found = ct.solve(model, steps).modes[-1]
        exact = np.sort(np.r_[abs(roots.imag), math.sqrt(kx / m)])
        np.testing.assert_allclose(np.sort(2 * np.pi * found.factors), exact, rtol=1e-6)


def test_twelve_modes_within_a_millionth():
    # Twelve equal particles on equal springs, joined to their neighbors by springs 1e-7 as stiff:
    # all are found, in order, and their shapes are M-orthonormal.
    n, k, weak = 12, 100.0, 1e-5
    points = [[float(i), 0.0] for i in range(n)] + [[float(i), 1.0] for i in range(n)]
    model = network(points, [[i, n + i] for i in range(n)], [])
    bars(model, list(range(n)), k, 1.0)
    for i in range(n):
        model.point_mass([i], 2.0)
        model.fix([i], y=None)
        model.fix([n + i])
    matrix = k * np.eye(n)
    frames = ct.solve(model, ct.Frequency(modes=n))
    found = frames.modes[-1]
    np.testing.assert_allclose(2 * np.pi * found.factors, math.sqrt(k / 2.0), rtol=1e-9)
    shapes = found.shapes[:, :n, 1]
    np.testing.assert_allclose(2.0 * shapes @ shapes.T, np.eye(n), atol=1e-9)
    # The same with the weak springs: vertical differences by fixed directions.
    lines = [[i, n + i] for i in range(n)] + [[i, i + 1] for i in range(n - 1)]
    model = network(points, lines)
    bars(model, list(range(n)), k, 1.0)
    model.spring(list(range(n, 2 * n - 1)), weak, "y y")
    for i in range(n):
        model.point_mass([i], 2.0)
        model.fix([i], y=None)
        model.fix([n + i])
    for i in range(n - 1):
        matrix[i : i + 2, i : i + 2] += weak * np.array([[1.0, -1.0], [-1.0, 1.0]])
    exact = np.sqrt(np.linalg.eigvalsh(matrix) / 2.0)
    found = ct.solve(model, ct.Frequency(modes=n)).modes[-1]
    np.testing.assert_allclose(2 * np.pi * found.factors - exact, 0.0, atol=1e-10 * exact[0])


@pytest.mark.parametrize("way", ["stretch", "initial stress"])
def test_taut_string_of_particles(way):
    # n particles on a string under the tension T at the spacing a: w_j = 2 sqrt(T/(m a)) sin(j pi /
    # (2(n+1))); along it 2 sqrt(k/m) sin(...). Without NLGEOM the frequency step sees no tension.
    n, k, m, a, tension = 9, 1e4, 0.2, 0.5, 30.0
    points = [[i * a, 0.0] for i in range(n + 2)]
    model = network(points, [[i, i + 1] for i in range(n + 1)])
    bars(model, list(range(n + 1)), k, a)
    model.point_mass(list(range(1, n + 1)), m)
    model.fix([0])
    spacing, inner = a, list(range(1, n + 1))
    first, second = ct.Static(), ct.Frequency(modes=2 * n)
    if way == "stretch":
        # The slack string is held sideways until it is taut; the frequency step lets it go.
        ends = [Fixed([0], 0), Fixed([0], 1), Fixed([n + 1], 1)]
        pulled = Fixed([n + 1], 0, (n + 1) * tension / k)
        first = ct.Static(supports=[*ends, pulled, Fixed(inner, 1)])
        second = ct.Frequency(modes=2 * n, new_supports=True, supports=[*ends, pulled])
        model.supports.clear()
        spacing = a + tension / k
    else:
        model.fix([n + 1])
        model.initial_stress(xx=tension)
    found = ct.solve(model, [first, second]).modes[-1]
    share = np.sin(np.arange(1, n + 1) * math.pi / (2 * (n + 1)))
    exact = np.r_[2 * math.sqrt(tension / (m * spacing)) * share, 2 * math.sqrt(k / m) * share]
    np.testing.assert_allclose(2 * np.pi * found.factors, np.sort(exact), rtol=1e-7)


def test_gears_on_a_torsion_spring():
    # phi2 = -3 phi1 by an equation: w^2 = kt / (I1 + 9 I2), also about a turned state.
    kt, i1, i2 = 40.0, 2.0, 0.5
    model = network([[0, 0], [3, 0]], [[0, 1]], [0, 1])
    model.spring([0], 1.0)
    model.spring([1], kt, "rotation")
    model.spring([2], 1e-9, "rotation")
    model.point_mass([0], 1.0, inertia=i1)
    model.point_mass([1], 1.0, inertia=i2)
    model.fix([0, 1])
    model.equation((1, "rotation", 1.0), (0, "rotation", 3.0))
    model.force([1], moment=5.0)
    results = ct.solve(model, [ct.Static(), ct.Frequency(modes=1)])
    np.testing.assert_allclose(results.frames[-1].UR, [-15.0 / kt, 45.0 / kt], rtol=1e-7)
    exact = math.sqrt(kt / (i1 + 9 * i2))
    np.testing.assert_allclose(2 * np.pi * results.modes[-1].factors[0], exact, rtol=1e-7)


def test_rotating_cantilever_beam():
    # First flapping frequency of a cantilever that rotates at eta = W L^2 sqrt(rho A / EI), hub of
    # radius 0: 3.6817, 5.5850, 11.2023 at 1, 4, 10 (Wright et al., J. Appl. Mech. 49, 1982); in the
    # plane of rotation the square is less by eta^2, Coriolis forces left out.
    n, length, rho, area, inertia = 40, 1.0, 1.0, 1.0, 1e-6
    young = 1.0 / inertia
    for eta, flap in ((1.0, 3.6817), (4.0, 5.5850), (10.0, 11.2023)):
        model = network(
            [[i * length / n, 0.0] for i in range(n + 1)], [[i, i + 1] for i in range(n)]
        )
        model.beam(
            list(range(n)), material=ct.Elastic(E=young, rho=rho), area=area, inertia=inertia
        )
        model.fix([0], rotation=True)
        model.centrifugal(eta)
        found = ct.solve(model, [ct.Static(), ct.Frequency(modes=1)]).modes[-1]
        exact = math.sqrt(flap**2 - eta**2)
        np.testing.assert_allclose(2 * np.pi * found.factors[0], exact, rtol=2e-3)


def test_compressed_beam_and_its_buckling_load():
    # Pinned beam under a dead force P: w^2 = w0^2 (1 - P/Pcr), w0 = pi^2 sqrt(EI/(rho A L^4)). The
    # chords of 64 beams leave (pi/64)^2/12 of P/Pcr, which 1 - P/Pcr magnifies.
    n, length, area, inertia, young, rho = 64, 2.0, 1.0, 1e-6, 2e5, 0.03
    critical = math.pi**2 * young * inertia / length**2
    for share in (-1.0, 0.5, 0.9):
        model = network(
            [[i * length / n, 0.0] for i in range(n + 1)], [[i, i + 1] for i in range(n)]
        )
        model.beam(
            list(range(n)), material=ct.Elastic(E=young, rho=rho), area=area, inertia=inertia
        )
        model.fix([0])
        model.fix([n], x=None)
        model.force([n], x=-share * critical)
        found = ct.solve(model, [ct.Static(), ct.Frequency(modes=1)]).modes[-1]
        first = math.pi**2 * math.sqrt(young * inertia / (rho * area * length**4))
        np.testing.assert_allclose(
            2 * np.pi * found.factors[0], first * math.sqrt(1 - share), rtol=1.5e-3
        )


@pytest.mark.parametrize("element", ["T3", "Q4", "Q4I", "Q4R", "Q4S"])
@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_dispersion_of_a_row_of_cells(element, mass):
    # A bar of equal linear cells, nu = 0, free to move along x only: consistent mass gives
    # w^2 = (6 c^2/h^2)(1 - cos kh)/(2 + cos kh), lumped 2 c^2/h^2 (1 - cos kh), fixed-fixed.
    n, h, c = 10, 0.3, 7.0
    mesh = ct.mesh.rectangle(n * h, 0.2, nx=n, ny=1, cell=CELL[element])
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=c**2 * 4.0, rho=4.0), thickness=3.0)
    model.fix("left")
    model.fix("right")
    model.fix("bottom", x=None)
    model.fix("top", x=None)
    low, high = mesh.nodes_of("bottom"), mesh.nodes_of("top")
    for a, b in zip(low[1:-1], high[1:-1], strict=True):
        model.equation((int(b), "x", 1.0), (int(a), "x", -1.0))
    found = ct.solve(model, ct.Frequency(modes=n - 1, mass=mass)).modes[-1]
    co = np.cos(np.arange(1, n) * math.pi / n)
    square = 6 * (1 - co) / (2 + co) if mass == "consistent" else 2 * (1 - co)
    np.testing.assert_allclose(2 * np.pi * found.factors, c / h * np.sqrt(square), rtol=1e-8)


@pytest.mark.parametrize("element", ["Q8", "Q9", "Q8R", "T6"])
def test_free_ring(element):
    # A free ring has three rigid motions and pairs of inextensional modes, w^2 = EI/(rho A R^4)
    # n^2 (n^2-1)^2 / (n^2+1); thickness of the wall R/40, pairs agree to 1e-6.
    mesh = ct.mesh.annulus(0.9875, 1.0125, n_radial=1, n_around=108, cell=CELL[element])
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=ct.Elastic(E=1e6, nu=0.3, rho=2.0), thickness=0.1
    )
    found = ct.solve(model, ct.Frequency(modes=9)).modes[-1]
    w = 2 * np.pi * found.factors
    h = 0.025
    n = np.array([2, 3, 4])
    exact = np.sqrt(1e6 * h**2 / 12 / 2.0 * n**2 * (n**2 - 1) ** 2 / (n**2 + 1))
    assert np.all(w[:3] < 0.05)
    np.testing.assert_allclose(w[3:8:2], exact, rtol=1e-2)
    np.testing.assert_allclose(w[3:8:2], w[4:9:2], rtol=1e-6)
