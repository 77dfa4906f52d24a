"""Supports and loads of a model as cards of a deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import UnsupportedError
from corota.io.deck.write.text import DOFS, Writer, number, numbers, plain
from corota.io.deck.write.thermal import temperatures
from corota.model.loads import AppliedLoad, BodyForce, EdgeLoad, Fixed, NodalForce, Temperature
from corota.model.sections import thickness_at

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from corota.arrays import Ints
    from corota.mesh import Mesh

#: Abscissas and weights of Gauss's rule of three points over a curved edge.
_GAUSS = (np.array([-math.sqrt(0.6), 0.0, math.sqrt(0.6)]), np.array([5.0, 8.0, 5.0]) / 9.0)


def boundary(
    writer: Writer, supports: Sequence[Fixed], new: bool, option: str = ""
) -> Iterator[str]:
    """``*BOUNDARY``, with ``OP=NEW`` where earlier ones end."""
    if new:
        yield "*BOUNDARY, OP=NEW\n"
    for (amplitude, keep), group in groupby(supports, key=lambda s: (s.amplitude, s.keep)):
        more = f", AMPLITUDE={plain(amplitude)}" if amplitude else ""
        more += ", FIXED" if keep else ""
        yield f"*BOUNDARY{more}{option}\n"
        for support in group:
            dof = DOFS[support.dof]
            for target in writer.nodes(support.nodes):
                yield f"{target}, {dof}, {dof}, {number(support.value)}\n"


def load_cards(writer: Writer, load: AppliedLoad, case: str = "") -> Iterator[str]:
    """Cards of one load; `case` is an option of all of them."""
    option = (f", AMPLITUDE={plain(load.amplitude)}" if load.amplitude else "") + case
    if isinstance(load, NodalForce):
        yield f"*CLOAD{', FOLLOWER' if load.follower else ''}{option}\n"
        if np.ndim(load.value):  # a value for each node
            labels = writer.mesh.node_labels[writer.mesh.node_indices(load.nodes)].tolist()
            rows = list(zip(map(str, labels), np.asarray(load.value).tolist(), strict=True))
        else:
            rows = [(target, float(load.value)) for target in writer.nodes(load.nodes)]
        for target, value in rows:
            yield f"{target}, {DOFS[load.dof]}, {number(value)}\n"
    elif isinstance(load, EdgeLoad):
        yield from _edges(writer, load, option)
    elif isinstance(load, Temperature):
        yield f"*TEMPERATURE{option}\n" + temperatures(writer, load.nodes, load.value)
    elif isinstance(load, BodyForce):
        row = _body(writer, load)
        yield f"*DLOAD{option}\n{row}" if row else ""


def ending(mesh: Mesh, load: AppliedLoad, earlier: Sequence[AppliedLoad]) -> list[AppliedLoad]:
    """A load as cards can express it.

    Gravity of size zero ends that of every direction. A nodal force of zero that ends none is not
    written.
    """
    if isinstance(load, NodalForce) and not np.any(load.value):
        nodes = mesh.node_indices(load.nodes)
        ends = any(
            isinstance(old, NodalForce)
            and old.dof == load.dof
            and np.isin(mesh.node_indices(old.nodes), nodes).any()
            for old in earlier
        )
        return [load] if ends else []
    if not (isinstance(load, BodyForce) and load.kind == "gravity" and load.axis is None):
        return [load]
    found: dict[tuple[float, ...], AppliedLoad] = {}
    for old in earlier:
        if not (isinstance(old, BodyForce) and old.kind == load.kind):
            continue
        if _same(old.cells, load.cells) and (axis := old.axis) is not None:
            x, y = axis.tolist()
            found[round(x, 9), round(y, 9)] = replace(load, direction=(x, y))
    return list(found.values())


def _same(one: str | Ints, other: str | Ints) -> bool:
    """Whether two body forces name the same cells, as the analysis compares them."""
    if isinstance(one, str) and isinstance(other, str):
        return (one if one != "all" else "") == (other if other != "all" else "")
    return not isinstance(one, str) and not isinstance(other, str) and np.array_equal(one, other)


def _edges(writer: Writer, load: EdgeLoad, option: str) -> Iterator[str]:
    if load.kind == "shear":
        yield from _shear(writer, load, option)
        return
    if load.kind == "electrostatic":
        raise UnsupportedError("decks have no electrostatic loads; keep the model in Python")
    if load.kind == "penetrating pressure":
        raise UnsupportedError(
            "decks have fluids that penetrate by contact pair, models by edges; keep the model in "
            "Python"
        )
    name = writer.edge_set(load.edges)
    if load.kind == "pressure":
        yield f"*DSLOAD{option}\n{name}, P, {number(load.value[0])}\n"
        return
    if load.kind == "hydrostatic pressure":
        yield f"*DSLOAD{option}\n{name}, HP, {numbers(load.value)}\n"
        return
    x, y = load.value
    size = math.hypot(x, y)
    if size == 0.0:
        # It ends an earlier one, in whatever direction.
        size, x, y = 0.0, 1.0, 0.0
    force = size / edge_area(writer, load.edges) if load.total else size
    size = math.hypot(x, y)
    dead = "" if load.kind == "following traction" else ", FOLLOWER=NO"
    yield f"*DSLOAD{dead}{option}\n"
    yield f"{name}, TRVEC, {number(force)}, {number(x / size)}, {number(y / size)}\n"


def _shear(writer: Writer, load: EdgeLoad, option: str) -> Iterator[str]:
    """A shear along edges: of all in one card, or where no direction suits all, of each."""
    mesh = writer.mesh
    edges = mesh.edge_pairs(load.edges)
    ends = np.array([nodes[:2] for nodes in mesh.edge_nodes(edges)])
    along = mesh.points[ends[:, 1]] - mesh.points[ends[:, 0]]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    mean = along.sum(axis=0)
    value = number(load.value[0])
    if (along @ mean > 1e-6 * len(along)).all():
        x, y = (mean / np.linalg.norm(mean)).tolist()
        yield f"*DSLOAD{option}\n{writer.edge_set(load.edges)}, TRSHR, {value}, "
        yield f"{number(x)}, {number(y)}\n"
        return
    yield f"*DLOAD{option}\n"
    labels = mesh.cell_labels
    for (cell, side), (x, y) in zip(edges.tolist(), along.tolist(), strict=True):
        yield f"{labels[cell]}, TRSHR{side + 1}, {value}, {number(x)}, {number(y)}\n"


def _body(writer: Writer, load: BodyForce) -> str:
    targets = (
        [writer.cell_set(load.cells)] if isinstance(load.cells, str) or len(load.cells) else []
    )
    targets += _mass_sets(writer, load)
    if load.kind == "centrifugal":
        square, x, y = load.value
        ring = any(section.axisymmetric for section in writer.model.sections)
        axis = "0., 1., 0." if ring else "0., 0., 1."
        row = f"CENTRIF, {number(square)}, {number(x)}, {number(y)}, 0., {axis}\n"
        return "".join(f"{where}, {row}" for where in targets)
    if load.kind != "gravity":
        label = "P" if load.kind == "line" else "B"
        # Without a direction of its own the load stands for both components.
        used = load.direction or (1.0, 1.0)
        axes = zip("XY", load.value, used, strict=True)
        rows = [(f"{label}{a}", v) for a, v, n in axes if n != 0.0]
        return "".join(f"{where}, {a}, {number(v)}\n" for a, v in rows for where in targets)
    along = load.axis
    if along is None:
        return ""
    size = math.hypot(*load.value)
    if load.direction:
        size = math.copysign(size, float(along @ load.value))
    x, y = along.tolist()
    row = f"GRAV, {number(size)}, {number(x)}, {number(y)}, 0.\n"
    return "".join(f"{where}, {row}" for where in targets)


def _mass_sets(writer: Writer, load: BodyForce) -> list[str]:
    """Sets of the point masses that a load acts on."""
    masses = writer.model.point_masses
    found = []
    for mass, nodes in load.point_masses(writer.mesh, masses):
        if not len(nodes):
            continue
        if len(nodes) < len(writer.mesh.node_indices(mass.nodes)):
            raise UnsupportedError(
                f"{load.kind} that acts on some of the nodes of a point mass cannot be written to "
                "a deck: give each mass its own nodes, or load all cells"
            )
        found.append(f"MASS{next(i for i, m in enumerate(masses, start=1) if m is mass)}")
    return found


def edge_area(writer: Writer, where: str | Ints) -> float:
    """Area of edges times thickness [length^2], over which a resultant is distributed."""
    mesh = writer.mesh
    edges = mesh.edge_pairs(where)
    area = 0.0
    for (cell, _), nodes in zip(edges, mesh.edge_nodes(edges), strict=True):
        x = mesh.points[nodes]
        found = thickness_at(mesh, writer.model.sections, np.array([cell]), np.array([nodes]))
        thickness = found[0]
        if len(nodes) == 3:
            r, weights = _GAUSS
            slope = np.stack([r - 0.5, r + 0.5, -2.0 * r], axis=1) @ x
            shape = np.stack([0.5 * r * (r - 1.0), 0.5 * r * (r + 1.0), 1.0 - r * r], axis=1)
            area += float((np.hypot(slope[:, 0], slope[:, 1]) * (shape @ thickness)) @ weights)
        else:
            area += math.dist(x[0], x[1]) * float(thickness.mean())
    return area
