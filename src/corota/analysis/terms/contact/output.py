"""Output of contact: values at slave nodes, sums and energies; and what is said about it.

Messages are on meshes before the run, failed increments, and what gives way or sinks in.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota._core import CLOSED, OPEN, STEEP, TURN
from corota.analysis.terms.contact.contact import few
from corota.analysis.terms.contact.gaps import SAME, WAITED, covered, mean
from corota.analysis.terms.contact.setup import (
    alone,
    blunt_turns,
    chords,
    core_of,
    of_lines,
    rotated,
    sharp_corners,
    signed_distances,
)
from corota.analysis.terms.term import TermOutput
from corota.arrays import distinct
from corota.mesh.parts import part_of_nodes
from corota.model.contact import ContactPair, RigidCurve, edges_or_nodes
from corota.results.rigid import rigid_curves

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.evaluation import Evaluation
    from corota.analysis.terms.contact.contact import ContactTerm
    from corota.analysis.terms.contact.equations import ContactEquations
    from corota.analysis.terms.contact.pair import Pair, Terms
    from corota.arrays import Bools, Floats, Ints
    from corota.mesh import Mesh
    from corota.model.model import Model


def output(term: ContactTerm) -> TermOutput:
    """Contact at the nodes of the committed state, and sums of the pairs.

    The sums are the force on the slave surface, its moment about the origin, area, gap, and
    energies.
    """
    if not term.pairs:
        return TermOutput()
    n = len(term.system.per_node)
    values = np.zeros((n, 5))
    sums: dict[str, float] = {}
    several = sum(not pair.tied for pair in term.pairs) > 1
    each = {p.name: np.zeros((n, 5)) for p in term.pairs if several and not p.tied}
    at, friction, law = term.at, 0.0, 0.0
    for k, (pair, (p, q)) in enumerate(zip(term.pairs, term.parts(term.committed), strict=True)):
        terms = None if at is None else at.terms[k]
        state = np.zeros(pair.n, np.int8) if at is None else at.states[k]
        gap = pair.first_gap
        if terms is not None:
            gap = mean(terms.gap, terms.area, pair.full, pair.reach)
        # Positive when the slave is pulled along its own edges' direction.
        rows = np.column_stack([p, q, gap, pair.slid, state])[pair.owner]
        if not pair.tied:
            _spread(values, pair, rows, terms)
        if pair.name in each:
            _spread(each[pair.name], pair, rows, terms)
        if at is None or terms is None:
            sums |= {} if pair.tied else {f"{pair.name}: gap": float(gap.min(initial=pair.reach))}
            continue
        acting, x = at.acting[k], at.where
        assert x is not None
        keys = (f"{pair.name}: {name}" for name in ("force x", "force y", "moment"))
        sums |= zip(keys, resultant(pair, acting, p, q, x), strict=True)
        if not pair.tied:
            closed = np.zeros(n)
            area = np.where(state != OPEN, terms.area, 0.0)
            np.maximum.at(closed, pair.nodes[: pair.of_surfaces], area[: pair.of_surfaces])
            # A corner that presses alone counts as a node does.
            area[: pair.of_surfaces] = 0.0
            area[pair.backed(terms, state)] = 0.0
            sums[f"{pair.name}: gap"] = float(gap.min(initial=pair.reach))
            sums[f"{pair.name}: area"] = float(closed.sum() + area.sum())
        if pair.rubs:
            keys = (f"{pair.name}: friction {name}" for name in ("x", "y", "moment"))
            sums |= zip(keys, resultant(pair, acting, np.zeros_like(p), q, x), strict=True)
        friction += pair.friction_work
        law += pair.law_energy(terms)
    sums["friction energy"] = friction
    sums["contact energy"] = law
    sums["stabilization energy"] = term.damping_work
    return TermOutput(values, sums, each)


def pressures(
    term: ContactTerm, terms: list[Terms] | None, multipliers: Floats
) -> tuple[Floats, NDArray[np.bool_]]:
    """Contact pressure of the slave nodes, and nodes whose pair has a pressure law; (n_nodes,).

    `terms` are those of all pairs at the state, None before the first increment; `multipliers` have
    the shape (n_multipliers,).
    """
    n = len(term.system.per_node)
    values, soft = np.zeros((n, 5)), np.zeros(n, bool)
    for k, (pair, (p, _)) in enumerate(zip(term.pairs, term.parts(multipliers), strict=True)):
        if pair.tied:
            continue
        rows = np.zeros((pair.n, 5))
        rows[:, 0], rows[:, 4] = p, np.where(p > 0.0, CLOSED, OPEN)
        _spread(values, pair, rows[pair.owner], None if terms is None else terms[k])
        soft[pair.nodes] |= pair.law is not None
    return values[:, 0], soft


def _spread(values: Floats, pair: Pair, rows: Floats, terms: Terms | None = None) -> None:
    """Add a pair's rows to the nodes."""
    n = len(values)
    own = np.zeros((n, 5))
    own[pair.nodes[: pair.of_nodes]] = rows[: pair.of_nodes]
    # Facets in contact with rounded corners are shown at their first nodes.
    facets = pair.nodes[pair.of_nodes : pair.of_surfaces]
    more = rows[pair.of_nodes : pair.of_surfaces]
    own[facets[:, None], [0, 1, 3]] += more[:, [0, 1, 3]]
    own[facets, 2] = np.minimum(own[facets, 2], more[:, 2])
    own[facets, 4] = np.maximum(own[facets, 4], more[:, 4])
    if terms is not None and len(pair.corners):
        _spread_corners(own, pair, rows, terms)
    nodes = distinct(pair.nodes)
    before = values[nodes, 4] > 0.0
    values[nodes, :2] += own[nodes, :2]
    values[nodes, 3] += own[nodes, 3]
    # The gap of a node with several pairs is that of the closed one, else the smallest.
    first = ~before & (values[nodes, 2] == 0.0)
    values[nodes, 2] = np.where(first, own[nodes, 2], np.minimum(values[nodes, 2], own[nodes, 2]))
    values[nodes, 4] = np.maximum(values[nodes, 4], own[nodes, 4])


