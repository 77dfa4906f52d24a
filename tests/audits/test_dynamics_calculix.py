"""Motion and modes beside CalculiX 2.20 and beside small programs that solve decks."""

# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
import pytest

import corota as ct
from support.audits import CELL
from support.particles import (
    CHAIN_CARDS,
    MASSES,
    STIFFNESS,
    chain_matrices,
    integrate,
    linear_motion,
)

pytestmark = pytest.mark.filterwarnings("ignore:central differences took")


LONG_PLATE = """*NODE, NSET=ALL
{nodes}
*ELEMENT, TYPE=CPE8, ELSET=E
{elements}
*NSET, NSET=L
{left}
*MATERIAL, NAME=M
*ELASTIC
210000., .3
*DENSITY
7.8e-9
*SOLID SECTION, ELSET=E, MATERIAL=M{options}
3.
*BOUNDARY
L, 1, 2
"""


def plate_deck(options=""):
    """Cantilever of 100 x 10 mm and 3 mm, 8 x 2 serendipity cells; numbers row by row."""
    label, nodes = {}, []
    for j in range(5):
        for i in range(17):
            if not (i % 2 and j % 2):
                label[i, j] = len(label) + 1
                nodes.append(f"{label[i, j]}, {100 * i / 16}, {10 * j / 4}")
    order = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    elements = []
    for j in range(2):
        for i in range(8):
            own = [label[2 * i + p, 2 * j + q] for p, q in order]
            elements.append(", ".join(map(str, [len(elements) + 1, *own])))
    left = ", ".join(str(label[0, j]) for j in range(5))
    return LONG_PLATE.format(
        nodes="\n".join(nodes), elements="\n".join(elements), left=left, options=options
    )


def run_deck(text, folder, name="job"):
    path = folder / f"{name}.inp"
    path.write_text(text)
    return ct.solve(ct.read(path))


def test_frequencies_beside_calculix(tmp_path):
    # CalculiX 2.20, the same deck.
    results = run_deck(plate_deck() + "*STEP\n*FREQUENCY\n6\n*END STEP\n", tmp_path)
    calculix = [879.0976, 5269.234, 13650.02, 13882.01, 25299.30, 38868.63]
    np.testing.assert_allclose(results.modes[-1].factors, calculix, rtol=2e-6)


def test_spinning_preload_beside_calculix(tmp_path):
    # CalculiX 2.20: static NLGEOM step under CENTRIF, then *STEP, PERTURBATION, *FREQUENCY. Its
    # material is linear in Green-Lagrange strain, so the same measure is used here.
    spin = "*DLOAD\nE, CENTRIF, 4.e6, 0., 5., 0., 0., 0., 1.\n"
    text = plate_deck(", LOCAL STRAIN=GREEN LAGRANGE") + (
        f"*STEP, NLGEOM\n*STATIC\n{spin}*END STEP\n*STEP, PERTURBATION\n*FREQUENCY\n6\n*END STEP\n"
    )
    calculix = [890.2048, 5320.437, 13658.29, 13940.71, 25365.30, 38941.18]
    found = run_deck(text, tmp_path).modes[-1].factors
    np.testing.assert_allclose(found, calculix, rtol=2e-6)


def test_buckling_beside_calculix(tmp_path):
    # CalculiX 2.20, force on the middle of the free end; it takes the stresses of the linear
    # response alone, which is the same to the first order of the strain.
    text = plate_deck(", LOCAL STRAIN=GREEN LAGRANGE") + (
        "*STEP\n*BUCKLE\n3\n*CLOAD\n43, 1, -1.\n*END STEP\n"
    )
    found = run_deck(text, tmp_path).modes[-1].factors
    np.testing.assert_allclose(found, [14235.46, 120136.7, 298042.2], rtol=5e-3)
    np.testing.assert_allclose(found[0], 14235.46, rtol=3e-4)


