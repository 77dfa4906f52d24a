"""Equations, couplings, straight lines and local axes of a model as cards of a deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from corota.errors import UnsupportedError
from corota.io.deck.write.text import DOFS, Writer, number, numbers, rows
from corota.model.constraints import Coupling, Equation, StraightLine

#: Every dof of a planar model.
ALL = (0, 1, 2)
#: Terms on a line of ``*EQUATION``, entries on one of ``*MPC``.
TERMS_PER_LINE, NODES_PER_LINE = 4, 12


def constraint_cards(writer: Writer) -> Iterator[str]:
    """Cards of axes and constraints, in the model's order.

    Raises
    ------
    UnsupportedError
        If a constraint has no card.
    """
    label = int(writer.mesh.cell_labels.max(initial=0)) + 1_000_000
    for axes in writer.model.axes:
        nodes = writer.node_set(axes.nodes)
        if axes.center is not None:
            if axes.angle:
                raise UnsupportedError(
                    "local axes about a point that are turned by an angle besides cannot be "
                    "written to a deck: keep the model in Python"
                )
            x, y = axes.center
            points = numbers((x, y, 0.0, x, y, 1.0))
            yield f"*TRANSFORM, NSET={nodes}, TYPE=C\n{points}\n"
            continue
        c, s = math.cos(axes.angle), math.sin(axes.angle)
        yield f"*TRANSFORM, NSET={nodes}, TYPE=R\n{numbers((c, s, 0.0, -s, c, 0.0))}\n"
    for count, item in enumerate(writer.model.constraints, start=1):
        if isinstance(item, Equation):
            yield _equation(writer, item)
        elif isinstance(item, StraightLine):
            yield _straight(writer, item)
        else:
            yield _coupling(writer, item, count, label + count)


def _equation(writer: Writer, item: Equation) -> str:
    if item.rhs:
        raise UnsupportedError(
            f"an equation with the right-hand side {item.rhs:g} cannot be written to a deck: let "
            "it relate a node whose displacement is prescribed, or keep the model in Python"
        )
    labels = writer.mesh.node_labels
    terms = [f"{labels[n]}, {DOFS[d]}, {number(c)}" for n, d, c in item.terms]
    return f"*EQUATION\n{len(terms)}\n" + "".join(rows(terms, TERMS_PER_LINE))


def _straight(writer: Writer, item: StraightLine) -> str:
    nodes = writer.mesh.node_indices(item.nodes)
    ends = [item.first, item.last]
    order = [*ends, *nodes[~np.isin(nodes, ends)].tolist()]
    lines = list(rows(writer.mesh.node_labels[order].tolist(), NODES_PER_LINE))
    return f"*MPC\nSTRAIGHT, {lines[0]}" + "".join(lines[1:])


def _coupling(writer: Writer, item: Coupling, count: int, label: int) -> str:
    mesh = writer.mesh
    reference = mesh.node_labels[item.reference]
    dofs = tuple(sorted(set(item.dofs)))
    if item.kind == "kinematic":
        nodes = writer.node_set(item.nodes)
        if dofs == ALL:
            return f"*RIGID BODY, NSET={nodes}, REF NODE={reference}\n"
        named = "".join(f"{nodes}, {DOFS[d]}, {DOFS[d]}\n" for d in dofs)
        return f"*KINEMATIC COUPLING, REF NODE={reference}\n{named}"
    if dofs == ALL:
        members = mesh.node_indices(item.nodes)
        weights = np.ones(len(members)) if item.weights is None else item.weights
        named = "".join(
            f"{node}, {number(w)}\n"
            for node, w in zip(mesh.node_labels[members].tolist(), weights.tolist(), strict=True)
        )
        return (
            f"*ELEMENT, TYPE=DCOUP2D, ELSET=COUPLING{count}\n{label}, {reference}\n"
            f"*DISTRIBUTING COUPLING, ELSET=COUPLING{count}\n{named}"
        )
    if item.weights is not None:
        raise UnsupportedError(
            "a distributing coupling with weights and only some dofs cannot be written to a deck: "
            "leave the weights out or couple all dofs, or keep the model in Python"
        )
    named = "".join(f"{DOFS[d]}, {DOFS[d]}\n" for d in dofs)
    return (
        f"*SURFACE, NAME=COUPLED{count}, TYPE=NODE\n{writer.node_set(item.nodes)}\n"
        f"*COUPLING, CONSTRAINT NAME=COUPLING{count}, REF NODE={reference}, "
        f"SURFACE=COUPLED{count}\n*DISTRIBUTING\n{named}"
    )