def _spread_corners(own: Floats, pair: Pair, rows: Floats, terms: Terms) -> None:
    """Add the forces of corners as tractions of slave nodes, in place.

    A corner of the slave is a node itself; one of the master presses on those of an edge.
    """
    edges, of = pair.slave.nodes, terms.constraint
    for term in np.flatnonzero((of >= pair.of_surfaces) & (rows[of, 4] != OPEN)):
        k, variables, gradient = of[term], terms.variables[term], terms.gap_gradient[term]
        a, b = (int(v) // 3 for v in variables[[0, 2]])
        edge = np.flatnonzero((edges[:, 0] == a) & (edges[:, 1] == b))
        shares = {a: 1.0}
        if len(edge) and pair.corners[k - pair.of_surfaces] not in (a, b):
            nodes = edges[int(edge[0])]
            width = 3 if nodes[2] >= 0 else 2
            shares = {
                int(variables[2 * i]) // 3: float(np.hypot(*gradient[2 * i : 2 * i + 2]))
                for i in range(width)
            }
        whole = sum(shares.values())
        for n, share in shares.items():
            own[n, :2] += share / whole * rows[k, :2] * pair.full[k] / pair.full[pair.place[n]]
            own[n, 4] = max(own[n, 4], rows[k, 4])


def resultant(
    pair: Pair, terms: Terms, p: Floats, q: Floats, x: Floats
) -> tuple[float, float, float]:
    """Force on the slave surface and its moment about the origin."""
    part = p[terms.constraint, None] * terms.gap_gradient
    if pair.two:
        part = part + q[terms.constraint, None] * terms.slip_gradient
    node = np.maximum(terms.variables, 0) // 3
    on = (terms.variables >= 0) & pair.on_slave[node]
    nodal = np.zeros((len(x), 3))
    np.add.at(nodal, (node[on], terms.variables[on] % 3), part[on])
    moment = x[:, 0] @ nodal[:, 1] - x[:, 1] @ nodal[:, 0] + nodal[:, 2].sum()
    return float(nodal[:, 0].sum()), float(nodal[:, 1].sum()), float(moment)


# -- messages --------------------------------------------------------------------------

#: Notes alone: depth of a penetration [edges], height of facets over an overlap, or part of a
#: force, of a friction bound and of an area, from which it counts; half of the depth where a pair
#: does not press at all.
NAMED = 0.05


def explanation(problem: ContactEquations, at: Evaluation | None) -> str:
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
        names = few([problem.term.label(q, j) for _, q, j in flipping])
        said += (
            "; the contact state (open, stick or slip) kept changing at "
            f"node{'s' if len(flipping) > 1 else ''} {names} of pair {flipping[0][1].name!r}"
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


def _overcome(problem: ContactEquations, at: Evaluation) -> str:
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
    if name and (used[name] > 1.0 + SAME or min(used.values()) > 1.0 - NAMED):
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
        if pair.rubs and float(np.abs(q * terms.area).sum()) > (1.0 - NAMED) * bound:
            return (
                f"friction of contact pair {pair.name!r} is used up: a body that it alone holds "
                "slides"
            )
        at_node = np.bincount(pair.named, force)
        node = int(np.argmax(at_node))
        mesh = contact_term.system.model.mesh
        edges = mesh.edge_nodes(mesh.boundary_edges())
        ends = np.array([nodes[:2] for nodes in edges], np.int64)
        if at_node[node] > (1.0 - NAMED) * total and node in sharp_corners(mesh.points, ends):
            return (
                f"contact pair {pair.name!r} presses at corner {mesh.node_labels[node]} alone: "
                "a body that it alone holds tips about it"
            )
    return ""


def guided_round_note(pair: Pair, points: Floats, labels: Ints) -> str:
    """Note on a rough round slave of straight edges whose end a support guides, with mortar.

    The last edge keeps its mean gap. Of a round with the radius R it is h^2/12R deeper than the
    gaps of its nodes, which all other edges take, and without friction this one as well.
    """
    if pair.beside is None or pair.tied or not pair.keeps_means:
        return ""
    if (pair.slave.nodes[:, 2] >= 0).any():
        return ""
    turns = blunt_turns(points, pair.slave)
    for k in np.flatnonzero(pair.guided_ends):
        beside = max(side[k] for side in pair.beside)
        end, next_one = pair.nodes[[k, beside]].tolist()
        if beside >= 0 and next_one in turns:
            depth = math.dist(points[end], points[next_one]) * turns[next_one] / 12.0
            return (
                f"contact pair {pair.name!r}: the slave surface is round, has friction, and a "
                f"support guides its end at node {labels[end]}, along which the other side may "
                f"move: its last edge keeps a mean gap, which is {depth:.3g} deeper than those of "
                "its nodes. Where this counts beside the deformation, pressures there are wrong: "
                "take method='node_to_segment', quadratic elements or the whole round"
            )
    return ""


def start_notes(
    pair: Pair,
    mesh: Mesh,
    area: Floats | None,
    x: Floats,
    gap: Floats,
    adjusted: Bools,
    explicit: bool,
) -> list[str]:
    """Notes on a pair that begins to act at positions `x`.

    `area` is None after the first step. Of the constraints with their gaps [length], overlaps of
    some are `adjusted`.
    """
    labels = mesh.node_labels
    notes = [fillet_note(pair), corner_note(pair, mesh.points, labels)]
    if area is not None:
        notes.append(partly_covered_note(pair, area, x, labels))
    deepest = int(np.argmin(gap))
    overlap, edge = -float(gap[deepest]), float(pair.slave.length.max())
    if overlap > SAME * edge:
        start = "adjust" if adjusted[deepest] else "keep"
        if isinstance(pair.item, ContactPair) and pair.item.start == "ramp":
            start = "ramp"
        how = {
            "keep": "is removed in the first increment (start='ramp' removes it over the step, "
            "start='adjust' treats it as in contact)",
            "explicit": "remains until the contact opens (start='ramp' removes it over the step)",
            "adjust": "is treated as in contact without strain",
            "ramp": "is removed over the first step",
        }["explicit" if explicit and start == "keep" else start]
        half = float(np.max(pair.slave.half, initial=0.0))
        lines = f" (the surface is {half:.4g} away from the line)" if half else ""
        notes.append(
            f"the surfaces overlap by up to {overlap:.4g} at node {labels[pair.nodes[deepest]]} at "
            f"the start{lines}; this {how}"
        )
        notes.append(facet_note(pair, mesh.points, overlap))
    return [f"contact pair {pair.name!r}: {note}" for note in notes if note]


def fillet_note(pair: Pair) -> str:
    """A remark on round corners of a rigid curve that are too small for the slave edges, or ''."""
    curve = pair.item.master
    if not isinstance(curve, RigidCurve) or pair.beside is None:
        return ""
    rows = curve.segments
    # Clockwise arcs have the rigid body inside: the corners that slave edges pass around. In hard
    # contact those of less than half a turn have constraints of their own.
    corners = rows[rows[:, 6] < -(TURN if pair.law else math.pi - SAME)]
    if not len(corners):
        return ""
    radius = float(np.hypot(*(corners[:, :2] - corners[:, 4:6]).T).min())
    # The mean by length: short edges at a nose do not represent the sliding face.
    edge = float((pair.slave.length**2).sum() / pair.slave.length.sum())
    if edge <= STEEP * radius:
        return ""
    return (
        f"the smallest round corner of the rigid curve has the radius {radius:.4g}, "
        f"{radius / edge:.2g} slave edges (mean {edge:.4g}); the force will be jagged while nodes "
        "pass it one by one. Use method='node_to_segment' (TYPE=NODE TO SURFACE), which measures "
        f"such rounds against edges; or use slave edges of at most {STEEP * radius:.3g} where they "
        "meet it, or a larger radius"
    )


def corner_note(pair: Pair, points: Floats, labels: Ints) -> str:
    """A remark on masters that press with corners but not as corners, or ''.

    Sharp corners under a pressure law, and round boundaries with too coarse edges.
    """
    if pair.master is None or pair.tied or pair.slave.pointwise:
        return ""
    sharp = sharp_corners(points, pair.master.nodes[:, :2]) if pair.law is not None else []
    if sharp:
        return (
            f"the master has sharp corners (node {few(labels[sharp], 3)}). A pressure law acts on "
            "areas, so a corner that presses alone sinks in between slave nodes and wedges: where "
            "the other body meets a corner, make this surface the slave, or use hard contact"
        )
    if getattr(pair.item, "smooth", True):
        return ""
    turns = blunt_turns(points, pair.master)
    node, turn = max(turns.items(), key=lambda item: item[1], default=(-1, 0.0))
    if turn <= TURN:
        return ""
    return (
        f"the master turns by {math.degrees(turn):.0f} degrees from edge to edge at node "
        f"{labels[node]}; the force will jump when contact passes such nodes. Where the boundary "
        "should be round, treat it as a curve (smooth=True, SMOOTH of *CONTACT PAIR) or refine its "
        "edges"
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
    if height <= NAMED * overlap:
        return ""
    return (
        f"edges of the master lie up to {height:.3g} inside its rounds, {height / overlap:.2g} of "
        "the overlap, and count as they are: pressures are uneven, and the force is off by this "
        "order. Take mortar contact, which counts them as arcs, or shorter edges"
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
        # A node a little beyond the end still presses.
        off[(part <= -0.5) | (part >= 1.0 - SAME)] = np.inf
        if not len(ends) or off.min() > pair.reach:
            continue
        taken = 0.5 if middle < 0 else 1.0 / 6.0 + 2.0 / 3.0 * inside[row, 2]
        depth = slave.thickness[row] or math.pi * (x[a, 0] + x[b, 0])
        excess += (taken - float(part[np.argmin(off)])) * length * depth
        named.append(str(labels[a]))
    exact = float(area[: pair.of_nodes][seen[: pair.of_nodes]].sum()) - excess
    if abs(excess) <= NAMED * exact:
        return ""
    return (
        f"the master ends within slave edges (node {', '.join(named)}). With node_to_segment a "
        "pressure law acts on the whole area of each slave node: the layer is "
        f"{abs(excess) / exact:.0%} too {'stiff' if excess > 0.0 else 'soft'} at the start. "
        "Exchange slave and master, or use method='mortar'"
    )


def _ends(pair: Pair, x: Floats) -> Floats:
    """Points at which a master ends, shape (k, 2); those of a rigid curve in the reference."""
    if pair.master is not None:
        points = x[pair.master.nodes[:, :2]].reshape(-1, 2)
    else:
        points = pair.item.master.segments[:, :4].reshape(-1, 2)  # type: ignore[union-attr]
    return np.asarray(points[alone(points, SAME * pair.size)])


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
            edges = pair.slave.nodes[:, :2]
            edges = edges[(edges != corner).all(axis=1)]
            if not len(edges):
                continue
            away, best, over = signed_distances(x[edges], x[[corner]], SAME * pair.size)
            a, b = edges[best[0]]
            depth, edge = -float(away[0] * over[0]), math.dist(x[a], x[b])
            if worst * edge < depth < pair.depth:
                label = contact_term.system.model.mesh.node_labels
                worst = depth / edge
                said = (
                    f"; the sharp corner of the master at node {label[corner]} lies {worst:.2g} "
                    f"slave edges inside the slave surface of {pair.name!r}, between nodes "
                    f"{label[a]} and {label[b]}: a pressure law acts on areas, so "
                    "that it goes in until they wedge. Exchange slave and master, refine the "
                    "slave where the corner meets it, round the corner, or use hard contact"
                )
    return said


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
        if depth <= (1.0 if presses else 0.5) * NAMED * edge:
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


def passed_through(model: Model, u: Floats) -> list[str]:
    """Notes on parts of bodies in no pair that lie behind a rigid curve or in another body.

    `u` has the displacements and rotations of all nodes at the end, shape (n_nodes, 3).
    """
    mesh, part, notes = model.mesh, part_of_nodes(model.mesh), []
    points, x = mesh.points, mesh.points + u[:, :2]

    def note(pair: ContactPair, nodes: Ints, depth: Floats, least: float, where: str) -> None:
        deepest = int(np.argmax(depth))
        if depth[deepest] > least:
            notes.append(
                f"contact pair {pair.name!r}: nodes that are in no pair {where} "
                f"({int((depth > least).sum())} of them), "
                f"node {mesh.node_labels[nodes[deepest]]} by {depth[deepest]:.3g}: "
                "they passed through. Give the surfaces of the pair all edges that may meet"
            )

    def entered(before: Floats, after: Floats, first: Floats, last: Floats) -> Floats:
        """Depth of points behind pieces at the end, of those that were before them [length]."""
        same = SAME * float(np.ptp(points))
        start, _, beside = signed_distances(first, before, same)
        end, _, inside = signed_distances(last, after, same)
        return np.where(inside & ~(beside & (start < -same)), np.maximum(-end, 0.0), 0.0)

    rims = [nodes[:2] for nodes in mesh.edge_nodes(mesh.boundary_edges())]
    edges = np.array(rims, np.int64).reshape(-1, 2)
    surfaces = [s for pair in model.contacts for s in (pair.slave, pair.master)]
    bodies = [_surface_nodes(model, s) for s in surfaces if not isinstance(s, RigidCurve)]
    free = np.setdiff1d(edges, np.concatenate(bodies))
    for pair in model.contacts:
        if isinstance(pair.master, RigidCurve):
            continue
        sides = [np.unique(part[_surface_nodes(model, s)]) for s in (pair.slave, pair.master)]
        for own, other in (sides, sides[::-1]):
            nodes = free[np.isin(part[free], np.setdiff1d(own, other))]
            rim = edges[np.isin(part[edges[:, 0]], np.setdiff1d(other, own))]
            if len(rim) and len(nodes):
                depth = entered(points[nodes], x[nodes], points[rim], x[rim])
                length = np.hypot(*(x[rim[:, 1]] - x[rim[:, 0]]).T)
                least = NAMED * float(length.mean())
                note(pair, nodes, depth, least, "lie in the other body")
    for curve in rigid_curves(model):
        pairs = [pair for pair in model.contacts if pair.master is curve]
        slaves = np.concatenate([_surface_nodes(model, pair.slave) for pair in pairs])
        chosen = np.isin(part, part[slaves]) & (part >= 0)
        chosen[slaves] = False
        nodes = np.flatnonzero(chosen)
        if not len(nodes):
            continue
        # Seen from a curve that moved with its reference node.
        before, after, node = points[nodes], x[nodes], curve.reference
        if isinstance(node, int | np.integer):
            after = rotated(after, -curve.turns * u[node, 2], x[node], points[node])
        pieces = chords(curve)
        depth = entered(before, after, pieces, pieces)
        depth[depth > np.linalg.norm(after - before, axis=1)] = 0.0  # it came there around an end
        # What may lie deeper than the slave surface beside it [mean distance of slave nodes].
        least = NAMED * float(np.ptp(points[slaves], axis=0).max()) / len(slaves)
        note(pairs[0], nodes, depth, least, "with this rigid curve lie behind it")
    return notes


def _surface_nodes(model: Model, surface: str | Ints) -> Ints:
    edges, single = edges_or_nodes(model.mesh, surface)
    return single if len(single) else model.mesh.edge_set_nodes(edges)
