"""Analysis of the body that densities mean, with exact contact, beside that of the densities."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from corota.analysis.run import solve
from corota.display import Brief
from corota.gradients.runs import Run
from corota.mesh import to_quadratic

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.arrays import Floats
    from corota.gradients.density import Density
    from corota.gradients.measures import Measure
    from corota.mesh import Mesh
    from corota.model.model import Model
    from corota.results.results import Results


#: Name of the contact of the body with itself.
CONTACT = "body"


@dataclass(repr=False)
class Reanalysis(Brief):
    """A measure by densities and by their body.

    Parameters
    ----------
    densities, body : float
        The measure by both analyses.
    mesh : Mesh
        Of the body.
    pressed : int
        Largest number of nodes of the body that pressed on it in an increment.
    results : Results
        Of the body.
    """

    densities: float
    body: float
    mesh: Mesh
    pressed: int
    results: Results = field(repr=False)

    @property
    def error(self) -> float:
        """How much the densities were off, over the measure of the body."""
        return self.densities / self.body - 1.0

    def __repr__(self) -> str:
        met = f"{self.pressed} nodes press on the body itself" if self.pressed else "no contact"
        return (
            f"Reanalysis({self.densities:.6g} by the densities, {self.body:.6g} by the body: the "
            f"densities were off by {self.error:+.2%}; {met})"
        )


def reanalyze(
    build: Callable[[Mesh, Any], Model],
    density: Density,
    x: Floats,
    measure: Callable[[Mesh], Measure],
    *,
    contact: bool = True,
    friction: float = 0.0,
    **options: Any,
) -> Reanalysis:
    """Analyze the body that densities mean, and compare it with their own analysis.

    The body is cut out where the filtered density exceeds the threshold and meshed to its boundary,
    by triangles of six nodes. Its boundary meets itself by exact contact, of which the densities
    know nothing: there soft cells fill the gaps.

    Parameters
    ----------
    build : callable
        As of :func:`optimize_density`: ``build(mesh, thickness)``, whose first cells are those of
        `mesh`.
    density : Density
    x : ndarray, shape (n_nodes,)
        Design variables.
    measure : callable
        Gives the measure on a mesh.
    contact : bool
        Whether the body meets itself.
    friction : float
        Coefficient of that contact.
    **options
        Of :func:`corota.solve`.

    Returns
    -------
    Reanalysis

    Examples
    --------
    ``print(gradients.reanalyze(build, density, x, stroke))`` in ``examples/inverter``.
    """
    soft = solve(build(density.mesh, density.thicknesses(x)), **options)
    mesh = to_quadratic(density.body(x))
    model = build(mesh, density.thickness)
    if contact:
        edges = mesh.boundary_edges()
        model.contact(edges, edges, friction=friction, name=CONTACT)
    results = solve(model, **options)
    by_densities, by_body = (
        float(Run(run, [measure(own)], adjoint=False).values[0])
        for run, own in ((soft, density.mesh), (results, mesh))
    )
    # With one pair its values are those of the frame.
    tables = [f.pairs.get(CONTACT, f.C) for f in results.frames] if contact else []
    pressed = max((int((t[:, 0] > 0.0).sum()) for t in tables if t is not None), default=0)
    return Reanalysis(by_densities, by_body, mesh, pressed, results)
