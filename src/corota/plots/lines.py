"""Line elements, masses and links of a model: trusses, beams, springs, dashpots, rigid bodies."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.mesh.parts import cells_of, nodes_of
from corota.model import elements
from corota.model.constraints import Coupling
from corota.plots.figure import INK

if TYPE_CHECKING:
    from corota.arrays import Floats
    from corota.model.model import Model


#: Beams, bars, springs and links are distinct from cell edges and supports.
BEAM, BAR, SPRING, LINK = "#35506e", "#8a5a2b", "#8c2f6b", "#9aa3ae"
#: Windings of a spring, and their height over the diagonal of the model.
WINDINGS, HEIGHT = 5, 0.012


def zigzag(first: Floats, last: Floats, height: float) -> Floats:
    """Line of a spring between two points, shape (m, 2)."""
    along = last - first
    length = float(np.linalg.norm(along))
    if length == 0.0:
        return np.stack([first, last])
    across = height * np.array([-along[1], along[0]]) / length
    at = np.concatenate([[0.0], np.linspace(0.25, 0.75, 2 * WINDINGS + 1), [1.0]])
    side = np.concatenate([[0.0, 0.0], np.resize([1.0, -1.0], 2 * WINDINGS - 1), [0.0, 0.0]])
    return first + at[:, None] * along + side[:, None] * across


def draw_lines(ax: Any, subject: Model, size: float) -> None:
    """Draw line elements, masses and links.

    Beams are heavy lines, bars lighter ones with open ends, springs zigzags (to the ground a short
    one; a ring where they turn), dashpots dashed, point masses dots, rigid bodies and couplings
    thin lines to their reference node.
    """
    from matplotlib.collections import LineCollection

    mesh = subject.mesh
    drawn: dict[str, list[Floats]] = {"beam": [], "truss": [], "spring": [], "dashpot": []}
    for section in subject.sections:
        facts = elements.find(section.element)
        if not facts.line:
            continue
        for cell in cells_of(mesh, section.cells).tolist():
            block, row = mesh.locate(cell)
            ends = mesh.points[mesh.cells[block].nodes[row]]
            if not facts.spring:
                drawn[facts.name.lower()].append(ends)
            elif len(ends) == 2 and np.ptp(ends, axis=0).any():
                drawn["spring"].append(zigzag(ends[0], ends[1], HEIGHT * size))
            elif facts.dofs_per_node == 3:
                ax.plot(
                    *ends[0],
                    "o",
                    markersize=11.0,
                    markerfacecolor="none",
                    color=SPRING,
                    markeredgewidth=1.4,
                    zorder=3,
                )
            else:
                dof = int(section.profile[1])
                away = ends[0] - 0.07 * size * np.eye(2)[dof % 2]
                drawn["spring"].append(zigzag(away, ends[0], HEIGHT * size))
    for damper in subject.dashpots:
        if damper.second is not None:
            drawn["dashpot"].append(mesh.points[[damper.first, damper.second]])
        else:
            at = mesh.points[damper.first]
            axes = [k for k in (0, 1) if damper.to_ground[k] or k in (damper.dofs or ())[:1]]
            drawn["dashpot"] += [np.stack([at - 0.07 * size * np.eye(2)[k], at]) for k in axes]
    looks = {
        "beam": (BEAM, 2.2, "-"),
        "truss": (BAR, 1.4, "-"),
        "spring": (SPRING, 1.1, "-"),
        "dashpot": (SPRING, 1.6, (0, (3, 2))),
    }
    for kind, paths in drawn.items():
        if paths:
            color, width, style = looks[kind]
            ax.add_collection(
                LineCollection(paths, colors=color, linewidths=width, linestyles=style, zorder=2)
            )
    if drawn["truss"]:
        ends = np.concatenate(drawn["truss"])
        ax.plot(
            *ends.T,
            "o",
            markersize=3.6,
            markerfacecolor="white",
            color=BAR,
            zorder=3,
            markeredgewidth=0.9,
        )
    for mass in subject.point_masses:
        at = mesh.points[nodes_of(mesh, mass.nodes)]
        ax.plot(*at.T, "o", markersize=7.0, color=INK, zorder=3)
    draw_links(ax, subject, mesh.points)
    for constraint in subject.constraints:
        if isinstance(constraint, Coupling):
            ax.plot(
                *mesh.points[constraint.reference],
                "D",
                markersize=4.0,
                color=LINK,
                markeredgecolor=INK,
                zorder=3,
                markeredgewidth=0.6,
            )


def draw_links(ax: Any, subject: Model, points: Floats) -> None:
    """Draw rigid bodies and couplings as lines from their reference, with the nodes at `points`."""
    from matplotlib.collections import LineCollection

    links: list[Floats] = []
    for constraint in subject.constraints:
        if isinstance(constraint, Coupling):
            nodes = subject.mesh.node_indices(constraint.nodes)
            links += [points[[node, constraint.reference]] for node in nodes]
    if links:
        ax.add_collection(LineCollection(links, colors=LINK, linewidths=0.7, zorder=1.8))
