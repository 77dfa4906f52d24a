"""Free motions in words: which part moves, and how."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import Floats, Ints, distinct
from corota.errors import SingularError
from corota.model import elements

if TYPE_CHECKING:
    from corota.analysis.numbered_model import NumberedModel
    from corota.mesh.data import Mesh


#: Fraction of the largest motion below which a part is at rest, or a motion is rigid.
SMALL = 1e-5
#: Ratio of nodal stiffnesses above which a soft support cannot be distinguished from none.
RATIO = 1e9
#: Largest number of bodies that are examined.
MOST = 400
#: Most motions that a message lists.
LISTED = 3


def name_motion(system: NumberedModel, error: SingularError, ratio: float) -> SingularError:
    """An error of the linear solver in terms of nodes and parts.

    Parameters
    ----------
    error : SingularError
        Its equation and mode are those of the unknowns.
    ratio : float
        Of the largest stiffness of a node and the smallest.
    """
    equation, modes = error.equation, error.modes
    if modes is None and error.mode is not None:
        modes = np.asarray(error.mode).reshape(1, -1)
    if 0 <= equation < len(system.constraints.free):
        equation = int(system.constraints.free[equation])
        if modes is not None:
            modes = system.link.expand(np.asarray(modes).T).T
    mode = None if modes is None else modes[0]
    if not 0 <= equation < system.n_dofs:
        return SingularError(str(error), equation, mode, modes)
    moves = "" if modes is None else describe(system, modes)
    text = (
        f"the structure can move freely: {moves + '; ' if moves else ''}"
        f"{system.describe(equation)} is unconstrained; add a support, or remove the "
        "mechanism that contains it"
    )
    if modes is not None and _slack(system, modes):
        text += (
            ". Bars and springs without tension have no stiffness across: give trusses an initial "
            "stress (springs: trusses with E A / l of their stiffness), however small, or let the "
            "chain come to rest in a dynamic step with damping"
        )
    if ratio > RATIO:
        text += (
            f". The stiffnesses of nodes differ by a factor of {ratio:.0e}: if it is supported "
            "by something soft, rounding hides that in double precision; check moduli and "
            "units, or make the stiff part a rigid body"
        )
    return SingularError(text, equation, mode, modes)


def describe(system: NumberedModel, modes: Floats) -> str:
    """Description of motions by part; empty if parts deform.

    Parameters
    ----------
    modes : ndarray, shape (n_modes, n_dofs)
    """
    from corota.mesh.parts import stiff_part_of_cells

    mesh = system.model.mesh
    moved = np.array([system.by_node(np.ascontiguousarray(m))[:, :2] for m in modes])
    body = stiff_part_of_cells(mesh)
    n_bodies = int(body.max(initial=-1)) + 1
    tops = np.abs(moved).max(axis=(1, 2), initial=0.0)
    if not tops.all() or n_bodies > MOST:
        return ""
    moved /= tops[:, None, None]
    center = mesh.points.mean(axis=0)
    rows = np.zeros((len(modes), 3 * n_bodies))
    nodes = [_nodes(mesh, np.flatnonzero(body == number)) for number in range(n_bodies)]
    for number, own in enumerate(nodes):
        x = (mesh.points[own] - center) / system.length
        for row, u in zip(rows, moved[:, own], strict=True):
            motion = _rigid(x, u)
            if motion is None:
                return ""
            row[3 * number : 3 * number + 3] = motion
    found: dict[str, list[str]] = {}
    for row in plain(rows.T, SMALL):
        for number in range(n_bodies):
            said = _words(row[3 * number : 3 * number + 3], center, system.length)
            if said:
                label = str(mesh.cell_labels[np.flatnonzero(body == number)[0]])
                found.setdefault(label, []).append(said)
    same: dict[str, list[str]] = {}
    for label, motions in found.items():
        same.setdefault(_and(motions), []).append(label)
    listed = [
        f"the part{'s' if len(labels) > 1 else ''} with element "
        f"{', '.join(labels[:3])}{', ...' if len(labels) > 3 else ''} can {how}"
        for how, labels in same.items()
    ]
    more = [f"{len(listed) - LISTED} more move"] if len(listed) > LISTED + 1 else []
    return "; ".join(listed[:LISTED] + more if more else listed)


def _slack(system: NumberedModel, modes: Floats) -> bool:
    """Whether all that moves are joints between two bars or springs, as in a chain."""
    size = np.max([np.abs(system.by_node(mode)) for mode in modes], axis=0)
    moving = (size > SMALL * size.max()).any(axis=1)
    bars, others = np.zeros(len(moving), np.int64), np.zeros(len(moving), bool)
    for block in system.blocks:
        element = elements.find(block.section.element)
        if (element.line or element.spring) and element.dofs_per_node == 2:
            np.add.at(bars, block.nodes.ravel(), 1)
        else:
            others[block.nodes] = True
    return bool((bars[moving] == 2).all() and not others[moving].any())


def _and(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def _nodes(mesh: Mesh, cells: Ints) -> Ints:
    nodes = [np.zeros(0, np.int64)]
    for offset, block in zip(mesh.offsets, mesh.cells, strict=False):
        inside = cells[(cells >= offset) & (cells < offset + len(block))] - offset
        nodes.append(block.nodes[inside].ravel())
    return distinct(np.concatenate(nodes))


def _rigid(x: Floats, u: Floats) -> tuple[float, float, float] | None:
    """Motion (x, y, turn) of the origin of points `x` that move rigidly by `u`, else None."""
    arm = x - x.mean(axis=0)
    skew = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    move = u.mean(axis=0)
    square = float((skew**2).sum())
    turn = float((skew * (u - move)).sum()) / square if square > 0.0 else 0.0
    if np.abs(u - move - turn * skew).max() > SMALL:
        return None
    middle = x.mean(axis=0)
    return move[0] + turn * middle[1], move[1] - turn * middle[0], turn


def _words(motion: Floats, center: Floats, length: float) -> str:
    """A rigid motion (x, y, turn) about a center in words, empty where there is none."""
    x, y, turn = motion
    if np.abs(motion).max() <= SMALL:
        return ""
    if abs(turn) <= SMALL:
        if abs(y) <= SMALL:
            return "move in x"
        return "move in y" if abs(x) <= SMALL else f"move along ({x:.3g}, {y:.3g})"
    pivot = center + length * np.array([-y, x]) / turn
    pivot = np.where(np.abs(pivot) < 1e-6 * length, 0.0, pivot)
    return f"turn about ({pivot[0]:.5g}, {pivot[1]:.5g})"


def plain(modes: Floats, nothing: float = 1e-7) -> Floats:
    """Basis of the free modes with as many zeros as possible, one mode per row.

    Parameters
    ----------
    modes : ndarray, shape (3 n_bodies, n_modes)
        Motion in x, y and turn of each body.
    nothing : float
        Entries that count as zero.
    """
    rows = np.array(modes.T)
    lead = 0
    for column in [c for d in range(3) for c in range(d, rows.shape[1], 3)]:
        if lead == len(rows):
            break
        pivot = lead + int(np.abs(rows[lead:, column]).argmax())
        if abs(rows[pivot, column]) < nothing:
            continue
        rows[[lead, pivot]] = rows[[pivot, lead]]
        rows[lead] /= rows[lead, column]
        for other in range(len(rows)):
            if other != lead:
                rows[other] -= rows[other, column] * rows[lead]
        lead += 1
    rows[np.abs(rows) < 1e-2 * nothing] = 0.0
    return rows
