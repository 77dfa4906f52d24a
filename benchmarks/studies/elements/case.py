"""What a study is made of: a problem, its variants, meshes, the value to compare, a reference."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: The paper's four elements; its second one in both forms.
ELEMENTS = ("Q4I", "Q8", "Q9", "OPT", "Q4D")
#: Elements with a rotation at each node.
DRILLING = ("OPT", "Q4D", "Q4DI")
#: Runs shorter than this [s] are repeated, and the shortest time is taken.
SHORT = 0.1


@dataclass(frozen=True)
class Case:
    """A problem on which elements are compared.

    Parameters
    ----------
    study, name, title : str
        Chapter of the page, name of the figure's file, heading.
    about : str
        Geometry, load, what is compared and with what, in Markdown.
    variants : sequence of str
        One column of the figure each: regular and distorted meshes, masses, local strains.
    meshes : sequence of int
        What `build` makes of them.
    build : callable
        ``(element, variant, n)`` to a model and its step.
    value : callable
        Of the results: what is compared, any shape.
    reference : callable
        ``(variant)`` to the value that counts as exact.
    elements : sequence of str
    quantity : str
        What the error is one of, for the axis.
    per_variant : bool
        The reference depends on the variant.
    coarser : callable, optional
        The reference on a mesh half as fine: their difference bounds the reference's own error,
        by a third of it where it falls with the square of the mesh, by all of it at worst.
    extra : callable, optional
        Of the results: further numbers by name, columns of the table.
    """

    study: str
    name: str
    title: str
    about: str
    variants: Sequence[str]
    meshes: Sequence[int]
    build: Callable[[str, str, int], tuple[ct.Model, Any]]
    value: Callable[[ct.Results], Floats]
    reference: Callable[[str], Floats]
    elements: Sequence[str] = ELEMENTS
    quantity: str = "error"
    per_variant: bool = False
    coarser: Callable[[str], Floats] | None = None
    extra: Callable[[ct.Results], dict[str, float]] | None = None


def measure(case: Case, element: str, variant: str, n: int) -> dict[str, Any]:
    """Solve (three times where it is short): error, size, processor time of one thread.

    What stops early has no error and says why.
    """
    record: dict[str, Any] = {"case": case.name, "element": element, "variant": variant, "n": n}
    seconds = np.inf
    for _ in range(3):
        model, step = case.build(element, variant, n)
        record["dofs"] = model.mesh.n_nodes * (3 if element in DRILLING else 2)
        begin = time.process_time()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                results = ct.solve(model, step, threads=1, fields=False)
            except ct.CorotaError as error:
                spent = time.process_time() - begin
                return record | {"stopped": str(error).splitlines()[0], "seconds": spent}
        spent = time.process_time() - begin
        seconds = min(seconds, spent)
        if spent > SHORT:
            break
    exact = reference(case, variant)
    found = np.asarray(case.value(results), dtype=float)
    more = case.extra(results) if case.extra else {}
    return (
        record
        | more
        | {
            "error": distance(found, exact),
            "moves": moves(case, variant),
            "seconds": seconds,
            "iterations": int(results.info["iterations"]),
            "value": np.ravel(found)[-1].item(),
        }
    )


def distance(found: Floats, exact: Floats) -> float:
    """Root mean square of the difference, over that of the exact values."""
    return float(np.linalg.norm(found - exact) / np.linalg.norm(exact))


@cache
def moves(case: Case, variant: str) -> float:
    """What the reference changes by from a mesh half as fine."""
    if not case.per_variant and variant != case.variants[0]:
        return moves(case, case.variants[0])
    if case.coarser is None:
        return float("nan")
    return distance(np.asarray(case.coarser(variant), dtype=float), reference(case, variant))


@cache
def reference(case: Case, variant: str) -> Floats:
    """The case's reference, once."""
    if not case.per_variant and variant != case.variants[0]:
        return reference(case, case.variants[0])
    return np.asarray(case.reference(variant), dtype=float)


def solved(model: ct.Model, step: Any) -> ct.Results:
    """Results of a reference."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ct.solve(model, step, threads=2, fields=False)


def nearest(mesh: ct.Mesh, x: float, y: float) -> int:
    """Node nearest to a point."""
    return int(np.argmin(np.hypot(*(mesh.points - np.array([x, y])).T)))


def slanted(mesh: ct.Mesh, cells: int, share: float = 0.3) -> ct.Mesh:
    """Turn the cells of a rectangle into trapezoids: upright sides lean to and fro.

    Parameters
    ----------
    mesh : Mesh
        Of ``mesh.rectangle``, with `cells` along x.
    share : float
        Shift of the upper and lower ends over the length of a cell.
    """
    from corota.mesh.change import placed_middles

    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    width, height = high - low
    column = (mesh.points[:, 0] - low[0]) / width * cells
    whole = np.abs(column - np.rint(column)) < 1e-9
    inner = whole & (column > 0.5) & (column < cells - 0.5)
    lean = (2.0 * (mesh.points[:, 1] - low[1]) / height - 1.0) * (-1.0) ** np.rint(column)
    points = mesh.points.copy()
    points[inner, 0] += share * width / cells * lean[inner]
    return placed_middles(mesh, points)
