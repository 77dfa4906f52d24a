"""Common models, loads and measures of verification problems and tests."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from corota import mesh as meshes
from corota.analysis.equations import System
from corota.analysis.linear.solvers import Multifrontal
from corota.analysis.run import solve
from corota.mesh import Cells, Mesh
from corota.mesh.shape_functions import edge_functions
from corota.model import elements
from corota.model.loads import Fixed, NodalForce
from corota.model.materials import Elastic
from corota.model.model import Model
from corota.model.steps import Static, Step
from corota.results.observer import BaseObserver, Iteration

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from corota.arrays import Floats, Ints
    from corota.mesh.generate import Diagonal, Kind
    from corota.results.results import Frame, Results


#: Every registered planar element.
ELEMENTS = elements.names()
#: Elements with drilling rotations.
DRILLING = tuple(n for n in ELEMENTS if elements.find(n).drilling)
#: Elements whose only displacement is the interpolation of the nodes'.
ISOPARAMETRIC = tuple(
    e.name
    for e in map(elements.find, ELEMENTS)
    if not (e.drilling or e.n_internal_modes or e.stabilized)
)
#: Elements of second order.
QUADRATIC = tuple(n for n in ELEMENTS if elements.find(n).cell in ("tri6", "quad8", "quad9"))
#: Corners of Cook's membrane.
COOK = [(0, 0), (48, 44), (48, 60), (0, 44)]


def cell(element: str) -> Kind:
    """Kind of cell that an element fits."""
    return cast("Kind", elements.find(element).cell)


def nearest(mesh: Mesh, x: float, y: float) -> int:
    """Index of the node at a point.

    Raises
    ------
    ValueError
        If there is none.
    """
    distance = np.hypot(mesh.points[:, 0] - x, mesh.points[:, 1] - y)
    if not distance.min() < 1e-9 * np.ptp(mesh.points):
        raise ValueError(f"no node at ({x}, {y})")
    return int(distance.argmin())


def run(model: Model, steps: Step | list[Step] | None = None, **keys: Any) -> Results:
    """Solve with one thread: problems run in parallel processes."""
    return solve(model, steps, **{"threads": 1, "fields": False, **keys})


def linear(model: Model, **keys: Any) -> Frame:
    """Solve one geometrically linear step and return the last frame."""
    return run(model, Static(nlgeom=False), **keys).frames[-1]


def last_frames(results: Results) -> list[Frame]:
    """Last frame of each step."""
    return list({f.step: f for f in results.frames if f.increment > 0}.values())


def boundary(mesh: Mesh) -> Ints:
    """Nodes on the boundary of a mesh."""
    return np.unique(np.concatenate(mesh.edge_nodes(mesh.boundary_edges())))


def prescribe(
    model: Model, nodes: ArrayLike, u: ArrayLike, rotation: ArrayLike | None = None
) -> None:
    """Move each node by its own displacement (n, 2); drilling rotations too where given."""
    where, u = np.asarray(nodes), np.asarray(u, float)
    for dof in (0, 1):
        for n, value in zip(where, u[:, dof], strict=True):
            model.supports.append(Fixed(np.array([n]), dof, float(value)))
    if rotation is not None:
        for n, value in zip(where, np.broadcast_to(rotation, len(where)), strict=True):
            model.supports.append(Fixed(np.array([n]), 2, float(value)))


def edge_forces(
    mesh: Mesh,
    name: str,
    traction: Callable[[Floats], ArrayLike],
    thickness: float = 1.0,
) -> list[Any]:
    """Consistent nodal forces of a traction field on an edge set, without moments.

    Parameters
    ----------
    traction : callable
        Position, shape (2,), to traction (2,).

    Returns
    -------
    list of NodalForce
    """
    force: dict[int, Floats] = {}
    for ends in mesh.edge_nodes(mesh.edge_sets[name]):
        x = mesh.points[list(ends)]
        for r, w in zip(*np.polynomial.legendre.leggauss(4), strict=True):
            n, d = (f[: len(ends)] for f in edge_functions(np.asarray(r), len(ends) == 3))
            dl = w * thickness * np.hypot(*(d @ x))
            t = np.asarray(traction(n @ x), float)
            for a, share in zip(ends, n, strict=True):
                force[int(a)] = force.get(int(a), np.zeros(2)) + share * dl * t
    return [
        NodalForce(np.array([a]), i, float(f[i]))
        for a, f in sorted(force.items())
        for i in (0, 1)
        if f[i] != 0.0
    ]


def single(element: str, x: Floats, *, E: float, nu: float, **section: Any) -> Model:
    """Model of one cell with the nodes `x`, shape (n, 2)."""
    nodes = np.arange(len(x))[None]
    model = Model(Mesh(x, [Cells(cell(element), nodes, np.array([1]))]))
    model.section("all", element=element, material=Elastic(E=E, nu=nu), **section)
    return model


def assemble(model: Model, u: ArrayLike, nlgeom: bool = True) -> tuple[Floats, Floats]:
    """Internal force (n_dofs,) and tangent (n_dofs, n_dofs) at displacements by node."""
    system = System(model, Multifrontal())
    core = system.core
    n = core.n_dofs
    force, scale = np.empty(n), np.empty(n)
    values = np.empty(system.pattern.nnz)
    core.assemble(np.ravel(u).astype(float), nlgeom, force, scale, values)
    return force, system.pattern.full(values).toarray()


def cook(
    element: str,
    n: int,
    *,
    diagonal: Diagonal = "alternate",
    clamp: bool = False,
    force: float = 1.0,
    E: float = 1.0,
    nu: float = 1 / 3,
    **section: Any,
) -> tuple[Model, int]:
    """Cook's membrane, `force` spread evenly over its right side; with the node (48, 52)."""
    mesh = meshes.mapped(COOK, n, n, cell=cell(element), diagonal=diagonal)
    model = Model(mesh)
    model.section("all", element=element, material=Elastic(E=E, nu=nu), **section)
    model.fix("left", rotation=clamp)
    model.traction("right", y=force / 16.0)
    return model, nearest(mesh, 48.0, 52.0)


