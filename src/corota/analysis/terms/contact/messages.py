"""Messages on contact: meshes before the run, failed increments, what gives way or sinks in."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.contact.gaps import SAME, WAITED, covered, mean
from corota.analysis.terms.contact.setup import (
    CORNER,
    NONE,
    blunt_turns,
    core_of,
    of_lines,
    sharp_corners,
)
from corota.analysis.terms.contact.tunneling import NAMED
from corota.model.contact import ContactPair, RigidCurve

if TYPE_CHECKING:
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.terms.contact.contact import ContactTerm
    from corota.analysis.terms.contact.pair import Pair
    from corota.analysis.terms.contact.problem import ContactProblem
    from corota.arrays import Floats, Ints
    from corota.mesh import Mesh


#: Message alone: part that counts as the whole: of the force of a pair that a node carries alone,
#: of a friction bound that is used up, of an area.
WHOLE = 0.99


def explanation(problem: ContactProblem, at: Evaluation | None) -> str:
    """Pair and nodes that caused a failed increment, and what was tried."""
    if at is None:
        return ""
    said = ""
    complementarity, k, i = problem.complementarity(at)
    pair, terms = problem.term.pairs[k], at.contact_state.terms[k]
    if complementarity > 0.0:
        p = problem.term.parts(at.contact_state.multipliers)[k][0][i]
        area = terms.area[i]
        gap = f"{terms.gap[i] / area:.3g}" if area > 0.0 else "none"
        said = (
            f"; contact pair {pair.name!r}: worst at node {problem.term.label(pair, i)} "
            f"(gap {gap}, pressure {p:.3g})"
        )
    flipping = [
        (int(f[j]), pair, int(j))
        for pair, f in zip(problem.term.pairs, problem.flips, strict=True)
        for j in np.flatnonzero(f >= WAITED)
    ]
    flipping.sort(key=lambda item: -item[0])
    if flipping:
        names = ", ".join(str(problem.term.label(q, j)) for _, q, j in flipping[:5])
        said += (
            "; the contact state (open, stick or slip) kept changing at "
            f"node{'s' if len(flipping) > 1 else ''} {names}"
            f"{', ...' if len(flipping) > 5 else ''} of pair {flipping[0][1].name!r}"
        )
    problem.term.overcome = problem.term.overcome or _overcome(problem, at)
    if way := gives_way(problem.term):
        said += f"; {way}"
    elif problem.sliding >= WAITED:
        said += "; friction does not hold the bodies: they slide"
    elif problem.term.overcome:
        said += f"; {problem.term.overcome}"
    if problem.loose:
        said += f"; without contact pressure, {problem.loose}"
    if problem.pivoted:
        said += (
            f"; {problem.pivoted} iterations chose the states of all contact nodes together "
            "(by pivoting), which did not converge either"
        )
    return said + sunk_corner(problem.term)


def _overcome(problem: ContactProblem, at: Evaluation) -> str:
    """Whether forces exceed friction from load zero on, when nothing is pressed yet; or ''.

    The sum of the tractions of a failed attempt is what equilibrium asks of a pair.
    """
    if any(p.any() for p, _ in problem.term.parts(problem.term.committed)):
        return ""
    used: dict[str, float] = {}
    for pair, terms, (p, q) in problem.pairs(at.contact_state):
        bound = float((pair.bound(np.maximum(p, 0.0)) * terms.area).sum())
        if pair.rubs and bound > 0.0:
            used[pair.name] = abs(float((q * terms.area).sum())) / bound
    name = max(used, key=lambda name: used[name], default="")
    if name and (WHOLE * used[name] > 1.0 or min(used.values()) > WHOLE):
        return (
            f"friction of contact pair {name!r} does not hold the bodies from the start: they slide"
        )
    return ""


def gives_way(contact_term: ContactTerm) -> str:
    """Whether a body slides or tips beyond the committed state; empty if neither.

    A pair whose friction is used up lets a body slide, one that presses at a corner of a body alone
    lets it tip. At a collapse of the bodies themselves there is neither.
    """
    if contact_term.at is None:
        return ""
    for pair, terms, (p, q) in contact_term.each(contact_term.at.terms, contact_term.committed):
        force = p * terms.area
        total = float(force.sum())
        if pair.tied or not total > 0.0:
            continue
        bound = float((pair.bound(np.maximum(p, 0.0)) * terms.area).sum())
        if pair.rubs and float(np.abs(q * terms.area).sum()) > WHOLE * bound:
            return (
                f"friction of contact pair {pair.name!r} is used up: a body that it alone holds "
                "slides"
            )
        nodes = pair.nodes.copy()
        nodes[pair.of_surfaces :] = np.where(
            pair.corners >= 0, pair.corners, nodes[pair.of_surfaces :]
        )
        at_node = np.bincount(nodes, force)
        node = int(np.argmax(at_node))
        mesh = contact_term.system.model.mesh
        edges = mesh.edge_nodes(mesh.boundary_edges())
        ends = np.array([nodes[:2] for nodes in edges], np.int64)
        if at_node[node] > WHOLE * total and node in sharp_corners(mesh.points, ends):
            return (
                f"contact pair {pair.name!r} presses at corner {mesh.node_labels[node]} alone: "
                "a body that it alone holds tips about it"
            )
    return ""


#: Notes alone: slave edges that a round corner should measure along its radius, its least turn,
#: and that from which hard contact has no constraint of it as a corner [rad].
EDGES, TURN, PIN = 2.0, math.radians(20.0), 3.1
#: Note alone: height of the facets of a meshed round, relative to an overlap at the start.
FACETS = 0.02


def guided_round_note(pair: Pair, points: Floats, labels: Ints) -> str:
    """Note on a rough round slave of straight edges whose end a support guides, with mortar.

    The last edge keeps its mean gap. Of a round with the radius R it is h^2/12R deeper than the
    gaps of its nodes, which all other edges take, and without friction this one as well.
    """
    if pair.beside is None or pair.tied or not pair.keeps_means:
        return ""
    if (pair.slave.nodes[:, 2] >= 0).any():
        return ""
    left, right = pair.beside
    for k in np.flatnonzero(pair.guided_ends):
        way = right if left[k] < 0 else left
        chain = [int(k), int(way[k])]
        chain.append(int(way[chain[1]]))
        if min(chain) < 0:
            continue
        a, b, c = points[pair.nodes[chain], :2]
        first, second = b - a, c - b
        turn = abs(math.atan2(first[0] * second[1] - first[1] * second[0], float(first @ second)))
        if NONE < turn < CORNER:
            depth = math.hypot(*first) * turn / 12.0
            return (
                f"contact pair {pair.name!r}: the slave surface is round, has friction, and a "
                f"support guides its end at node {labels[pair.nodes[k]]}, along which the other "
                f"side may move: its last edge keeps a mean gap, which is {depth:.3g} deeper than "
                "those of its nodes. Where this counts beside the deformation, pressures there are "
                "wrong: take method='node_to_segment', quadratic elements or the whole round"
            )
    return ""


def start_notes(pair: Pair, mesh: Mesh, area: Floats | None, x: Floats) -> list[str]:
    """Notes on a pair that begins to act.

    Parameters
    ----------
    area : ndarray, shape (n,), or None
        Areas of the constraints that have an opposite surface; None after the first step.
    x : ndarray, shape (n_nodes, 2)
        Positions at the start.
    """
    labels = mesh.node_labels
    notes = [fillet_note(pair), corner_note(pair, mesh.points, labels)]
    if area is not None:
        notes.append(partly_covered_note(pair, area, x, labels))
    return [note for note in notes if note]


def fillet_note(pair: Pair) -> str:
    """A remark on round corners of a rigid curve that are too small for the slave edges, or ''."""
    curve = getattr(pair.item, "master", None)
    if not isinstance(curve, RigidCurve) or pair.beside is None:
        return ""
    rows = curve.segments
    # Clockwise arcs have the rigid body inside: the corners that slave edges pass around.
    corners = rows[rows[:, 6] < -(PIN if pair.law is None else TURN)]
    if not len(corners):
        return ""
    radius = float(np.hypot(*(corners[:, :2] - corners[:, 4:6]).T).min())
    # The mean by length: short edges at a nose do not represent the sliding face.
    edge = float((pair.slave.length**2).sum() / pair.slave.length.sum())
    if radius >= EDGES * edge:
        return ""
    return (
        f"contact pair {pair.item.name!r}: the smallest round corner of the rigid curve has the "
        f"radius {radius:.4g}, {radius / edge:.2g} slave edges (mean {edge:.4g}); the force "
        "will be jagged while nodes pass it one by one. Use method='node_to_segment' (TYPE=NODE "
        "TO SURFACE), which measures such rounds against edges; or use slave edges of at most "
        f"{radius / EDGES:.3g} where they meet it, or a larger radius"
    )


def corner_note(pair: Pair, points: Floats, labels: Ints) -> str:
    """A remark on masters that press with corners but not as corners, or ''.

    Sharp corners under a pressure law, and round boundaries with too coarse edges.
    """
    if pair.master is None or pair.tied or pair.slave.pointwise:
        return ""
    sharp = sharp_corners(points, pair.master.nodes[:, :2]) if pair.law is not None else []
    if sharp:
        named = ", ".join(str(labels[k]) for k in sharp[:3]) + ", ..." * (len(sharp) > 3)
        return (
            f"contact pair {pair.item.name!r}: the master has sharp corners (node {named}). A "
            "pressure law acts on areas, so a corner that presses alone sinks in between slave "
            "nodes and wedges: where the other body meets a corner, make this surface the slave, "
            "or use hard contact"
        )
    if getattr(pair.item, "smooth", True):
        return ""
    turns = blunt_turns(points, pair.master)
    node, turn = max(turns.items(), key=lambda item: item[1], default=(-1, 0.0))
    if turn <= TURN:
        return ""
    return (
        f"contact pair {pair.item.name!r}: the master turns by {math.degrees(turn):.0f} degrees "
        f"from edge to edge at node {labels[node]}; the force will jump when contact passes such "
        "nodes. Where the boundary should be round, treat it as a curve (smooth=True, SMOOTH of "
        "*CONTACT PAIR) or refine its edges"
    )


def facet_note(pair: Pair, points: Floats, overlap: float) -> str:
    """A remark on an overlap of rounds whose meshed master has facets that count beside it, or ''.

    With node_to_segment an edge of the length h that turns by t lies h t / 8 inside its round.
    """
    if pair.master is None or pair.beside is not None or getattr(pair.item, "smooth", True):
        return ""
    if pair.slave.pointwise or not blunt_turns(points, pair.slave):
        return ""
    turns = blunt_turns(points, pair.master)
    height = 0.0
    for a, b, middle in pair.master.nodes.tolist():
        turn = min(turns.get(a, 0.0), turns.get(b, 0.0))
        if middle < 0 and turn <= TURN:
            height = max(height, float(np.hypot(*(points[b] - points[a]))) * turn / 8.0)
    if height <= FACETS * overlap:
        return ""
    return (
        f"contact pair {pair.item.name!r}: edges of the master lie up to {height:.3g} inside its "
        f"rounds, {height / overlap:.2g} of the overlap, and count as they are: pressures are "
        "uneven, and the force is off by this order. Take mortar contact, which counts them as "
        "arcs, or shorter edges"
    )


def partly_covered_note(pair: Pair, area: Floats, x: Floats, labels: Ints) -> str:
    """A remark on slave nodes at the ends of a master under a pressure law, or ''.

    With node_to_segment a node presses on its whole area, though the master covers a part of it.
    """
    item, slave = pair.item, pair.slave
    pointwise = slave.pointwise or pair.beside is not None
    if pair.law is None or pointwise or not isinstance(item, ContactPair) or item.itself:
        return ""
    ends = _ends(pair, x)
    seen = covered(area, pair.full)
    inside = seen[pair.place[slave.nodes]] & (slave.nodes >= 0)
    excess, named = 0.0, []
    for row in np.flatnonzero(inside[:, 0] != inside[:, 1]).tolist():
        a, b, middle = slave.nodes[row].tolist()
        if not inside[row, 0]:
            a, b = b, a
        along, away = x[b] - x[a], ends - x[a]
        length = float(np.hypot(*along))
        part = away @ along / length**2
        off = np.abs(away[:, 0] * along[1] - away[:, 1] * along[0]) / length
        off[(part <= -SAME) | (part >= 1.0 - SAME)] = np.inf
        if not len(ends) or off.min() > pair.reach:
            continue
        taken = 0.5 if middle < 0 else 1.0 / 6.0 + 2.0 / 3.0 * inside[row, 2]
        depth = slave.thickness[row] or math.pi * (x[a, 0] + x[b, 0])
        excess += (taken - float(part[np.argmin(off)])) * length * depth
        named.append(str(labels[a]))
    exact = float(area[: pair.of_nodes][seen[: pair.of_nodes]].sum()) - excess
    if abs(excess) <= (1.0 - WHOLE) * exact:
        return ""
    return (
        f"contact pair {pair.name!r}: the master ends within slave edges (node "
        f"{', '.join(named)}). With node_to_segment a pressure law acts on the whole area of each "
        f"slave node: the layer is {abs(excess) / exact:.0%} too "
        f"{'stiff' if excess > 0.0 else 'soft'} at the start. Exchange slave and master, or use "
        "method='mortar'"
    )


def _ends(pair: Pair, x: Floats) -> Floats:
    """Points at which a master ends, shape (k, 2); those of a rigid curve in the reference."""
    if pair.master is not None:
        ids, count = np.unique(pair.master.nodes[:, :2], return_counts=True)
        return np.asarray(x[ids[count == 1]])
    rows = pair.item.master.segments  # type: ignore[union-attr]
    points = np.concatenate([rows[:, :2], rows[:, 2:4]])
    place = np.round(points / (SAME * pair.size))
    _, first, count = np.unique(place, axis=0, return_index=True, return_counts=True)
    alone: Floats = points[first[count == 1]]
    return alone


def sunk_corner(contact_term: ContactTerm) -> str:
    """Message on the deepest corner of a master inside a slave surface, or ''.

    A pressure law acts on areas, so that a corner has no constraint of its own: it can penetrate
    between two slave nodes until one of them is in contact with the side of the corner and jams.
    """
    x = contact_term.positions(contact_term.u)[:, :2]
    worst, said = NAMED, ""
    for pair in contact_term.pairs:
        if pair.law is None or pair.master is None or not isinstance(pair.item, ContactPair):
            continue
        for corner in sharp_corners(x, pair.master.nodes[:, :2]):
            depth, ends = _depth(x, pair, corner)
            if worst < depth < EDGES:
                label = contact_term.system.model.mesh.node_labels
                worst = depth
                said = (
                    f"; the sharp corner of the master at node {label[corner]} lies {depth:.2g} "
                    f"slave edges inside the slave surface of {pair.name!r}, between nodes "
                    f"{label[ends[0]]} and {label[ends[1]]}: a pressure law acts on areas, so "
                    "that it goes in until they wedge. Exchange slave and master, refine the "
                    "slave where the corner meets it, round the corner, or use hard contact"
                )
    return said


def _depth(x: Floats, pair: Pair, corner: int) -> tuple[float, tuple[int, int]]:
    """Depth behind the nearest slave edge [its length], and the edge; 0 beyond its ends."""
    edges = pair.slave.nodes[:, :2]
    edges = edges[(edges != corner).all(axis=1)]
    if not len(edges):
        return 0.0, (-1, -1)
    d, r = x[edges[:, 1]] - x[edges[:, 0]], x[corner] - x[edges[:, 0]]
    square = (d * d).sum(axis=1)
    along = (r * d).sum(axis=1) / square
    off = r - np.clip(along, 0.0, 1.0)[:, None] * d
    k = int(np.argmin((off * off).sum(axis=1)))
    a, b = edges[k].tolist()
    if not 0.0 < along[k] < 1.0:
        return 0.0, (a, b)
    return float((d[k, 0] * r[k, 1] - d[k, 1] * r[k, 0]) / square[k]), (a, b)


#: Note alone: overlap of surfaces between the constraints of a pair from which it is reported: of a
#: pair that presses, and of one that does not [edges].
BETWEEN, UNHELD = 0.05, 0.02


def sunk_between(contact_term: ContactTerm) -> list[str]:
    """Notes on pairs of bodies whose surfaces overlap between their constraints at the end.

    Mortar gaps are means over slave edges, and node-to-segment contact has the gaps of slave nodes:
    what is small beside a slave edge goes in between. Here the gaps of all nodes count.
    """
    notes: list[str] = []
    if contact_term.at is None:
        return notes
    numbered, x = contact_term.system, contact_term.positions(contact_term.u)
    parts = contact_term.parts(contact_term.committed)
    for pair, (p, _) in zip(contact_term.pairs, parts, strict=True):
        item = pair.item
        if not isinstance(item, ContactPair) or not pair.active:
            continue
        # Laws let surfaces overlap; offsets and linear steps have gaps of their own.
        if pair.law is not None or not numbered.nlgeom or pair.core.offset.any():
            continue
        if any(of_lines(side) for side in (pair.slave, pair.master) if side is not None):
            continue
        depth, node = _deepest(pair, numbered.model.mesh, x)
        edge, presses = float(pair.slave.length.max()), bool((p > 0.0).any())
        if depth <= (BETWEEN if presses else UNHELD) * edge:
            continue
        notes.append(
            f"contact pair {pair.name!r}{'' if presses else ' has no force, though'}: the "
            f"surfaces overlap by {depth:.3g} at node {numbered.model.mesh.node_labels[node]} at "
            f"the end, {depth / edge:.2g} slave edges, where the pair has no constraint. Take "
            "shorter slave edges there, the other method, or exchange slave and master"
        )
    return notes


def _deepest(pair: Pair, mesh: Mesh, x: Floats) -> tuple[float, int]:
    """Depth of the node of either side that lies deepest in the other, and the node."""
    assert isinstance(pair.item, ContactPair)
    item = replace(pair.item, method="node_to_segment")
    sides = [(item, pair.slave, pair.master)]
    if pair.master is not None and not isinstance(item.master, RigidCurve) and item.images is None:
        exchanged = replace(item, slave=item.master, master=item.slave, smooth=False)
        sides.append((exchanged, pair.master, pair.slave))
    worst, node = 0.0, -1
    for own, slave, master in sides:
        core = core_of(mesh, own, slave, master, pair.reach, pair.depth)
        core.search(x)
        found = core.evaluate(x)
        depth = mean(-found["total_gap"], found["total_area"], np.asarray(core.full_area))
        k = int(np.argmax(depth))
        if depth[k] > worst:
            worst, node = float(depth[k]), int(core.nodes[k])
    return worst, node