def test_first_frequency_under_a_following_tension(tmp_path):
    # A tension that follows the free end: Beck's frequency equation p^2 + 2 w^2 (1 + ch a cos b) +
    # p w sh a sin b = 0 with p = -P L^2/EI lowers the first frequency by 6.85 %. Its EI does not
    # change with the tension: the local strain is linear.
    pull = "*DLOAD\n8, P2, -400.\n16, P2, -400.\n"
    text = plate_deck(", LOCAL STRAIN=LINEAR") + (
        f"*STEP, NLGEOM\n*STATIC\n{pull}*END STEP\n*STEP, PERTURBATION\n*FREQUENCY\n2\n*END STEP\n"
    )

    def first(p):
        def value(w):
            r = math.sqrt(p * p / 4 + w * w)
            a, b = math.sqrt(r - p / 2), math.sqrt(r + p / 2)
            even = 2 * w * w * (1 + math.cosh(a) * math.cos(b))
            return p * p + even + p * w * math.sinh(a) * math.sin(b)

        low, high = 1.0, 5.0
        for _ in range(100):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if value(low) * value(middle) > 0 else (low, middle)
        return low

    p = -400.0 * 30 * 100.0**2 / (210000 / 0.91 * 250)
    found = run_deck(text, tmp_path).modes[-1].factors[0]
    np.testing.assert_allclose(found / 879.0976, first(p) / first(0.0), rtol=2e-3)


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q8", "T6", "T3"])
@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_coriolis_forces_of_a_continuum(element, mass):
    # All real modes give the mass, M = (Phi Phi^T)^-1; C = 2 W M J. Eigenvalues by LAPACK.
    mesh = ct.mesh.rectangle(100.0, 10.0, nx=5, ny=1, cell=CELL[element])
    model = ct.Model(mesh)
    steel = ct.Elastic(E=210000.0, nu=0.3, rho=7.8e-9)
    model.section("all", element=element, material=steel, thickness=3.0, plane="strain")
    model.fix("left")
    spin = 2000.0
    model.centrifugal(spin, about=(0.0, 5.0))
    free = np.setdiff1d(np.arange(mesh.n_nodes), mesh.nodes_of("left"))
    n = 2 * len(free)
    steps = [
        ct.Static(),
        ct.Frequency(modes=n, mass=mass),
        ct.Frequency(modes=4, mass=mass, complex_modes=True),
    ]
    real, found = ct.solve(model, steps).modes
    phi = real.shapes[:, free, :2].reshape(n, n).T
    matrix = np.linalg.inv(phi @ phi.T)
    turn = np.kron(np.eye(len(free)), [[0.0, -1.0], [1.0, 0.0]])
    half = spin * matrix @ turn
    modal = phi.T @ (half - half.T) @ phi
    squares = (2 * np.pi * real.factors) ** 2
    companion = np.block([[np.zeros((n, n)), np.eye(n)], [-np.diag(squares), -modal]])
    roots = np.linalg.eigvals(companion)
    exact = np.sort(roots.imag[roots.imag > 0])[:4] / (2 * np.pi)
    np.testing.assert_allclose(found.factors, exact, rtol=1e-8)
    np.testing.assert_allclose(found.growth, 0.0, atol=1e-6 * exact[0])


CHAIN_DECK = (
    CHAIN_CARDS
    + """*ELEMENT, TYPE=DASHPOTA, ELSET=D
21, 2, 3
*DASHPOT, ELSET=D

6.
*AMPLITUDE, NAME=A
0., 0., 0.25, 1., 0.5, 1., 1., -2.
2., 0.
*BOUNDARY
1, 1, 2
2, 2
3, 2
4, 2
"""
)


COUPLED = 6.0 * np.array([[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 0.0]])


def table_rows(text, name):
    """Tables of a .dat file under headings that hold `name`: time to rows."""
    found, rows = {}, None
    for line in text.splitlines():
        if "time" in line:
            rows = found.setdefault(float(line.split()[-1]), []) if name in line else None
        elif line.strip() and rows is not None:
            try:
                rows.append([float(word) for word in line.split()])
            except ValueError:
                rows = None
    return found


def solve_to_files(text, folder):
    path = folder / "job.inp"
    path.write_text(text)
    results = ct.solve(ct.read(path), observers=[ct.JobFiles(str(folder))])
    return results, (folder / "job.dat").read_text()


def test_deck_of_modal_dynamics_with_a_dashpot(tmp_path):
    # Forces by a table, dashpot between two particles, table of displacements in .dat.
    steps = (
        "*STEP\n*FREQUENCY\n3\n*END STEP\n"
        "*STEP\n*MODAL DYNAMIC\n0.05, 1.5\n*CLOAD, AMPLITUDE=A\n4, 1, 3.\n"
        "*NODE PRINT, NSET=TIP\nU\n*END STEP\n"
    )
    results, text = solve_to_files(CHAIN_DECK + steps, tmp_path)
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    corners = [0.0, 0.25, 0.5, 1.0, 2.0]

    def load(t):
        return np.array([0.0, 0.0, 3.0 * np.interp(t, corners, [0.0, 1.0, 1.0, -2.0, 0.0])])

    exact = linear_motion(k, m, COUPLED, load, 1.5, corners)
    np.testing.assert_allclose(results.frames[-1].U[1:, 0], exact[:3], rtol=1e-7)
    rows = table_rows(text, "TIP")
    np.testing.assert_allclose(rows[max(rows)][-1][1], exact[2], rtol=1e-5)


