"""Tables of ``*CONTACT PRINT`` in the layout of CalculiX's ``.dat`` file.

Source: CalculiX 2.20, contact of type node to surface and the statistics of pairs. Values belong
to slave nodes here in every type of contact; open nodes have no row.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import Floats, Ints, distinct
from corota.io.tables.dat_numbers import fortran, rows, statistics
from corota.model.contact import ContactPair, RigidCurve, edges_or_nodes, joint_thickness
from corota.model.sections import thickness_at

if TYPE_CHECKING:
    from collections.abc import Iterator

    from corota.model.model import Model
    from corota.model.steps import Output
    from corota.results.results import Frame


#: Variables of contact that are printed.
VARIABLES = ("CDIS", "CSTR", "CELS", "CNUM", "CF", "CFN", "CFS")
#: Resultant of each variable as scalars of a frame: added, subtracted.
_PARTS = {"CF": ("", None), "CFN": ("", "friction "), "CFS": ("friction ", None)}


def contact_tables(model: Model, output: Output, frame: Frame) -> Iterator[str]:
    """Text of one request at a frame."""
    if frame.C is None:
        return
    pairs = [p for p in model.contacts if output.where in ("", p.name)]
    slaves = [_slave_nodes(model, p) for p in pairs]
    nodes = distinct(np.concatenate([np.zeros(0, np.int64), *slaves]))
    nodes = nodes[frame.C[nodes, 4] > 0.0]
    labels = model.mesh.node_labels[nodes]
    pressure, shear, gap, slip, _ = frame.C[nodes].T + 0.0
    now = f"time{fortran(frame.time, 7):>14}\n\n"
    row = "%10d %13.6E %13.6E  0.000000E+00\n"
    for name in (v.upper() for v in output.variables):
        if name == "CDIS":
            yield "\n relative contact displacement (slave node,normal,tang1,tang2) for all "
            yield f"contact elements and {now}"
            yield rows(row, labels, gap, slip)
        elif name == "CSTR":
            yield "\n contact stress (slave node,press,tang1,tang2) for all contact elements and "
            yield now + rows(row, labels, pressure, shear)
        elif name == "CNUM":
            yield f"\n total number of contact elements for time {fortran(frame.time, 7):>14}\n\n"
            yield f" {len(nodes):16d}\n"
        elif name == "CELS":
            yield f"\n total contact spring energy for time {fortran(frame.time, 7):>14}\n\n"
            yield f"       {frame.scalars.get('contact energy', 0.0):13.6E}\n"
        else:
            for pair in pairs:
                yield _statistics(model, pair, frame, name)


def _slave(model: Model, pair: ContactPair) -> Ints:
    """Cells and local edges of the slave surface, shape (n, 2); none of single nodes."""
    return edges_or_nodes(model.mesh, pair.slave)[0]


def _slave_nodes(model: Model, pair: ContactPair) -> Ints:
    edges, nodes = edges_or_nodes(model.mesh, pair.slave)
    return distinct(nodes) if len(nodes) else model.mesh.edge_set_nodes(edges)


def _statistics(model: Model, pair: ContactPair, frame: Frame, name: str) -> str:
    """Resultant on the slave surface, where it is closed and how it is turned there."""
    plus, minus = _PARTS[name]
    force = _resultant(frame, pair, plus)
    if minus is not None:
        force = force - _resultant(frame, pair, minus)
    area, center, normal = _closed_part(model, pair, frame)
    master = pair.master if isinstance(pair.master, str) else getattr(pair.master, "name", "")
    slave = pair.slave if isinstance(pair.slave, str) else pair.name
    return statistics(
        f"slave set {slave.upper()}, master set {str(master).upper()}",
        frame.time,
        " ",
        force,
        (area, center, normal),
        "area,  normal force (+ = tension) and shear force (size)",
    )


def _resultant(frame: Frame, pair: ContactPair, what: str) -> Floats:
    """Force x, y and moment about the origin from the scalars of a frame."""
    names = ("force x", "force y", "moment") if not what else ("x", "y", "moment")
    get = frame.scalars.get
    return np.array([get(f"{pair.name}: {what}{name}", 0.0) for name in names])


def _closed_nodes(
    model: Model, pair: ContactPair, frame: Frame, x: Floats
) -> tuple[float, Floats, Floats]:
    """The same for lines and single nodes, whose normal is that of the force between them."""
    assert frame.C is not None
    nodes = _slave_nodes(model, pair)
    nodes = nodes[frame.C[nodes, 4] > 0.0]
    if not len(nodes):
        return 0.0, np.zeros(2), np.zeros(2)
    force = _resultant(frame, pair, "")[:2] - _resultant(frame, pair, "friction ")[:2]
    area = frame.scalars.get(f"{pair.name}: area", 0.0)
    return area, x[nodes].mean(axis=0), -force / (math.hypot(*force) or 1.0)


def _closed_part(model: Model, pair: ContactPair, frame: Frame) -> tuple[float, Floats, Floats]:
    """Area that is closed, its center and its mean outward normal, in the current state."""
    assert frame.C is not None
    x = model.mesh.points + frame.U
    edges = _slave(model, pair)
    if not len(edges) or model.mesh.are_lines(edges[:, 0]).all():
        return _closed_nodes(model, pair, frame, x)
    ends = np.array([nodes[:2] for nodes in model.mesh.edge_nodes(edges)])
    chord = x[ends[:, 1]] - x[ends[:, 0]]
    own = thickness_at(model.mesh, model.sections, edges[:, 0], ends, x).mean(axis=1)
    master = pair.master
    if not isinstance(master, RigidCurve):
        edges = edges_or_nodes(model.mesh, master)[0]
        if model.mesh.are_lines(edges[:, 0]).all():
            return _closed_nodes(model, pair, frame, x)
        facing = np.array([nodes[:2] for nodes in model.mesh.edge_nodes(edges)])
        other = thickness_at(model.mesh, model.sections, edges[:, 0], facing, x).mean(axis=1)
        own = joint_thickness(model.mesh.points, ends, own, facing, other)
    share = 0.5 * own
    closed = (frame.C[ends, 4] > 0.0) * share[:, None]
    weight = closed * np.hypot(*chord.T)[:, None]
    area = float(weight.sum())
    if area == 0.0:
        return 0.0, np.zeros(2), np.zeros(2)
    center = np.einsum("ij,ijk->k", weight, x[ends]) / area
    normal = np.array([chord[:, 1], -chord[:, 0]]) @ closed.sum(axis=1)
    return area, center, normal / (math.hypot(*normal) or 1.0)
