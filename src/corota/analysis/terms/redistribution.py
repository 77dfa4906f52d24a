"""Redistribution of the mass of contact nodes to other nodes of their elements.

Where an element has no inner nodes at two distances, its mass moves off the skin. The densities
of the elements of a body are then changed a little, so that its mass, its center and its moment of
inertia stay: the change is the least that does, ``1 + a + b . x + c |x|^2`` in the places of the
elements' masses (the conditions of Khenous, Laborde & Renard 2008).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.mesh.parts import part_of_cells

if TYPE_CHECKING:
    from corota.analysis.numbered_model import NumberedModel
    from corota.arrays import Bools, Floats


#: Least factor on a density.
LEAST = 0.1
#: Relative residual of satisfied conditions.
HOLDS = 1e-9
#: Share of a body's size by which its center may move without a remark, and relative change of its
#: moment of inertia.
SMALL = 0.01


def massless_nodes(system: NumberedModel, redistribute: bool) -> Bools | None:
    """Nodes whose mass others carry: the slave nodes of contact.

    A contact force that acts on nodes without mass is bounded and does no work in the limit of
    small increments; on nodes with mass it creates energy and chatters.
    """
    if not redistribute:
        return None
    massless = system.nodes_of_terms("slave")
    return massless if massless.any() else None


def set_moving_mass(system: NumberedModel, kind: str, massless: Bools | None) -> str:
    """Set the massless nodes in the core, and the densities of the others.

    Parameters
    ----------
    kind : {"consistent", "constant", "lumped"}
    massless : ndarray of bool, shape (n_nodes,), or None

    Returns
    -------
    str
        A remark; empty if mass, center and moment of inertia are kept.
    """
    core, none = system.core, np.zeros(0)
    core.set_massless(np.zeros(0, bool))
    for number in range(len(system.own_blocks)):
        core.set_mass_factors(number, none)
    if massless is None:
        return ""
    before = _moments(system, kind)
    core.set_massless(np.ascontiguousarray(massless))
    after = _moments(system, kind)
    own = np.concatenate([b.cells for b in system.own_blocks])
    communicator = system.communicator
    body = communicator.concatenate(part_of_cells(system.model.mesh)[own])
    before, after = communicator.concatenate(before), communicator.concatenate(after)
    process = communicator.concatenate(np.full(len(own), communicator.rank))
    factors = np.ones(len(body))
    errors = np.zeros(2)
    for number in np.unique(body[(before != after).any(axis=1)]):
        heavy = (body == number) & (after[:, 0] > 0.0)
        factors[heavy], left = _kept(before[heavy], after[heavy])
        errors = np.maximum(errors, left)
    factors = factors[process == communicator.rank]
    first = 0
    for number, block in enumerate(system.own_blocks):
        core.set_mass_factors(number, factors[first : first + len(block.cells)])
        first += len(block.cells)
    what = [
        f"moves the center of mass of a body by {errors[0]:.1%} of its radius of gyration",
        f"changes the moment of inertia of a body by {errors[1]:.1%}",
    ]
    said = [text for text, error in zip(what, errors, strict=True) if error > SMALL]
    if not said:
        return _all_skin(system, massless)
    return (
        f"contact: the mass of contact nodes {' and '.join(said)}; take three elements or more "
        "through its thickness, elements with mid-side nodes, or redistribute=False"
    )


def _all_skin(system: NumberedModel, massless: Bools) -> str:
    """A remark where elements consist of contact nodes alone: no other node can take their mass."""
    mesh = system.model.mesh
    count = sum(int(massless[cells.nodes].all(axis=1).sum()) for cells in mesh.cells)
    if not count:
        return ""
    return (
        f"contact: all nodes of {count} element{'s' * (count > 1)} are slave nodes, and no other "
        "can take their mass: where they meet the other side the force grows as increments shrink, "
        "while its impulse is right; name only what meets the other side as the slave"
    )


def _moments(system: NumberedModel, kind: str) -> Floats:
    """Mass, its moments x and y and polar moment of inertia of each element, shape (n, 4).

    About the middle of the nodes, lengths over the size of the model.
    """
    points = system.model.mesh.points
    arm = (points - points.mean(axis=0)) / system.length
    one, zero = np.ones(len(points)), np.zeros(len(points))
    spin = np.stack([-arm[:, 1], arm[:, 0], one / system.length], axis=1)
    x, y = np.stack([one, zero, zero], axis=1), np.stack([zero, one, zero], axis=1)
    rest = np.zeros(system.n_dofs)

    def twice(rates: Floats) -> Floats:
        v = system.in_space(system.from_nodes(rates))
        blocks = range(len(system.own_blocks))
        each = [system.core.kinetic(number, rest, v, kind, False) for number in blocks]
        return 2.0 * np.concatenate(each)

    mass, polar = twice(x), twice(spin)
    along = 0.5 * (twice(y + spin) - mass - polar)
    across = 0.5 * (mass + polar - twice(x + spin))
    return np.stack([mass, along, across, polar], axis=1)


def _kept(before: Floats, after: Floats) -> tuple[Floats, tuple[float, float]]:
    """Factors of the elements of a body, and what they leave of its errors.

    These are the way of its center over its radius of gyration, and the relative change of its
    moment of inertia.
    """
    total = before.sum(axis=0)
    center = total[1:3] / total[0]
    size = np.sqrt(max(total[3] / total[0] - center @ center, 0.0)) or 1.0

    def centered(m: Floats) -> Floats:
        dx, dy = center
        polar = m[:, 3] - 2.0 * (dx * m[:, 1] + dy * m[:, 2]) + m[:, 0] * (dx * dx + dy * dy)
        x, y = m[:, 1] - dx * m[:, 0], m[:, 2] - dy * m[:, 0]
        return np.stack([m[:, 0], x / size, y / size, polar / size**2], axis=1)

    want, have = centered(before).sum(axis=0), centered(after)
    missing = (want - have.sum(axis=0)) / total[0]
    shape = have / have[:, :1]
    for count in (4, 3):
        gram = have[:, :count].T @ shape[:, :count] / total[0]
        share = np.linalg.lstsq(gram, missing[:count], rcond=1e-12)[0]
        if np.abs(gram @ share - missing[:count]).max() > HOLDS:
            continue
        factors = 1.0 + shape[:, :count] @ share
        if factors.min() >= LEAST:
            break
    else:
        factors = np.ones(len(after))
    left = (want - factors @ have) / total[0]
    return factors, (float(np.hypot(*left[1:3])), float(abs(left[3])))