def test_deck_of_steady_state_with_two_load_cases(tmp_path):
    # LOAD CASE=2 acts a quarter of a period ahead; the dashpot couples the modes.
    steps = (
        "*STEP\n*FREQUENCY\n3\n*END STEP\n"
        "*STEP\n*STEADY STATE DYNAMICS\n0.5, 2.5, 5\n"
        "*CLOAD, LOAD CASE=1\n2, 1, 2.\n*CLOAD, LOAD CASE=2\n4, 1, -1.\n*END STEP\n"
    )
    results, _ = solve_to_files(CHAIN_DECK + steps, tmp_path)
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    frames = [f for f in results.frames if f.step == 2]
    assert len(frames) == 13
    for frame in frames:
        w = 2 * math.pi * frame.time
        exact = np.linalg.solve(k - w**2 * m + 1j * w * COUPLED, [2.0, 0.0, -1j])
        np.testing.assert_allclose(frame.U[1:, 0], exact.real, atol=1e-7 * abs(exact).max())
        np.testing.assert_allclose(
            frame.V[1:, 0], -w * exact.imag, atol=1e-7 * w * abs(exact).max()
        )


def test_deck_of_complex_frequencies(tmp_path):
    # Eigenvalues of the quadratic problem in the result and in the table.
    steps = "*STEP\n*FREQUENCY\n3\n*END STEP\n*STEP\n*COMPLEX FREQUENCY, CORIOLIS\n3\n*END STEP\n"
    results, text = solve_to_files(CHAIN_DECK + steps, tmp_path)
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    companion = np.block(
        [[np.zeros((3, 3)), np.eye(3)], [-np.linalg.solve(m, k), -np.linalg.solve(m, COUPLED)]]
    )
    roots = np.linalg.eigvals(companion)
    roots = roots[roots.imag > 0]
    roots = roots[np.argsort(roots.imag)]
    found = results.modes[-1]
    np.testing.assert_allclose(2 * np.pi * found.factors, roots.imag, rtol=1e-8)
    np.testing.assert_allclose(found.growth, roots.real, rtol=1e-8)
    rows = [line.split() for line in text.splitlines() if line.split()[:1] == ["1"]]
    assert any(
        len(row) == 4
        and math.isclose(float(row[1]), roots[0].imag, rel_tol=1e-6)
        and math.isclose(abs(float(row[3])), abs(roots[0].real), rel_tol=1e-6)
        for row in rows
    )


def test_deck_of_direct_dynamics_and_its_histories(tmp_path):
    # Trapezoidal rule (ALPHA=0) with a dashpot and a table: displacement in .dat,
    # dissipation of the dashpot and kinetic energy in .csv.
    steps = (
        "*STEP, INC=10000\n*DYNAMIC, DIRECT, ALPHA=0.\n0.005, 1.5\n*CLOAD, AMPLITUDE=A\n"
        "4, 1, 3.\n*NODE PRINT, NSET=TIP, FREQUENCY=100\nU\n*END STEP\n"
    )
    _, text = solve_to_files(CHAIN_DECK + steps, tmp_path)
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    corners = [0.0, 0.25, 0.5, 1.0, 2.0]

    def rate(t, z):
        force = np.array([0.0, 0.0, 3.0 * np.interp(t, corners, [0.0, 1.0, 1.0, -2.0, 0.0])])
        v = z[3:6]
        return np.r_[
            v, np.linalg.solve(m, force - k @ z[:3] - COUPLED @ v), v @ COUPLED @ v, force @ v
        ]

    exact = integrate(rate, np.zeros(8), 1.5, corners)
    rows = table_rows(text, "TIP")
    np.testing.assert_allclose(rows[max(rows)][-1][1], exact[2], rtol=1e-3)
    lines = (tmp_path / "job.csv").read_text().splitlines()
    names = lines[0].split(",")
    last = dict(zip(names, lines[-1].split(","), strict=True))
    np.testing.assert_allclose(float(last["ALLVD"]), exact[6], rtol=1e-3)
    np.testing.assert_allclose(float(last["ALLWK"]), exact[7], rtol=1e-3)
    np.testing.assert_allclose(float(last["ALLKE"]), 0.5 * exact[3:6] @ m @ exact[3:6], rtol=2e-3)