def cantilever(
    element: str,
    length: float,
    height: float,
    nx: int,
    ny: int,
    *,
    E: float,
    nu: float = 0.0,
    rotation: bool = True,
    diagonal: Diagonal = "alternate",
    **section: Any,
) -> Model:
    """Strip along x, clamped on the left, its axis on y = 0."""
    mesh = meshes.rectangle(
        length, height, nx, ny, cell(element), diagonal, origin=(0.0, -height / 2)
    )
    model = Model(mesh)
    model.section("all", element=element, material=Elastic(E=E, nu=nu), **section)
    model.fix("left", rotation=rotation)
    return model


class Watch(BaseObserver):
    """Keeps the size of the residual and of the correction after each Newton iteration."""

    def __init__(self) -> None:
        self.runs: dict[tuple[int, int, int], list[tuple[float, float]]] = {}
        self.cuts = 0

    def iteration(self, info: Iteration) -> None:
        key = (info.step, info.increment, info.attempt)
        size = max(info.residual, info.moment_residual)
        self.runs.setdefault(key, []).append((size, info.correction))

    def cut_back(self, step: int, increment: int, attempt: int, reason: str, dt: float) -> None:
        self.cuts += 1

    @property
    def iterations(self) -> list[int]:
        """Iterations of every increment, in order."""
        return [len(run) for run in self.runs.values()]

    def orders(self, size: float, below: float) -> Floats:
        """Observed order of the last iterations: growth of the number of correct digits.

        From successive corrections below a share of `size` and above rounding:
        log(e1 / size) / log(e0 / size), which is 2 where e1 = e0^2 / size.
        """
        found: list[float] = []
        for steps in self.runs.values():
            e = [c / size for _, c in steps if c > 1e-13 * size]
            found += [float(np.log(b) / np.log(a)) for a, b in pairwise(e) if a < below][-1:]
        return np.array(found)
