"""Print requests in the layout of CalculiX's ``.dat`` file.

Source: CalculiX 2.20, ``printout.f`` and the files it writes (compared byte by byte in the tests).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import Floats, Ints, Lookup, distinct
from corota.errors import InputError
from corota.io.tables.dat_contact import VARIABLES as CONTACT_VARIABLES
from corota.io.tables.dat_contact import contact_tables
from corota.io.tables.dat_numbers import fortran, rows
from corota.io.tables.dat_section import VARIABLES as SECTION_VARIABLES
from corota.io.tables.dat_section import section_tables
from corota.model.constraints import local_axes
from corota.results.table import INVARIANTS, TABLE, requests, variables
from corota.results.variables import invariant

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from corota.model.model import Model
    from corota.model.steps import Output, Step
    from corota.results.results import Frame, PointFields


def node_titles() -> dict[str, tuple[str, str]]:
    """Tables at nodes: variable to (title, title of the sum or "")."""
    return {n: (r.title, r.total) for n, r in variables().items() if r.frame and r.title}


def point_titles() -> dict[str, str]:
    """Tables of values at points: variable to title with its own spacing."""
    return {n: r.title for n, r in requests().items() if not r.frame and r.title}


#: Tables of one number an element: variable to (title, title of the sum).
ELEMENT_TITLES = {
    "ELSE": ("internal energy (element, energy)", "total internal energy"),
    "ELKE": ("kinetic energy (elem, energy)", "total kinetic energy"),
    "EVOL": ("volume (element, volume)", "total volume"),
}

_VECTOR = "%10d %13.6E %13.6E %13.6E"
#: Energies per volume that are summed.
DENSITY = {"ELSE": "ENER", "ELKE": "EKEDEN"}


def check_requests(steps: list[Step]) -> None:
    """Refuse print requests for variables that are not printed.

    Raises
    ------
    InputError
        Names the variable, the card and the valid ones.
    """
    for step in steps:
        for output in step.outputs:
            if not output.kind.endswith("print"):
                continue
            valid = {
                "node print": [*node_titles()],
                "el print": [*point_titles(), *ELEMENT_TITLES],
                "contact print": [*CONTACT_VARIABLES],
                "section print": [*SECTION_VARIABLES],
            }[output.kind]
            for name in output.variables:
                if name.upper() not in valid:
                    known = ", ".join(valid)
                    raise InputError(
                        f"*{output.kind.upper()}: no variable {name}; there are: {known}",
                        output.source,
                    )


def dat_blocks(model: Model, outputs: Sequence[Output], frame: Frame) -> str:
    """Text that a frame adds to the ``.dat`` file in answer to print requests.

    Parameters
    ----------
    outputs : sequence of Output
        Others than print requests are ignored.
    """
    tables = {
        "node print": _node_tables,
        "el print": _element_tables,
        "contact print": contact_tables,
        "section print": section_tables,
    }
    requested = (o for o in outputs if o.kind in tables)
    return "".join(text for o in requested for text in tables[o.kind](model, o, frame))


def _head(title: str, output: Output, frame: Frame) -> str:
    name = output.where.upper() or "ALL"
    return f"\n {title}for set {name} and time {fortran(frame.time, 7):>14}\n\n"


def _node_tables(model: Model, output: Output, frame: Frame) -> Iterator[str]:
    mesh = model.mesh
    nodes = mesh.nodes_of(output.where) if output.where else np.arange(mesh.n_nodes)
    labels = mesh.node_labels[nodes]
    axes = {} if output.in_global or not model.axes else local_axes(model.mesh, model.axes)
    for name in (v.upper() for v in output.variables):
        title, total = node_titles()[name]
        values = _node_values(model, frame, name)[nodes] + 0.0  # no negative zeros
        only = output.totals == "only" and total
        parts = [values]
        if name == "U" and frame.H is not None:  # CalculiX prints the imaginary part as well
            parts.append(np.zeros_like(values))
            parts[1][:, :2] = frame.H[nodes, :2] * np.sin(frame.H[nodes, 2:4])
        for part in [] if only else parts:
            yield _head(title + " ", output, frame)
            if name == "NT":
                yield rows("%10d %13.6E\n", labels, part[:, 0])
            elif axes and name != "UR":
                yield _turned_rows(nodes, labels, part, axes)
            else:
                yield rows(_VECTOR + "\n", labels, *part.T)
        if total and output.totals != "no":  # in global axes
            fx, fy = (math.fsum(values[:, i].tolist()) for i in range(2))
            yield _head(total + " ", output, frame)
            yield f"       {fx:13.6E} {fy:13.6E}  0.000000E+00\n"


def _turned_rows(nodes: Ints, labels: Ints, values: Floats, axes: dict[int, Floats]) -> str:
    """Rows of nodes in global axes, and marked ``L`` those along the nodes' own."""
    out = []
    for node, label, value in zip(nodes.tolist(), labels.tolist(), values, strict=True):
        own = axes.get(node)
        if own is None:
            out.append(_VECTOR % (label, *value) + "\n")
        else:
            out.append(_VECTOR % (label, *(value[:2] @ own + 0.0), value[2]) + " L\n")
    return "".join(out)


