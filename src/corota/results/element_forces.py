"""Nodal forces of single elements at a given state, for free-body cuts."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import corota._core as _core
from corota.model import elements
from corota.model.blocks import BlockOfCells, blocks_of, core_input
from corota.model.user_material import UserMaterial

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.model.model import Model
    from corota.results.frame import Frame, PointFields

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: Share of the largest stress by which a recomputed stress may differ from the recorded one.
SAME = 1e-8


def element_forces(
    model: Model, cells: Ints, frame: Frame, nlgeom: bool
) -> tuple[list[tuple[Ints, Ints, Floats]], bool] | None:
    """Forces that nodes exert on elements.

    They follow from the displacements. Where the stress of the frame is another one than that
    (flow, heat, initial stress, materials in Python), they are those of the stress of the frame,
    if the local strain is linear; the drilling stiffness of elements is then an elastic one.

    Parameters
    ----------
    model : Model
    cells : ndarray of int
        Global cell indices.
    frame : Frame
        With values at points.
    nlgeom : bool
        Whether the frame belongs to a step with large displacements.

    Returns
    -------
    found : list of (ndarray, ndarray, ndarray)
        Cells (n,), their nodes (n, k), force and moment (n, k, 3).
    exact : bool
        None for both if the core cannot compute them.
    """
    found, exact = [], True
    for block in blocks_of(model):
        mine = np.isin(block.cells, cells)
        if not mine.any():
            continue
        chosen = BlockOfCells(block.section, block.cells[mine], block.nodes[mine])
        recorded = _recorded(frame, chosen.cells)
        if recorded is None:
            return None
        force = _of_displacements(model, chosen, frame, nlgeom, recorded)
        if force is None:
            force = _of_stress(model, chosen, frame, nlgeom, recorded)
            exact = exact and not elements.find(block.section.element).drilling
        if force is None:
            return None
        found.append((chosen.cells, chosen.nodes, force))
    return found, exact


def _recorded(frame: Frame, cells: Ints) -> tuple[PointFields, Ints] | None:
    """The fields that hold these cells, and their rows."""
    for fields in frame.fields:
        rows = np.flatnonzero(np.isin(fields.cells, cells))
        if len(rows) == len(cells):
            return fields, rows
    return None


def _of_displacements(
    model: Model,
    block: BlockOfCells,
    frame: Frame,
    nlgeom: bool,
    recorded: tuple[PointFields, Ints],
) -> Floats | None:
    """Forces of a block without history; None where the frame has another stress."""
    if isinstance(block.section.material, UserMaterial):
        return None
    fields, rows = recorded
    problem, u = _alone(model, block, core_input(block), frame)
    values = problem.recover(u, nlgeom)[0]["values"]
    names = [name for name in ("S", "N", "M1") if name in values]
    if not all(_same(values[name], fields.values[name][rows]) for name in names):
        return None
    return _force(problem, u, nlgeom, block.nodes.shape)


def _of_stress(
    model: Model,
    block: BlockOfCells,
    frame: Frame,
    nlgeom: bool,
    recorded: tuple[PointFields, Ints],
) -> Floats | None:
    """Forces of a block by the stress of the frame; None if the local strain is not linear."""
    section, (fields, rows) = block.section, recorded
    if (nlgeom and section.local_strain != "linear") or elements.find(section.element).line:
        return None
    stress, turn = fields.values["S"][rows], fields.frame_rotation[rows]
    modulus = float(getattr(section.material, "E", 0.0)) or float(np.abs(stress).max()) or 1.0
    tangent = modulus * np.array([[1.1, 0.3, 0.0], [0.3, 1.1, 0.0], [0.0, 0.0, 0.4]])
    given = core_input(block) | {"law": "given", "parameters": tangent.ravel().tolist()}
    given["by_temperature"] = []
    problem, u = _alone(model, block, given, frame)
    c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
    xx, yy, xy = stress[..., 0], stress[..., 1], stress[..., 3]
    local = np.stack(
        [
            c * c * xx + s * s * yy + 2 * c * s * xy,
            s * s * xx + c * c * yy - 2 * c * s * xy,
            c * s * (yy - xx) + (c * c - s * s) * xy,
        ],
        axis=-1,
    )
    values = np.zeros((*local.shape[:2], 16))
    # The internal modes are in equilibrium at the given strains, and so is the stress.
    values[..., :3] = problem.strains(0, u, nlgeom, True).reshape(local.shape)
    values[..., 3:6] = local
    rows, columns = np.triu_indices(3)
    values[..., 6:12] = tangent[rows, columns]
    problem.give(0, values.ravel())
    return _force(problem, u, nlgeom, block.nodes.shape)


def _alone(
    model: Model, block: BlockOfCells, given: dict[str, Any], frame: Frame
) -> tuple[Any, Floats]:
    """A core problem of elements without common nodes, and their displacements."""
    flat = block.nodes.ravel()
    own = np.arange(len(flat), dtype=np.uint32)
    points = np.ascontiguousarray(model.mesh.points[flat])
    problem = _core.Problem(points, [given | {"nodes": own}], np.zeros(len(flat), np.uint8))
    node = problem.node_of_dof.astype(np.int64)
    component = np.arange(problem.n_dofs) - problem.dof_start.astype(np.int64)[node]
    whole = np.column_stack([frame.U, frame.UR])[flat]
    return problem, np.ascontiguousarray(whole[node, component])


def _force(problem: Any, u: Floats, nlgeom: bool, shape: tuple[int, ...]) -> Floats:
    force, scale = np.empty(problem.n_dofs), np.empty(problem.n_dofs)
    problem.assemble(u, nlgeom, force, scale, np.empty(0))
    out: Floats = problem.by_node(force).reshape(*shape, 3)
    return out


def _same(one: Floats, other: Floats) -> bool:
    size = float(np.abs(other).max(initial=0.0))
    return bool(np.abs(one - other).max(initial=0.0) <= SAME * size)


__all__ = ["element_forces"]
