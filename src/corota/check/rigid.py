"""Free rigid-body modes and hinges, with the node to fix."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.free_motion import plain
from corota.arrays import Bools, Floats, Ints, distinct
from corota.errors import Diagnostic
from corota.mesh.parts import cells_of, nodes_of_cells, part_of_cells, stiff_part_of_cells
from corota.model.released import without_releases
from corota.model.rotations import rotating_nodes

if TYPE_CHECKING:
    from corota.mesh.data import Mesh
    from corota.model.loads import Fixed
    from corota.model.model import Model
    from corota.model.steps import Step

#: Share of the largest eigenvalue of the constraints below which a mode is free.
FREE = 1e-13
#: Largest number of bodies joined by common nodes that are checked together.
MAX_BODIES = 400


def check_rigid(model: Model, first: int = 0) -> list[Diagnostic]:
    """Findings over all static steps (over the model's supports, if it has no step).

    It uses supports and common nodes only, and names the motions of plain models. Steps before
    `first`, from 0, are ignored.
    """
    mesh = model.mesh
    rotating = rotating_nodes(model)
    found: list[Diagnostic] = []
    for number, held in enumerate(_held(model, rotating)):
        step = model.steps[number] if model.steps else None
        if number < first or (step is not None and step.procedure != "static"):
            continue
        found = _free_modes(mesh, held, rotating, step)
        if found:
            later = f"step {number + 1}: " if number else ""
            return [replace(d, message=later + d.message) for d in found]
    return found


def _held(model: Model, rotating: Bools) -> list[Floats]:
    """Dofs fixed in each step, each of shape (n_nodes, 3)."""
    base = np.zeros((model.mesh.n_nodes, 3), bool)
    _hold(model, base, model.supports)
    now, found = base.copy(), []
    same, steps = without_releases(model, model.steps)
    for step in steps:
        if step.new_supports:
            now[:] = False
            _hold(model, now, same.supports)
        _hold(model, now, step.supports)
        found.append(now.copy())
    found = found or [base]
    mesh = model.mesh
    rings = [cells_of(mesh, s.cells) for s in model.sections if s.axisymmetric]
    for held in found:
        held[:, 2] &= rotating
        for cells in rings:
            # The hoop resists radial motion and turns in the plane.
            held[nodes_of_cells(mesh, cells), 0] = True
    return found


def _hold(model: Model, held: Floats, supports: list[Fixed]) -> None:
    for support in supports:
        nodes = support.nodes
        held[model.mesh.node_indices(nodes), support.dof] = True


def _free_modes(mesh: Mesh, held: Floats, rotating: Bools, step: Step | None) -> list[Diagnostic]:
    body = stiff_part_of_cells(mesh)
    part = part_of_cells(mesh)
    node, owner = _body_nodes(mesh, body)
    part_of_body = np.zeros(body.max(initial=-1) + 1, np.int64)
    part_of_body[body] = part
    found: list[Diagnostic] = []
    for number in distinct(part):
        bodies = np.flatnonzero(part_of_body == number)
        mine = np.isin(owner, bodies)
        if len(bodies) > MAX_BODIES:
            bodies = bodies[:1]
            owner_here = np.full(int(mine.sum()), bodies[0])
            found += _of_part(mesh, held, rotating, bodies, node[mine], owner_here)
        else:
            found += _of_part(mesh, held, rotating, bodies, node[mine], owner[mine])
        if len(found) >= 20:
            break
    where = step.where if step is not None else None
    return [Diagnostic("error", d.message, where, hint=d.hint) for d in found]


def _body_nodes(mesh: Mesh, body: Ints) -> tuple[Ints, Ints]:
    """Pairs of node and body, each once."""
    pairs = [np.zeros((0, 2), np.int64)]
    for offset, block in zip(mesh.offsets, mesh.cells, strict=False):
        mine = body[offset : offset + len(block)]
        width = block.nodes.shape[1]
        pairs.append(np.stack([block.nodes.ravel(), np.repeat(mine, width)], axis=1))
    table = np.unique(np.concatenate(pairs), axis=0)
    return table[:, 0], table[:, 1]


def _of_part(
    mesh: Mesh, held: Floats, rotating: Bools, bodies: Ints, node: Ints, owner: Ints
) -> list[Diagnostic]:
    points = mesh.points[node]
    center = (points.min(axis=0) + points.max(axis=0)) / 2
    size = float(np.ptp(points, axis=0).max()) or 1.0
    local = np.searchsorted(bodies, owner)
    x, y = ((points - center) / size).T
    one, zero = np.ones_like(x), np.zeros_like(x)
    # Displacement x, y and rotation (times the size) of each node by the motion of its body.
    motion = np.stack(
        [np.stack([one, zero, -y], 1), np.stack([zero, one, x], 1), np.stack([zero, zero, one], 1)],
        axis=1,
    )
    matrix = np.zeros((3 * len(bodies), 3 * len(bodies)))
    for dof in range(3):
        for row in np.flatnonzero(held[node, dof]):
            _add(matrix, [(local[row], motion[row, dof])])
    order = np.argsort(node, kind="stable")
    shared = np.flatnonzero(np.diff(node[order]) == 0)
    for at in shared:
        a, b = order[at], order[at + 1]
        for dof in range(3 if rotating[node[a]] else 2):
            _add(matrix, [(local[a], motion[a, dof]), (local[b], -motion[b, dof])])
    values, vectors = np.linalg.eigh(matrix)
    free = values <= FREE * max(float(values[-1]), 1.0)
    return _describe(mesh, node, local, points, vectors[:, free], center, size, len(bodies))


def _add(matrix: Floats, terms: list[tuple[int, Floats]]) -> None:
    for i, a in terms:
        for j, b in terms:
            matrix[3 * i : 3 * i + 3, 3 * j : 3 * j + 3] += np.outer(a, b)


def _describe(
    mesh: Mesh,
    node: Ints,
    local: Ints,
    points: Floats,
    modes: Floats,
    center: Floats,
    size: float,
    n_bodies: int,
) -> list[Diagnostic]:
    found = []
    for mode in plain(modes):
        motion = mode.reshape(-1, 3)[local]
        offset = (points - center) / size
        u = motion[:, :2] + motion[:, 2:] * np.stack([-offset[:, 1], offset[:, 0]], axis=1)
        moving = np.abs(u).max(axis=1) > 1e-8
        if np.abs(motion[:, 2]).max() <= 1e-8:
            main = u[np.abs(u).max(axis=1).argmax()]
            text = "move along " + (
                "x" if abs(main[1]) < 1e-8 else "y" if abs(main[0]) < 1e-8 else "a slanted line"
            )
        else:
            turn = motion[np.abs(motion[:, 2]).argmax()]
            pivot = center + size * np.array([-turn[1], turn[0]]) / turn[2]
            pivot = np.where(np.abs(pivot) < 1e-9 * size, 0.0, pivot)
            text = f"turn about ({pivot[0]:.6g}, {pivot[1]:.6g})"
        row = int(np.abs(u).max(axis=1).argmax())
        dof = int(np.abs(u[row]).argmax())
        label = mesh.node_labels[node[row]]
        hint = f"hold node {label} in {'xy'[dof]} (dof {dof + 1})"
        if n_bodies > 1 and not moving.all():
            text = f"a hinge or a free body: the cells at node {label} can {text}"
        else:
            text = f"a free body: it can {text}"
            if int(mesh.node_labels[node].min()) != int(mesh.node_labels.min()):
                text += f" (the part of node {label})"
        found.append(Diagnostic("error", text, hint=hint))
    return found