def _node_values(model: Model, frame: Frame, name: str) -> Floats:
    """Rows of three numbers, shape (n_nodes, 3); RF is the internal force, as in CalculiX.

    At nodes of no element, such as reference nodes, RF is the reaction and the load: the
    internal force is none there.
    """
    zero = np.zeros(len(frame.U))
    if name == "NT":
        return np.column_stack([zero if frame.T is None else frame.T, zero, zero])
    if name == "UR":
        return np.column_stack([zero, zero, frame.UR])
    if name == "U":
        values = frame.U
    elif name == "V":
        values = np.zeros_like(frame.U) if frame.V is None else frame.V[:, :2]
    else:
        values = internal_force(model, frame)
    return np.column_stack([values, zero])


def internal_force(model: Model, frame: Frame) -> Floats:
    """CalculiX's ``RF``: reaction, load, force of constraints and inertia; shape (n_nodes, 2)."""
    values: Floats = (frame.RF + frame.F)[:, :2]
    if frame.constraint_force is not None:
        inside = distinct(np.concatenate([b.nodes.ravel() for b in model.mesh.cells]))
        values[inside] += frame.constraint_force[inside, :2]
    return values


def _element_tables(model: Model, output: Output, frame: Frame) -> Iterator[str]:
    mesh = model.mesh
    cells = mesh.cell_sets.get(output.where)
    titles = point_titles()
    for name in (v.upper() for v in output.variables):
        if name in titles:
            title = titles[name]
            owner, point, values = _at_points(model, frame, cells, name)
            yield _head(title, output, frame)
            if not len(owner):
                continue
            columns = [mesh.cell_labels[owner], point]
            if values.ndim == 1:
                yield rows("%10d %3d %13.6E\n", *columns, values)
                continue
            values = values * [1.0, 1.0, 1.0, TABLE[name].shear]  # CalculiX prints components
            form = "%10d %3d" + 4 * " %13.6E" + 2 * "  0.000000E+00" + "\n"
            yield rows(form, *columns, *values.T)
            continue
        title, total = ELEMENT_TITLES[name]
        owner, sums = _per_element(frame, cells, name)
        if output.totals != "only":
            yield _head(title + " ", output, frame)
            if len(owner):
                yield rows("%10d %13.6E\n", mesh.cell_labels[owner], sums)
        if output.totals != "no":
            yield _head(total + " ", output, frame)
            yield f"       {math.fsum(sums.tolist()):13.6E}\n"


def _picked(
    frame: Frame, cells: Ints | None, take: Callable[[PointFields], Floats | None]
) -> tuple[Ints, list[Ints], list[Floats]]:
    """Rows of the blocks that belong to a set, and the place of each cell in the set's order."""
    places, owners, values = [], [], []
    for block in frame.fields:
        data = take(block)
        if data is None:
            continue
        place = block.cells if cells is None else Lookup(cells)(block.cells)
        pick = place >= 0
        if not pick.any():
            continue
        places.append(place[pick])
        owners.append(block.cells[pick])
        values.append(data[pick])
    place = np.concatenate(places) if places else np.zeros(0, np.int64)
    return place, owners, values


