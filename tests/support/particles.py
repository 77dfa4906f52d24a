"""Particles joined by springs, and the answers of SciPy's integrators to them."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
from scipy import linalg
from scipy.integrate import solve_ivp

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells
from corota.model.loads import Amplitude
from corota.model.schemes import names

LIGHT = 1e-13  # density of lines that carry point masses
IMPLICIT = [name for name in names() if name != "central_difference"]
#: A chain of three particles on springs from a base, in models and in decks.
STIFFNESS, MASSES = [100.0, 200.0, 50.0], [1.0, 2.0, 0.5]
CHAIN_CARDS = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 3., 0.
*NSET, NSET=TIP
4
*NSET, NSET=BASE
1
*ELEMENT, TYPE=SPRINGA, ELSET=S1
1, 1, 2
*ELEMENT, TYPE=SPRINGA, ELSET=S2
2, 2, 3
*ELEMENT, TYPE=SPRINGA, ELSET=S3
3, 3, 4
*SPRING, ELSET=S1

100.
*SPRING, ELSET=S2

200.
*SPRING, ELSET=S3

50.
*ELEMENT, TYPE=MASS, ELSET=M1
11, 2
*ELEMENT, TYPE=MASS, ELSET=M2
12, 3
*ELEMENT, TYPE=MASS, ELSET=M3
13, 4
*MASS, ELSET=M1
1.
*MASS, ELSET=M2
2.
*MASS, ELSET=M3
.5
"""


def network(points, lines=(), dots=()):
    """Model of two-node lines and single points, by node indices."""
    points = np.asarray(points, float)
    cells = []
    if len(lines):
        cells.append(Cells("line2", np.asarray(lines, np.int64), np.arange(1, len(lines) + 1)))
    if len(dots):
        numbers = np.arange(len(lines) + 1, len(lines) + len(dots) + 1)
        cells.append(Cells("point1", np.asarray(dots, np.int64).reshape(-1, 1), numbers))
    return ct.Model(Mesh(points, cells, np.arange(1, len(points) + 1)))


def bars(model, cells, stiffness, length, density=LIGHT):
    """Trusses with the axial stiffness EA/L."""
    model.truss(cells, material=ct.Elastic(E=stiffness * length, rho=density), area=1.0)


def table(model, name, time, value, **options):
    model.amplitudes[name] = Amplitude(np.asarray(time, float), np.asarray(value, float), **options)


def extrapolated(run, increments):
    """Richardson's extrapolation of a result of second order."""
    return (4.0 * run(2 * increments) - run(increments)) / 3.0


def integrate(rate, state, end, breaks=()):
    """State at the end, with restarts where the right-hand side is not smooth."""
    times = [0.0, *[t for t in breaks if 0.0 < t < end], end]
    for start, stop in zip(times, times[1:], strict=False):
        state = solve_ivp(rate, (start, stop), state, method="DOP853", rtol=1e-11, atol=1e-12).y[
            :, -1
        ]
    return state


def lagrange(positions, masses, potential, q, qd, end):
    """Integrate Lagrange's equations of particles x(q) under V(q), by complex steps."""
    q, n = np.asarray(q, float), len(q)
    masses = np.repeat(masses, 2)

    def jacobian(at):
        h = 1e-30
        return np.array([positions(at + 1j * h * e).ravel().imag / h for e in np.eye(n)]).T

    def rate(_, z):
        at, v = z[:n], z[n:]
        jac = jacobian(at)
        h = 1e-6
        turned = (jacobian(at + h * v) - jacobian(at - h * v)) @ v / (2 * h)
        force = -np.array([potential(at + 1e-30j * e).imag / 1e-30 for e in np.eye(n)])
        matrix = jac.T @ (masses[:, None] * jac)
        return np.r_[v, np.linalg.solve(matrix, force - jac.T @ (masses * turned))]

    return integrate(rate, np.r_[q, qd], end)


def chain(stiffness, masses):
    """Particles on the x axis, each joined to the one before it, the first to a support."""
    n = len(masses)
    model = network([[float(i), 0.0] for i in range(n + 1)], [[i, i + 1] for i in range(n)])
    for i in range(n):
        bars(model, [i], stiffness[i], 1.0)
        model.point_mass([i + 1], masses[i])
        model.fix([i + 1], x=None)
    model.fix([0])
    return model


def chain_matrices(stiffness, masses):
    k = np.zeros((len(masses) + 1,) * 2)
    for i, s in enumerate(stiffness):
        k[i : i + 2, i : i + 2] += s * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return k[1:, 1:], np.diag(masses), -k[1:, 0]


def modal_damping(k, m, share):
    squares, modes = linalg.eigh(k, m)
    return m @ modes @ np.diag(2 * share * np.sqrt(squares)) @ modes.T @ m


def linear_motion(k, m, c, load, end, breaks, start=None):
    n = len(m)

    def rate(t, z):
        return np.r_[z[n:], np.linalg.solve(m, load(t) - k @ z[:n] - c @ z[n:])]

    return integrate(rate, np.zeros(2 * n) if start is None else start, end, breaks)


def without_first_support(model):
    """A chain whose support is left to the steps."""
    model.supports = [f for f in model.supports if not (f.dof == 0 and list(f.nodes) == [0])]
    return model


def wheel(where=((0.5, 0.0), (-0.2, 0.4), (0.1, -0.3)), masses=(1.0, 2.0, 0.5), inertia=0.0):
    """Three particles rigidly joined to a reference node in the origin, off their center."""
    points = np.vstack([[0.0, 0.0], where])
    model = network(points, [[1, 2], [2, 3]])
    bars(model, [0, 1], 1.0, 1.0)
    for i, m in enumerate(masses):
        model.point_mass([i + 1], m)
    if inertia:
        model.point_mass([0], LIGHT, inertia=inertia)
    model.rigid([1, 2, 3], 0)
    return model, points[1:], np.asarray(masses)


def column(n, length, young, inertia, area=1.0, rho=1.0):
    model = network([[i * length / n, 0.0] for i in range(n + 1)], [[i, i + 1] for i in range(n)])
    model.beam(list(range(n)), material=ct.Elastic(E=young, rho=rho), area=area, inertia=inertia)
    return model
