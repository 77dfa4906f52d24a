"""Models and measures that several tests share."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from itertools import pairwise

import numpy as np

import corota as ct
from corota import elements
from corota.drivers.solvers import Faer
from corota.drivers.system import System
from corota.mesh import Cells
from corota.model import Fixed, NodalForce
from corota.results import Silent

#: Every registered element with the kind of cell that it fits.
ELEMENTS = elements.names()
#: Elements whose only displacement is the interpolation of the nodes'.
ISOPARAMETRIC = ("T3", "T6", "Q4", "Q8", "Q8R", "Q9")
DRILLING = tuple(n for n in ELEMENTS if elements.find(n).dofs_per_node == 3)
QUADRATIC = ("T6", "Q8", "Q8R", "Q9")


def cell(element):
    """Kind of cell that an element fits."""
    return elements.find(element).cell


class Watch(Silent):
    """Keeps the size of the residual and of the correction after each Newton iteration."""

    def __init__(self):
        self.runs = {}
        self.cuts = 0

    def iteration(self, info):
        key = (info.step, info.increment, info.attempt)
        size = max(info.residual, info.moment_residual)
        self.runs.setdefault(key, []).append((size, info.correction))

    def cut_back(self, step, increment, attempt, reason, dt):
        self.cuts += 1

    @property
    def iterations(self):
        """Iterations of every increment, in order."""
        return [len(run) for run in self.runs.values()]

    def orders(self, size, below):
        """Observed order of the last iterations: growth of the number of correct digits.

        From successive corrections below a share of `size` and above rounding:
        log(e1 / size) / log(e0 / size), which is 2 where e1 = e0^2 / size.
        """
        found = []
        for run in self.runs.values():
            e = [c / size for _, c in run if c > 1e-13 * size]
            last = [np.log(b) / np.log(a) for a, b in pairwise(e) if a < below]
            found += last[-1:]
        return np.array(found)


def assert_quadratic(watch, size, below=1e-3):
    """Assert that Newton's last iterations converge with order 1.8 at least.

    Parameters
    ----------
    watch : Watch
    size : float
        Length over which the problem is nonlinear, thickness^2 / length of a slender part.
    below : float
        Share of it from which corrections count as the last ones.
    """
    orders = watch.orders(size, below)
    assert len(orders) > 0, "no increment has two corrections in the asymptotic range"
    assert (orders >= 1.8).all(), orders


def assert_contracts(watch, constant, floor):
    """Assert e1 <= constant e0^2 for successive corrections, down to a rounding floor.

    For slender structures: the constant, about length / thickness^2, is so large and the
    stiffness so ill-conditioned that no pair of corrections shows the order itself. Linear
    convergence breaks this bound all the same, near the floor.
    """
    for key, run in watch.runs.items():
        for (_, a), (_, b) in pairwise(run):
            assert b <= max(constant * a * a, floor), (key, a, b)


def run(model, steps=None, watch=None, **keys):
    """Solve with one thread and return the last frame."""
    keys = {"threads": 1, "fields": False, **keys}
    return ct.solve(model, steps, observers=[watch] if watch else [], **keys).frames[-1]


def linear(model, **keys):
    """Solve one geometrically linear step and return the last frame."""
    return run(model, ct.Static(nlgeom=False), **keys)


def prescribe(model, nodes, u, rotation=None):
    """Move each node by its own displacement; drilling rotations too where given."""
    dofs = model.supports
    for n, value in zip(nodes, u, strict=True):
        dofs.append(Fixed(np.array([n]), 0, float(value[0])))
        dofs.append(Fixed(np.array([n]), 1, float(value[1])))
    if rotation is not None:
        for n, value in zip(nodes, np.broadcast_to(rotation, len(nodes)), strict=True):
            dofs.append(Fixed(np.array([n]), 2, float(value)))


def boundary(mesh):
    """Nodes on the boundary of a mesh."""
    return np.unique(np.concatenate(mesh.edge_nodes(mesh.boundary_edges())))


def edge_forces(mesh, name, traction, thickness=1.0):
    """Consistent nodal forces of a traction field on straight edges, without moments.

    Parameters
    ----------
    traction : callable
        Position, shape (2,), to traction (2,).

    Returns
    -------
    list of NodalForce
    """
    force = {}
    for ends in mesh.edge_nodes(mesh.edge_sets[name]):
        x = mesh.points[list(ends)]
        for r, w in zip(*np.polynomial.legendre.leggauss(4), strict=True):
            if len(ends) == 2:
                n, d = [(1 - r) / 2, (1 + r) / 2], [-0.5, 0.5]
            else:
                n = [r * (r - 1) / 2, r * (r + 1) / 2, 1 - r * r]
                d = [r - 0.5, r + 0.5, -2 * r]
            dl = w * thickness * np.hypot(*(np.array(d) @ x))
            t = np.asarray(traction(np.array(n) @ x))
            for a, share in zip(ends, n, strict=True):
                force[int(a)] = force.get(int(a), 0.0) + share * dl * t
    return [
        NodalForce(np.array([a]), i, float(f[i]))
        for a, f in sorted(force.items())
        for i in (0, 1)
        if f[i] != 0.0
    ]


def nearest(mesh, x, y):
    """Index of the node at a point."""
    distance = np.hypot(mesh.points[:, 0] - x, mesh.points[:, 1] - y)
    assert distance.min() < 1e-9 * np.ptp(mesh.points)
    return int(distance.argmin())


def single(element, x, *, E, nu, **section):
    """Model of one cell with the nodes `x`, shape (n, 2)."""
    nodes = np.arange(len(x))[None]
    model = ct.Model(ct.Mesh(x, [Cells(cell(element), nodes, np.array([1]))]))
    model.section("all", element=element, material=ct.Elastic(E=E, nu=nu), **section)
    return model


def assemble(model, u, nlgeom=True):
    """Internal force (n_dofs,) and tangent (n_dofs, n_dofs) at displacements by node."""
    core = System(model, Faer()).core
    n = core.n_dofs
    force, scale = np.empty(n), np.empty(n)
    values = np.empty(len(core.indices))
    core.assemble(np.ravel(u).astype(float), nlgeom, force, scale, values)
    upper = np.zeros((n, n))
    upper[core.indices, np.repeat(np.arange(n), np.diff(core.indptr.astype(int)))] = values
    return force, upper + np.triu(upper, 1).T


COOK = [(0, 0), (48, 44), (48, 60), (0, 44)]


def cook(element, n, *, diagonal="alternate", clamp=False, force=1.0, E=1.0, nu=1 / 3, **section):
    """Cook's membrane with the shear force `force` spread evenly over the right side."""
    mesh = ct.mesh.mapped(COOK, n, n, cell=cell(element), diagonal=diagonal)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=E, nu=nu), **section)
    model.fix("left", rotation=clamp)
    model.traction("right", y=force / 16.0)
    return model, nearest(mesh, 48.0, 52.0)