#: Values of the fibers of plastic beams.
FIBER_VALUES = ("S", "E", "PEEQ")


def _at_fibers(model: Model, block: PointFields, name: str) -> Floats | None:
    """Values of beams at the outer fibers, shape (n, 4, ...); none if these are not known.

    At the first end on the right of the way to the second and on the left, then at the second.
    Elastic beams give the stress alone.
    """
    if name not in FIBER_VALUES or "SR1" not in block.values or not len(block.cells):
        return None
    if name == "S":
        stress = np.hstack([block.values[s] for s in ("SR1", "SL1", "SR2", "SL2")])
    elif block.fibers is not None:
        stress = block.fibers[:, [0, 0, -1, -1], [0, -1, 0, -1], FIBER_VALUES.index(name)]
        if name == "PEEQ":
            return stress
    else:
        return None
    number, _ = model.mesh.locate(int(block.cells[0]))
    rows = block.cells - model.mesh.offsets[number]
    place = model.mesh.points[model.mesh.cells[number].nodes[rows]]
    along = place[:, 1] - place[:, 0]
    angle = np.arctan2(along[:, 1], along[:, 0]) + block.frame_rotation
    c, s = np.cos(angle), np.sin(angle)
    # Of strain the shear is that of engineering.
    shear = 2.0 if name == "E" else 1.0
    direction = np.stack([c * c, s * s, np.zeros_like(c), shear * c * s], axis=1)
    return np.asarray(stress[:, :, None] * direction[:, None, :])


def _at_points(
    model: Model, frame: Frame, cells: Ints | None, name: str
) -> tuple[Ints, Ints, Floats]:
    """Cell, point number (from 1) and value of every point of a set, in the set's order."""

    def take(block: PointFields) -> Floats | None:
        stored = INVARIANTS[name][0] if name in INVARIANTS else name
        values = _at_fibers(model, block, stored)
        if block.element.startswith("SPRING"):
            if stored != "S":
                return None  # a force has no strain, and CalculiX prints no rows of springs
            values = block.values["N"][:, :, None] * [1.0, 0.0, 0.0, 0.0]
        values = block.values.get(stored) if values is None else values
        if values is None:  # what a material does not have, such as plastic strain
            return np.zeros_like(block.volume)
        return invariant(name, values) if name in INVARIANTS else values

    place, owners, values = _picked(frame, cells, take)
    if not owners:
        return np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0)
    rank, owner, point, flat, start = [], [], [], [], 0
    for own, data in zip(owners, values, strict=True):
        n, p = data.shape[:2]
        rank.append(np.repeat(place[start : start + n], p))
        owner.append(np.repeat(own, p))
        point.append(np.tile(np.arange(1, p + 1), n))
        flat.append(data.reshape(n * p, *data.shape[2:]))
        start += n
    order = np.argsort(np.concatenate(rank), kind="stable")
    joined = [np.concatenate(x)[order] for x in (owner, point)]
    return joined[0], joined[1], np.concatenate(flat)[order]


def _per_element(frame: Frame, cells: Ints | None, name: str) -> tuple[Ints, Floats]:
    """Cell and its volume or energy, in the set's order."""

    def take(block: PointFields) -> Floats | None:
        if name == "EVOL":
            return np.asarray(block.volume.sum(axis=1))
        # At rest there is no kinetic energy.
        density = block.values.get(DENSITY[name], np.zeros_like(block.volume))
        return np.asarray((density * block.volume).sum(axis=1))

    place, owners, values = _picked(frame, cells, take)
    if not owners:
        return np.zeros(0, np.int64), np.zeros(0)
    order = np.argsort(place, kind="stable")
    return np.concatenate(owners)[order], np.concatenate(values)[order]
