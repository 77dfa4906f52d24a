"""The cells of a model grouped into blocks of the core, with checks."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.arrays import Floats, Ints, distinct
from corota.errors import ModelError
from corota.mesh.kinds import EDGES
from corota.model import elements
from corota.model.element_changes import groups_of_cells
from corota.model.material_table import MaterialTable
from corota.model.straight_edges import straight

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from corota.model.model import Model
    from corota.model.sections import Section
    from corota.model.steps import Step


#: Elements that are checked at once: what is computed of them stays in the cache.
_AT_ONCE = 1 << 13


@dataclass
class BlockOfCells:
    """Cells of one section and one kind: a block of the core."""

    section: Section
    cells: Ints  # global cell indices
    nodes: Ints  # (n, k)
    #: Share of the normal traction of each edge that gives end moments, (n, k); None where it is
    #: `alpha_b` of the element everywhere.
    sides: Floats | None = None

    def part(self, rows: NDArray[Any]) -> BlockOfCells:
        """The block of some of its cells, chosen by indices or by a mask."""
        sides = None if self.sides is None else self.sides[rows]
        return BlockOfCells(self.section, self.cells[rows], self.nodes[rows], sides)

    def shares(self, rows: Ints | int, edge: int) -> Floats | float:
        """Share of the normal traction of an edge of some cells that gives end moments."""
        if self.sides is None:
            return elements.find(self.section.element).alpha_b
        found: Floats = self.sides[rows, edge]
        return found


def core_input(
    block: BlockOfCells, points: Floats, temperature: Floats | None = None
) -> dict[str, Any]:
    """The block in the format of the core; masses need the initial temperatures of the nodes."""
    section, material = block.section, block.section.material
    own: dict[str, Any] = {}
    if section.fibers and not material.linear:
        first = material.first if isinstance(material, MaterialTable) else material
        soft = float(first.compliance()[0, 0])
        own["fibers"] = [[y, area, -stress * soft] for y, area, stress in section.fibers]
    if section.nodal_thickness is not None:
        own["nodal_thickness"] = section.thickness_at(block.nodes, points).ravel()
    if block.sides is not None:
        own["sides"] = np.ascontiguousarray(block.sides).ravel()
    if isinstance(material, MaterialTable):
        own["by_temperature"] = material.rows_of_parameters(section.orientation)
        if temperature is not None and material.density_varies:
            # The mass of a body does not change with its temperature.
            own["nodal_density"] = material.densities(temperature[block.nodes]).ravel()
    return {
        **own,
        "element": section.element,
        "law": material.law,
        "parameters": material.parameters(section.orientation),
        "plane": section.plane,
        "local_strain": section.local_strain,
        "thickness": float(section.thickness),
        "profile": [float(v) for v in section.profile],
        "table": [[float(v) for v in pair] for pair in section.table],
        "rho": float(material.rho),
        "mean_dilatation": section.mean_dilatation,
        "beta0": section.beta0,
        "nodes": np.ascontiguousarray(block.nodes, dtype=np.uint32).ravel(),
    }


def blocks_of(model: Model, steps: Sequence[Step] = ()) -> list[BlockOfCells]:
    """Group the cells by section and kind; supports of `steps` count beside those of the model.

    Raises
    ------
    ModelError
        If a cell has no section or two, or an element does not fit its cell.
    """
    mesh = model.mesh
    owner = np.full(mesh.n_cells, -1, np.int64)
    labels = mesh.cell_labels
    planar = np.concatenate(
        [np.zeros(0, bool)]
        + [np.full(len(c), not c.kind.startswith(("line", "point"))) for c in mesh.cells]
    )
    for s, section in enumerate(model.sections):
        section.check()
        cells = section.cells
        if isinstance(cells, str):
            if cells == "all" and "all" not in mesh.cell_sets:
                cells = np.flatnonzero(planar)
            elif cells in mesh.cell_sets:
                cells = mesh.cell_sets[cells]
            else:
                names = ", ".join(mesh.cell_sets) or "none"
                raise ModelError(
                    f"no element set named {cells!r}; there are: {names}", section.where
                )
        taken = cells[(owner[cells] >= 0) & (owner[cells] != s)]
        if len(taken):
            raise ModelError(
                f"element {labels[taken[0]]} already has a section; give each element one",
                section.where,
            )
        owner[cells] = s
    bare = np.flatnonzero(planar & (owner < 0))
    if len(bare):
        raise ModelError(
            f"{len(bare)} elements have no section, the first is {labels[bare[0]]}: "
            "add a section (*SOLID SECTION) for them"
        )
    blocks = []
    group = groups_of_cells(mesh, model.steps)
    for offset, cells_of_kind in zip(mesh.offsets, mesh.cells, strict=False):
        owners = owner[offset : offset + len(cells_of_kind)]
        for s in distinct(owners[owners >= 0]):
            section = model.sections[s]
            element = elements.find(section.element)
            rows = np.flatnonzero(owners == s)
            if element.cell != cells_of_kind.kind:
                raise ModelError(
                    f"{element.name} needs {element.cell} cells; element "
                    f"{labels[offset + rows[0]]} is a {cells_of_kind.kind}: name an element for "
                    "each kind, as element={'quad4': 'Q4I', 'tri3': 'OPT'}",
                    section.where,
                )
            for alike in distinct(group[rows + offset]):
                own = rows[group[rows + offset] == alike]
                blocks.append(BlockOfCells(section, own + offset, cells_of_kind.nodes[own]))
    if not blocks:
        raise ModelError("the model has no elements; add cells and a section for them")
    _share_end_moments(blocks, model, steps)
    return blocks


def _share_end_moments(blocks: list[BlockOfCells], model: Model, steps: Sequence[Step]) -> None:
    """Give edges the share of end moments that their other side can take.

    The rotations of a drilling element bend its edges. On an edge common with an element that
    bends it less, or not at all, the displacements would differ, and a constant stress would give
    end moments that nothing balances. With a common share both sides lump a constant stress alike:
    any mixture passes the patch test. So do edges that supports and rigid curves keep straight. The
    higher-order parts do not enter, since they vanish at constant strain.
    """
    facts = [elements.find(b.section.element) for b in blocks]
    planar = [(b, f) for b, f in zip(blocks, facts, strict=True) if not f.line]
    if not any(f.alpha_b for _, f in planar):
        return
    edges = np.concatenate(
        [b.nodes[:, [e[:2] for e in EDGES[f.cell]]].reshape(-1, 2) for b, f in planar]
    )
    counts = [len(EDGES[f.cell]) * len(b.nodes) for b, f in planar]
    shares = np.repeat([f.alpha_b for _, f in planar], counts)
    supports = [*model.supports, *(s for step in steps for s in step.supports)]
    shares[straight(model, supports, edges)] = 0.0
    keys = edges.min(axis=1) * model.mesh.n_nodes + edges.max(axis=1)
    _, edge = np.unique(keys, return_inverse=True)
    least = np.full(edge.max() + 1, np.inf)
    np.minimum.at(least, edge, shares)
    common = np.split(least[edge], np.cumsum(counts)[:-1])
    for (block, f), own in zip(planar, common, strict=True):
        if (own < f.alpha_b).any():
            block.sides = own.reshape(len(block.nodes), -1)


def _check_line(model: Model, block: BlockOfCells, turns: bool) -> None:
    """Refuse lines without length and material laws that line elements do not support."""
    labels, section = model.mesh.cell_labels, block.section
    if not section.material.for_lines:
        raise ModelError(
            f"element {labels[block.cells[0]]}: {section.element} takes isotropic elastic "
            f"material or plasticity of von Mises, not {section.material.law!r}",
            section.where,
        )
    if section.element == "BEAM" and not (section.material.linear or section.fibers):
        raise ModelError(
            f"element {labels[block.cells[0]]}: a plastic beam needs the shape of its "
            "cross-section: profile= (*BEAM SECTION)",
            section.where,
        )
    ends = model.mesh.points[block.nodes]
    short = np.flatnonzero(np.ptp(ends, axis=1).max(axis=1) == 0.0)
    if turns and len(short):
        raise ModelError(
            f"element {labels[block.cells[short[0]]]} has no length; give its nodes different "
            "coordinates, or connect fixed directions (dofs) of them",
            section.where,
        )


def check_shapes(model: Model, blocks: list[BlockOfCells]) -> None:
    """Refuse elements of zero, negative or folded area, by their labels."""
    points, labels = model.mesh.points, model.mesh.cell_labels
    lost = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(lost):
        label = model.mesh.node_labels[lost[0]]
        x, y = points[lost[0]].tolist()
        raise ModelError(f"node {label} has coordinates that are not finite: ({x}, {y})")
    for block in blocks:
        facts = elements.find(block.section.element)
        _check_thickness(model, block)
        if facts.line:
            _check_line(model, block, facts.turns)
            continue
        n = 3 if "tri" in facts.cell else 4
        bad = _folded(points.T, block.nodes[:, :n])
        if len(bad):
            raise ModelError(
                f"element {labels[block.cells[bad[0]]]} is folded, has no area or is clockwise "
                f"({len(bad)} such elements); its corners must be counter-clockwise with no "
                "angle above 180 degrees",
                block.section.where,
            )
        _check_middles(model, block)


def _folded(rows: Floats, nodes: Ints) -> Ints:
    """Elements of zero, negative or folded area, from coordinates of shape (2, n_nodes).

    The Jacobian may be zero at a corner, as where a side of a quadrilateral has no length, but not
    at the integration points, 0.58 of the way to the corners.
    """
    around = np.arange(nodes.shape[1])
    found = [np.zeros(0, np.int64)]
    for first in range(0, len(nodes), _AT_ONCE):
        corners = rows[:, nodes[first : first + _AT_ONCE].T]  # (2, n, cells): long rows are fast
        one, two = corners[:, around + 1 - len(around)] - corners, corners[:, around - 1] - corners
        turn = one[0] * two[1] - one[1] * two[0]
        size = (corners.max(axis=1) - corners.min(axis=1)).max(axis=0) ** 2
        mean = turn.mean(axis=0)
        inside = mean + 0.577 * (turn - mean)
        bad = (turn < -1e-12 * size) | (inside <= 1e-12 * size)
        found.append(first + bad.any(axis=0).nonzero()[0])
    return np.concatenate(found)


def _check_thickness(model: Model, block: BlockOfCells) -> None:
    """Refuse thicknesses by node of the wrong number, or that are not positive."""
    section, labels = block.section, model.mesh.node_labels
    nodal = section.nodal_thickness
    if nodal is None:
        return
    if len(nodal) != model.mesh.n_nodes:
        raise ModelError(
            f"{len(nodal)} thicknesses for {model.mesh.n_nodes} nodes of the mesh", section.where
        )
    own = section.thickness_at(block.nodes, model.mesh.points)
    bad = np.argwhere(~(np.isfinite(own) & (own > 0.0)))
    if len(bad):
        node = block.nodes[tuple(bad[0])]
        raise ModelError(
            f"the thickness of node {labels[node]} must be > 0, not {nodal[node]:g}", section.where
        )


def _check_middles(model: Model, block: BlockOfCells) -> None:
    """Refuse mid-side nodes beyond the quarter points: the element folds at a corner there."""
    points, labels = model.mesh.points, model.mesh.cell_labels
    n = 3 if "tri" in elements.find(block.section.element).cell else 4
    if block.nodes.shape[1] < 2 * n:
        return
    corners = points[block.nodes[:, :n]]
    side = np.roll(corners, -1, axis=1) - corners
    middle = points[block.nodes[:, n : 2 * n]] - corners
    share = (middle * side).sum(axis=2) / (side**2).sum(axis=2)
    bad = np.argwhere(np.abs(share - 0.5) > 0.25 + 1e-6)
    if len(bad):
        cell, k = (int(i) for i in bad[0])
        label = model.mesh.node_labels[block.nodes[cell, n + k]]
        raise ModelError(
            f"element {labels[block.cells[cell]]}: mid-side node {label} lies at "
            f"{share[cell, k]:.3g} of its side; only between .25 and .75 the element cannot fold: "
            "move the node towards the middle",
            block.section.where,
        )