def cantilever(element, length, height, nx, ny, *, E, nu=0.0, diagonal="alternate", **section):
    """Strip along x, clamped on the left, its axis on y = 0."""
    mesh = ct.mesh.rectangle(
        length, height, nx, ny, cell(element), diagonal, origin=(0.0, -height / 2)
    )
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=E, nu=nu), **section)
    model.fix("left", rotation=True)
    return model


def balance(model, frame, moved=True):
    """Sum of reactions and loads, and of their moments about the origin, over their sizes.

    Parameters
    ----------
    moved : bool
        Moments about the deformed body; a geometrically linear one balances undeformed.
    """
    held = np.zeros((model.mesh.n_nodes, 3), bool)
    for item in model.supports:
        nodes = model.mesh.nodes_of(item.nodes) if isinstance(item.nodes, str) else item.nodes
        held[nodes, item.dof] = True
    total = np.where(held, frame.RF, 0.0) + frame.F
    x = model.mesh.points + (frame.U if moved else 0.0)
    size = np.abs(frame.RF[held]).max() + np.abs(frame.F).max()
    moment = x[:, 0] @ total[:, 1] - x[:, 1] @ total[:, 0] + total[:, 2].sum()
    return np.abs(total[:, :2].sum(axis=0)).max() / size, abs(moment) / (size * np.abs(x).max())
